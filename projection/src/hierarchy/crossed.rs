//! The walk over a trimmed surface: leaves that its boundary crosses.
//!
//! A leaf is wholly inside the region, or the boundary crosses it; leaves outside are not kept. One inside is proven as a leaf of any surface. The nearest point of
//! the trimmed surface lies on its boundary, which is projected onto as curves, or it is a local minimum of the distance inside the region. So a leaf that is
//! crossed is proven in one of these ways:
//!
//! 1. no point of it is nearer than `tau`, trimmed away or not: by the glance and the form, as any leaf;
//! 2. the squared distance has no stationary point on it: one of its slopes has a sign all over the leaf. A slope that falls towards a crease of
//!    the carrier says nothing, since across it the distance may rise;
//! 3. it is split, and what of it lies outside is dropped.
//!
//! A point of a crossed leaf bounds the answer from above only where it lies in the region.

use std::sync::{Arc, OnceLock};

use glam::{DVec2, DVec3};
use perpend_kernel::{Cover, Direction, KnotVector, NurbsSurface, Region, Side, Trimming};

use super::certify::{Memory, Outcome, Part, certify};
use super::leaf::Leaf;
use super::ranges::Slopes;
use super::state::{Foot, State};
use super::walk::close;
use super::{Hierarchy, LocalSolution, REFINED_DEPTH, ROUNDING, Workspace, glance, squared};
use crate::query::{Query, QueryOptions};
use crate::solver::Tie;
use crate::statistics::Work;

/// The index of the leaf of a point that lies in none: a point of the boundary.
const NO_LEAF: u32 = u32::MAX;

/// Splits of the form of a crossed leaf before its vector piece is split: pieces of it may lie outside.
const SHARE: u32 = 24;

/// How often a crossed leaf is refined at most: what is left then is smaller than rounding of its parameters.
pub(super) const CROSSED_DEPTH: u32 = 90;

/// How often a glance is repeated while it finds nearer points.
const GLANCES: u32 = 3;

/// What a trim does to the leaves of its carrier.
#[derive(Debug)]
pub(super) struct Trim {
    trimming: Arc<Trimming>,
    /// Whether the boundary crosses a leaf.
    crossed: Vec<bool>,
    /// The slopes of crossed leaves, made when first asked for.
    slopes: Vec<OnceLock<Slopes>>,
    /// Parameters in u and in v across which the tangent plane may turn.
    creases: [Vec<f64>; 2],
}

impl Trim {
    pub(super) fn new(trimming: Arc<Trimming>, crossed: Vec<bool>, surface: &NurbsSurface) -> Self {
        let slopes = crossed.iter().map(|_| OnceLock::new()).collect();
        let creases = [Direction::U, Direction::V].map(|direction| creases(surface, direction));
        Self { trimming, crossed, slopes, creases }
    }

    /// The region, where its boundary crosses a leaf.
    pub(super) fn crossing(&self, leaf: u32) -> Option<&Region> {
        self.crossed[leaf as usize].then(|| self.trimming.region())
    }

    /// Whether the squared distance has no stationary point on a part, and none on a crease at its border.
    fn is_never_level(&self, leaf: &Leaf, slopes: &Slopes, p: DVec3) -> bool {
        let x = p - leaf.origin;
        let view = leaf.ranges().view(x, leaf.along_axes(x));
        let ends = [leaf.u, leaf.v];
        slopes.signs(&view).into_iter().enumerate().any(|(axis, sign)| {
            let (from, to) = ends[axis];
            let down = if sign > 0.0 { from } else { to };
            sign != 0.0 && !self.creases[axis].contains(&down)
        })
    }
}

/// The knots across which the tangent plane of a surface may turn.
///
/// Below full multiplicity the derivatives are continuous. At a knot of full multiplicity they are where every column of control points runs straight on, and the ratio
/// of the two legs is one number for all: told for polynomials and for weights that are equal along every column.
fn creases(surface: &NurbsSurface, direction: Direction) -> Vec<f64> {
    let knots: &KnotVector = surface.knots(direction);
    let full = knots.breaks().filter(|one| one.multiplicity >= knots.degree());
    full.filter(|one| !runs_on(surface, direction, knots.find_span(one.at) - knots.degree()))
        .map(|one| one.at)
        .collect()
}

