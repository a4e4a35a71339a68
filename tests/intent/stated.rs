//! Intents that an application states: without a note of what they made, in several steps, or by operations of its own.

use perpend::knowledge::{BuildError, MakingError};
use perpend::{Circle, CurveData, DVec3, Effect, EntityId, Frame, Intent, Line, Model, Operation, Record, ReplayError};

use super::record;

fn circle(radius: f64) -> Operation {
    Operation::CircleByCentre { centre: DVec3::ZERO, axis: DVec3::Z, radius, xdir: Some(DVec3::X) }
}

fn lifted(by: f64) -> Operation {
    Operation::Transform { columns: (DVec3::X, DVec3::Y, DVec3::Z), translation: DVec3::new(0.0, 0.0, by) }
}

/// States the steps of an entity, and nothing of what they made.
fn state(model: &mut Model, id: EntityId, steps: Vec<Intent>) {
    model.set_record(id, Record { intent: steps, ..Record::default() }).expect("valid");
}

fn rim(height: f64) -> Circle {
    Circle::whole(Frame { centre: DVec3::new(0.0, 0.0, height), ..Frame::WORLD }, 2.0).expect("valid")
}

#[test]
fn steps_run_in_their_order_each_on_what_the_one_before_it_made() {
    let mut model = Model::new();
    let id = model.insert("rim", rim(5.0)).expect("valid");
    state(
        &mut model,
        id,
        vec![Intent::new(circle(2.0), &[]), Intent::new(lifted(3.0), &[]), Intent::new(lifted(2.0), &[])],
    );
    let replay = model.replay(id).expect("all steps run");
    assert!(!replay.is_overridden && replay.drift.proven == 0.0, "{:?}", replay.drift);
    // the last step of an operation is the one that is edited
    assert_eq!(model.edit(id, lifted(4.0)), Ok(vec![id]));
    let foot = model.project(id, DVec3::new(0.0, 9.0, 7.0)).expect("a valid query");
    assert!((foot.distance - 7.0).abs() < 1e-12);
    assert_eq!(model.edit(id, circle(3.0)), Ok(vec![id]));
    let foot = model.project(id, DVec3::new(0.0, 9.0, 7.0)).expect("a valid query");
    assert!((foot.distance - 6.0).abs() < 1e-12);
    let steps: Vec<_> =
        record(&model, id).intent.iter().map(|step| (step.operation.clone(), step.of.is_some())).collect();
    assert_eq!(steps, [(circle(3.0), false), (lifted(3.0), false), (lifted(4.0), true)]);
    let error = model.edit(id, Operation::Extrude { vector: DVec3::Z }).expect_err("no such step").to_string();
    assert_eq!(
        error,
        "entity 1: none of the steps that made it is Extrude: edit one of CircleByCentre, Transform, Transform, or remake it"
    );
}

#[test]
fn a_stated_intent_holds_where_its_replay_is_the_entity() {
    let mut model = Model::new();
    let below = model.insert("rim", rim(0.0)).expect("valid");
    let [true_copy, false_copy] = [3.0, 4.0].map(|height| model.insert("copy", rim(height)).expect("valid"));
    for copy in [true_copy, false_copy] {
        state(&mut model, copy, vec![Intent::new(lifted(3.0), &[below])]);
    }
    let replay = model.replay(false_copy).expect("made");
    // a unit higher everywhere
    assert!(replay.is_overridden && (1.0..1.0 + 1e-12).contains(&replay.drift.proven), "{:?}", replay.drift);
    assert!(replay.drift.measured > 1.0 - 1e-12);
    let effects: Vec<_> = model.impact(below).expect("known").into_iter().map(|one| (one.id, one.effect)).collect();
    assert_eq!(effects, [(true_copy, Effect::Rebuilt), (false_copy, Effect::Overridden)]);
    assert_eq!(model.edit(below, circle(1.0)), Ok(vec![below, true_copy]));
    assert_eq!(model.replay(true_copy).expect("made").drift.proven, 0.0);
}

