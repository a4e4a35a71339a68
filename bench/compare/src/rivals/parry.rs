//! parry: the nearest point of a polyline or mesh that stands for the entity, at a chord error. It is inexact by nature.

use std::time::{Duration, Instant};

use parry3d_f64::math::Vector;
use parry3d_f64::query::PointQuery;
use parry3d_f64::shape::{Polyline, Segment, TriMesh, Triangle};
use perpend::{DVec3, Definition, Direction, KnotVector, NurbsCurve, NurbsSurface};

use crate::Failure;
use crate::case::{Case, Set};
use crate::contender::{Answer, Ask, Contender, Entrant, Own, Pace};

/// Where within a part its distance from the chord is measured, as shares of the part.
const WITHIN: [f64; 3] = [0.25, 0.5, 0.75];

struct Parry {
    /// The chord error, as a share of the size.
    chord_error: f64,
}

pub(super) fn contenders() -> Vec<Box<dyn Contender>> {
    [1e-3, 1e-4, 1e-5].map(|chord_error| Box::new(Parry { chord_error }) as Box<dyn Contender>).into()
}

impl Contender for Parry {
    fn name(&self) -> String {
        format!("parry3d-f64 0.31, chord error {:e}", self.chord_error)
    }

    fn pace(&self, _: Set) -> Pace {
        Pace::All
    }

    fn enter(&self, case: &Case, _: &[DVec3]) -> Result<Option<Box<dyn Entrant>>, Failure> {
        let size = case.definition.size();
        let target = self.chord_error * size;
        Ok(Some(match &*case.definition {
            Definition::NurbsCurve(curve) => {
                let counts = counts(curve.knots(), target, |u| vec![curve.point(u)]);
                let parameters = divided(curve.knots(), &counts);
                let chord_error = curve_error(curve, &parameters) / size;
                let start = Instant::now();
                let points = parameters.iter().map(|u| vector(curve.point(*u))).collect();
                let shape = Polyline::new(points, None);
                Box::new(Stood { shape, setup: start.elapsed(), chord_error })
            }
            Definition::NurbsSurface(surface) => {
                let (u, v, measured) = grid(surface, target);
                let start = Instant::now();
                let (vertices, triangles) = mesh(surface, &u, &v);
                let shape = TriMesh::new(vertices, triangles)?;
                Box::new(Stood { shape, setup: start.elapsed(), chord_error: measured / size })
            }
        }))
    }
}

/// What stands for an entity.
struct Stood<S> {
    shape: S,
    /// Evaluating its vertices and making its tree; how many there must be was found before.
    setup: Duration,
    chord_error: f64,
}

impl<S: PointQuery> Ask for Stood<S> {
    fn ask(&mut self, p: DVec3) -> Option<Answer> {
        let p = vector(p);
        let distance = (self.shape.project_local_point(p, false).point - p).length();
        Some(Answer { distance, parameter: None, lower_bound: None })
    }

    fn own(&self) -> Own {
        Own { setup: Some(self.setup), chord_error: Some(self.chord_error), ..Own::default() }
    }
}

fn vector(p: DVec3) -> Vector {
    Vector::new(p.x, p.y, p.z)
}

/// `count` equal parts from `from` to `to`, without the end.
fn parts(from: f64, to: f64, count: usize) -> impl Iterator<Item = f64> {
    (0..count).map(move |i| from + (to - from) * i as f64 / count as f64)
}

/// Into how many equal parts each span is divided, as few as keep chords within `target` of all points that `across` gives for a parameter.
fn counts(knots: &KnotVector, target: f64, across: impl Fn(f64) -> Vec<DVec3>) -> Vec<usize> {
    let count = |span: perpend::kernel::Span| {
        let mut count = 1;
        loop {
            let ends: Vec<f64> = parts(span.start, span.end, count).chain([span.end]).collect();
            let worst = ends.windows(2).map(|part| chord_error(part[0], part[1], &across)).fold(0.0, f64::max);
            if worst <= target {
                return count;
            }
            let wanted = count as f64 * (worst / target).sqrt();
            count = (count + 1).max((0.98 * wanted) as usize);
        }
    };
    knots.spans().map(count).collect()
}

/// The parameters that divide each span into so many equal parts.
fn divided(knots: &KnotVector, counts: &[usize]) -> Vec<f64> {
    let spans = knots.spans().zip(counts);
    spans.flat_map(|(span, count)| parts(span.start, span.end, *count)).chain([knots.domain().1]).collect()
}

