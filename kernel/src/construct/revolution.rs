//! Surfaces of revolution.

use glam::DVec3;

use crate::curve::NurbsCurve;
use crate::invalid::InvalidDefinition;
use crate::shapes::{Arc, check_sweep, unit_vector};
use crate::surface::NurbsSurface;

/// The surface that `profile` (u) sweeps when it is turned about an axis by `angle` radians (v in `[0, 1]`, right-handed).
///
/// The NURBS Book, §8.5, algorithm A8.1. At v = 0 the control points are the profile's, bit for bit, and a full turn ends in the
/// same ones. A control point that lies on the axis up to rounding stays where it is all around, so that a profile which ends
/// there gives a pole.
///
/// # Errors
///
/// The axis is zero or not finite; the angle is not above 0 and at most 2π; the whole profile lies on the axis and is one point.
pub fn revolution(
    profile: &NurbsCurve,
    centre: DVec3,
    axis: DVec3,
    angle: f64,
) -> Result<NurbsSurface, InvalidDefinition> {
    let axis = unit_vector("axis", axis)?;
    if !centre.is_finite() {
        return Err(InvalidDefinition::Shape {
            what: "centre",
            value: centre.to_string(),
            expected: "it must be finite",
        });
    }
    check_sweep("angle", (0.0, angle))?;
    let around = Arc::new((0.0, angle));
    let (mut points, mut weights) = (Vec::new(), Vec::new());
    for (i, point) in profile.control_points.iter().enumerate() {
        let arm = *point - centre;
        let radius = arm - arm.dot(axis) * axis;
        let rounding = 8.0 * f64::EPSILON * point.abs().max(centre.abs()).max_element();
        let on_axis = radius.length() <= rounding;
        let side = axis.cross(radius);
        let weight = profile.weights().map_or(1.0, |w| w[i]);
        for (x, y, w) in &around.points {
            points.push(if on_axis { *point } else { *point + ((x - 1.0) * radius + *y * side) });
            weights.push(weight * w);
        }
    }
    NurbsSurface::checked(profile.knots.clone(), around.knots, points, Some(weights))
}
