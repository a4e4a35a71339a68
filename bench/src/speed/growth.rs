//! How the cost grows: with the size of a surface, with threads, with the number of points.

use std::sync::Arc;
use std::time::Instant;

use glam::DVec3;
use perpend::{EntityId, Model};
use perpend_bench::{Case, Failure, scan, spread, time_all, wavy};
use perpend_kernel::Definition;
use perpend_projection::{Prepared, QueryOptions};

use crate::Run;
use crate::sets::by_hierarchy;
use crate::table::{Goal, Table};

pub(crate) fn measure(run: &Run, table: &mut Table) -> Result<(), Failure> {
    spans(run, table)?;
    threads(run, table)?;
    points(run, table)
}

/// The same surface of more and more spans, asked the same.
fn spans(run: &Run, table: &mut Table) -> Result<(), Failure> {
    table.heading("one bicubic wave refined, 1,250 queries: three times the box, near, on");
    let coarse = wavy(8)?;
    let (centre, size) = (coarse.control_box().centre(), coarse.control_box().diagonal());
    let around = (0..1000).map(|k| centre + 3.0 * spread(k) * DVec3::new(1.0, 1.0, 0.5));
    let beside = (0..250).map(|k| {
        let at = spread(k) + 0.5;
        let off = if k % 5 == 0 { 0.0 } else { 0.02 * size * spread(k).z };
        coarse.point(at.x, at.y) + off * DVec3::Z
    });
    let asked: Vec<DVec3> = around.chain(beside).collect();
    let mut cases = Vec::new();
    for spans in [8, 16, 32, 64, 128] {
        let prepared = Arc::new(Prepared::new(Arc::new(Definition::from(wavy(spans)?)), None));
        let name = format!("{spans} x {spans} spans");
        cases.push(Case::new(name, &prepared, asked.iter().copied(), by_hierarchy())?);
    }
    time_all(&mut cases, run.passes);
    for case in &cases {
        table.line(&case.name, Goal::None, "us", case.micros);
    }
    if let [first, .., last] = cases.as_slice() {
        let what = format!("{} against {}", last.name, first.name);
        table.line(what, Goal::AtMost(2.0), "x", last.micros / first.micros);
    }
    Ok(())
}

/// What a second thread brings.
fn threads(run: &Run, table: &mut Table) -> Result<(), Failure> {
    table.heading("threads, 62,500 scan points of a wave of 40 x 40 spans through project_all");
    let (model, id, points) = scanned(250)?;
    let pools = [1, 2].map(|count| rayon::ThreadPoolBuilder::new().num_threads(count).build());
    let [one, two] = pools;
    let (one, two) = (one?, two?);
    let mut seconds = [f64::INFINITY; 2];
    // short batches, often: some of them then meet two idle cores
    for _ in 0..5 * run.passes {
        for (pool, best) in [&one, &two].into_iter().zip(&mut seconds) {
            *best = best.min(pool.install(|| time(&model, id, &points)));
        }
    }
    table.line("1 thread", Goal::None, "s", seconds[0]);
    table.line("2 threads, throughput of 1", Goal::AtLeast(1.9), "x", seconds[0] / seconds[1]);
    Ok(())
}

/// The cost of a point in batches of more and more.
fn points(run: &Run, table: &mut Table) -> Result<(), Failure> {
    table.heading("scan points of a wave of 40 x 40 spans through project_all, all cores: cost per point");
    let sides = [32, 100, 316, 1000, 3162];
    let sides = if run.long { &sides[..] } else { &sides[..4] };
    for side in sides {
        let (model, id, points) = scanned(*side)?;
        // a small batch is too short for the clock of a busy machine
        let passes = run.passes * (100_000 / points.len()).clamp(1, 20);
        let fastest = (0..passes).map(|_| time(&model, id, &points)).fold(f64::INFINITY, f64::min);
        table.line(format!("{} points", points.len()), Goal::None, "us", fastest * 1e6 / points.len() as f64);
    }
    let answer = size_of_val(&Model::new().project_all(EntityId::new(1), &[DVec3::ZERO], &QueryOptions::default())[0]);
    table.line("memory of a point's answer, bytes", Goal::None, "", answer as f64);
    Ok(())
}

/// A wave of 40 by 40 spans, made ready, with a scan of it.
fn scanned(side: u32) -> Result<(Model, EntityId, Vec<DVec3>), Failure> {
    let surface = wavy(40)?;
    let points = scan(&surface, side);
    let mut model = Model::new();
    let id = model.insert("wave", surface)?;
    time(&model, id, &points[..points.len().min(2000)]);
    Ok((model, id, points))
}

/// The seconds of a batch, its answers dropped with it.
fn time(model: &Model, id: EntityId, points: &[DVec3]) -> f64 {
    let start = Instant::now();
    let answers = model.project_all(id, points, &QueryOptions::default());
    let seconds = start.elapsed().as_secs_f64();
    std::hint::black_box(answers);
    seconds
}
