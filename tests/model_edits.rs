//! Edits of a model, as properties: any sequence of them does to a model what it does to a plain list.

#[path = "files/random.rs"]
#[expect(dead_code, reason = "a part of it is used here")]
mod random;

use perpend::{
    CurveData, DVec3, Definition, EditError, EntityId, Model, QueryError, QueryOptions, Record, Relation, Relationship,
};
use proptest::prelude::*;

fn segment(from: DVec3, to: DVec3) -> CurveData {
    CurveData { degree: 1, knots: vec![0.0, 0.0, 1.0, 1.0], control_points: vec![from, to], weights: None }
}

fn broken() -> CurveData {
    CurveData { weights: Some(vec![1.0, -1.0]), ..segment(DVec3::ZERO, DVec3::X) }
}

#[derive(Debug, Clone)]
enum Edit {
    Insert(String, Definition),
    InsertBroken,
    Replace(u64, Definition),
    ReplaceBroken(u64),
    Rename(u64, String),
    Remove(u64),
    Relate(u64, u64),
}

fn edit() -> impl Strategy<Value = Edit> {
    let id = || 0..12_u64;
    prop_oneof![
        4 => (random::text(), random::definition()).prop_map(|(name, definition)| Edit::Insert(name, definition)),
        1 => Just(Edit::InsertBroken),
        2 => (id(), random::definition()).prop_map(|(id, definition)| Edit::Replace(id, definition)),
        1 => id().prop_map(Edit::ReplaceBroken),
        2 => (id(), random::text()).prop_map(|(id, name)| Edit::Rename(id, name)),
        3 => id().prop_map(Edit::Remove),
        2 => (id(), id()).prop_map(|(id, target)| Edit::Relate(id, target)),
    ]
}

/// What a model should hold, in a plain list.
#[derive(Debug, Clone, PartialEq)]
struct Row {
    id: u64,
    name: String,
    definition: Definition,
    revision: u64,
    target: Option<u64>,
}

fn rows(model: &Model) -> Vec<Row> {
    let rows = model.entities().iter().map(|entity| Row {
        id: entity.id().get(),
        name: entity.name().to_owned(),
        definition: entity.definition().as_ref().clone(),
        revision: entity.revision(),
        target: entity.record().and_then(|record| record.relationships.first()).map(|one| one.target.get()),
    });
    rows.collect()
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_model_does_what_a_plain_list_does(edits in prop::collection::vec(edit(), 1..24)) {
        let mut model = Model::new();
        let mut list: Vec<Row> = Vec::new();
        let mut next = 1;
        for edit in edits {
            let before = model.clone();
            let place = |list: &[Row], id: u64| list.iter().position(|row| row.id == id);
            let done = match edit {
                Edit::Insert(name, definition) => {
                    let id = model.insert(&name, definition.clone()).expect("valid").get();
                    prop_assert_eq!(id, next, "ids are never reused");
                    next += 1;
                    list.push(Row { id, name, definition, revision: 0, target: None });
                    true
                }
                Edit::InsertBroken => {
                    prop_assert!(model.insert("", broken()).is_err());
                    false
                }
                Edit::Replace(id, definition) => {
                    let result = model.replace(EntityId::new(id), definition.clone());
                    prop_assert_eq!(result.is_ok(), place(&list, id).is_some());
                    if let Some(at) = place(&list, id) {
                        list[at].definition = definition;
                        list[at].revision += 1;
                    }
                    result.is_ok()
                }
                Edit::ReplaceBroken(id) => {
                    prop_assert!(model.replace(EntityId::new(id), broken()).is_err());
                    false
                }
                Edit::Rename(id, name) => {
                    let result = model.rename(EntityId::new(id), &name);
                    prop_assert_eq!(result.is_ok(), place(&list, id).is_some());
                    if let Some(at) = place(&list, id) {
                        list[at].name = name;
                        list[at].revision += 1;
                    }
                    result.is_ok()
                }
                Edit::Remove(id) => {
                    let result = model.remove(EntityId::new(id));
                    let used = list.iter().any(|row| row.id != id && row.target == Some(id));
                    let at = place(&list, id).filter(|_| !used);
                    prop_assert_eq!(result.is_ok(), at.is_some());
                    if let Some(at) = at {
                        list.remove(at);
                    }
                    result.is_ok()
                }
                Edit::Relate(id, target) => {
                    let relationship = Relationship {
                        kind: Relation::PartOf,
                        target: EntityId::new(target),
                        parameters: [].into(),
                        checked: None,
                    };
                    let record = Record { relationships: vec![relationship], ..Record::default() };
                    let result = model.set_record(EntityId::new(id), record);
                    let at = place(&list, id).filter(|_| place(&list, target).is_some());
                    prop_assert_eq!(result.is_ok(), at.is_some());
                    if let Some(at) = at {
                        list[at].target = Some(target);
                    }
                    result.is_ok()
                }
            };
            if !done {
                prop_assert_eq!(&before, &model, "a failed edit leaves the model as it was");
            }
            prop_assert_eq!(&rows(&model), &list);
            prop_assert_eq!(model.next_id().get(), next);
            for id in 0..14 {
                let found = model.entity(EntityId::new(id)).map(|entity| entity.id().get());
                prop_assert_eq!(found, place(&list, id).map(|_| id));
            }
            for row in &list {
                let named: Vec<u64> = model.named(&row.name).map(|entity| entity.id().get()).collect();
                let expected: Vec<u64> = list.iter().filter(|other| other.name == row.name).map(|other| other.id).collect();
                prop_assert_eq!(named, expected);
            }
            // a model that edits leave behind can always be written and read
            prop_assert_eq!(&Model::from_ron(&model.to_ron()).expect("a valid file"), &model);
        }
    }
}

