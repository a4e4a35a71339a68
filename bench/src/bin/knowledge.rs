//! What knowing an entity's class saves: time per query of its closed form and of the certified hierarchy, in one run on one thread.
//!
//! `knowledge [FOLDER]`: the folder of the corpora `quadrics` and `circles-table1`, `tests/data` if left out.

#![allow(clippy::print_stdout, reason = "a benchmark prints its table")]

use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use glam::DVec3;
use perpend_bench::{Corpus, rows};
use perpend_projection::{Method, Prepared, Query, QueryOptions, Scratch};

/// Passes over the queries, of which the fastest counts: other programs only ever add time.
const PASSES: usize = 15;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| "tests/data".to_owned());
    println!(
        "{:<16}{:<24}{:>7}{:>12}{:>12}{:>12}{:>8}{:>12}{:>12}",
        "corpus", "entity", "rows", "hierarchy us", "analytic us", "evaluate us", "ratio", "declined", "worst / ulp"
    );
    let (mut logarithms, mut entities) = (0.0, 0.0);
    for name in ["circles-table1", "quadrics"] {
        let path = Path::new(&folder).join(name);
        let file = std::fs::File::open(path.with_extension("json"))?;
        let corpus: Corpus = serde_json::from_reader(std::io::BufReader::new(file))?;
        let rows = rows(&path.with_extension("truth.csv"))?;
        for entity in &corpus.entities {
            let points: Vec<DVec3> = rows.iter().filter(|row| row.entity == entity.id).map(|row| row.point).collect();
            let definition = Arc::new(entity.definition()?);
            let prepared = Prepared::new(Arc::clone(&definition), None);
            let mut scratch = Scratch::default();
            let queries = |method| -> Result<Vec<Query>, Box<dyn std::error::Error>> {
                let options = QueryOptions { method: Some(method), ..QueryOptions::default() };
                Ok(points.iter().map(|p| Query::new(*p, options)).collect::<Result<_, _>>()?)
            };
            let (slow, fast) = (queries(Method::Hierarchy)?, queries(Method::Analytic)?);
            let (mut declined, mut worst) = (0, 0.0_f64);
            for ((slow, fast), p) in slow.iter().zip(&fast).zip(&points) {
                let proven = prepared.project(slow, &mut scratch).ok_or("no distance limit")?;
                let closed = prepared.project(fast, &mut scratch).ok_or("no distance limit")?;
                declined += u32::from(closed.method != Method::Analytic);
                let ulp = f64::EPSILON * (definition.reach() + p.abs().max_element());
                worst = worst.max((closed.distance - proven.distance).abs() / ulp);
            }
            let mut times = [f64::INFINITY; 3];
            for _ in 0..PASSES {
                for (time, queries) in times.iter_mut().zip([&slow, &fast]) {
                    let start = Instant::now();
                    for query in queries {
                        std::hint::black_box(prepared.project(query, &mut scratch));
                    }
                    *time = time.min(start.elapsed().as_secs_f64() * 1e6 / queries.len() as f64);
                }
                let start = Instant::now();
                for _ in 0..points.len() {
                    match std::hint::black_box(&*definition) {
                        perpend_kernel::Definition::NurbsCurve(curve) => {
                            std::hint::black_box(curve.point(std::hint::black_box(0.37)));
                        }
                        perpend_kernel::Definition::NurbsSurface(surface) => {
                            let mut d = [DVec3::ZERO; 4];
                            surface.derivatives(std::hint::black_box(0.37), std::hint::black_box(0.61), 1, &mut d);
                            std::hint::black_box(d);
                        }
                    }
                }
                times[2] = times[2].min(start.elapsed().as_secs_f64() * 1e6 / points.len() as f64);
            }
            let [hierarchy, analytic, evaluation] = times;
            let ratio = hierarchy / analytic;
            logarithms += ratio.ln();
            entities += 1.0;
            println!(
                "{name:<16}{:<24}{:>7}{hierarchy:>12.3}{analytic:>12.3}{evaluation:>12.3}{ratio:>8.1}{declined:>12}{worst:>12.1}",
                entity.name,
                points.len()
            );
        }
    }
    println!("geometric mean of the ratios: {:.1}", f64::exp(logarithms / entities));
    Ok(())
}
