//! The reply: the best foot as exactly as it can be told, its place among the leaves, and what other feet are to it.

use std::mem::swap;

use glam::{DVec3, DVec4};

use super::newton::{self, Polished};
use super::state::{Foot, State};
use super::{Hierarchy, LocalSolution, ROUNDING, holds, squared};
use crate::solver::{Tie, unit_normal};

/// Nearer to a leaf's border than this share of the leaf, a foot may be on it but for rounding.
const NEAR_BORDER: f64 = 1e-6;

/// How many borders a foot is followed across: it is within the gap of the nearest, so that the next leaf or the one after has it.
const CROSSINGS: u32 = 4;

/// A polished foot of a leaf.
#[derive(Debug, Clone, Copy)]
pub(super) struct Settled {
    leaf: u32,
    polished: Polished,
    /// In the entity's coordinates.
    pub(super) point: DVec3,
}

impl Settled {
    /// The order of feet: the nearest first, then the one with the lower parameters.
    fn rank(&self) -> (f64, f64, f64) {
        (self.distance(), self.polished.u, self.polished.v)
    }

    pub(super) fn distance(&self) -> f64 {
        self.polished.found.distance
    }

    /// Parameters of the definition.
    pub(super) fn parameters(&self) -> (f64, f64) {
        (self.polished.u, self.polished.v)
    }
}

impl Hierarchy {
    /// Polishes the feet that were met and reads the answer off the least (distance, u, v).
    pub(super) fn solution(&self, state: &mut State<'_>, coincidence: f64) -> LocalSolution {
        let lower = state.tau().min(state.open) - self.reserve - 10.0 * ROUNDING * state.point.length();
        let mut winner = self.polish(&state.best.clone(), state);
        self.cross_borders(&mut winner, state);
        let mut others = self.others(&winner, coincidence, state);
        for other in &mut others {
            if other.rank() < winner.rank() {
                swap(other, &mut winner);
            }
        }
        let tie = self.tie(&winner, &others, coincidence, state);
        self.solution_at(&winner, tie, lower.max(0.0), state)
    }

    /// The feet that were met elsewhere and are as near as the best one within the gap, polished.
    fn others(&self, best: &Settled, coincidence: f64, state: &mut State<'_>) -> Vec<Settled> {
        let near = best.distance() + state.goal.gap;
        let apart = |distance: f64, point: DVec3| distance <= near && point.distance(best.point) > coincidence;
        // two feet of one leaf that are this close in its parameters are one on its way to convergence
        let (s, t) = (best.polished.found.s, best.polished.found.t);
        let close = |foot: &Foot| foot.leaf == best.leaf && (foot.s - s).abs().max((foot.t - t).abs()) < 1e-2;
        let mut others = Vec::new();
        for k in 0..state.met.len() {
            let foot = state.met[k];
            if apart(foot.distance, foot.point) && !close(&foot) {
                let settled = self.polish(&foot, state);
                if apart(settled.distance(), settled.point) {
                    others.push(settled);
                }
            }
        }
        others
    }

    /// A foot as the solution of its query.
    pub(super) fn solution_at(&self, foot: &Settled, tie: Tie, lower_bound: f64, state: &State<'_>) -> LocalSolution {
        let leaf = &self.leaves[foot.leaf as usize];
        let x = state.point - leaf.origin;
        let Polished { u, v, found } = self.snapped(foot, x);
        LocalSolution {
            u,
            v,
            distance: found.distance,
            lower_bound: lower_bound.min(found.distance),
            normal: unit_normal(found.jet.ps.truncate(), found.jet.pt.truncate()),
            offset: found.jet.point() - x,
            tie,
            done: state.done,
        }
    }

    /// A foot on the border of its leaf where it lies beside it by no more than rounding: there are the edges,
    /// seams, poles and creases that `place` tells by the parameter.
    ///
    /// Rounding moves a foot by more where the entity bends almost about the query: by the inverse of what its curvature leaves of the
    /// Hessian.
    fn snapped(&self, foot: &Settled, x: DVec3) -> Polished {
        let leaf = &self.leaves[foot.leaf as usize];
        let found = &foot.polished.found;
        let border = |x: f64| match x {
            x if x < NEAR_BORDER => 0.0,
            x if x > 1.0 - NEAR_BORDER => 1.0,
            x => x,
        };
        let mut at = (found.s, found.t);
        let corner = (border(at.0), border(at.1));
        if corner == at {
            return foot.polished;
        }
        let c = &found.jet;
        let r = c.point() - x;
        let left = |first: DVec4, second: DVec4| {
            let (first, second) = (first.truncate(), second.truncate());
            let square = first.length_squared();
            if square > 0.0 { ((square + r.dot(second)) / square).clamp(1e-6, 1.0) } else { 1.0 }
        };
        let rounding = 16.0 * ROUNDING * (1.0 + found.distance) / left(c.ps, c.pss).min(left(c.pt, c.ptt));
        for snapped in [(corner.0, at.1), (at.0, corner.1), corner] {
            if snapped != at && leaf.jet(snapped.0, snapped.1).point().distance(c.point()) <= rounding {
                at = snapped;
            }
        }
        if at == (found.s, found.t) {
            return foot.polished;
        }
        let (u, v) = leaf.parameters(at.0, at.1);
        Polished { u, v, found: newton::point(leaf, x, leaf.own_parameters(u, v)) }
    }

    /// A foot as exactly as its coordinates allow, in its prepared leaf.
    pub(super) fn polish(&self, foot: &Foot, state: &mut State<'_>) -> Settled {
        let leaf = &self.leaves[foot.leaf as usize];
        let polished = newton::polish(leaf, state.point - leaf.origin, foot, &mut state.done);
        Settled { leaf: foot.leaf, polished, point: polished.found.jet.point() + leaf.origin }
    }

