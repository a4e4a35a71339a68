//! The oracle is held to closed forms, to the proven distances of the test sets, to samples; and the exact evaluation that it
//! stands on is held to the kernel's.

mod common;

use common::adversaries::{KINDS, adversary, circle_arc, sphere_zone, torus_part};
use common::corpus;
use common::double_double::Dd;
use common::judgement::is_false_bound;
use common::oracle::{Oracle, TOLERANCE};
use common::points::{hard_points, parameter};
use common::random::Random;
use common::shape::{Shape, bezier_knots};
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Query points on, near and far from a shape of about unit size, on the planes and axes of its symmetry as well.
fn points(seed: u64) -> Vec<DVec3> {
    let mut random = Random::new(seed);
    let coordinate = |random: &mut Random| match random.count(0, 5) {
        0 => 0.0,
        1 => random.sign() * random.power(-12.0, -3.0),
        2 => random.sign(),
        _ => random.between(-3.0, 3.0),
    };
    let mut points: Vec<DVec3> = (0..400).map(|_| DVec3::from_array([0; 3].map(|_| coordinate(&mut random)))).collect();
    points.extend((0..100).map(|_| random.power(0.5, 3.0) * random.direction()));
    points
}

/// Fails where the oracle's distance is not `truth`, but for the tolerance at which it stops and the rounding of both the control
/// points and the closed form.
fn agrees(shape: Shape, truth: impl Fn(DVec3) -> f64) {
    let oracle = Oracle::new(shape);
    for p in points(7) {
        let (found, truth) = (oracle.nearest(p), truth(p));
        let off = (found.distance - truth).abs();
        assert!(
            off <= 2.0 * TOLERANCE * oracle.size + 2e-15 * truth,
            "{p}: {found:?}, true distance {truth:e}, off by {off:e}"
        );
    }
}

/// The distance from `(x, y)` to the circle of this radius about the origin, or its arc from the angle 0.
fn to_arc(radius: f64, sweep: f64, x: f64, y: f64) -> f64 {
    let angle = y.atan2(x).rem_euclid(TAU);
    if angle <= sweep || sweep == TAU {
        return (x.hypot(y) - radius).abs();
    }
    let (end_x, end_y) = (radius * sweep.cos(), radius * sweep.sin());
    (x - radius).hypot(y).min((x - end_x).hypot(y - end_y))
}

#[test]
fn circles_and_arcs_agree_with_their_closed_form() {
    for (radius, sweep) in [(1.0, TAU), (0.5, TAU), (1.5, FRAC_PI_2), (1.0, 2.5), (1.0, 5.0)] {
        agrees(circle_arc(radius, sweep), |p| to_arc(radius, sweep, p.x, p.y).hypot(p.z));
    }
}

#[test]
fn segments_and_rectangles_agree_with_their_closed_form() {
    let (a, b) = (DVec3::new(-1.0, 0.5, 0.0), DVec3::new(1.0, 1.0, 2.0));
    let segment = |p: DVec3| {
        let share = (p - a).dot(b - a) / (b - a).length_squared();
        (a + share.clamp(0.0, 1.0) * (b - a) - p).length()
    };
    agrees(Shape::curve(1, bezier_knots(1), vec![a, b], None), segment);
    // the same segment, run through there and back by a cubic
    agrees(Shape::curve(3, bezier_knots(3), vec![a, b, a, b], None), segment);
    let corners = [(-1.0, -2.0), (-1.0, 2.0), (1.0, -2.0), (1.0, 2.0)].map(|(x, y)| DVec3::new(x, y, 0.0));
    agrees(Shape::surface([1, 1], [bezier_knots(1), bezier_knots(1)], corners.to_vec(), None), |p| {
        (p - p.clamp(DVec3::new(-1.0, -2.0, 0.0), DVec3::new(1.0, 2.0, 0.0))).length()
    });
}

