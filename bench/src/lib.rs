//! Benchmarks of perpend: questions that an application would ask, with the worst error seen beside every time.

pub mod callgrind;
mod case;
mod corpus;
mod judgement;
mod prepared_set;
mod sequences;

pub use case::{Case, geometric_mean, slowest, time_all};
pub use corpus::{Corpus, CorpusEntity, Row, corpora, points, real_models, rows};
pub use judgement::{Faults, Judge};
pub use prepared_set::{PreparedEntity, prepared_set};
pub use sequences::{scan, spread, wavy};

/// Why a benchmark ends early; its message is for the person who ran it.
pub type Failure = Box<dyn std::error::Error>;
