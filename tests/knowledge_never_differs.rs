//! Knowledge makes an answer faster, never different: every test set is asked with all that can be known of its entities, with nothing,
//! with each item of knowledge removed in turn, and with each solver; distances agree within the gap, and keep to the truth.
//!
//! Asked is one row in forty of each set, by its number. The environment variable `PERPEND_ALL_ROWS`, set to anything, asks all:
//! `PERPEND_ALL_ROWS=1 cargo test --test knowledge_never_differs -- --nocapture`.

#![allow(
    clippy::print_stderr,
    reason = "the share of the closed forms and the largest difference are wanted by readers"
)]

mod common;

use common::corpus::{self, Row};
use common::judgement::{is_certified, rounding};
use common::known::{known, with_record, without_each_item};
use glam::DVec3;
use perpend::{
    Basis, Classification, Definition, EntityId, FootPoint, Item, Kind, Method, Model, QueryOptions, Record,
};

/// One row of so many is asked.
const ONE_IN: usize = 40;

/// An entity with a certain knowledge, asked in a certain way.
struct Variant {
    what: String,
    model: Model,
    method: Option<Method>,
}

fn variants(definition: &Definition) -> Vec<Variant> {
    let full = known(definition);
    let made = |what: &str, record: Option<Record>, method| {
        let model = with_record(definition, record).expect("the record is valid");
        Variant { what: what.to_owned(), model, method }
    };
    let kind = Item { value: Kind::FreeForm, basis: Basis::Declared, tolerance: 0.0, of: definition.fingerprint() };
    let classification = Some(Classification { kind: Some(kind), ..Classification::default() });
    let mut variants = vec![
        made("nothing is known", None, None),
        made("all is known", Some(full.clone()), None),
        made("all is known, the certified solver is asked", Some(full.clone()), Some(Method::Hierarchy)),
        made("all is known, the closed form is asked", Some(full.clone()), Some(Method::Analytic)),
        made("a free form, it is said", Some(Record { classification, ..Record::default() }), None),
    ];
    let removed = without_each_item(&full);
    variants
        .extend(removed.into_iter().map(|(item, record)| made(&format!("{item} is not known"), Some(record), None)));
    variants
}

#[derive(Default)]
struct Tally {
    rows: usize,
    queries: usize,
    analytic: usize,
    /// Of distances of one row, as a share of the entity's size.
    difference: f64,
    failures: Vec<String>,
}

fn ask(set: &str, tally: &mut Tally) {
    let truth = corpus::rows(&corpus::data().join(format!("{set}.truth.csv")));
    let all = std::env::var_os("PERPEND_ALL_ROWS").is_some();
    for entry in corpus::entities(&corpus::data().join(format!("{set}.json"))) {
        let definition = entry.shape.definition();
        let rows = truth.iter().enumerate().filter(|(k, row)| row.entity == entry.id && (all || k % ONE_IN == 0));
        let rows: Vec<&Row> = rows.map(|(_, row)| row).collect();
        let points: Vec<DVec3> = rows.iter().map(|row| row.point).collect();
        let (size, reach) = (entry.shape.size(), entry.shape.reach());
        let mut least: Vec<f64> = vec![f64::INFINITY; rows.len()];
        let mut most: Vec<f64> = vec![0.0; rows.len()];
        for Variant { what, model, method } in variants(&definition) {
            let options = QueryOptions { method, ..QueryOptions::default() };
            let id: EntityId = model.entities()[0].id();
            for (k, answer) in model.project_all(id, &points, &options).into_iter().enumerate() {
                let foot: FootPoint = answer.expect("a finite point").expect("no distance is too far");
                let (p, want) = (points[k], rows[k].distance());
                let tolerance = rounding(reach, p, want);
                let right = (foot.distance - want).abs() <= 1e-9 * size + tolerance
                    && foot.lower_bound <= want + 1e-10 * size + tolerance
                    && is_certified(foot.distance, foot.lower_bound, 1e-9 * size, reach, p);
                if !right {
                    tally.failures.push(format!("{set} {}, {what}, at {p}: truth {want:e}, {foot:?}", entry.name));
                }
                least[k] = least[k].min(foot.distance);
                most[k] = most[k].max(foot.distance);
                tally.queries += 1;
                tally.analytic += usize::from(foot.method == Method::Analytic);
            }
        }
        tally.rows += rows.len();
        for k in 0..rows.len() {
            let apart = most[k] - least[k];
            tally.difference = tally.difference.max(apart / size);
            if apart > 1e-9 * size + rounding(reach, points[k], most[k]) {
                tally.failures.push(format!("{set} {} at {}: {apart:e} apart", entry.name, points[k]));
            }
        }
    }
}

fn never_differs(set: &str) -> Tally {
    let mut tally = Tally::default();
    ask(set, &mut tally);
    let Tally { rows, queries, analytic, difference, ref failures } = tally;
    eprintln!(
        "{set}: {rows} rows, {queries} answers, {analytic} of them in closed form, the largest difference {difference:.1e} of the size"
    );
    let shown = failures.iter().take(8).cloned().collect::<Vec<_>>().join("\n");
    assert!(failures.is_empty(), "{} failures\n{shown}", failures.len());
    tally
}

#[test]
fn knowledge_changes_no_answer_on_the_curves() {
    assert!(never_differs("seeds-curves").rows >= 470);
}

#[test]
fn knowledge_changes_no_answer_on_the_surfaces() {
    assert!(never_differs("seeds-surfaces").rows >= 400);
}

#[test]
fn knowledge_changes_no_answer_on_the_quadrics() {
    let Tally { rows, queries, analytic, .. } = never_differs("quadrics");
    assert!(rows >= 370 && 4 * analytic >= 3 * queries, "closed forms answer {analytic} of {queries}");
}

#[test]
fn knowledge_changes_no_answer_on_the_circles() {
    let Tally { rows, queries, analytic, .. } = never_differs("circles-table1");
    assert!(rows >= 300 && 4 * analytic >= 3 * queries, "closed forms answer {analytic} of {queries}");
}
