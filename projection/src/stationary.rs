//! All stationary points of an entity: plain data.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::answer::{Continuum, Parameter, ParameterBox, Place};
use crate::query::QueryError;

/// What the distance does around a stationary point, on the entity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Extremum {
    /// It rises in every direction.
    Minimum,
    /// It falls in every direction.
    Maximum,
    /// It rises in some directions and falls in others.
    Saddle,
}

/// What is proven of the box of a stationary point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Certainty {
    /// It holds exactly one. Points of neighbouring pieces, or of a piece and its edge, that are closer than the tolerance and that rounding cannot
    /// part count as one.
    One,
    /// It may hold one, several or none: the query lies in or beside a focal point, or a whole curve of points is narrower than the tolerance.
    Undecided,
}

/// A stationary point of the distance from a query point, on an entity.
///
/// On a smooth piece it is a point where the gradient of the distance vanishes. On an edge of the entity, and on a crease, it is one where the
/// derivative along the edge vanishes; corners of a surface and ends of a curve always are. Where the distance is monotonous across a crease, the
/// crease is no reason to stop, and the point is none.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct StationaryPoint {
    /// Where it is, as near as rounding allows.
    pub parameter: Parameter,
    /// The definition there.
    pub point: DVec3,
    /// Its distance from the query point, in the model's unit.
    pub distance: f64,
    /// What the distance does around it, on the entity: an edge's minimum from which the distance falls into the entity is a saddle. None where
    /// rounding leaves it open.
    pub kind: Option<Extremum>,
    /// What is particular about its place.
    pub place: Place,
    /// On an edge, end or corner of an open entity: the distance falls when one leaves it into the entity. Without those, the number of minima less
    /// that of saddles plus that of maxima is Euler's characteristic of a surface (of a curve, the number of minima less that of maxima).
    pub descends_inward: bool,
    /// The box in which it lies.
    pub range: ParameterBox,
    /// What is proven of that box.
    pub certainty: Certainty,
}

/// All stationary points of an entity for a query point.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StationaryPoints {
    /// The isolated ones, in ascending order of parameters.
    pub points: Vec<StationaryPoint>,
    /// Connected sets of boxes, wider than the tolerance, in which the gradient could not be told from zero: continua, as the circle of a cylinder
    /// for a point of its axis, and the surroundings of points where it vanishes to a higher order than rounding shows.
    pub continua: Vec<Continuum>,
    /// Every box is proven to hold none, belongs to a point, or shows nothing but rounding or is narrower than the tolerance. False where the work bound
    /// was met before: then boxes of `continua` may be wider, and some may hold none. No box that could hold one is ever left out.
    pub complete: bool,
}

/// What a search for stationary points asks for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StationaryOptions {
    /// Boxes are split until they are proven, or no longer than this, in the model's unit; none: 1e-6 times the entity's size.
    pub tolerance: Option<f64>,
    /// How often boxes are split before the search ends with what is left.
    pub work: u32,
}

impl Default for StationaryOptions {
    fn default() -> Self {
        Self { tolerance: None, work: 20_000 }
    }
}

impl StationaryOptions {
    /// Checks the options.
    ///
    /// # Errors
    ///
    /// [`QueryError::InvalidOption`] where the tolerance is negative or not a number.
    pub fn validate(&self) -> Result<(), QueryError> {
        match self.tolerance {
            Some(value) if value.is_nan() || value < 0.0 => {
                Err(QueryError::InvalidOption { option: "tolerance", value })
            }
            _ => Ok(()),
        }
    }
}

/// A range of a definition's parameters, in u and in v.
pub(crate) fn parameter_box(range: [(f64, f64); 2]) -> ParameterBox {
    ParameterBox { u: range[0], v: range[1] }
}
