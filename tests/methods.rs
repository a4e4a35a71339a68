//! One meaning, every solver: each method that can be asked for gives the same proven distance on every test set, and on models that nobody
//! here wrote.
//!
//! A fixed share of the rows is asked, by index; all of them where the environment variable `PERPEND_ALL_ROWS` is set. What a method declines or
//! proposes wrongly, the hierarchy answers: that is counted and told, and changes no distance.

#![allow(clippy::print_stderr, reason = "a test that skips says so aloud; the counts are wanted by readers")]

mod common;

use common::corpus::{self, Row};
use common::judgement::{is_certified, is_false_bound, rounding};
use perpend::{Method, Model, QueryOptions};

/// A method, and one row of how many is asked of each set in a short run.
const METHODS: [(Method, usize); 6] = [
    (Method::Analytic, 9),
    (Method::Hierarchy, 9),
    (Method::Wave, 61),
    (Method::Exclusion, 17),
    (Method::ControlPolygon, 61),
    (Method::Bernstein, 241),
];

/// The rows that are asked; the first of each entity always.
fn share<'a>(rows: &'a [&'a Row], one_of: usize) -> impl Iterator<Item = &'a Row> {
    let all = std::env::var_os("PERPEND_ALL_ROWS").is_some();
    rows.iter().enumerate().filter(move |(k, _)| all || k % one_of == 0).map(|(_, row)| *row)
}

/// Asks every method for a share of the rows of a set; `exact` says whether the distances are true, or the best known.
fn check(name: &str, entities: &std::path::Path, rows: &std::path::Path, exact: bool) {
    let truth = corpus::rows(rows);
    let mut failures = Vec::new();
    let mut counts = METHODS.map(|_| [0; 3]);
    for entry in corpus::entities(entities) {
        let of_entity: Vec<&Row> = truth.iter().filter(|row| row.entity == entry.id).collect();
        if of_entity.is_empty() {
            continue;
        }
        let (size, reach) = (entry.shape.size(), entry.shape.reach());
        let mut model = Model::new();
        let id = model.insert(&entry.name, entry.shape.definition()).expect("a valid entity");
        for ((method, one_of), count) in METHODS.iter().zip(&mut counts) {
            let options = QueryOptions { method: Some(*method), ..QueryOptions::default() };
            let mut projector = model.projector(id).expect("it is there");
            for row in share(&of_entity, *one_of) {
                let (p, want) = (row.point, row.distance());
                let foot = projector.project(p, &options).expect("a finite point").expect("no distance is too far");
                let tolerance = 1e-9 * size + rounding(reach, p, want) * if exact { 1.0 } else { 2.0 };
                let wrong = if exact { (foot.distance - want).abs() } else { foot.distance - want } > tolerance;
                let is_false = is_false_bound(foot.lower_bound, want + 1e-10 * size + rounding(reach, p, want), size);
                if wrong || is_false || !is_certified(foot.distance, foot.lower_bound, 1e-9 * size, reach, p) {
                    failures.push(format!("{name} {} at {p} by {method:?}: {foot:?}, known {want:e}", entry.name));
                }
                if foot.method != *method && foot.method != Method::Hierarchy {
                    failures
                        .push(format!("{name} {} at {p}: {method:?} was asked, {:?} answers", entry.name, foot.method));
                }
            }
            let statistics = projector.statistics();
            let seen = [statistics.queries, statistics.corrected, statistics.declined];
            count.iter_mut().zip(seen).for_each(|(sum, seen)| *sum += seen);
        }
    }
    for ((method, _), [asked, corrected, declined]) in METHODS.iter().zip(counts) {
        eprintln!("{name}, {method:?}: {asked} asked, {corrected} corrected, {declined} declined");
    }
    let shown = failures.iter().take(10).cloned().collect::<Vec<_>>().join("\n");
    assert!(failures.is_empty(), "{name}: {} failures\n{shown}", failures.len());
}

fn check_set(set: &str) {
    let file = |ending: &str| corpus::data().join(format!("{set}{ending}"));
    check(set, &file(".json"), &file(".truth.csv"), true);
}

#[test]
fn every_method_gives_the_true_distances_of_the_curves() {
    check_set("seeds-curves");
}

#[test]
fn every_method_gives_the_true_distances_of_the_surfaces() {
    check_set("seeds-surfaces");
}

#[test]
fn every_method_gives_the_true_distances_of_the_quadrics() {
    check_set("quadrics");
}

#[test]
fn every_method_gives_the_true_distances_of_the_circles() {
    check_set("circles-table1");
}

#[test]
fn every_method_comes_as_near_as_any_kernel_on_real_models() {
    let Ok(folders) = std::fs::read_dir(corpus::real()) else {
        eprintln!("skipped: {} is absent; PERPEND_SHARED names the folder that holds real/", corpus::real().display());
        return;
    };
    let mut folders: Vec<_> = folders.flatten().map(|entry| entry.path()).collect();
    folders.sort();
    for folder in folders.iter().filter(|folder| folder.join("best-known.csv").is_file()) {
        let name = folder.file_name().expect("a folder has a name").to_string_lossy();
        check(&name, &folder.join("corpus.json"), &folder.join("best-known.csv"), false);
    }
}
