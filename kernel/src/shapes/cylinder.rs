//! Circular cylinders.

use serde::{Deserialize, Serialize};

use super::check;
use super::frame::Frame;
use super::turn::Profile;
use crate::invalid::InvalidDefinition;
use crate::knots::KnotVector;
use crate::surface::NurbsSurface;

/// A circular cylinder, bounded in height and angle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Cylinder {
    /// Origin of heights, axis, and the direction of angle 0.
    pub frame: Frame,
    /// The radius.
    pub radius: f64,
    /// From where to where along the axis.
    pub height: (f64, f64),
    /// The first and the last angle, at most a full turn apart.
    pub sweep: (f64, f64),
}

impl Cylinder {
    /// The part of a cylinder over the heights `height` and the angles `sweep`.
    ///
    /// # Errors
    ///
    /// The frame is none, the radius is not positive, the height does not ascend, or the sweep is empty or more than a full
    /// turn.
    pub fn new(frame: Frame, radius: f64, height: (f64, f64), sweep: (f64, f64)) -> Result<Self, InvalidDefinition> {
        let cylinder = Self { frame: frame.checked()?, radius, height, sweep };
        cylinder.to_nurbs().map(|_| cylinder)
    }

    /// The cylinder as a surface of degree (1, 2): u along the axis, v around it. Exact but for rounding.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new).
    pub fn to_nurbs(&self) -> Result<NurbsSurface, InvalidDefinition> {
        check::positive("radius", self.radius)?;
        check::ascending("height", self.height)?;
        check::sweep("sweep", self.sweep)?;
        let points = vec![(self.radius, self.height.0, 1.0), (self.radius, self.height.1, 1.0)];
        Profile { knots: KnotVector::bezier(1, 0.0, 1.0), points }.turn(&self.frame.checked()?, self.sweep)
    }
}
