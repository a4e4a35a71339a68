//! Queries by their distance from the entity, and those that are equally far from many of its points.

use perpend_bench::{Case, Failure, geometric_mean, slowest, time_all};

use crate::Run;
use crate::equidistant::Shapes;
use crate::sets::{by_hierarchy, case_of};
use crate::table::{Goal, Table};

/// Distances in shares of the size: a class holds those from the one before it to its own.
const CLASSES: [(&str, f64); 5] = [("on", 1e-9), ("near", 0.02), ("mid", 0.5), ("out", 20.0), ("far", f64::INFINITY)];

pub(crate) fn measure(run: &Run, table: &mut Table) -> Result<(), Failure> {
    table.heading("by distance: on < 1e-9 of the size, near < 0.02, mid < 0.5, out < 20, far beyond; geometric mean");
    for (set, entities) in run.sets.named() {
        let mut from = 0.0;
        for (class, to) in CLASSES {
            let mut cases = Vec::new();
            for entity in entities {
                let size = entity.prepared.definition().size();
                let range = from * size..to * size;
                cases.extend(case_of(entity, by_hierarchy(), |row| range.contains(&row.distance))?);
            }
            from = to;
            time_all(&mut cases, run.passes);
            let count: usize = cases.iter().map(Case::len).sum();
            let goal = if class == "far" { Goal::Time(1.0) } else { Goal::None };
            table.line(format!("{set}, {class}, {count} queries"), goal, "us", geometric_mean(&cases));
        }
    }
    table.heading("centres, axes and spines, by the certified solver");
    for (set, entities) in [("quadrics", &run.sets.quadrics), ("circles-table1", &run.sets.circles)] {
        let shapes = Shapes::read(set)?;
        let mut cases = Vec::new();
        for entity in entities {
            let shape = shapes.of(entity.id)?;
            cases.extend(case_of(entity, by_hierarchy(), |row| shape.is_equidistant(row.point))?);
        }
        time_all(&mut cases, run.passes);
        let count: usize = cases.iter().map(Case::len).sum();
        let what = format!("{set}, {count} queries of {} entities, geometric mean", cases.len());
        table.line(what, Goal::Time(3.0), "us", geometric_mean(&cases));
        let worst = slowest(&cases).ok_or("no such queries")?;
        table.line(format!("{set}, slowest entity: {}", worst.name), Goal::None, "us", worst.micros);
    }
    Ok(())
}
