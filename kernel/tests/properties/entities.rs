//! Random curves and surfaces that land on trouble on purpose: multiple knots, short spans, coincident points, weights a million
//! apart, tiny ones and ones far off.

use perpend_kernel::glam::DVec3;
use perpend_kernel::{Direction, NurbsCurve, NurbsSurface};
use proptest::collection::vec;
use proptest::prelude::*;

/// Clamped knots of a degree with up to four spans.
fn knots(degree: usize) -> impl Strategy<Value = Vec<f64>> {
    let width = prop_oneof![4 => 0.1..3.0_f64, 1 => Just(1.0), 1 => 1e-6..1e-5_f64];
    let start = prop_oneof![Just(0.0), Just(-3.0), Just(1000.0)];
    (start, vec((width, 1..=degree), 0..4), 0.2..2.0_f64).prop_map(move |(start, inner, last)| {
        let mut knots = vec![start; degree + 1];
        let mut at = start;
        for (width, multiplicity) in inner {
            at += width;
            knots.extend(vec![at; multiplicity]);
        }
        knots.extend(vec![at + last; degree + 1]);
        knots
    })
}

fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![6 => -1.0..1.0_f64, 1 => Just(0.0), 1 => Just(0.5)]
}

/// Where and how large an entity is: `(offset, scale)`.
fn placing() -> impl Strategy<Value = (DVec3, f64)> {
    prop_oneof![
        4 => Just((DVec3::ZERO, 1.0)),
        1 => Just((DVec3::ZERO, 1e-6)),
        1 => Just((DVec3::new(1e7, -1e7, 3e6), 1.0)),
        1 => Just((DVec3::new(0.0, 0.0, 1e7), 1e3)),
    ]
}

/// Control points, of which the first and the last always differ.
fn points(count: usize) -> impl Strategy<Value = Vec<DVec3>> {
    let point = (coordinate(), coordinate(), coordinate()).prop_map(DVec3::from);
    (vec(point, count), placing()).prop_map(|(mut points, (offset, scale))| {
        points[0].x = -1.5;
        points.iter_mut().for_each(|p| *p = offset + scale * *p);
        points
    })
}

fn weights(count: usize) -> impl Strategy<Value = Option<Vec<f64>>> {
    proptest::option::of(vec((-3.0..3.0_f64).prop_map(|e| 10.0_f64.powf(e)), count))
}

/// Any curve up to a degree.
pub(crate) fn curve(highest: usize) -> impl Strategy<Value = NurbsCurve> {
    (1..=highest)
        .prop_flat_map(|degree| (Just(degree), knots(degree)))
        .prop_flat_map(|(degree, knots)| {
            let count = knots.len() - degree - 1;
            (Just(degree), Just(knots), points(count), weights(count))
        })
        .prop_map(|(degree, knots, points, weights)| {
            NurbsCurve::new(degree, knots, points, weights).expect("the generator makes valid curves")
        })
}

/// Any surface up to a degree.
pub(crate) fn surface(highest: usize) -> impl Strategy<Value = NurbsSurface> {
    (1..=highest, 1..=highest)
        .prop_flat_map(|(p, q)| (Just((p, q)), knots(p), knots(q)))
        .prop_flat_map(|((p, q), u, v)| {
            let count = (u.len() - p - 1) * (v.len() - q - 1);
            (Just((p, q)), Just((u, v)), points(count), weights(count))
        })
        .prop_map(|(degree, knots, points, weights)| {
            let columns = knots.1.len() - degree.1 - 1;
            let points = points.chunks(columns).map(<[DVec3]>::to_vec).collect();
            let weights = weights.map(|w| w.chunks(columns).map(<[f64]>::to_vec).collect());
            NurbsSurface::new(degree, knots, points, weights).expect("the generator makes valid surfaces")
        })
}

/// A direction of a surface.
pub(crate) fn direction() -> impl Strategy<Value = Direction> {
    prop_oneof![Just(Direction::U), Just(Direction::V)]
}

/// Parameters all over a domain: ends, knots, and between.
pub(crate) fn parameters(knots: &perpend_kernel::KnotVector) -> Vec<f64> {
    let mut parameters: Vec<f64> = knots.distinct().map(|(knot, _)| knot).collect();
    for span in knots.spans() {
        parameters.extend([0.01, 0.3, 0.5, 0.77].map(|t| span.start + t * (span.end - span.start)));
    }
    parameters
}

/// A parameter strictly inside a domain, by a fraction; some of them knots.
pub(crate) fn inner(knots: &perpend_kernel::KnotVector, fraction: f64) -> f64 {
    let breaks: Vec<f64> = knots.breaks().map(|b| b.at).collect();
    if fraction > 0.8 && !breaks.is_empty() {
        return breaks[breaks.len() / 2];
    }
    let (first, last) = knots.domain();
    first + (0.01 + fraction * 0.98) * (last - first)
}

/// The rounding that evaluation and an edit of a few steps may show: convex combinations of `degree` steps, twenty roundings each,
/// of the largest coordinate.
pub(crate) fn rounding(degree: usize, points: &[DVec3]) -> f64 {
    let reach = points.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
    20.0 * (degree + 1) as f64 * f64::EPSILON * reach
}
