//! Points as a scanner takes them: near a surface, each beside the one before it.

use std::time::Instant;

use glam::DVec3;
use perpend::Model;
use perpend_bench::{Case, Failure, Judge, geometric_mean, scan, slowest, time_all};
use perpend_kernel::{Definition, NurbsSurface};
use perpend_projection::{FootPoint, QueryOptions};

use crate::Run;
use crate::sets::by_hierarchy;
use crate::table::{Goal, Table};

/// Points of a side of the raster: on each surface, and on the one that is scanned finely.
const SIDES: (u32, u32) = (120, 1000);

pub(crate) fn measure(run: &Run, table: &mut Table) -> Result<(), Failure> {
    let (coarse, fine) = SIDES;
    table.heading(format!(
        "scans: {} points within 1 % of the size, row after row, the foot before as the hint",
        coarse * coarse
    ));
    let (mut cases, mut open) = (Vec::new(), 0_usize);
    for entity in &run.sets.surfaces {
        let points = scan(surface(entity.prepared.definition())?, coarse);
        let judge = Judge::new(entity.prepared.definition());
        let mut case =
            Case::new(entity.name.clone(), &entity.prepared, points.iter().copied(), by_hierarchy())?.hinted();
        open += points.iter().zip(case.answers()).filter(|(p, foot)| judge.is_open(**p, foot)).count();
        cases.push(case);
    }
    time_all(&mut cases, run.passes);
    table.line("scan of seeds-surfaces, geometric mean", Goal::Time(0.8), "us", geometric_mean(&cases));
    table.line("scan of seeds-surfaces, uncertified", Goal::AtMost(0.0), "", open as f64);
    for case in &cases {
        table.line(format!("  {}", case.name), Goal::None, "us", case.micros);
    }
    let worst = slowest(&cases).ok_or("an empty set")?;
    table.line(format!("scan, slowest entity: {}", worst.name), Goal::None, "us", worst.micros);

    let cores = std::thread::available_parallelism()?;
    table.heading(format!("a million points of one scan through project_all, {cores} cores"));
    for name in ["wavy-40x40", "dust-pan"] {
        let entity = run.sets.surfaces.iter().find(|entity| entity.name == name).ok_or("an entity is absent")?;
        let definition = entity.prepared.definition();
        let points = scan(surface(definition)?, fine);
        let mut model = Model::new();
        let id = model.insert(name, (**definition).clone())?;
        let judge = Judge::new(definition);
        let (mut seconds, mut open) = (f64::INFINITY, 0);
        for _ in 0..run.passes.div_ceil(2) {
            let start = Instant::now();
            let answers = model.project_all(id, &points, &QueryOptions::default());
            seconds = seconds.min(start.elapsed().as_secs_f64());
            open = points.iter().zip(&answers).filter(|(p, answer)| !is_certified(judge, **p, answer)).count();
        }
        table.line(format!("{} scan points of {name}", points.len()), Goal::Time(0.5), "s", seconds);
        table.line(format!("{name}, uncertified"), Goal::AtMost(0.0), "", open as f64);
    }
    Ok(())
}

/// The surface that a definition is.
pub(crate) fn surface(definition: &Definition) -> Result<&NurbsSurface, Failure> {
    match definition {
        Definition::NurbsSurface(surface) => Ok(surface),
        Definition::NurbsCurve(_) => Err("a curve where a surface is wanted".into()),
    }
}

fn is_certified<E>(judge: Judge, p: DVec3, answer: &Result<Option<FootPoint>, E>) -> bool {
    matches!(answer, Ok(Some(foot)) if !judge.is_open(p, foot))
}
