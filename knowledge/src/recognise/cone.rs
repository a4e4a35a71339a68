//! Circular cones.

use glam::DVec3;

use super::line;
use super::revolution::Pose;
use super::turned::Turned;
use crate::classification::Kind;

/// The cone through the ends of a profile.
pub(super) fn candidate(pose: &Pose) -> Option<Kind> {
    let profile = &pose.turned.profile;
    let points = super::curves::samples(profile);
    let by_radius = |a: &&DVec3, b: &&DVec3| a.x.total_cmp(&b.x);
    let (narrow, wide) = (points.iter().min_by(by_radius)?, points.iter().max_by(by_radius)?);
    let (out, up) = (wide.x - narrow.x, wide.z - narrow.z);
    let apex = narrow.z - narrow.x * up / out;
    if !apex.is_finite() || up == 0.0 {
        return None;
    }
    let along = 1.0_f64.copysign(up);
    let clean = |height: f64| if height.abs() <= pose.slack { 0.0 } else { height };
    let (first, last) = line::lengths(profile, apex * DVec3::Z, along * DVec3::Z)?.range();
    Some(Kind::Cone {
        apex: pose.centre + apex * pose.axis,
        axis: along * pose.axis,
        xdir: pose.xdir,
        half_angle: out.atan2(up.abs()),
        height: (clean(first), clean(last)),
        sweep: (along * pose.sweep.0, along * pose.sweep.1),
        angular: pose.angular,
    })
}

/// Bound of the distance from a cone: the profile is a ruling through the apex.
pub(super) fn gap(turned: &Turned, half_angle: f64, height: (f64, f64), sweep: (f64, f64)) -> Option<f64> {
    let (sin, cos) = half_angle.sin_cos();
    let ruling = line::gap(&turned.profile, DVec3::ZERO, DVec3::new(sin, 0.0, cos), (height.0 / cos, height.1 / cos))?;
    Some(turned.gap(sweep)? + ruling)
}
