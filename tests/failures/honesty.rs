//! What an answer says of itself is so, and the same question has the same answer.

use glam::{DVec3, dvec3};
use perpend::{Definition, FootPoint, QueryOptions};

use super::case::Case;
use super::shapes::{bezier, circle, eggcrate, gallery, plain_surface, points_about, sphere, torus};
use crate::common::adversaries::{KINDS, adversary};
use crate::common::points::hard_points;
use crate::common::random::Random;

fn evaluated(definition: &Definition, foot: &FootPoint) -> DVec3 {
    match definition {
        Definition::NurbsCurve(curve) => curve.point(foot.parameter.u()),
        Definition::NurbsSurface(surface) => surface.point(foot.parameter.u(), foot.parameter.v().expect("a surface")),
    }
}

/// OCCT #345: the point that was returned is not the curve's at the parameter that was returned.
#[test]
fn the_point_is_the_definition_at_the_parameter_bit_for_bit() {
    let mut random = Random::new(345);
    for kind in 0..KINDS.len() {
        let adversary = adversary(kind, &mut random);
        let case = Case::new(adversary.shape.definition());
        for p in hard_points(&adversary, 25, &mut random) {
            let foot = case.model.project(case.id, p).expect("a good query");
            let bits = |p: DVec3| p.to_array().map(f64::to_bits);
            let point = evaluated(&case.definition, &foot);
            assert_eq!(bits(point), bits(foot.point), "{}, {p}: {foot:?}", adversary.kind);
            // the point is rounded to the world's coordinates, the distance is not
            let ulps = 8.0 * f64::EPSILON * case.shape.reach().max(p.abs().max_element());
            // a few ulps of each control point's share
            let degree = (case.shape.degree[0] + case.shape.degree[1]) as f64;
            let off = (foot.distance - p.distance(point)).abs();
            assert!(off <= degree * ulps + 1e-15 * foot.distance, "{}, {p}: {off:e}, {foot:?}", adversary.kind);
        }
    }
}

/// OCCT bug 28196: a projection that was seeded with the foot of the point before was worse than one without. Here a hint, good or bad,
/// changes no bit.
#[test]
fn a_hint_never_worsens_an_answer() {
    let options = QueryOptions::default();
    for (name, case) in gallery() {
        let mut points = points_about(&case, &[0.0, 1e-4, 0.05, 0.7]);
        // there and back across the entity, so that every hint is as bad as can be
        let half = points.len() / 2;
        let leaps: Vec<DVec3> = (0..half).flat_map(|k| [points[k], points[points.len() - 1 - k]]).collect();
        points.extend(leaps);
        points.push(1e6 * case.size() * DVec3::ONE);
        points.push(points[0]);
        let mut projector = case.model.projector(case.id).expect("an entity");
        let together = case.model.project_all(case.id, &points, &options);
        for (p, batch) in points.iter().zip(together) {
            let alone = case.model.project(case.id, *p).expect("a good query");
            let hinted = projector.project(*p, &options).expect("a good query").expect("no limit");
            let batch = batch.expect("a good query").expect("no limit");
            let bits = |foot: &FootPoint| {
                [foot.parameter.u(), foot.parameter.v().unwrap_or(0.0), foot.distance, foot.lower_bound]
                    .map(f64::to_bits)
            };
            assert_eq!(bits(&alone), bits(&hinted), "{name}, {p}: hinted");
            assert_eq!(bits(&alone), bits(&batch), "{name}, {p}: in a batch");
            assert_eq!((alone, alone), (hinted, batch), "{name}, {p}");
        }
    }
}

