//! Knowledge that lies, with the fingerprint of the very definition: loading refuses a false class with the measured deviation; in a
//! model that holds a lie already, of the class or of how the parametrisation behaves, no answer changes but in its last digits.

mod common;

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use common::exact::Exact;
use common::judgement::{EPSILON, is_certified, judge};
use common::known::{known, with_record};
use common::random::Random;
use common::shape::Shape;
use glam::DVec3;
use perpend::{
    Basis, Classification, Definition, Direction, Frame, Item, Kind, Model, QueryOptions, Record, Representation, Trust,
};
use serde_json::{Value, json};

fn shapes() -> Vec<Exact> {
    let frame = Frame::new(DVec3::new(1.0, -2.0, 0.5), DVec3::new(0.0, 0.6, 0.8), DVec3::X).expect("a frame");
    let (height, sweep) = ((-1.0, 2.0), (0.5, 3.0));
    vec![
        Exact::Segment { a: DVec3::ZERO, b: DVec3::new(1.0, 2.0, 3.0) },
        Exact::Circle { frame, radius: 1.5, sweep },
        Exact::Circle { frame, radius: 1.5, sweep: (0.0, TAU) },
        Exact::Ellipse { frame, radii: (2.0, 1.0), sweep },
        Exact::Parallelogram { corner: DVec3::ONE, a: DVec3::X, b: DVec3::new(0.5, 2.0, 0.0) },
        Exact::Cylinder { frame, radius: 1.5, height, sweep },
        Exact::Cylinder { frame, radius: 1.5, height, sweep: (0.0, TAU) },
        Exact::Cone { frame, radii: (2.0, 0.0), height, sweep: (0.0, TAU) },
        Exact::Cone { frame, radii: (0.5, 2.0), height, sweep },
        Exact::Sphere { frame, radius: 1.5, latitude: (-FRAC_PI_2, FRAC_PI_2), sweep: (0.0, TAU) },
        Exact::Sphere { frame, radius: 1.5, latitude: (-0.5, 1.0), sweep },
        Exact::Torus { frame, major: 2.0, minor: 0.5, tube: (0.0, TAU), sweep: (0.0, TAU) },
        Exact::Torus { frame, major: 2.0, minor: 0.5, tube: (1.0, 4.0), sweep },
    ]
}

/// A false class, and how far the definition is from it at least, as a length.
struct Lie {
    what: &'static str,
    kind: Kind,
    deviation: f64,
}

