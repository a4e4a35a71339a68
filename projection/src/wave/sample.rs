//! The second decomposition: the samples of a segment, from which a start for Newton's method is taken (Piegl et al. 2008, §6).

use glam::DVec3;
use perpend_kernel::{Aabb, Direction, NurbsCurve, NurbsSurface};

use super::decompose::{Decomposition, decompose};
use super::nodes::nodes;
use super::settings::Steps;

/// The most samples of an entity, all segments together: 100 MB.
const MOST: usize = 1 << 22;

/// Samples that share a box.
const RUN: usize = 32;

/// Samples of a segment: a grid of points over parameters in u and in v.
#[derive(Debug)]
pub(super) struct Samples {
    pub u: Vec<f64>,
    /// A single 0 on a curve.
    pub v: Vec<f64>,
    /// Those along v innermost.
    pub points: Vec<DVec3>,
    /// The box of each run of points, in order: a run that is too far is passed over.
    boxes: Vec<Aabb>,
    /// What they cost.
    pub evaluations: u64,
}

/// How densely the segments of an entity can be sampled, so that all samples find room, and how many points a direction may have.
pub(super) fn affordable(asked: Steps, segments: usize, directions: i32) -> (Steps, usize) {
    let share = (MOST / segments.max(1)).max(4) as f64;
    let most = if directions == 2 { share.sqrt() } else { share };
    // steps are at least jitter * tolerance long
    (Steps { tolerance: asked.tolerance.max(1.0 / (asked.jitter * most)).min(1.0), ..asked }, most as usize)
}

impl Samples {
    pub(super) fn of_curve(curve: &NurbsCurve, range: (f64, f64), (steps, most): (Steps, usize)) -> Self {
        let Decomposition { parameters, points, evaluations, length_evaluations } =
            decompose(|u| curve.point(u), &nodes(curve.knots(), range), &[], steps, most);
        Self::new(parameters, vec![0.0], points, evaluations + length_evaluations)
    }

    /// Of a patch: the points of its longest iso-curve in each direction (of both edges and the middle) give the parameters of the grid.
    pub(super) fn of_surface(surface: &NurbsSurface, ranges: [(f64, f64); 2], budget: (Steps, usize)) -> Self {
        let (u, of_u) = along(surface, Direction::U, ranges[0], ranges[1], budget);
        let (v, of_v) = along(surface, Direction::V, ranges[1], ranges[0], budget);
        let points: Vec<DVec3> = u.iter().flat_map(|u| v.iter().map(|v| surface.point(*u, *v))).collect();
        let evaluations = of_u + of_v + points.len() as u64;
        Self::new(u, v, points, evaluations)
    }

    fn new(u: Vec<f64>, v: Vec<f64>, points: Vec<DVec3>, evaluations: u64) -> Self {
        let boxes = points.chunks(RUN).map(|run| Aabb::around(run.iter().copied())).collect();
        Self { u, v, points, boxes, evaluations }
    }

    /// The first of the samples nearest to a query and nearer than `limit_squared`, with the square of its distance.
    pub(super) fn nearest(&self, query: DVec3, limit_squared: f64) -> Option<(usize, f64)> {
        let (mut found, mut least) = (None, limit_squared);
        for (run, bounds) in self.boxes.iter().enumerate() {
            if bounds.distance_squared(query) >= least {
                continue;
            }
            for (k, point) in self.points.iter().enumerate().skip(RUN * run).take(RUN) {
                let distance_squared = point.distance_squared(query);
                if distance_squared < least {
                    (found, least) = (Some((k, distance_squared)), distance_squared);
                }
            }
        }
        found
    }

    /// The parameters of a sample.
    pub(super) fn parameters(&self, index: usize) -> (f64, f64) {
        (self.u[index / self.v.len()], self.v[index % self.v.len()])
    }

    /// Bytes on the heap.
    pub(super) fn memory(&self) -> usize {
        8 * (self.u.capacity() + self.v.capacity())
            + size_of::<DVec3>() * self.points.capacity()
            + size_of::<Aabb>() * self.boxes.capacity()
    }
}

/// The parameters of a patch along a direction, and how many evaluations they took.
fn along(
    surface: &NurbsSurface,
    direction: Direction,
    range: (f64, f64),
    across: (f64, f64),
    (steps, most): (Steps, usize),
) -> (Vec<f64>, u64) {
    let held = match direction {
        Direction::U => Direction::V,
        Direction::V => Direction::U,
    };
    let nodes = nodes(surface.knots(direction), range);
    let length = |curve: &NurbsCurve| nodes.windows(2).map(|n| curve.point(n[0]).distance(curve.point(n[1]))).sum();
    let isos = [across.0, across.0 + 0.5 * (across.1 - across.0), across.1].map(|at| {
        let curve = surface.iso_curve(held, at).ok()?;
        let length: f64 = length(&curve);
        Some((curve, length))
    });
    let longest = isos.into_iter().flatten().reduce(|a, b| if b.1 > a.1 { b } else { a });
    match longest {
        Some((curve, length)) if length > 0.0 => {
            let done = decompose(|u| curve.point(u), &nodes, &[], steps, most);
            (done.parameters, done.evaluations + done.length_evaluations + 6 * nodes.len() as u64)
        }
        // a patch without extent in this direction
        _ => (vec![range.0, range.1], 6 * nodes.len() as u64),
    }
}