#[test]
fn spheres_and_tori_agree_with_their_closed_form() {
    agrees(sphere_zone(PI, TAU), |p| (p.length() - 1.0).abs());
    for latitudes in [FRAC_PI_2, 2.0] {
        // in the half plane of the query point: an arc from the south pole
        agrees(sphere_zone(latitudes, TAU), |p| to_arc(1.0, latitudes, -p.z, p.x.hypot(p.y)));
    }
    for (major, minor) in [(1.0, 0.25), (1.0, 1.0)] {
        agrees(torus_part(major, minor, TAU, TAU), |p| ((p.x.hypot(p.y) - major).hypot(p.z) - minor).abs());
    }
}

/// The distance from `(x, y)` to the ellipse of half axes 1 and `b` < 1: the root of the foot's equation, by bisection.
fn to_ellipse(b: f64, x: f64, y: f64) -> f64 {
    let (x, y) = (x.abs(), y.abs());
    if y == 0.0 && x < 1.0 - b * b {
        // inside the evolute on the long axis: two feet off the axis
        let cosine = x / (1.0 - b * b);
        return (x - cosine).hypot(b * (1.0 - cosine * cosine).sqrt());
    }
    // foot (x / (s + 1 - b²), b² y / s); the root s lies between these
    let (mut low, mut high) = (b * y, x.hypot(b * y) + b * b);
    for _ in 0..200 {
        let s = 0.5 * (low + high);
        if (x / (s + 1.0 - b * b)).hypot(b * y / s) > 1.0 { low = s } else { high = s }
    }
    let s = 0.5 * (low + high);
    // (s - b²) times the gradient of the ellipse's equation
    (s - b * b).abs() * (x / (s + 1.0 - b * b)).hypot(y / s)
}

#[test]
fn ellipses_agree_with_the_root_of_the_foots_equation() {
    for b in [0.7, 0.1] {
        let shape = circle_arc(1.0, TAU).mapped(|p| DVec3::new(p.x, b * p.y, 0.0));
        let oracle = Oracle::new(shape);
        for p in points(3) {
            let (found, truth) = (oracle.nearest(p).distance, to_ellipse(b, p.x, p.y).hypot(p.z));
            assert!((found - truth).abs() <= 2e-12 + 2e-15 * truth, "b = {b}, {p}: {found:e}, true {truth:e}");
        }
    }
}

#[test]
fn the_proven_distances_of_the_test_sets_are_found() {
    for set in ["seeds-curves", "seeds-surfaces", "quadrics", "circles-table1"] {
        let rows = corpus::rows(&corpus::data().join(format!("{set}.truth.csv")));
        for entry in corpus::entities(&corpus::data().join(format!("{set}.json"))) {
            let oracle = Oracle::new(entry.shape);
            for row in rows.iter().filter(|row| row.entity == entry.id).step_by(3) {
                let (found, truth) = (oracle.nearest(row.point).distance, row.distance());
                let off = (found - truth).abs();
                assert!(
                    off <= 2.0 * TOLERANCE * oracle.size + 2e-15 * truth,
                    "{set} {} at {}: off by {off:e}",
                    entry.name,
                    row.point
                );
            }
        }
    }
}

#[test]
fn no_sample_of_a_hard_entity_is_nearer_than_the_oracles_point() {
    for kind in 0..KINDS.len() {
        let mut random = Random::new(kind as u64);
        let adversary = adversary(kind, &mut random);
        let oracle = Oracle::new(adversary.shape.clone());
        let parameters: Vec<[f64; 2]> =
            (0..150).map(|_| [0, 1].map(|k| parameter(&adversary.shape, k, &mut random))).collect();
        let samples: Vec<DVec3> = parameters.iter().map(|[u, v]| adversary.shape.point(*u, *v)).collect();
        for p in hard_points(&adversary, 60, &mut random) {
            let found = oracle.nearest(p);
            let nearest = samples.iter().map(|s| (*s - p).length()).fold(f64::INFINITY, f64::min);
            let rounding = 4.0 * f64::EPSILON * (adversary.shape.reach() + nearest);
            let allowed = nearest + 2.0 * TOLERANCE * oracle.size + rounding;
            assert!(found.distance <= allowed, "{} at {p}: {found:?}, a sample at {nearest:e}", adversary.kind);
        }
    }
}