#[test]
fn a_record_that_falsely_notes_what_made_the_entity_loses_it_no_shape() {
    let mut model = Model::new();
    let below = model.insert("rim", rim(0.0)).expect("valid");
    let copy = model.make("copy", lifted(3.0), &[below]).expect("valid");
    let text = model.to_ron();
    let lie = text.replace("translation: (0.0, 0.0, 3.0)", "translation: (0.0, 0.0, 4.0)");
    assert_ne!(lie, text);
    let mut model = Model::from_ron(&lie).expect("the steps are not run on loading");
    let drawn = model.entity(copy).expect("known").definition().clone();
    assert!(model.replay(copy).expect("made").is_overridden);
    assert_eq!(model.impact(below).expect("known")[0].effect, Effect::Overridden);
    assert_eq!(model.edit(below, circle(1.0)), Ok(vec![below]));
    assert_eq!(*model.entity(copy).expect("known").definition(), drawn);
}

#[test]
fn operations_of_an_application_are_kept_as_references() {
    let made_elsewhere = || {
        let mut model = Model::new();
        let below = model.insert("rim", rim(0.0)).expect("valid");
        let data = CurveData {
            degree: 2,
            knots: vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0],
            control_points: vec![DVec3::ZERO, DVec3::new(1.0, 2.0, 0.0), DVec3::new(3.0, 0.0, 1.0)],
            weights: None,
        };
        let wave = model.insert("wave", data).expect("valid");
        let id = model.insert("made elsewhere", rim(1.0)).expect("valid");
        (model, below, wave, id)
    };
    let (_, below, wave, _) = made_elsewhere();
    let offset = Operation::Offset { distance: 0.5, normal: Some(DVec3::Z) };
    let kept = [
        (
            Operation::Other { name: "fillet".to_owned() },
            below,
            "Other is not rebuilt by perpend: it is an operation of an application",
        ),
        (
            Operation::Approximation { degree: (3, 0), points: 100, tolerance: 0.01 },
            below,
            "Approximation is not rebuilt by perpend: the points that it approximates are not in the model",
        ),
        (
            offset,
            wave,
            "Offset is not rebuilt by perpend: the offset of a curve that is no line and no circle is no NURBS curve",
        ),
    ];
    for (operation, input, message) in kept {
        for is_noted in [false, true] {
            let (mut model, _, _, id) = made_elsewhere();
            let of = is_noted.then(|| model.entity(id).expect("known").definition().fingerprint());
            state(&mut model, id, vec![Intent { of, ..Intent::new(operation.clone(), &[input]) }]);
            let Err(ReplayError::Build { source, .. }) = model.replay(id) else { panic!("{operation:?}") };
            assert!(source.is_reference() && source.to_string().starts_with(message), "{source}");
            let before = model.entity(id).expect("known").clone();
            let impact = model.impact(input).expect("known");
            let one = impact.iter().find(|one| one.id == id).expect("listed");
            let Effect::Kept { why } = &one.effect else { panic!("{one:?}") };
            assert!(matches!(why, MakingError::Build(BuildError::NotRebuilt { .. })), "{why}");
            // what it is made of moves, and it is kept
            let moved = Line::new(DVec3::ZERO, DVec3::new(1.0, 1.0, 0.0)).expect("valid").to_nurbs().expect("valid");
            model.replace(input, moved).expect("it is kept");
            assert_eq!(model.entity(id).expect("known"), &before);
        }
    }
}

#[test]
fn steps_that_name_the_wrong_entities_say_so_and_load() {
    let text = include_str!("../files/record.ron");
    let model = Model::from_ron(text).expect("what is stated of its making is not run on loading");
    let error = model.replay(EntityId::new(2)).expect_err("a circle is made of nothing");
    assert_eq!(error.to_string(), "entity 2: CircleByCentre takes no entities, and 1 are given: correct the inputs");
    assert!(matches!(model.impact(EntityId::new(4)).expect("known")[0].effect, Effect::Kept { .. }));
    assert_eq!(model.replay(EntityId::new(1)), Err(ReplayError::NotMade { id: EntityId::new(1) }));
    assert!(matches!(model.replay(EntityId::new(77)), Err(ReplayError::UnknownEntity { .. })));
}
