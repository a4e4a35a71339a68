//! Circular cones.

use serde::{Deserialize, Serialize};

use super::check;
use super::frame::Frame;
use super::turn::Profile;
use crate::invalid::InvalidDefinition;
use crate::knots::KnotVector;
use crate::surface::NurbsSurface;

/// A circular cone, up to its apex or truncated, bounded in height and angle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Cone {
    /// Origin of heights, axis, and the direction of angle 0.
    pub frame: Frame,
    /// The radii at the first and at the last height; 0 is the apex.
    pub radii: (f64, f64),
    /// From where to where along the axis.
    pub height: (f64, f64),
    /// The first and the last angle, at most a full turn apart.
    pub sweep: (f64, f64),
}

impl Cone {
    /// The part of a cone over the heights `height` and the angles `sweep`.
    ///
    /// # Errors
    ///
    /// The frame is none, a radius is negative, the radii are equal, the height does not ascend, or the sweep is empty or more
    /// than a full turn.
    pub fn new(
        frame: Frame,
        radii: (f64, f64),
        height: (f64, f64),
        sweep: (f64, f64),
    ) -> Result<Self, InvalidDefinition> {
        let cone = Self { frame: frame.checked()?, radii, height, sweep };
        cone.to_nurbs().map(|_| cone)
    }

    /// The cone as a surface of degree (1, 2): u along the rulings, v around the axis; the apex is a collapsed edge.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new).
    pub fn to_nurbs(&self) -> Result<NurbsSurface, InvalidDefinition> {
        for radius in [self.radii.0, self.radii.1] {
            if !(radius >= 0.0 && radius.is_finite()) {
                return check::refuse("radius", radius, "it must be finite and not negative");
            }
        }
        if self.radii.0 == self.radii.1 {
            return check::refuse(
                "second radius",
                self.radii.1,
                "it must differ from the first; equal radii are a cylinder",
            );
        }
        check::ascending("height", self.height)?;
        check::sweep("sweep", self.sweep)?;
        let points = vec![(self.radii.0, self.height.0, 1.0), (self.radii.1, self.height.1, 1.0)];
        Profile { knots: KnotVector::bezier(1, 0.0, 1.0), points }.turn(&self.frame.checked()?, self.sweep)
    }
}