/// Whether the lines of the control net run straight on through the control points of one index.
fn runs_on(surface: &NurbsSurface, direction: Direction, index: usize) -> bool {
    let columns = surface.columns();
    let at = |along: usize, across: usize| match direction {
        Direction::U => along * columns + across,
        Direction::V => across * columns + along,
    };
    let lines = if direction == Direction::U { columns } else { surface.rows() };
    let points = surface.control_points();
    let weight = |k: usize| surface.weights().map_or(1.0, |weights| weights[k]);
    let noise = 1e-13 * surface.control_box().reach();
    let mut ratios = Vec::with_capacity(lines);
    let first = [0, 1, 2].map(|k| weight(at(index + k - 1, 0)));
    for across in 0..lines {
        let [a, b, c] = [index - 1, index, index + 1].map(|along| at(along, across));
        // along the line the weights of all lines are in one proportion
        let scale = weight(b) / first[1];
        let is_alike =
            [a, c].iter().zip([first[0], first[2]]).all(|(k, w)| (weight(*k) - scale * w).abs() <= 1e-13 * w);
        let (before, after) = (points[b] - points[a], points[c] - points[b]);
        let (long, short) = (before.length(), after.length());
        if !is_alike || (before * short - after * long).length() > noise * long.max(short) {
            return false;
        }
        if long.max(short) > noise {
            ratios.push(short / long);
        }
    }
    ratios.iter().all(|ratio| (ratio - ratios[0]).abs() <= 1e-10 * ratios[0])
}

/// A point of the boundary with its bound, in the entity's own coordinates.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BoundaryPoint {
    pub point: DVec3,
    pub distance: f64,
    pub lower_bound: f64,
}

/// The nearest point of a trimmed surface.
#[derive(Debug)]
pub(crate) enum TrimmedFoot {
    /// Inside the region, at these parameters of the carrier where those of the solution, which were polished, left it.
    Inside(LocalSolution, Option<DVec2>),
    /// The boundary's own foot; the distance from the query is nowhere less than this, in the entity's own coordinates.
    OnBoundary { lower_bound: f64, done: Work },
    /// Proven: no point lies within the query's `max_distance`.
    Beyond(Work),
}

impl Hierarchy {
    /// The nearest point of the trimmed surface. `anchor` is any point of its boundary; `boundary` projects onto that, and answers none where it
    /// proves that no point of it is within a distance.
    pub(crate) fn project_trimmed(
        &self,
        query: &Query,
        anchor: DVec3,
        boundary: &mut dyn FnMut(Option<f64>) -> Option<BoundaryPoint>,
        workspace: &mut Workspace,
    ) -> TrimmedFoot {
        let Workspace { memory, candidates, lists } = &mut *workspace;
        let point = self.frame.enter(query.point);
        let on_boundary =
            |point: DVec3, distance: f64| Foot { leaf: NO_LEAF, s: 0.0, t: 0.0, next: (0.0, 0.0), point, distance };
        let mut state = self.state(query, on_boundary(anchor, anchor.distance(point)), lists);
        if self.is_beyond(query, &mut state, candidates) {
            return TrimmedFoot::Beyond(state.done);
        }
        let mut visited = self.tree.descend(point).map(|(first, boxes)| {
            state.done.boxes += boxes;
            self.visit_first(query, first, &mut state)
        });
        let wanted = query.options.max_distance.map(|_| state.goal.wanted);
        let inside = (state.best.leaf != NO_LEAF).then_some(state.best.distance);
        let limit = wanted.into_iter().chain(inside).reduce(f64::min);
        let mut bound = limit.unwrap_or(f64::INFINITY);
        let found = boundary(limit);
        let is_boundary_known = found.is_some();
        if let Some(found) = found {
            bound = found.lower_bound;
            if found.distance < state.best.distance || state.best.leaf == NO_LEAF {
                let gap = state.goal.gap;
                state.best = on_boundary(found.point, found.distance);
                state.met.clear();
                state.goal = self.goal(query, &state.best);
                if state.goal.gap < gap {
                    visited = None;
                }
            }
        }
        self.walk(visited, &mut state, f64::INFINITY, memory, candidates);
        let proven = state.tau().min(state.open).min(bound);
        // what is beyond by no more than rounding is answered, and judged in the model's unit
        let rounding = 64.0 * ROUNDING * (1.0 + state.point.length());
        if state.best.distance > state.goal.wanted + rounding && proven >= state.goal.wanted {
            return TrimmedFoot::Beyond(state.done);
        }
        if state.best.leaf == NO_LEAF && !is_boundary_known {
            // the anchor is no foot: it lies at the limit but for rounding, or the work did not suffice for the proof that there is none
            let options = QueryOptions { max_distance: None, ..query.options };
            return self.project_trimmed(&Query { options, ..*query }, anchor, boundary, workspace);
        }
        let lower = state.tau().min(state.open) - self.reserve - 10.0 * ROUNDING * state.point.length();
        let lower = lower.min(bound).max(0.0);
        if state.best.leaf == NO_LEAF {
            return TrimmedFoot::OnBoundary { lower_bound: lower, done: state.done };
        }
        let best = state.best;
        // a point of the boundary that is as near belongs to no leaf: it is told of, and not polished
        let (near, coincidence) = (best.distance + state.goal.gap, self.coincidence(query));
        let is_tied = state
            .met
            .iter()
            .any(|foot| foot.leaf == NO_LEAF && foot.distance <= near && foot.point.distance(best.point) > coincidence);
        state.met.retain(|foot| foot.leaf != NO_LEAF);
        let mut solution = self.solution(&mut state, coincidence);
        if is_tied && solution.tie == Tie::None {
            solution.tie = Tie::Apart;
        }
        // polished feet may have left the region: their distance is no bound
        solution.lower_bound = lower;
        let trim = self.trim.as_ref().expect("a trimmed surface");
        let kept = |at: DVec2| trim.trimming.region().side(at) != Side::Outside;
        let (u, v) = self.leaves[best.leaf as usize].parameters(best.s, best.t);
        let moved = !kept(DVec2::new(solution.u, solution.v));
        TrimmedFoot::Inside(solution, moved.then_some(DVec2::new(u, v)))
    }

