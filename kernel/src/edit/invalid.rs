//! Why an edit is refused.

use crate::invalid::{Along, Direction, InvalidDefinition};

/// Why an edit of a curve or a surface was refused; the entity itself is as it was.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum InvalidEdit {
    /// The parameter lies outside the domain, or at an end where an interior parameter is needed, or is not a number.
    #[error("the {along}parameter is {at}; choose one {} {first} and {last}", if *.inside { "strictly between" } else { "from the domain, between" })]
    Parameter {
        /// Which parameter.
        along: Along,
        /// Its value.
        at: f64,
        /// The start of the domain.
        first: f64,
        /// The end of the domain.
        last: f64,
        /// Whether the ends are excluded.
        inside: bool,
    },
    /// A knot would occur more often than the degree, which would leave a gap.
    #[error(
        "the {along}knot {knot} would have multiplicity {multiplicity}; the degree, {degree}, is the most: insert it fewer times"
    )]
    Multiplicity {
        /// Which parameter.
        along: Along,
        /// The knot.
        knot: f64,
        /// How often it would occur.
        multiplicity: usize,
        /// The degree.
        degree: usize,
    },
    /// The value is not an interior knot.
    #[error("{at} is not an interior {along}knot; only knots between the ends can be removed")]
    NotAKnot {
        /// Which parameter.
        along: Along,
        /// The value.
        at: f64,
    },
    /// The degree would pass [`MAX_DEGREE`](crate::MAX_DEGREE).
    #[error("the {along}degree would be {degree}; 25 is the highest: elevate by less")]
    Degree {
        /// Which parameter.
        along: Along,
        /// The degree that the result would have.
        degree: usize,
    },
    /// The tolerance is negative or not a number.
    #[error("the tolerance is {tolerance}; it is a length, 0 or more")]
    Tolerance {
        /// Its value.
        tolerance: f64,
    },
    /// The iso-curve is a single point: a pole.
    #[error("the iso-curve at {direction} = {at} is a single point (a pole), not a curve; choose another parameter")]
    Collapsed {
        /// The direction whose parameter is held.
        direction: Direction,
        /// The parameter.
        at: f64,
    },
    /// The result would have more control points than a definition may have.
    #[error("the result would have {points} control points; at most 10000000 are supported: split the entity first")]
    TooManyPoints {
        /// How many it would have.
        points: usize,
    },
    /// The result is not a valid definition.
    #[error("the result is not valid: {0}")]
    Result(#[from] InvalidDefinition),
}
