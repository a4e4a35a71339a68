//! Knowledge of a file that is false is found on loading, named, and refused or acquired again.

use perpend::kernel::glam::DVec3;
use perpend::{
    Basis, Circle, Cylinder, EntityError, EntityId, Frame, InvalidModel, Kind, Model, NurbsCurve, Sphere, Trust,
};

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

/// A learned model with a curve that has a crease, a closed one, and a surface with a pole, as text.
fn learned() -> String {
    let mut model = Model::new();
    let points = [[0.0, 0.0], [1.0, 2.0], [2.0, 0.0], [3.0, 2.0], [4.0, 0.0]].map(|[x, y]| DVec3::new(x, y, 0.0));
    let knots = vec![0.0, 0.0, 0.0, 0.5, 0.5, 1.0, 1.0, 1.0];
    model.insert("roof", NurbsCurve::new(2, knots, points.to_vec(), None).expect("valid")).expect("valid");
    model.insert("rim", Circle::whole(Frame::WORLD, 2.0).expect("valid")).expect("valid");
    let half = std::f64::consts::FRAC_PI_2;
    let ball = Sphere::new(Frame::WORLD, 1.0, (-half, half), (0.0, 2.0 * half)).expect("valid");
    model.insert("dome", ball).expect("valid");
    assert_eq!(model.learn_all(), 3);
    model.to_ron()
}

/// The text with a number in the record of entity `id` moved by `by`: the one after all the parts of `what`.
fn moved(text: &str, id: u64, what: &str, by: f64) -> String {
    let entity = text.find(&format!("id: {id},")).expect("the entity");
    let start = ["representation"]
        .into_iter()
        .chain(what.split(" > "))
        .fold(entity, |at, part| at + text[at..].find(part).unwrap_or_else(|| panic!("{part} of {id}")) + part.len());
    let end = start + text[start..].find([',', ')', ']']).expect("the end of a number");
    let old: f64 = text[start..end].parse().unwrap_or_else(|_| panic!("{what}: {}", &text[start..end]));
    format!("{}{:?}{}", &text[..start], old + by, &text[end..])
}

#[test]
fn what_was_learned_is_believed() {
    let text = learned();
    let model = Model::from_ron(&text).expect("nothing is false");
    assert_eq!(model.to_ron(), text);
    assert_eq!(Model::from_ron_with(&text, Trust::Repair).expect("nothing to repair").to_ron(), text);
}

#[test]
fn items_that_the_definition_contradicts_are_named_with_their_deviation() {
    let text = learned();
    for (id, what, by, field, deviation) in [
        (1, "max: ", -1.0, "representation.speed[0]", None),
        (1, "min: ", 2.5, "representation.speed[0]", None),
        (1, "factor: ", 0.25, "representation.speed[0]", Some(0.25)),
        (1, "breaks: > at: ", 0.125, "representation.breaks[0]", Some(0.125)),
        (1, "Crease(direction: U, at: ", 0.125, "representation.irregularities[0]", Some(0.125)),
        (1, "c: ", 1.0, "representation.breaks[0]", None),
        (1, "length: > value: ", 3.0, "representation.length", None),
        (1, "box: > min: (", 0.5, "representation.box", Some(0.5)),
        (1, "weights: > value: (", 0.25, "representation.weights", Some(0.25)),
        (2, "weights: > value: (", 0.25, "representation.weights", Some(0.25)),
        (3, "Pole(direction: U, at: ", 0.5, "representation.irregularities[0]", None),
    ] {
        let lie = if what == "c: " { text.replacen("c: 0, g: 0", "c: 1, g: 1", 1) } else { moved(&text, id, what, by) };
        assert_ne!(lie, text, "{what}");
        let error = Model::from_ron(&lie).expect_err(what);
        assert_eq!(error.entity, Some(EntityId::new(id)), "{what}: {error}");
        let InvalidModel::Entity(EntityError::FalseItem(found)) = &error.problem else { panic!("{what}: {error}") };
        assert_eq!(found.field, field, "{what}: {error}");
        assert!(error.to_string().contains("--repair"), "{error}");
        if let Some(deviation) = deviation {
            assert!((found.deviation - deviation).abs() < 1e-8, "{what}: {error}");
        }
        assert_eq!(Model::from_ron_with(&lie, Trust::Repair).expect("repaired").to_ron(), text, "{what}");
    }
}

#[test]
fn a_loop_or_a_seam_that_is_none_is_false() {
    let text = learned();
    let of = |id: u64| Model::from_ron(&text).expect("true").entities()[id as usize - 1].definition().fingerprint();
    for (id, stated, deviation) in [
        (1, "Loop(from: 0.0, to: 1.0, gap: 0.0)", 4.0),
        (1, "Seam(direction: U)", 4.0),
        (2, "Loop(from: 0.0, to: 0.5, gap: 0.0)", 4.0),
        (2, "Inflection(at: Curve(1.5))", 0.5),
        (2, "ZeroCurvature(from: -0.25, to: 0.5)", 0.25),
        (3, "VanishingNormal(at: Surface(0.5, 1.5), area: 0.0)", 0.5),
    ] {
        let entity = text.find(&format!("id: {id},")).expect("the entity");
        let start = entity + text[entity..].find("irregularities: [").expect("the list") + "irregularities: [".len();
        let item = format!("(value: {stated}, basis: Declared, tolerance: 0.0, of: \"{}\"), ", of(id));
        let lie = format!("{}{item}{}", &text[..start], &text[start..]);
        let error = Model::from_ron(&lie).expect_err(stated);
        let InvalidModel::Entity(EntityError::FalseItem(found)) = &error.problem else { panic!("{stated}: {error}") };
        assert_eq!(found.field, "representation.irregularities[0]", "{error}");
        assert!((found.deviation - deviation).abs() < 1e-8, "{stated}: {error}");
        assert_eq!(Model::from_ron_with(&lie, Trust::Repair).expect("repaired").to_ron(), text, "{stated}");
    }
}

#[test]
fn repair_acquires_stale_items_again_and_keeps_what_was_declared() {
    let text = learned();
    let of = Model::from_ron(&text).expect("true").entities()[1].definition().fingerprint().to_string();
    let stale = text.replace(&of, "fnv1a64:0123456789abcdef");
    let model = Model::from_ron(&stale).expect("stale is not false");
    assert!(!model.entities()[1].stale().is_empty());
    let model = Model::from_ron_with(&stale, Trust::Repair).expect("repaired");
    assert_eq!(model.entities()[1].stale(), [""; 0]);
    let part = |model: &Model| model.entities()[1].record().and_then(|record| record.representation.clone());
    assert_eq!(part(&model), part(&Model::from_ron(&text).expect("true")));
    let declared = "(value: NearKnots(direction: U, at: 0.25, apart: 0.5), basis: Declared, tolerance: 0.0, of: ";
    let entity = stale.find("id: 2,").expect("the entity");
    let start = entity + stale[entity..].find("irregularities: [").expect("the list") + "irregularities: [".len();
    let stated = format!("{}{declared}\"{of}\"), {}", &stale[..start], &stale[start..]);
    let model = Model::from_ron_with(&stated, Trust::Repair).expect("repaired");
    assert_eq!(
        part(&model)
            .expect("known")
            .irregularities
            .iter()
            .flatten()
            .filter(|item| item.basis == Basis::Declared)
            .count(),
        1
    );
}
