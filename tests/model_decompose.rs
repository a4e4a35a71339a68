//! Curves are taken apart where they have cusps and loops; the parts have none, and are the curve.

mod common;

use common::random::Random;
use glam::DVec3;
use perpend::knowledge::{AcquireOptions, Irregularity, ParameterPoint, Value, acquire, cuts};
use perpend::{Definition, EditError, EntityId, Model, NurbsCurve, Relation};

fn cubic(points: [(f64, f64); 4]) -> NurbsCurve {
    let points = points.map(|(x, y)| DVec3::new(x, y, 0.0)).to_vec();
    NurbsCurve::new(3, vec![0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0], points, None).expect("valid")
}

/// A cubic that crosses itself once.
fn ribbon() -> NurbsCurve {
    cubic([(0.0, 2.0), (-1.0, 0.0), (1.0, 1.0), (-0.75, 1.625)])
}

/// The semicubical parabola `(s², s³)` over `s = 2 t - 1`: its cusp is in the middle.
fn spike() -> NurbsCurve {
    cubic([(1.0, -1.0), (-1.0 / 3.0, 1.0), (-1.0 / 3.0, -1.0), (1.0, 1.0)])
}

fn curve(model: &Model, id: EntityId) -> NurbsCurve {
    match model.entity(id).expect("an entity").definition().as_ref() {
        Definition::NurbsCurve(curve) => curve.clone(),
        Definition::NurbsSurface(_) => panic!("a curve"),
    }
}

/// Panics where a part has a cusp inside or a loop; ends may have a derivative that vanishes, and may meet.
fn is_plain(part: &NurbsCurve) {
    let known = acquire(&part.clone().into(), &AcquireOptions::default());
    let (first, last) = part.domain();
    for item in known.irregularities.expect("acquired") {
        match item.value {
            Irregularity::Cusp { at: ParameterPoint::Curve(u), .. }
            | Irregularity::VanishingDerivative { at: ParameterPoint::Curve(u), .. } => {
                let inside = (u - first).min(last - u) / (last - first);
                assert!(inside < 1e-6, "{:?}", item.value);
            }
            Irregularity::Loop { .. } => panic!("{:?}", item.value),
            _ => {}
        }
    }
    // an oracle of its own: chords between sampled points that cross
    let n = 400;
    let at = |k: i32| part.point(first + (last - first) * f64::from(k) / f64::from(n));
    for i in 0..n {
        // the ends may meet
        for j in i + 2..n - i32::from(i == 0) {
            let ([a, b], [c, d]) = ([at(i), at(i + 1)], [at(j), at(j + 1)]);
            let side = |p: DVec3, q: DVec3, r: DVec3| (q - p).truncate().perp_dot((r - p).truncate());
            let crosses = side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0;
            assert!(!crosses, "the part over {:?} crosses itself near {a}", part.domain());
        }
    }
}

/// Takes a curve apart and checks that the parts are it.
fn taken_apart(curve: NurbsCurve) -> (Model, Vec<EntityId>) {
    let mut model = Model::new();
    let id = model.insert("it", curve.clone()).expect("valid");
    let before = model.entity(id).expect("an entity").clone();
    let parts = model.decompose(id).expect("a curve");
    assert_eq!(model.entity(id), Some(&before), "the curve stays");
    let mut at = curve.domain().0;
    for part in &parts {
        let part = self::curve(&model, *part);
        let (first, last) = part.domain();
        assert_eq!(first, at);
        for k in 0..=100 {
            let u = first + (last - first) * f64::from(k) / 100.0;
            assert!(part.point(u).distance(curve.point(u)) < 1e-14 * (1.0 + before.definition().reach()));
        }
        is_plain(&part);
        at = last;
    }
    assert!(parts.is_empty() || at == curve.domain().1);
    (model, parts)
}

#[test]
fn a_loop_is_cut_where_the_curve_meets_itself() {
    let ribbon = ribbon();
    let at = cuts(&ribbon);
    let [from, to] = at[..] else { panic!("{at:?}") };
    assert!(ribbon.point(from).distance(ribbon.point(to)) < 1e-12, "{at:?}");
    let (model, parts) = taken_apart(ribbon);
    assert_eq!(parts.len(), 3);
    assert_eq!(model.entity(parts[1]).expect("a part").name(), "it 2 of 3");
}

