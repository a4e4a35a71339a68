//! The boundary of a trimmed surface as curves in space, with their own certified solver.
//!
//! Every piece of the region's boundary is cut at the carrier's knots and composed with the patch that holds it ([`compose`](super::compose)). What is of high
//! degree is replaced by quintics that lie within a proven error of it: the lower bound pays for that.

use glam::{DVec2, DVec3};
use perpend_kernel::{BoundaryPiece, Direction, KnotVector, NurbsSurface, Region};

use super::compose::{self, Net, composed, quintic};
use crate::hierarchy::{Frame, Hierarchy, LocalSolution, Patches, Workspace};
use crate::query::Query;

/// Curves up to this degree are kept as they are.
const KEPT_DEGREE: usize = 8;

/// Sought distance between a quintic and what it stands for, in the entity's own coordinates, whose size is 1 to 2: a hundredth of the default gap.
const CLOSE: f64 = 1e-11;

/// How often a curve is halved at most to bring its quintic closer.
const DEPTH: u32 = 12;

/// The boundary of a trimmed surface.
#[derive(Debug)]
pub(crate) struct Boundary {
    curves: Hierarchy,
    /// What the hierarchy's parameter counts, in ascending order of it.
    parts: Vec<Part>,
    /// Least and largest parameters of the carrier.
    domain: (DVec2, DVec2),
    /// How far any of the curves may be from the boundary, in the entity's own coordinates.
    error: f64,
}

/// A part of the boundary: a range of the parameter of one of its pieces.
#[derive(Debug, Clone, Copy)]
struct Part {
    /// It covers `[start, start + 1]` of the hierarchy's parameter. Where it does not go on from the part before it, a value lies between
    /// both: no value of the parameter is two points.
    start: f64,
    piece: u32,
    from: f64,
    to: f64,
}

/// A foot on the boundary.
#[derive(Debug, Clone)]
pub(crate) struct BoundaryFoot {
    /// Parameters of the carrier.
    pub at: DVec2,
    /// Whether p-curves meet there.
    pub is_vertex: bool,
    /// What the solver of the curves found, in the entity's own coordinates; its bound pays for the curves' error.
    pub solution: LocalSolution,
}

impl Boundary {
    /// The boundary of a region of a surface, whose patches in the entity's own coordinates are given.
    pub(super) fn new(region: &Region, surface: &NurbsSurface, frame: Frame, patches: &Patches) -> Self {
        let mut parts: Vec<Part> = Vec::new();
        let mut nets: Vec<(f64, Net)> = Vec::new();
        let mut end: Option<DVec2> = None;
        let (mut error, mut degree) = (0.0_f64, 0);
        for (index, piece) in region.pieces().iter().enumerate() {
            let mut goes_on = end == Some(piece.start);
            end = Some(piece.end);
            for (from, to) in cut(piece, surface) {
                let points = restricted(&piece.points, from, to);
                let patch = patches.holding(middle_of(&points));
                degree = degree.max(points.len() - 1);
                let whole = composed(patch, &points);
                let mut waiting = vec![(whole, from, to, 0)];
                while let Some((net, from, to, depth)) = waiting.pop() {
                    let (net, off) = if net.len() > KEPT_DEGREE + 1 {
                        let (low, off) = quintic(&net);
                        if off > CLOSE && depth < DEPTH {
                            let middle = from + 0.5 * (to - from);
                            let [low, high] = compose::halves(net);
                            waiting.extend([(high, middle, to, depth + 1), (low, from, middle, depth + 1)]);
                            continue;
                        }
                        (low, off)
                    } else {
                        (net, 0.0)
                    };
                    error = error.max(off);
                    let step = if goes_on { 1.0 } else { 2.0 };
                    let start = parts.last().map_or(0.0, |last| last.start + step);
                    goes_on = true;
                    nets.push((start, net));
                    parts.push(Part { start, piece: index as u32, from, to });
                }
            }
        }
        let curves = Hierarchy::of_curves(frame, nets, patches.rounding(degree));
        let [(u0, u1), (v0, v1)] = [Direction::U, Direction::V].map(|along| surface.domain(along));
        Self { curves, parts, domain: (DVec2::new(u0, v0), DVec2::new(u1, v1)), error }
    }

