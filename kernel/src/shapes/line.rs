//! Line segments.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::curve::NurbsCurve;
use crate::invalid::InvalidDefinition;
use crate::knots::KnotVector;

/// The segment between two points.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Line {
    /// Where it starts.
    pub start: DVec3,
    /// Where it ends.
    pub end: DVec3,
}

impl Line {
    /// The segment from `start` to `end`.
    ///
    /// # Errors
    ///
    /// The points are equal or not finite.
    pub fn new(start: DVec3, end: DVec3) -> Result<Self, InvalidDefinition> {
        let line = Self { start, end };
        line.to_nurbs().map(|_| line)
    }

    /// The segment as a curve of degree 1 over `[0, 1]`, of constant speed.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new).
    pub fn to_nurbs(&self) -> Result<NurbsCurve, InvalidDefinition> {
        NurbsCurve::checked(KnotVector::bezier(1, 0.0, 1.0), vec![self.start, self.end], None)
    }
}
