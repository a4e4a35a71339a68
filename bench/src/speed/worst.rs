//! The single queries that take longest, of the test sets and of the models from outside: found by the clock, then told apart by their
//! instructions, which no other program disturbs.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::fmt::Write;
use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use glam::DVec3;
use perpend_bench::{Corpus, Failure, callgrind, corpora, points};
use perpend_projection::{Prepared, Query, Scratch};

use crate::Run;
use crate::real;
use crate::sets::by_hierarchy;
use crate::table::{Goal, Table};

/// How many queries are counted.
const COUNTED: usize = 20;

/// How often a query is asked; the fastest counts.
const TURNS: usize = 5;

/// A query, and the fastest that it was answered.
struct Asked {
    file: PathBuf,
    entity: u64,
    name: String,
    point: DVec3,
    micros: f64,
}

pub(crate) fn measure(run: &Run, table: &mut Table) -> Result<(), Failure> {
    table.heading(format!(
        "single queries by the certified solver: the {COUNTED} slowest, their instructions, fastest of {TURNS}"
    ));
    let mut slowest = Vec::new();
    for (set, _) in run.sets.named() {
        let file = |ending: &str| corpora().join(format!("{set}{ending}"));
        look_through(set, &file(".json"), &file(".truth.csv"), &mut slowest)?;
    }
    for folder in real::folders() {
        let model = folder.file_name().unwrap_or_default().to_string_lossy();
        look_through(&model, &folder.join("corpus.json"), &folder.join("queries.csv"), &mut slowest)?;
    }
    let counts = instructions(&slowest)?;
    // how fast instructions are is told by all of these queries together
    let (time, count) = (slowest.iter().map(|asked| asked.micros).sum::<f64>(), counts.iter().sum::<u64>());
    let micros = time / count as f64;
    let mut worst = (0, 0);
    for (k, (asked, count)) in slowest.iter().zip(&counts).enumerate() {
        let DVec3 { x, y, z } = asked.point;
        table.line(format!("  {} ({x:.4}, {y:.4}, {z:.4}), {count}", asked.name), Goal::None, "us", asked.micros);
        worst = worst.max((*count, k));
    }
    let (count, k) = worst;
    table.line(
        format!("most instructions, {count}: {}", slowest[k].name),
        Goal::Time(300.0),
        "us",
        count as f64 * micros,
    );
    Ok(())
}

/// Asks all queries of a file to the entities of another, and keeps the slowest of them and of those before.
fn look_through(set: &str, entities: &Path, queries: &Path, slowest: &mut Vec<Asked>) -> Result<(), Failure> {
    let mut asked: HashMap<u64, Vec<DVec3>> = HashMap::new();
    for (entity, point) in points(queries)? {
        asked.entry(entity).or_default().push(point);
    }
    for entity in Corpus::read(entities)?.entities {
        let Some(points) = asked.get(&entity.id) else { continue };
        let prepared = Prepared::new(Arc::new(entity.definition()?), None);
        let mut scratch = Scratch::default();
        for point in points {
            let query = Query::new(*point, by_hierarchy())?;
            let mut micros = f64::INFINITY;
            for _ in 0..TURNS {
                let start = Instant::now();
                black_box(prepared.project(black_box(&query), &mut scratch));
                micros = micros.min(start.elapsed().as_secs_f64() * 1e6);
            }
            if slowest.len() < COUNTED || slowest.last().is_some_and(|last| last.micros < micros) {
                let place = slowest.partition_point(|other| other.micros >= micros);
                let (file, name) = (entities.to_owned(), format!("{set} {}", entity.name));
                slowest.insert(place, Asked { file, entity: entity.id, name, point: *point, micros });
                slowest.truncate(COUNTED);
            }
        }
    }
    Ok(())
}

/// The instructions of each query.
fn instructions(queries: &[Asked]) -> Result<Vec<u64>, Failure> {
    let folder = tempfile::tempdir()?;
    let list = folder.path().join("queries.csv");
    let mut text = String::from("entity,x,y,z,file\n");
    for Asked { file, entity, point: DVec3 { x, y, z }, .. } in queries {
        writeln!(text, "{entity},{x:?},{y:?},{z:?},{}", std::path::absolute(file)?.display())?;
    }
    std::fs::write(&list, text)?;
    let counts = callgrind::instructions(&["--replay".as_ref(), list.as_os_str()])?;
    if counts.len() != queries.len() {
        return Err(format!("{} queries are asked and callgrind counted {}", queries.len(), counts.len()).into());
    }
    Ok(counts)
}

/// Asks the queries of a list: each once alone, so that tables and working memory are there, and once counted.
pub(crate) fn replay(list: &Path) -> Result<(), Failure> {
    let text = std::fs::read_to_string(list)?;
    let files = text.lines().skip(1).filter_map(|line| line.splitn(5, ',').last());
    let (mut sets, mut prepared) = (HashMap::new(), HashMap::new());
    for ((entity, point), file) in points(list)?.into_iter().zip(files) {
        let set = match sets.entry(file) {
            Entry::Occupied(read) => read.into_mut(),
            Entry::Vacant(unread) => unread.insert(Corpus::read(Path::new(file))?),
        };
        let prepared = match prepared.entry((file, entity)) {
            Entry::Occupied(ready) => ready.into_mut(),
            Entry::Vacant(unready) => {
                let found = set.entities.iter().find(|e| e.id == entity).ok_or("an entity is absent")?;
                unready.insert(Prepared::new(Arc::new(found.definition()?), None))
            }
        };
        let (query, mut scratch) = (Query::new(point, by_hierarchy())?, Scratch::default());
        black_box(prepared.project(&query, &mut scratch));
        callgrind::counted(&mut || {
            black_box(prepared.project(black_box(&query), &mut scratch));
        });
    }
    Ok(())
}
