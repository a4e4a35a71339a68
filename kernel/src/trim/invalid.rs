//! Why a trim is refused.

use crate::invalid::InvalidDefinition;

/// Why a trim was refused: where, what was expected, and how to mend it.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum InvalidTrim {
    /// There are no loops.
    #[error(
        "loops is empty; a trimmed surface has at least one loop: give its boundary, or a NurbsSurface without trims"
    )]
    NoLoops,
    /// A loop has no curves.
    #[error("loops[{of}].curves is empty; a loop has at least one p-curve: remove the loop")]
    EmptyLoop {
        /// Index of the loop.
        of: usize,
    },
    /// The tolerance is negative or no number.
    #[error("tolerance is {tolerance}; it is a length in the model's unit, zero or more and finite")]
    Tolerance {
        /// What was given.
        tolerance: f64,
    },
    /// A p-curve is no valid curve.
    #[error("loops[{of}].curves[{curve}]: {source}")]
    Curve {
        /// Index of the loop.
        of: usize,
        /// Index of the p-curve in it.
        curve: usize,
        /// What is wrong with it.
        source: InvalidDefinition,
    },
    /// A p-curve leaves the surface's domain by more than the slack that files are granted.
    #[error(
        "loops[{of}].curves[{curve}] leaves the surface's domain by {share:e} of its extent (at most {most:e} is clamped): correct the p-curve or extend the surface"
    )]
    OutsideDomain {
        /// Index of the loop.
        of: usize,
        /// Index of the p-curve in it.
        curve: usize,
        /// By how much, as a share of the domain's extent.
        share: f64,
        /// What is clamped.
        most: f64,
    },
    /// A p-curve does not begin where the one before it ends.
    #[error(
        "loops[{of}].curves[{curve}] begins {gap:e} away from the end of the curve before it, and tolerance is {tolerance:e}: put the curves in order, close the loop, or state the tolerance to which it is closed"
    )]
    Open {
        /// Index of the loop.
        of: usize,
        /// Index of the p-curve that begins elsewhere.
        curve: usize,
        /// How far apart the ends are, or how far the straight way between their parameters leads away from them, in the model's unit.
        gap: f64,
        /// The tolerance that was given.
        tolerance: f64,
    },
    /// The loops bound nothing.
    #[error(
        "the loops bound no region: every point of a grid over their box is outside, and so are the points beside the loops"
    )]
    Empty,
}
