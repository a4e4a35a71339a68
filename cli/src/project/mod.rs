//! `perpend project`: the nearest points to a file of points.

pub(crate) mod answer;
pub(crate) mod complaints;
pub(crate) mod engine;
pub(crate) mod output;
pub(crate) mod points;
pub(crate) mod progress;
mod query;
pub(crate) mod source;
mod tally;

use std::fs;
use std::path::Path;
use std::process::ExitCode;
use std::time::{Duration, Instant};

use indicatif::ProgressBar;
use perpend::{BodyError, Model, QueryOptions, Referent};

use crate::args::ProjectArguments;
use crate::error::CommandError;
use crate::project::answer::Layout;
use crate::project::complaints::Complaints;
use crate::project::engine::{Answers, Engine, Target};
use crate::project::output::Output;
use crate::project::points::{Batch, Columns, Points};
use crate::project::source::Source;
use crate::project::tally::Tally;
use crate::report::counted;

/// How many rows are in memory at a time.
pub(crate) const BATCH: usize = 4096;

pub(crate) fn run(arguments: &ProjectArguments) -> Result<ExitCode, CommandError> {
    let file = arguments.output.as_deref().filter(|path| path.as_os_str() != "-");
    if let Some(path) = file
        && is_same_file(path, &arguments.model)
    {
        return Err(CommandError::OutputIsModel { path: path.to_owned() });
    }
    let threads = rayon::ThreadPoolBuilder::new().num_threads(arguments.threads.map_or(0, usize::from)).build()?;
    let output = Output::open(file)?;
    let start = Instant::now();
    let model = arguments.trust.read(&arguments.model)?;
    let reading = start.elapsed();
    if let Some(id) = arguments.entity
        && model.referent(id) == Referent::Missing
    {
        return Err(CommandError::unknown_entity(arguments.model.clone(), &model, id));
    }

    if model.is_empty() {
        return Err(CommandError::NoEntities { model: arguments.model.clone() });
    }

    let start = Instant::now();
    let source = Source::of(&arguments.points);
    let (input, length) = source.open()?;
    let bar = progress::bar(length, file.is_some());
    let mut points = Points::new(bar.wrap_read(input)).map_err(|problem| source.wrong(problem))?;
    let columns = points.header().map_err(|problem| source.wrong(problem))?;
    let target = target(arguments, &model, &source, &columns)?;
    let options = QueryOptions {
        gap: arguments.gap,
        max_distance: arguments.max_distance,
        method: arguments.method,
        ..QueryOptions::default()
    };
    let layout = Layout { columns: &columns, normals: arguments.normals, ranks: target.is_ranked() };
    let engine = Engine::new(&model, target, options, layout);

    let mut journal = Journal { complaints: Complaints::new(source, &bar), bar: &bar, tally: Tally::default() };
    let mut output = output.write(&layout.header())?;
    let mut batch = Batch::default();
    loop {
        points.read(&mut batch, BATCH).map_err(|problem| source.wrong(problem))?;
        if batch.len() == 0 {
            break;
        }
        for answers in threads.install(|| engine.answer(&batch)) {
            output = output.write(&answers.text)?;
            journal.take(&answers);
        }
        journal.show_progress(start.elapsed());
    }
    output.finish()?;
    bar.finish_and_clear();
    journal.finish(model.units().symbol(), reading, start.elapsed());
    Ok(if journal.tally.bad == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// What the rows are projected onto.
fn target(
    arguments: &ProjectArguments,
    model: &Model,
    source: &Source<'_>,
    columns: &Columns,
) -> Result<Target, CommandError> {
    let ProjectArguments { entity, k, within, .. } = *arguments;
    let named = [("entity", entity.is_some()), ("k", k.is_some()), ("within", within.is_some())];
    if columns.entity.is_some() {
        return match named.into_iter().find(|(_, is_given)| *is_given) {
            Some((option, _)) => Err(CommandError::TwoEntities { name: source.to_string(), option }),
            None => Ok(Target::Named),
        };
    }
    Ok(match (entity, k, within) {
        (Some(id), ..) if model.referent(id) == Referent::Body => {
            let shells = model.body(id).map_or(&[][..], perpend::Body::shells);
            if let (true, Some(shell)) = (arguments.normals, shells.iter().position(|shell| !shell.closed)) {
                let source = BodyError::Open { body: id, shell };
                return Err(CommandError::Body { model: arguments.model.clone(), source });
            }
            Target::Body { id, signed: arguments.normals }
        }
        (Some(id), ..) => Target::Entity(id),
        (None, Some(k), _) => Target::Several(k as usize),
        (None, None, Some(radius)) => Target::Within(radius),
        (None, None, None) => Target::Nearest,
    })
}

pub(crate) fn is_same_file(a: &Path, b: &Path) -> bool {
    matches!((fs::canonicalize(a), fs::canonicalize(b)), (Ok(a), Ok(b)) if a == b)
}

/// What is told while the run lasts.
struct Journal<'a> {
    complaints: Complaints<'a>,
    bar: &'a ProgressBar,
    tally: Tally,
}

impl Journal<'_> {
    fn take(&mut self, answers: &Answers) {
        for complaint in &answers.complaints {
            self.complaints.take(complaint);
        }
        self.tally.add(&answers.tally);
    }

    fn show_progress(&self, elapsed: Duration) {
        let rate = self.tally.rows as f64 / elapsed.as_secs_f64().max(1e-9);
        self.bar.set_message(format!("{}, {rate:.0} points/s", counted(self.tally.rows, "point")));
    }

    fn finish(&self, unit: &str, reading: Duration, projecting: Duration) {
        self.complaints.finish();
        self.tally.report(unit, reading, projecting);
    }
}
