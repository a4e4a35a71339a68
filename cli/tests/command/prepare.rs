//! `clean`, `purge` and `restore`.

use perpend::{EntityId, Model};

use crate::workshop::Workshop;

/// A parabola whose middle knot is needless, a corner, and a wave of small waves.
const NEEDLESS: &str = "\
Model(
    format: 1,
    entities: [
        (id: 3, name: \"bow\", definition: NurbsCurve(
            degree: 2, knots: [0.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0],
            control_points: [(-1.0, 0.0, 0.0), (-0.5, 1.0, 0.0), (0.5, 1.0, 0.0), (1.0, 0.0, 0.0)],
        )),
        (id: 4, name: \"corner\", definition: NurbsCurve(
            degree: 1, knots: [0.0, 0.0, 1.0, 2.0, 2.0], control_points: [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 1.0, 0.0)],
        )),
        (id: 9, name: \"rough edge\", definition: NurbsCurve(
            degree: 1, knots: [0.0, 0.0, 1.0, 2.0, 3.0, 4.0, 4.0],
            control_points: [(0.0, 0.0, 0.0), (1.0, 0.01, 0.0), (2.0, 0.0, 0.0), (3.0, 0.01, 0.0), (4.0, 0.0, 0.0)],
        )),
    ],
)
";

fn needless() -> Workshop {
    let workshop = Workshop::new();
    workshop.write("model.ron", NEEDLESS);
    workshop
}

fn points(workshop: &Workshop, file: &str) -> Vec<usize> {
    let model = Model::read(workshop.path(file)).unwrap();
    model.entities().iter().map(|entity| entity.definition().control_points().len()).collect()
}

#[test]
fn clean_says_what_went() {
    let workshop = needless();
    let run = workshop.run(&["clean", "model.ron", "-o", "clean.ron"]);
    run.ends(0, "");
    let lines: Vec<&str> = run.out.lines().collect();
    let [bow, total] = lines[..] else { panic!("{}", run.out) };
    assert!(
        bow.starts_with("     3  \"bow\": 4 to 3 control points; removed 1 knot in u; points moved by at most "),
        "{bow}"
    );
    assert!(bow.ends_with("e-15 mm"), "{bow}");
    assert_eq!(total, "clean.ron: cleaned 1 of 3 entities");
    assert_eq!((points(&workshop, "model.ron"), points(&workshop, "clean.ron")), (vec![4, 3, 5], vec![3, 3, 5]));
    let check = workshop.run(&["check", "clean.ron"]);
    check.ends(0, "");
    assert!(check.out.contains("        removed 1 knot in u, which moved points by at most "), "{}", check.out);
    // in place, and one entity alone
    workshop.run(&["clean", "model.ron", "--entity", "4", "-o", "model.ron"]).ends(0, "");
    assert_eq!(points(&workshop, "model.ron"), [4, 3, 5]);
    workshop.run(&["clean", "model.ron", "--entity", "3", "-o", "model.ron"]).ends(0, "");
    assert_eq!(points(&workshop, "model.ron"), [3, 3, 5]);
}

#[test]
fn purge_needs_a_tolerance() {
    let workshop = needless();
    workshop.run(&["purge", "model.ron", "-o", "out.ron"]).ends(2, "--tolerance <T>");
    for bad in ["0", "-1", "NaN", "inf", "wide"] {
        let run = workshop.run(&["purge", "model.ron", "--tolerance", bad, "-o", "out.ron"]);
        run.ends(2, "it is how far points may move, in the model's unit: a finite number above 0");
    }
    assert!(!workshop.path("out.ron").exists());
}

