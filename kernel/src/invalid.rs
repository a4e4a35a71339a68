//! Why a definition is refused.

use serde::{Deserialize, Serialize};

/// A parametric direction of a surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum Direction {
    /// Along rows of the control net: `i` of `control_points[i][j]`.
    U,
    /// Along columns of the control net: `j` of `control_points[i][j]`.
    V,
}

impl std::fmt::Display for Direction {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::U => "u",
            Self::V => "v",
        })
    }
}

/// Which parameter of a definition an error speaks of: a curve's only one, or one of a surface's two.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Along {
    /// The parameter of a curve.
    Curve,
    /// One of the parameters of a surface.
    Surface(Direction),
}

impl std::fmt::Display for Along {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Curve => Ok(()),
            Self::Surface(direction) => write!(f, "{direction} "),
        }
    }
}

/// Where in the control points of a definition an error lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum PointIndex {
    /// `control_points[i]` of a curve.
    Curve(usize),
    /// `control_points[i][j]` of a surface.
    Surface(usize, usize),
}

impl std::fmt::Display for PointIndex {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Curve(i) => write!(f, "[{i}]"),
            Self::Surface(i, j) => write!(f, "[{i}][{j}]"),
        }
    }
}

/// Why a curve or a surface was refused: the offending datum, what was expected of it, and how to mend it.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum InvalidDefinition {
    /// The degree is outside 1 to [`MAX_DEGREE`](crate::MAX_DEGREE).
    #[error("{along}degree is {degree}; degrees from 1 to 25 are supported: lower the degree or split the entity")]
    Degree {
        /// Which parameter.
        along: Along,
        /// The degree that was given.
        degree: usize,
    },
    /// Fewer control points than degree + 1.
    #[error("{points} control points for {along}degree {degree}; at least {} are needed: add control points or lower the degree", degree + 1)]
    TooFewPoints {
        /// Which parameter.
        along: Along,
        /// Control points along it.
        points: usize,
        /// Its degree.
        degree: usize,
    },
    /// More control points than a definition may have.
    #[error("{points} control points; at most 10000000 are supported: split the entity")]
    TooManyPoints {
        /// How many were given.
        points: usize,
    },
    /// The number of knots is not points + degree + 1.
    #[error("{found} {along}knots; control points ({points}) + degree ({degree}) + 1 = {} are needed", points + degree + 1)]
    KnotCount {
        /// Which parameter.
        along: Along,
        /// Knots that were given.
        found: usize,
        /// Control points along the parameter.
        points: usize,
        /// Its degree.
        degree: usize,
    },
    /// A knot is infinite or not a number.
    #[error("{along}knots[{index}] is {value}; knots are finite numbers")]
    NonFiniteKnot {
        /// Which parameter.
        along: Along,
        /// Index of the knot.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// A knot is smaller than the one before it.
    #[error("{along}knots[{index}] is {knot}, below the knot before it ({previous}); sort the knots")]
    DecreasingKnots {
        /// Which parameter.
        along: Along,
        /// Index of the smaller knot.
        index: usize,
        /// The knot before it.
        previous: f64,
        /// The knot itself.
        knot: f64,
    },
    /// An interior knot is repeated more often than the degree, which leaves a gap in the entity.
    #[error(
        "the {along}knot {knot} has multiplicity {multiplicity}, above the degree {degree}: the entity has a gap there; split it into two entities"
    )]
    InteriorMultiplicity {
        /// Which parameter.
        along: Along,
        /// The knot.
        knot: f64,
        /// How often it occurs.
        multiplicity: usize,
        /// The degree.
        degree: usize,
    },
    /// An end knot is repeated more often than degree + 1.
    #[error("the {along}end knot {knot} has multiplicity {multiplicity}; degree + 1 = {} is the most: remove the surplus knots and their control points", degree + 1)]
    EndMultiplicity {
        /// Which parameter.
        along: Along,
        /// The knot.
        knot: f64,
        /// How often it occurs.
        multiplicity: usize,
        /// The degree.
        degree: usize,
    },
    /// The first and the last parameter are the same.
    #[error("the {along}domain is the single value {knot}; the last knot must exceed the first")]
    EmptyDomain {
        /// Which parameter.
        along: Along,
        /// The value of both ends.
        knot: f64,
    },
    /// The domain is so wide, or a span of it so narrow, that parameters overflow or cannot be told apart.
    #[error(
        "the {along}knots run from {first:e} to {last:e}; the length of their range must be within 1e-100 to 1e100: rescale the knots"
    )]
    KnotRange {
        /// Which parameter.
        along: Along,
        /// First knot of the domain.
        first: f64,
        /// Last knot of the domain.
        last: f64,
    },
    /// A coordinate is infinite, not a number, or beyond 1e70.
    #[error("control_points{at} is ({x:?}, {y:?}, {z:?}); coordinates are finite and within ±1e70")]
    BadPoint {
        /// Which control point.
        at: PointIndex,
        /// Its first coordinate.
        x: f64,
        /// Its second coordinate.
        y: f64,
        /// Its third coordinate.
        z: f64,
    },
    /// A weight is zero, negative, infinite or not a number.
    #[error("weights{at} is {weight}; weights are positive and finite")]
    BadWeight {
        /// Which weight.
        at: PointIndex,
        /// Its value.
        weight: f64,
    },
    /// The largest weight is more than 1e100 times the smallest, or a weight is outside 1e-100 to 1e100.
    #[error(
        "weights reach from {smallest:e} to {largest:e}; they must lie within 1e-100 to 1e100, their ratio at most 1e100: rescale the weights"
    )]
    WeightRatio {
        /// The smallest weight.
        smallest: f64,
        /// The largest weight.
        largest: f64,
    },
    /// There are not as many weights as control points.
    #[error("{found} weights for {points} control points; give one weight each, or leave the weights out")]
    WeightCount {
        /// Weights that were given.
        found: usize,
        /// Control points that were given.
        points: usize,
    },
    /// A row of a surface's net is not as long as the first row of its control points.
    #[error(
        "{field}[{row}] has {found} entries, control_points[0] has {expected}; all rows of the net are equally long"
    )]
    RaggedRow {
        /// `control_points` or `weights`.
        field: &'static str,
        /// Index of the row.
        row: usize,
        /// Its length.
        found: usize,
        /// The length of the first row of control points.
        expected: usize,
    },
    /// All control points are one point, or so close that their box is below 1e-70.
    #[error("all control points are equal (or within 1e-70); an entity has an extent")]
    NoExtent,
    /// A shape's parameter has no meaning: a zero axis, a negative radius, an empty sweep.
    #[error("{what} is {value}; {expected}")]
    Shape {
        /// Which parameter of the shape.
        what: &'static str,
        /// Its value, as text.
        value: String,
        /// What it should be.
        expected: &'static str,
    },
}
