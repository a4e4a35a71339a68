//! Queries of a model: alone, in batches, on any number of threads, to one entity and to all.

use perpend::{
    CurveData, DVec3, EntityId, FootPoint, Model, NurbsCurve, Parameter, Place, QueryError, QueryOptions, SurfaceData,
};
use proptest::prelude::*;

/// A model and its queries are used by many threads.
#[test]
fn a_model_is_shared_by_threads() {
    fn shared<T: Send + Sync>() {}
    shared::<Model>();
    shared::<perpend::Entity>();
    shared::<perpend::Prepared>();
    fn sent<T: Send>() {}
    sent::<perpend::Projector<'_>>();
}

/// A small generator: the points of a test are the same on every machine.
struct Numbers(u64);

impl Numbers {
    /// The next number in [-1, 1).
    fn next(&mut self) -> f64 {
        // Knuth's MMIX constants; the high bits are the good ones
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn point(&mut self, scale: f64) -> DVec3 {
        scale * DVec3::new(self.next(), self.next(), self.next())
    }
}

fn wave(centre: DVec3, numbers: &mut Numbers) -> CurveData {
    CurveData {
        degree: 3,
        knots: vec![0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 4.0, 4.0, 4.0, 4.0],
        control_points: (0..7).map(|_| centre + numbers.point(1.0)).collect(),
        weights: Some((0..7).map(|_| 1.5 + numbers.next()).collect()),
    }
}

fn hill(centre: DVec3, numbers: &mut Numbers) -> SurfaceData {
    let knots = vec![0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 2.0];
    let at = |i: i32, j: i32| DVec3::new(f64::from(i) - 1.5, f64::from(j) - 1.5, 0.0);
    SurfaceData {
        degree: (2, 2),
        knots: (knots.clone(), knots),
        control_points: (0..4)
            .map(|i| (0..4).map(|j| centre + at(i, j) + numbers.point(0.3)).collect::<Vec<_>>())
            .collect::<Vec<_>>(),
        weights: None,
    }
}

/// Curves and surfaces scattered about, some of them overlapping.
fn scattered(count: usize, seed: u64) -> Model {
    let mut numbers = Numbers(seed);
    let mut model = Model::new();
    for k in 0..count {
        let centre = numbers.point(6.0);
        if k % 2 == 0 {
            model.insert("wave", wave(centre, &mut numbers)).expect("valid");
        } else {
            model.insert("hill", hill(centre, &mut numbers)).expect("valid");
        }
    }
    model
}

/// Points about a model, with two bad ones among them.
fn cloud(count: usize, seed: u64) -> Vec<DVec3> {
    let mut numbers = Numbers(seed);
    let mut points: Vec<DVec3> = (0..count).map(|_| numbers.point(9.0)).collect();
    points[count / 3].y = f64::NAN;
    points[count / 2].z = f64::INFINITY;
    points
}

/// All bits of an answer.
fn bits(foot: &FootPoint) -> Vec<u64> {
    let parameters = [foot.parameter.u(), foot.parameter.v().unwrap_or(-1.0)];
    let normal = foot.normal.map_or([7.0; 3], |normal| normal.to_array());
    let lengths = [foot.distance, foot.lower_bound, foot.signed_distance.unwrap_or(-7.0)];
    let kinds = [foot.place as u64, foot.multiplicity as u64, foot.method as u64];
    let numbers = parameters.into_iter().chain(foot.point.to_array()).chain(normal).chain(lengths);
    numbers.map(f64::to_bits).chain(kinds).collect()
}

/// A result in a form in which NaN equals itself, so that errors about it can be compared.
fn comparable<T>(
    result: &Result<Option<T>, QueryError>,
    bits: impl Fn(&T) -> Vec<u64>,
) -> Result<Option<Vec<u64>>, String> {
    match result {
        Ok(answer) => Ok(answer.as_ref().map(bits)),
        Err(error) => Err(error.to_string()),
    }
}

fn one_by_one(
    model: &Model,
    id: EntityId,
    points: &[DVec3],
    options: &QueryOptions,
) -> Vec<Result<Option<Vec<u64>>, String>> {
    let ask = |(index, p): (usize, &DVec3)| {
        let result = model.project_with(id, *p, options);
        comparable(&result, bits).map_err(|error| error.replace("query point 0", &format!("query point {index}")))
    };
    points.iter().enumerate().map(ask).collect()
}

#[test]
fn a_batch_gives_the_bits_of_its_points_alone() {
    let model = scattered(6, 11);
    let points = cloud(1_500, 12);
    for options in [QueryOptions::default(), QueryOptions { max_distance: Some(4.0), ..QueryOptions::default() }] {
        for entity in model.entities() {
            let batch = model.project_all(entity.id(), &points, &options);
            let batch: Vec<_> = batch.iter().map(|result| comparable(result, bits)).collect();
            assert_eq!(batch, one_by_one(&model, entity.id(), &points, &options), "entity {}", entity.id());
            assert!(
                batch[500].as_ref().is_err_and(|error| error.starts_with("query point 500 is (")),
                "{:?}",
                batch[500]
            );
            assert!(batch[750].is_err() && batch.iter().filter(|result| result.is_err()).count() == 2);
        }
    }
}

#[test]
fn a_projector_gives_the_bits_of_single_queries_in_any_order() {
    let model = scattered(4, 21);
    let mut points = cloud(600, 22);
    let options = QueryOptions::default();
    for entity in model.entities() {
        for _ in 0..2 {
            let mut projector = model.projector(entity.id()).expect("known");
            for p in &points {
                let with_hint = comparable(&projector.project(*p, &options), bits);
                assert_eq!(with_hint, comparable(&model.project_with(entity.id(), *p, &options), bits), "{p}");
            }
            assert_eq!(projector.statistics().queries, 598);
            points.reverse();
        }
    }
}

#[cfg(feature = "rayon")]
#[test]
fn the_number_of_threads_does_not_change_a_bit() {
    let points = cloud(2_000, 32);
    let options = QueryOptions::default();
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        // prepared anew, by however many threads come first
        let model = scattered(5, 31);
        pool.install(|| {
            let of_nearest = |(id, foot): &(EntityId, FootPoint)| [vec![id.get()], bits(foot)].concat();
            let nearest: Vec<_> =
                model.nearest_all(&points, &options).iter().map(|result| comparable(result, of_nearest)).collect();
            let ids = model.entities().iter().map(perpend::Entity::id);
            let answers = ids.flat_map(|id| model.project_all(id, &points, &options)).collect::<Vec<_>>();
            (answers.iter().map(|result| comparable(result, bits)).collect::<Vec<_>>(), nearest)
        })
    };
    let alone = on(1);
    for threads in 2..=4 {
        assert_eq!(on(threads), alone, "{threads} threads");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 60, ..ProptestConfig::default() })]

    #[test]
    fn the_nearest_entity_is_the_one_that_a_loop_over_all_finds(seed in any::<u64>(), count in 1..14_usize, far in 0..3_i32) {
        let model = scattered(count, seed);
        let mut numbers = Numbers(seed ^ 1);
        for _ in 0..20 {
            let p = numbers.point(8.0 * 10_f64.powi(far));
            let all: Vec<(EntityId, FootPoint)> =
                model.entities().iter().map(|entity| (entity.id(), model.project(entity.id(), p).expect("known"))).collect();
            let least = all.iter().min_by(|a, b| a.1.distance.total_cmp(&b.1.distance).then(a.0.cmp(&b.0))).expect("entities");
            let (id, foot) = model.nearest(p, &QueryOptions::default()).expect("a valid query").expect("an entity");
            prop_assert_eq!(id, least.0);
            prop_assert_eq!(bits(&FootPoint { lower_bound: 0.0, ..foot }), bits(&FootPoint { lower_bound: 0.0, ..least.1 }));
            // the whole model's bound is that of no entity's alone, and no looser than the loosest gap
            let proven = all.iter().map(|(_, foot)| foot.lower_bound).fold(f64::INFINITY, f64::min);
            prop_assert!(foot.lower_bound >= proven && foot.lower_bound <= least.1.lower_bound);
            prop_assert!(foot.gap() <= 1e-9 * model.size() + 32.0 * f64::EPSILON * (8.0 + p.abs().max_element()));
        }
    }

    #[test]
    fn nothing_beyond_the_maximum_distance_is_given(seed in any::<u64>(), count in 1..9_usize, limit in 0.0..12.0_f64) {
        let model = scattered(count, seed);
        let mut numbers = Numbers(seed ^ 2);
        let options = QueryOptions { max_distance: Some(limit), ..QueryOptions::default() };
        for _ in 0..20 {
            let p = numbers.point(9.0);
            let unlimited = model.nearest(p, &QueryOptions::default()).expect("a valid query").expect("an entity");
            let limited = model.nearest(p, &options).expect("a valid query");
            prop_assert_eq!(limited, (unlimited.1.distance <= limit).then_some(unlimited));
        }
    }
}

