//! What comes before the queries: preparation, its memory, and a query to an entity that nobody asked before.

use std::sync::Arc;
use std::time::Instant;

use glam::DVec3;
use perpend_bench::{Corpus, Failure, PreparedEntity, spread, wavy};
use perpend_kernel::{Definition, Direction, NurbsSurface};
use perpend_projection::{Prepared, Query, QueryOptions, Scratch};

use crate::Run;
use crate::real;
use crate::scan::surface;
use crate::table::{Goal, Table};

/// Control points of a big surface.
const BIG: usize = 500;

/// How many fresh entities each figure is the median of; each is asked something else.
const FRESH: usize = 25;

pub(crate) fn measure(run: &Run, table: &mut Table) -> Result<(), Failure> {
    first_queries(run, table)?;
    preparation(run, table)?;
    memory(table)
}

/// A single query to a fresh entity, its preparation included.
fn first_queries(run: &Run, table: &mut Table) -> Result<(), Failure> {
    table.heading(format!("one query to a fresh entity, preparation included, median of {FRESH}"));
    let mut sum = 0.0;
    for PreparedEntity { name, prepared, rows, .. } in &run.sets.surfaces {
        let definition = prepared.definition();
        let points: Vec<DVec3> = (0..FRESH).map(|k| rows[k * 397 % rows.len()].point).collect();
        let micros = first_query(definition, &points)?;
        sum += micros;
        if definition.control_points().len() >= BIG {
            table.line(format!("{name}, {} control points", definition.control_points().len()), GOAL, "us", micros);
        }
    }
    let mean = sum / run.sets.surfaces.len() as f64;
    table.line("seeds-surfaces, mean of the entities", Goal::None, "us", mean);
    for folder in real::folders() {
        let model = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let mut largest: Option<(String, Definition)> = None;
        for entity in Corpus::read(&folder.join("corpus.json"))?.entities {
            let definition = entity.definition()?;
            let most = largest.as_ref().map_or(BIG, |(_, held)| held.control_points().len());
            if definition.control_points().len() > most && surface(&definition).is_ok() {
                largest = Some((entity.name, definition));
            }
        }
        if let Some((name, definition)) = largest {
            let (centre, size) = (definition.control_box().centre(), definition.size());
            let points: Vec<DVec3> = (0..FRESH as u32).map(|k| centre + size * spread(k)).collect();
            let count = definition.control_points().len();
            let micros = first_query(&Arc::new(definition), &points)?;
            table.line(format!("{model} {name}, {count} control points"), GOAL, "us", micros);
        }
    }
    Ok(())
}

/// The quickest that another kernel is on a big surface.
const GOAL: Goal = Goal::Time(950.0);

/// The median time of the first query, of one fresh entity for each point.
fn first_query(definition: &Arc<Definition>, points: &[DVec3]) -> Result<f64, Failure> {
    let mut times = Vec::new();
    for p in points {
        let query = Query::new(*p, QueryOptions::default())?;
        let start = Instant::now();
        let prepared = Prepared::new(Arc::clone(definition), None);
        std::hint::black_box(prepared.project(&query, &mut Scratch::default()));
        times.push(start.elapsed().as_secs_f64() * 1e6);
    }
    times.sort_by(f64::total_cmp);
    Ok(times[times.len() / 2])
}

/// Preparation with all that queries add to it: the time of a query above every leaf, less that of the same queries again.
fn preparation(run: &Run, table: &mut Table) -> Result<(), Failure> {
    table.heading("preparation and a query above every leaf");
    let named = run.sets.surfaces.iter().find(|entity| entity.name == "wavy-40x40").ok_or("wavy-40x40 is absent")?;
    let wave = Arc::new(Definition::from(wavy(40)?));
    for (what, definition) in
        [("a wave of 40 x 40 spans", &wave), ("wavy-40x40, 37 x 37 spans", named.prepared.definition())]
    {
        let queries = above_every_leaf(surface(definition)?)?;
        let [mut new, mut cold, mut warm] = [f64::INFINITY; 3];
        for _ in 0..run.passes {
            let start = Instant::now();
            let prepared = Prepared::new(Arc::clone(definition), None);
            new = new.min(start.elapsed().as_secs_f64());
            let mut scratch = Scratch::default();
            ask(&prepared, &queries, &mut scratch);
            cold = cold.min(start.elapsed().as_secs_f64());
            let start = Instant::now();
            ask(&prepared, &queries, &mut scratch);
            warm = warm.min(start.elapsed().as_secs_f64());
        }
        table.line(what, Goal::Time(3.0), "ms", (cold - warm) * 1e3);
        table.line("  of that before the first query: recognition and the plan", Goal::None, "ms", new * 1e3);
    }
    Ok(())
}

/// What a prepared surface holds, after a query above every leaf.
fn memory(table: &mut Table) -> Result<(), Failure> {
    table.heading("memory held, after a query above every leaf");
    for spans in [40, 128] {
        let definition = Arc::new(Definition::from(wavy(spans)?));
        let queries = above_every_leaf(surface(&definition)?)?;
        let mut held = None;
        let memory = allocation_counter::measure(|| {
            let prepared = Prepared::new(Arc::clone(&definition), None);
            ask(&prepared, &queries, &mut Scratch::default());
            held = Some(prepared);
        });
        drop(held);
        // the wave is so flat over a span that each is one leaf
        let leaves = (spans * spans) as f64;
        let what = format!("bicubic wave of {spans} x {spans} spans, bytes a leaf");
        table.line(what, Goal::AtMost(2560.0), "", memory.bytes_current as f64 / leaves);
    }
    Ok(())
}

/// Four queries above each span, a thousandth of the size off: where a leaf is half a span, it is asked, too.
fn above_every_leaf(surface: &NurbsSurface) -> Result<Vec<Query>, Failure> {
    let size = surface.control_box().diagonal();
    let quarters = |direction: Direction| {
        let spans = surface.knots(direction).spans();
        spans
            .flat_map(|span| [0.25, 0.75].map(|share| span.start + share * (span.end - span.start)))
            .collect::<Vec<_>>()
    };
    let (across, along) = (quarters(Direction::U), quarters(Direction::V));
    let mut queries = Vec::new();
    for u in &across {
        for v in &along {
            let off = 1e-3 * size * surface.normal(*u, *v).normalize_or_zero();
            queries.push(Query::new(surface.point(*u, *v) + off, QueryOptions::default())?);
        }
    }
    Ok(queries)
}

fn ask(prepared: &Prepared, queries: &[Query], scratch: &mut Scratch) {
    for query in queries {
        std::hint::black_box(prepared.project(query, scratch));
    }
}
