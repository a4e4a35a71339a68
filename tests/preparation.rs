//! Cleaning gives back what refinement hid and changes nothing else; purging stays within the tolerance that was named, and its
//! proof within reach of what points show.

mod common;

use common::random::Random;
use glam::DVec3;
use perpend::knowledge::{PreparedDefinition, clean, purge};
use perpend::{Cleaning, Definition, Direction, NurbsCurve, NurbsSurface};

/// Clamped knots with random interior ones, up to `most` of them.
fn knots(random: &mut Random, degree: usize, most: usize) -> Vec<f64> {
    let mut all = vec![0.0; degree + 1];
    let mut at = 0.0;
    let mut left = random.count(0, most);
    while left > 0 {
        at += random.between(0.3, 2.0);
        let multiplicity = if random.chance(0.8) { 1 } else { random.count(1, degree.min(left)) };
        all.extend(vec![at; multiplicity]);
        left -= multiplicity;
    }
    at += random.between(0.3, 2.0);
    all.extend(vec![at; degree + 1]);
    all
}

fn weights(random: &mut Random, count: usize) -> Vec<f64> {
    (0..count).map(|_| random.power(-0.7, 0.7)).collect()
}

fn curve(random: &mut Random, degree: usize, most: usize) -> NurbsCurve {
    let knots = knots(random, degree, most);
    let count = knots.len() - degree - 1;
    let (offset, scale) = (random.power(-1.0, 2.0) * random.in_cube(), random.power(-1.0, 2.0));
    let points = (0..count).map(|_| offset + scale * random.in_cube()).collect();
    let weights = random.chance(0.5).then(|| weights(random, count));
    NurbsCurve::new(degree, knots, points, weights).expect("valid")
}

fn surface(random: &mut Random, degree: (usize, usize), most: usize) -> NurbsSurface {
    let (u, v) = (knots(random, degree.0, most), knots(random, degree.1, most));
    let (rows, columns) = (u.len() - degree.0 - 1, v.len() - degree.1 - 1);
    let points = (0..rows).map(|_| (0..columns).map(|_| random.in_cube()).collect()).collect();
    let weights = random.chance(0.5).then(|| (0..rows).map(|_| weights(random, columns)).collect());
    NurbsSurface::new(degree, (u, v), points, weights).expect("valid")
}

/// The curve with control points on a wave, up to some noise: more than it needs within a tolerance.
fn wavy(random: &mut Random, curve: &NurbsCurve, noise: f64) -> NurbsCurve {
    let points = (0..curve.control_points().len()).map(|k| 0.3 * k as f64);
    let points = points.map(|t| DVec3::new(t, t.sin(), (0.7 * t).cos()) + noise * random.in_cube());
    let weights = curve.weights().map(|w| (0..w.len()).map(|k| 1.5 + (0.2 * k as f64).sin()).collect());
    NurbsCurve::new(curve.degree(), curve.knots().as_slice().to_vec(), points.collect(), weights).expect("valid")
}

/// The same of a surface.
fn hilly(random: &mut Random, surface: &NurbsSurface, noise: f64) -> NurbsSurface {
    let (rows, columns) = (surface.rows(), surface.columns());
    let height = |i: usize, j: usize| (0.3 * i as f64).sin() * (0.25 * j as f64).cos();
    let mut point =
        |i: usize, j: usize| DVec3::new(0.3 * i as f64, 0.3 * j as f64, height(i, j)) + noise * random.in_cube();
    let points = (0..rows).map(|i| (0..columns).map(|j| point(i, j)).collect()).collect();
    let weight = |i: usize, j: usize| 1.5 + (0.2 * (i + j) as f64).sin();
    let weights = surface.weights().map(|_| (0..rows).map(|i| (0..columns).map(|j| weight(i, j)).collect()).collect());
    let [u, v] = [Direction::U, Direction::V].map(|direction| surface.knots(direction).as_slice().to_vec());
    NurbsSurface::new(surface.degree(), (u, v), points, weights).expect("valid")
}

