//! Affine maps of space.

use glam::DAffine3;

use crate::curve::NurbsCurve;
use crate::invalid::InvalidDefinition;
use crate::surface::NurbsSurface;

impl NurbsCurve {
    /// The image under an affine map, with the same parameters and weights: control points are mapped (The NURBS Book, §3.1, P3.24).
    ///
    /// # Errors
    ///
    /// The image has no extent, or leaves the range of coordinates.
    pub fn transformed(&self, map: &DAffine3) -> Result<Self, InvalidDefinition> {
        let points = self.control_points.iter().map(|p| map.transform_point3(*p)).collect();
        Self::checked(self.knots.clone(), points, self.weights.clone())
    }
}

impl NurbsSurface {
    /// The image under an affine map, with the same parameters and weights.
    ///
    /// # Errors
    ///
    /// The image has no extent, or leaves the range of coordinates.
    pub fn transformed(&self, map: &DAffine3) -> Result<Self, InvalidDefinition> {
        let points = self.control_points.iter().map(|p| map.transform_point3(*p)).collect();
        Self::checked(self.u.clone(), self.v.clone(), points, self.weights.clone())
    }
}
