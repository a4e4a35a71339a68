//! What is asked for is heeded, and what has no meaning is named.

use glam::{DVec3, dvec3};
use perpend::{CurveData, EntityId, Multiplicity, QueryError, QueryOptions};

use super::case::{Case, close};
use super::shapes::{arc, eggcrate, flat, gallery, points_about, polyline, sphere};

/// Rhino's maximumDistance, Parasolid's bounds: beyond it there is no answer, and that is not an error.
#[test]
fn beyond_the_maximum_distance_there_is_none() {
    for (name, case) in gallery() {
        for p in points_about(&case, &[1e-3, 0.3, 5.0]) {
            let full = case.foot(p);
            let mut projector = case.model.projector(case.id).expect("an entity");
            for (factor, expected) in [(0.5, false), (1.0 - 1e-9, false), (1.0 + 1e-9, true), (3.0, true)] {
                let options = QueryOptions { max_distance: Some(factor * full.distance), ..QueryOptions::default() };
                let limited = case.model.project_with(case.id, p, &options).expect("a good query");
                assert_eq!(limited.is_some(), expected, "{name}, {p}, {factor}: {full:?}");
                let hinted = projector.project(p, &options).expect("a good query");
                assert_eq!(hinted.map(|f| f.distance), limited.map(|f| f.distance), "{name}, {p}, {factor}");
                let nearest = case.model.nearest(p, &options).expect("a good query");
                assert_eq!(nearest.is_some(), expected, "{name}, {p}, {factor}");
                for foot in limited.into_iter().chain(nearest.map(|(_, foot)| foot)) {
                    close(foot.distance, full.distance, 1e-12 * case.size());
                }
            }
        }
    }
    let case = Case::new(sphere(1.0));
    let options = QueryOptions { max_distance: Some(0.99), ..QueryOptions::default() };
    assert_eq!(case.model.project_ties(case.id, DVec3::ZERO, &options), Ok(None));
    // nothing is farther than 0 from a point of the entity
    let options = QueryOptions { max_distance: Some(0.0), ..QueryOptions::default() };
    let polyline = Case::new(polyline(&flat(&[[0.0, 0.0], [1.0, 0.0]])));
    let on = polyline.model.project_with(polyline.id, dvec3(0.5, 0.0, 0.0), &options).expect("a good query");
    assert!(on.is_some_and(|foot| foot.distance == 0.0));
}

/// The gap that is asked is the gap that is proven, coarse or fine.
#[test]
fn the_gap_is_heeded() {
    for (name, case) in gallery() {
        for p in points_about(&case, &[1e-4, 0.02, 0.4, 8.0]) {
            let real = case.oracle_distance(p);
            for share in [1e-6, 1e-11] {
                let gap = share * case.size();
                let options = QueryOptions { gap: Some(gap), ..QueryOptions::default() };
                let foot = case.foot_no_farther(p, real, &options);
                assert!(foot.distance <= real + gap + 1e-13 * real, "{name}, {p}: {foot:?}");
            }
        }
    }
}

/// A gap of 0 asks for more than rounding allows: the answer comes, and its bounds hold.
#[test]
fn a_gap_of_zero_is_answered_as_finely_as_rounding_allows() {
    let case = Case::new(eggcrate());
    let options = QueryOptions { gap: Some(0.0), ..QueryOptions::default() };
    for p in points_about(&case, &[1e-4, 0.02, 0.4]) {
        let foot = case.model.project_with(case.id, p, &options).expect("a good query").expect("no limit");
        let real = case.oracle_distance(p);
        assert!(foot.lower_bound <= real + 1e-15 * case.size() && foot.distance >= real - 1e-12 * case.size());
        assert!(foot.gap() <= 1e-10 * case.size(), "{foot:?}");
    }
}

