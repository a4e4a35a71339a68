//! Models from outside: each entity that the best known distances of a model name.

use std::path::{Path, PathBuf};

use perpend_bench::{Failure, Judge, PreparedEntity, geometric_mean, prepared_set, real_models, slowest, time_all};
use perpend_projection::QueryOptions;

use crate::Run;
use crate::sets::{by_hierarchy, judged_cases};
use crate::table::{Goal, Table};

pub(crate) fn measure(run: &Run, table: &mut Table) -> Result<(), Failure> {
    table.heading("models from outside");
    let folders = folders();
    if folders.is_empty() {
        table.heading(format!(
            "none in {}; the environment variable PERPEND_REAL names their folder",
            real_models().display()
        ));
    }
    for folder in folders {
        let name = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let (distances, exact) = distances(&folder);
        let entities = prepared_set(&folder.join("corpus.json"), &distances)?;
        let judge = |entity: &PreparedEntity| {
            let judge = Judge::new(entity.prepared.definition());
            if exact { judge } else { judge.by_best_known() }
        };
        let (mut cases, faults) = judged_cases(&entities, |_| by_hierarchy(), judge)?;
        time_all(&mut cases, run.passes);
        let what = format!("{name}, geometric mean of {} entities", cases.len());
        table.line(what, Goal::None, "us", geometric_mean(&cases));
        let worst = slowest(&cases).ok_or("no entity is asked")?;
        table.line(format!("{name}, slowest entity: {}", worst.name), Goal::Time(10.0), "us", worst.micros);
        let (mut planned, _) = judged_cases(&entities, |_| QueryOptions::default(), judge)?;
        time_all(&mut planned, run.passes);
        table.line(format!("{name}, by the plans' own methods"), Goal::None, "us", geometric_mean(&planned));
        table.faults(name, faults);
    }
    Ok(())
}

/// The folders of the models, in the order of their names.
pub(crate) fn folders() -> Vec<PathBuf> {
    let entries = std::fs::read_dir(real_models()).into_iter().flatten().flatten();
    let mut folders: Vec<PathBuf> =
        entries.map(|entry| entry.path()).filter(|path| path.join("corpus.json").is_file()).collect();
    folders.sort();
    folders
}

/// The file with a model's distances, and whether they are true, or the best known.
fn distances(folder: &Path) -> (PathBuf, bool) {
    let truth = folder.join("truth.csv");
    let exact = truth.is_file();
    (if exact { truth } else { folder.join("best-known.csv") }, exact)
}
