//! §7, Tables 2 to 4: Newton iterations over the tolerances of the decomposition and of the sampling.

use std::sync::Arc;

use glam::DVec3;
use perpend_kernel::{Definition, Direction};
use perpend_projection::{NewtonTolerances, Prepared, Query, QueryOptions, Scratch, Steps, Wave, WaveSettings};

use super::points::{Points, Where};
use super::{ENTITIES, definition};
use crate::Failure;

const TOLERANCES: [f64; 3] = [0.1, 0.05, 0.01];

/// Random points a table.
const QUERIES: usize = 100;

/// What the paper prints, in the order of the rows: Table 2, 3 and 4.
const PRINTED: [[&str; 9]; 3] = [
    ["1><2", "1><2", "1", "1><2", "~1", "<1", "<1", "<1", "<1"],
    ["1><2", "1><2", "1", "1><2", "~1", "1", "1", "<1", "<1"],
    ["1><2", "1><2", "1", "1><2", "~1", "<1", "<1", "<1", "<1"],
];

pub(super) fn print() -> Result<(), Failure> {
    for ((set, name, means), printed) in ENTITIES.into_iter().zip(PRINTED) {
        let definition = definition(set, name)?;
        let prepared = Prepared::new(Arc::clone(&definition), None);
        let mut random = Points::new(&definition, Where::Around);
        let points: Vec<DVec3> = (0..QUERIES).map(|_| random.next()).collect();
        let mut scratch = Scratch::default();
        let truth: Vec<f64> = points
            .iter()
            .map(|p| prepared.project(&query(*p), &mut scratch).expect("no distance limit").distance)
            .collect();
        println!(
            "\nNewton iterations, {means}: {QUERIES} random points, jitter 80 %, coincidence 1e-6, perpendicularity 1e-4"
        );
        println!(
            "{:<10}{:<10}{:>8}{:>8}{:>8}{:>8}{:>10}{:>10}{:>10}{:>12}{:>12}{:>12}",
            "decompose",
            "sample",
            "paper",
            "mean",
            "most",
            "edges",
            "segments",
            "cells",
            "visited",
            "beyond gap",
            "other foot",
            "worst"
        );
        let tolerances = TOLERANCES.iter().flat_map(|d| TOLERANCES.map(|s| (*d, s)));
        for ((decomposition, sampling), printed) in tolerances.zip(printed) {
            let settings = WaveSettings { decomposition: [Steps::of(decomposition); 2], sampling: Steps::of(sampling) };
            let wave = Wave::new(Arc::clone(&definition), settings);
            line(&definition, &wave, (decomposition, sampling), printed, &points, &truth);
        }
    }
    Ok(())
}

fn line(
    definition: &Definition,
    wave: &Wave,
    (decomposition, sampling): (f64, f64),
    printed: &str,
    points: &[DVec3],
    truth: &[f64],
) {
    let size = definition.size();
    let (mut sum, mut most, mut edges, mut cells, mut beyond, mut other, mut worst) = (0, 0, 0, 0, 0, 0, 0.0_f64);
    for (p, truth) in points.iter().zip(truth) {
        let trace = wave.trace(&query(*p));
        let excess = (trace.distance - truth) / size;
        sum += trace.work.newton;
        most = most.max(trace.work.newton);
        edges += u32::from(is_on_edge(definition, trace.foot));
        cells += trace.cells.len();
        beyond += u32::from(excess > 1e-9);
        other += u32::from(excess > 1e-6);
        worst = worst.max(excess);
    }
    let mean = |count: f64| count / points.len() as f64;
    println!(
        "{:<10}{:<10}{:>8}{:>8.2}{:>8}{:>8}{:>10}{:>10}{:>10.0}{:>12}{:>12}{:>12.1e}",
        format!("{:.0} %", 100.0 * decomposition),
        format!("{:.0} %", 100.0 * sampling),
        printed,
        mean(sum as f64),
        most,
        edges,
        wave.segment_boxes().len(),
        wave.cell_counts().iter().product::<usize>(),
        mean(cells as f64),
        beyond,
        other,
        worst
    );
}

fn query(p: DVec3) -> Query {
    let newton = NewtonTolerances { coincidence: Some(1e-6), perpendicularity: 1e-4 };
    Query::new(p, QueryOptions { newton, ..QueryOptions::default() }).expect("finite")
}

/// Whether a foot lies on an end or edge of the domain.
fn is_on_edge(definition: &Definition, (u, v): (f64, f64)) -> bool {
    let at_end = |x: f64, (first, last): (f64, f64)| x == first || x == last;
    match definition {
        Definition::NurbsCurve(curve) => at_end(u, curve.domain()),
        Definition::NurbsSurface(surface) => {
            at_end(u, surface.domain(Direction::U)) || at_end(v, surface.domain(Direction::V))
        }
    }
}
