//! `perpend explain`: how an entity's queries are answered, and why so.

use std::fmt::Write as _;
use std::process::ExitCode;

use perpend::{Basis, Entity, EntityId, Model, Plan, Reason, Settings};
use serde::Serialize;

use crate::args::ExplainArguments;
use crate::error::CommandError;
use crate::names;
use crate::report::{self, rounded};

pub(crate) fn run(arguments: &ExplainArguments) -> Result<ExitCode, CommandError> {
    let mut model = arguments.trust.read(&arguments.model)?;
    let id = arguments.entity;
    // what is absent is acquired in memory: the file stays as it is
    let _ = model.learn(id);
    let Some(entity) = model.entity(id) else {
        return Err(CommandError::unknown_entity(arguments.model.clone(), &model, id));
    };
    let plan = entity.prepared().plan();
    let text = if arguments.json { json(id, plan) } else { words(&model, entity, plan) };
    report::answer(text.as_bytes())?;
    Ok(ExitCode::SUCCESS)
}

#[derive(Serialize)]
struct Explanation<'a> {
    id: EntityId,
    method: &'static str,
    settings: &'a Settings,
    reasons: &'a [Reason],
}

fn json(id: EntityId, plan: &Plan) -> String {
    let explanation =
        Explanation { id, method: names::method(plan.method), settings: &plan.settings, reasons: &plan.reasons };
    let mut text = serde_json::to_string_pretty(&explanation).expect("a plan is plain data with names for keys");
    text.push('\n');
    text
}

fn words(model: &Model, entity: &Entity, plan: &Plan) -> String {
    let Settings { gap, cuts, decomposition } = &plan.settings;
    let mut text = format!("entity {} {:?}\n", entity.id(), entity.name());
    let _ = writeln!(text, "method        {}", names::method(plan.method));
    let _ =
        writeln!(text, "gap           {} {}, unless a query asks for another", rounded(*gap), model.units().symbol());
    if !cuts.is_empty() {
        let places: Vec<String> = cuts.iter().map(|u| format!("{u:?}")).collect();
        let _ = writeln!(text, "cuts          u = {}", places.join(", "));
    }
    for part in decomposition {
        let _ = writeln!(
            text,
            "decomposition {}: {}; tolerance {:?}, jitter {:?}",
            part.direction, part.category, part.tolerance, part.jitter
        );
    }
    text.push_str("because\n");
    for Reason { item, basis, effect } in &plan.reasons {
        let known = basis.map_or_else(|| "not known".to_owned(), known);
        let _ = writeln!(text, "  {item} ({known})\n      {effect}");
    }
    text
}

/// How an item is known, in words.
fn known(basis: Basis) -> String {
    match basis {
        Basis::Defined => "defined".to_owned(),
        Basis::Proved { gap } => format!("proved, gap {}", rounded(gap)),
        Basis::Measured { error } => format!("measured, error about {}", rounded(error)),
        Basis::Fitted { residual, points } => format!("fitted to {points} points, residual {}", rounded(residual)),
        Basis::Declared => "declared".to_owned(),
    }
}
