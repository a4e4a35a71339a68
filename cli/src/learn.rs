//! `perpend learn`: acquires what can be known of the entities.

use std::process::ExitCode;

use perpend::{Body, Entity};

use crate::args::LearnArguments;
use crate::error::CommandError;
use crate::{report, show};

pub(crate) fn run(arguments: &LearnArguments) -> Result<ExitCode, CommandError> {
    let mut model = arguments.trust.read(&arguments.model)?;
    let learned = model.learn_all();
    model.write(&arguments.output)?;
    if arguments.json {
        let entities: Vec<&Entity> = model.entities().iter().collect();
        let bodies: Vec<&Body> = model.bodies().iter().collect();
        report::answer(show::json(&entities, &bodies).as_bytes())?;
    }
    report::say(format_args!(
        "{}: learned of {} of {}",
        arguments.output.display(),
        learned,
        if model.len() == 1 { "1 entity".to_owned() } else { format!("{} entities", model.len()) },
    ));
    Ok(ExitCode::SUCCESS)
}