#[test]
fn queries_see_every_edit() {
    let mut model = Model::new();
    let p = DVec3::new(0.5, 3.0, 0.0);
    let near = |model: &Model| model.nearest(p, &QueryOptions::default()).expect("a valid query");
    assert_eq!(near(&model), None);
    let low = model.insert("low", segment(DVec3::ZERO, DVec3::X)).expect("valid");
    assert_eq!(near(&model).map(|(id, foot)| (id, foot.distance)), Some((low, 3.0)));
    let high = model.insert("high", segment(DVec3::new(0.0, 2.0, 0.0), DVec3::new(1.0, 2.0, 0.0))).expect("valid");
    assert_eq!(near(&model).map(|(id, foot)| (id, foot.distance)), Some((high, 1.0)));
    assert_eq!(model.project(low, p).expect("a valid query").distance, 3.0);
    model.replace(low, segment(DVec3::new(0.0, 2.5, 0.0), DVec3::new(1.0, 2.5, 0.0))).expect("valid");
    assert_eq!(near(&model).map(|(id, foot)| (id, foot.distance)), Some((low, 0.5)));
    assert_eq!(model.project(low, p).expect("a valid query").distance, 0.5);
    model.remove(low).expect("known");
    assert_eq!(near(&model).map(|(id, foot)| (id, foot.distance)), Some((high, 1.0)));
    assert_eq!(model.project(low, p), Err(QueryError::UnknownEntity { id: low }));
    assert_eq!(model.size(), 1.0);
}

#[test]
fn replacing_forgets_what_was_computed_from_the_old_definition_and_keeps_what_people_stated() {
    let text = include_str!("files/record.ron");
    let mut model = Model::from_ron(text).expect("valid");
    let id = EntityId::new(2);
    let before = model.entity(id).and_then(|entity| entity.record()).expect("a record").clone();
    assert!(before.representation.is_some() && !before.intent.is_empty());
    assert!(model.entity(id).expect("known").stale().contains(&"representation.speed[0]".to_owned()));
    model.replace(id, segment(DVec3::ZERO, DVec3::X)).expect("valid");
    let entity = model.entity(id).expect("known");
    let after = entity.record().expect("a record");
    assert_eq!(after.revision, before.revision + 1);
    assert_eq!(entity.stale(), Vec::<String>::new());
    assert_eq!(after.representation, None);
    let (old, new) = (before.classification.expect("known"), after.classification.clone().expect("known"));
    assert_eq!((new.kind, new.origin, new.destination), (None, old.origin, old.destination));
    assert_eq!((&after.intent, &after.relationships), (&before.intent, &before.relationships));
}

#[test]
fn unclamped_knots_are_clamped_and_the_record_says_so() {
    let mut model = Model::new();
    let unclamped = CurveData {
        degree: 2,
        knots: vec![0.0, 1.0, 2.0, 3.0, 4.0, 5.0],
        control_points: vec![DVec3::ZERO, DVec3::X, DVec3::ONE],
        weights: None,
    };
    let id = model.insert("arch", unclamped.clone()).expect("valid");
    let entity = model.entity(id).expect("known");
    let record = entity.record().expect("a note");
    let cleaning = record.representation.as_ref().and_then(|part| part.cleaning.as_ref()).expect("a note");
    assert_eq!(cleaning.len(), 1);
    assert_eq!(entity.stale(), Vec::<String>::new());
    // it is noted once: the file holds the clamped knots
    assert_eq!(Model::from_ron(&model.to_ron()).expect("valid"), model);
    model.replace(id, unclamped).expect("valid");
    let record = model.entity(id).and_then(|entity| entity.record()).expect("a note");
    assert_eq!(record.representation.as_ref().and_then(|part| part.cleaning.as_ref()).map(Vec::len), Some(1));
    assert_eq!(record.revision, 1);
}

#[test]
fn refused_edits_say_why() {
    let mut model = Model::new();
    let (a, b) = (EntityId::new(1), EntityId::new(2));
    model.insert("a", segment(DVec3::ZERO, DVec3::X)).expect("valid");
    model.insert("b", segment(DVec3::ZERO, DVec3::Y)).expect("valid");
    let to = |target| Relationship { kind: Relation::Axis, target, parameters: [].into(), checked: None };
    let record = |target| Record { relationships: vec![to(target)], ..Record::default() };
    model.set_record(b, record(a)).expect("valid");
    let message = |error: EditError| error.to_string();
    assert_eq!(message(model.rename(EntityId::new(9), "").expect_err("unknown")), "the model has no entity 9");
    assert_eq!(
        message(model.replace(a, broken()).expect_err("broken")),
        "entity 1: definition: weights[1] is -1; weights are positive and finite"
    );
    assert_eq!(
        message(model.set_record(a, record(EntityId::new(7))).expect_err("dangling")),
        "entity 1: knowledge: relationships[0].target is 7, which the model does not have: insert that entity first"
    );
    assert_eq!(
        message(model.remove(a).expect_err("in use")),
        "entity 1 is in use: knowledge.relationships[0].target of entity 2 refers to it; change that record or remove entity 2 first"
    );
    model.remove(b).expect("unused");
    model.remove(a).expect("unused");
    assert!(model.is_empty());
}
