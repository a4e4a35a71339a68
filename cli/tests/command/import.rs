//! `import`, and the example part: made by the example's code, written by `export`, imported and reported on.

use std::fs;
use std::path::{Path, PathBuf};

use crate::workshop::Workshop;

#[path = "../../../examples/bracket/mod.rs"]
mod bracket;

fn example(file: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples").join(file)
}

#[test]
fn the_example_part_is_what_its_code_and_the_exporter_make() {
    let workshop = Workshop::new();
    bracket::make(&workshop.path("")).unwrap();
    workshop.run(&["export", "bracket.ron", "-o", "bracket.step"]).ends(0, "1 body, 21 faces");
    for file in ["bracket.step", "bracket.csv"] {
        let made = fs::read(workshop.path(file)).unwrap();
        let kept = fs::read(example(file)).unwrap();
        assert!(
            made == kept,
            "{file} is not what the code makes: run `cargo run --example make_bracket`, and `perpend export` on its model"
        );
    }
}

#[test]
fn a_part_becomes_a_model_that_can_be_asked() {
    let workshop = Workshop::new();
    let part = example("bracket.step");
    let part = part.to_str().unwrap();
    workshop
        .run(&["import", part, "-o", "part.ron"])
        .ends(0, "part.ron: 21 faces (20 of known class), 50 edges, 1 body; size 167.678 mm");
    let first = workshop.read("part.ron");
    workshop.run(&["import", part, "-o", "part.ron"]).ends(0, "21 faces");
    assert_eq!(first, workshop.read("part.ron"), "two imports give the same bytes");
    workshop.run(&["check", "part.ron"]).ends(0, "");
    let scan = example("bracket.csv");
    workshop.run(&["project", "part.ron", scan.to_str().unwrap(), "-o", "feet.csv"]).ends(0, "not certified:  0");
    let feet = workshop.read("feet.csv");
    assert_eq!(feet.lines().count(), fs::read_to_string(scan).unwrap().lines().count());
    assert!(feet.contains(",interior,"), "{feet}");
}

/// What was not understood is named by its number, and the rest is written; `--partial` takes that for success.
#[test]
fn what_is_not_understood_is_listed_and_counts() {
    let workshop = Workshop::new();
    let text = fs::read_to_string(example("bracket.step")).unwrap();
    let broken = text.replacen("TOROIDAL_SURFACE", "BLOB_SURFACE", 1);
    assert_ne!(text, broken);
    fs::write(workshop.path("part.step"), broken).unwrap();
    let run = workshop.run(&["import", "part.step", "-o", "part.ron"]);
    run.ends(1, "part.ron: 20 faces");
    assert!(run.err.contains("part.step: not understood, and not in the model:\n  #"), "{}", run.err);
    assert!(run.err.contains("BLOB_SURFACE"), "{}", run.err);
    workshop.run(&["import", "part.step", "-o", "again.ron", "--partial"]).ends(0, "BLOB_SURFACE");
    assert_eq!(workshop.read("part.ron"), workshop.read("again.ron"));
}

#[test]
fn what_is_no_part_is_refused() {
    let workshop = Workshop::new();
    let refused = |name: &str, bytes: &[u8], expected: &str| {
        fs::write(workshop.path(name), bytes).unwrap();
        workshop.run(&["import", name, "-o", "part.ron"]).ends(1, expected);
        assert!(!workshop.files().contains(&"part.ron".to_owned()), "nothing is written");
    };
    refused("empty.step", b"", "empty.step: ");
    refused("gzip.step", &[0x1f, 0x8b, 8, 0, 0, 0], "gzip.step: this is no STEP file");
    let text = fs::read(example("bracket.step")).unwrap();
    refused("short.step", &text[..text.len() / 2], "short.step: the file ends in line ");
    workshop.run(&["import", "absent.step", "-o", "part.ron"]).ends(1, "absent.step: the file cannot be read: ");
    workshop.run(&["import", ".", "-o", "part.ron"]).ends(1, ".: the file cannot be read: ");
    workshop.run(&["import", "short.step"]).ends(2, "--output");
    fs::write(workshop.path("large.step"), vec![b' '; (1 << 20) + 1]).unwrap();
    let run = workshop.run(&["import", "large.step", "-o", "part.ron", "--max-megabytes", "1"]);
    run.ends(1, "large.step: the file has 1048577 bytes, more than the 1048576 that are allowed");
}

#[test]
fn the_part_is_not_overwritten() {
    let workshop = Workshop::new();
    fs::copy(example("bracket.step"), workshop.path("part.step")).unwrap();
    workshop.run(&["import", "part.step", "-o", "part.step"]).ends(2, "part.step is an input; it would be lost");
    assert_eq!(fs::read(example("bracket.step")).unwrap(), fs::read(workshop.path("part.step")).unwrap());
}

/// A body has no definition that could be explained; a name of a hundred thousand letters does not fill a table.
#[test]
fn bodies_and_long_names_are_told_apart() {
    let workshop = Workshop::new();
    let part = example("bracket.step");
    workshop.run(&["import", part.to_str().unwrap(), "-o", "part.ron"]).ends(0, "1 body");
    let text = workshop.read("part.ron");
    let body: u64 = text.rsplit("id: ").next().and_then(|rest| rest.split(',').next()?.parse().ok()).unwrap();
    let body = body.to_string();
    workshop.run(&["explain", "part.ron", "--entity", &body]).ends(1, "is a body, which has no definition of its own");
    let long = text.replacen("name: \"", &format!("name: \"{}", "n".repeat(100_000)), 1);
    fs::write(workshop.path("long.ron"), long).unwrap();
    let run = workshop.run(&["show", "long.ron"]);
    run.ends(0, "");
    assert!(run.out.contains('…') && run.out.lines().all(|line| line.chars().count() < 300));
}
