//! Piegl et al. 2008: what a decomposition costs, Tables 2 to 4, and the wave beside the hierarchy.
//!
//! `papers piegl` prints all of it; with `--quick`, the last table ends at 10⁴ queries instead of 10⁶.

mod cost;
mod iterations;
mod own;
mod points;
mod race;

use std::sync::Arc;

use perpend_bench::{Corpus, corpora};
use perpend_kernel::Definition;

use crate::Failure;

/// The entities of the tables: a set, a name in it, and what it stands for.
const ENTITIES: [(&str, &str, &str); 3] = [
    ("seeds-curves", "selimovic-4-spatial", "a spatial curve (Fig. 6)"),
    ("seeds-surfaces", "dust-pan", "the dust pan (Fig. 7)"),
    ("seeds-surfaces", "brush-handle", "the brush handle (Fig. 7)"),
];

pub(crate) fn print() -> Result<(), Failure> {
    cost::print()?;
    iterations::print()?;
    own::print()?;
    race::print()
}

/// One cell of the last table, in a process of its own: see [`race`].
pub(crate) fn run(arguments: &[String]) -> Result<(), Failure> {
    race::run(arguments)
}

fn corpus(set: &str) -> Result<Corpus, Failure> {
    Corpus::read(&corpora().join(set).with_extension("json"))
}

fn definition(set: &str, name: &str) -> Result<Arc<Definition>, Failure> {
    let corpus = corpus(set)?;
    let entity = corpus.entities.iter().find(|entity| entity.name == name);
    Ok(Arc::new(entity.ok_or_else(|| format!("{set} has no entity {name}"))?.definition()?))
}