/// Where a work bound leaves it open whether something is within the limit, none would be a claim without proof. On these
/// curves, whose weights pull hard, a search without work stops short of the foot and beyond the limit.
#[test]
fn a_query_that_may_do_no_work_never_denies_what_is_within_the_maximum_distance() {
    let curves = [
        ([(4.0, 7.0), (6.0, 10.0), (1.0, 8.0), (9.0, 2.0), (2.0, 2.0)], [1e2, 1.0, 1e1, 1e3, 1e3], (1.0, 9.0)),
        ([(9.0, 2.0), (5.0, 1.0), (3.0, 5.0), (4.0, 7.0), (5.0, 3.0)], [1e3, 1.0, 1e1, 1e1, 1e4], (1.0, 2.0)),
        ([(3.0, 8.0), (9.0, 4.0), (8.0, 9.0), (2.0, 9.0), (9.0, 4.0)], [1e2, 1.0, 1e4, 1e1, 1.0], (10.0, 5.0)),
    ];
    for (points, weights, p) in curves {
        let points = points.map(|(x, y)| DVec3::new(x, y, 0.0)).to_vec();
        let knots = [[0.0; 5], [1.0; 5]].concat();
        let curve = NurbsCurve::new(4, knots, points, Some(weights.to_vec())).expect("valid");
        let mut model = Model::new();
        model.insert("pulled", curve).expect("valid");
        let p = DVec3::new(p.0, p.1, 0.0);
        let (_, foot) = model.nearest(p, &QueryOptions::default()).expect("a valid query").expect("an entity");
        let limit = Some((1.0 + 1e-6) * foot.distance);
        let options = QueryOptions { max_distance: limit, work: 0, ..QueryOptions::default() };
        let (_, hasty) = model.nearest(p, &options).expect("a valid query").expect("the foot is within the limit");
        assert!(hasty.lower_bound <= foot.distance && foot.lower_bound <= hasty.distance, "{hasty:?} and {foot:?}");
    }
}

