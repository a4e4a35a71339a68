//! What real parts cost, beside the goals, in one run: `parts [PART]... [--passes N]`.
//!
//! The parts are the STEP files of the models from outside; where there are none, growth alone is measured, on plates with holes. Every answer is judged
//! before it is timed. Every time is the fastest of several passes, and what is compared takes turns.

#![allow(clippy::print_stdout, reason = "a benchmark prints its table")]

#[path = "../speed/calibration.rs"]
mod calibration;
#[path = "../parts/growth.rs"]
mod growth;
#[path = "../parts/import.rs"]
mod import;
#[path = "../parts/judge.rs"]
mod judge;
#[path = "../parts/kinds.rs"]
mod kinds;
#[path = "../parts/plate.rs"]
mod plate;
#[path = "../parts/real.rs"]
mod real;
#[path = "../speed/table.rs"]
mod table;
#[path = "../parts/throughput.rs"]
mod throughput;
#[path = "../parts/timing.rs"]
mod timing;
#[path = "../parts/whole.rs"]
mod whole;

use std::path::PathBuf;

use clap::{Parser, ValueEnum};
use perpend_bench::{Failure, wavy};

use crate::real::RealPart;
use crate::table::Table;

/// What is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Part {
    /// STEP files: time and memory.
    Import,
    /// Queries to a whole model against queries to the nearest face alone.
    Whole,
    /// The k nearest, all within a radius, signed distances.
    Kinds,
    /// Points a second, on one thread and on two.
    Throughput,
    /// Models of more and more faces.
    Growth,
}

/// What real parts cost, beside the goals.
#[derive(Debug, Parser)]
struct Arguments {
    /// What is measured; everything if left out.
    parts: Vec<Part>,
    /// How often everything is timed; the fastest counts.
    #[arg(long, default_value_t = 7, value_parser = clap::value_parser!(u32).range(1..))]
    passes: u32,
    /// Only models whose name holds this.
    #[arg(long, default_value = "")]
    model: String,
    /// Only imports a file and prints by how much memory grew.
    #[arg(long, hide = true)]
    import_alone: Option<PathBuf>,
}

/// What a part is given.
struct Run {
    /// Those that were found.
    parts: Vec<RealPart>,
    passes: usize,
}

fn main() -> Result<(), Failure> {
    let arguments = Arguments::parse();
    if let Some(file) = arguments.import_alone {
        return import::alone(&file);
    }
    let passes = arguments.passes as usize;
    let run = Run { parts: real::parts(&arguments.model)?, passes };
    let mut table = Table::scaled_by(calibration::evaluation_micros(&wavy(40)?, passes));
    if run.parts.is_empty() {
        table.heading(format!("no STEP files: {}", real::remedy()));
    }
    let parts = if arguments.parts.is_empty() { Part::value_variants() } else { &arguments.parts };
    let done = parts.iter().try_for_each(|part| match part {
        Part::Import => import::measure(&run, &mut table),
        Part::Whole => whole::measure(&run, &mut table),
        Part::Kinds => kinds::measure(&run, &mut table),
        Part::Throughput => throughput::measure(&run, &mut table),
        Part::Growth => growth::measure(&run, &mut table),
    });
    table.close();
    done
}
