//! How an entity's queries are answered, and why so.

use perpend_knowledge::Basis;
use serde::Serialize;

use crate::answer::Method;

/// How an entity's queries are answered: decided once, when it is prepared, from what is known of it.
///
/// It never depends on how many queries come, so that the same query gives the same answer alone or in a batch.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Plan {
    /// The solver that is asked first. What it declines, the certified hierarchy answers.
    pub method: Method,
    /// What the solvers are made with.
    pub settings: Settings,
    /// What each item of knowledge contributed.
    pub reasons: Vec<Reason>,
}

/// What an entity's solvers are made with.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Settings {
    /// The largest difference between `distance` and `lower_bound` unless a query asks for another, in the model's unit: 1e-9 times the
    /// entity's size.
    pub gap: f64,
    /// The parameters of a curve at which its pieces are cut beside its knots: cusps and loops.
    pub cuts: Vec<f64>,
    /// How an entity is decomposed into points, per direction, where its parametrisation factors are known.
    pub decomposition: Vec<Decomposition>,
}

/// How a direction is decomposed into points: from its parametrisation factor, by the table of categories (Piegl et al. 2008, §5).
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Decomposition {
    /// The direction.
    pub direction: perpend_kernel::Direction,
    /// What its parametrisation is called.
    pub category: String,
    /// The largest length of a part, as a share of the whole.
    pub tolerance: f64,
    /// The smallest length of a part, as a share of the largest.
    pub jitter: f64,
}

/// What an item of knowledge contributed to a plan.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Reason {
    /// The item, by the name of its field in the record.
    pub item: String,
    /// How it is known; none where it is not.
    pub basis: Option<Basis>,
    /// What follows from it, in words.
    pub effect: String,
}
