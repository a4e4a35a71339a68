//! `stationary`.

use serde_json::Value;

use crate::workshop::Workshop;

#[test]
fn the_points_of_an_edge_are_listed_with_kind_and_place() {
    let run = Workshop::new().run(&["stationary", "model.ron", "--entity", "1", "--point", "1,2,0"]);
    run.ends(0, "");
    assert_eq!(
        run.out,
        "kind     place              u     v  distance/mm  certainty
maximum  end, falls inward  0.0   -  2.23607      one
minimum  interior           0.25  -  2.0          one
maximum  end, falls inward  1.0   -  3.60555      one
complete: everywhere else is proven to hold none
"
    );
}

#[test]
fn json_holds_all_that_is_known_of_every_point() {
    let run = Workshop::new().run(&["stationary", "model.ron", "--entity", "2", "--point", "1,-1,12", "--json"]);
    run.ends(0, "");
    let json: Value = serde_json::from_str(&run.out).unwrap();
    assert_eq!((&json["id"], &json["point"][1], &json["complete"]), (&2.into(), &(-1.0).into(), &true.into()));
    let points = json["stationary"].as_array().unwrap();
    let minimum = points.iter().find(|point| point["kind"] == "minimum").unwrap();
    assert_eq!((&minimum["place"], &minimum["certainty"]), (&"edge".into(), &"one".into()));
    assert_eq!((&minimum["u"], &minimum["v"], &minimum["descends_inward"]), (&0.25.into(), &0.0.into(), &false.into()));
    assert!((minimum["distance"].as_f64().unwrap() - 5.0_f64.sqrt()).abs() < 1e-15);
    // four corners, and on two of the edges a foot
    assert_eq!(points.len(), 6, "{}", run.out);
    assert_eq!(json["continua"], Value::Array(Vec::new()));
}

#[test]
fn a_continuum_is_told_with_its_extent() {
    let workshop = Workshop::new();
    workshop.write(
        "arc.ron",
        r#"Model(format: 1, entities: [(id: 1, name: "arc", definition: NurbsCurve(
            degree: 2, knots: [0.0, 0.0, 0.0, 1.0, 1.0, 1.0],
            control_points: [(1.0, 0.0, 0.0), (1.0, 1.0, 0.0), (0.0, 1.0, 0.0)],
            weights: Some([1.0, 0.7071067811865476, 1.0]),
        ))])"#,
    );
    let run = workshop.run(&["stationary", "arc.ron", "--entity", "1", "--point", "0,0,0"]);
    run.ends(0, "");
    assert!(run.out.contains("continuum  u 0.0 to 1.0 (1 box)"), "{}", run.out);
}

#[test]
fn a_wrong_point_and_an_unknown_entity_are_told() {
    let workshop = Workshop::new();
    for point in ["1,2", "1,2,3,4", "1,two,3", "1,2,inf", ""] {
        let run = workshop.run(&["stationary", "model.ron", "--entity", "1", "--point", point]);
        assert_eq!(run.code, Some(2), "{point:?}: {}", run.err);
        assert!(run.err.contains("three finite numbers"), "{point:?}: {}", run.err);
    }
    let run = workshop.run(&["stationary", "model.ron", "--entity", "9", "--point", "-1,-2,-3"]);
    assert_eq!(run.code, Some(1));
    assert!(run.err.contains("no entity has the id 9"), "{}", run.err);
    let run = workshop.run(&["stationary", "model.ron", "--entity", "1", "--point", "1e80,0,0"]);
    assert_eq!(run.code, Some(1));
    assert!(run.err.contains("1e75"), "{}", run.err);
}
