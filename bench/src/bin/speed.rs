//! How fast perpend is, beside its goals, in one run: `speed [PART]... [--passes N] [--long]`.
//!
//! The goals are those of a machine on which one evaluation of a bicubic B-spline surface with all second derivatives takes 0.1 µs; that
//! evaluation is timed first, and the goals that are times are scaled by it. Every time is the fastest mean of several passes.

#![allow(clippy::print_stdout, reason = "a benchmark prints its table")]

#[path = "../speed/calibration.rs"]
mod calibration;
#[path = "../speed/classes.rs"]
mod classes;
#[path = "../speed/corpora.rs"]
mod corpora;
#[path = "../speed/equidistant.rs"]
mod equidistant;
#[path = "../speed/fresh.rs"]
mod fresh;
#[path = "../speed/gaps.rs"]
mod gaps;
#[path = "../speed/growth.rs"]
mod growth;
#[path = "../speed/real.rs"]
mod real;
#[path = "../speed/scan.rs"]
mod scan;
#[path = "../speed/sets.rs"]
mod sets;
#[path = "../speed/table.rs"]
mod table;
#[path = "../speed/worst.rs"]
mod worst;

use std::path::PathBuf;

use clap::{Parser, ValueEnum};
use perpend_bench::Failure;

use crate::sets::Sets;
use crate::table::Table;

/// What is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Part {
    /// The query mix of the test sets, as NURBS and recognised.
    Corpora,
    /// Points near a surface, in the order of a scan.
    Scan,
    /// Queries by their distance; centres, axes and spines.
    Classes,
    /// Gaps of 1e-11 and 1e-12 of the size.
    Gaps,
    /// Models from outside, where there are any.
    Real,
    /// The first query to an entity; preparation and memory.
    Fresh,
    /// Larger surfaces, more threads, more points.
    Growth,
    /// The queries that take longest, with their instructions.
    Worst,
}

/// How fast perpend is, beside its goals.
#[derive(Debug, Parser)]
struct Arguments {
    /// What is measured; everything if left out.
    parts: Vec<Part>,
    /// How often everything is timed; the fastest counts.
    #[arg(long, default_value_t = 7, value_parser = clap::value_parser!(u32).range(1..))]
    passes: u32,
    /// Asks ten million points, too.
    #[arg(long)]
    long: bool,
    /// Only asks the queries of a file, for callgrind.
    #[arg(long, hide = true)]
    replay: Option<PathBuf>,
}

/// What a part is given.
struct Run {
    sets: Sets,
    passes: usize,
    long: bool,
}

fn main() -> Result<(), Failure> {
    let arguments = Arguments::parse();
    if let Some(file) = arguments.replay {
        return worst::replay(&file);
    }
    let run = Run { sets: Sets::read()?, passes: arguments.passes as usize, long: arguments.long };
    let wavy = run.sets.surfaces.iter().find(|entity| entity.name == "wavy-40x40").ok_or("wavy-40x40 is absent")?;
    let bicubic = scan::surface(wavy.prepared.definition())?;
    let mut table = Table::scaled_by(calibration::evaluation_micros(bicubic, run.passes));
    let parts = if arguments.parts.is_empty() { Part::value_variants() } else { &arguments.parts };
    let done = parts.iter().try_for_each(|part| match part {
        Part::Corpora => corpora::measure(&run, &mut table),
        Part::Scan => scan::measure(&run, &mut table),
        Part::Classes => classes::measure(&run, &mut table),
        Part::Gaps => gaps::measure(&run, &mut table),
        Part::Real => real::measure(&run, &mut table),
        Part::Fresh => fresh::measure(&run, &mut table),
        Part::Growth => growth::measure(&run, &mut table),
        Part::Worst => worst::measure(&run, &mut table),
    });
    table.close();
    done
}
