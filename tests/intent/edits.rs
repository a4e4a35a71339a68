//! Editing what others are made of: they are rebuilt in order, or nothing changes.

use perpend::{
    Circle, DVec3, EditError, Effect, EntityId, Frame, Line, Model, Operation, QueryOptions, RebuildError, Relation,
};

use super::{number, record};

/// A circle, the pipe that is extruded from it, an iso-curve of that, and a surface ruled between the iso-curve and the circle.
pub(crate) fn chain() -> (Model, [EntityId; 4]) {
    let mut model = Model::new();
    let rim = model.make("rim", circle(2.0), &[]).expect("valid");
    let pipe = model.make("pipe", Operation::Extrude { vector: DVec3::new(0.0, 0.0, 5.0) }, &[rim]).expect("valid");
    let at = Operation::IsoCurve { direction: perpend::Direction::V, at: 0.5 };
    let waist = model.make("waist", at, &[pipe]).expect("valid");
    let cone = model.make("cone", Operation::Rule, &[waist, rim]).expect("valid");
    (model, [rim, pipe, waist, cone])
}

fn circle(radius: f64) -> Operation {
    Operation::CircleByCentre { centre: DVec3::ZERO, axis: DVec3::Z, radius, xdir: Some(DVec3::X) }
}

fn distance(model: &Model, id: EntityId) -> f64 {
    model.project(id, DVec3::new(10.0, 0.0, 2.5)).expect("a valid query").distance
}

#[test]
fn editing_a_radius_rebuilds_all_that_is_made_of_the_circle_in_order() {
    let (mut model, [rim, pipe, waist, cone]) = chain();
    assert!((distance(&model, waist) - 8.0).abs() < 1e-12);
    let nearest = |model: &Model| model.nearest(DVec3::new(10.0, 0.0, 2.5), &QueryOptions::default());
    let before = nearest(&model).expect("valid").expect("there").1.distance;
    assert_eq!(model.edit(rim, circle(3.0)), Ok(vec![rim, pipe, waist, cone]));
    for id in [rim, pipe, waist, cone] {
        assert_eq!(model.entity(id).expect("known").revision(), 1);
        assert_eq!(model.entity(id).expect("known").stale(), Vec::<String>::new());
        assert_eq!(model.replay(id).expect("made").drift.proven, 0.0);
        // prepared anew: the answer is that of the new shape, certified
        let foot = model.project(id, DVec3::new(10.0, 0.0, 2.5)).expect("a valid query");
        let expected = if id == rim { 7.0_f64.hypot(2.5) } else { 7.0 };
        assert!((foot.distance - expected).abs() < 1e-12 && foot.gap() < 1e-7, "{id}: {foot:?}");
    }
    let after = nearest(&model).expect("valid").expect("there").1.distance;
    assert!((before - 8.0).abs() < 1e-12 && (after - 7.0).abs() < 1e-12, "the overview is made anew");
    let (fresh, _) = chain();
    let mut fresh = fresh;
    fresh.edit(rim, circle(3.0)).expect("valid");
    assert_eq!(fresh, model, "an edit gives the same bytes each time");
}

#[test]
fn an_edit_gives_what_making_it_so_at_once_gives() {
    let (mut model, ids) = chain();
    model.edit(ids[0], circle(3.0)).expect("valid");
    let mut at_once = Model::new();
    let rim = at_once.make("rim", circle(3.0), &[]).expect("valid");
    let pipe = at_once.make("pipe", Operation::Extrude { vector: DVec3::new(0.0, 0.0, 5.0) }, &[rim]).expect("valid");
    let at = Operation::IsoCurve { direction: perpend::Direction::V, at: 0.5 };
    let waist = at_once.make("waist", at, &[pipe]).expect("valid");
    at_once.make("cone", Operation::Rule, &[waist, rim]).expect("valid");
    for (one, other) in model.entities().iter().zip(at_once.entities()) {
        assert_eq!(one.definition(), other.definition());
        let (one, other) = (one.record().expect("a record"), other.record().expect("a record"));
        assert_eq!((&one.intent, &one.relationships), (&other.intent, &other.relationships));
        assert_eq!(one.classification, other.classification);
    }
}

