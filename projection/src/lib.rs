//! Certified nearest points on curves and surfaces.

mod analytic;
mod answer;
mod bernstein;
mod closed_form;
mod dispatch;
mod exclusion;
mod foot;
mod hierarchy;
mod landmarks;
mod plan;
mod prepared;
mod query;
mod scratch;
mod solver;
mod stationary;
mod statistics;
mod tree;
mod trimmed;
mod wave;

pub use answer::{Continuum, FootPoint, Method, Multiplicity, Parameter, ParameterBox, Place, Ties};
pub use plan::{Decomposition, Plan, Reason, Settings};
pub use prepared::Prepared;
pub use query::{NewtonTolerances, Query, QueryError, QueryOptions};
pub use scratch::Scratch;
pub use stationary::{Certainty, Extremum, StationaryOptions, StationaryPoint, StationaryPoints};
pub use statistics::{Statistics, Work};
pub use tree::{BoxTree, Candidate};
pub use wave::{DecompositionCost, Steps, Wave, WaveSettings, WaveTrace};
