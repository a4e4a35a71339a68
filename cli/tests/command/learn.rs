//! `learn`.

use crate::workshop::Workshop;

#[test]
fn learn_writes_the_model_with_what_it_learned() {
    let workshop = Workshop::new();
    let run = workshop.run(&["learn", "model.ron", "-o", "learned.ron"]);
    run.ends(0, "learned.ron: learned of 3 of 3 entities");
    assert_eq!(run.out, "");
    let (old, new) = (workshop.path("model.ron"), workshop.path("learned.ron"));
    let (old, new) = (perpend::Model::read(old).unwrap(), perpend::Model::read(new).unwrap());
    for (old, new) in old.entities().iter().zip(new.entities()) {
        assert_eq!(old.definition(), new.definition());
        assert_eq!(old.revision(), new.revision(), "learning is no edit");
        assert!(new.record().unwrap().representation.is_some() && new.stale().is_empty());
    }
}

#[test]
fn learn_tells_programs_what_is_known() {
    let workshop = Workshop::new();
    let run = workshop.run(&["learn", "model.ron", "-o", "learned.ron", "--json"]);
    run.ends(0, "learned.ron: learned of 3 of 3 entities");
    let shown = workshop.run(&["show", "learned.ron", "--json"]);
    assert_eq!(run.out, shown.out);
    let said: serde_json::Value = serde_json::from_str(&run.out).expect("JSON");
    assert!(said["entities"][0]["knowledge"]["representation"]["speed"].is_array(), "{said}");
}

#[test]
fn what_is_known_is_not_learned_again() {
    let workshop = Workshop::new();
    workshop.run(&["learn", "model.ron", "-o", "learned.ron"]).ends(0, "learned.ron: learned of 3 of 3 entities");
    let first = workshop.read("learned.ron");
    workshop.run(&["learn", "learned.ron", "-o", "learned.ron"]).ends(0, "learned.ron: learned of 0 of 3 entities");
    assert_eq!(workshop.read("learned.ron"), first);
}

#[test]
fn what_was_declared_stays() {
    let workshop = Workshop::new();
    let declared = "(value: 5.0, basis: Declared, tolerance: 0.5, of: \"fnv1a64:0123456789abcdef\")";
    let model = workshop.read("model.ron").replacen(
        ")),\n        (id: 2",
        &format!("), knowledge: Some((representation: Some((length: {declared}))))),\n        (id: 2"),
        1,
    );
    workshop.write("model.ron", &model);
    workshop.run(&["learn", "model.ron", "-o", "learned.ron"]).ends(0, "learned.ron: learned of 3 of 3 entities");
    let learned = perpend::Model::read(workshop.path("learned.ron")).unwrap();
    let part = learned.entities()[0].record().unwrap().representation.as_ref().unwrap();
    assert_eq!(part.length.as_ref().map(|item| item.value), Some(5.0));
    assert!(part.speed.is_some() && part.bounds.is_some());
}

#[test]
fn a_model_that_cannot_be_read_or_written_is_told() {
    let workshop = Workshop::new();
    workshop.run(&["learn", "none.ron", "-o", "learned.ron"]).ends(1, "none.ron");
    workshop.run(&["learn", "model.ron"]).ends(2, "--output");
    let run = workshop.run(&["learn", "model.ron", "-o", "no/where.ron"]);
    run.ends(1, "no/where.ron");
    assert_eq!(workshop.files(), ["model.ron"]);
}

#[test]
fn a_file_that_states_something_false_is_refused_or_repaired() {
    let workshop = Workshop::new();
    workshop.run(&["learn", "model.ron", "-o", "true.ron"]).ends(0, "learned of 3 of 3");
    let learned = workshop.read("true.ron");
    let at = learned.find("length: (").expect("the arc length of a curve");
    let value = at + learned[at..].find("value: ").expect("its value") + "value: ".len();
    workshop.write("false.ron", format!("{}1{}", &learned[..value], &learned[value..]));
    workshop.write("points.csv", "x,y,z\n1,2,3\n");
    for command in [
        &["check", "false.ron"][..],
        &["show", "false.ron"],
        &["explain", "false.ron", "--entity", "1"],
        &["project", "false.ron", "points.csv"],
        &["learn", "false.ron", "-o", "mended.ron"],
    ] {
        let run = workshop.run(command);
        run.ends(1, "entity 1: knowledge: representation.length is false: it lies between");
        assert!(run.err.contains("--repair"), "{}", run.err);
        workshop.run(&[command, &["--repair"]].concat()).ends(0, "");
    }
    assert_eq!(workshop.read("mended.ron"), learned);
}
