//! `export`.

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
fn the_model_is_not_written_over() {
    let workshop = Workshop::new();
    let run = workshop.run(&["export", "model.ron", "-o", "model.ron", "--format", "obj"]);
    run.ends(2, "model.ron is the model; it would be lost: give another file to -o");
    assert_eq!(workshop.read("model.ron"), crate::workshop::MODEL);
}
