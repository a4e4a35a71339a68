//! The command `perpend`: certified nearest points of a model's entities.

mod args;
mod check;
mod deviation_report;
mod error;
mod explain;
mod export;
mod impact;
mod import;
mod learn;
mod names;
mod prepare;
mod project;
mod replay;
mod report;
mod show;
mod stationary;

use std::process::ExitCode;

use clap::Parser;

use crate::args::{Arguments, Command};

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    survive_file_size_limit();
    let done = match arguments.command {
        Command::Import(arguments) => import::run(&arguments),
        Command::Check(arguments) => check::run(&arguments),
        Command::Learn(arguments) => learn::run(&arguments),
        Command::Show(arguments) => show::run(&arguments),
        Command::Explain(arguments) => explain::run(&arguments),
        Command::Clean(arguments) => prepare::clean(&arguments),
        Command::Purge(arguments) => prepare::purge(&arguments),
        Command::Decompose(arguments) => prepare::decompose(&arguments),
        Command::Restore(arguments) => prepare::restore(&arguments),
        Command::Replay(arguments) => replay::run(&arguments),
        Command::Impact(arguments) => impact::run(&arguments),
        Command::Project(arguments) => project::run(&arguments),
        Command::Stationary(arguments) => stationary::run(&arguments),
        Command::Report(arguments) => deviation_report::run(&arguments),
        Command::Export(arguments) => export::run(&arguments),
    };
    match done {
        Ok(code) => code,
        Err(error) if error.is_closed_pipe() => ExitCode::SUCCESS,
        Err(error) => {
            report::say(format_args!("error: {error}"));
            error.exit_code()
        }
    }
}

/// A write beyond a file-size limit then fails with an error instead of ending the process without a word.
#[cfg(unix)]
fn survive_file_size_limit() {
    let noticed = std::sync::Arc::new(std::sync::atomic::AtomicBool::new(false));
    // Where it cannot be had, the limit ends the process, as is the custom.
    let _ = signal_hook::flag::register(signal_hook::consts::signal::SIGXFSZ, noticed);
}

#[cfg(not(unix))]
fn survive_file_size_limit() {}
