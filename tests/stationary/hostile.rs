//! Bad input, and input that is hard on purpose: no panic, no endless search, no point lost.

use std::time::{Duration, Instant};

use perpend::{Certainty, DVec3, Model, NurbsCurve, NurbsSurface, QueryError, StationaryOptions};

use crate::One;
use crate::common::random::Random;

#[test]
fn numbers_without_meaning_are_refused() {
    let mut model = Model::new();
    let line = NurbsCurve::new(1, vec![0.0, 0.0, 1.0, 1.0], vec![DVec3::ZERO, DVec3::X], None).expect("valid");
    let id = model.insert("", line).expect("valid");
    let ask = |p: DVec3, tolerance: Option<f64>| {
        model.stationary_points(id, p, &StationaryOptions { tolerance, ..StationaryOptions::default() })
    };
    for x in [f64::NAN, f64::INFINITY, -1e76] {
        assert!(matches!(ask(DVec3::new(0.0, x, 0.0), None), Err(QueryError::InvalidPoint { .. })));
    }
    for tolerance in [f64::NAN, -1.0] {
        let refused = ask(DVec3::ZERO, Some(tolerance)).expect_err("no tolerance");
        assert!(refused.to_string().contains("tolerance"), "{refused}");
    }
    assert_eq!(ask(DVec3::ONE, Some(0.0)).expect("the finest").points.len(), 2);
    assert_eq!(ask(DVec3::ONE, Some(f64::INFINITY)).expect("the coarsest").points.len(), 2);
    let unknown = model.stationary_points(perpend::EntityId::new(99), DVec3::ZERO, &StationaryOptions::default());
    assert!(matches!(unknown, Err(QueryError::UnknownEntity { .. })));
}

/// With no work allowed, whatever is not proven at once comes back as undecided.
#[test]
fn the_least_work_loses_no_minimum() {
    let mut random = Random::new(6);
    for _ in 0..20 {
        let points = (0..8).map(|_| random.in_cube()).collect();
        let knots = [vec![0.0; 6], vec![0.3, 0.6], vec![1.0; 6]].concat();
        let one = One::new(NurbsCurve::new(5, knots, points, None).expect("valid"));
        let p = random.in_cube();
        let all = one.stationary(p);
        for work in [0, 1, 5, 20] {
            let options = StationaryOptions { work, ..StationaryOptions::default() };
            let found = one.model.stationary_points(one.id, p, &options).expect("finite");
            for point in &all.points {
                let u = point.parameter.u();
                let again = found.points.iter().any(|other| (other.parameter.u() - u).abs() < 1e-9);
                let held = found.continua.iter().flat_map(|set| &set.boxes).any(|b| b.u.0 <= u && u <= b.u.1);
                assert!(again || held, "work {work}: {u} of {all:?} is not in {found:?}");
            }
            assert!(work > 0 || found.complete == found.continua.is_empty());
        }
    }
}

/// The highest degrees, weights twelve decades apart, hair-thin and huge and tiny entities, queries on them and far off.
#[test]
fn hard_entities_end_soon_and_lose_no_foot() {
    let mut random = Random::new(7);
    for round in 0..36 {
        let scale = [1.0, 1e60, 1e-60, 1e-3, 1e9, 1.0][round % 6];
        let thin = [DVec3::ONE, DVec3::new(1.0, 1e-12, 1e-12), DVec3::new(1.0, 1.0, 0.0)][round % 3];
        let degree = [25, 9, 3, 2][round % 4];
        let weight = |random: &mut Random| random.power(-6.0, 6.0);
        let one = if round % 2 == 0 {
            let n = degree + 3;
            let points = (0..n).map(|_| scale * thin * random.in_cube()).collect();
            let weights = (0..n).map(|_| weight(&mut random)).collect();
            let knots = [vec![0.0; degree + 1], vec![1e-9, 0.5], vec![1.0; degree + 1]].concat();
            One::new(NurbsCurve::new(degree, knots, points, Some(weights)).expect("valid"))
        } else {
            let side = degree.min(9) + 1;
            let points = (0..side).map(|_| (0..side).map(|_| scale * thin * random.in_cube()).collect()).collect();
            let weights = (0..side).map(|_| (0..side).map(|_| weight(&mut random)).collect()).collect();
            let knots = [vec![0.0; side], vec![1.0; side]].concat();
            let surface = NurbsSurface::new((side - 1, side - 1), (knots.clone(), knots), points, Some(weights));
            One::new(surface.expect("valid"))
        };
        for reach in [1e-9, 0.5, 1e4] {
            let p = scale * reach * random.in_cube();
            let started = Instant::now();
            let options = StationaryOptions { work: 2_000, ..StationaryOptions::default() };
            let found = one.model.stationary_points(one.id, p, &options).expect("finite");
            assert!(started.elapsed() < Duration::from_secs(20), "round {round}: {:?}", started.elapsed());
            let foot = one.model.project(one.id, p).expect("finite");
            let (u, v) = (foot.parameter.u(), foot.parameter.v().unwrap_or(0.0));
            let within = |(from, to): (f64, f64), x: f64| from - 1e-6 <= x && x <= to + 1e-6;
            let held = found.continua.iter().flat_map(|set| &set.boxes).any(|b| within(b.u, u) && within(b.v, v));
            let near = foot.gap() + 1e-9 * (one.size() + foot.distance);
            let met = found.points.iter().any(|point| (point.distance - foot.distance).abs() <= near);
            assert!(held || met, "round {round}, reach {reach}: {foot:?} is not in {found:?}");
            for point in &found.points {
                assert!(point.distance.is_finite() && point.distance >= foot.lower_bound - near);
                assert!(point.certainty == Certainty::Undecided || point.range.u.1 >= point.range.u.0);
            }
        }
    }
}
