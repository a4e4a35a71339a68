//! Gaps near the limit of f64.

use perpend_bench::{Failure, Judge, PreparedEntity, geometric_mean, time_all};
use perpend_projection::QueryOptions;

use crate::Run;
use crate::sets::{by_hierarchy, judged_cases};
use crate::table::{Goal, Table};

pub(crate) fn measure(run: &Run, table: &mut Table) -> Result<(), Failure> {
    table.heading("smaller gaps, by the certified solver, geometric mean");
    for (share, goal) in [(1e-11, 2.0), (1e-12, 5.0)] {
        for (set, entities) in run.sets.named() {
            let gap = |entity: &PreparedEntity| share * entity.prepared.definition().size();
            let options = |entity: &PreparedEntity| QueryOptions { gap: Some(gap(entity)), ..by_hierarchy() };
            let judge = |entity: &PreparedEntity| Judge::new(entity.prepared.definition()).with_gap(gap(entity));
            let (mut cases, faults) = judged_cases(entities, options, judge)?;
            time_all(&mut cases, run.passes.div_ceil(2));
            // the goal names surfaces; the others are for information
            let goal = if set == "seeds-surfaces" { Goal::Time(goal) } else { Goal::None };
            table.line(format!("gap {share:.0e} of the size, {set}"), goal, "us", geometric_mean(&cases));
            if share < 1e-11 {
                // past what f64 tells at a distance, a wider gap that is said at once is an answer, too
                let open = format!("gap {share:.0e}, {set}: uncertified, and said so");
                table.line(open, Goal::None, "", faults.open as f64);
                let untrue = format!("gap {share:.0e}, {set}: wrong or false");
                table.line(untrue, Goal::AtMost(0.0), "", (faults.wrong + faults.false_bounds) as f64);
            } else {
                table.faults(format!("gap {share:.0e}, {set}"), faults);
            }
        }
    }
    Ok(())
}
