//! What holds for every entity and every point: nothing sampled is nearer; the answer does not depend on where the entity lies,
//! how it is parametrised or written, nor on the company in which a point is asked.
//!
//! Two queries whose true distances are equal have overlapping intervals `[lower_bound, distance]`, and distances that
//! differ by a gap at most; `slack` below is the rounding of the change itself.

mod common;

use common::adversaries::{KINDS, adversary, grain};
use common::judgement::{EPSILON, is_certified, rounding};
use common::points::hard_points;
use common::random::Random;
use common::shape::{Shape, bezier_knots};
use common::strategies::{Probe, coordinate, entity, probe};
use glam::{DAffine3, DMat3, DQuat, DVec3};
use perpend::{Definition, Direction, FootPoint, Model, QueryOptions};
use proptest::prelude::*;
use proptest::sample::Index;
use proptest::test_runner::RngSeed;

/// The same cases every time, so that a suite that passed passes again; the variable `PROPTEST_RNG_SEED` asks for others.
fn config(cases: u32) -> ProptestConfig {
    let default = ProptestConfig::default();
    let rng_seed = if default.rng_seed == RngSeed::Random { RngSeed::Fixed(1) } else { default.rng_seed };
    ProptestConfig { cases, failure_persistence: None, rng_seed, ..default }
}

fn model(definition: &Definition) -> (Model, perpend::EntityId) {
    let mut model = Model::new();
    let id = model.insert("it", definition.clone()).expect("a valid entity");
    (model, id)
}

fn project(definition: &Definition, p: DVec3) -> FootPoint {
    let (model, id) = model(definition);
    model.project(id, p).expect("a finite point")
}

/// Fails unless the answers to a query and to its changed form agree; distances of the second are `scale` times the first's.
fn same_distance(
    (one, p): (&Definition, DVec3),
    (other, q): (&Definition, DVec3),
    scale: f64,
    slack: f64,
) -> Result<(), TestCaseError> {
    let (a, b) = (project(one, p), project(other, q));
    let (upper, lower) = (a.distance * scale, a.lower_bound * scale);
    let told = format!("{one:?} at {p}: {a:?}\nand {other:?} at {q}: {b:?}\nslack {slack:e}");
    prop_assert!(lower <= b.distance + slack && b.lower_bound <= upper + slack, "bounds that deny each other: {told}");
    let gap = 1e-9 * (one.size() * scale).max(other.size());
    prop_assert!((upper - b.distance).abs() <= gap + slack, "distances differ: {told}");
    Ok(())
}

/// The rounding of an edit that moves control points by some ulps of the largest coordinate.
fn edit_slack(definition: &Definition, p: DVec3) -> f64 {
    64.0 * EPSILON * (definition.reach() + p.abs().max_element())
}

/// The map `p -> scale * turned p + offset`.
fn similarity(turn: DQuat, scale: f64, offset: DVec3) -> DAffine3 {
    DAffine3 { matrix3: scale * DMat3::from_quat(turn), translation: offset }
}

fn transformed(definition: &Definition, map: &DAffine3) -> Definition {
    match definition {
        Definition::NurbsCurve(curve) => curve.transformed(map).expect("an image with extent").into(),
        Definition::NurbsSurface(surface) => surface.transformed(map).expect("an image with extent").into(),
    }
}

/// Some knot inside the domain: a share of a span, or of the whole.
fn inner_knot(shape: &Shape, along: usize, share: f64) -> f64 {
    let [first, last] = shape.domain(along);
    first + share * (last - first)
}

