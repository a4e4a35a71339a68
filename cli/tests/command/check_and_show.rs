//! `check` and `show`.

use serde_json::{Value, json};

use crate::workshop::Workshop;

/// A curve whose knots are not clamped, and one with knowledge of another definition.
const KNOWING: &str = "\
Model(
    format: 1,
    units: Metre,
    entities: [
        (id: 3, name: \"open \\\"end\\\"\", definition: NurbsCurve(
            degree: 2, knots: [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0],
            control_points: [(0.0, 0.0, 0.0), (1.0, 1.0, 0.0), (2.0, 0.0, 0.0), (3.0, 1.0, 0.0)],
        )),
        (id: 4, name: \"\", definition: NurbsSurface(
            degree: (1, 2), knots: ([0.0, 0.0, 1.0, 1.0], [0.0, 0.0, 0.0, 1.0, 1.0, 1.0]),
            control_points: [
                [(0.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 2.0, 1.0)],
                [(1.0, 0.0, 0.0), (1.0, 1.0, 0.0), (1.0, 2.0, 1.0)],
            ],
            weights: Some([[1.0, 0.5, 1.0], [1.0, 0.5, 1.0]]),
        ), knowledge: Some((
            revision: 6,
            classification: Some((
                kind: (value: FreeForm, basis: Declared, tolerance: 0.0, of: \"fnv1a64:0123456789abcdef\"),
                destination: [\"inspection\"],
            )),
        ))),
    ],
)
";

fn knowing() -> Workshop {
    let workshop = Workshop::new();
    workshop.write("model.ron", KNOWING);
    workshop
}

#[test]
fn check_says_what_each_entity_is_and_what_was_done_to_it() {
    let run = knowing().run(&["check", "model.ron"]);
    run.ends(0, "");
    assert_eq!(
        run.out,
        "     3  \"open \\\"end\\\"\": curve of degree 2, 4 control points
        knots in u came unclamped and were clamped, which leaves the shape as it is
     4  \"\": rational surface of degree (1, 2), 2 x 3 control points
        stale knowledge, computed from another definition: classification.kind
model.ron: valid; 1 curve, 1 surface; size 3.3541 m; stale knowledge in 1 entity
"
    );
}

#[test]
fn check_accepts_a_model_without_entities() {
    let workshop = Workshop::new();
    workshop.write("model.ron", "Model(format: 1, entities: [])");
    let run = workshop.run(&["check", "model.ron"]);
    run.ends(0, "");
    assert_eq!(run.out, "model.ron: valid; 0 curves, 0 surfaces; size 0.0 mm\n");
}

#[test]
fn show_lists_the_entities() {
    let run = knowing().run(&["show", "model.ron"]);
    run.ends(0, "");
    assert_eq!(
        run.out,
        "\
id  name            kind          degree  points  weights   size/m   knowledge
3   \"open \\\"end\\\"\"  NurbsCurve    2       4       all 1     2.23607  revision 0, representation
4   \"\"              NurbsSurface  (1, 2)  2 x 3   rational  2.44949  revision 6, classification, stale
"
    );
}

#[test]
fn show_gives_one_entity_in_full() {
    let run = knowing().run(&["show", "model.ron", "--entity", "4"]);
    run.ends(0, "");
    for text in [
        "domain      [0.0, 1.0] x [0.0, 1.0]\n",
        "box         (0.0, 0.0, 0.0) to (1.0, 2.0, 1.0) m\n",
        "stale       classification.kind\n",
        "revision: 6",
        "\"inspection\"",
    ] {
        assert!(run.out.contains(text), "{text} in {}", run.out);
    }
    knowing()
        .run(&["show", "model.ron", "--entity", "5"])
        .ends(1, "error: model.ron: no entity has the id 5; its ids are 3, 4");
}

#[test]
fn show_gives_json_to_programs() {
    let workshop = knowing();
    let run = workshop.run(&["show", "model.ron", "--json"]);
    run.ends(0, "");
    let shown: Value = serde_json::from_str(&run.out).unwrap();
    let mut model = perpend::Model::read(workshop.path("model.ron")).unwrap();
    assert_eq!(model.learn_all(), 2);
    let record = |at: usize| serde_json::to_value(model.entities()[at].record()).unwrap();
    let expected = json!({"entities": [
        {
            "id": 3, "name": "open \"end\"", "definition": {"kind": "NurbsCurve", "degree": 2, "points": 4},
            "knowledge": record(0),
        },
        {
            "id": 4, "name": "", "definition": {"kind": "NurbsSurface", "degree": [1, 2], "points": [2, 3]},
            "knowledge": record(1),
        },
    ]});
    assert_eq!(shown, expected);
    assert_eq!(shown["entities"][1]["knowledge"]["classification"]["destination"], json!(["inspection"]));
    let one = workshop.run(&["show", "model.ron", "--entity", "4", "--json"]);
    let one: Value = serde_json::from_str(&one.out).unwrap();
    assert_eq!(one, json!({"entities": [expected["entities"][1]]}));
}

#[test]
fn show_acquires_what_is_not_known_in_memory() {
    let workshop = Workshop::new();
    let before = workshop.read("model.ron");
    let run = workshop.run(&["show", "model.ron", "--json"]);
    run.ends(0, "");
    assert_eq!(workshop.read("model.ron"), before);
    let shown: Value = serde_json::from_str(&run.out).unwrap();
    assert_eq!(shown["entities"].as_array().unwrap().len(), 3);
    let part = |at: usize| &shown["entities"][at]["knowledge"]["representation"];
    assert!((part(0)["length"]["value"].as_f64().unwrap() - 4.0).abs() < 1e-12);
    assert!((part(1)["area"]["value"].as_f64().unwrap() - 16.0).abs() < 1e-12);
    assert_eq!(part(0)["speed"][0]["value"]["category"]["name"], json!("nearly uniform"));
    assert_eq!(part(2)["closed"]["value"], json!([true, false]));
    let run = workshop.run(&["show", "model.ron", "--json", "--entity", "99"]);
    run.ends(1, "error: model.ron: no entity has the id 99; its ids are 1, 2, 7");
}
