//! The coordinates that a shape is written in.

use glam::{DMat3, DVec3};

use crate::hierarchy::Frame;

/// The unit roundoff `u`.
pub(super) const ROUNDING: f64 = f64::EPSILON / 2.0;

/// An orthonormal frame of lengths relative to the entity's size, which lies in `[1, 2)`: the scale is a power of two.
#[derive(Debug, Clone)]
pub(super) struct Axes {
    /// In the model.
    origin: DVec3,
    /// A power of two, and its inverse: also exact.
    scale: f64,
    inverse: f64,
    /// The axes are its rows, times the scale.
    turn: DMat3,
    /// The largest |coordinate| of the origin, in the model's unit.
    reach: f64,
}

impl Axes {
    /// Axes at a point, along unit vectors that are orthogonal but for rounding.
    pub(super) fn new(frame: &Frame, origin: DVec3, x: DVec3, y: DVec3, z: DVec3) -> Self {
        let turn = frame.scale * DMat3::from_cols(x, y, z).transpose();
        Self { origin, scale: frame.scale, inverse: 1.0 / frame.scale, turn, reach: origin.abs().max_element() }
    }

    /// A point of the model in these coordinates.
    ///
    /// The subtraction rounds by `u |p - origin|`, each scalar product by `3u |p - origin|`, and the axes are orthonormal but for `4u`.
    #[inline]
    pub(super) fn enter(&self, p: DVec3) -> DVec3 {
        self.turn * (p - self.origin)
    }

    /// A length of these coordinates in the model's unit.
    #[inline]
    pub(super) fn length(&self, local: f64) -> f64 {
        local * self.inverse
    }

    /// A length of the model in these coordinates.
    #[inline]
    pub(super) fn local(&self, length: f64) -> f64 {
        length * self.scale
    }

    /// The largest |coordinate| of the origin, in the model's unit.
    #[inline]
    pub(super) fn reach(&self) -> f64 {
        self.reach
    }
}

/// An axis and a direction across it, orthonormal to rounding; those of a record may be off by a few ulps more.
pub(super) fn orthonormal(axis: DVec3, xdir: DVec3) -> Option<(DVec3, DVec3, DVec3)> {
    let z = axis.try_normalize()?;
    let x = (xdir - xdir.dot(z) * z).try_normalize()?;
    let x = (x - x.dot(z) * z).try_normalize()?;
    Some((x, z.cross(x), z))
}