/// A parameter inside the domain, away from the knots.
fn inside(random: &mut Random, knots: &perpend::KnotVector) -> f64 {
    let spans: Vec<_> = knots.spans().collect();
    let span = random.pick(&spans);
    span.start + (span.end - span.start) * random.between(0.25, 0.75)
}

/// Parameters all over a domain, and on and beside every knot.
fn parameters(knots: &perpend::KnotVector, a_span: usize) -> Vec<f64> {
    let mut all: Vec<f64> = knots.distinct().map(|(knot, _)| knot).collect();
    for span in knots.spans() {
        all.extend((1..a_span).map(|k| span.start + (span.end - span.start) * k as f64 / a_span as f64));
    }
    all
}

/// The largest distance between points at equal parameters: an oracle from below, by dense sampling.
fn apart(a: &Definition, b: &Definition, a_span: usize) -> f64 {
    match (a, b) {
        (Definition::NurbsCurve(a), Definition::NurbsCurve(b)) => {
            parameters(a.knots(), a_span).into_iter().map(|u| a.point(u).distance(b.point(u))).fold(0.0, f64::max)
        }
        (Definition::NurbsSurface(a), Definition::NurbsSurface(b)) => {
            let along = [Direction::U, Direction::V].map(|direction| parameters(a.knots(direction), a_span));
            let all = along[0].iter().flat_map(|u| along[1].iter().map(move |v| (*u, *v)));
            all.map(|(u, v)| a.point(u, v).distance(b.point(u, v))).fold(0.0, f64::max)
        }
        _ => f64::INFINITY,
    }
}

/// The rounding of evaluating a definition twice.
fn evaluation(definition: &Definition) -> f64 {
    256.0 * f64::EPSILON * (definition.reach() + definition.size())
}

/// Degrees and counts of control points.
fn form(definition: &Definition) -> [usize; 4] {
    match definition {
        Definition::NurbsCurve(curve) => [curve.degree(), 0, curve.control_points().len(), 1],
        Definition::NurbsSurface(surface) => {
            let (p, q) = surface.degree();
            [p, q, surface.rows(), surface.columns()]
        }
    }
}

/// Panics where cleaning did not give back a form, or moved points farther than it says, or than rounding.
fn gives_back(plain: &Definition, hidden: &Definition, what: &str) {
    let PreparedDefinition { definition, steps, deviation } = clean(hidden);
    assert_eq!(form(&definition), form(plain), "{what}: {steps:?}");
    assert_eq!(steps.is_empty(), definition == *hidden, "{what}: {steps:?}");
    let seen = apart(hidden, &definition, 5);
    assert!(seen <= deviation + evaluation(plain), "{what}: {seen:e} seen, {deviation:e} proven");
    // a few hundred ε an order and a step: rounding of up to thirty refinements, and of their proof
    assert!(deviation <= 1e-11 * plain.reach(), "{what}: {deviation:e} of {:e}", plain.reach());
}

#[test]
fn refined_curves_are_cleaned_to_what_they_were() {
    let mut random = Random::new(31_001);
    for round in 0..400 {
        let degree = 1 + round % 8;
        let plain = curve(&mut random, degree, 6);
        let mut refined = plain.clone();
        for _ in 0..random.count(1, 12) {
            refined = refined.refine(&[inside(&mut random, refined.knots())]).expect("inside");
        }
        gives_back(&plain.into(), &refined.into(), &format!("round {round}, degree {degree}"));
    }
}

#[test]
fn elevated_curves_are_cleaned_to_what_they_were() {
    let mut random = Random::new(31_002);
    for round in 0..200 {
        let (degree, by) = (1 + round % 6, 1 + round % 5);
        let plain = curve(&mut random, degree, 4);
        let mut raised = plain.elevate_degree(by).expect("a degree within the limit");
        for _ in 0..random.count(0, 4) {
            raised = raised.refine(&[inside(&mut random, raised.knots())]).expect("inside");
        }
        gives_back(&plain.into(), &raised.into(), &format!("round {round}, degree {degree} by {by}"));
    }
}