/// How far apart two feet must be to be two is the caller's to say.
#[test]
fn the_coincidence_is_heeded() {
    // midway between two walls, 2 apart
    let case = Case::new(polyline(&flat(&[[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [0.0, 2.0]])));
    let p = dvec3(1.0, 1.0, 0.0);
    for (coincidence, multiplicity, count) in [(1.9, Multiplicity::Tied, 2), (2.1, Multiplicity::Unique, 1)] {
        let options = QueryOptions { coincidence: Some(coincidence), ..QueryOptions::default() };
        let ties = case.model.project_ties(case.id, p, &options).expect("a good query").expect("no limit");
        assert_eq!(ties.nearest.multiplicity, multiplicity);
        assert_eq!(ties.points.len(), count, "{ties:?}");
    }
}

/// Query points that are no points, everywhere they may come from; in a batch the others are answered.
#[test]
fn bad_points_are_named_by_their_index() {
    let case = Case::new(arc(1.0, 1.0));
    let (model, id, options) = (&case.model, case.id, QueryOptions::default());
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e151] {
        for k in 0..3 {
            let mut p = DVec3::ONE;
            p[k] = bad;
            let error = model.project(id, p).expect_err("no point");
            assert!(matches!(error, QueryError::InvalidPoint { index: 0, .. }), "{error:?}");
            assert!(error.to_string().contains("coordinates are finite"), "{error}");
            assert!(model.project_ties(id, p, &options).is_err() && model.nearest(p, &options).is_err());
            assert!(model.projector(id).expect("an entity").project(p, &options).is_err());
            let batch = model.project_all(id, &[DVec3::ONE, DVec3::ZERO, p, DVec3::X], &options);
            let answered: Vec<bool> = batch.iter().map(Result::is_ok).collect();
            assert_eq!(answered, [true, true, false, true]);
            assert!(matches!(batch[2], Err(QueryError::InvalidPoint { index: 2, .. })), "{:?}", batch[2]);
        }
    }
    // far beyond anything sensible and still a point
    let foot = model.project(id, 1e75 * DVec3::X).expect("a point");
    assert!(foot.distance.is_finite() && foot.lower_bound <= foot.distance, "{foot:?}");
}

/// Options and ids without meaning.
#[test]
fn bad_options_and_ids_are_named() {
    let case = Case::new(arc(1.0, 1.0));
    let ask = |options: QueryOptions| case.model.project_with(case.id, DVec3::ONE, &options);
    for bad in [-1.0, -f64::MIN_POSITIVE, f64::NAN, f64::NEG_INFINITY] {
        let plain = QueryOptions::default();
        for (name, options) in [
            ("gap", QueryOptions { gap: Some(bad), ..plain }),
            ("max_distance", QueryOptions { max_distance: Some(bad), ..plain }),
            ("coincidence", QueryOptions { coincidence: Some(bad), ..plain }),
        ] {
            let error = ask(options).expect_err("no option");
            assert!(matches!(error, QueryError::InvalidOption { option, .. } if option == name), "{error:?}");
            assert!(error.to_string().contains(name), "{error}");
            assert!(case.model.project_ties(case.id, DVec3::ONE, &options).is_err());
            assert!(case.model.nearest(DVec3::ONE, &options).is_err());
            assert!(case.model.project_all(case.id, &[DVec3::ONE], &options)[0].is_err());
        }
    }
    let unknown = EntityId::new(77);
    let error = case.model.project(unknown, DVec3::ONE).expect_err("no entity");
    assert_eq!(error, QueryError::UnknownEntity { id: unknown });
    assert!(error.to_string().contains("77"), "{error}");
    assert!(case.model.projector(unknown).is_err());
    // an entity that is none never gets in
    let knots = vec![0.0, 0.0, 1.0, 1.0];
    let data = CurveData { degree: 1, knots, control_points: vec![DVec3::ONE, DVec3::splat(f64::NAN)], weights: None };
    let mut model = case.model.clone();
    assert!(model.insert("bad", data).is_err() && model.len() == 1);
}
