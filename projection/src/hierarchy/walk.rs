//! The walk over the leaves: which are proven, in which order, and what is done where the form alone does not prove one.

use glam::DVec3;

use super::certify::{Memory, Outcome, Part, certify};
use super::form::{rounding_bound, rounding_factor};
use super::newton::Domain;
use super::state::{Foot, Goal, State};
use super::{Hierarchy, Lists, LocalSolution, REFINED_DEPTH, ROUNDING, glance, squared};
use crate::query::{DEFAULT_GAP, Query};
use crate::statistics::Work;
use crate::tree::Candidate;

/// A leaf that was looked at before the others, and whether it is proven already.
#[derive(Debug, Clone, Copy)]
pub(super) struct Visited {
    index: u32,
    closed: bool,
}

impl Hierarchy {
    /// The state of a query of which one point is known.
    pub(super) fn state<'m>(&self, query: &Query, best: Foot, lists: &'m mut Lists) -> State<'m> {
        let Lists { met, neighbours } = lists;
        met.clear();
        met.push(best);
        State {
            point: self.frame.enter(query.point),
            goal: self.goal(query, &best),
            best,
            met,
            neighbours,
            open: f64::INFINITY,
            rejected: f64::INFINITY,
            work: query.options.work,
            done: Work::default(),
        }
    }

    /// What the proof is to reach, as far as a point at that distance tells.
    pub(super) fn goal(&self, query: &Query, best: &Foot) -> Goal {
        let scale = self.frame.scale;
        // Whether anything is within a maximum distance is told as finely as by default, however wide the gap.
        let (wanted, finest) = match query.options.max_distance {
            Some(distance) => (distance * scale, DEFAULT_GAP * self.frame.size * scale),
            None => (f64::INFINITY, f64::INFINITY),
        };
        let asked = self.asked_gap(query).min(finest);
        // The proof is sought closer than asked by what rounding may take away again. Where that leaves less than half, or
        // the asked gap is finer than the forms can tell at this distance, the finest gap that they can tell is sought.
        // A fiftieth is kept for the foot's parameters, which are rounded after the proof.
        let left = 0.98 * asked - 2.0 * self.reserve - 20.0 * ROUNDING * self.frame.enter(query.point).length();
        let gap = if left < 0.5 * asked {
            let degree = self.leaves.get(best.leaf as usize).unwrap_or(&self.leaves[0]).degree;
            left.max(40.0 * rounding_factor(degree) * ROUNDING * best.distance + 2.0 * self.reserve)
        } else {
            left
        };
        Goal { gap, wanted, limit: wanted + asked }
    }

    /// The first look at a leaf, for a first upper bound; often its proof, too.
    pub(super) fn visit_first(&self, query: &Query, index: u32, state: &mut State<'_>) -> Visited {
        let closed = glance::closes(self.part(index), true, state);
        // the gap that can be reached depends on the distance, which is better known now
        let goal = self.goal(query, &state.best);
        let closed = closed && goal.gap >= state.goal.gap;
        state.goal = goal;
        Visited { index, closed }
    }

    /// Proves every leaf that could hold a point nearer than `tau`, the nearest box first; then looks for feet in those that can
    /// hold none nearer than that, but others as near within the gap.
    pub(super) fn walk(
        &self,
        visited: Option<Visited>,
        state: &mut State<'_>,
        hint: f64,
        memory: &mut Memory,
        candidates: &mut Vec<Candidate>,
    ) {
        // a hint of a point at distance h: the best will be at most h + gap away, and others as near within the gap count
        let (mut from, mut to) = (0.0, squared(state.reach().min(hint + 2.0 * state.goal.gap)));
        while state.tau() > 0.0 {
            candidates.clear();
            state.done.boxes += self.tree.nearer_than(state.point, to, candidates);
            let is_closed = |item: u32| visited.is_some_and(|visited| visited.closed && visited.index == item);
            candidates.retain_mut(|candidate| {
                let leaf = &self.leaves[candidate.item as usize];
                candidate.distance_squared =
                    candidate.distance_squared.max(leaf.oriented_distance_squared(state.point));
                (from..to).contains(&candidate.distance_squared) && !is_closed(candidate.item)
            });
            candidates
                .sort_unstable_by(|a, b| a.distance_squared.total_cmp(&b.distance_squared).then(a.item.cmp(&b.item)));
            for candidate in candidates.iter() {
                let part = self.part(candidate.item);
                if candidate.distance_squared < squared(state.tau()) {
                    let seen = visited.is_some_and(|visited| visited.index == candidate.item);
                    if part.region.is_some() {
                        self.close_crossed(part, state, memory);
                    } else if seen || !glance::closes(part, false, state) {
                        close(part, state, memory, 0);
                    }
                } else if candidate.distance_squared < squared(state.reach()) {
                    part.look_for_tie(state);
                } else {
                    return;
                }
            }
            // the leaves beyond the bound that the hint gave, if they are needed after all
            (from, to) = (to, squared(state.reach()));
            if to <= from {
                return;
            }
        }
    }

    /// The solution, unless it is proven that nothing lies within the query's maximum distance.
    pub(super) fn within(&self, query: &Query, solution: LocalSolution, state: &State<'_>) -> Option<LocalSolution> {
        let limit = query.options.max_distance.unwrap_or(f64::INFINITY);
        // none is a claim, too: it needs its proof
        let beyond = self.frame.length(solution.distance) > limit && state.tau().min(state.open) >= state.goal.wanted;
        (!beyond).then_some(solution)
    }
}

/// Proves a part by its form, refining its vector piece where the form alone does not do it.
pub(super) fn close(part: Part<'_>, state: &mut State<'_>, memory: &mut Memory, depth: u32) {
    // where even a leaf without extent would drown in rounding, refining is in vain
    let floor = rounding_bound(part.leaf.degree, state.best.distance, 0.0, state.tau(), 1.0);
    let last = depth >= REFINED_DEPTH || floor > state.margin();
    let share = match (last, depth) {
        (true, _) => 4_000,
        (false, 0) => 200,
        (false, _) => 60,
    };
    if certify(part, state, memory, share, last) == Outcome::Closed {
        return;
    }
    state.done.refinements += 1;
    state.work = state.work.saturating_sub(1);
    let (direction, halves) = part.leaf.refine();
    let within = part.within.halves(direction);
    let mut parts = [0, 1].map(|k| {
        let part = Part { leaf: &halves[k], index: part.index, within: within[k], region: None };
        (part.leaf.box_distance_squared(state.point), part)
    });
    if parts[1].0 < parts[0].0 {
        parts.swap(0, 1);
    }
    for (distance_squared, part) in parts {
        if distance_squared < squared(state.tau()) {
            close(part, state, memory, depth + 1);
        }
    }
}

impl Part<'_> {
    /// The point in the middle of a leaf's parameters: a first upper bound that costs no evaluation.
    pub(super) fn middle(&self, p: DVec3) -> Foot {
        let point = self.leaf.middle() + self.leaf.origin;
        let (s, t) = (0.5, if self.leaf.degree.1 == 0 { 0.0 } else { 0.5 });
        let guess = self.leaf.linear_guess(p - self.leaf.origin);
        let next = Domain::WHOLE.clamp(guess.0, guess.1);
        Foot { leaf: self.index, s, t, next, point, distance: point.distance(p) }
    }
}
