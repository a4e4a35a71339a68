//! Free-form profiles that are moved along a vector or turned about an axis: by one parameter, that of the profile.

use std::f64::consts::TAU;

use glam::DVec3;
use perpend::{Model, Multiplicity};

use super::case::{Case, Tally};
use super::probes::{Probe, probes};
use crate::common::disguise::disguised;
use crate::common::exact::Exact;
use crate::common::random::Random;
use crate::common::shape::{Shape, knots_of_spans};

/// The share of these queries that the reduction must answer: it leaves a profile that it cannot invert to the certified solver.
fn most(_: &str) -> f64 {
    0.7
}

/// A wavy profile in the half plane of `x` and `z` through `centre`, well off the axis unless it starts on it.
fn profile(random: &mut Random, [x, z]: [DVec3; 2], centre: DVec3, scale: f64, from_axis: bool) -> Shape {
    let (degree, spans) = (random.count(2, 4), random.count(1, 4));
    let count = degree + spans;
    let mut points: Vec<DVec3> = (0..count)
        .map(|i| {
            let height = i as f64 / (count - 1) as f64 * 2.0 - 1.0;
            centre + scale * (random.between(0.3, 1.5) * x + (height + 0.2 * random.between(-1.0, 1.0)) * z)
        })
        .collect();
    if from_axis {
        points[0] = centre - scale * z;
    }
    // by chance a kink at an inner knot
    let mut lengths = vec![1.0; spans];
    if spans > degree && random.chance(0.5) {
        lengths[1..degree].fill(0.0);
    }
    let weights = random.chance(0.5).then(|| (0..count).map(|_| random.between(0.3, 3.0)).collect());
    Shape::curve(degree, knots_of_spans(degree, &lengths), points, weights)
}

fn model(random: &mut Random, exact: &Exact) -> Model {
    let plain = exact.made().0;
    let definition = if random.chance(0.5) { disguised(random, &plain) } else { plain };
    let mut model = Model::new();
    model.insert("profile", definition).expect("valid");
    model
}

fn place(random: &mut Random) -> ([DVec3; 3], DVec3, f64) {
    let frame = if random.chance(0.5) { [DVec3::X, DVec3::Y, DVec3::Z] } else { random.frame() };
    let scale = random.pick(&[1.0, 1.0, 1e-3, 1e6]);
    let centre = scale * random.pick(&[0.0, 1.0, 1e3]) * random.direction();
    (frame, centre, scale)
}

#[test]
fn extrusions_are_answered_to_the_last_digits() {
    let mut random = Random::new(43_001);
    let mut tally = Tally::default();
    for round in 0..16 {
        let ([x, y, z], centre, scale) = place(&mut random);
        let from_axis = random.chance(0.2);
        let profile = profile(&mut random, [x, z], centre, scale, from_axis);
        let skew = random.pick(&[0.0, 0.0, 0.7, -2.0]);
        let vector = scale * random.pick(&[1.0, 0.1, 20.0]) * (y + skew * x);
        let exact = Exact::Extrusion { profile, vector };
        let case = Case::new(&exact, format!("round {round}"), model(&mut random, &exact));
        case.ask(&probes(&[], &case.shape, 40, &mut random), &mut tally);
    }
    tally.settle(most);
}

#[test]
fn revolutions_are_answered_to_the_last_digits() {
    let mut random = Random::new(43_002);
    let mut tally = Tally::default();
    for round in 0..16 {
        let ([x, _, z], centre, scale) = place(&mut random);
        let from_axis = random.chance(0.3);
        let profile = profile(&mut random, [x, z], centre, scale, from_axis);
        let sweep = random.pick(&[TAU, TAU, 0.05, 1.0, 3.0, 5.0]);
        // from a point of the axis, whole circles are as near, unless the profile's end on the axis is nearer still
        let on_axis = [-4.0, -1.0, 0.0, 0.3, 2.0].map(|height| Probe {
            point: centre + scale * height * z,
            multiplicity: (!from_axis).then_some(Multiplicity::Continuum),
        });
        let exact = Exact::Revolution { profile, origin: centre, axis: z, sweep };
        let case = Case::new(&exact, format!("round {round}"), model(&mut random, &exact));
        case.ask(&probes(&on_axis, &case.shape, 40, &mut random), &mut tally);
    }
    tally.settle(most);
}
