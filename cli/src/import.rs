//! `perpend import`: a part as a CAD system wrote it becomes a model.

use std::process::ExitCode;
use std::time::Duration;

use perpend_step::{Import, NotUnderstood, ReadOptions, import_file};

use crate::args::ImportArguments;
use crate::error::CommandError;
use crate::project::is_same_file;
use crate::report::{self, counted};

pub(crate) fn run(arguments: &ImportArguments) -> Result<ExitCode, CommandError> {
    if is_same_file(&arguments.output, &arguments.part) {
        return Err(CommandError::OutputIsInput { path: arguments.output.clone() });
    }
    let defaults = ReadOptions::default();
    let options = ReadOptions {
        max_bytes: arguments.max_megabytes.map_or(defaults.max_bytes, |megabytes| megabytes << 20),
        max_time: arguments.max_seconds.map_or(defaults.max_time, Duration::from_secs),
        ..defaults
    };
    let import = import_file(&arguments.part, &options)
        .map_err(|source| CommandError::Import { part: arguments.part.clone(), source })?;
    let Import { model, not_understood, faces, known_faces, edges, bodies } = import;
    model.write(&arguments.output)?;
    let count = |count: usize, noun| counted(count as u64, noun);
    report::say(format_args!(
        "{}: {} ({known_faces} of known class), {}, {}; size {} {}",
        arguments.output.display(),
        count(faces, "face"),
        count(edges, "edge"),
        if bodies == 1 { "1 body".to_owned() } else { format!("{bodies} bodies") },
        report::rounded(model.size()),
        model.units().symbol(),
    ));
    if not_understood.is_empty() {
        return Ok(ExitCode::SUCCESS);
    }
    report::say(format_args!("{}: not understood, and not in the model:", arguments.part.display()));
    for NotUnderstood { entity, keyword, reason } in &not_understood {
        report::say(format_args!("  #{entity} {keyword}: {reason}"));
    }
    if arguments.partial {
        return Ok(ExitCode::SUCCESS);
    }
    report::say(format_args!(
        "the rest was written; --partial takes that for success, or have the part written anew without these"
    ));
    Ok(ExitCode::FAILURE)
}