#[test]
fn the_highest_degrees_are_cleaned() {
    let mut random = Random::new(31_003);
    for degree in [1, 2, 3, 7, 12, 20] {
        let plain = curve(&mut random, degree, 0);
        let raised = plain.elevate_degree(25 - degree).expect("degree 25");
        gives_back(&plain.clone().into(), &raised.into(), &format!("degree {degree} raised to 25"));
    }
    for degree in 1..=25 {
        let plain = curve(&mut random, degree, 0);
        let (first, last) = plain.domain();
        let middle = 0.5 * (first + last);
        let refined = plain.insert_knot(middle, degree).expect("inside");
        gives_back(&plain.into(), &refined.into(), &format!("degree {degree}, parted"));
    }
}

#[test]
fn refined_and_elevated_surfaces_are_cleaned_to_what_they_were() {
    let mut random = Random::new(31_004);
    for round in 0..60 {
        let degree = (1 + round % 4, 1 + (round / 4) % 3);
        let plain = surface(&mut random, degree, 4);
        let mut hidden = plain.clone();
        for direction in [Direction::U, Direction::V] {
            hidden = hidden.elevate_degree(direction, random.count(0, 2)).expect("a degree within the limit");
            for _ in 0..random.count(0, 5) {
                let at = inside(&mut random, hidden.knots(direction));
                hidden = hidden.insert_knot(direction, at, 1).expect("inside");
            }
        }
        gives_back(&plain.into(), &hidden.into(), &format!("round {round}, degree {degree:?}"));
    }
}

#[test]
fn equal_weights_are_dropped_and_others_kept() {
    let mut random = Random::new(31_005);
    let plain = curve(&mut random, 3, 4);
    let (knots, points) = (plain.knots().as_slice().to_vec(), plain.control_points().to_vec());
    let count = points.len();
    let weighted = |weights: Vec<f64>| {
        Definition::from(NurbsCurve::new(3, knots.clone(), points.clone(), Some(weights)).expect("valid"))
    };
    let cleaned = clean(&weighted(vec![0.7; count]));
    assert_eq!(cleaned.steps, [Cleaning::DroppedWeights { weight: 0.7 }]);
    assert_eq!((cleaned.definition.weights(), cleaned.definition.control_points()), (None, &points[..]));
    let mut other = vec![0.7; count];
    other[1] = 0.8;
    assert!(clean(&weighted(other)).steps.is_empty());
}

#[test]
fn what_needs_nothing_keeps_its_bits() {
    let mut random = Random::new(31_006);
    for degree in 1..=6 {
        for _ in 0..20 {
            for plain in [curve(&mut random, degree, 8).into(), surface(&mut random, (degree, 2), 4).into()] {
                let cleaned = clean(&plain);
                assert_eq!((cleaned.steps, cleaned.deviation), (Vec::new(), 0.0), "degree {degree}");
                assert_eq!(cleaned.definition.fingerprint(), plain.fingerprint());
            }
        }
    }
}

#[test]
fn a_straight_edge_a_plane_and_a_pole_stay_that_to_the_bit() {
    // a polar cap with one row that is a point, in the plane of its rim at a height that no power of two divides
    let knots = |count: usize| {
        let mut all = vec![0.0; 3];
        all.extend((1..count - 2).map(|k| k as f64 / 3.0));
        all.extend(vec![(count - 2) as f64 / 3.0; 3]);
        all
    };
    let row = |i: usize| -> Vec<DVec3> {
        (0..7).map(|j| DVec3::new(0.1 * i as f64, 0.1 * (i * (j + 1)) as f64, 1.0 / 3.0)).collect()
    };
    let cap = NurbsSurface::new((2, 2), (knots(7), knots(7)), (0..7).map(row).collect(), None).expect("valid");
    let thin = clean(&cap.into()).definition;
    let Definition::NurbsSurface(thin) = thin else { panic!("a surface") };
    assert!(thin.control_points().len() < 49, "{}", thin.control_points().len());
    assert!(thin.control_points().iter().all(|p| p.z == 1.0 / 3.0), "{:?}", thin.control_points());
    assert!(thin.control_points()[..thin.columns()].iter().all(|p| *p == DVec3::new(0.0, 0.0, 1.0 / 3.0)));
}