#[test]
fn purge_keeps_originals_and_restore_gives_them_back() {
    let workshop = needless();
    let run = workshop.run(&["purge", "model.ron", "--tolerance", "0.02", "--entity", "9", "-o", "purged.ron"]);
    run.ends(0, "");
    let lines: Vec<&str> = run.out.lines().collect();
    let [edge, total] = lines[..] else { panic!("{}", run.out) };
    assert!(edge.starts_with("     9  \"rough edge\": 5 to "), "{edge}");
    assert!(edge.contains(" control points; purged "), "{edge}");
    assert!(edge.contains(" in u; points moved by at most 0.0"), "{edge}");
    assert_eq!(total, "purged.ron: purged 1 of 1 entity");
    assert!(points(&workshop, "purged.ron")[2] < 5);
    let check = workshop.run(&["check", "purged.ron"]);
    assert!(check.out.contains("        the original is kept: curve of degree 1, 5 control points\n"), "{}", check.out);
    let run = workshop.run(&["restore", "purged.ron", "-o", "back.ron"]);
    run.ends(0, "");
    assert_eq!(run.out, "back.ron: restored 1 original\n");
    let [before, after] = ["model.ron", "back.ron"].map(|file| {
        let model = Model::read(workshop.path(file)).unwrap();
        model.entity(EntityId::new(9)).unwrap().definition().fingerprint()
    });
    assert_eq!(before, after);
    let run = workshop.run(&["restore", "purged.ron", "--drop", "--entity", "9", "-o", "for_good.ron"]);
    run.ends(0, "");
    assert_eq!(run.out, "for_good.ron: dropped 1 original\n");
    assert_eq!(points(&workshop, "for_good.ron"), points(&workshop, "purged.ron"));
    workshop
        .run(&["restore", "for_good.ron", "--entity", "9", "-o", "out.ron"])
        .ends(1, "error: for_good.ron: entity 9 has no original: it was not purged, or its original was dropped");
    assert_eq!(workshop.run(&["restore", "for_good.ron", "-o", "out.ron"]).out, "out.ron: restored 0 originals\n");
}

#[test]
fn models_and_entities_that_are_not_there() {
    let workshop = needless();
    for command in [&["clean"][..], &["purge", "--tolerance", "1"], &["restore"]] {
        let run = |rest: &[&str]| workshop.run(&[command, rest].concat());
        run(&["model.ron", "--entity", "5", "-o", "out.ron"])
            .ends(1, "error: model.ron: no entity has the id 5; its ids are 3, 4, 9");
        run(&["none.ron", "-o", "out.ron"]).ends(1, "error: cannot read none.ron");
        run(&["model.ron", "-o", "no/such/folder.ron"]).ends(1, "error: cannot write no/such/folder.ron");
        run(&["model.ron"]).ends(2, "--output <OUT>");
    }
    assert!(!workshop.path("out.ron").exists());
}

#[test]
fn decompose_adds_the_parts_of_a_loop() {
    let workshop = needless();
    let with_loop = NEEDLESS.replace(
        "id: 4, name: \"corner\", definition: NurbsCurve(
            degree: 1, knots: [0.0, 0.0, 1.0, 2.0, 2.0], control_points: [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 1.0, 0.0)],",
        "id: 4, name: \"ribbon\", definition: NurbsCurve(
            degree: 3, knots: [0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0],
            control_points: [(0.0, 2.0, 0.0), (-1.0, 0.0, 0.0), (1.0, 1.0, 0.0), (-0.75, 1.625, 0.0)],",
    );
    assert_ne!(with_loop, NEEDLESS);
    workshop.write("model.ron", with_loop);
    let run = workshop.run(&["decompose", "model.ron", "-o", "parts.ron"]);
    run.ends(0, "");
    assert_eq!(run.out, "     4  \"ribbon\": 3 parts, entities 10 to 12\nparts.ron: took apart 1 of 3 curves\n");
    let model = Model::read(workshop.path("parts.ron")).unwrap();
    let names: Vec<&str> = model.entities().iter().map(perpend::Entity::name).collect();
    assert_eq!(names, ["bow", "ribbon", "rough edge", "ribbon 1 of 3", "ribbon 2 of 3", "ribbon 3 of 3"]);
    let run = workshop.run(&["decompose", "model.ron", "--entity", "3", "-o", "parts.ron"]);
    assert_eq!(run.out, "parts.ron: took apart 0 of 1 curve\n");
    let surface = Workshop::new();
    surface
        .run(&["decompose", "model.ron", "--entity", "2", "-o", "out.ron"])
        .ends(1, "error: model.ron: entity 2 is a surface; curves are taken apart: choose one");
}

#[test]
fn what_is_made_of_a_prepared_entity_is_named() {
    let workshop = Workshop::new();
    let model = concat!(env!("CARGO_MANIFEST_DIR"), "/../examples/workshop.ron");
    let run = workshop.run(&["purge", model, "--tolerance", "0.5", "--entity", "5", "-o", "purged.ron"]);
    run.ends(0, "");
    let anew = run.out.lines().find(|line| line.contains("corrugated sheet"));
    assert_eq!(anew, Some("    27  \"corrugated sheet\": made anew of what changed"));
}
