//! Certified nearest points on curves and surfaces.

mod answer;
mod hierarchy;
mod landmarks;
mod prepared;
mod query;
mod scratch;
mod statistics;
mod tree;

pub use answer::{Continuum, FootPoint, Method, Multiplicity, Parameter, ParameterBox, Place, Ties};
pub use prepared::Prepared;
pub use query::{Query, QueryError, QueryOptions};
pub use scratch::Scratch;
pub use statistics::Statistics;
pub use tree::{BoxTree, Candidate};
