//! Random entities and points that shrink, and land on degenerate sets often enough to matter.

use glam::DVec3;
use proptest::prelude::*;
use proptest::sample::Index;

use super::shape::{Shape, knots_of_spans};

/// Coordinates that coincide, vanish, or nearly do.
pub fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![4 => -9.0..9.0f64, 2 => Just(0.0), 1 => Just(3.0), 1 => -1e-9..1e-9f64]
}

pub fn point() -> impl Strategy<Value = DVec3> {
    (coordinate(), coordinate(), coordinate()).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

/// Lengths of knot spans: even, repeated knots, tiny spans.
fn span() -> impl Strategy<Value = f64> {
    prop_oneof![4 => Just(1.0), 2 => Just(0.0), 1 => 0.1..3.0f64, 1 => 1e-6..1e-3f64]
}

fn weight() -> impl Strategy<Value = f64> {
    prop_oneof![3 => Just(1.0), 2 => 0.2..5.0f64, 1 => Just(1e3), 1 => Just(1e-2)]
}

/// Knots of a degree whose first and last span are not empty and where no knot occurs more often than the degree.
fn knots(degree: usize, mut spans: Vec<f64>) -> Vec<f64> {
    let mut run = 1;
    let last = spans.len() - 1;
    for (i, length) in spans.iter_mut().enumerate() {
        run = if *length == 0.0 { run + 1 } else { 1 };
        if *length == 0.0 && (i == 0 || i == last || run > degree) {
            (*length, run) = (1.0, 1);
        }
    }
    knots_of_spans(degree, &spans)
}

pub fn curve() -> impl Strategy<Value = Shape> {
    (1..=5usize, 1..=5usize).prop_flat_map(|(degree, spans)| {
        let count = degree + spans;
        let points = prop::collection::vec(point(), count);
        let weights = prop::option::of(prop::collection::vec(weight(), count));
        (prop::collection::vec(span(), spans), points, weights).prop_filter_map(
            "an entity has an extent",
            move |(spans, points, weights)| {
                let shape = Shape::curve(degree, knots(degree, spans), points, weights);
                (shape.size() > 0.0).then_some(shape)
            },
        )
    })
}

pub fn surface() -> impl Strategy<Value = Shape> {
    (1..=3usize, 1..=3usize, 1..=3usize, 1..=3usize).prop_flat_map(|(p, q, across, along)| {
        let count = (p + across) * (q + along);
        let spans = (prop::collection::vec(span(), across), prop::collection::vec(span(), along));
        let points = prop::collection::vec(point(), count);
        let weights = prop::option::of(prop::collection::vec(weight(), count));
        (spans, points, weights).prop_filter_map("an entity has an extent", move |((u, v), points, weights)| {
            let shape = Shape::surface([p, q], [knots(p, u), knots(q, v)], points, weights);
            (shape.size() > 0.0).then_some(shape)
        })
    })
}

pub fn entity() -> impl Strategy<Value = Shape> {
    prop_oneof![curve(), surface()]
}

/// A query point, told by its place about an entity.
#[derive(Debug, Clone)]
pub enum Probe {
    Anywhere(DVec3),
    Far(DVec3),
    ControlPoint(Index),
    Between(Index, Index),
    On(f64, f64),
    Beside(f64, f64, DVec3),
}

pub fn probe() -> impl Strategy<Value = Probe> {
    let share = || prop_oneof![Just(0.0), Just(0.5), Just(1.0), 0.0..1.0f64];
    prop_oneof![
        4 => point().prop_map(Probe::Anywhere),
        1 => point().prop_map(Probe::Far),
        1 => any::<Index>().prop_map(Probe::ControlPoint),
        1 => (any::<Index>(), any::<Index>()).prop_map(|(i, j)| Probe::Between(i, j)),
        1 => (share(), share()).prop_map(|(u, v)| Probe::On(u, v)),
        2 => (share(), share(), point()).prop_map(|(u, v, way)| Probe::Beside(u, v, way)),
    ]
}

impl Probe {
    /// The query point for this entity.
    pub fn about(&self, shape: &Shape) -> DVec3 {
        let on = |u: f64, v: f64| {
            let at = [u, v].into_iter().enumerate().map(|(k, share)| {
                let [first, last] = shape.domain(k);
                (first + share * (last - first)).clamp(first, last)
            });
            let at: Vec<f64> = at.collect();
            shape.point(at[0], at[1])
        };
        match self {
            Self::Anywhere(p) => *p,
            Self::Far(p) => 1e3 * *p,
            Self::ControlPoint(i) => *i.get(&shape.points),
            Self::Between(i, j) => 0.5 * (*i.get(&shape.points) + *j.get(&shape.points)),
            Self::On(u, v) => on(*u, *v),
            Self::Beside(u, v, way) => on(*u, *v) + 1e-7 * *way,
        }
    }
}
