//! `perpend impact`: what an edit of an entity would touch.

use std::fmt::Write as _;
use std::process::ExitCode;

use perpend::{Effect, EntityId, Impact, Model};
use serde::Serialize;

use crate::args::ImpactArguments;
use crate::error::CommandError;
use crate::names;
use crate::report;

pub(crate) fn run(arguments: &ImpactArguments) -> Result<ExitCode, CommandError> {
    let model = arguments.trust.read(&arguments.model)?;
    let id = arguments.entity;
    let Ok(impact) = model.impact(id) else {
        return Err(CommandError::unknown_entity(arguments.model.clone(), &model, id));
    };
    let text = if arguments.json { json(&model, id, &impact) } else { words(&model, id, &impact) };
    report::answer(text.as_bytes())?;
    Ok(ExitCode::SUCCESS)
}

#[derive(Serialize)]
struct Touching<'a> {
    id: EntityId,
    touches: Vec<Touched<'a>>,
}

#[derive(Serialize)]
struct Touched<'a> {
    id: EntityId,
    name: &'a str,
    effect: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    why: Option<String>,
    because: Vec<Because>,
}

#[derive(Serialize)]
struct Because {
    relation: String,
    target: EntityId,
}

fn json(model: &Model, id: EntityId, impact: &[Impact]) -> String {
    let touched = |Impact { id, because, effect }: &Impact| Touched {
        id: *id,
        name: model.entity(*id).map_or("", |entity| entity.name()),
        effect: names::effect(effect),
        why: why(effect),
        because: because
            .iter()
            .map(|(relation, target)| Because { relation: names::relation(relation), target: *target })
            .collect(),
    };
    let touching = Touching { id, touches: impact.iter().map(touched).collect() };
    let mut text = serde_json::to_string_pretty(&touching).expect("an impact is plain data with names for keys");
    text.push('\n');
    text
}

fn why(effect: &Effect) -> Option<String> {
    match effect {
        Effect::Kept { why } => Some(why.to_string()),
        _ => None,
    }
}

fn words(model: &Model, id: EntityId, impact: &[Impact]) -> String {
    let mut text = format!("an edit of {} touches ", names::entity(model, id));
    if impact.is_empty() {
        text.push_str("nothing else\n");
        return text;
    }
    let others = if impact.len() == 1 { "entity" } else { "entities" };
    let _ = writeln!(text, "{} other {others}", impact.len());
    for Impact { id, because, effect } in impact {
        let _ = writeln!(text, "{}: {}", names::entity(model, *id), what(effect));
        for (relation, target) in because {
            let _ = writeln!(text, "    {}: {}", names::relation(relation), names::entity(model, *target));
        }
    }
    text
}

/// What happens to an entity, in words.
fn what(effect: &Effect) -> String {
    match effect {
        Effect::Rebuilt => "rebuilt".to_owned(),
        Effect::Overridden => "kept, since it was replaced by hand after it was made; it may no longer fit".to_owned(),
        Effect::Kept { why } => format!("kept, and may no longer fit: {why}"),
        _ => "kept; it only refers to what changes, and what it states may no longer hold".to_owned(),
    }
}