/// How far points between two parameters are from their chord, on the worst of the lines that `across` gives.
fn chord_error(from: f64, to: f64, across: &impl Fn(f64) -> Vec<DVec3>) -> f64 {
    let (first, last) = (across(from), across(to));
    let mut worst: f64 = 0.0;
    for share in WITHIN {
        let between = across(from + (to - from) * share);
        for ((a, b), p) in first.iter().zip(&last).zip(between) {
            worst = worst.max(Segment::new(vector(*a), vector(*b)).distance_to_local_point(vector(p), false));
        }
    }
    worst
}

/// The measured distance of a curve from its polyline.
fn curve_error(curve: &NurbsCurve, parameters: &[f64]) -> f64 {
    parameters.windows(2).map(|part| chord_error(part[0], part[1], &|u| vec![curve.point(u)])).fold(0.0, f64::max)
}

/// The parameters of a grid whose triangles stay within `target` of the surface, and how far they are as measured.
fn grid(surface: &NurbsSurface, target: f64) -> (Vec<f64>, Vec<f64>, f64) {
    let lines = |direction| {
        let spans = surface.knots(direction).spans();
        let mut lines: Vec<f64> = spans.flat_map(|span| parts(span.start, span.end, 4)).collect();
        lines.push(surface.domain(direction).1);
        lines
    };
    let [along_u, along_v] = [Direction::U, Direction::V].map(lines);
    let knots = [Direction::U, Direction::V].map(|direction| surface.knots(direction));
    // what both directions leave adds up
    let mut in_u = counts(knots[0], 0.5 * target, |u| along_v.iter().map(|v| surface.point(u, *v)).collect());
    let mut in_v = counts(knots[1], 0.5 * target, |v| along_u.iter().map(|u| surface.point(*u, v)).collect());
    loop {
        let (u, v) = (divided(knots[0], &in_u), divided(knots[1], &in_v));
        let measured = mesh_error(surface, &u, &v);
        if measured <= target {
            return (u, v, measured);
        }
        // a twist is left, which no chord along u or v sees: it falls with both sides of a cell
        let factor = 1.02 * (measured / target).sqrt();
        for count in in_u.iter_mut().chain(&mut in_v) {
            *count = (*count as f64 * factor).ceil() as usize;
        }
    }
}

/// The measured distance of a surface from the triangles of a grid: of points in each cell from the two triangles of that cell.
fn mesh_error(surface: &NurbsSurface, u: &[f64], v: &[f64]) -> f64 {
    let mut worst: f64 = 0.0;
    let row = |u: f64| v.iter().map(|v| vector(surface.point(u, *v))).collect::<Vec<_>>();
    let mut low = row(u[0]);
    for side_u in u.windows(2) {
        let high = row(side_u[1]);
        for (j, side_v) in v.windows(2).enumerate() {
            let [first, second] = cell([low[j], high[j], high[j + 1], low[j + 1]]);
            for share_u in WITHIN {
                for share_v in WITHIN {
                    let at = |side: &[f64], share: f64| side[0] + (side[1] - side[0]) * share;
                    let p = vector(surface.point(at(side_u, share_u), at(side_v, share_v)));
                    let distance = [first, second].map(|triangle| triangle.distance_to_local_point(p, false));
                    worst = worst.max(distance[0].min(distance[1]));
                }
            }
        }
        low = high;
    }
    worst
}

/// The two triangles of a cell, whose corners are given in turn.
fn cell([a, b, c, d]: [Vector; 4]) -> [Triangle; 2] {
    [Triangle::new(a, b, c), Triangle::new(a, c, d)]
}

fn mesh(surface: &NurbsSurface, u: &[f64], v: &[f64]) -> (Vec<Vector>, Vec<[u32; 3]>) {
    let columns = v.len();
    let vertices = u.iter().flat_map(|u| v.iter().map(|v| vector(surface.point(*u, *v)))).collect();
    let index = |i: usize, j: usize| (i * columns + j) as u32;
    let mut triangles = Vec::new();
    for i in 1..u.len() {
        for j in 1..columns {
            let [a, b, c, d] = [index(i - 1, j - 1), index(i, j - 1), index(i, j), index(i - 1, j)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    (vertices, triangles)
}
