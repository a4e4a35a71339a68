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
use crate::kept::{Cost, Kept};

/// Instructions may rise by this share; where they fall by more, a new table is asked for. Allocations may not rise.
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
                wanted.iter().for_each(|fixed| fixed.ask(callgrind::counted));
            }
            Ok(ExitCode::SUCCESS)
        }
        Task::Compare { update } => compare(update),
    }
}

/// Prints every cost beside the one that is kept.
fn compare(update: bool) -> Result<ExitCode, Failure> {
    let fixed = Fixed::all()?;
    let instructions = callgrind::instructions(&["ask".as_ref()])?;
    if instructions.len() != fixed.len() {
        return Err(format!("{} queries are made and callgrind counted {}", fixed.len(), instructions.len()).into());
    }
    let costs: Vec<Cost> = fixed
        .iter()
        .zip(instructions)
        .map(|(fixed, instructions)| Cost { instructions, allocations: allocations(fixed) })
        .collect();
    let kept = Kept::read()?;
    println!(
        "{:<16}{:<26}{:>12}{:>12}{:>9}{:>14}{:>8}",
        "method", "query", "instructions", "kept", "ratio", "allocations", "kept"
    );
    let (mut more, mut less) = (0, 0);
    for (Fixed { method, name, .. }, cost) in fixed.iter().zip(&costs) {
        let Cost { instructions, allocations } = *cost;
        let Some(before) = kept.cost(method, name) else {
            more += 1;
            println!("{method:<16}{name:<26}{instructions:>12}{:>12}{:>9}{allocations:>14}{:>8}  new", "-", "-", "-");
            continue;
        };
        let ratio = instructions as f64 / before.instructions as f64;
        let remark = if ratio > 1.0 + TOLERANCE || allocations > before.allocations {
            more += 1;
            "MORE"
        } else if ratio < 1.0 - TOLERANCE || allocations < before.allocations {
            less += 1;
            "less"
        } else {
            ""
        };
        println!(
            "{method:<16}{name:<26}{instructions:>12}{:>12}{ratio:>9.4}{allocations:>14}{:>8}  {remark}",
            before.instructions, before.allocations
        );
    }
    let gone = kept.names().filter(|name| !fixed.iter().any(|f| (f.method, f.name.as_str()) == *name)).count();
    if update {
        let rows = fixed.iter().zip(&costs).map(|(fixed, cost)| (fixed.method, fixed.name.as_str(), *cost));
        kept::write(rows)?;
        println!("{} rows kept", costs.len());
        return Ok(ExitCode::SUCCESS);
    }
    println!("{} rows: {more} above what is kept or new, {less} below, {gone} kept ones not asked", costs.len());
    if more + less + gone > 0 {
        println!("`.ci/instructions --update` keeps what is counted now; the table was made with {}", kept.compiler());
    }
    Ok(if more == 0 && gone == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// How often a query asks for memory.
fn allocations(fixed: &Fixed) -> u64 {
    let mut count = 0;
    fixed.ask(|call| count = allocation_counter::measure(call).count_total);
    count
}
