//! Profiles turned about the axis of a frame.

use glam::DVec3;

use super::arc::Arc;
use super::frame::Frame;
use crate::invalid::InvalidDefinition;
use crate::knots::KnotVector;
use crate::surface::NurbsSurface;

/// A curve in the half plane of a frame: `points[i]` is `(distance from the axis, height, weight)`.
pub(super) struct Profile {
    pub(super) knots: KnotVector,
    pub(super) points: Vec<(f64, f64, f64)>,
}

impl Profile {
    /// The surface that the profile (u) sweeps over a valid range of angles (v). The NURBS Book, §8.5, algorithm A8.1.
    pub(super) fn turn(self, frame: &Frame, sweep: (f64, f64)) -> Result<NurbsSurface, InvalidDefinition> {
        let arc = Arc::new(sweep);
        let place = |distance: f64, height: f64, (x, y, _): (f64, f64, f64)| -> DVec3 {
            // apart from the rest: a pole is one point, with one sign of zero
            if distance == 0.0 { frame.at(0.0, 0.0, height) } else { frame.at(distance * x, distance * y, height) }
        };
        let (mut points, mut weights) = (Vec::new(), Vec::new());
        for (distance, height, weight) in &self.points {
            points.extend(arc.points.iter().map(|around| place(*distance, *height, *around)));
            weights.extend(arc.points.iter().map(|around| weight * around.2));
        }
        NurbsSurface::checked(self.knots, arc.knots, points, Some(weights))
    }
}
