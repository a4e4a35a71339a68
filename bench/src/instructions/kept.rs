//! The counts that are kept: `bench/instructions.csv`.

use std::collections::HashMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

use perpend_bench::Failure;

/// What a query takes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Cost {
    pub instructions: u64,
    /// How often memory is asked for.
    pub allocations: u64,
}

/// The counts of an earlier run, by method and query, with the compiler that made that program.
pub(crate) struct Kept {
    compiler: String,
    counts: HashMap<(String, String), Cost>,
}

impl Kept {
    /// Reads them; none where there is no file yet.
    pub(crate) fn read() -> Result<Self, Failure> {
        let text = match std::fs::read_to_string(file()) {
            Ok(text) => text,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => String::new(),
            Err(error) => return Err(format!("{}: {error}", file().display()).into()),
        };
        let mut kept = Self { compiler: "an unknown compiler".to_owned(), counts: HashMap::new() };
        for line in text.lines().filter(|line| *line != HEADER) {
            if let Some(compiler) = line.strip_prefix("# ") {
                kept.compiler = compiler.to_owned();
                continue;
            }
            let [method, query, instructions, allocations] = line.split(',').collect::<Vec<_>>()[..] else {
                return Err(format!("{}: no row: {line}", file().display()).into());
            };
            let cost = Cost { instructions: instructions.parse()?, allocations: allocations.parse()? };
            kept.counts.insert((method.to_owned(), query.to_owned()), cost);
        }
        Ok(kept)
    }

    /// What is kept of a query by a method.
    pub(crate) fn cost(&self, method: &str, query: &str) -> Option<Cost> {
        self.counts.get(&(method.to_owned(), query.to_owned())).copied()
    }

    /// The methods and queries.
    pub(crate) fn names(&self) -> impl Iterator<Item = (&str, &str)> {
        self.counts.keys().map(|(method, query)| (method.as_str(), query.as_str()))
    }

    /// The compiler of the program that was counted.
    pub(crate) fn compiler(&self) -> &str {
        &self.compiler
    }
}

const HEADER: &str = "method,query,instructions,allocations";

/// Keeps these counts in place of all others.
pub(crate) fn write<'a>(counts: impl Iterator<Item = (&'a str, &'a str, Cost)>) -> Result<(), Failure> {
    let version = Command::new("rustc").arg("--version").output()?;
    let mut text = format!("# {}\n{HEADER}\n", String::from_utf8(version.stdout)?.trim());
    for (method, query, Cost { instructions, allocations }) in counts {
        writeln!(text, "{method},{query},{instructions},{allocations}")?;
    }
    Ok(std::fs::write(file(), text)?)
}

fn file() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("instructions.csv")
}
