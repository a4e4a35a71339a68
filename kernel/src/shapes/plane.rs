//! Rectangles of planes.

use serde::{Deserialize, Serialize};

use super::check;
use super::frame::Frame;
use crate::invalid::InvalidDefinition;
use crate::knots::KnotVector;
use crate::surface::NurbsSurface;

/// A rectangle of the plane across the axis of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Plane {
    /// Origin, normal (the axis), and the direction of `width`.
    pub frame: Frame,
    /// From where to where along `xdir`.
    pub width: (f64, f64),
    /// From where to where along `ydir`.
    pub height: (f64, f64),
}

impl Plane {
    /// The rectangle `width` × `height` of a plane.
    ///
    /// # Errors
    ///
    /// The frame is none, or a range does not ascend.
    pub fn new(frame: Frame, width: (f64, f64), height: (f64, f64)) -> Result<Self, InvalidDefinition> {
        let plane = Self { frame: frame.checked()?, width, height };
        plane.to_nurbs().map(|_| plane)
    }

    /// The rectangle as a bilinear surface over `[0, 1]²`: u along `xdir`, v along `ydir`.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new).
    pub fn to_nurbs(&self) -> Result<NurbsSurface, InvalidDefinition> {
        check::ascending("width", self.width)?;
        check::ascending("height", self.height)?;
        let frame = self.frame.checked()?;
        let ((a, b), (c, d)) = (self.width, self.height);
        let points = [(a, c), (a, d), (b, c), (b, d)].map(|(x, y)| frame.at(x, y, 0.0));
        let knots = KnotVector::bezier(1, 0.0, 1.0);
        NurbsSurface::checked(knots.clone(), knots, points.to_vec(), None)
    }
}