#[test]
fn a_cusp_is_cut() {
    let at = cuts(&spike());
    assert!(at.len() == 1 && (at[0] - 0.5).abs() < 1e-6, "{at:?}");
    let (_, parts) = taken_apart(spike());
    assert_eq!(parts.len(), 2);
    // it lies on a knot too
    let (_, parts) = taken_apart(spike().insert_knot(0.5, 2).expect("inside"));
    assert_eq!(parts.len(), 2);
}

#[test]
fn a_line_that_turns_back_is_cut_and_a_corner_is_not() {
    let line = |points: &[(f64, f64)]| {
        let points: Vec<DVec3> = points.iter().map(|(x, y)| DVec3::new(*x, *y, 0.0)).collect();
        let mut knots = vec![0.0];
        knots.extend((0..points.len()).map(|k| k as f64));
        knots.push((points.len() - 1) as f64);
        NurbsCurve::new(1, knots, points, None).expect("valid")
    };
    assert_eq!(cuts(&line(&[(0.0, 0.0), (2.0, 0.0), (1.0, 0.1)])), [1.0]);
    assert_eq!(cuts(&line(&[(0.0, 0.0), (2.0, 0.0), (2.0, 1.0)])), [0.0; 0]);
    let eight = line(&[(0.0, 0.0), (2.0, 2.0), (2.0, 0.0), (0.0, 2.0)]);
    let (_, parts) = taken_apart(eight);
    assert!(parts.len() >= 3, "{}", parts.len());
}

#[test]
fn many_loops_are_cut() {
    // a chain of loops, in other places and forms
    let mut random = Random::new(31_030);
    for round in 0..10 {
        let count = 12;
        let points = (0..count).map(|k| {
            let t = 1.9 * f64::from(k);
            DVec3::new(0.35 * t + 2.0 * t.cos(), 2.0 * t.sin(), 0.0) + 0.1 * random.in_cube().with_z(0.0)
        });
        let mut knots = vec![0.0; 4];
        knots.extend((1..count - 3).map(f64::from));
        knots.extend([f64::from(count - 3); 4]);
        let curve = NurbsCurve::new(3, knots, points.collect(), None).expect("valid");
        let (_, parts) = taken_apart(curve);
        assert!(parts.len() >= 3, "round {round}: {} parts", parts.len());
    }
}

#[test]
fn parts_say_what_they_are_and_hold_what_they_are_of() {
    let (mut model, parts) = taken_apart(ribbon());
    let whole = EntityId::new(1);
    let part = model.entity(parts[0]).expect("a part");
    let record = part.record().expect("a record");
    let relationship = &record.relationships[0];
    let (first, last) = curve(&model, parts[0]).domain();
    assert_eq!((&relationship.kind, relationship.target), (&Relation::PartOf, whole));
    assert_eq!(relationship.parameters["range"], Value::Numbers(vec![first, last]));
    assert_eq!(record.intent[0].inputs, [whole]);
    assert!(matches!(model.remove(whole), Err(EditError::InUse { .. })));
    let text = model.to_ron();
    assert_eq!(Model::from_ron(&text).expect("valid"), model);
}

#[test]
fn what_is_plain_stays_whole() {
    let mut model = Model::new();
    let arc = model.insert("", cubic([(0.0, 0.0), (1.0, 2.0), (2.0, 2.0), (3.0, 0.0)])).expect("valid");
    let text = model.to_ron();
    assert_eq!(model.decompose(arc), Ok(Vec::new()));
    let missing = EntityId::new(9);
    assert_eq!(model.decompose(missing), Err(EditError::UnknownEntity { id: missing }));
    assert_eq!(model.to_ron(), text);
}

#[test]
fn a_model_that_has_no_ids_left_for_the_parts_says_so() {
    let mut model = Model::new();
    let id = model.insert("ribbon", ribbon()).expect("valid");
    let text = model.to_ron();
    let last = text.replace("next_id: 2,", &format!("next_id: {},", u64::MAX - 2));
    assert_ne!(last, text);
    let mut model = Model::from_ron(&last).expect("valid");
    let error = model.decompose(id).expect_err("three parts and two ids");
    assert_eq!(error, EditError::NoIds { id, count: 3, last: u64::MAX - 3 });
    assert_eq!(model.to_ron(), last);
}