/// The class in other words, each of them false. Fields are changed by their names in serde's form.
fn lies(kind: &Kind, is_curve: bool) -> Vec<Lie> {
    let plain = serde_json::to_value(kind).expect("a class has a form in JSON");
    let class = plain.as_object().and_then(|class| class.keys().next()).expect("a class with fields").clone();
    let number = |value: &Value| value.as_f64().expect("a number");
    let mut lies = Vec::new();
    let mut lie = |what, deviation, json: &Value| {
        let kind = serde_json::from_value(json.clone()).unwrap_or_else(|e| panic!("{what}: {e} in {json}"));
        lies.push(Lie { what, kind, deviation });
    };
    for (field, value) in plain[&class].as_object().expect("fields") {
        let mut set = |what, deviation, value: Value| {
            let mut json = plain.clone();
            json[&class][field] = value;
            lie(what, deviation, &json);
        };
        let pair = value.as_array().filter(|list| list.len() == 2 && list[0].is_number());
        match (field.as_str(), pair) {
            ("radius" | "major_radius" | "minor_radius", _) => {
                let radius = number(value);
                set("a radius", 1e-3 * radius, json!(radius * 1.001));
                set("a radius, a little", 1e-6 * radius, json!(radius * 1.000_001));
            }
            ("centre" | "apex" | "origin", _) => {
                let moved = |by: f64| json!([number(&value[0]) + by, number(&value[1]) + by, number(&value[2]) + by]);
                // along a line or plane nothing would show
                set("the origin", 0.0, moved(0.01));
                set("the origin, far away", 1.0, moved(1e5));
            }
            ("axis" | "normal" | "direction", _) => {
                // another direction, and what is perpendicular to it
                let [x, y, z] = [0, 1, 2].map(|k| number(&value[k]));
                set("the axis, backwards and not straightened", 0.0, json!([-x + 0.1, -y, -z]));
            }
            ("sweep" | "section" | "latitude" | "height" | "range" | "radii", Some(pair)) => {
                let (from, to) = (number(&pair[0]), number(&pair[1]));
                let sign = (to - from).signum();
                // of a full turn, samples may miss what is cut off
                let missed = if (to - from).abs() > 6.0 { 0.0 } else { 1e-3 };
                set("a range that stops short", missed, json!([from, to - 0.01 * sign]));
                set("a range that starts late", missed, json!([from + 0.01 * sign, to]));
                if (to - from).abs() < 6.0 && !matches!(field.as_str(), "radii" | "height") {
                    set("a range that goes too far", 0.0, json!([from, to + 0.01 * sign]));
                }
                if (to - from).abs() < PI {
                    set("a range backwards", 0.0, json!([to, from]));
                }
            }
            ("half_angle", _) => set("the angle", 1e-4, json!(number(value) * 1.001)),
            ("angular", _) => {
                set("the wrong direction", 0.0, json!(if value == "U" { "V" } else { "U" }));
            }
            _ => {}
        }
    }
    let others = if is_curve {
        vec![Kind::Line { origin: DVec3::ZERO, direction: DVec3::X, range: (0.0, 1.0) }]
    } else {
        let (origin, axis, xdir) = (DVec3::ZERO, DVec3::Z, DVec3::X);
        let (sweep, angular) = ((0.0, TAU), Direction::U);
        vec![
            Kind::Plane { origin, normal: axis, sides: Some((DVec3::X, DVec3::Y)) },
            Kind::Plane { origin, normal: axis, sides: None },
            Kind::Sphere { centre: origin, axis, xdir, radius: 1.0, sweep, latitude: (-1.0, 1.0), angular },
            Kind::Cylinder { centre: origin, axis, xdir, radius: 1.0, height: (0.0, 1.0), sweep, angular },
            Kind::Revolution { origin, axis, sweep: TAU, angular },
            Kind::Extrusion { vector: DVec3::new(0.3, 0.2, 0.9), along: Direction::V },
        ]
    };
    lies.extend(others.into_iter().map(|kind| Lie { what: "another class", kind, deviation: 0.0 }));
    lies
}

fn stated(definition: &Definition, kind: Kind, basis: Basis, tolerance: f64) -> Record {
    let item = Item { value: kind, basis, tolerance, of: definition.fingerprint() };
    let classification = Some(Classification { kind: Some(item), ..Classification::default() });
    Record { classification, ..Record::default() }
}

fn queries(exact: &Exact, seed: u64, count: usize) -> Vec<DVec3> {
    let mut random = Random::new(seed);
    let shape = Shape::of(&exact.made().0);
    let [low, high] = shape.bounds();
    let (middle, size) = (0.5 * (low + high), shape.size());
    (0..count)
        .map(|k| {
            let at = [0, 1].map(|k| random.between(shape.domain(k)[0], shape.domain(k)[1]));
            let on = shape.point(at[0], at[1]);
            match k % 4 {
                0 => middle + size * random.in_cube(),
                1 => on + size * random.power(-9.0, -2.0) * random.direction(),
                2 => middle + size * random.power(0.0, 3.0) * random.direction(),
                _ => on,
            }
        })
        .collect()
}