proptest! {
    #![proptest_config(config(1_500))]

    #[test]
    fn no_sample_is_nearer(shape in entity(), probe in probe()) {
        let p = probe.about(&shape);
        let definition = shape.definition();
        let foot = project(&definition, p);
        let (size, reach) = (shape.size(), shape.reach());
        // a gap needs parameters that are finer than it
        if grain(&shape) <= 1e-10 * size {
            prop_assert!(is_certified(foot.distance, foot.lower_bound, 1e-9 * size, reach, p), "{foot:?}");
        }
        let shares = || (0..=20).map(|i| f64::from(i) / 20.0).chain([1e-9]);
        let (across, along) = (shares(), shares().take(if shape.curve { 1 } else { 22 }));
        for u in across {
            for v in along.clone() {
                let (u, v) = (inner_knot(&shape, 0, u), inner_knot(&shape, 1, v));
                let sample = shape.distance_at(p, u.into(), v.into());
                let told = || format!("the point at ({u:?}, {v:?}) is {sample:e} from {p}; {foot:?}");
                prop_assert!(foot.lower_bound <= sample + 1e-12 * size + 1e-15 * sample, "{}", told());
                prop_assert!(foot.distance <= sample + 1e-9 * size + rounding(reach, p, sample), "{}", told());
            }
        }
    }

    #[test]
    fn a_rigid_motion_changes_no_distance(
        shape in entity(),
        probe in probe(),
        (axis, angle) in (prop_oneof![Just(DVec3::Z), Just(DVec3::ONE)], prop_oneof![Just(0.0), -3.0..3.0f64]),
        offset in (coordinate(), coordinate(), prop_oneof![Just(0.0), Just(1e4), -1e2..1e2f64]),
    ) {
        let definition = shape.definition();
        let p = probe.about(&shape);
        let map = similarity(DQuat::from_axis_angle(axis.normalize(), angle), 1.0, offset.into());
        let (moved, q) = (transformed(&definition, &map), map.transform_point3(p));
        // the turned axes are of unit length to rounding only
        let slack = edit_slack(&definition, p) + edit_slack(&moved, q);
        same_distance((&definition, p), (&moved, q), 1.0, slack)?;
    }

    #[test]
    fn a_scaled_entity_has_scaled_distances(
        shape in entity(),
        probe in probe(),
        scale in prop_oneof![Just(1e-3), Just(1e6), Just(1.0 / 3.0), 1e-3..1e6f64],
    ) {
        let definition = shape.definition();
        let p = probe.about(&shape);
        let map = similarity(DQuat::IDENTITY, scale, DVec3::ZERO);
        let (scaled, q) = (transformed(&definition, &map), scale * p);
        let slack = edit_slack(&definition, p) * scale + edit_slack(&scaled, q);
        same_distance((&definition, p), (&scaled, q), scale, slack)?;
    }

    #[test]
    fn the_sense_of_the_parameters_changes_no_distance(shape in entity(), probe in probe(), swap in any::<bool>()) {
        let definition = shape.definition();
        let p = probe.about(&shape);
        let other: Definition = match &definition {
            Definition::NurbsCurve(curve) => curve.reversed().into(),
            Definition::NurbsSurface(surface) if swap => surface.swapped().into(),
            Definition::NurbsSurface(surface) => surface.reversed(Direction::U).reversed(Direction::V).into(),
        };
        same_distance((&definition, p), (&other, p), 1.0, edit_slack(&definition, p))?;
    }

    #[test]
    fn an_inserted_knot_changes_no_distance(shape in entity(), probe in probe(), share in 0.001..0.999f64) {
        let definition = shape.definition();
        let p = probe.about(&shape);
        let (u, v) = (inner_knot(&shape, 0, share), inner_knot(&shape, 1, 1.0 - share));
        let refined: Option<Definition> = match &definition {
            Definition::NurbsCurve(curve) => curve.insert_knot(u, 1).ok().map(Into::into),
            Definition::NurbsSurface(surface) => surface
                .insert_knot(Direction::U, u, 1)
                .and_then(|surface| surface.insert_knot(Direction::V, v, 1))
                .ok()
                .map(Into::into),
        };
        // refused where the knot stands there as often as the degree already
        prop_assume!(refined.is_some());
        let refined = refined.expect("assumed");
        same_distance((&definition, p), (&refined, p), 1.0, edit_slack(&definition, p))?;
    }

    #[test]
    fn a_raised_degree_changes_no_distance(shape in entity(), probe in probe(), by in 1..=2usize) {
        let definition = shape.definition();
        let p = probe.about(&shape);
        let raised: Definition = match &definition {
            Definition::NurbsCurve(curve) => curve.elevate_degree(by).expect("a low degree").into(),
            Definition::NurbsSurface(surface) => {
                let surface = surface.elevate_degree(Direction::U, by).expect("a low degree");
                surface.elevate_degree(Direction::V, 1).expect("a low degree").into()
            }
        };
        same_distance((&definition, p), (&raised, p), 1.0, edit_slack(&definition, p))?;
    }

    #[test]
    fn a_limit_beyond_the_foot_changes_no_distance_and_one_short_of_it_finds_nothing(
        shape in entity(),
        probe in probe(),
        margin in prop_oneof![Just(1e-8), 1e-8..1.0f64],
    ) {
        let definition = shape.definition();
        let p = probe.about(&shape);
        let (model, id) = model(&definition);
        let foot = model.project(id, p).expect("a finite point");
        let within = |limit: f64| {
            let options = QueryOptions { max_distance: Some(limit), ..QueryOptions::default() };
            model.project_with(id, p, &options).expect("a finite point")
        };
        let (gap, margin) = (1e-9 * shape.size(), margin * (shape.size() + foot.distance));
        let Some(limited) = within(foot.distance + margin) else {
            return Err(TestCaseError::fail(format!("nothing within {margin:e} more than {foot:?}")));
        };
        let slack = gap + edit_slack(&definition, p);
        prop_assert!((limited.distance - foot.distance).abs() <= slack, "{limited:?} and {foot:?}");
        prop_assert!(limited.lower_bound <= foot.distance && foot.lower_bound <= limited.distance, "{limited:?} and {foot:?}");
        if foot.lower_bound > margin {
            prop_assert_eq!(within(foot.lower_bound - margin), None);
        }
    }

    /// A foot is planted in a patch over the unit square and the query point put on its normal, nearer than the patch can bend: with
    /// `|f''| <= bend` no other point of the graph of `f` is as near, since `|S - p|² >= t² + |S - foot|² (1 - t bend)`.
    #[test]
    fn a_planted_foot_is_found(
        heights in prop::collection::vec(-0.2..0.2f64, 16),
        (u, v) in (0.0..=1.0f64, 0.0..=1.0f64),
        share in prop_oneof![Just(0.0), Just(1e-9), Just(1e-6), -0.9..0.9f64],
        knot in prop::option::of(0.01..0.99f64),
    ) {
        let at = |k: usize| DVec3::new((k / 4) as f64 / 3.0, (k % 4) as f64 / 3.0, heights[k]);
        let h = |i: usize, j: usize| heights[4 * i + j];
        let (mut uu, mut uv, mut vv) = (0.0_f64, 0.0_f64, 0.0_f64);
        for i in 0..4 {
            for j in 0..4 {
                if i < 2 {
                    uu = uu.max(6.0 * (h(i + 2, j) - 2.0 * h(i + 1, j) + h(i, j)).abs());
                }
                if j < 2 {
                    vv = vv.max(6.0 * (h(i, j + 2) - 2.0 * h(i, j + 1) + h(i, j)).abs());
                }
                if i < 3 && j < 3 {
                    uv = uv.max(9.0 * (h(i + 1, j + 1) - h(i + 1, j) - h(i, j + 1) + h(i, j)).abs());
                }
            }
        }
        let bend = (uu.max(vv) + uv).max(1e-3);
        let shape = Shape::surface([3, 3], [bezier_knots(3), bezier_knots(3)], (0..16).map(at).collect(), None);
        let Definition::NurbsSurface(surface) = shape.definition() else { unreachable!("a surface") };
        let planted = surface.point(u, v);
        let t = share / bend;
        let p = planted + t * surface.normal(u, v).normalize();
        let refined = match knot {
            Some(knot) => surface.insert_knot(Direction::U, knot, 1).expect("an inner knot").into(),
            None => surface.into(),
        };
        let (foot, slack) = (project(&refined, p), edit_slack(&refined, p));
        prop_assert!((foot.distance - t.abs()).abs() <= 1e-9 * shape.size() + slack, "planted at {t:e}: {foot:?}");
        prop_assert!(foot.lower_bound <= t.abs() + slack, "planted at {t:e}: {foot:?}");
        let excess = 1e-9 * shape.size() + slack;
        let astray = ((2.0 * t.abs() + excess) * excess / (1.0 - t.abs() * bend)).sqrt();
        prop_assert!((foot.point - planted).length() <= astray, "planted at {planted}, astray by at most {astray:e}: {foot:?}");
    }
}

