//! `perpend replay`: an entity, made again as it was made, beside what it is.

use std::fmt::Write as _;
use std::process::ExitCode;

use perpend::{Deviation, Difference, Entity, EntityId, Intent, Model, Record, Replay};
use serde::Serialize;

use crate::args::ReplayArguments;
use crate::check::shape;
use crate::error::CommandError;
use crate::names;
use crate::report::{self, rounded};

pub(crate) fn run(arguments: &ReplayArguments) -> Result<ExitCode, CommandError> {
    let model = arguments.trust.read(&arguments.model)?;
    let id = arguments.entity;
    let unknown = || CommandError::unknown_entity(arguments.model.clone(), &model, id);
    let entity = model.entity(id).ok_or_else(unknown)?;
    let replay = model.replay(id).map_err(|source| CommandError::Replay { model: arguments.model.clone(), source })?;
    let text = if arguments.json { json(entity, &replay) } else { words(&model, entity, &replay) };
    report::answer(text.as_bytes())?;
    Ok(ExitCode::SUCCESS)
}

/// The steps that were run.
fn steps(entity: &Entity) -> Vec<Intent> {
    entity.record().and_then(Record::making).map_or_else(Vec::new, |making| making.steps.to_vec())
}

#[derive(Serialize)]
struct Replayed<'a> {
    id: EntityId,
    name: &'a str,
    steps: &'a [Intent],
    overridden: bool,
    drift: &'a Deviation,
}

fn json(entity: &Entity, replay: &Replay) -> String {
    let replayed = Replayed {
        id: entity.id(),
        name: entity.name(),
        steps: &steps(entity),
        overridden: replay.is_overridden,
        drift: &replay.drift,
    };
    let mut text = serde_json::to_string_pretty(&replayed).expect("a replay is plain data with names for keys");
    text.push('\n');
    text
}

fn words(model: &Model, entity: &Entity, replay: &Replay) -> String {
    let unit = model.units().symbol();
    let Deviation { proven, measured, differs } = &replay.drift;
    let mut text = format!("entity {} {:?}\n", entity.id(), entity.name());
    for step in steps(entity) {
        let inputs: Vec<String> = step.inputs.iter().map(|id| names::entity(model, *id)).collect();
        let of = if inputs.is_empty() { String::new() } else { format!(" of {}", inputs.join(" and ")) };
        let _ = writeln!(text, "made by   {}{of}", step.operation.name());
    }
    let _ = writeln!(text, "gives     {}", shape(&replay.definition));
    if *proven == 0.0 {
        text.push_str("drift     none: the same bits\n");
    } else {
        let _ = writeln!(
            text,
            "drift     proven at most {} {unit}, measured {} {unit}",
            rounded(*proven),
            rounded(*measured)
        );
    }
    if !differs.is_empty() {
        let words: Vec<&str> = differs.iter().map(|difference| word(*difference)).collect();
        let _ = writeln!(text, "differs   in {}", words.join(", "));
    }
    if replay.is_overridden {
        text.push_str(
            "the entity was replaced by hand after it was made; an edit of what it is made of leaves it as it is\n",
        );
    }
    text
}

fn word(difference: Difference) -> &'static str {
    match difference {
        Difference::Kind => "kind (curve, surface)",
        Difference::Degree => "degree",
        Difference::Domain => "domain",
        Difference::Knots => "knots",
        Difference::Weights => "weights (rational or not)",
    }
}
