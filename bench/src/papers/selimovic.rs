//! Selimovic 2006, Figs. 8 and 10: mean subdivisions of a query, with his criteria and with those of Ma and Hewitt.

use std::sync::Arc;

use perpend_bench::{Corpus, Row, corpora, rows};
use perpend_kernel::Definition;
use perpend_projection::{Method, Prepared, Query, QueryOptions, Scratch, Statistics};

use crate::Failure;

/// The flatness at which subdivision ends, in shares of the size: the paper names none.
const FLATNESS: [f64; 3] = [1e-2, 1e-3, 1e-4];

/// The queries of an entity that lie on the paper's grid: 10 by 10 by 10 in a box three times the entity's.
const GRID: usize = 1000;

pub(crate) fn print() -> Result<(), Failure> {
    for (set, figure) in [("seeds-curves", "Fig. 8, curves"), ("seeds-surfaces", "Fig. 10, surfaces")] {
        let corpus = Corpus::read(&corpora().join(set).with_extension("json"))?;
        let truth = rows(&corpora().join(format!("{set}.truth.csv")))?;
        println!("\n{figure}: mean subdivisions over {GRID} points, flatness 1e-2 | 1e-3 | 1e-4 of the size");
        println!(
            "{:<22}{:>23}{:>24}{:>19}{:>9}{:>9}{:>17}{:>17}",
            "entity", "Ma & Hewitt", "Selimovic", "ratio in %", "splits", "pieces", "M&H wrong in %", "Sel. wrong in %"
        );
        for entity in &corpus.entities {
            let definition = Arc::new(entity.definition()?);
            let grid: Vec<&Row> = truth.iter().filter(|row| row.entity == entity.id).take(GRID).collect();
            line(&entity.name, &definition, &grid);
        }
    }
    Ok(())
}

fn line(name: &str, definition: &Arc<Definition>, grid: &[&Row]) {
    let prepared = Prepared::new(Arc::clone(definition), None);
    let ask = |method: Method, flatness: f64| -> Statistics {
        let options = QueryOptions {
            method: Some(method),
            flatness: Some(flatness * definition.size()),
            ..QueryOptions::default()
        };
        let mut scratch = Scratch::default();
        for row in grid {
            let query = Query::new(row.point, options).expect("finite points");
            prepared.project(&query, &mut scratch).expect("no distance limit");
        }
        scratch.statistics
    };
    let per = |count: u64| count as f64 / grid.len() as f64;
    let theirs = FLATNESS.map(|flatness| ask(Method::ControlPolygon, flatness));
    let his = FLATNESS.map(|flatness| ask(Method::Exclusion, flatness));
    let ours = ask(Method::Hierarchy, FLATNESS[1]).proof;
    let splits =
        |of: &[Statistics; 3]| of.map(|statistics| format!("{:8.2}", per(statistics.proposal.subdivisions))).concat();
    let wrong =
        |of: &[Statistics; 3]| of.map(|statistics| format!("{:6.1}", 100.0 * per(statistics.corrected))).concat();
    let ratio = [0, 1, 2].map(|k| {
        format!("{:6.0}", 100.0 * his[k].proposal.subdivisions as f64 / theirs[k].proposal.subdivisions.max(1) as f64)
    });
    println!(
        "{:<22.21}{}{}{:>19}{:>9.2}{:>9.2}{:>18}{:>18}",
        name,
        splits(&theirs),
        splits(&his),
        ratio.concat(),
        per(ours.subdivisions + ours.refinements),
        per(ours.pieces),
        wrong(&theirs),
        wrong(&his)
    );
}
