//! Definitions that were replaced by hand after they had been made: kept, named, and given up only where that is asked for.

use perpend::{CurveData, DVec3, Effect, EntityId, Model, Operation, RebuildError};

use super::edits::chain;
use super::record;

fn circle(radius: f64) -> Operation {
    Operation::CircleByCentre { centre: DVec3::ZERO, axis: DVec3::Z, radius, xdir: Some(DVec3::X) }
}

/// A waist as somebody drew it.
fn drawn() -> CurveData {
    let points = [(2.0, 0.0), (2.0, 2.0), (-2.0, 2.5), (-2.0, 0.0)];
    CurveData {
        degree: 3,
        knots: vec![0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0],
        control_points: points.map(|(x, y)| DVec3::new(x, y, 2.5)).to_vec(),
        weights: None,
    }
}

fn definition(model: &Model, id: EntityId) -> perpend::Definition {
    model.entity(id).expect("known").definition().as_ref().clone()
}

#[test]
fn a_hand_edit_is_kept_when_what_it_was_made_of_changes() {
    let (mut model, [rim, pipe, waist, cone]) = chain();
    model.replace(waist, drawn()).expect("the cone can be rebuilt");
    let kept = definition(&model, waist);
    let replay = model.replay(waist).expect("its intent is kept");
    assert!(replay.is_overridden && replay.drift.proven > 0.1 && replay.drift.measured > 0.1);
    assert!(replay.drift.measured <= replay.drift.proven);
    assert_ne!(replay.definition, kept);
    assert_eq!(model.replay(cone).expect("made").drift.proven, 0.0, "the cone was rebuilt from the drawn waist");

    let impact = model.impact(rim).expect("known");
    let effects: Vec<_> = impact.iter().map(|one| (one.id, &one.effect)).collect();
    assert_eq!(effects, [(pipe, &Effect::Rebuilt), (waist, &Effect::Overridden), (cone, &Effect::Rebuilt)]);
    assert_eq!(model.edit(rim, circle(3.0)), Ok(vec![rim, pipe, cone]));
    assert_eq!(definition(&model, waist), kept);
    // it survives a file
    let read = Model::from_ron(&model.to_ron()).expect("valid");
    assert!(read.replay(waist).expect("made").is_overridden);
}

#[test]
fn an_edit_of_a_hand_edited_entity_is_refused_until_it_is_rebuilt() {
    let (mut model, [rim, _, waist, cone]) = chain();
    let made = definition(&model, waist);
    model.replace(waist, drawn()).expect("valid");
    let before = model.to_ron();
    let at = Operation::IsoCurve { direction: perpend::Direction::V, at: 0.25 };
    let error = model.edit(waist, at.clone()).expect_err("that would lose the drawing");
    assert_eq!(error, RebuildError::Overridden { id: waist });
    assert_eq!(model.to_ron(), before);
    assert_eq!(model.rebuild(waist), Ok(vec![waist, cone]));
    assert_eq!(definition(&model, waist), made);
    assert_eq!(model.edit(waist, at), Ok(vec![waist, cone]));
    assert_eq!(model.edit(rim, circle(1.0)).expect("valid").len(), 4);
}

#[test]
fn an_analytic_shape_in_place_of_what_was_made_is_its_own_making() {
    let (mut model, [_, pipe, waist, cone]) = chain();
    let line = perpend::Line::new(DVec3::new(0.0, 3.0, 1.0), DVec3::new(0.0, 4.0, 9.0)).expect("valid");
    model.replace(waist, line).expect("the cone can be rebuilt");
    let steps = &record(&model, waist).intent;
    assert_eq!(steps.len(), 2, "what it was made of before is history");
    assert_eq!(steps[1].operation, line.into());
    assert!(record(&model, waist).relationships.is_empty());
    assert!(!model.replay(waist).expect("made").is_overridden);
    assert_eq!(model.impact(pipe).expect("known"), []);
    let longer = perpend::Line::new(DVec3::new(0.0, 3.0, 1.0), DVec3::new(0.0, 5.0, 9.0)).expect("valid");
    assert_eq!(model.edit(waist, longer), Ok(vec![waist, cone]));
    model.replace(waist, line).expect("valid");
    model.replace(waist, perpend::Circle::whole(perpend::Frame::WORLD, 1.0).expect("valid")).expect("valid");
    assert_eq!(record(&model, waist).intent.len(), 2, "history does not grow with every replacement");
}

#[test]
fn data_in_place_of_data_is_no_hand_edit() {
    let mut model = Model::new();
    let id = model.insert("waist", drawn()).expect("valid");
    let mut stated = perpend::Record::default();
    let of = Some(definition(&model, id).fingerprint());
    stated.intent = vec![perpend::Intent { of, ..perpend::Intent::new(Operation::ByData, &[]) }];
    model.set_record(id, stated).expect("valid");
    let moved = CurveData { control_points: drawn().control_points.iter().map(|p| *p + DVec3::X).collect(), ..drawn() };
    model.replace(id, moved).expect("valid");
    let replay = model.replay(id).expect("data are their own replay");
    assert_eq!((replay.drift.proven, replay.is_overridden), (0.0, false));
    assert_eq!(model.edit(id, circle(1.0)), Err(RebuildError::NotMade { id }));
    assert!(matches!(model.rebuild(id), Err(RebuildError::Build { .. })), "there is nothing to make it of");
    assert_eq!(model.remake(id, circle(1.0), &[]), Ok(vec![id]));
    assert_eq!(model.edit(id, circle(2.0)), Ok(vec![id]));
}
