//! Time and proof of a query on every entity of a corpus, one thread.
//!
//! `corpora CORPUS.json TRUTH.csv [--verbose]`

#![allow(clippy::print_stdout, reason = "a benchmark prints its table")]

use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use perpend_bench::{Corpus, Failure, Faults, Judge, Row, rows};
use perpend_projection::{Prepared, Query, QueryOptions, Scratch};

fn main() -> Result<(), Failure> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [corpus, truth, rest @ ..] = arguments.as_slice() else {
        return Err("usage: corpora CORPUS.json TRUTH.csv [--verbose]".into());
    };
    let verbose = rest.iter().any(|a| a == "--verbose");
    let corpus = Corpus::read(Path::new(corpus))?;
    let rows = rows(Path::new(truth))?;
    println!(
        "{:<4}{:<24}{:>7}{:>7}{:>7}{:>7}{:>9}{:>10}{:>8}{:>7}{:>7}{:>8}{:>9}{:>9}",
        "id",
        "entity",
        "rows",
        "wrong",
        "false",
        "open",
        "mean us",
        "p99.9 us",
        "boxes",
        "evals",
        "forms",
        "splits",
        "refined",
        "prep ms"
    );
    let (mut logarithms, mut entities) = (0.0, 0);
    for entity in &corpus.entities {
        let queries: Vec<_> = rows.iter().filter(|row| row.entity == entity.id).collect();
        if queries.is_empty() {
            continue;
        }
        let definition = Arc::new(entity.definition()?);
        let judge = Judge::new(&definition);
        let start = Instant::now();
        let prepared = Prepared::new(definition, None);
        let preparation = start.elapsed().as_secs_f64() * 1e3;
        let mut scratch = Scratch::default();
        let ask = |row: &Row, scratch: &mut Scratch| {
            let query = Query::new(row.point, QueryOptions::default()).expect("finite points");
            prepared.project(&query, scratch).expect("no distance limit")
        };
        for row in &queries {
            ask(row, &mut scratch);
        }
        scratch.statistics = Default::default();
        let (mut sum, mut times) = (Faults::default(), Vec::new());
        for row in &queries {
            let start = Instant::now();
            let foot = ask(row, &mut scratch);
            times.push(start.elapsed().as_secs_f64() * 1e6);
            let faults = judge.faults(row, &foot);
            if verbose && !faults.none() {
                println!("  {:?} truth {:e}: {foot:?}", row.point, row.distance);
            }
            sum += faults;
        }
        let n = queries.len() as f64;
        let mut mean = f64::MAX;
        let statistics = scratch.statistics.proof;
        for _ in 0..5 {
            let start = Instant::now();
            for row in &queries {
                std::hint::black_box(ask(row, &mut scratch));
            }
            mean = mean.min(start.elapsed().as_secs_f64() * 1e6 / n);
        }
        times.sort_by(f64::total_cmp);
        let per = |count: u64| count as f64 / n;
        println!(
            "{:<4}{:<24.23}{:>7}{:>7}{:>7}{:>7}{:>9.2}{:>10.1}{:>8.1}{:>7.2}{:>7.2}{:>8.2}{:>9.2}{:>9.2}",
            entity.id,
            entity.name,
            queries.len(),
            sum.wrong,
            sum.false_bounds,
            sum.open,
            mean,
            times[times.len() * 999 / 1000],
            per(statistics.boxes),
            per(statistics.evaluations),
            per(statistics.pieces),
            per(statistics.subdivisions),
            per(statistics.refinements),
            preparation
        );
        logarithms += mean.ln();
        entities += 1;
    }
    println!("geometric mean over {entities} entities: {:.3} us", (logarithms / f64::from(entities)).exp());
    Ok(())
}
