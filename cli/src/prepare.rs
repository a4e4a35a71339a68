//! `perpend clean`, `perpend purge` and `perpend restore`: what definitions do not need, or hardly need, goes, and comes back;
//! `perpend decompose`: curves in parts.

use std::collections::HashSet;
use std::fmt::Write as _;
use std::path::Path;
use std::process::ExitCode;
use std::sync::Arc;

use perpend::{Basis, Cleaning, Consent, Definition, EditError, Entity, EntityId, Model, Preparation};

use crate::args::{CleanArguments, DecomposeArguments, PurgeArguments, RestoreArguments};
use crate::error::CommandError;
use crate::report::{self, counted, rounded};

pub(crate) fn clean(arguments: &CleanArguments) -> Result<ExitCode, CommandError> {
    let mut model = arguments.trust.read(&arguments.model)?;
    let ids = asked(&arguments.model, &model, arguments.entity)?;
    let text = each(&mut model, &ids, (&arguments.model, &arguments.output), "cleaned", |model, id| model.clean(id))?;
    model.write(&arguments.output)?;
    report::answer(text.as_bytes())?;
    Ok(ExitCode::SUCCESS)
}

pub(crate) fn purge(arguments: &PurgeArguments) -> Result<ExitCode, CommandError> {
    let mut model = arguments.trust.read(&arguments.model)?;
    let mut ids = asked(&arguments.model, &model, arguments.entity)?;
    // What is made of others first: purged, it stays as it is when these are purged, and moves by no more than the tolerance.
    ids.sort_by_key(|id| model.impact(*id).map_or(0, |impact| impact.len()));
    let consent = Consent::within(arguments.tolerance);
    let text =
        each(&mut model, &ids, (&arguments.model, &arguments.output), "purged", |model, id| model.purge(id, consent))?;
    model.write(&arguments.output)?;
    report::answer(text.as_bytes())?;
    Ok(ExitCode::SUCCESS)
}

pub(crate) fn decompose(arguments: &DecomposeArguments) -> Result<ExitCode, CommandError> {
    let mut model = arguments.trust.read(&arguments.model)?;
    let mut ids = asked(&arguments.model, &model, arguments.entity)?;
    if arguments.entity.is_none() {
        let is_curve = |entity: &Entity| matches!(**entity.definition(), Definition::NurbsCurve(_));
        ids.retain(|id| model.entity(*id).is_some_and(is_curve));
    }
    let mut text = String::new();
    for id in &ids {
        let parts = model.decompose(*id).map_err(|source| edit(&arguments.model, source))?;
        if let (Some(first), Some(last)) = (parts.first(), parts.last()) {
            let name = model.entity(*id).map_or("", Entity::name);
            let _ = writeln!(text, "{id:>6}  {name:?}: {} parts, entities {first} to {last}", parts.len());
        }
    }
    let taken = text.lines().count();
    let count = counted(ids.len() as u64, "curve");
    let _ = writeln!(text, "{}: took apart {taken} of {count}", arguments.output.display());
    model.write(&arguments.output)?;
    report::answer(text.as_bytes())?;
    Ok(ExitCode::SUCCESS)
}

pub(crate) fn restore(arguments: &RestoreArguments) -> Result<ExitCode, CommandError> {
    let mut model = arguments.trust.read(&arguments.model)?;
    let mut ids = asked(&arguments.model, &model, arguments.entity)?;
    if arguments.entity.is_none() {
        ids.retain(|id| model.entity(*id).is_some_and(|entity| entity.original().is_some()));
    }
    for id in &ids {
        let done = if arguments.drop { model.drop_original(*id) } else { model.restore(*id) };
        done.map_err(|source| edit(&arguments.model, source))?;
    }
    model.write(&arguments.output)?;
    let done = if arguments.drop { "dropped" } else { "restored" };
    let count = counted(ids.len() as u64, "original");
    report::answer(format!("{}: {done} {count}\n", arguments.output.display()).as_bytes())?;
    Ok(ExitCode::SUCCESS)
}