#[test]
fn a_bound_too_high_by_a_trillionth_of_the_size_is_convicted() {
    let oracle = Oracle::new(circle_arc(1.0, TAU));
    for p in points(11) {
        let (truth, found) = (to_arc(1.0, TAU, p.x, p.y).hypot(p.z), oracle.nearest(p).distance);
        let margin = 2.0 * TOLERANCE * oracle.size + 4e-15 * truth;
        assert!(is_false_bound(truth + 1e-12 * oracle.size + margin, found, oracle.size), "{p}");
        assert!(!is_false_bound(truth - margin, found, oracle.size), "{p}");
    }
    assert!(is_false_bound(f64::NAN, 1.0, 1.0));
}

#[test]
fn the_exact_evaluation_agrees_with_the_kernels() {
    for (kind, (name, _)) in KINDS.iter().enumerate() {
        let mut random = Random::new(100 + kind as u64);
        let shape = adversary(kind, &mut random).shape;
        let definition = shape.definition();
        assert_eq!(Shape::of(&definition), shape, "read back");
        for _ in 0..40 {
            let [u, v] = [0, 1].map(|k| parameter(&shape, k, &mut random));
            let kernel = match &definition {
                perpend_kernel::Definition::NurbsCurve(curve) => curve.point(u),
                perpend_kernel::Definition::NurbsSurface(surface) => surface.point(u, v),
            };
            let off = (kernel - shape.point(u, v)).length();
            let degrees = (shape.degree[0] + shape.degree[1]) as f64;
            let allowed = 8.0 * degrees * f64::EPSILON * shape.reach();
            assert!(off <= allowed, "{name}: {off:e} apart, {allowed:e} promised");
        }
    }
}

#[test]
fn edits_of_the_tests_leave_the_entity_where_it_is() {
    for (kind, (name, _)) in KINDS.iter().enumerate() {
        let mut random = Random::new(200 + kind as u64);
        let shape = adversary(kind, &mut random).shape;
        let [first, last] = shape.domain(0);
        let knot = random.between(first, last);
        let inserted = shape.with_knot(knot);
        let (reversed, swapped) = (shape.clone().reversed(), shape.clone().swapped());
        let allowed = 16.0 * f64::EPSILON * shape.reach();
        for _ in 0..20 {
            let [u, v] = [0, 1].map(|k| parameter(&shape, k, &mut random));
            let point = shape.point(u, v);
            assert!((inserted.point(u, v) - point).length() <= allowed, "knot {knot} in {name}");
            assert_eq!(swapped.point(v, u), point, "swapped {name}");
            let back = Dd::difference(first, u) + Dd::from(last);
            let [x, y, z] = reversed.seen_from(point, back, v.into()).map(Dd::value);
            let grain = common::adversaries::grain(&shape);
            assert!(DVec3::new(x, y, z).length() <= allowed + 4.0 * grain, "reversed {name}");
        }
        if shape.rows == shape.degree[0] + 1 {
            let v = parameter(&shape, 1, &mut random);
            let apart = shape.elevated().point(knot, v) - shape.point(knot, v);
            assert!(apart.length() <= allowed, "elevated {name}");
        }
    }
}

#[test]
fn double_doubles_hold_thirty_digits() {
    let third = Dd::ONE / Dd::from(3.0);
    assert_eq!(third * Dd::from(3.0), Dd::ONE);
    let root = Dd::from(2.0).sqrt();
    assert!((root * root - Dd::from(2.0)).value().abs() < 1e-30);
    let tiny = Dd::difference(1.0, -1e-25);
    assert!(((tiny - Dd::ONE).value() - 1e-25).abs() < 1e-40);
    assert!(Dd::ONE < tiny);
}