/// An answer to the last bit: equality of numbers would take -0.0 for 0.0.
fn bits<T: std::fmt::Debug>(answers: &[T]) -> Vec<String> {
    answers.iter().map(|answer| format!("{answer:?}")).collect()
}

proptest! {
    #![proptest_config(config(200))]

    #[test]
    fn company_order_hints_and_threads_change_no_bit(
        (kind, seed) in (0..KINDS.len(), 0..1_000_000u64),
        order in prop::collection::vec(any::<Index>(), 80),
        threads in 1..=5usize,
    ) {
        let mut random = Random::new(seed);
        let adversary = adversary(kind, &mut random);
        let (model, id) = model(&adversary.shape.definition());
        let points = hard_points(&adversary, 80, &mut random);
        let options = QueryOptions::default();
        let alone: Vec<_> = points.iter().map(|p| model.project_with(id, *p, &options)).collect();
        let alone = bits(&alone);
        prop_assert_eq!(&bits(&model.project_all(id, &points, &options)), &alone, "in a batch");
        let order: Vec<usize> = order.iter().map(|index| index.index(points.len())).collect();
        let shuffled: Vec<DVec3> = order.iter().map(|i| points[*i]).collect();
        let expected: Vec<String> = order.iter().map(|i| alone[*i].clone()).collect();
        prop_assert_eq!(&bits(&model.project_all(id, &shuffled, &options)), &expected, "in another order");
        let mut projector = model.projector(id).expect("a known entity");
        let hinted: Vec<_> = shuffled.iter().map(|p| projector.project(*p, &options)).collect();
        prop_assert_eq!(&bits(&hinted), &expected, "with the last foot as a hint");
        #[cfg(not(feature = "rayon"))]
        let _ = threads;
        #[cfg(feature = "rayon")]
        {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            let many: Vec<DVec3> = points.iter().cycle().take(400).copied().collect();
            let expected: Vec<String> = alone.iter().cycle().take(400).cloned().collect();
            prop_assert_eq!(&bits(&pool.install(|| model.project_all(id, &many, &options))), &expected, "{} threads", threads);
        }
    }

    #[test]
    fn a_model_that_went_through_its_file_answers_with_the_same_bits((kind, seed) in (0..KINDS.len(), 0..1_000_000u64)) {
        let mut random = Random::new(seed);
        let adversary = adversary(kind, &mut random);
        let (model, id) = model(&adversary.shape.definition());
        let text = model.to_ron();
        let back = Model::from_ron(&text).map_err(|error| TestCaseError::fail(format!("{error}\n{text}")))?;
        prop_assert_eq!(back.to_ron(), text);
        let definition = back.entity(id).expect("the same id").definition();
        prop_assert_eq!(Shape::of(definition), adversary.shape.clone());
        let points = hard_points(&adversary, 20, &mut random);
        let options = QueryOptions::default();
        prop_assert_eq!(bits(&back.project_all(id, &points, &options)), bits(&model.project_all(id, &points, &options)));
    }
}

#[test]
fn probes_meet_every_place_that_they_name() {
    let shape = Shape::curve(1, vec![0.0, 0.0, 1.0, 1.0], vec![DVec3::ZERO, DVec3::X], None);
    assert_eq!(Probe::On(0.5, 0.0).about(&shape), 0.5 * DVec3::X);
    assert_eq!(Probe::Far(DVec3::Y).about(&shape), 1e3 * DVec3::Y);
    assert_eq!(Probe::Beside(1.0, 0.0, DVec3::Z).about(&shape), DVec3::X + 1e-7 * DVec3::Z);
}
