//! Knowledge of a file that is false is found on loading, named, and refused or acquired again.

use perpend::kernel::glam::DVec3;
use perpend::{Basis, Circle, Cylinder, EntityId, Frame, Kind, Model, Trust};

fn kind(model: &Model) -> &Kind {
    let record = model.entities()[0].record().expect("a record");
    &record.classification.as_ref().expect("a class").kind.as_ref().expect("a kind").value
}

fn model() -> Model {
    let mut model = Model::new();
    let pipe = Cylinder::new(Frame::WORLD, 1.5, (0.0, 4.0), (0.0, 2.0)).expect("valid");
    model.insert("pipe", pipe).expect("valid");
    model
}

#[test]
fn a_true_record_loads() {
    let text = model().to_ron();
    assert_eq!(Model::from_ron(&text).expect("true").to_ron(), text);
}

#[test]
fn a_record_that_lies_is_refused_with_the_measured_deviation() {
    let text = model().to_ron();
    let lie = text.replacen("radius: 1.5", "radius: 1.625", 1);
    assert_ne!(text, lie);
    let error = Model::from_ron(&lie).expect_err("the radius is another");
    assert_eq!(error.entity, Some(EntityId::new(1)));
    let message = error.to_string();
    assert!(message.contains("knowledge: classification.kind"), "{message}");
    assert!(message.contains("is 1.250e-1 from it"), "{message}");
}

#[test]
fn a_class_of_the_other_kind_of_definitions_is_refused() {
    let mut model = Model::new();
    model.insert("rim", Circle::whole(Frame::WORLD, 2.0).expect("valid")).expect("valid");
    let text = model.to_ron();
    let start = text.find("Circle(").expect("the class");
    let end = start + text[start..].find(')').expect("the end of its centre");
    let end = end + 1 + text[end + 1..].find("basis").expect("what follows");
    let lie = format!("{}Ruled(ruling: U), {}", &text[..start], &text[end..]);
    let message = Model::from_ron(&lie).expect_err("a curve is not ruled").to_string();
    assert!(message.contains("a Ruled is stated of a"), "{message}");
}

#[test]
fn repair_acquires_a_false_class_again() {
    let lie = model().to_ron().replacen("radius: 1.5", "radius: 1.625", 1);
    let repaired = Model::from_ron_with(&lie, Trust::Repair).expect("repaired");
    let Kind::Cylinder { centre, axis, radius, .. } = *kind(&repaired) else { panic!("{:?}", kind(&repaired)) };
    assert!((radius - 1.5).abs() < 1e-14 && axis.cross(DVec3::Z).length() < 1e-14, "{radius} {axis}");
    assert!(centre.truncate().length() < 1e-14, "{centre}");
    let record = repaired.entities()[0].record().expect("a record");
    let item = record.classification.as_ref().and_then(|c| c.kind.clone()).expect("a kind");
    assert!(matches!(item.basis, Basis::Proved { gap } if gap < 1e-12), "{:?}", item.basis);
    // and is true from then on
    assert_eq!(Model::from_ron(&repaired.to_ron()).expect("true"), repaired);
}