#[test]
fn replacing_the_profile_rebuilds_what_is_made_of_it() {
    let mut model = Model::new();
    let profile = Line::new(DVec3::new(1.0, 0.0, 0.0), DVec3::new(2.0, 0.0, 3.0)).expect("valid");
    let profile = model.insert("profile", profile).expect("valid");
    let turned = Operation::Revolve { origin: DVec3::ZERO, axis: DVec3::Z, angle: std::f64::consts::TAU };
    let funnel = model.make("funnel", turned, &[profile]).expect("valid");
    let far = DVec3::new(9.0, 0.0, 0.0);
    assert!(model.project(funnel, far).expect("valid").distance > 7.0);
    let line = Line::new(DVec3::new(4.0, 0.0, 0.0), DVec3::new(4.0, 0.0, 3.0)).expect("valid");
    model.replace(profile, line).expect("the funnel can be rebuilt");
    assert!((model.project(funnel, far).expect("valid").distance - 5.0).abs() < 1e-12);
    assert_eq!(model.replay(funnel).expect("made").drift.proven, 0.0);
    assert_eq!(
        (model.entity(profile).expect("known").revision(), model.entity(funnel).expect("known").revision()),
        (1, 1)
    );
    // data of an application, which is no operation, rebuild it just as well
    let data = perpend::CurveData {
        degree: 1,
        knots: vec![0.0, 0.0, 1.0, 1.0],
        control_points: vec![DVec3::new(6.0, 0.0, 0.0), DVec3::new(6.0, 0.0, 3.0)],
        weights: None,
    };
    model.replace(profile, data).expect("the funnel can be rebuilt");
    assert!((model.project(funnel, far).expect("valid").distance - 3.0).abs() < 1e-12);
}

#[test]
fn a_failed_rebuild_leaves_the_model_as_it_was_byte_for_byte() {
    let (mut model, [rim, pipe, waist, cone]) = chain();
    let columns = (2.0 * DVec3::X, 2.0 * DVec3::Y, 2.0 * DVec3::Z);
    let lid = Operation::Transform { columns, translation: DVec3::ZERO };
    let lid = model.make("lid", lid, &[rim]).expect("valid");
    model.rename(waist, "the waist").expect("known");
    let text = model.to_ron();
    let probe = DVec3::new(3.0, 1.0, 2.0);
    let answers = |model: &Model| {
        let one: Vec<_> =
            model.entities().iter().map(|entity| model.project(entity.id(), probe).expect("valid")).collect();
        (one, model.nearest(probe, &QueryOptions::default()).expect("valid"))
    };
    let answered = answers(&model);
    let prepared: Vec<_> = model.entities().iter().map(|entity| std::sync::Arc::clone(entity.prepared())).collect();

    // the edited entity itself
    let error = model.edit(rim, circle(-1.0)).expect_err("no circle");
    assert_eq!(error.to_string(), "entity 1: CircleByCentre: radius is -1; it must be positive and finite");
    // one that is made of it: at this height the parameter of the iso-curve is outside
    let error =
        model.edit(waist, Operation::IsoCurve { direction: perpend::Direction::V, at: 1.5 }).expect_err("outside");
    assert!(error.to_string().starts_with("entity 3: IsoCurve: the v parameter is 1.5"), "{error}");
    // the last of the chain: coordinates of the lid leave their range after the pipe and the rest were rebuilt
    let far =
        Operation::CircleByCentre { centre: DVec3::new(9e69, 0.0, 0.0), axis: DVec3::Z, radius: 1e68, xdir: None };
    let error = model.edit(rim, far).expect_err("too far");
    assert!(matches!(error, RebuildError::Build { id, .. } if id == lid), "{error}");
    // a surface in place of the curve that others are made of
    let plane = perpend::Plane::new(Frame::WORLD, (0.0, 1.0), (0.0, 1.0)).expect("valid");
    let error = model.replace(rim, plane).expect_err("no profile");
    assert_eq!(
        error.to_string(),
        "entity 2, which is made of entity 1, cannot be rebuilt: Extrude: input 0 is a surface, and a curve is needed: name another entity"
    );
    // unknown ones
    assert_eq!(model.edit(number(77), circle(1.0)), Err(RebuildError::UnknownEntity { id: number(77) }));
    assert_eq!(
        model.remake(cone, Operation::Rule, &[rim, number(77)]),
        Err(RebuildError::UnknownInput { id: cone, input: number(77) })
    );
    assert!(model.make("no", Operation::Rule, &[pipe, rim]).is_err());

    assert_eq!(model.to_ron(), text);
    assert_eq!(answers(&model), answered);
    for (entity, before) in model.entities().iter().zip(&prepared) {
        assert!(std::sync::Arc::ptr_eq(entity.prepared(), before), "what was prepared is kept");
    }
    assert_eq!(model.next_id().get(), lid.get() + 1, "no id is spent");
}