/// JointJS PR 1061, oce PR 70, FreeCAD #13797: some points made the search hang. However little work is allowed, an answer comes back,
/// and its bounds hold.
#[test]
fn every_query_is_bounded_and_its_bounds_hold() {
    let paraboloid = plain_surface(2, 3, 3, |i, j| {
        let (x, y) = (i as f64 - 1.0, j as f64 - 1.0);
        // x² + y² over [-1, 1]²
        dvec3(x, y, [1.0, -1.0, 1.0][i] + [1.0, -1.0, 1.0][j])
    });
    let wild = |k: usize| dvec3((7.3 * k as f64).sin(), (4.1 * k as f64).cos(), (2.9 * k as f64).sin());
    // two sheets a millionth apart, of different waves
    let sheets = plain_surface(3, 24, 5, |i, j| {
        let there = if i < 12 { i as f64 } else { 23.0 - i as f64 };
        dvec3(there, j as f64, if i < 12 { 0.0 } else { 1e-6 * (1.0 + (i as f64).sin()) })
    });
    let cases: [(&str, Case, Vec<DVec3>); 6] = [
        ("circle", Case::new(circle(1.0)), vec![DVec3::ZERO, dvec3(1e-9, 0.0, 0.0)]),
        ("sphere", Case::new(sphere(1.0)), vec![DVec3::ZERO, dvec3(1e-9, -1e-9, 0.0), dvec3(1e-13, 0.0, 0.0)]),
        ("torus", Case::new(torus(3.0, 1.0)), vec![dvec3(3.0, 0.0, 1e-9), dvec3(0.0, 3.0, 0.0), DVec3::Z]),
        ("paraboloid", Case::new(paraboloid), vec![dvec3(0.0, 0.0, 0.5), dvec3(1e-6, 0.0, 0.5), dvec3(0.0, 0.0, 0.6)]),
        ("degree 25", Case::new(bezier((0..26).map(wild).collect())), vec![DVec3::ZERO, dvec3(0.2, 0.1, -0.3)]),
        ("sheets", Case::new(sheets), vec![dvec3(5.0, 2.0, 1.0), dvec3(5.3, 2.2, 5e-7), dvec3(5.3, 2.2, -1.0)]),
    ];
    for (name, case, points) in cases {
        for p in points {
            let real = case.oracle_distance(p);
            let mut last = f64::INFINITY;
            for work in [0, 1, 5, 40, 300, 20_000] {
                let options = QueryOptions { work, gap: Some(1e-11 * case.size()), ..QueryOptions::default() };
                let mut projector = case.model.projector(case.id).expect("an entity");
                let foot = projector.project(p, &options).expect("a good query").expect("no limit");
                let statistics = projector.statistics().proof;
                let spent = statistics.subdivisions + statistics.refinements;
                assert!(spent <= u64::from(work) + 1, "{name}, {p}: {spent} of {work} splits");
                let finite = [foot.distance, foot.lower_bound, foot.parameter.u(), foot.parameter.v().unwrap_or(0.0)];
                assert!(finite.iter().all(|x| x.is_finite()), "{name}, {p}: {foot:?}");
                assert_eq!(evaluated(&case.definition, &foot), foot.point, "{name}, {p}");
                let slack = 1e-15 * (real + case.size());
                assert!(0.0 <= foot.lower_bound && foot.lower_bound <= real + slack, "{name}, {p}: {real:e}, {foot:?}");
                assert!(foot.distance >= real - 1e-12 * case.size(), "{name}, {p}: {real:e}, {foot:?}");
                // an unfinished proof shows, and more work never worsens the foot
                let gap = options.gap.unwrap_or_default() + 32.0 * f64::EPSILON * (case.shape.reach() + p.length());
                assert!(statistics.unresolved > 0 || foot.gap() <= gap, "{name}, {p}, {work}: {foot:?}");
                assert!(foot.distance <= last, "{name}, {p}, {work}: {foot:?}");
                last = foot.distance;
            }
        }
    }
}

/// FreeCAD #13797: `project_ties` is bounded too, and says when it did not finish.
#[test]
fn the_search_for_ties_is_bounded_and_says_so() {
    let case = Case::new(torus(3.0, 1.0));
    let spine = 3.0 * DVec3::Y;
    let options = QueryOptions { work: 3, ..QueryOptions::default() };
    let ties = case.model.project_ties(case.id, spine, &options).expect("a good query").expect("no limit");
    assert!(!ties.complete);
    assert!(case.ties(spine).complete);
    assert!(Case::new(sphere(1.0)).ties(DVec3::ZERO).complete);
    let case = Case::new(eggcrate());
    for (_, _, p) in case.grid(6) {
        assert!(case.ties(p + 0.3 * DVec3::Z).complete);
    }
}
