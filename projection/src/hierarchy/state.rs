//! What is known so far of one query.

use glam::DVec3;

use crate::statistics::Work;
use crate::tree::Candidate;

/// A point of the entity.
#[derive(Debug, Clone, Copy)]
pub(super) struct Foot {
    /// The prepared leaf.
    pub leaf: u32,
    /// Parameters in that leaf.
    pub s: f64,
    pub t: f64,
    /// Where a step of Newton's method leads from there.
    pub next: (f64, f64),
    /// In the entity's coordinates.
    pub point: DVec3,
    pub distance: f64,
}

/// What the proof of a query is to reach. All lengths are in the entity's own coordinates.
#[derive(Debug, Clone, Copy)]
pub(super) struct Goal {
    /// How far below the upper bound the proof is sought: the asked gap less the reserves for rounding.
    pub gap: f64,
    /// Where nothing nearer than this is found, that is to be proven: the maximum distance.
    pub wanted: f64,
    /// Nothing farther needs a proof.
    pub limit: f64,
}

impl Goal {
    /// The distance that a proof must reach while the best point is at `distance`: nothing nearer than this. It falls with
    /// `distance`.
    #[inline]
    pub(super) fn tau(&self, distance: f64) -> f64 {
        let sought = (distance - self.gap).max(0.0);
        let sought = if distance > self.wanted { sought.max(self.wanted) } else { sought };
        sought.min(self.limit)
    }

    /// How far a foot may be to count as one as near as the best point, which is at `distance`.
    #[inline]
    pub(super) fn reach(&self, distance: f64) -> f64 {
        (distance + self.gap).min(self.limit)
    }
}

/// The state of one query, shared by all leaves. All lengths are in the entity's own coordinates.
#[derive(Debug)]
pub(super) struct State<'m> {
    pub point: DVec3,
    pub goal: Goal,
    /// The nearest point so far.
    pub best: Foot,
    /// Feet met on the way that are nearest within the gap, for the answer's multiplicity.
    pub met: &'m mut Vec<Foot>,
    /// Working memory: leaves beside a foot.
    pub neighbours: &'m mut Vec<Candidate>,
    /// The least lower bound of the boxes that were left open.
    pub open: f64,
    /// The distance of the nearest point that was met outside the trim since this was last set.
    pub rejected: f64,
    /// Splits that are left.
    pub work: u32,
    pub done: Work,
}

impl State<'_> {
    /// The distance that a proof must reach: nothing nearer than this.
    #[inline]
    pub(super) fn tau(&self) -> f64 {
        self.goal.tau(self.best.distance)
    }

    /// Whether it is proven that nothing lies within the maximum distance, by so much that the last digits of the best point do not matter.
    pub(super) fn is_clearly_beyond(&self) -> bool {
        let Goal { gap, wanted, .. } = self.goal;
        self.best.distance > wanted + 2.0 * gap && self.tau().min(self.open) >= wanted
    }

    /// How far a foot may be to count as one as near as the best.
    pub(super) fn reach(&self) -> f64 {
        self.goal.reach(self.best.distance)
    }

    /// What the squared distance of a foot exceeds `tau²` by, at least, where it is worth proving.
    pub(super) fn margin(&self) -> f64 {
        let tau = self.tau();
        let reach = self.best.distance.min(tau + self.goal.gap);
        (reach - tau) * (reach + tau)
    }

    /// Takes note of a point.
    pub(super) fn offer(&mut self, foot: Foot) {
        if foot.distance <= self.best.distance + self.goal.gap {
            if self.met.len() == MET {
                let reach = self.best.distance + self.goal.gap;
                self.met.retain(|met| met.distance <= reach);
            }
            if self.met.len() < MET {
                self.met.push(foot);
            }
        }
        if foot.distance < self.best.distance {
            self.best = foot;
        }
    }
}

/// How many feet are kept for the answer's multiplicity.
const MET: usize = 16;