/// Holds the answers of a model to the exact distance, whatever it believes.
fn answers_truly(what: &str, exact: &Exact, model: &Model, points: &[DVec3]) {
    let entity = &model.entities()[0];
    let shape = Shape::of(entity.definition());
    for (k, p) in points.iter().enumerate() {
        let gap = [1e-9, 1e-9, 1e-3][k % 3] * shape.size();
        let options = QueryOptions { gap: Some(gap), ..QueryOptions::default() };
        let foot = model.project_with(entity.id(), *p, &options).expect("a good query").expect("no limit");
        let exactly = exact.distance(*p);
        let judged = judge(&shape, entity.definition(), *p, &foot, gap, exactly);
        assert!(judged.fault.is_none(), "{what} at {p:?}: {judged:?}, the distance is {exactly:e}, {foot:?}");
        let reach = shape.reach();
        assert!(is_certified(foot.distance, foot.lower_bound, gap, reach, *p), "{what} at {p:?}: {foot:?}");
        let rounding = 16.0 * EPSILON * (reach + exact.reach() + p.abs().max_element());
        assert!((foot.distance - exactly).abs() <= gap + rounding, "{what} at {p:?}: {exactly:e}, {foot:?}");
    }
}

/// The deviation that a message measures: "is 1.250e-1 from it".
fn measured(message: &str) -> Option<f64> {
    let (before, _) = message.split_once(" from it")?;
    before.rsplit(' ').next()?.parse().ok()
}

#[test]
fn a_false_class_is_refused_on_loading_with_the_measured_deviation() {
    let bases = [
        Basis::Defined,
        Basis::Declared,
        Basis::Proved { gap: 0.0 },
        Basis::Fitted { residual: 0.0, points: 1_000_000 },
    ];
    let (mut refused, mut with_deviation) = (0, 0);
    for exact in shapes() {
        let (definition, kind) = exact.made();
        let is_curve = matches!(definition, Definition::NurbsCurve(_));
        for Lie { what, kind, deviation } in lies(&kind.expect("a class"), is_curve) {
            for basis in bases {
                let record = stated(&definition, kind.clone(), basis, 1e-10 * definition.size());
                // a model may refuse the record itself
                let Ok(model) = with_record(&definition, Some(record)) else { continue };
                let text = model.to_ron();
                let what = format!("{}: {what}, {basis:?}: {kind:?}", exact.class());
                let Err(error) = Model::from_ron(&text) else { panic!("{what} is believed") };
                let message = error.to_string();
                refused += 1;
                assert_eq!(error.entity, Some(model.entities()[0].id()), "{what}: {message}");
                assert!(message.contains("classification.kind"), "{what}: {message}");
                if let Some(off) = measured(&message) {
                    with_deviation += 1;
                    assert!(off >= 0.5 * deviation, "{what}: {deviation:e} off at least, {message}");
                }
                let repaired = Model::from_ron_with(&text, Trust::Repair).expect("repaired");
                answers_truly(&what, &exact, &repaired, &queries(&exact, 1, 3));
            }
        }
    }
    assert!(refused >= 400, "{refused} lies");
    assert!(4 * with_deviation >= 3 * refused, "{with_deviation} of {refused} refusals measure the deviation");
}

#[test]
fn a_radius_that_lies_is_measured() {
    for exact in shapes() {
        let (definition, kind) = exact.made();
        let kind = kind.expect("a class");
        let is_curve = matches!(definition, Definition::NurbsCurve(_));
        for lie in lies(&kind, is_curve).into_iter().filter(|lie| lie.what.starts_with("a radius")) {
            let record = stated(&definition, lie.kind.clone(), Basis::Defined, 1e-10 * definition.size());
            let Ok(model) = with_record(&definition, Some(record)) else { continue };
            let message = Model::from_ron(&model.to_ron()).expect_err("a lie").to_string();
            let off = measured(&message).unwrap_or_else(|| panic!("no deviation in {message}"));
            // at most what the ends of a wider arc are farther apart by
            let close = (0.99..=2.0).contains(&(off / lie.deviation));
            assert!(close, "{:?} is {:e} off: {message}", lie.kind, lie.deviation);
        }
    }
}

