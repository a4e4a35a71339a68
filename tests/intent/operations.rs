//! Every operation: what is made, what the record says of it, and that it can be made again.

use perpend::knowledge::{Intent, Relation, Value};
use perpend::{
    Basis, Circle, DVec3, Definition, Direction, Frame, Kind, MakeError, Model, NurbsCurve, Operation, Origin,
    ReplayError,
};

use super::{everything, number, record};

#[test]
fn what_an_operation_made_is_made_again_bit_for_bit() {
    let (model, made) = everything();
    for (id, operation) in made {
        let replay = model.replay(id).expect("it was made");
        let entity = model.entity(id).expect("known");
        assert_eq!(&replay.definition, entity.definition().as_ref(), "{operation:?}");
        assert_eq!((replay.drift.proven, replay.drift.measured), (0.0, 0.0), "{operation:?}");
        assert!(replay.drift.is_same_structure() && !replay.is_overridden);
    }
}

#[test]
fn the_record_says_how_an_entity_was_made_and_of_what() {
    let (model, made) = everything();
    for (id, operation) in made {
        let (entity, record) = (model.entity(id).expect("known"), record(&model, id));
        let [step] = &*record.intent else { panic!("{operation:?}: {:?}", record.intent) };
        assert_eq!(step.operation, operation);
        assert_eq!(step.of, Some(entity.definition().fingerprint()));
        let class = record.classification.as_ref().expect("a class");
        match class.origin.as_ref().expect("an origin") {
            Origin::Designed => assert!(step.inputs.is_empty()),
            Origin::Derived { operation: name, from } => {
                assert_eq!((name.as_str(), from), (operation.name(), &step.inputs));
                assert!(!from.is_empty());
            }
            other => panic!("{other:?}"),
        }
        // all that replay needs stands in the relationships, too
        let targets: Vec<_> = record.relationships.iter().map(|edge| edge.target).collect();
        assert_eq!(targets, step.inputs);
        for edge in &record.relationships {
            let checked = edge.checked.expect("made just now");
            assert_eq!((checked.deviation, checked.of), (0.0, entity.definition().fingerprint()));
            assert_eq!(checked.target, model.entity(edge.target).expect("known").definition().fingerprint());
        }
        assert_eq!((entity.revision(), entity.stale()), (0, Vec::new()));
        let is_shape = operation.shape().is_some();
        let determines = matches!(operation, Operation::Extrude { .. } | Operation::Revolve { .. } | Operation::Rule);
        assert_eq!(class.kind.is_some(), is_shape || determines, "{operation:?}");
        assert!(class.kind.iter().all(|kind| kind.basis == Basis::Defined));
    }
}

#[test]
fn a_record_without_intent_is_replayed_by_its_relationships() {
    let (mut model, made) = everything();
    for (id, operation) in made {
        let mut without = record(&model, id).clone();
        without.intent.clear();
        model.set_record(id, without.clone()).expect("valid");
        if without.relationships.is_empty() {
            assert_eq!(model.replay(id), Err(ReplayError::NotMade { id }));
        } else {
            let replay = model.replay(id).expect("the relationships say all");
            assert_eq!(&replay.definition, model.entity(id).expect("known").definition().as_ref(), "{operation:?}");
        }
    }
}

#[test]
fn a_model_of_everything_is_read_as_it_was_written_and_replays_the_same() {
    let (model, made) = everything();
    let text = model.to_ron();
    let read = Model::from_ron(&text).expect("valid");
    assert_eq!(read, model);
    assert_eq!(read.to_ron(), text);
    for (id, _) in made {
        assert_eq!(read.replay(id), model.replay(id));
    }
}

#[test]
fn a_shape_that_is_inserted_carries_the_operation_that_makes_it() {
    let mut model = Model::new();
    let frame = Frame::new(DVec3::ONE, DVec3::new(0.1, 0.2, 0.9), DVec3::X).expect("a frame");
    let inserted = model.insert("rim", Circle::whole(frame, 2.0).expect("valid")).expect("valid");
    let made = model.make("rim", Circle::whole(frame, 2.0).expect("valid"), &[]).expect("valid");
    assert_eq!(record(&model, inserted).intent, record(&model, made).intent);
    let definition = |id| model.entity(id).expect("known").definition();
    assert_eq!(definition(inserted), definition(made));
    assert_eq!(model.replay(inserted).expect("made").drift.proven, 0.0);
    assert!(model.edit(inserted, Circle::whole(frame, 3.0).expect("valid")).is_ok());
}

#[test]
fn an_arc_through_points_passes_them_and_runs_in_their_order() {
    let mut model = Model::new();
    let (start, through, end) = (DVec3::new(4.0, 1.0, 0.0), DVec3::new(1.0, 2.0, 3.0), DVec3::new(-2.0, 0.0, 1.0));
    let arc = model.make("arc", Operation::ArcByPoints { start, through, end }, &[]).expect("valid");
    let Definition::NurbsCurve(curve) = model.entity(arc).expect("known").definition().as_ref().clone() else {
        panic!("an arc is a curve")
    };
    assert!(curve.point(0.0).distance(start) < 1e-14 && curve.point(1.0).distance(end) < 1e-14);
    let foot = model.project(arc, through).expect("a valid query");
    assert!(foot.distance < 1e-14);
    let kind = record(&model, arc).classification.as_ref().and_then(|class| class.kind.clone()).expect("a circle");
    assert!(matches!(kind.value, Kind::Circle { .. }));
}

