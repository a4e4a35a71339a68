//! What the first queries to a fresh entity cost: the prepared hierarchy beside exclusion, which needs no preparation of its own.

use std::sync::Arc;
use std::time::Instant;

use perpend_bench::{Corpus, Row, corpora, rows};
use perpend_kernel::Definition;
use perpend_projection::{Method, Prepared, Query, QueryOptions, Scratch};

use crate::Failure;

/// How many fresh entities each figure is the first quartile of: others use the machine, too.
const FRESH: usize = 61;

pub(crate) fn print() -> Result<(), Failure> {
    println!(
        "\nFresh entities, one thread: µs for the first 1, 10 and 100 queries of the grid, tree and proof included"
    );
    println!("{:<22}{:>10}{:>27}{:>27}{:>18}", "entity", "plan", "hierarchy", "exclusion, proved", "its own, a query");
    for set in ["seeds-curves", "seeds-surfaces"] {
        let corpus = Corpus::read(&corpora().join(set).with_extension("json"))?;
        let truth = rows(&corpora().join(format!("{set}.truth.csv")))?;
        for entity in &corpus.entities {
            let definition = Arc::new(entity.definition()?);
            let grid: Vec<&Row> = truth.iter().filter(|row| row.entity == entity.id).take(1000).collect();
            line(&entity.name, &definition, &grid);
        }
    }
    Ok(())
}

fn line(name: &str, definition: &Arc<Definition>, grid: &[&Row]) {
    let micros = |start: Instant| start.elapsed().as_secs_f64() * 1e6;
    let mut plans = Vec::new();
    // the queries are spread over the grid, others for each fresh entity
    let mut ask = |method: Method, count: usize| {
        let options = QueryOptions { method: Some(method), ..QueryOptions::default() };
        let times = (0..FRESH).map(|round| {
            let start = Instant::now();
            let prepared = Prepared::new(Arc::clone(definition), None);
            plans.push(micros(start));
            let mut scratch = Scratch::default();
            let start = Instant::now();
            for k in 0..count {
                let row = grid[(round * 397 + k * 61) % grid.len()];
                let query = Query::new(row.point, options).expect("finite points");
                std::hint::black_box(prepared.project(&query, &mut scratch));
            }
            micros(start)
        });
        quartile(times.collect())
    };
    let counts = [1, 10, 100];
    let hierarchy = counts.map(|count| ask(Method::Hierarchy, count));
    let exclusion = counts.map(|count| ask(Method::Exclusion, count));
    // the hierarchy is the same for both, and so is the proof but for its start
    let own = (exclusion[2] - hierarchy[2]) / 100.0;
    let columns = |times: [f64; 3]| times.map(|time| format!("{time:>9.0}")).concat();
    println!("{name:<22.21}{:>10.0}{}{}{own:>18.1}", quartile(plans), columns(hierarchy), columns(exclusion));
}

fn quartile(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 4]
}