    /// The boundary's nearest point; none where it is proven that none lies within the query's `max_distance`.
    pub(crate) fn project(&self, query: &Query, region: &Region, workspace: &mut Workspace) -> Option<BoundaryFoot> {
        let mut solution = self.curves.project(query, None, workspace)?;
        solution.lower_bound = (solution.lower_bound - self.error).max(0.0);
        let index = self.parts.partition_point(|part| part.start <= solution.u).saturating_sub(1);
        let part = self.parts[index];
        let share = (solution.u - part.start).clamp(0.0, 1.0);
        let t = if share >= 1.0 { part.to } else { part.from + share * (part.to - part.from) };
        let piece = &region.pieces()[part.piece as usize];
        let at = match t {
            0.0 => piece.start,
            1.0 => piece.end,
            // an ulp outside, where a combination of equal numbers was rounded up
            t => point(&piece.points, t).clamp(self.domain.0, self.domain.1),
        };
        let is_vertex = (t == 0.0 && piece.begins_curve) || (t == 1.0 && piece.ends_curve);
        Some(BoundaryFoot { at, is_vertex, solution })
    }

    /// How far its curves may be from the boundary, in the entity's own coordinates.
    pub(crate) fn error(&self) -> f64 {
        self.error
    }
}

/// The parameter in the middle of a piece, about.
fn middle_of(points: &[DVec3]) -> DVec2 {
    point(points, 0.5)
}

/// The point of a homogeneous Bézier piece in the plane.
pub(super) fn point(points: &[DVec3], t: f64) -> DVec2 {
    let mut work: smallvec::SmallVec<[DVec3; 8]> = points.into();
    for k in (1..work.len()).rev() {
        for i in 0..k {
            work[i] = work[i] * (1.0 - t) + work[i + 1] * t;
        }
    }
    work[0].truncate() / work[0].z
}

/// The part of a Bézier piece over a range of its parameter.
fn restricted(points: &[DVec3], from: f64, to: f64) -> Vec<DVec3> {
    let mut work = points.to_vec();
    if to < 1.0 {
        let n = work.len();
        for k in 1..n {
            for i in (k..n).rev() {
                work[i] = work[i - 1] * (1.0 - to) + work[i] * to;
            }
        }
    }
    if from > 0.0 {
        let (n, from) = (work.len(), from / to);
        for k in 1..n {
            for i in 0..n - k {
                work[i] = work[i] * (1.0 - from) + work[i + 1] * from;
            }
        }
    }
    work
}

/// The ranges of a piece's parameter between the carrier's knots, in order.
fn cut(piece: &BoundaryPiece, surface: &NurbsSurface) -> Vec<(f64, f64)> {
    let mut at = vec![0.0, 1.0];
    for (axis, direction) in [Direction::U, Direction::V].into_iter().enumerate() {
        let knots: &KnotVector = surface.knots(direction);
        let value = |point: &DVec3| point[axis] / point.z;
        let low = piece.points.iter().map(value).fold(f64::INFINITY, f64::min);
        let high = piece.points.iter().map(value).fold(f64::NEG_INFINITY, f64::max);
        for knot in knots.breaks().map(|one| one.at).filter(|knot| low < *knot && *knot < high) {
            let form: Vec<f64> = piece.points.iter().map(|point| point[axis] - knot * point.z).collect();
            roots(&form, &mut at);
        }
    }
    at.sort_by(f64::total_cmp);
    // roots a few roundings apart are one; the ends stay
    at.dedup_by(|next, kept| *next - *kept < 1e-14);
    *at.last_mut().expect("there are two ends") = 1.0;
    at.windows(2).map(|pair| (pair[0], pair[1])).collect()
}

/// Adds the roots of a Bernstein polynomial inside `(0, 1)`, to rounding.
fn roots(form: &[f64], found: &mut Vec<f64>) {
    let largest = form.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
    let mut open = vec![(form.to_vec(), 0.0, 1.0)];
    while let Some((form, from, to)) = open.pop() {
        let is_one_sided = form.iter().all(|x| *x > 0.0) || form.iter().all(|x| *x < 0.0);
        if is_one_sided {
            continue;
        }
        let middle = from + 0.5 * (to - from);
        // down to rounding: a root where the signs at the ends differ, else the curve only touches the knot
        if to - from < 4.0 * f64::EPSILON || form.iter().all(|x| x.abs() <= 8.0 * f64::EPSILON * largest) {
            if form[0] * form[form.len() - 1] <= 0.0 && from > 0.0 && to < 1.0 {
                found.push(middle);
            }
            continue;
        }
        let [low, high] = compose::halves(form);
        open.push((low, from, middle));
        open.push((high, middle, to));
    }
}
