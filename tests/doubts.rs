//! What a record states of an entity's making and does not hold is found and named.

use perpend::knowledge::{Value, believed_tolerance};
use perpend::{CurveData, DVec3, Kind, Model, Operation, Relation};

fn bow() -> CurveData {
    CurveData {
        degree: 2,
        knots: vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0],
        control_points: vec![DVec3::new(1.0, 0.0, 0.0), DVec3::new(2.0, 0.0, 2.0), DVec3::new(1.0, 0.0, 4.0)],
        weights: None,
    }
}

fn turned(model: &mut Model) -> perpend::EntityId {
    let profile = model.insert("bow", bow()).expect("valid");
    let turn = Operation::Revolve { origin: DVec3::ZERO, axis: DVec3::Z, angle: 4.0 };
    model.make("bell", turn, &[profile]).expect("it can be turned")
}

#[test]
fn a_true_record_is_not_doubted() {
    let mut model = Model::new();
    let bell = turned(&mut model);
    assert_eq!(model.doubts(bell), []);
    model.learn_all();
    assert!(model.entities().iter().all(|entity| model.doubts(entity.id()).is_empty()));
}

#[test]
fn a_false_step_and_a_false_edge_are_named_with_their_deviation() {
    let mut model = Model::new();
    let bell = turned(&mut model);
    let record = model.entity(bell).and_then(|entity| entity.record()).expect("made").clone();

    let mut lying = record.clone();
    lying.intent.last_mut().expect("a step").operation =
        Operation::Revolve { origin: DVec3::ZERO, axis: DVec3::Z, angle: 1.0 };
    model.set_record(bell, lying).expect("finite");
    let doubts = model.doubts(bell);
    assert_eq!(doubts.iter().map(|doubt| doubt.part).collect::<Vec<_>>(), ["intent"]);
    assert!(doubts[0].drift.measured > 1.0 && doubts[0].drift.proven >= doubts[0].drift.measured, "{doubts:?}");

    let mut lying = record.clone();
    let edge = lying.relationships.iter_mut().find(|edge| edge.kind == Relation::Profile).expect("an edge");
    edge.parameters.insert("angle".to_owned(), Value::Number(3.9));
    model.set_record(bell, lying).expect("finite");
    let doubts = model.doubts(bell);
    assert_eq!(doubts.iter().map(|doubt| doubt.part).collect::<Vec<_>>(), ["relationships"]);

    model.set_record(bell, record).expect("finite");
    model.replace(bell, bow()).expect("valid");
    assert!(!model.doubts(bell).is_empty(), "it was replaced by hand");
}

#[test]
fn a_tolerance_is_believed_up_to_a_hundredth_of_the_size() {
    let mut model = Model::new();
    let id = model.insert("bow", bow()).expect("valid");
    let definition = model.entity(id).expect("an entity").definition().clone();
    let size = definition.size();
    assert_eq!(believed_tolerance(1e300, &definition), 1e-2 * size);
    assert_eq!(believed_tolerance(1e-3, &definition), 1e-3);
    assert!(believed_tolerance(0.0, &definition) <= 2e-10 * size);
    let circle = Kind::Circle { centre: DVec3::ZERO, axis: DVec3::Y, xdir: DVec3::X, radius: 1.0, sweep: (0.0, 1.0) };
    let kind = perpend::Item {
        value: circle,
        basis: perpend::Basis::Declared,
        tolerance: 1e300,
        of: definition.fingerprint(),
    };
    let class = perpend::Classification { kind: Some(kind), ..Default::default() };
    model.set_record(id, perpend::Record { classification: Some(class), ..Default::default() }).expect("finite");
    let refused = Model::from_ron(&model.to_ron()).expect_err("a lie");
    assert!(refused.to_string().contains("classification.kind"), "{refused}");
}