#[test]
fn a_loft_passes_its_sections() {
    let (model, made) = everything();
    let (id, _) = made.iter().find(|(_, operation)| matches!(operation, Operation::Loft { .. })).expect("a loft");
    let sections = record(&model, *id).intent[0].inputs.clone();
    let curve = |id| match model.entity(id).expect("known").definition().as_ref() {
        Definition::NurbsCurve(curve) => curve.clone(),
        Definition::NurbsSurface(_) => panic!("a section is a curve"),
    };
    for (k, section) in sections.iter().enumerate() {
        let section: NurbsCurve = curve(*section);
        for step in 0..=32 {
            let point = section.point(f64::from(step) / 32.0);
            let foot = model.project(*id, point).expect("a valid query");
            // coordinates up to 10, solved to some tens of roundings
            assert!(foot.distance < 1e-13, "section {k}: {}", foot.distance);
        }
    }
}

#[test]
fn operations_that_cannot_be_run_are_refused_with_what_they_lack() {
    let mut model = Model::new();
    let line = model.make("line", Operation::LineByPoints { start: DVec3::ZERO, end: DVec3::X }, &[]).expect("valid");
    let vector = DVec3::Z;
    let plate = model.make("plate", Operation::Extrude { vector }, &[line]).expect("valid");
    let before = model.to_ron();
    let circle = |radius| Operation::CircleByCentre { centre: DVec3::ZERO, axis: DVec3::Z, radius, xdir: None };
    let points = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
    let interpolation = |degree, columns| Operation::Interpolation {
        degree,
        points: points.clone(),
        columns,
        spacing: perpend::kernel::Spacing::Uniform,
    };
    let split = |range| Operation::Split { direction: Direction::U, range };
    let refused: Vec<(Operation, Vec<perpend::EntityId>, &str)> = vec![
        (circle(f64::NAN), vec![], "CircleByCentre: radius is NaN; the parameters of an operation are finite"),
        (circle(-1.0), vec![], "CircleByCentre: radius is -1; it must be positive and finite"),
        (circle(1.0), vec![line], "CircleByCentre takes no entities, and 1 are given: correct the inputs"),
        (circle(1.0), vec![number(9)], "the model has no entity 9 to make another of"),
        (Operation::Extrude { vector }, vec![], "Extrude takes 1 entity, and 0 are given"),
        (Operation::Extrude { vector }, vec![plate], "Extrude: input 0 is a surface, and a curve is needed"),
        (Operation::Extrude { vector: DVec3::ZERO }, vec![line], "Extrude: path is [0, 0, 0]"),
        (Operation::Rule, vec![line], "Rule takes 2 entities, and 1 are given"),
        (Operation::Loft { degree: 1 }, vec![line], "Loft takes at least 2 entities, and 1 are given"),
        (Operation::Loft { degree: u32::MAX }, vec![line; 3], "Loft: 3 points and degree 4294967295"),
        (Operation::Loft { degree: 1 }, vec![line; 2], "Loft: point 1 and the one before it get the same parameter"),
        (Operation::IsoCurve { direction: Direction::U, at: 2.0 }, vec![plate], "IsoCurve: the u parameter is 2"),
        (split((0.5, 0.5)), vec![plate], "Split: range is (0.5, 0.5); it must ascend within the domain"),
        (split((-1.0, 0.5)), vec![line], "Split: range is (-1.0, 0.5); it must ascend within the domain"),
        (interpolation((3, 0), 0), vec![], "Interpolation: 3 points and degree 3"),
        (interpolation((1, 1), 2), vec![], "Interpolation: columns is 2 for 3 points"),
        (interpolation((1, 1), 0), vec![], "Interpolation: columns is 0 for 3 points"),
        (interpolation((1, 1), u64::MAX), vec![], "Interpolation: columns is 18446744073709551615 for 3 points"),
        (
            Operation::ArcByPoints { start: DVec3::ZERO, through: DVec3::X, end: 2.0 * DVec3::X },
            vec![],
            "ArcByPoints: through is [1, 0, 0]; it must differ from both ends and lie off the line through them",
        ),
        (Operation::ByData, vec![], "ByData is not rebuilt by perpend: the defining data were entered as they are"),
        (
            Operation::Other { name: "fillet".to_owned() },
            vec![line],
            "Other is not rebuilt by perpend: it is an operation",
        ),
        (
            Operation::Approximation { degree: (3, 0), points: 9, tolerance: 0.1 },
            vec![],
            "Approximation is not rebuilt by perpend: the points that it approximates are not in the model",
        ),
    ];
    for (operation, inputs, message) in refused {
        let error = model.make("no", operation.clone(), &inputs).expect_err("it cannot be made");
        assert!(error.to_string().starts_with(message), "{operation:?}: {error}");
        assert_eq!(model.to_ron(), before, "{operation:?}");
        if let MakeError::Build(error) = &error {
            assert_eq!(error.is_reference(), message.contains("not rebuilt"), "{error}");
        }
    }
}

