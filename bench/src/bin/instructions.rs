//! Instructions of fixed queries by every method, beside those that are kept: a guard against slower code that no busy machine disturbs.
//!
//! `instructions compare [--update]` runs this program under callgrind and compares with `bench/instructions.csv`; `instructions ask` makes
//! the queries, for any profiler.

#![allow(clippy::print_stdout, reason = "the comparison prints its table")]

#[path = "../instructions/fixed.rs"]
mod fixed;
#[path = "../instructions/kept.rs"]
mod kept;

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use perpend_bench::{Failure, callgrind};

use crate::fixed::Fixed;
use crate::kept::Kept;

/// A count may rise by this share; one that falls by more asks for a new table.
const TOLERANCE: f64 = 0.03;

/// Instructions of fixed queries by every method.
#[derive(Debug, Parser)]
struct Arguments {
    #[command(subcommand)]
    task: Task,
}

#[derive(Debug, Subcommand)]
enum Task {
    /// Counts the instructions under callgrind, and fails where one is beyond what is kept.
    Compare {
        /// Keeps what is counted now.
        #[arg(long)]
        update: bool,
    },
    /// Makes the queries.
    Ask {
        /// The method whose queries are made; those of all if left out.
        method: Option<String>,
        /// Stops before the queries.
        #[arg(long)]
        setup_only: bool,
    },
}

fn main() -> Result<ExitCode, Failure> {
    match Arguments::parse().task {
        Task::Ask { method, setup_only } => {
            let wanted = Fixed::all()?.into_iter().filter(|fixed| method.as_ref().is_none_or(|m| *m == fixed.method));
            let wanted: Vec<Fixed> = wanted.collect();
            if wanted.is_empty() {
                return Err(
                    format!("no method is called {}; one of {}", method.unwrap_or_default(), fixed::methods()).into()
                );
            }
            if !setup_only {
                wanted.iter().for_each(Fixed::ask);
            }
            Ok(ExitCode::SUCCESS)
        }
        Task::Compare { update } => compare(update),
    }
}

/// Prints every count beside the one that is kept.
fn compare(update: bool) -> Result<ExitCode, Failure> {
    let fixed = Fixed::all()?;
    let counts = callgrind::instructions(&["ask".as_ref()])?;
    if counts.len() != fixed.len() {
        return Err(format!("{} queries are made and callgrind counted {}", fixed.len(), counts.len()).into());
    }
    let kept = Kept::read()?;
    println!("{:<16}{:<28}{:>12}{:>12}{:>9}", "method", "query", "measured", "kept", "ratio");
    let (mut more, mut less) = (0, 0);
    for (Fixed { method, name, .. }, count) in fixed.iter().zip(&counts) {
        let Some(before) = kept.count(method, name) else {
            more += 1;
            println!("{method:<16}{name:<28}{count:>12}{:>12}{:>9}  new", "-", "-");
            continue;
        };
        let ratio = *count as f64 / before as f64;
        let remark = if ratio > 1.0 + TOLERANCE {
            more += 1;
            "MORE"
        } else if ratio < 1.0 - TOLERANCE {
            less += 1;
            "less"
        } else {
            ""
        };
        println!("{method:<16}{name:<28}{count:>12}{before:>12}{ratio:>9.4}  {remark}");
    }
    let gone = kept.names().filter(|name| !fixed.iter().any(|f| (f.method, f.name.as_str()) == *name)).count();
    if update {
        let rows = fixed.iter().zip(&counts).map(|(fixed, count)| (fixed.method, fixed.name.as_str(), *count));
        kept::write(rows)?;
        println!("{} counts kept", counts.len());
        return Ok(ExitCode::SUCCESS);
    }
    println!(
        "{} counts: {more} above the tolerance of {TOLERANCE} or new, {less} below, {gone} kept ones not asked",
        counts.len()
    );
    if more + less > 0 || gone > 0 {
        println!("`.ci/instructions --update` keeps what is counted now; the table was made with {}", kept.compiler());
    }
    Ok(if more == 0 && gone == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
