//! Extrusions.

use glam::DVec3;

use crate::curve::NurbsCurve;
use crate::invalid::InvalidDefinition;
use crate::knots::KnotVector;
use crate::shapes::unit_vector;
use crate::surface::NurbsSurface;

/// The surface that `profile` (u) sweeps when it is moved along `path` (v in `[0, 1]`): `C(u) + v path`.
///
/// The NURBS Book, §8.3. Exact but for the rounding of the second row of control points.
///
/// # Errors
///
/// `path` is zero or not finite; coordinates leave their range.
pub fn extrusion(profile: &NurbsCurve, path: DVec3) -> Result<NurbsSurface, InvalidDefinition> {
    unit_vector("path", path)?;
    let points = profile.control_points.iter().flat_map(|p| [*p, *p + path]).collect();
    let weights = profile.weights().map(|w| w.iter().flat_map(|w| [*w, *w]).collect());
    NurbsSurface::checked(profile.knots.clone(), KnotVector::bezier(1, 0.0, 1.0), points, weights)
}
