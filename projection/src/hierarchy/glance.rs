//! The first proof that is tried for a leaf: from the ranges of the derivatives of its squared distance, without the form.
//!
//! Where secants (of a rational leaf, slopes) tell on which edge or corner the leaf is nearest, only that remains. A corner is a control point.
//! Elsewhere, where the ranges show the squared distance convex, a point from Newton's method bounds it from below ([`bound`](super::bound)).

use fearless_simd::{Simd, dispatch};

use super::bound::{nearest_from, square_error};
use super::certify::Part;
use super::newton::{self, Search};
use super::state::{Foot, State};

/// How many points Newton's method may evaluate; where it needs more, the form tells more.
const EVALUATIONS: u32 = 8;

/// Whether the leaf is proven no nearer than the state's `tau`. Nearer points that are met on the way lower it.
///
/// The first leaf of a query is searched also where it is not shown convex: it gives the first upper bound.
pub(super) fn closes(part: Part<'_>, first: bool, state: &mut State<'_>) -> bool {
    dispatch!(part.leaf.level, simd => closes_within(simd, part, first, state))
}

#[inline(always)]
fn closes_within<S: Simd>(simd: S, part: Part<'_>, first: bool, state: &mut State<'_>) -> bool {
    let leaf = part.leaf;
    let x = state.point - leaf.origin;
    let ranges = leaf.ranges();
    let view = ranges.view(x, leaf.along_axes(x));
    let domain = ranges.lowest(&view);
    if let Some((s, t)) = domain.corner() {
        let corner = leaf.corner(s, t);
        let distance = corner.distance(x);
        let counts = part.counts(s, t);
        let (s, t) = part.parameters(s, t);
        let foot = Foot { leaf: part.index, s, t, next: (s, t), point: corner + leaf.origin, distance };
        if counts {
            state.offer(foot);
        } else {
            state.rejected = state.rejected.min(distance);
        }
        let tau = state.tau();
        return (distance - tau) * (distance + tau) >= square_error(leaf, distance);
    }
    let curvature = ranges.curvature(&view, &domain);
    if curvature.is_none() && !first {
        return false;
    }
    // where this leaf holds the best point already, from the next one
    let (s, t) = if state.best.leaf == part.index { state.best.next } else { leaf.linear_guess(x) };
    let decrease = 1e-3 * state.margin();
    let search = Search { domain, start: domain.clamp(s, t), evaluations: EVALUATIONS, decrease };
    let (upper, goal, is_whole_entity) = (state.best.distance, state.goal, part.region.is_none());
    let mut closed = false;
    let found = newton::search_within(
        simd,
        leaf,
        x,
        search,
        &mut state.done,
        #[inline(always)]
        |found| {
            let Some(curvature) = curvature else { return false };
            let best = if is_whole_entity { found.distance.min(upper) } else { upper };
            let (tau, reach) = (goal.tau(best), goal.reach(best));
            let least = nearest_from(leaf, x, found, domain, curvature);
            closed |= least >= tau * tau;
            // what is proven no nearer may still hold a foot that is as near
            closed && (found.distance <= reach || least >= reach * reach)
        },
    );
    part.offer(&found, state);
    closed
}
