//! Circles and their arcs.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use super::ellipse::Ellipse;
use super::frame::Frame;
use crate::curve::NurbsCurve;
use crate::invalid::InvalidDefinition;

/// A circle or an arc of one, in the plane across the axis of its frame.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Circle {
    /// Centre, axis, and the direction of angle 0.
    pub frame: Frame,
    /// The radius.
    pub radius: f64,
    /// The first and the last angle, at most a full turn apart.
    pub sweep: (f64, f64),
}

impl Circle {
    /// The arc of a circle over the angles `sweep`.
    ///
    /// # Errors
    ///
    /// The frame is none, the radius is not positive, or the sweep is empty or more than a full turn.
    pub fn new(frame: Frame, radius: f64, sweep: (f64, f64)) -> Result<Self, InvalidDefinition> {
        let circle = Self { frame: frame.checked()?, radius, sweep };
        circle.to_nurbs().map(|_| circle)
    }

    /// The whole circle.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new).
    pub fn whole(frame: Frame, radius: f64) -> Result<Self, InvalidDefinition> {
        Self::new(frame, radius, (0.0, TAU))
    }

    /// The arc as a rational quadratic over `[0, 1]`, exact but for the rounding of its control points.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new).
    pub fn to_nurbs(&self) -> Result<NurbsCurve, InvalidDefinition> {
        super::check::positive("radius", self.radius)?;
        Ellipse { frame: self.frame, radii: (self.radius, self.radius), sweep: self.sweep }.to_nurbs()
    }
}
