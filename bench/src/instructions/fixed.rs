//! The queries that are counted: rows of the test sets, fixed.

use std::hint::black_box;
use std::sync::Arc;

use glam::DVec3;
use perpend_bench::{Failure, PreparedEntity, corpora, prepared_set};
use perpend_projection::{Method, Prepared, Query, QueryOptions, Scratch};

/// A query by a method.
pub(crate) struct Fixed {
    /// The method, or what else is counted.
    pub method: &'static str,
    /// What is asked.
    pub name: String,
    task: Task,
    prepared: Arc<Prepared>,
    query: Query,
}

#[derive(Clone, Copy)]
enum Task {
    Query,
    /// A query with this point of the entity as its hint.
    Hinted(DVec3),
    Preparation,
}

/// What is asked of each set: what it is, the entity, and the row. The rows of an entity are a grid of 1000, 200 near, 50 on, 50 far, 30
/// beyond ends and edges, then ties, centres of curvature, and of known shapes points of the centre, the axis and the spine, last.
type Asked = [(&'static str, &'static str, usize)];

const CURVES: &Asked = &[
    ("curve grid", "selimovic-4-spatial", 555),
    ("curve near", "degree7-60", 1010),
    ("curve on", "nonuniform", 1205),
    ("curve far", "rational-spatial", 1255),
    ("curve beyond its end", "near-touch", 1305),
    ("curve tie", "loop", 1335),
];

const SURFACES: &Asked = &[
    ("surface grid", "blend", 432),
    ("surface near", "wavy-40x40", 1020),
    ("surface near rational", "rational-2x5", 1030),
    ("surface on", "dust-pan", 1210),
    ("surface far", "brush-handle", 1260),
    ("surface beyond its edge", "nonuniform", 1310),
    ("surface with a pole", "pole", 555),
];

const QUADRICS: &Asked = &[
    ("plane grid", "plane", 555),
    ("cylinder grid", "cylinder-full", 333),
    ("cone near", "cone-partial", 1100),
    ("sphere far", "sphere-full", 1270),
    ("torus near", "torus-full", 1040),
    ("torus spine", "torus-full", LAST),
];

const CIRCLES: &Asked = &[("circle grid", "degree5-360", 444), ("circle centre", "degree2-90", LAST)];

/// The last row of an entity.
const LAST: usize = usize::MAX;

const METHODS: [(&str, Method); 6] = [
    ("analytic", Method::Analytic),
    ("hierarchy", Method::Hierarchy),
    ("wave", Method::Wave),
    ("exclusion", Method::Exclusion),
    ("control polygon", Method::ControlPolygon),
    ("bernstein", Method::Bernstein),
];

const HINTED: &str = "hinted";
const PREPARATION: &str = "preparation";

/// The names of the methods.
pub(crate) fn methods() -> String {
    let names = METHODS.iter().map(|(name, _)| *name).chain([HINTED, PREPARATION]);
    names.collect::<Vec<_>>().join(", ")
}

impl Fixed {
    /// All of them, in the order in which they are asked.
    pub(crate) fn all() -> Result<Vec<Self>, Failure> {
        let read = |set: &str| {
            let file = |ending: &str| corpora().join(format!("{set}{ending}"));
            prepared_set(&file(".json"), &file(".truth.csv"))
        };
        let mut asked = Vec::new();
        for (set, queries) in [
            ("seeds-curves", CURVES),
            ("seeds-surfaces", SURFACES),
            ("quadrics", QUADRICS),
            ("circles-table1", CIRCLES),
        ] {
            let entities = read(set)?;
            for (name, entity, row) in queries {
                let entity =
                    entities.iter().find(|e| e.name == *entity).ok_or_else(|| format!("{set}: no {entity}"))?;
                asked.push((*name, Arc::clone(&entity.prepared), point(entity, *row)?));
            }
        }
        let mut all = Vec::new();
        let mut add = |method, name: &str, task, prepared: &Arc<Prepared>, p, options| -> Result<(), Failure> {
            let query = Query::new(p, options)?;
            all.push(Self { method, name: name.to_owned(), task, prepared: Arc::clone(prepared), query });
            Ok(())
        };
        for (label, method) in METHODS {
            let options = QueryOptions { method: Some(method), ..QueryOptions::default() };
            for (name, prepared, p) in &asked {
                // where no closed form is, the hierarchy answers, and is counted by its own name
                if method != Method::Analytic || prepared.plan().method == Method::Analytic {
                    add(label, name, Task::Query, prepared, *p, options)?;
                }
            }
        }
        let options = QueryOptions::default();
        for (name, prepared, p) in asked.iter().filter(|(name, ..)| name.starts_with("surface near")) {
            let beside = *p + 1e-3 * prepared.definition().size() * DVec3::X;
            let before = prepared.project(&Query::new(beside, options)?, &mut Scratch::default());
            let hint = before.ok_or("no distance limit")?.point;
            add(HINTED, name, Task::Hinted(hint), prepared, *p, options)?;
        }
        for (name, prepared, p) in &asked {
            add(PREPARATION, name, Task::Preparation, prepared, *p, options)?;
        }
        Ok(all)
    }

    /// Asks it: once alone, so that tables and working memory are there, and once more by `measure`, which is given the call and makes it.
    pub(crate) fn ask(&self, mut measure: impl FnMut(&mut dyn FnMut())) {
        let Self { prepared, query, .. } = self;
        let hint = match self.task {
            Task::Query => None,
            Task::Hinted(hint) => Some(hint),
            Task::Preparation => {
                measure(&mut || {
                    let prepared = Prepared::new(Arc::clone(prepared.definition()), None);
                    black_box(prepared.project(query, &mut Scratch::default()));
                });
                return;
            }
        };
        let mut scratch = Scratch::default();
        black_box(prepared.project_near(query, hint, &mut scratch));
        measure(&mut || {
            black_box(prepared.project_near(query, hint, &mut scratch));
        });
    }
}

fn point(entity: &PreparedEntity, row: usize) -> Result<DVec3, Failure> {
    let row = if row == LAST { entity.rows.last() } else { entity.rows.get(row) };
    Ok(row.ok_or_else(|| format!("{} has no such row", entity.name))?.point)
}
