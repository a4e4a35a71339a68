//! What queries cost.

use serde::{Deserialize, Serialize};

/// Counts of the work done for one query, or for many together, by any solver.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Statistics {
    /// Queries answered.
    pub queries: u64,
    /// Queries that the solver which was asked first declined, and the certified hierarchy answered.
    pub declined: u64,
    /// Proposals that the proof corrected: another point of the entity is nearer by more than the gap.
    pub corrected: u64,
    /// What solvers did that propose a foot.
    pub proposal: Work,
    /// What the proof did.
    pub proof: Work,
}

/// Counts of work.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Work {
    /// Boxes of a tree looked at.
    pub boxes: u64,
    /// Cells of a grid visited.
    pub cells: u64,
    /// Pieces of the entity visited; of the hierarchy, leaves whose form was made, restarts included.
    pub pieces: u64,
    /// Splits of a piece or of its scalar form.
    pub subdivisions: u64,
    /// Splits of a vector piece, where rounding stopped the scalar form.
    pub refinements: u64,
    /// Evaluations of a point, with or without its derivatives.
    pub evaluations: u64,
    /// Steps of Newton's method.
    pub newton: u64,
    /// Boxes left open when the work bound was met.
    pub unresolved: u64,
}

impl std::ops::AddAssign for Statistics {
    fn add_assign(&mut self, other: Self) {
        self.queries += other.queries;
        self.declined += other.declined;
        self.corrected += other.corrected;
        self.proposal += other.proposal;
        self.proof += other.proof;
    }
}

impl std::ops::AddAssign for Work {
    fn add_assign(&mut self, other: Self) {
        self.boxes += other.boxes;
        self.cells += other.cells;
        self.pieces += other.pieces;
        self.subdivisions += other.subdivisions;
        self.refinements += other.refinements;
        self.evaluations += other.evaluations;
        self.newton += other.newton;
        self.unresolved += other.unresolved;
    }
}
