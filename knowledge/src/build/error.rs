//! Why an operation made nothing.

use perpend_kernel::{InvalidDefinition, InvalidEdit, InvalidInterpolation};

use crate::finite::NonFinite;
use crate::operation::Takes;

/// Why an operation made nothing.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BuildError {
    /// A parameter is infinite or not a number.
    #[error("{operation}: {} is {}; the parameters of an operation are finite", source.field, source.value)]
    NonFinite {
        /// The operation.
        operation: &'static str,
        /// The parameter.
        source: NonFinite,
    },
    /// Too few or too many inputs.
    #[error("{operation} takes {takes}, and {found} are given: correct the inputs")]
    Inputs {
        /// The operation.
        operation: &'static str,
        /// How many it takes.
        takes: Takes,
        /// How many there are.
        found: usize,
    },
    /// An input is a curve where a surface is needed, or the other way round.
    #[error("{operation}: input {index} is {found}, and {expected} is needed: name another entity")]
    WrongInput {
        /// The operation.
        operation: &'static str,
        /// Which input.
        index: usize,
        /// What is needed.
        expected: &'static str,
        /// What it is.
        found: &'static str,
    },
    /// The points of a surface are no rows.
    #[error(
        "Interpolation: columns is {columns} for {points} points; of a surface, give the length of a row, which divides the number of points (0, with a second degree of 0, is a curve)"
    )]
    Columns {
        /// The length of a row.
        columns: u64,
        /// How many points.
        points: usize,
    },
    /// A range does not ascend within the domain.
    #[error("Split: range is {range:?}; it must ascend within the domain of the input, {domain:?}")]
    Range {
        /// The range.
        range: (f64, f64),
        /// The domain.
        domain: (f64, f64),
    },
    /// perpend does not run the operation: its result is kept as it was entered.
    #[error("{operation} is not rebuilt by perpend: {why}; the entity is kept as it is")]
    NotRebuilt {
        /// The operation.
        operation: &'static str,
        /// Why not.
        why: &'static str,
    },
    /// The parameters make no valid definition.
    #[error("{operation}: {source}")]
    Definition {
        /// The operation.
        operation: &'static str,
        /// The rule.
        source: InvalidDefinition,
    },
    /// The input cannot be edited so.
    #[error("{operation}: {source}")]
    Edit {
        /// The operation.
        operation: &'static str,
        /// What cannot be done.
        source: InvalidEdit,
    },
    /// Nothing can be laid through the points or sections.
    #[error("{operation}: {source}")]
    Interpolation {
        /// The operation.
        operation: &'static str,
        /// What cannot be done.
        source: InvalidInterpolation,
    },
}

impl BuildError {
    /// Whether the operation is one that perpend does not run, so that the entity is kept as a reference.
    #[must_use]
    pub fn is_reference(&self) -> bool {
        matches!(self, Self::NotRebuilt { .. })
    }
}
