//! `perpend check`: validates a model.

use std::fmt::Write as _;
use std::process::ExitCode;

use perpend::{Body, Cleaning, Definition, Direction, Doubt, Entity, Model};

use crate::args::CheckArguments;
use crate::error::CommandError;
use crate::prepare;
use crate::report::{self, counted, rounded};

pub(crate) fn run(arguments: &CheckArguments) -> Result<ExitCode, CommandError> {
    let model = arguments.trust.read(&arguments.model)?;
    let stale = model.entities().iter().filter(|entity| !entity.stale().is_empty()).count();
    let surfaces = model.entities().iter().filter(|e| matches!(**e.definition(), Definition::NurbsSurface(_))).count();
    let mut text = String::new();
    for entity in model.entities() {
        describe(&mut text, &model, entity, model.units().symbol());
    }
    for body in model.bodies() {
        let _ = writeln!(text, "{:>6}  {:?}: {}", body.id(), body.name(), solid(body));
    }
    let count = |count: usize, noun| counted(count as u64, noun);
    let _ = write!(
        text,
        "{}: valid; {}, {}; size {} {}",
        arguments.model.display(),
        count(model.len() - surfaces, "curve"),
        count(surfaces, "surface"),
        rounded(model.size()),
        model.units().symbol(),
    );
    let bodies = match model.bodies().len() {
        0 => String::new(),
        1 => "; 1 body".to_owned(),
        bodies => format!("; {bodies} bodies"),
    };
    text.push_str(&bodies);
    if stale > 0 {
        let _ = write!(
            text,
            "; stale knowledge in {}",
            if stale == 1 { "1 entity".to_owned() } else { format!("{stale} entities") }
        );
    }
    text.push('\n');
    report::answer(text.as_bytes())?;
    Ok(ExitCode::SUCCESS)
}

/// A line for the entity, and one for each thing to know about it.
fn describe(text: &mut String, model: &Model, entity: &Entity, unit: &str) {
    let _ = writeln!(text, "{:>6}  {:?}: {}", entity.id(), entity.name(), form(entity));
    for direction in clamped(entity) {
        let _ = writeln!(
            text,
            "        knots in {direction} came unclamped and were clamped, which leaves the shape as it is"
        );
    }
    for line in prepare::told(entity, unit) {
        let _ = writeln!(text, "        {line}");
    }
    for Doubt { part, drift } in model.doubts(entity.id()) {
        let _ = writeln!(
            text,
            "        {part}: gives another shape, {} {unit} off at points (proven at most {}): the definition was changed by hand since, or the \
             statement is false",
            rounded(drift.measured),
            rounded(drift.proven)
        );
    }
    let stale = entity.stale();
    if !stale.is_empty() {
        let _ = writeln!(text, "        stale knowledge, computed from another definition: {}", stale.join(", "));
    }
}

/// What an entity is, in words: its definition, and what trims it.
pub(crate) fn form(entity: &Entity) -> String {
    let shape = shape(entity.definition());
    match entity.trimming() {
        None => shape,
        Some(trimming) => {
            let of = entity.carrier().map_or_else(String::new, |id| format!(" of entity {id}"));
            let curves = trimming.loops().iter().map(|one| one.curves.len()).sum::<usize>();
            let (loops, curves) = (counted(trimming.loops().len() as u64, "loop"), counted(curves as u64, "p-curve"));
            let reversed = if trimming.reversed() { ", reversed" } else { "" };
            format!("{shape}{of}, trimmed by {loops} of {curves}{reversed}")
        }
    }
}

/// What a body is, in words.
pub(crate) fn solid(body: &Body) -> String {
    let shells: Vec<String> = body
        .shells()
        .iter()
        .map(|shell| {
            let closed = if shell.closed { "a closed" } else { "an open" };
            format!("{closed} shell of {}", counted(shell.faces.len() as u64, "face"))
        })
        .collect();
    format!("body of {}", shells.join(" and "))
}

/// What a definition is, in words.
pub(crate) fn shape(definition: &Definition) -> String {
    let weights = if definition.weights().is_some() { "rational " } else { "" };
    match definition {
        Definition::NurbsCurve(curve) => {
            format!("{weights}curve of degree {}, {} control points", curve.degree(), curve.control_points().len())
        }
        Definition::NurbsSurface(surface) => {
            let (p, q) = surface.degree();
            format!("{weights}surface of degree ({p}, {q}), {} x {} control points", surface.rows(), surface.columns())
        }
    }
}

/// The directions in which knots were clamped on entry.
fn clamped(entity: &Entity) -> Vec<Direction> {
    let representation = entity.record().and_then(|record| record.representation.as_ref());
    let items = representation.and_then(|part| part.cleaning.as_deref()).unwrap_or_default();
    let mut directions: Vec<Direction> = items
        .iter()
        .filter_map(|item| match item.value {
            Cleaning::Clamped { direction } => Some(direction),
            _ => None,
        })
        .collect();
    directions.sort_unstable();
    directions.dedup();
    directions
}
