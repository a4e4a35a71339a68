//! perpend beside the libraries that one would take instead, in one run.
//!
//! `README.md` says what every row and column means.

#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a benchmark prints its tables, and how far it has come")]

mod case;
mod contender;
mod judgement;
mod machine;
mod report;
mod rivals;
mod run;
mod shape;
mod table;

use std::process::ExitCode;

use case::Set;
use clap::error::ErrorKind;
use clap::{CommandFactory as _, Parser, ValueEnum as _};
use contender::Contender;
use report::Outcome;
use rivals::{REFERENCE, Roster};
use table::Style;

/// What ends the program, or keeps a contender from an entity.
type Failure = Box<dyn std::error::Error>;

/// Prints a table per test set: perpend's methods beside other libraries, with times, memory and errors.
#[derive(Debug, Parser)]
#[command(name = "perpend-compare", version)]
struct Options {
    /// The test sets.
    #[arg(long, value_enum, value_delimiter = ',', num_args = 1.., default_values_t = Set::value_variants().to_vec())]
    sets: Vec<Set>,
    /// Passes over the queries of each contender; their median counts.
    #[arg(long, default_value_t = 7, value_parser = clap::value_parser!(u16).range(1..=1000))]
    passes: u16,
    /// Slow contenders are timed on every N-th row; very slow ones are asked no others.
    #[arg(long, value_name = "N", default_value_t = 11, value_parser = clap::value_parser!(u16).range(1..))]
    rows: u16,
    /// Only contenders with this in their name, and the hierarchy, to which the ratios are taken.
    #[arg(long, value_name = "NAME")]
    only: Vec<String>,
    /// Prints the tables in Markdown.
    #[arg(long)]
    markdown: bool,
}

fn main() -> ExitCode {
    match compare(&Options::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn compare(options: &Options) -> Result<(), Failure> {
    let Roster { present, absent } = Roster::gather();
    let names: Vec<String> = present.iter().map(|contender| contender.name()).collect();
    let wanted = |name: &String| {
        let has = |part: &String| name.to_lowercase().contains(&part.to_lowercase());
        options.only.is_empty() || options.only.iter().any(has)
    };
    for part in &options.only {
        let is_in = |name: &String| name.to_lowercase().contains(&part.to_lowercase());
        if !names.iter().chain(absent.iter().map(|(name, _)| name)).any(is_in) {
            let message = format!("no contender has {part:?} in its name; they are:\n  {}\n", names.join("\n  "));
            Options::command().error(ErrorKind::InvalidValue, message).exit();
        }
    }
    let contenders: Vec<(usize, &dyn Contender)> = names
        .iter()
        .enumerate()
        .filter(|(_, name)| wanted(name) || *name == REFERENCE)
        .map(|(index, _)| (index, &*present[index]))
        .collect();
    let absent: Vec<(String, String)> = absent.into_iter().filter(|(name, _)| wanted(name)).collect();

    println!("{}; {}; {}", machine::processor(), machine::date(), machine::commit());
    println!("{} passes, medians; slow contenders: every {} row", options.passes, ordinal(options.rows));
    let before = machine::evaluation()?;
    println!("one evaluation of a bicubic surface with all second derivatives: {before:.3} µs before the run");
    let style = if options.markdown { Style::Markdown } else { Style::Plain };
    let mut failures = Vec::new();
    let mut sets = Set::value_variants().to_vec();
    sets.retain(|set| options.sets.contains(set));
    // what is made once in a process would count for whoever comes first
    if let Some(first) = sets[0].cases()?.first() {
        run::measure(sets[0], (0, first), &contenders, 0, usize::from(options.rows), &mut Vec::new());
    }
    for set in sets {
        let cases = set.cases()?;
        let mut measured = Vec::new();
        for (at, case) in cases.iter().enumerate() {
            eprintln!("{}: {}", set.name(), case.name);
            let (passes, every) = (usize::from(options.passes), usize::from(options.rows));
            measured.extend(run::measure(set, (at, case), &contenders, passes, every, &mut failures));
        }
        let outcome = Outcome { set, cases: &cases, names: &names, measured: &measured };
        let mark = if options.markdown { "### " } else { "" };
        println!("\n{mark}{}\n\n{}", outcome.title(), outcome.table(&absent).text(style));
        if let Some(elementary) = outcome.elementary() {
            println!("{mark}{}, kind by kind\n\n{}", set.name(), elementary.text(style));
        }
    }
    println!("the same evaluation after the run: {:.3} µs", machine::evaluation()?);
    for failure in &failures {
        println!("failed: {failure}");
    }
    Ok(())
}

/// "11th", as in "every 11th".
fn ordinal(n: u16) -> String {
    let ending = match (n % 100, n % 10) {
        (11..=13, _) => "th",
        (_, 1) => "st",
        (_, 2) => "nd",
        (_, 3) => "rd",
        _ => "th",
    };
    format!("{n}{ending}")
}
