//! Queries to a whole model against queries to the nearest face alone.

use std::sync::Arc;

use glam::DVec3;
use perpend::{EntityId, FootPoint, Model, Prepared, Query, QueryOptions, Scratch};
use perpend_bench::{Failure, Faults};
use rayon::prelude::*;

use crate::Run;
use crate::judge::Judge;
use crate::table::{Goal, Table};
use crate::timing::least_seconds_of;

/// Models with fewer faces are one face more or less.
pub(crate) const MANY: usize = 50;

pub(crate) fn measure(run: &Run, table: &mut Table) -> Result<(), Failure> {
    table.heading(
        "whole models, scattered points, one thread: a query to the model against one to its nearest face alone",
    );
    for part in run.parts.iter().filter(|part| part.faces >= MANY) {
        let Times { whole, alone } = times(&part.model, &part.points, run.passes, &mut |what, faults| {
            table.faults(format!("{}, {what}", part.name), faults);
        })?;
        table.line(format!("{}, {} faces, whole", part.name, part.faces), Goal::None, "us", whole);
        table.line("  the nearest face alone", Goal::None, "us", alone);
        table.line("  ratio", Goal::AtMost(5.0), "x", whole / alone);
    }
    Ok(())
}

/// How many queries to single faces judge the answers of a model at most: of a large one, not all points are judged.
const JUDGED: usize = 200_000;

/// Microseconds a query.
pub(crate) struct Times {
    pub whole: f64,
    pub alone: f64,
}

/// What queries at points take, judged before.
pub(crate) fn times(
    model: &Model,
    points: &[DVec3],
    passes: usize,
    tell: &mut dyn FnMut(&str, Faults),
) -> Result<Times, Failure> {
    let options = QueryOptions::default();
    let found = answers(model, points)?;
    let judge = Judge::new(model);
    let step = (points.len() * judge.len()).div_ceil(JUDGED).max(1);
    let judged: Vec<Faults> = points
        .par_iter()
        .zip(&found)
        .step_by(step)
        .map(|(p, (_, foot))| {
            let nearest = judge.one_by_one(*p).expect("the point was asked before")[0].1;
            judge.faults(*p, foot, nearest)
        })
        .collect();
    tell(&format!("{} points judged", judged.len()), judged.into_iter().sum());
    let alone: Vec<(&Arc<Prepared>, Query)> = points
        .iter()
        .zip(&found)
        .map(|(p, (id, _))| Ok((model.entity(*id).ok_or("an id of the model")?.prepared(), Query::new(*p, options)?)))
        .collect::<Result<_, Failure>>()?;
    let mut scratch = Scratch::default();
    let [whole, alone] = least_seconds_of(
        passes,
        points.len(),
        [
            &mut |slice| {
                for p in &points[slice] {
                    let _ = std::hint::black_box(model.nearest(*p, &options));
                }
            },
            &mut |slice| {
                for (prepared, query) in &alone[slice] {
                    std::hint::black_box(prepared.project(query, &mut scratch));
                }
            },
        ],
    );
    let micros = 1e6 / points.len() as f64;
    Ok(Times { whole: whole * micros, alone: alone * micros })
}

/// The answers of a model.
pub(crate) fn answers(model: &Model, points: &[DVec3]) -> Result<Vec<(EntityId, FootPoint)>, Failure> {
    let answers = model.nearest_all(points, &QueryOptions::default());
    answers.into_iter().map(|answer| Ok(answer?.ok_or("a model with faces has a nearest one")?)).collect()
}
