//! Trimmed faces and bodies: what `project`, `check` and `show` say of them.

use std::fmt::Write as _;

use serde_json::{Value, json};

use crate::workshop::{ANSWER, Workshop};

/// A cube from 0 to 2: faces 1 to 6, of which the first trims the larger entity 7 and follows the edge 8; body 9.
fn model() -> String {
    let mut text = "Model(format: 1, entities: [\n".to_owned();
    let mut id = 0;
    for axis in 0..3 {
        for far in [2, 0] {
            id += 1;
            let at = |u: i32, v: i32| {
                let mut point = [0; 3];
                point[axis] = far;
                point[(axis + 1) % 3] = u;
                point[(axis + 2) % 3] = v;
                format!("({}, {}, {})", point[0], point[1], point[2])
            };
            let surface = format!(
                "NurbsSurface(degree: (1, 1), knots: ([0, 0, 4, 4], [0, 0, 4, 4]), control_points: [[{}, {}], [{}, {}]])",
                at(0, 0),
                at(0, 4),
                at(4, 0),
                at(4, 4)
            );
            let (carrier, edge) =
                if id == 1 { ("Ref(7)".to_owned(), "Some(8)") } else { (format!("Own({surface})"), "None") };
            writeln!(
                text,
                "(id: {id}, name: \"side\", definition: TrimmedSurface(surface: {carrier}, reversed: {}, tolerance: 1e-6, loops: [(outer: true, curves: [\
                 (degree: 1, knots: [0, 0, 1, 1], points: [(0, 0), (2, 0)], edge: {edge}),\
                 (degree: 1, knots: [0, 0, 1, 2, 3, 3], points: [(2, 0), (2, 2), (0, 2), (0, 0)])])])),",
                far == 0
            )
            .unwrap();
            if id == 1 {
                writeln!(text, "(id: 7, name: \"carrier\", definition: {surface}),").unwrap();
            }
        }
    }
    text += "(id: 8, name: \"edge\", definition: NurbsCurve(degree: 1, knots: [0, 0, 1, 1], control_points: [(2, 0, 0), (2, 2, 0)])),\n";
    text += "(id: 9, name: \"cube\", colour: Some((1, 0.5, 0)), definition: Body(shells: [(faces: [1, 2, 3, 4, 5, 6], closed: true)])),\n";
    text += "(id: 10, name: \"cap\", definition: Body(shells: [(faces: [5], closed: false)])),\n])\n";
    text
}

fn workshop() -> Workshop {
    let workshop = Workshop::new();
    workshop.write("model.ron", model());
    workshop
}

#[test]
fn a_body_answers_with_its_nearest_face_and_the_sign_of_the_body() {
    let run = workshop().project("x,y,z\n1,1,3\n1,1,1.5\n3,-1,-1\n", &["--entity", "9", "--normals"]);
    run.ends(0, "3 points in ");
    assert_eq!(run.out.lines().next(), Some(&*format!("{ANSWER},nx,ny,nz,signed_distance")));
    assert_eq!((run.field(1, "entity"), run.field(1, "nz"), run.field(1, "place")), ("5", "1.0", "interior"));
    for (row, signed) in [(1, 1.0), (2, -0.5), (3, 3.0_f64.sqrt())] {
        assert!((run.number(row, "signed_distance") - signed).abs() < 1e-9, "{}", run.out);
        assert!(run.number(row, "lower_bound") <= run.number(row, "distance"));
    }
    assert_eq!(run.field(3, "place"), "vertex");
    // without normals, and within a distance
    let run = workshop().project("x,y,z\n1,1,3\n1,1,9\n", &["--entity", "9", "--max-distance", "2"]);
    run.ends(0, "beyond maximum: 1");
    assert_eq!((run.field(1, "entity"), run.field(2, "entity"), run.field(2, "distance")), ("5", "", ""));
    let run = workshop().project("x,y,z\n1,1,3\n1,1,9\n", &["--entity", "9", "--max-distance", "2", "--normals"]);
    run.ends(0, "beyond maximum: 1");
    assert_eq!((run.number(1, "signed_distance"), run.field(2, "signed_distance")), (1.0, ""));
}

#[test]
fn an_open_body_has_a_distance_and_no_sign() {
    let run = workshop().project("x,y,z\n1,1,3\n", &["--entity", "10"]);
    run.ends(0, "");
    assert_eq!((run.field(1, "entity"), run.number(1, "distance")), ("5", 1.0));
    let run = workshop().project("x,y,z\n1,1,3\n", &["--entity", "10", "--normals"]);
    run.ends(1, "error: model.ron: body 10 has no inside: shells[0] is not closed");
}