    /// Proves a leaf that the boundary crosses.
    pub(super) fn close_crossed(&self, part: Part<'_>, state: &mut State<'_>, memory: &mut Memory) {
        let trim = self.trim.as_ref().expect("only a trim crosses leaves");
        let slopes = trim.slopes[part.index as usize].get_or_init(|| part.leaf.slopes());
        prove_crossed(trim, part, slopes, state, memory, 0);
    }
}

fn prove_crossed(trim: &Trim, part: Part<'_>, slopes: &Slopes, state: &mut State<'_>, memory: &mut Memory, depth: u32) {
    if trim.is_never_level(part.leaf, slopes, state.point) {
        return;
    }
    state.rejected = f64::INFINITY;
    for _ in 0..GLANCES {
        let before = state.best.distance;
        if glance::closes(part, false, state) {
            return;
        }
        if state.best.distance >= before {
            break;
        }
    }
    let is_refuted = state.rejected < state.tau();
    if !is_refuted && certify(part, state, memory, SHARE, false) == Outcome::Closed {
        return;
    }
    if depth >= CROSSED_DEPTH || state.work == 0 {
        state.done.unresolved += 1;
        state.open = state.open.min(part.leaf.box_distance_squared(state.point).sqrt());
        return;
    }
    state.done.refinements += 1;
    state.work -= 1;
    let (direction, halves) = part.leaf.refine();
    let within = part.within.halves(direction);
    let mut order = [0, 1];
    if halves[1].box_distance_squared(state.point) < halves[0].box_distance_squared(state.point) {
        order.swap(0, 1);
    }
    for k in order {
        let leaf = &halves[k];
        if leaf.box_distance_squared(state.point) >= squared(state.tau()) {
            continue;
        }
        let region = trim.trimming.region();
        let half = Part { leaf, index: part.index, within: within[k], region: Some(region) };
        match region.cover(DVec2::new(leaf.u.0, leaf.v.0), DVec2::new(leaf.u.1, leaf.v.1)) {
            Cover::Outside => {}
            // as small as it may be, half of a leaf's refinements are left to it: the reserve has room for them
            Cover::Inside => close(Part { region: None, ..half }, state, memory, depth.min(REFINED_DEPTH / 2)),
            Cover::Crossed => prove_crossed(trim, half, &leaf.slopes(), state, memory, depth + 1),
        }
    }
}