#[test]
fn a_false_class_in_a_model_changes_no_answer() {
    for exact in shapes() {
        let (definition, kind) = exact.made();
        let is_curve = matches!(definition, Definition::NurbsCurve(_));
        let points = queries(&exact, 2, 12);
        for Lie { what, kind, .. } in lies(&kind.expect("a class"), is_curve) {
            // a tolerance under which the lie passes is one more lie
            for tolerance in [0.0, 1e-10, 1e-2, 1e3] {
                for basis in [Basis::Defined, Basis::Proved { gap: 0.0 }] {
                    let record = stated(&definition, kind.clone(), basis, tolerance * definition.size());
                    let Ok(model) = with_record(&definition, Some(record)) else { continue };
                    answers_truly(&format!("{what} within {tolerance:e}: {kind:?}"), &exact, &model, &points);
                }
            }
        }
    }
}

#[test]
fn knowledge_of_another_definition_changes_no_answer() {
    let shapes = shapes();
    for (k, exact) in shapes.iter().enumerate() {
        let definition = exact.made().0;
        let points = queries(exact, 4, 12);
        for other in shapes.iter().skip(k + 1).chain(&shapes[..k]) {
            // all that is true of another entity, by its own fingerprint
            let model = with_record(&definition, Some(known(&other.made().0))).expect("stale, not false");
            answers_truly("stale", exact, &model, &points);
            // the same entity, asked, changed, and asked again
            let mut edited = with_record(&other.made().0, None).expect("valid");
            let id = edited.entities()[0].id();
            edited.learn(id).expect("the entity is there");
            answers_truly("before", other, &edited, &queries(other, 5, 2));
            edited.replace(id, definition.clone()).expect("valid");
            answers_truly("replaced", exact, &edited, &points[..4]);
        }
    }
}

/// Lies about how the parametrisation of a definition behaves, as fields of the record's part.
fn false_representations(definition: &Definition) -> Vec<(&'static str, Value)> {
    let of = json!(definition.fingerprint());
    let item = |value: Value| json!({ "value": value, "basis": "Defined", "tolerance": 0.0, "of": of });
    let proved =
        |value: Value| json!({ "value": value, "basis": { "Proved": { "gap": 0.0 } }, "tolerance": 0.0, "of": of });
    let shape = Shape::of(definition);
    let [first, last] = shape.domain(0);
    let inside = |share: f64| first + share * (last - first);
    let is_curve = shape.curve;
    let at = |share: f64| {
        if is_curve { json!({ "Curve": inside(share) }) } else { json!({ "Surface": [inside(share), 0.5] }) }
    };
    let beside = first.next_up();
    let cusps = |places: Vec<f64>| -> Value {
        let cusp = |u: f64| {
            let at = if is_curve { json!({ "Curve": u }) } else { json!({ "Surface": [u, 0.5] }) };
            proved(json!({ "Cusp": { "at": at, "angle": 1.0 } }))
        };
        json!({ "irregularities": places.into_iter().map(cusp).collect::<Vec<_>>() })
    };
    let mut crowd = vec![beside];
    (0..300).for_each(|_| crowd.push(crowd[crowd.len() - 1].next_up()));
    vec![
        (
            "speeds",
            json!({ "speed": [item(json!({ "direction": "U", "min": 1e300, "max": 1e-300, "factor": -7.0 }))] }),
        ),
        (
            "no speed at all",
            json!({ "speed": [proved(json!({ "direction": "V", "min": 0.0, "max": 0.0, "factor": 1.0 }))] }),
        ),
        ("no breaks", json!({ "breaks": [] })),
        (
            "breaks",
            json!({ "breaks": [item(json!({ "direction": "U", "at": inside(0.3), "c": 0, "g": 0 })),
                item(json!({ "direction": "V", "at": -1e9, "c": 4_000_000_000_u32, "g": 0 }))] }),
        ),
        ("closed", json!({ "closed": proved(json!([true, true])) })),
        ("open", json!({ "closed": proved(json!([false, false])) })),
        ("no irregularities", json!({ "irregularities": [] })),
        ("a cusp", cusps(vec![inside(0.37)])),
        (
            "cusps at the ends, beside them and outside",
            cusps(vec![first, last, beside, last.next_down(), -1e300, 1e300]),
        ),
        ("a crowd of cusps", cusps(crowd)),
        ("cusps everywhere", cusps((1..500).map(|k| inside(f64::from(k) / 500.0)).collect())),
        (
            "loops, poles, creases, seams, inflections",
            json!({ "irregularities": [
                proved(json!({ "Loop": { "from": inside(0.9), "to": inside(0.1), "gap": 0.0 } })),
                proved(json!({ "Loop": { "from": inside(0.5), "to": inside(0.5), "gap": -1.0 } })),
                proved(json!({ "Pole": { "direction": "U", "at": first, "extent": 0.0 } })),
                proved(json!({ "Pole": { "direction": "V", "at": 1.0, "extent": 0.0 } })),
                proved(json!({ "Seam": { "direction": "V" } })),
                proved(json!({ "Crease": { "direction": "U", "at": inside(0.5), "angle": 3.0 } })),
                proved(json!({ "Inflection": { "at": at(0.4) } })),
                proved(json!({ "VanishingDerivative": { "direction": "U", "at": at(0.6), "speed": 0.0 } })),
                proved(json!({ "NearKnots": { "direction": "U", "at": first, "apart": 0.0 } })),
                proved(json!({ "TinySpan": { "direction": "U", "at": first, "extent": 0.0 } })),
            ] }),
        ),
        ("a box elsewhere", json!({ "box": proved(json!({ "min": [1e6, 1e6, 1e6], "max": [1e6, 1e6, 1e6] })) })),
        ("no length", json!({ "length": proved(json!(0.0)) })),
        ("no area", json!({ "area": proved(json!(0.0)) })),
        ("weights", json!({ "weights": proved(json!([1e-100, 1e100])) })),
        ("an unclamped past", json!({ "cleaning": [item(json!({ "Clamped": { "direction": "U" } }))] })),
    ]
}

