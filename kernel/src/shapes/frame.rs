//! Frames: where a shape stands.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::check::refuse;
use crate::invalid::InvalidDefinition;

/// A right-handed frame: origin, axis, and the direction from which angles about the axis count.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Frame {
    /// The origin.
    pub centre: DVec3,
    /// The axis, of unit length.
    pub axis: DVec3,
    /// The direction of angle 0, of unit length, perpendicular to the axis.
    pub xdir: DVec3,
}

impl Frame {
    /// The frame at the origin with the axes of space.
    pub const WORLD: Self = Self { centre: DVec3::ZERO, axis: DVec3::Z, xdir: DVec3::X };

    /// A frame from directions of any length; the part of `xdir` along the axis is taken off.
    ///
    /// # Errors
    ///
    /// A direction is zero or not finite, or both are parallel.
    pub fn new(centre: DVec3, axis: DVec3, xdir: DVec3) -> Result<Self, InvalidDefinition> {
        if !centre.is_finite() {
            return refuse("centre", centre, "it must be finite");
        }
        let axis = unit_vector("axis", axis)?;
        let given = unit_vector("xdir", xdir)?;
        let across = given - given.dot(axis) * axis;
        // below this its direction is mostly rounding
        if across.length() < 1e-8 {
            return refuse("xdir", xdir, "it must not be parallel to the axis");
        }
        // twice is enough: what is left along the axis is rounding of the first time
        let across = across.normalize();
        let across = across - across.dot(axis) * axis;
        Ok(Self { centre, axis, xdir: across.normalize() })
    }

    /// A frame with any direction across the axis as `xdir`.
    ///
    /// # Errors
    ///
    /// The axis is zero or not finite.
    pub fn about(centre: DVec3, axis: DVec3) -> Result<Self, InvalidDefinition> {
        let axis = unit_vector("axis", axis)?;
        Self::new(centre, axis, axis.any_orthonormal_vector())
    }

    /// The direction of angle 90 degrees: `axis × xdir`.
    #[must_use]
    pub fn ydir(&self) -> DVec3 {
        self.axis.cross(self.xdir)
    }

    /// This frame with unit directions, whatever its fields hold.
    pub(super) fn checked(&self) -> Result<Self, InvalidDefinition> {
        Self::new(self.centre, self.axis, self.xdir)
    }

    /// The point at `(x, y, z)` along `xdir`, `ydir` and the axis.
    pub(super) fn at(&self, x: f64, y: f64, z: f64) -> DVec3 {
        self.centre + (x * self.xdir + y * self.ydir() + z * self.axis)
    }
}

/// The vector's direction; lengths near the ends of the range of numbers do not matter.
pub(crate) fn unit_vector(what: &'static str, vector: DVec3) -> Result<DVec3, InvalidDefinition> {
    let largest = vector.abs().max_element();
    if !(vector.is_finite() && largest > 0.0) {
        return refuse(what, vector, "it must be finite and not zero");
    }
    let scaled = vector / largest;
    if !scaled.is_finite() {
        return refuse(what, vector, "it must be longer than 1e-300");
    }
    Ok(scaled.normalize())
}
