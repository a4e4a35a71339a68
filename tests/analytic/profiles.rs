//! Free-form profiles that are moved along a vector or turned about an axis: by one parameter, that of the profile.

use std::f64::consts::{PI, TAU};

use glam::DVec3;
use perpend::{Frame, Model, Multiplicity};

use super::case::{Case, Tally};
use super::probes::{Probe, probes};
use crate::common::disguise::disguised;
use crate::common::exact::Exact;
use crate::common::random::Random;
use crate::common::shape::{Shape, bezier_knots, knots_of_spans};

/// The share of these queries that the reduction must answer: it leaves to the certified solver a profile that it cannot invert, and
/// extrusions that are not at right angles to their profile.
fn most(class: &str) -> f64 {
    if class == "Extrusion" { 0.2 } else { 0.9 }
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

/// An arc of a circle in the half plane of `x` and `z`, about `centre`, over a range of angles from `x` towards `z`.
fn arc(centre: DVec3, radius: f64, range: (f64, f64)) -> Shape {
    let frame = Frame::new(centre, -DVec3::Y, DVec3::X).expect("a frame");
    Shape::of(&Exact::Circle { frame, radius, sweep: range }.made().0)
}

fn asked(exact: &Exact, what: &str, count: usize, random: &mut Random, tally: &mut Tally) {
    let on_axis = |height: f64| Probe { point: height * DVec3::Z, multiplicity: None };
    let axis: Vec<Probe> = [-3.0, -0.5, 0.0, 0.7, 1.0, 5.0].map(on_axis).to_vec();
    for disguise in [false, true] {
        let plain = exact.made().0;
        let definition = if disguise { disguised(random, &plain) } else { plain };
        let mut model = Model::new();
        model.insert(what, definition).expect("valid");
        let case = Case::new(exact, what.to_owned(), model);
        case.ask(&probes(&axis, &case.shape, count, random), tally);
    }
}

/// Tori whose tube is wider than its circle: apples and lemons, up to the axis, across it, and parts.
#[test]
fn spindles_are_answered_to_the_last_digits() {
    let mut random = Random::new(43_003);
    let mut tally = Tally::default();
    let tip = (0.5_f64).acos();
    for (what, major, range) in [
        ("an apple", 0.5, (-PI + tip, PI - tip)),
        ("a part of an apple", 0.5, (-1.0, 2.0)),
        ("a lemon", -0.5, (-tip, tip)),
        ("a part of a lemon", -0.5, (-0.3, 0.9)),
        ("a spindle across its axis", 0.5, (0.0, TAU)),
        ("a ball off its centre", 1e-3, (-1.0, 1.0)),
    ] {
        for sweep in [TAU, 2.0, 0.02] {
            let profile = arc(major * DVec3::X, 1.0, range);
            let exact = Exact::Revolution { profile, origin: DVec3::ZERO, axis: DVec3::Z, sweep };
            asked(&exact, &format!("{what} over {sweep}"), 12, &mut random, &mut tally);
        }
    }
    tally.settle(|_| 0.0);
}

/// Lines and arcs that do not lie in a plane with the axis: hyperboloids, discs, cylinders and cones met from aside.
#[test]
fn skew_profiles_are_answered_to_the_last_digits() {
    let mut random = Random::new(43_004);
    let mut tally = Tally::default();
    let line = |a: DVec3, b: DVec3| Shape::of(&Exact::Segment { a, b }.made().0);
    let aside = Frame::new(DVec3::new(1.0, 0.5, 0.2), DVec3::new(1.0, 1.0, 0.3), DVec3::Z).expect("a frame");
    for (what, profile) in [
        ("a hyperboloid", line(DVec3::new(1.0, -1.0, -1.0), DVec3::new(1.0, 1.0, 1.0))),
        ("half a hyperboloid", line(DVec3::new(1.0, 0.0, 0.0), DVec3::new(1.0, 2.0, 1.0))),
        ("a disc by a radius", line(DVec3::ZERO, DVec3::new(2.0, 0.0, 0.0))),
        ("a ring by a chord", line(DVec3::new(1.0, -1.0, 0.5), DVec3::new(1.0, 1.0, 0.5))),
        ("a double cone", line(DVec3::new(-1.0, 0.0, -1.0), DVec3::new(1.0, 0.0, 1.0))),
        ("an arc from aside", Shape::of(&Exact::Circle { frame: aside, radius: 0.7, sweep: (0.0, 4.0) }.made().0)),
        ("a circle from aside", Shape::of(&Exact::Circle { frame: aside, radius: 0.4, sweep: (0.0, TAU) }.made().0)),
    ] {
        for sweep in [TAU, 2.5, 0.05] {
            let exact = Exact::Revolution { profile: profile.clone(), origin: DVec3::ZERO, axis: DVec3::Z, sweep };
            asked(&exact, &format!("{what} over {sweep}"), 12, &mut random, &mut tally);
        }
    }
    tally.settle(|_| 0.0);
}

/// Profiles that are closed, cross themselves, run along the vector, or leave every plane.
#[test]
fn extrusions_of_hard_profiles_are_answered_to_the_last_digits() {
    let mut random = Random::new(43_005);
    let mut tally = Tally::default();
    let cubic = |points: [[f64; 3]; 4]| Shape::curve(3, bezier_knots(3), points.map(DVec3::from_array).to_vec(), None);
    let frame = Frame::WORLD;
    let circle = |sweep| Shape::of(&Exact::Circle { frame, radius: 1.0, sweep }.made().0);
    let ellipse = Shape::of(&Exact::Ellipse { frame, radii: (2.0, 0.3), sweep: (0.0, TAU) }.made().0);
    for (what, profile) in [
        ("a circle", circle((0.0, TAU))),
        ("an arc", circle((1.0, 2.5))),
        ("an ellipse", ellipse),
        ("a loop", cubic([[-1.0, 0.0, 0.0], [3.0, 1.0, 0.0], [-3.0, 1.0, 0.0], [1.0, 0.0, 0.0]])),
        ("a cusp", cubic([[-1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0], [1.0, 0.0, 0.0]])),
        ("a twisted cubic", cubic([[0.0, 0.0, 0.0], [1.0, 0.0, 1.0], [1.0, 1.0, -1.0], [0.0, 1.0, 2.0]])),
        ("a curve that rises", cubic([[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 2.0], [1.0, 0.5, 2.0]])),
        ("a line there and back", cubic([[0.0, 0.0, 0.0], [2.0, 1.0, 0.0], [-1.0, -0.5, 0.0], [1.0, 0.5, 0.0]])),
    ] {
        for vector in [DVec3::Z, DVec3::new(0.7, 0.2, 1.0), DVec3::new(1.0, 0.3, 1e-3), 1e-3 * DVec3::Z] {
            let exact = Exact::Extrusion { profile: profile.clone(), vector };
            asked(&exact, &format!("{what} along {vector}"), 12, &mut random, &mut tally);
        }
    }
    tally.settle(|_| 0.0);
}