#[test]
fn a_false_parametrisation_changes_no_answer() {
    let free = Shape::curve(
        3,
        vec![0.0, 0.0, 0.0, 0.0, 0.4, 1.0, 1.0, 1.0, 1.0],
        [(0.0, 0.0), (1.0, 2.0), (-0.5, 2.5), (1.5, 0.5), (2.0, 2.0)].map(|(x, y)| DVec3::new(x, y, 0.3 * x)).to_vec(),
        Some(vec![1.0, 0.5, 2.0, 1.5, 1.0]),
    );
    let extruded = Exact::Extrusion { profile: free.clone(), vector: DVec3::new(0.1, 0.2, 1.0) };
    let turned = Exact::Revolution { profile: free, origin: DVec3::new(-2.0, 0.0, 0.0), axis: DVec3::Y, sweep: TAU };
    let mut refused = 0;
    for exact in shapes().into_iter().chain([extruded, turned]) {
        let definition = exact.made().0;
        let points = queries(&exact, 3, 12);
        for (what, lie) in false_representations(&definition) {
            let representation: Representation = serde_json::from_value(lie).unwrap_or_else(|e| panic!("{what}: {e}"));
            // with the true class, whose closed form may answer, and stated to be free
            let free = stated(&definition, Kind::FreeForm, Basis::Declared, 0.0);
            for record in [known(&definition), free] {
                let record = Record { representation: Some(representation.clone()), ..record };
                let Ok(model) = with_record(&definition, Some(record)) else { continue };
                let what = format!("{}: {what}", exact.class());
                answers_truly(&what, &exact, &model, &points);
                // a file that says so is refused by the name of the field; what is not seen to be false does no harm
                let text = model.to_ron();
                match Model::from_ron(&text) {
                    Ok(believed) => answers_truly(&what, &exact, &believed, &points[..4]),
                    Err(error) => {
                        assert!(error.to_string().contains("representation."), "{what}: {error}");
                        refused += 1;
                    }
                }
                let repaired = Model::from_ron_with(&text, Trust::Repair).unwrap_or_else(|e| panic!("{what}: {e}"));
                answers_truly(&what, &exact, &repaired, &points[..4]);
            }
        }
    }
    assert!(refused >= 100, "{refused} false parametrisations are refused");
}
