//! `replay` and `impact`.

use serde_json::{Value, json};

use crate::workshop::Workshop;

/// A rim, the pipe extruded from it, a pipe that somebody drew higher, and a seal that refers to the rim.
fn model() -> Workshop {
    use perpend::{DVec3, EntityId, Frame, Model, Operation, Relation, Relationship};
    let mut model = Model::new();
    let rim = perpend::Circle::whole(Frame::WORLD, 2.0).unwrap();
    let rim = model.make("rim", rim, &[]).unwrap();
    let up = |height| Operation::Extrude { vector: DVec3::new(0.0, 0.0, height) };
    let pipe = model.make("pipe", up(5.0), &[rim]).unwrap();
    let drawn = model.make("drawn", up(5.0), &[rim]).unwrap();
    let higher = model.make("higher", up(6.0), &[rim]).unwrap();
    let definition = model.entity(higher).unwrap().definition().as_ref().clone();
    model.replace(drawn, definition).unwrap();
    model.remove(higher).unwrap();
    let seal = model.insert("seal", perpend::Plane::new(Frame::WORLD, (0.0, 1.0), (0.0, 1.0)).unwrap()).unwrap();
    let mut record = model.entity(seal).unwrap().record().unwrap().clone();
    let note = Relationship { kind: Relation::Boundary, target: rim, parameters: [].into(), checked: None };
    record.relationships.push(note);
    model.set_record(seal, record).unwrap();
    assert_eq!([rim, pipe, drawn, seal].map(EntityId::get), [1, 2, 3, 5]);
    let workshop = Workshop::new();
    workshop.write("model.ron", model.to_ron());
    workshop
}

#[test]
fn replay_says_how_far_an_entity_is_from_what_its_steps_give() {
    let workshop = model();
    let run = workshop.run(&["replay", "model.ron", "--entity", "2"]);
    run.ends(0, "");
    assert_eq!(
        run.out,
        "entity 2 \"pipe\"
made by   Extrude of 1 \"rim\"
gives     rational surface of degree (2, 1), 9 x 2 control points
drift     none: the same bits
"
    );
    let run = workshop.run(&["replay", "model.ron", "--entity", "3"]);
    run.ends(0, "");
    assert_eq!(
        run.out,
        "entity 3 \"drawn\"
made by   Extrude of 1 \"rim\"
gives     rational surface of degree (2, 1), 9 x 2 control points
drift     proven at most 1.0 mm, measured 1.0 mm
the entity was replaced by hand after it was made; an edit of what it is made of leaves it as it is
"
    );
}

#[test]
fn replay_writes_json() {
    let workshop = model();
    let run = workshop.run(&["replay", "model.ron", "--entity", "3", "--json"]);
    run.ends(0, "");
    let replay: Value = serde_json::from_str(&run.out).unwrap();
    assert_eq!(replay["id"], 3);
    assert_eq!(replay["name"], "drawn");
    assert_eq!(replay["overridden"], true);
    assert_eq!(replay["steps"][0]["operation"], json!({"Extrude": {"vector": [0.0, 0.0, 5.0]}}));
    assert_eq!(replay["steps"][0]["inputs"], json!([1]));
    let (proven, measured) =
        (replay["drift"]["proven"].as_f64().unwrap(), replay["drift"]["measured"].as_f64().unwrap());
    assert!((1.0..1.0 + 1e-12).contains(&proven) && measured <= proven && measured > 1.0 - 1e-12, "{replay}");
    assert_eq!(replay["drift"]["differs"], json!([]));
}

#[test]
fn impact_lists_what_an_edit_would_touch() {
    let workshop = model();
    let before = workshop.read("model.ron");
    let run = workshop.run(&["impact", "model.ron", "--entity", "1"]);
    run.ends(0, "");
    assert_eq!(
        run.out,
        "an edit of 1 \"rim\" touches 3 other entities
2 \"pipe\": rebuilt
    profile: 1 \"rim\"
3 \"drawn\": kept, since it was replaced by hand after it was made; it may no longer fit
    profile: 1 \"rim\"
5 \"seal\": kept; it only refers to what changes, and what it states may no longer hold
    boundary: 1 \"rim\"
"
    );
    let run = workshop.run(&["impact", "model.ron", "--entity", "5"]);
    run.ends(0, "");
    assert_eq!(run.out, "an edit of 5 \"seal\" touches nothing else\n");
    let run = workshop.run(&["impact", "model.ron", "--entity", "1", "--json"]);
    run.ends(0, "");
    let impact: Value = serde_json::from_str(&run.out).unwrap();
    let because = |relation: &str| json!([{"relation": relation, "target": 1}]);
    assert_eq!(
        impact,
        json!({"id": 1, "touches": [
            {"id": 2, "name": "pipe", "effect": "rebuilt", "because": because("profile")},
            {"id": 3, "name": "drawn", "effect": "overridden", "because": because("profile")},
            {"id": 5, "name": "seal", "effect": "refers", "because": because("boundary")},
        ]})
    );
    assert_eq!(workshop.read("model.ron"), before);
}

#[test]
fn what_cannot_be_replayed_says_why() {
    let workshop = model();
    workshop.write("data.ron", crate::workshop::MODEL);
    workshop.run(&["replay", "data.ron", "--entity", "2"]).ends(
        1,
        "error: data.ron: entity 2: its record does not say how it was made; state its intent, or remake it by an operation\n",
    );
    for command in ["replay", "impact"] {
        workshop
            .run(&[command, "model.ron", "--entity", "9"])
            .ends(1, "error: model.ron: no entity has the id 9; its ids are 1, 2, 3, 5\n");
        assert_eq!(workshop.run(&[command, "model.ron"]).code, Some(2));
    }
}
