//! The first proof that is tried for a leaf: from the ranges of its form's derivatives, without the form.
//!
//! Where the slopes' signs tell on which edge or corner the form is least, only that remains. A corner is a control point. Elsewhere, where
//! the ranges show the form convex, a point from Newton's method bounds it from below ([`bound`](super::bound)).

use super::bound::{least_from, value_error};
use super::certify::Part;
use super::newton::{self, Domain, Found, Search};
use super::state::{Foot, State};

/// How many points Newton's method may evaluate; where it needs more, the form tells more.
const EVALUATIONS: u32 = 6;

/// Whether the leaf is proven no nearer than the state's `tau`. Nearer points that are met on the way lower it.
///
/// The first leaf of a query is searched also where its form is not shown convex: it gives the first upper bound.
pub(super) fn closes(part: Part<'_>, first: bool, state: &mut State<'_>) -> bool {
    let leaf = part.leaf;
    let x = state.point - leaf.origin;
    let ranges = &leaf.opened().ranges;
    let y = leaf.along_axes(x);
    // where this leaf holds the best point, that was found by a look at it before
    let start = if state.best.leaf == part.index { state.best.next } else { leaf.linear_guess(x) };
    // a rational leaf's form is made for one tau: when that falls, a second look asks for less
    let mut found: Option<Found> = None;
    for look in 0..2 {
        let tau = state.tau();
        let view = ranges.view(x, y, tau);
        let domain = ranges.lowest(&view);
        if let Some((s, t)) = domain.corner() {
            let corner = leaf.corner(s, t);
            let distance = corner.distance(x);
            let (s, t) = part.parameters(s, t);
            state.offer(Foot { leaf: part.index, s, t, next: (s, t), point: corner + leaf.origin, distance });
            let tau = if leaf.rational { tau } else { state.tau() };
            if (distance - tau) * (distance + tau) * leaf.lightest * leaf.lightest >= value_error(leaf, distance) {
                return true;
            }
        } else {
            let curvature = ranges.curvature(&view, &domain);
            if curvature.is_none() && !(first && look == 0) {
                return false;
            }
            let (upper, goal) = (state.best.distance, state.goal);
            let mut closed = false;
            let mut visit = |found: &Found| {
                let tau = if leaf.rational { tau } else { goal.tau(found.distance.min(upper)) };
                closed = curvature.is_some_and(|c| least_from(leaf, x, found, domain, c, tau) > 0.0);
                closed
            };
            let known = found.filter(|found| domain.contains(found.s, found.t));
            if !known.is_some_and(|found| visit(&found)) {
                let start = known.map_or(start, |found| found.next);
                let decrease = 1e-3 * state.margin();
                let search =
                    Search { domain, start: domain.clamp(start.0, start.1), evaluations: EVALUATIONS, decrease };
                let there = newton::search(leaf, x, search, &mut state.done, visit);
                part.offer(&there, state);
                found = Some(there);
            }
            if closed {
                return true;
            }
        }
        if !leaf.rational || state.tau() >= tau {
            return false;
        }
    }
    false
}

impl Domain {
    /// The point that the box is, if it is one.
    pub(super) fn corner(&self) -> Option<(f64, f64)> {
        (self.s.0 == self.s.1 && self.t.0 == self.t.1).then_some((self.s.0, self.t.0))
    }
}
