//! `explain`.

use serde_json::Value;

use crate::workshop::Workshop;

fn model() -> Workshop {
    let workshop = Workshop::new();
    workshop.write(
        "model.ron",
        r#"Model(format: 1, units: Inch, entities: [
            (id: 4, name: "bow", definition: NurbsCurve(
                degree: 2, knots: [0.0, 0.0, 0.0, 1.0, 1.0, 1.0],
                control_points: [(0.0, 0.0, 0.0), (1.0, 2.0, 0.0), (2.0, 0.0, 1.0)],
            ), knowledge: Some((
                classification: Some((kind: (value: FreeForm, basis: Declared, tolerance: 0.0, of: "fnv1a64:0123456789abcdef"))),
            ))),
        ])"#,
    );
    workshop
}

#[test]
fn the_method_and_its_reasons_are_told_in_words() {
    let run = model().run(&["explain", "model.ron", "--entity", "4"]);
    assert_eq!(run.code, Some(0), "{}", run.err);
    for part in [
        "entity 4 \"bow\"",
        "method        hierarchy",
        "gap           3e-9",
        " in, unless a query asks for another",
        "classification.kind (declared)",
        "not believed: it was computed from another definition",
        "no special shape was proved within",
        "representation",
    ] {
        assert!(run.out.contains(part), "{part:?} in {}", run.out);
    }
    assert_eq!(run.err, "");
}

#[test]
fn programs_get_json() {
    let run = model().run(&["explain", "model.ron", "--entity", "4", "--json"]);
    let said: Value = serde_json::from_str(&run.out).expect("JSON");
    assert_eq!((said["id"].as_u64(), said["method"].as_str()), (Some(4), Some("hierarchy")));
    assert!(said["settings"]["gap"].as_f64().is_some_and(|gap| gap > 0.0), "{said}");
    let reasons = said["reasons"].as_array().expect("a list");
    assert!(reasons.iter().all(|r| r["item"].is_string() && r["effect"].is_string() && !r["basis"].is_boolean()));
    assert_eq!(reasons[0]["basis"], "Declared");
}

#[test]
fn an_unknown_entity_is_named_and_a_missing_one_is_wrong_usage() {
    let unknown = model().run(&["explain", "model.ron", "--entity", "5"]);
    assert_eq!(unknown.code, Some(1));
    assert!(unknown.err.contains("no entity has the id 5; its ids are 4"), "{}", unknown.err);
    let missing = model().run(&["explain", "model.ron"]);
    assert_eq!(missing.code, Some(2));
    assert!(missing.err.contains("--entity <ID>"), "{}", missing.err);
}
