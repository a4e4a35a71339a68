//! What a query cost.

use serde::{Deserialize, Serialize};

/// Counts of the work done for one query, or for many together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Statistics {
    /// Queries answered.
    pub queries: u64,
    /// Queries that the solver which was asked first declined, and the certified hierarchy answered.
    pub declined: u64,
    /// Boxes of the tree looked at.
    pub boxes: u64,
    /// Leaves whose form was made, restarts included.
    pub forms: u64,
    /// Splits of a scalar form.
    pub subdivisions: u64,
    /// Splits of a vector piece, where rounding stopped the scalar form.
    pub refinements: u64,
    /// Evaluations of a point with its derivatives.
    pub evaluations: u64,
    /// Boxes left open when the work bound was met.
    pub unresolved: u64,
}

impl std::ops::AddAssign for Statistics {
    fn add_assign(&mut self, other: Self) {
        self.queries += other.queries;
        self.declined += other.declined;
        self.boxes += other.boxes;
        self.forms += other.forms;
        self.subdivisions += other.subdivisions;
        self.refinements += other.refinements;
        self.evaluations += other.evaluations;
        self.unresolved += other.unresolved;
    }
}