/// The entities that a command is to work on.
fn asked(path: &Path, model: &Model, entity: Option<EntityId>) -> Result<Vec<EntityId>, CommandError> {
    match entity {
        // faces that trim other entities follow these
        None => Ok(model.entities().iter().filter(|one| one.carrier().is_none()).map(Entity::id).collect()),
        Some(id) if model.entity(id).is_some() => Ok(vec![id]),
        Some(id) => Err(CommandError::unknown_entity(path.to_owned(), model, id)),
    }
}

fn edit(path: &Path, source: EditError) -> CommandError {
    CommandError::Edit { model: path.to_owned(), source }
}

/// Prepares the entities, and says of each that changed what was done to it; of one that is made of those, that it was made anew.
fn each(
    model: &mut Model,
    ids: &[EntityId],
    (input, output): (&Path, &Path),
    done: &str,
    prepare: impl Fn(&mut Model, EntityId) -> Result<Preparation, EditError>,
) -> Result<String, CommandError> {
    let mut text = String::new();
    let definitions: Vec<_> = model.entities().iter().map(|entity| Arc::clone(entity.definition())).collect();
    let mut changed = HashSet::new();
    for id in ids {
        let points = |model: &Model| model.entity(*id).map_or(0, |entity| entity.definition().control_points().len());
        let before = points(model);
        let Preparation { steps, deviation } = prepare(model, *id).map_err(|source| edit(input, source))?;
        if steps.is_empty() {
            continue;
        }
        changed.insert(*id);
        let name = model.entity(*id).map_or("", Entity::name);
        let _ = writeln!(
            text,
            "{id:>6}  {name:?}: {before} to {} control points; {}; points moved by at most {} {}",
            points(model),
            steps.iter().map(words).collect::<Vec<_>>().join("; "),
            rounded(deviation),
            model.units().symbol(),
        );
    }
    for (entity, before) in model.entities().iter().zip(&definitions) {
        if !changed.contains(&entity.id()) && entity.definition() != before {
            let _ = writeln!(text, "{:>6}  {:?}: made anew of what changed", entity.id(), entity.name());
        }
    }
    let _ = writeln!(text, "{}: {done} {} of {}", output.display(), changed.len(), entities(ids.len()));
    Ok(text)
}

fn entities(count: usize) -> String {
    if count == 1 { "1 entity".to_owned() } else { format!("{count} entities") }
}

/// A step, in words.
fn words(step: &Cleaning) -> String {
    let knots = |count: usize| counted(count as u64, "knot");
    match step {
        Cleaning::Clamped { direction } => format!("clamped the knots in {direction}"),
        Cleaning::TrimClamped { share } => {
            format!("clamped p-curves that left the domain by {} of its extent", rounded(share.0.max(share.1)))
        }
        Cleaning::RemovedKnots { direction, knots: all } => format!("removed {} in {direction}", knots(all.len())),
        Cleaning::ReducedDegree { direction, from, to } => {
            format!("reduced the degree in {direction} from {from} to {to}")
        }
        Cleaning::DroppedWeights { weight } => format!("dropped the weights, which all were {}", rounded(*weight)),
        Cleaning::Purged { direction, removed, added } if added.is_empty() => {
            format!("purged {} in {direction}", knots(removed.len()))
        }
        Cleaning::Purged { direction, removed, added } => {
            format!("purged {} in {direction} and added {} where near ones met", knots(removed.len()), added.len())
        }
    }
}

/// What `check` says of the preparation of an entity, a line each.
pub(crate) fn told(entity: &Entity, unit: &str) -> Vec<String> {
    let items = entity.record().and_then(|record| record.representation.as_ref()?.cleaning.as_deref());
    let mut lines = Vec::new();
    for item in items.unwrap_or_default() {
        let bound = match item.basis {
            Basis::Proved { gap } => format!(", which moved points by at most {} {unit}", rounded(gap)),
            _ => String::new(),
        };
        match &item.value {
            // it leaves the shape as it is, and has a line of its own
            Cleaning::Clamped { .. } => {}
            step => lines.push(format!("{}{bound}", words(step))),
        }
    }
    if let Some(original) = entity.original() {
        lines.push(format!("the original is kept: {}", crate::check::shape(original.definition())));
    }
    lines
}
