//! Boxes from Bézier pieces.

use crate::bezier::{curve_pieces, surface_pieces};
use crate::bounds::Aabb;
use crate::curve::NurbsCurve;
use crate::homogeneous::cartesian;
use crate::surface::NurbsSurface;

impl NurbsCurve {
    /// The box of the control points of the Bézier pieces: holds the curve up to rounding (a few `degree * ε` of the largest
    /// coordinate), and lies within [`control_box`](Self::control_box) up to the same.
    #[must_use]
    pub fn tight_box(&self) -> Aabb {
        let pieces = curve_pieces(&self.knots, &self.homogeneous_points());
        Aabb::around(pieces.iter().flat_map(|piece| &piece.points).map(|point| cartesian(*point)))
    }
}

impl NurbsSurface {
    /// The box of the control points of the Bézier pieces; see [`NurbsCurve::tight_box`].
    #[must_use]
    pub fn tight_box(&self) -> Aabb {
        let pieces = surface_pieces(&self.u, &self.v, &self.homogeneous_points());
        Aabb::around(pieces.iter().flat_map(|piece| &piece.points).map(|point| cartesian(*point)))
    }
}