#[test]
fn hostile_parameters_are_refused_or_give_a_valid_model() {
    let numbers = [0.0, -0.0, 1.0, -1e-300, 1e-80, 1e-60, 1e60, -1e69, 1e80, f64::MAX, f64::INFINITY, f64::NAN];
    let mut model = Model::new();
    let point = |a: f64, b: f64, c: f64| DVec3::new(a, b, c);
    let line = model
        .make("line", Operation::LineByPoints { start: DVec3::ZERO, end: DVec3::new(1.0, 2.0, 3.0) }, &[])
        .expect("valid");
    let plate = model.make("plate", Operation::Extrude { vector: DVec3::Z }, &[line]).expect("valid");
    let (mut made, mut refused) = (0, 0);
    for (k, a) in numbers.into_iter().enumerate() {
        for (l, b) in numbers.into_iter().enumerate() {
            let c = numbers[(3 * k + 5 * l) % numbers.len()];
            let v = point(a, b, c);
            let (x, y) = (point(b, c, 1.0), point(1.0, a, b));
            let operations = [
                (Operation::LineByPoints { start: v, end: x }, vec![]),
                (Operation::CircleByCentre { centre: v, axis: x, radius: a, xdir: Some(y) }, vec![]),
                (Operation::ArcByPoints { start: v, through: x, end: y }, vec![]),
                (
                    Operation::SphereByCentre {
                        centre: x,
                        axis: DVec3::Z,
                        xdir: y,
                        radius: b,
                        latitude: (c, a),
                        sweep: (a, b),
                    },
                    vec![],
                ),
                (
                    Operation::ConeByFrame {
                        centre: v,
                        axis: x,
                        xdir: y,
                        radii: (a, b),
                        height: (b, c),
                        sweep: (0.0, a),
                    },
                    vec![],
                ),
                (Operation::Extrude { vector: v }, vec![line]),
                (Operation::Revolve { origin: v, axis: x, angle: b }, vec![line]),
                (Operation::Offset { distance: a, normal: Some(v) }, vec![line]),
                (Operation::Offset { distance: b, normal: None }, vec![plate]),
                (Operation::Split { direction: Direction::V, range: (a, b) }, vec![plate]),
                (Operation::Transform { columns: (v, x, y), translation: x }, vec![plate]),
            ];
            for (operation, inputs) in operations {
                let mut trial = model.clone();
                match trial.make("trial", operation.clone(), &inputs) {
                    Ok(id) => {
                        made += 1;
                        let read = Model::from_ron(&trial.to_ron()).expect("what was made can be read");
                        assert_eq!(read, trial, "{operation:?}");
                        assert_eq!(read.replay(id).expect("made").drift.proven, 0.0, "{operation:?}");
                        let foot = read.project(id, DVec3::ONE).expect("a valid query");
                        assert!(foot.distance.is_finite() && foot.lower_bound <= foot.distance);
                    }
                    Err(error) => {
                        refused += 1;
                        assert!(!error.to_string().is_empty());
                        assert_eq!(trial, model);
                    }
                }
            }
        }
    }
    assert!(made > 100 && refused > 100, "{made} made, {refused} refused");
}

#[test]
fn relationships_are_checked_by_their_own_parameters() {
    let (mut model, made) = everything();
    let is_extrusion = |operation: &Operation| matches!(operation, Operation::Extrude { .. });
    let (id, _) = *made.iter().find(|(_, operation)| is_extrusion(operation)).as_ref().expect("one");
    let id = *id;
    // a relationship that lies: the intent is right, and so replay finds nothing
    let mut lying = record(&model, id).clone();
    lying.relationships[0].parameters.insert("vector".to_owned(), Value::Point(DVec3::new(0.0, 0.3, 2.5)));
    assert_eq!(lying.relationships[0].kind, Relation::Profile);
    model.set_record(id, lying).expect("valid");
    assert_eq!(model.replay(id).expect("made").drift.proven, 0.0);
    let revision = model.entity(id).expect("known").revision();
    let drift = model.check_relationships(id).expect("they say all");
    // the far edge is 0.5 off
    assert!((0.5..0.5 + 1e-12).contains(&drift.proven) && drift.measured <= drift.proven, "{drift:?}");
    assert!(drift.measured > 0.5 - 1e-12);
    let checked = record(&model, id).relationships[0].checked.expect("just now");
    assert_eq!(checked.deviation, drift.proven);
    assert!(checked.deviation > checked.tolerance);
    assert_eq!(model.entity(id).expect("known").revision(), revision);
    let plain = Intent::new(Operation::Rule, &[]);
    assert!(plain.relationships().is_empty());
    let error = model.check_relationships(number(1)).expect_err("a line has none");
    assert!(matches!(error, ReplayError::Unrelated { .. }));
}
