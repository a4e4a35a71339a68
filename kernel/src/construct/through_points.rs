//! Curves through points.

use glam::DVec3;

use super::interpolate::{InvalidInterpolation, System, check, check_finite};
use super::spacing::Spacing;
use crate::curve::NurbsCurve;

/// The curve of a degree over `[0, 1]` that passes the points in their order, the first and the last exactly.
///
/// The NURBS Book, §9.2.1, algorithm A9.1. Continuity is `degree - 1`. High degrees through many points oscillate: 3 suits most data.
///
/// # Accuracy
///
/// The curve misses a point by rounding alone: a few ε of the largest control point for low degrees.
///
/// # Errors
///
/// A bad degree, too few points, a coordinate that is not finite, neighbours with one parameter.
pub fn curve_through(points: &[DVec3], degree: usize, spacing: Spacing) -> Result<NurbsCurve, InvalidInterpolation> {
    check(points.len(), degree)?;
    check_finite(points.iter().copied())?;
    let parameters = spacing.parameters(points).ok_or(InvalidInterpolation::Repeated { index: 1 })?;
    let system = System::new(degree, &parameters)?;
    let control_points = system.solve(points);
    Ok(NurbsCurve::checked(system.knots, control_points, None)?)
}
