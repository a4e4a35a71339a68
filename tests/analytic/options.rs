//! What a query may ask for, of shapes that the closed form answers; and the nearest of many shapes.

use glam::DVec3;
use perpend::{Method, Model, QueryOptions};

use super::probes::{probes, special};
use super::shapes::{CLASSES, Standing, shape};
use crate::common::exact::Exact;
use crate::common::judgement::EPSILON;
use crate::common::random::Random;
use crate::common::shape::Shape;

fn few_ulps(exact: &Exact, p: DVec3) -> f64 {
    16.0 * EPSILON * (exact.reach() + p.abs().max_element())
}

#[test]
fn a_limit_is_kept_to_the_last_digits() {
    let mut random = Random::new(46_001);
    let mut within = [0; 2];
    for _ in 0..6 {
        for class in CLASSES {
            let standing = Standing::random(&mut random);
            let exact = shape(&mut random, class, standing);
            let definition = exact.made().0;
            let mut model = Model::new();
            let id = model.insert(class, definition.clone()).expect("valid");
            let special = special(&exact, &mut random);
            for probe in probes(&special, &Shape::of(&definition), 20, &mut random) {
                let p = probe.point;
                let (exactly, rounding) = (exact.distance(p), few_ulps(&exact, p) + 1e-12 * definition.size());
                for share in [0.0, 0.5, 1.0 - 1e-6, 1.0, 1.0 + 1e-6, 2.0] {
                    let limit = share * exactly;
                    let options = QueryOptions { max_distance: Some(limit), ..QueryOptions::default() };
                    match model.project_with(id, p, &options).expect("a good query") {
                        None => assert!(exactly > limit - rounding, "{exact:?} at {p:?}, limit {limit:e}: {exactly:e}"),
                        Some(foot) => {
                            assert!(foot.distance <= limit + rounding, "{exact:?} at {p:?}, limit {limit:e}: {foot:?}");
                            within[usize::from(foot.method == Method::Analytic)] += 1;
                        }
                    }
                }
            }
        }
    }
    assert!(
        within[1] > 1000 && 4 * within[1] > 3 * within[0],
        "by the certified solver and in closed form: {within:?}"
    );
}

#[test]
fn a_gap_of_nothing_and_a_gap_of_everything_leave_bounds_true() {
    let mut random = Random::new(46_002);
    for _ in 0..4 {
        for class in CLASSES {
            let standing = Standing::random(&mut random);
            let exact = shape(&mut random, class, standing);
            let definition = exact.made().0;
            let mut model = Model::new();
            let id = model.insert(class, definition.clone()).expect("valid");
            let special = special(&exact, &mut random);
            for probe in probes(&special, &Shape::of(&definition), 10, &mut random) {
                let (p, exactly) = (probe.point, exact.distance(probe.point));
                let few = few_ulps(&exact, p);
                for gap in [0.0, 1e-15, 1e-3, 10.0] {
                    let gap = gap * definition.size();
                    for work in [0, 20_000] {
                        let options = QueryOptions { gap: Some(gap), work, ..QueryOptions::default() };
                        let foot = model.project_with(id, p, &options).expect("a good query").expect("no limit");
                        let what = || format!("{exact:?} at {p:?}, gap {gap:e}, work {work}: {exactly:e}, {foot:?}");
                        assert!(foot.lower_bound <= exactly + few && foot.distance >= exactly - few, "{}", what());
                        let analytic = foot.method == Method::Analytic;
                        assert!(!analytic || foot.distance <= exactly + gap + few, "{}", what());
                    }
                }
            }
        }
    }
}

#[test]
fn the_nearest_of_many_shapes_is_the_nearest() {
    let mut random = Random::new(46_003);
    for _ in 0..4 {
        let mut model = Model::new();
        let mut shapes = Vec::new();
        for _ in 0..3 {
            for class in CLASSES {
                let standing = Standing { scale: 1.0, offset: 4.0 * random.unit(), upright: false };
                let exact = shape(&mut random, class, standing);
                shapes.push((model.insert(class, exact.made().0).expect("valid"), exact));
            }
        }
        for _ in 0..150 {
            let p = 6.0 * random.in_cube();
            let (id, foot) = model.nearest(p, &QueryOptions::default()).expect("a good query").expect("no limit");
            let all = shapes.iter().map(|(_, exact)| exact.distance(p));
            let (least, reach) = (all.fold(f64::INFINITY, f64::min), 40.0);
            let allowed = 1e-9 * model.size() + 16.0 * EPSILON * reach;
            assert!((foot.distance - least).abs() <= allowed, "{p}: {least:e}, entity {id}: {foot:?}");
            assert!(foot.lower_bound <= least + 16.0 * EPSILON * reach, "{p}: {least:e}, entity {id}: {foot:?}");
            let (_, exact) = shapes.iter().find(|(other, _)| *other == id).expect("an entity of the model");
            assert!((foot.distance - exact.distance(p)).abs() <= allowed, "{p}: entity {id}: {foot:?}");
        }
    }
}
