//! The four test sets, each entity made ready once for all parts.

use perpend_bench::{Case, Failure, Faults, Judge, PreparedEntity, Row, corpora, prepared_set};
use perpend_projection::{Method, QueryOptions};

/// The test sets.
pub(crate) struct Sets {
    pub curves: Vec<PreparedEntity>,
    pub surfaces: Vec<PreparedEntity>,
    pub quadrics: Vec<PreparedEntity>,
    pub circles: Vec<PreparedEntity>,
}

impl Sets {
    pub(crate) fn read() -> Result<Self, Failure> {
        let set = |name: &str| {
            let file = |ending: &str| corpora().join(format!("{name}{ending}"));
            prepared_set(&file(".json"), &file(".truth.csv"))
        };
        Ok(Self {
            curves: set("seeds-curves")?,
            surfaces: set("seeds-surfaces")?,
            quadrics: set("quadrics")?,
            circles: set("circles-table1")?,
        })
    }

    /// Their names, each with its entities.
    pub(crate) fn named(&self) -> [(&'static str, &[PreparedEntity]); 4] {
        [
            ("seeds-curves", &self.curves),
            ("seeds-surfaces", &self.surfaces),
            ("quadrics", &self.quadrics),
            ("circles-table1", &self.circles),
        ]
    }
}

/// Queries that the certified solver answers, whatever is known of the entity.
pub(crate) fn by_hierarchy() -> QueryOptions {
    QueryOptions { method: Some(Method::Hierarchy), ..QueryOptions::default() }
}

/// The rows of an entity that satisfy `wanted`, as a case; none where there are no such rows.
pub(crate) fn case_of(
    entity: &PreparedEntity,
    options: QueryOptions,
    wanted: impl Fn(&Row) -> bool,
) -> Result<Option<Case>, Failure> {
    let points = entity.rows.iter().filter(|row| wanted(row)).map(|row| row.point);
    let case = Case::new(entity.name.clone(), &entity.prepared, points, options)?;
    Ok((!case.is_empty()).then_some(case))
}

/// The faults of the answers to all rows of an entity.
pub(crate) fn faults_of(case: &mut Case, entity: &PreparedEntity, judge: Judge) -> Faults {
    entity.rows.iter().zip(case.answers()).map(|(row, foot)| judge.faults(row, &foot)).sum()
}

/// The cases of all entities, all rows of each, and the faults of their answers.
pub(crate) fn judged_cases(
    entities: &[PreparedEntity],
    options: impl Fn(&PreparedEntity) -> QueryOptions,
    judge: impl Fn(&PreparedEntity) -> Judge,
) -> Result<(Vec<Case>, Faults), Failure> {
    let (mut cases, mut faults) = (Vec::new(), Faults::default());
    for entity in entities {
        if let Some(mut case) = case_of(entity, options(entity), |_| true)? {
            faults += faults_of(&mut case, entity, judge(entity));
            cases.push(case);
        }
    }
    Ok((cases, faults))
}
