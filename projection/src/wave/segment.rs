//! The boxes of sub-curves and sub-patches.

use glam::DVec4;
use perpend_kernel::bezier::{Extraction, extraction};
use perpend_kernel::{Aabb, Direction, KnotVector, NurbsCurve, NurbsSurface, Span, cartesian};

/// A box is widened by this share of the largest |coordinate|: what rounding leaves between a point and the control points around it.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// A polynomial part of a segment, with the matrix that takes its control points from those of the definition.
struct Part {
    segment: usize,
    /// The first control point that it needs.
    first: usize,
    /// Row `m` gives Bézier point `m`: shares of the control points, none negative.
    matrix: Extraction,
}

/// The parts of the segments between neighbouring parameters: cut at every parameter and at every knot.
fn parts(knots: &KnotVector, parameters: &[f64]) -> impl Iterator<Item = Part> {
    let ends = parameters.windows(2).enumerate();
    ends.flat_map(move |(segment, ends)| {
        let slice = knots.as_slice();
        let inner = &slice[slice.partition_point(|k| *k <= ends[0])..slice.partition_point(|k| *k < ends[1])];
        let mut at = vec![ends[0]];
        at.extend_from_slice(inner);
        at.push(ends[1]);
        at.dedup();
        let cut = move |pair: &[f64]| {
            let span = Span { index: knots.find_span(pair[0]), start: pair[0], end: pair[1] };
            Part { segment, first: span.index - knots.degree(), matrix: extraction(knots, span) }
        };
        at.windows(2).map(cut).collect::<Vec<_>>()
    })
}

/// The boxes of a curve's segments between neighbouring parameters: each holds its segment.
pub(super) fn curve_boxes(curve: &NurbsCurve, parameters: &[f64]) -> Vec<Aabb> {
    let net = curve.homogeneous_points();
    let mut boxes = vec![Aabb::EMPTY; parameters.len() - 1];
    for part in parts(curve.knots(), parameters) {
        let points = part.matrix.rows().map(|row| cartesian(combine(row, |k| net[part.first + k])));
        boxes[part.segment] = boxes[part.segment].join(Aabb::around(points));
    }
    widened(boxes)
}

/// The boxes of a surface's patches between neighbouring parameters, those along v innermost: each holds its patch.
pub(super) fn surface_boxes(surface: &NurbsSurface, u: &[f64], v: &[f64]) -> Vec<Aabb> {
    let (net, columns) = (surface.homogeneous_points(), surface.columns());
    let along: Vec<Part> = parts(surface.knots(Direction::V), v).collect();
    let mut boxes = vec![Aabb::EMPTY; (u.len() - 1) * (v.len() - 1)];
    let mut strip: Vec<DVec4> = Vec::new();
    for across in parts(surface.knots(Direction::U), u) {
        strip.clear();
        for row in across.matrix.rows() {
            strip.extend((0..columns).map(|j| combine(row, |i| net[(across.first + i) * columns + j])));
        }
        for part in &along {
            let bounds = &mut boxes[across.segment * (v.len() - 1) + part.segment];
            for line in strip.chunks(columns) {
                let points = part.matrix.rows().map(|row| cartesian(combine(row, |j| line[part.first + j])));
                *bounds = bounds.join(Aabb::around(points));
            }
        }
    }
    widened(boxes)
}

fn combine(row: &[f64], point: impl Fn(usize) -> DVec4) -> DVec4 {
    row.iter().enumerate().fold(DVec4::ZERO, |sum, (k, share)| sum + *share * point(k))
}

fn widened(mut boxes: Vec<Aabb>) -> Vec<Aabb> {
    let reach = boxes.iter().fold(0.0_f64, |reach, bounds| reach.max(bounds.reach()));
    for bounds in &mut boxes {
        bounds.min -= ROUNDING * reach;
        bounds.max += ROUNDING * reach;
    }
    boxes
}