#[test]
fn several_entities_answer_in_ranks() {
    let run = workshop().project("note,x,y,z\na,1,1.2,3\nb,1,1,2.5\n", &["--k", "2"]);
    run.ends(0, "2 points in ");
    assert_eq!(run.out.lines().next(), Some(&*format!("{ANSWER},rank,note")));
    let found: Vec<_> = (1..5).map(|row| (run.field(row, "note"), run.field(row, "rank"))).collect();
    assert_eq!(found, [("a", "1"), ("a", "2"), ("b", "1"), ("b", "2")]);
    assert_eq!((run.field(1, "entity"), run.field(2, "entity")), ("5", "3"));
    // neither the carrier nor the edge is asked
    let run = workshop().project("x,y,z\n3,1,1\n", &["--k", "99"]);
    run.ends(0, "");
    assert_eq!(run.rows().len(), 1 + 6);

    let run = workshop().project("x,y,z\n1,1,3\n1,1,9\n", &["--within", "1.5"]);
    run.ends(0, "beyond maximum: 1");
    let rows: Vec<_> = (1..run.rows().len()).map(|row| (run.field(row, "entity"), run.field(row, "rank"))).collect();
    assert_eq!(rows, [("5", "1"), ("1", "2"), ("2", "3"), ("3", "4"), ("4", "5"), ("", "")]);
}

#[test]
fn options_that_contradict_each_other_are_wrong_usage() {
    let points = "entity,x,y,z\n1,0,0,0\n";
    workshop()
        .project(points, &["--k", "2"])
        .ends(2, "points.csv has a column `entity`, and --k asks the whole model: leave out one of them");
    workshop().project(points, &["--within", "2"]).ends(2, "and --within asks the whole model");
    for options in
        [&["--k", "2", "--within", "1"][..], &["--k", "2", "--entity", "1"], &["--within", "2", "--entity", "1"]]
    {
        workshop().project("x,y,z\n", options).ends(2, "cannot be used with");
    }
    workshop().project("x,y,z\n", &["--k", "0"]).ends(2, "invalid value '0' for '--k <N>'");
}

#[test]
fn check_and_show_tell_of_trims_and_bodies() {
    let run = workshop().run(&["check", "model.ron"]);
    run.ends(0, "");
    let expected = "     1  \"side\": surface of degree (1, 1), 2 x 2 control points of entity 7, trimmed by 1 loop of 2 p-curves\n";
    assert!(run.out.contains(expected), "{}", run.out);
    assert!(run.out.contains("     9  \"cube\": body of a closed shell of 6 faces\n"), "{}", run.out);
    assert!(run.out.contains("model.ron: valid; 1 curve, 7 surfaces; size "), "{}", run.out);
    assert!(run.out.ends_with(" mm; 2 bodies\n"), "{}", run.out);

    let run = workshop().run(&["show", "model.ron"]);
    assert!(run.out.contains("TrimmedSurface  (1, 1)  2 x 2"), "{}", run.out);
    assert!(run.out.contains("Body"), "{}", run.out);
    let run = workshop().run(&["show", "model.ron", "--entity", "9"]);
    assert!(run.out.contains("closed      faces 1, 2, 3, 4, 5, 6\ncolour      (1.0, 0.5, 0.0)\n"), "{}", run.out);
    let run = workshop().run(&["show", "model.ron", "--entity", "1"]);
    assert!(run.out.contains("            outer loop of 2 p-curves, edges 8\n"), "{}", run.out);
    workshop().run(&["show", "model.ron", "--entity", "77"]).ends(1, "no entity has the id 77");

    let shown = |id: &str| -> Value {
        let run = workshop().run(&["show", "model.ron", "--json", "--entity", id]);
        let mut listing: Value = serde_json::from_str(&run.out).unwrap();
        listing["entities"][0].take()
    };
    assert_eq!(
        shown("1")["definition"],
        json!({"kind": "TrimmedSurface", "surface": 7, "degree": [1, 1], "points": [2, 2], "reversed": false, "tolerance": 1e-6,
               "loops": [{"outer": true, "curves": 2, "edges": [8]}]})
    );
    assert_eq!(
        shown("9"),
        json!({"id": 9, "name": "cube", "colour": [1.0, 0.5, 0.0], "knowledge": null,
               "definition": {"kind": "Body", "shells": [{"faces": [1, 2, 3, 4, 5, 6], "closed": true}]}})
    );
}

#[test]
fn cleaning_leaves_faces_that_follow_others_to_these() {
    let workshop = workshop();
    workshop.run(&["clean", "model.ron", "-o", "clean.ron"]).ends(0, "");
    workshop.run(&["check", "clean.ron"]).ends(0, "");
    workshop
        .run(&["clean", "model.ron", "--entity", "1", "-o", "clean.ron"])
        .ends(1, "entity 1 trims entity 7 and follows it: prepare entity 7");
    let run = workshop.run(&["impact", "model.ron", "--entity", "7"]);
    run.ends(0, "");
    assert!(run.out.contains("rebuilt"), "{}", run.out);
}
