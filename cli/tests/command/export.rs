//! `export`.

use perpend::{Frame, Model, Sphere};

use crate::workshop::Workshop;

#[test]
fn the_ending_names_the_format() {
    let workshop = Workshop::new();
    workshop.run(&["export", "model.ron", "-o", "out.stl"]).ends(0, "out.stl: 1 face, 2 triangles, within 0.0 mm");
    let bytes = std::fs::read(workshop.path("out.stl")).unwrap();
    assert_eq!(bytes.len(), 84 + 2 * 50);
    workshop.run(&["export", "model.ron", "-o", "out.obj"]).ends(0, "out.obj: 1 face, 2 triangles");
    let obj = workshop.read("out.obj");
    assert!(obj.starts_with("# lengths in mm\no table\nv 0 0 10\n"), "{obj}");
    assert!(obj.contains("\no edge\nv 0 0 0\nv 4 0 0\nl 5 6\n") && obj.contains("\no rim\n"), "{obj}");
    workshop.run(&["export", "model.ron", "-o", "out.stp"]).ends(0, "out.stp: 0 bodies, 1 face, 2 free curves");
    let step = workshop.read("out.stp");
    assert!(step.starts_with("ISO-10303-21;\n") && step.ends_with("END-ISO-10303-21;\n"), "{step}");
    assert!(step.contains("ADVANCED_FACE('table',"), "{step}");
    workshop.run(&["export", "model.ron", "-o", "out.json"]).ends(0, "out.json: 3 entities");
    assert_eq!(workshop.read("out.json"), workshop.run(&["show", "model.ron", "--json"]).out);
}

#[test]
fn standard_output_needs_a_format() {
    let workshop = Workshop::new();
    let run = workshop.run(&["export", "model.ron", "-o", "-"]);
    run.ends(2, "-: no ending that names a format: name it .step, .stp, .obj, .stl or .json, or give --format");
    let run = workshop.run(&["export", "model.ron", "-o", "-", "--format", "stl", "--ascii"]);
    run.ends(0, "2 curves left out: STL holds triangles alone");
    assert!(run.out.starts_with("solid table\nfacet normal 0e0 0e0 1e0\n"), "{}", run.out);
    assert_eq!(run.out.matches("facet normal").count(), 2);
}

#[test]
fn options_that_mean_nothing_to_a_format_are_refused() {
    let workshop = Workshop::new();
    let run = workshop.run(&["export", "model.ron", "-o", "out.step", "--chord", "0.1"]);
    run.ends(2, "--chord means nothing to STEP: leave it out");
    let run = workshop.run(&["export", "model.ron", "-o", "out.json", "--most-triangles", "9"]);
    run.ends(2, "--most-triangles means nothing to JSON: leave it out");
    workshop
        .run(&["export", "model.ron", "-o", "out.obj", "--ascii"])
        .ends(2, "--ascii means nothing to OBJ: leave it out");
    workshop.run(&["export", "model.ron", "-o", "out.stl", "--chord", "0"]).ends(2, "a finite number above 0");
    assert_eq!(workshop.files(), ["model.ron"]);
}

#[test]
fn one_entity_alone() {
    let workshop = Workshop::new();
    workshop
        .run(&["export", "model.ron", "-o", "out.obj", "--entity", "7", "--chord", "0.5"])
        .ends(0, "0 faces, 0 triangles");
    assert!(!workshop.read("out.obj").contains("table"));
    let run = workshop.run(&["export", "model.ron", "-o", "none.stl", "--entity", "7"]);
    run.ends(1, "model.ron: there is no surface, and STL holds triangles alone: nothing to write");
    workshop
        .run(&["export", "model.ron", "-o", "none.stl", "--entity", "3"])
        .ends(1, "no entity has the id 3; its ids are 1, 2, 7");
    assert_eq!(workshop.files(), ["model.ron", "out.obj"]);
}

#[test]
fn a_chord_error_that_is_too_small_is_an_error_that_names_one_that_would_do() {
    let workshop = Workshop::new();
    let run = workshop.run(&["export", "model.ron", "-o", "out.obj", "--entity", "7", "--chord", "1e-15"]);
    run.ends(1, "model.ron: entity 7: 250000 segments are too few for the chord error 1e-15: --chord ");
    let would = run.err.split("--chord ").nth(1).and_then(|rest| rest.split_whitespace().next()).unwrap().to_owned();
    workshop.run(&["export", "model.ron", "-o", "out.obj", "--entity", "7", "--chord", &would]).ends(0, "segments");
}

#[test]
fn too_many_triangles_together_are_an_error_that_names_a_chord_error_that_does() {
    let workshop = Workshop::new();
    let ball = Sphere::whole(Frame::WORLD, 2.0).unwrap().to_nurbs().unwrap();
    let mut model = Model::new();
    for name in ["one", "two", "three"] {
        model.insert(name, ball.clone()).unwrap();
    }
    model.write(workshop.path("balls.ron")).unwrap();
    let export = |chord: &str, most: &str| {
        workshop.run(&["export", "balls.ron", "-o", "out.stl", "--chord", chord, "--most-triangles", most])
    };
    let run = export("1e-4", "20000");
    run.ends(1, "balls.ron: the chord error 0.0001 takes more than 20000 triangles: --chord ");
    assert_eq!(workshop.files(), ["balls.ron", "model.ron"]);
    let would = run.err.split("--chord ").nth(1).and_then(|rest| rest.split_whitespace().next()).unwrap().to_owned();
    export(&would, "20000").ends(0, "3 faces");
    // each of them alone has fewer
    let count = (std::fs::metadata(workshop.path("out.stl")).unwrap().len() - 84) / 50;
    export(&would, &count.to_string()).ends(0, "3 faces");
    export(&would, &(count - 1).to_string()).ends(1, &format!("more than {} triangles: --chord ", count - 1));
    export(&would, "5").ends(1, "more than 5 triangles: give more of them with --most-triangles, or one --entity");
    export("1", "0").ends(2, "--most-triangles");
}

#[test]
fn the_model_is_not_written_over() {
    let workshop = Workshop::new();
    let run = workshop.run(&["export", "model.ron", "-o", "model.ron", "--format", "obj"]);
    run.ends(2, "model.ron is the model; it would be lost: give another file to -o");
    assert_eq!(workshop.read("model.ron"), crate::workshop::MODEL);
}