/// Panics where a purge moved points farther than it says, or than was asked; gives how much looser the proof is than what was seen.
fn purged(definition: &Definition, tolerance: f64, what: &str) -> (PreparedDefinition, f64) {
    let done = purge(definition, tolerance).expect("a tolerance");
    assert!(done.deviation <= tolerance, "{what}: {:e} of {tolerance:e}", done.deviation);
    let seen = apart(definition, &done.definition, 6);
    let rounding = evaluation(definition);
    assert!(seen <= done.deviation + rounding, "{what}: {seen:e} seen, {:e} proven", done.deviation);
    assert_eq!(done.steps.is_empty(), done.definition == *definition, "{what}");
    let looseness = done.deviation / (seen + rounding);
    (done, looseness)
}

#[test]
fn purging_stays_within_the_tolerance_and_its_proof_near_what_is_seen() {
    let mut random = Random::new(31_007);
    let (mut removed, mut looseness) = (0, Vec::new());
    for round in 0..200 {
        let degree = 1 + round % 5;
        let plain = curve(&mut random, degree, 30);
        let noise = random.power(-6.0, -1.0);
        let curve = Definition::from(wavy(&mut random, &plain, noise));
        let tolerance = curve.size() * random.power(-5.0, -1.0);
        let (done, loose) = purged(&curve, tolerance, &format!("round {round}, degree {degree}"));
        removed += curve.control_points().len() - done.definition.control_points().len();
        if !done.steps.is_empty() {
            looseness.push(loose);
        }
    }
    assert!(removed > 300, "{removed} control points");
    looseness.sort_by(f64::total_cmp);
    let (median, most) = (looseness[looseness.len() / 2], looseness[looseness.len() - 1]);
    assert!(median < 3.0 && most < 40.0, "the proof is {median} times what is seen, at most {most}");
}

#[test]
fn surfaces_are_purged_within_the_tolerance() {
    let mut random = Random::new(31_008);
    let mut removed = 0;
    for round in 0..40 {
        let degree = (1 + round % 3, 1 + round % 4);
        let plain = surface(&mut random, degree, 12);
        let noise = random.power(-6.0, -1.0);
        let surface = Definition::from(hilly(&mut random, &plain, noise));
        let tolerance = surface.size() * random.power(-5.0, -1.0);
        let (done, loose) = purged(&surface, tolerance, &format!("round {round}, degree {degree:?}"));
        removed += surface.control_points().len() - done.definition.control_points().len();
        assert!(loose < 40.0, "round {round}: the proof is {loose} times what is seen");
    }
    assert!(removed > 100, "{removed} control points");
}

#[test]
fn every_degree_is_purged() {
    let mut random = Random::new(31_009);
    for degree in 1..=25 {
        let smooth: Vec<DVec3> =
            (0..80).map(|k| 0.1 * f64::from(k)).map(|t| DVec3::new(t, t.sin(), (0.7 * t).cos())).collect();
        let mut knots = vec![0.0; degree + 1];
        knots.extend((1..80 - degree).map(|k| k as f64 + random.between(-0.2, 0.2)));
        knots.extend(vec![(80 - degree) as f64; degree + 1]);
        for weights in [None, Some((0..80).map(|k| 1.5 + (0.1 * f64::from(k)).sin()).collect())] {
            let curve =
                Definition::from(NurbsCurve::new(degree, knots.clone(), smooth.clone(), weights).expect("valid"));
            let (done, _) = purged(&curve, 1e-2, &format!("degree {degree}"));
            let left = done.definition.control_points().len();
            // a degree of 25 over 55 spans holds 26 points anyway
            assert!(left < 70, "degree {degree}: {left} control points");
        }
    }
}