    /// Follows a foot out of its leaf: where it lies on a border with another leaf, the distance may go on falling there. The proof
    /// does not ask for that, as it is less than the gap; the foot's place does.
    fn cross_borders(&self, foot: &mut Settled, state: &mut State<'_>) {
        for _ in 0..CROSSINGS {
            let here = *foot;
            let leaf = &self.leaves[here.leaf as usize];
            let inner = |x: f64, (from, to): (f64, f64), (first, last): (f64, f64)| {
                (x == 0.0 && from > first) || (x == 1.0 && to < last)
            };
            let (surface, found) = (leaf.degree.1 > 0, &here.polished.found);
            let crosses = inner(found.s, leaf.u, self.domain[0]) || (surface && inner(found.t, leaf.v, self.domain[1]));
            if !crosses {
                return;
            }
            let (u, v) = here.parameters();
            state.neighbours.clear();
            state.done.boxes += self.tree.nearer_than(here.point, squared(1e-9), state.neighbours);
            for k in 0..state.neighbours.len() {
                let neighbour = state.neighbours[k];
                let other = &self.leaves[neighbour.item as usize];
                if neighbour.item != here.leaf && holds(other.u, u) && holds(other.v, v) {
                    let x = state.point - other.origin;
                    let start = self.part(neighbour.item).foot(&newton::point(other, x, other.own_parameters(u, v)));
                    let there = self.polish(&start, state);
                    if there.distance() < foot.distance() {
                        *foot = there;
                    }
                }
            }
            if foot.leaf == here.leaf {
                return;
            }
        }
    }

    /// The distance from the query to the entity at parameters of the definition.
    pub(super) fn distance_at(&self, p: DVec3, u: f64, v: f64) -> f64 {
        let leaf = self.leaves.iter().find(|leaf| holds(leaf.u, u) && holds(leaf.v, v)).unwrap_or(&self.leaves[0]);
        let (s, t) = leaf.own_parameters(u, v);
        leaf.jet(s, t).point().distance(p - leaf.origin)
    }

    /// What the other feet are to the best one.
    ///
    /// The straight way between the parameters of two feet tells: where it leads farther away than both, they are apart; where the
    /// best one is flat and the whole way is as near to rounding, they belong to a continuum. Else the other is on its way to the
    /// best one, or was kept from it by the border of its leaf.
    fn tie(&self, best: &Settled, others: &[Settled], coincidence: f64, state: &State<'_>) -> Tie {
        let flat = self.is_flat(best, state);
        if !flat && others.is_empty() {
            return Tie::None;
        }
        let mut tie = Tie::None;
        let noise = 64.0 * ROUNDING * (best.distance() + 1.0);
        let sides = flat.then(|| self.sides(best, state)).into_iter().flatten();
        let met = others.iter().map(|foot| (foot.parameters(), foot.distance(), foot.point));
        for (b, distance, point) in met.chain(sides) {
            if distance > best.distance() + state.goal.gap || point.distance(best.point) <= coincidence {
                continue;
            }
            let a = best.parameters();
            let between = [0.25, 0.5, 0.75]
                .map(|share| self.distance_at(state.point, a.0 + share * (b.0 - a.0), a.1 + share * (b.1 - a.1)));
            if between.iter().any(|d| *d > distance.max(best.distance()) + noise) {
                tie = Tie::Apart;
            } else if flat && between.iter().all(|d| (d - best.distance()).abs() <= noise) {
                return Tie::Connected;
            }
        }
        tie
    }

    /// Whether the distance is flat to second order at a foot: then others may be as near beside it.
    ///
    /// A direction in which the foot is held at a border, the distance falling beyond, is not flat.
    fn is_flat(&self, foot: &Settled, state: &State<'_>) -> bool {
        let leaf = &self.leaves[foot.leaf as usize];
        let c = &foot.polished.found.jet;
        let r = c.point() - (state.point - leaf.origin);
        let [ps, pt, pss, pst, ptt] = [c.ps, c.pt, c.pss, c.pst, c.ptt].map(DVec4::truncate);
        let (a, b) = (ps.length_squared(), pt.length_squared());
        let reach = squared(1e-9 * foot.distance());
        let held = |derivative: DVec3, square: f64| squared(r.dot(derivative)) > reach * square;
        let (hss, hst, htt) = (a + r.dot(pss), ps.dot(pt) + r.dot(pst), b + r.dot(ptt));
        match (held(ps, a), leaf.degree.1 == 0 || held(pt, b)) {
            (true, true) => false,
            (true, false) => htt <= 1e-9 * b,
            (false, true) => hss <= 1e-9 * a,
            (false, false) => hss * htt - hst * hst <= 1e-9 * a * b,
        }
    }

    /// Points to compare a flat foot with, on the sides of its leaf, straight across: parameters of the definition, distance and point.
    fn sides(&self, foot: &Settled, state: &State<'_>) -> impl Iterator<Item = ((f64, f64), f64, DVec3)> {
        let leaf = &self.leaves[foot.leaf as usize];
        let (x, count) = (state.point - leaf.origin, if leaf.degree.1 == 0 { 2 } else { 4 });
        let (s, t) = (foot.polished.found.s, foot.polished.found.t);
        let sides = [(0.0, t), (1.0, t), (s, 0.0), (s, 1.0)];
        sides.into_iter().take(count).map(move |(s, t)| {
            let point = leaf.jet(s, t).point();
            (leaf.parameters(s, t), point.distance(x), point + leaf.origin)
        })
    }
}
