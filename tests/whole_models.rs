//! The k nearest entities and all within a radius, against a loop over the entities.

#[path = "bodies/solids.rs"]
#[expect(dead_code, reason = "shared with the tests of bodies")]
mod solids;

use perpend::glam::DVec2;
use perpend::{CurveData, DVec3, EntityId, FootPoint, Model, QueryError, QueryOptions};

use solids::{circle, cuboid, planar, rectangle};

/// A small generator: the points of a test are the same on every machine.
struct Numbers(u64);

impl Numbers {
    /// The next number in [0, 1).
    fn next(&mut self) -> f64 {
        // Knuth's MMIX constants; the high bits are the good ones
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn point(&mut self, scale: f64) -> DVec3 {
        scale * (DVec3::new(self.next(), self.next(), self.next()) - 0.5)
    }
}

/// Boxes, plates with round holes and curves, scattered about; some of them coincide.
fn model() -> Model {
    let mut numbers = Numbers(1);
    let mut model = Model::new();
    for k in 0..12 {
        let at = numbers.point(8.0);
        if k % 3 == 0 {
            cuboid(&mut model, at, at + DVec3::new(1.0, 2.0, 0.5), false);
        } else if k % 3 == 1 {
            for _ in 0..2 {
                let loops = vec![rectangle(DVec2::splat(-1.0), DVec2::ONE), circle(false, DVec2::ZERO, 0.5)];
                planar(&mut model, at, [DVec3::X, DVec3::Z], loops, k % 2 == 0);
            }
        } else {
            let control_points = (0..4).map(|_| at + numbers.point(2.0)).collect();
            let knots = vec![0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0];
            model.insert("curve", CurveData { degree: 3, knots, control_points, weights: None }).unwrap();
        }
    }
    model
}

/// Every entity asked by itself, the nearest first.
fn one_by_one(model: &Model, p: DVec3) -> Vec<(EntityId, FootPoint)> {
    let mut all: Vec<(EntityId, FootPoint)> =
        model.entities().iter().map(|one| (one.id(), model.project(one.id(), p).unwrap())).collect();
    all.sort_by(|a, b| a.1.distance.total_cmp(&b.1.distance).then(a.0.cmp(&b.0)));
    all
}

#[test]
fn the_k_nearest_are_those_of_a_loop_bit_for_bit() {
    let model = model();
    let options = QueryOptions::default();
    let mut numbers = Numbers(7);
    for round in 0..400 {
        let p = numbers.point(if round % 4 == 0 { 100.0 } else { 12.0 });
        let all = one_by_one(&model, p);
        for k in [0, 1, 2, 3, 7, all.len(), all.len() + 5] {
            let found = model.nearest_k(p, k, &options).unwrap();
            assert_eq!(found, all[..k.min(all.len())], "{p:?}, {k}");
        }
        let (id, foot) = model.nearest(p, &options).unwrap().unwrap();
        assert_eq!((id, foot.parameter, foot.distance), (all[0].0, all[0].1.parameter, all[0].1.distance));
        assert!(foot.lower_bound <= all[0].1.distance);
    }
}

#[test]
fn what_is_within_a_radius_is_what_a_loop_finds_there() {
    let model = model();
    let options = QueryOptions::default();
    let mut numbers = Numbers(9);
    let mut counts = 0;
    for _ in 0..400 {
        let p = numbers.point(12.0);
        let all = one_by_one(&model, p);
        for radius in [0.0, 0.5, 2.0, 5.0, 1e3] {
            let found = model.within(p, radius, &options).unwrap();
            assert!(found.iter().all(|(_, foot)| foot.lower_bound <= radius));
            let ids = |list: &[(EntityId, FootPoint)]| list.iter().map(|(id, _)| *id).collect::<Vec<_>>();
            let expected: Vec<_> = all.iter().filter(|(_, foot)| foot.distance <= radius).copied().collect();
            assert_eq!(ids(&found), ids(&expected), "{p:?}, {radius}");
            counts += found.len();
            // a maximum distance holds too
            let limited = QueryOptions { max_distance: Some(radius), ..options };
            assert_eq!(model.nearest_k(p, all.len(), &limited).unwrap().len(), found.len(), "{p:?}, {radius}");
            assert_eq!(model.within(p, 1e9, &limited).unwrap(), found);
        }
    }
    assert!(counts > 10_000);
}

#[test]
fn batches_give_the_bits_of_single_queries() {
    let model = model();
    let mut numbers = Numbers(13);
    let mut points: Vec<DVec3> = (0..300).map(|_| numbers.point(12.0)).collect();
    points[100].y = f64::NAN;
    let options = QueryOptions::default();
    let several = model.nearest_k_all(&points, 3, &options);
    let near = model.within_all(&points, 2.0, &options);
    for (index, p) in points.iter().enumerate() {
        if index == 100 {
            assert!(matches!(several[index], Err(QueryError::InvalidPoint { index: 100, .. })));
            assert!(matches!(near[index], Err(QueryError::InvalidPoint { index: 100, .. })));
            continue;
        }
        assert_eq!(several[index], model.nearest_k(*p, 3, &options));
        assert_eq!(near[index], model.within(*p, 2.0, &options));
    }
    // on any number of threads
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    assert_eq!(one.install(|| format!("{:?}", model.nearest_k_all(&points, 3, &options))), format!("{several:?}"));
}

#[test]
fn a_radius_without_meaning_is_refused() {
    let model = model();
    for radius in [-1.0, f64::NAN] {
        let error = model.within(DVec3::ZERO, radius, &QueryOptions::default()).unwrap_err();
        assert!(matches!(error, QueryError::InvalidOption { option: "radius", .. }), "{error}");
        assert!(model.within_all(&[DVec3::ZERO], radius, &QueryOptions::default())[0].is_err());
    }
    assert!(Model::new().nearest_k(DVec3::ZERO, 3, &QueryOptions::default()).unwrap().is_empty());
    assert!(Model::new().within(DVec3::ZERO, 3.0, &QueryOptions::default()).unwrap().is_empty());
}