#[test]
fn impact_lists_what_an_edit_touches_in_order_and_why() {
    let (mut model, [rim, pipe, waist, cone]) = chain();
    let note = perpend::Relationship { kind: Relation::Boundary, target: rim, parameters: [].into(), checked: None };
    let other = model.insert("seal", Circle::whole(Frame::WORLD, 1.0).expect("valid")).expect("valid");
    let mut refers = record(&model, other).clone();
    refers.relationships.push(note);
    model.set_record(other, refers).expect("valid");
    let before = model.to_ron();
    let impact = model.impact(rim).expect("known");
    let listed: Vec<_> = impact.iter().map(|one| (one.id, one.because.clone(), one.effect.clone())).collect();
    assert_eq!(
        listed,
        [
            (pipe, vec![(Relation::Profile, rim)], Effect::Rebuilt),
            (waist, vec![(Relation::IsoCurveOf, pipe)], Effect::Rebuilt),
            (cone, vec![(Relation::Rail, waist), (Relation::Rail, rim)], Effect::Rebuilt),
            (other, vec![(Relation::Boundary, rim)], Effect::Refers),
        ]
    );
    assert_eq!(model.to_ron(), before);
    // what was listed is what an edit touches
    let changed = model.edit(rim, circle(1.5)).expect("valid");
    assert_eq!(changed, [rim, pipe, waist, cone]);
    assert_eq!(model.impact(cone).expect("known"), []);
    assert!(matches!(model.impact(number(50)), Err(EditError::UnknownEntity { .. })));
}

#[test]
fn remaking_changes_operation_and_inputs() {
    let (mut model, [rim, pipe, waist, cone]) = chain();
    let turned = Operation::Revolve { origin: DVec3::new(9.0, 0.0, 0.0), axis: DVec3::Y, angle: 2.0 };
    assert_eq!(model.remake(pipe, turned.clone(), &[rim]), Ok(vec![pipe, waist, cone]));
    assert_eq!(record(&model, pipe).intent[0].operation, turned);
    assert_eq!(record(&model, pipe).relationships.len(), 1);
    assert_eq!(model.replay(cone).expect("made").drift.proven, 0.0);
    // an operation of no inputs: then it depends on nothing any more
    assert_eq!(model.remake(waist, circle(7.0), &[]), Ok(vec![waist, cone]));
    assert!(record(&model, waist).relationships.is_empty());
    assert!(model.impact(pipe).expect("known").is_empty());
    assert_eq!(Model::from_ron(&model.to_ron()).expect("valid"), model);
}

#[test]
fn an_edit_that_changes_nothing_rebuilds_nothing_else() {
    let (mut model, [rim, ..]) = chain();
    assert_eq!(model.edit(rim, circle(2.0)), Ok(vec![rim]));
    assert_eq!(model.entities().iter().map(|entity| entity.revision()).collect::<Vec<_>>(), [1, 0, 0, 0]);
}

#[test]
fn what_others_are_made_of_cannot_be_removed() {
    let (mut model, [rim, pipe, ..]) = chain();
    let error = model.remove(rim).expect_err("in use").to_string();
    assert!(error.starts_with("entity 1 is in use: knowledge.classification.origin.from[0] of entity 2"), "{error}");
    assert!(matches!(model.remove(pipe), Err(EditError::InUse { .. })));
}

#[test]
fn a_long_chain_is_rebuilt_without_deep_recursion() {
    let mut model = Model::new();
    let mut last = model.make("rim", circle(1.0), &[]).expect("valid");
    let columns = (DVec3::X, DVec3::Y, DVec3::Z);
    for _ in 0..3_000 {
        let moved = Operation::Transform { columns, translation: DVec3::new(0.0, 0.0, 0.25) };
        last = model.make("copy", moved, &[last]).expect("valid");
    }
    assert_eq!(model.edit(number(1), circle(2.0)).expect("valid").len(), 3_001);
    let foot = model.project(last, DVec3::new(0.0, 0.0, 750.0)).expect("a valid query");
    assert!((foot.distance - 2.0).abs() < 1e-12);
    assert_eq!(Model::from_ron(&model.to_ron()).expect("valid"), model);
}
