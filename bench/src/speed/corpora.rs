//! The query mix of the test sets: by the certified solver, and where a class is recognised also by its closed form.

use std::collections::BTreeMap;

use perpend_bench::{Case, Failure, Faults, Judge, PreparedEntity, geometric_mean, slowest, time_all};
use perpend_projection::QueryOptions;

use crate::Run;
use crate::equidistant::Shapes;
use crate::sets::{by_hierarchy, case_of, faults_of, judged_cases};
use crate::table::{Goal, Table};

pub(crate) fn measure(run: &Run, table: &mut Table) -> Result<(), Failure> {
    table.heading("test sets, as NURBS by the certified solver");
    let goals = [0.25, 0.8, 0.5, 0.25];
    for ((name, entities), goal) in run.sets.named().into_iter().zip(goals) {
        let judge = |entity: &PreparedEntity| Judge::new(entity.prepared.definition());
        let (mut cases, faults) = judged_cases(entities, |_| by_hierarchy(), judge)?;
        time_all(&mut cases, run.passes);
        table.line(format!("{name}, geometric mean"), Goal::Time(goal), "us", geometric_mean(&cases));
        let worst = slowest(&cases).ok_or("an empty set")?;
        table.line(format!("{name}, slowest entity: {}", worst.name), Goal::Time(2.0), "us", worst.micros);
        table.faults(name, faults);
    }
    table.heading("recognised: by the plan's own method");
    for (name, entities) in [("quadrics", &run.sets.quadrics), ("circles-table1", &run.sets.circles)] {
        let shapes = Shapes::read(name)?;
        let (mut kinds, mut faults) = (BTreeMap::<&str, Vec<Case>>::new(), Faults::default());
        for entity in entities {
            let mut case = case_of(entity, QueryOptions::default(), |_| true)?.ok_or("an entity without rows")?;
            faults += faults_of(&mut case, entity, Judge::new(entity.prepared.definition()));
            kinds.entry(&shapes.of(entity.id)?.kind).or_default().push(case);
        }
        for _ in 0..run.passes {
            kinds.values_mut().for_each(|cases| time_all(cases, 1));
        }
        for (kind, cases) in &kinds {
            let what = format!("{kind}, geometric mean of {}", cases.len());
            table.line(what, Goal::Time(0.12), "us", geometric_mean(cases));
        }
        table.faults(name, faults);
    }
    Ok(())
}