#[test]
fn near_knots_become_one() {
    let mut random = Random::new(31_010);
    for degree in 2..=5 {
        for ulps in [1, 3, 1000] {
            let (mut points, mut knots) = (Vec::new(), vec![0.0; degree + 1]);
            for at in [1.0, 2.0, 3.0] {
                knots.push(at);
                knots.push(at + f64::from(ulps) * at * f64::EPSILON);
            }
            knots.extend(vec![4.0; degree + 1]);
            points.extend((0..knots.len() - degree - 1).map(|_| random.in_cube()));
            let curve = Definition::from(NurbsCurve::new(degree, knots, points, None).expect("valid"));
            let (done, _) = purged(&curve, 1e-9, &format!("degree {degree}, {ulps} ulps"));
            let Definition::NurbsCurve(thin) = &done.definition else { panic!("a curve") };
            let gaps = thin.knots().spans().map(|span| span.end - span.start).fold(f64::INFINITY, f64::min);
            assert!(gaps > 0.9, "degree {degree}, {ulps} ulps: {:?}", thin.knots());
            assert!(done.deviation < 1e-10, "{:e}", done.deviation);
            let [Cleaning::Purged { removed, .. }] = &done.steps[..] else { panic!("{:?}", done.steps) };
            assert_eq!(removed.len(), 3, "{:?}", done.steps);
        }
    }
}

#[test]
fn no_weight_falls_to_zero() {
    let mut random = Random::new(31_011);
    for round in 0..200 {
        let degree = 1 + round % 6;
        let knots = knots(&mut random, degree, 15);
        let count = knots.len() - degree - 1;
        let points = (0..count).map(|_| random.in_cube()).collect();
        let weights: Vec<f64> = (0..count).map(|_| random.power(-6.0, 6.0)).collect();
        let curve = Definition::from(NurbsCurve::new(degree, knots, points, Some(weights)).expect("valid"));
        for tolerance in [1e-3, 1.0, 1e9] {
            let (done, _) = purged(&curve, tolerance, &format!("round {round}"));
            assert!(done.definition.weights().into_iter().flatten().all(|w| *w > 0.0 && w.is_finite()));
        }
    }
}

#[test]
fn extreme_places_and_sizes_are_prepared() {
    let mut random = Random::new(31_012);
    for scale in [1e-69, 1e-30, 1e30, 1e69] {
        let knots = vec![0.0, 0.0, 0.0, 0.0, 0.25, 0.5, 0.75, 1.0, 1.0, 1.0, 1.0];
        let points: Vec<DVec3> = (0..7).map(|_| scale * random.in_cube()).collect();
        for weights in [None, Some([1e-99, 1e-10, 1.0, 1e-99, 1.0, 1e-50, 1e-99].to_vec())] {
            let curve = Definition::from(NurbsCurve::new(3, knots.clone(), points.clone(), weights).expect("valid"));
            let cleaned = clean(&curve);
            assert!(cleaned.deviation.is_finite());
            for tolerance in [1e-300, 1e-3 * scale, f64::MAX] {
                let done = purge(&curve, tolerance).expect("a tolerance");
                assert!(done.deviation <= tolerance, "{:e} of {tolerance:e}", done.deviation);
            }
        }
    }
    let line = Definition::from(curve(&mut random, 2, 3));
    for tolerance in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let refused = purge(&line, tolerance).expect_err("no tolerance");
        assert!(refused.to_string().contains("above 0"), "{refused}");
    }
}

#[test]
fn a_hundred_thousand_control_points_are_prepared() {
    let mut random = Random::new(31_013);
    let count = 100_000;
    let mut knots = vec![0.0; 4];
    knots.extend((1..count - 3).map(|k| k as f64));
    knots.extend(vec![(count - 3) as f64; 4]);
    let turn = |k: usize| 1e-3 * k as f64;
    let spiral = (0..count).map(|k| 100.0 * DVec3::new(turn(k).cos(), turn(k).sin(), 0.1 * turn(k))).collect();
    let curve = Definition::from(NurbsCurve::new(3, knots.clone(), spiral, None).expect("valid"));
    let done = purge(&curve, 1e-2).expect("a tolerance");
    let left = done.definition.control_points().len();
    assert!(done.deviation <= 1e-2 && left < 1000, "{left} control points, {:e}", done.deviation);
    assert!(apart(&curve, &done.definition, 2) <= done.deviation + evaluation(&curve));
    // nothing can go: found in one pass
    let noise = (0..count).map(|_| random.in_cube()).collect();
    let noise = Definition::from(NurbsCurve::new(3, knots, noise, None).expect("valid"));
    assert!(clean(&noise).steps.is_empty());
}