fn segment(from: DVec3, to: DVec3) -> CurveData {
    CurveData { degree: 1, knots: vec![0.0, 0.0, 1.0, 1.0], control_points: vec![from, to], weights: None }
}

#[test]
fn of_entities_at_one_distance_the_lowest_id_is_given_whatever_their_order() {
    let text = |first: u64, second: u64| {
        let line = |id: u64, y: f64| {
            format!(
                "(id: {id}, definition: NurbsCurve(degree: 1, knots: [0, 0, 1, 1], control_points: [(-1, {y}, 0), (1, {y}, 0)]))"
            )
        };
        format!("(format: 1, entities: [{}, {}, {}])", line(first, 2.0), line(second, -2.0), line(50, 9.0))
    };
    for (first, second) in [(3, 8), (8, 3), (0, 1), (1, 0)] {
        let model = Model::from_ron(&text(first, second)).expect("valid");
        let (id, foot) = model.nearest(DVec3::ZERO, &QueryOptions::default()).expect("valid").expect("an entity");
        assert_eq!((id.get(), foot.distance), (first.min(second), 2.0));
    }
}

#[test]
fn a_query_gives_the_foot_with_its_parameter_and_place() {
    let mut model = Model::new();
    let id = model.insert("segment", segment(DVec3::ZERO, 4.0 * DVec3::X)).expect("valid");
    let foot = model.project(id, DVec3::new(1.0, 2.0, 0.0)).expect("a valid query");
    assert_eq!((foot.parameter, foot.point, foot.distance), (Parameter::Curve(0.25), DVec3::X, 2.0));
    assert_eq!((foot.place, foot.normal), (Place::Interior, None));
    let foot = model.project(id, DVec3::new(-3.0, 4.0, 0.0)).expect("a valid query");
    assert_eq!((foot.parameter, foot.distance, foot.place), (Parameter::Curve(0.0), 5.0, Place::End));
}

#[test]
fn refused_queries_say_why() {
    let mut model = Model::new();
    let (p, options) = (DVec3::ZERO, QueryOptions::default());
    let unknown = QueryError::UnknownEntity { id: EntityId::new(1) };
    assert_eq!(model.project(EntityId::new(1), p), Err(unknown.clone()));
    assert_eq!(model.project_ties(EntityId::new(1), p, &options), Err(unknown.clone()));
    assert_eq!(model.projector(EntityId::new(1)).err(), Some(unknown.clone()));
    assert_eq!(model.project_all(EntityId::new(1), &[p; 3], &options), vec![Err(unknown); 3]);
    assert_eq!(model.nearest(p, &options), Ok(None), "an empty model has no nearest entity");
    let id = model.insert("segment", segment(DVec3::ZERO, DVec3::X)).expect("valid");
    let message = |p: DVec3| model.project(id, p).expect_err("a bad point").to_string();
    assert_eq!(
        message(DVec3::new(0.0, f64::NAN, 1.0)),
        "query point 0 is (0.0, NaN, 1.0); coordinates are finite and within ±1e75"
    );
    assert!(message(DVec3::new(0.0, 0.0, f64::NEG_INFINITY)).contains("-inf"));
    assert!(model.nearest(DVec3::NAN, &options).is_err());
    let negative = QueryOptions { gap: Some(-1.0), ..options };
    let refused = QueryError::InvalidOption { option: "gap", value: -1.0 };
    assert_eq!(model.project_with(id, p, &negative), Err(refused.clone()));
    assert_eq!(model.nearest(p, &negative), Err(refused.clone()));
    assert_eq!(model.project_all(id, &[p; 2], &negative), vec![Err(refused); 2]);
}
