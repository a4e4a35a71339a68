//! Nothing is made of itself: not by an edit, not by a record, not by a file.

use perpend::{DVec3, Direction, EditError, Intent, Model, Operation, RebuildError};

use super::edits::chain;
use super::{number, record};

#[test]
fn an_entity_that_would_be_made_of_itself_is_refused() {
    let (mut model, [rim, pipe, waist, cone]) = chain();
    let before = model.to_ron();
    let up = Operation::Extrude { vector: DVec3::Z };
    let at = Operation::IsoCurve { direction: Direction::U, at: 0.5 };
    assert_eq!(
        model.remake(rim, at, &[cone]).map_err(|error| error.to_string()),
        Err("entity 1 would be made of itself (1 -> 4 -> 1): name other inputs".to_owned())
    );
    let Err(RebuildError::Cycle { id, circle }) = model.remake(pipe, up.clone(), &[waist]) else { panic!("a circle") };
    assert_eq!((id, circle), (pipe, vec![pipe, waist]));
    let Err(RebuildError::Cycle { circle, .. }) = model.remake(rim, up.clone(), &[rim]) else { panic!("a circle") };
    assert_eq!(circle, [rim]);
    assert!(matches!(model.make("self", up, &[number(5)]), Err(perpend::MakeError::UnknownInput { .. })));
    assert_eq!(model.to_ron(), before);
}

#[test]
fn a_record_that_makes_an_entity_of_itself_is_refused() {
    let (mut model, [rim, pipe, waist, _]) = chain();
    let before = model.to_ron();
    for inputs in [vec![rim], vec![pipe], vec![waist]] {
        let mut lying = record(&model, rim).clone();
        lying.intent = vec![Intent::new(Operation::Extrude { vector: DVec3::Z }, &inputs)];
        let error = model.set_record(rim, lying).expect_err("a circle");
        let EditError::Rebuild(error) = error else { panic!("{error}") };
        assert!(matches!(*error, RebuildError::Cycle { id, .. } if id == rim), "{error}");
        // relationships say it as well
        let mut lying = record(&model, rim).clone();
        lying.intent.clear();
        lying.relationships = Intent::new(Operation::Extrude { vector: DVec3::Z }, &inputs).relationships();
        assert!(matches!(model.set_record(rim, lying), Err(EditError::Rebuild(_))));
    }
    assert_eq!(model.to_ron(), before);
}

#[test]
fn steps_that_are_history_make_no_circle() {
    let (mut model, [rim, pipe, ..]) = chain();
    // once extruded from the pipe's rim, since then a circle again
    let mut record = record(&model, rim).clone();
    record.intent.insert(0, Intent::new(Operation::IsoCurve { direction: Direction::V, at: 0.0 }, &[pipe]));
    model.set_record(rim, record).expect("what is in force depends on nothing");
    assert_eq!(Model::from_ron(&model.to_ron()).expect("no circle"), model);
    assert_eq!(model.replay(rim).expect("made").drift.proven, 0.0);
}

#[test]
fn a_file_whose_intents_form_a_circle_is_refused_with_the_ids() {
    let (model, _) = chain();
    let text = model.to_ron();
    let Some(intent) = text.find("operation: CircleByCentre") else { panic!("the rim has an intent") };
    let inputs = intent + text[intent..].find("inputs: []").expect("no inputs");
    for (inputs_text, message) in [
        ("inputs: [3]", "the entity is made of itself (1 -> 2 -> 3 -> 1): remove one of these inputs"),
        ("inputs: [1]", "the entity is made of itself (1 -> 1): remove one of these inputs"),
    ] {
        let circular = format!("{}{inputs_text}{}", &text[..inputs], &text[inputs + "inputs: []".len()..]);
        let error = Model::from_ron(&circular).expect_err("a circle");
        assert_eq!(error.entity, Some(number(1)));
        assert!(error.to_string().ends_with(message), "{error}");
    }
}
