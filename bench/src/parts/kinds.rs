//! Other queries to whole models: the k nearest, all within a radius, signed distances of bodies.

use std::collections::HashMap;

use glam::DVec3;
use perpend::{EntityId, Model, QueryOptions};
use perpend_bench::{Failure, Faults};
use rayon::prelude::*;

use crate::Run;
use crate::judge::Judge;
use crate::table::{Goal, Table};
use crate::timing::least_seconds_of;
use crate::whole::{MANY, answers};

/// How many nearest faces are asked for.
const K: usize = 3;

/// A radius, as a share of the model's size.
const RADIUS: f64 = 0.02;

pub(crate) fn measure(run: &Run, table: &mut Table) -> Result<(), Failure> {
    table.heading("other queries to whole models, scattered points, one thread");
    for part in run.parts.iter().filter(|part| part.faces >= MANY) {
        let (model, points, name) = (&part.model, &part.points, &part.name);
        let options = QueryOptions::default();
        let radius = RADIUS * model.size();
        let judge = Judge::new(model);
        let judged: Vec<[Faults; 2]> = points.par_iter().map(|p| faults(&judge, model, *p, radius)).collect();
        table.faults(format!("{name}, {K} nearest"), judged.iter().map(|faults| faults[0]).sum());
        table.faults(format!("{name}, within"), judged.iter().map(|faults| faults[1]).sum());
        let listed: usize = model.within_all(points, radius, &options).iter().flatten().map(|list| list.len()).sum();
        let [nearest, within] = least_seconds_of(
            run.passes,
            points.len(),
            [
                &mut |slice| {
                    for p in &points[slice] {
                        let _ = std::hint::black_box(model.nearest_k(*p, K, &options));
                    }
                },
                &mut |slice| {
                    for p in &points[slice] {
                        let _ = std::hint::black_box(model.within(*p, radius, &options));
                    }
                },
            ],
        );
        let micros = 1e6 / points.len() as f64;
        table.line(format!("{name}, {K} nearest"), Goal::None, "us", nearest * micros);
        let faces = listed as f64 / points.len() as f64;
        table.line(format!("{name}, within {RADIUS} of the size: {faces:.1} faces"), Goal::None, "us", within * micros);
        signed(model, name, points, run.passes, table)?;
    }
    Ok(())
}

/// The faults of both lists.
fn faults(judge: &Judge<'_>, model: &Model, p: DVec3, radius: f64) -> [Faults; 2] {
    let options = QueryOptions::default();
    let all = judge.one_by_one(p).expect("a point of a file");
    let distances: HashMap<EntityId, f64> = all.iter().copied().collect();
    let nearest = model.nearest_k(p, K, &options).expect("a point of a file");
    let within = model.within(p, radius, &options).expect("a point of a file");
    let slack = judge.slack(p);
    let each = |list: &[(EntityId, perpend::FootPoint)]| -> Faults {
        list.iter().map(|(id, foot)| judge.faults(p, foot, distances[id])).sum()
    };
    let mut nearest_faults = each(&nearest);
    let is_last = nearest.last().is_some_and(|(_, foot)| foot.distance <= all[K.min(all.len()) - 1].1 + slack);
    if nearest.len() != K.min(all.len()) || !is_last {
        nearest_faults += Judge::wrong();
    }
    let mut within_faults = each(&within);
    let surely = all.iter().filter(|(_, distance)| *distance <= radius - slack);
    let is_missed = surely.into_iter().any(|(id, _)| within.iter().all(|(listed, _)| listed != id));
    if is_missed || within.iter().any(|(_, foot)| foot.lower_bound > radius) {
        within_faults += Judge::wrong();
    }
    [nearest_faults, within_faults]
}

/// Signed distances, each to the body whose face is the nearest.
fn signed(model: &Model, name: &str, points: &[DVec3], passes: usize, table: &mut Table) -> Result<(), Failure> {
    let options = QueryOptions::default();
    let mut bodies: HashMap<EntityId, EntityId> = HashMap::new();
    for body in model.bodies().iter().filter(|body| body.is_closed()) {
        bodies.extend(body.faces().map(|face| (face, body.id())));
    }
    let mut asked = Vec::new();
    let (mut wrong, mut undecided, mut inside) = (0_u64, 0_u64, 0_u64);
    for (p, (face, foot)) in points.iter().zip(answers(model, points)?) {
        let Some(body) = bodies.get(&face) else { continue };
        asked.push((*body, *p));
        match model.signed_distance(*body, *p, &options) {
            Ok(found) => {
                wrong += u64::from(found.signed_distance.abs() != foot.distance);
                inside += u64::from(found.signed_distance < 0.0);
            }
            Err(_) => undecided += 1,
        }
    }
    if asked.is_empty() {
        table.heading(format!("{name} has no closed bodies"));
        return Ok(());
    }
    table.line(format!("{name}, signed distances: not those of the whole model"), Goal::AtMost(0.0), "", wrong as f64);
    table.line(format!("{name}, signed distances: without an answer"), Goal::AtMost(0.0), "", undecided as f64);
    let [signed, plain] = least_seconds_of(
        passes,
        asked.len(),
        [
            &mut |slice| {
                for (body, p) in &asked[slice] {
                    let _ = std::hint::black_box(model.signed_distance(*body, *p, &options));
                }
            },
            &mut |slice| {
                for (body, p) in &asked[slice] {
                    let _ = std::hint::black_box(model.nearest_of(*body, *p, &options));
                }
            },
        ],
    );
    let micros = 1e6 / asked.len() as f64;
    let count = asked.len();
    table.line(format!("{name}, signed distances, {count} points, {inside} inside"), Goal::None, "us", signed * micros);
    table.line("  the same without the sign", Goal::None, "us", plain * micros);
    Ok(())
}
