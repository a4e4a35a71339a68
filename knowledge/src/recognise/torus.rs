//! Tori.

use glam::DVec3;
use perpend_kernel::NurbsCurve;

use super::axis;
use super::conic::{Conic, full_if_closed};
use super::curves::samples;
use super::revolution::Pose;
use super::turned::Turned;
use crate::classification::Kind;

/// The torus whose tube is the circle through the profile.
pub(super) fn candidate(pose: &Pose) -> Option<Kind> {
    let profile = &pose.turned.profile;
    let (major_radius, at, minor_radius) = circle(profile)?;
    if major_radius <= 0.0 {
        return None;
    }
    let section = tube(major_radius, minor_radius, at).angles(profile)?.range();
    let section = full_if_closed(section, 1e-2 * pose.slack / minor_radius);
    Some(Kind::Torus {
        centre: pose.centre + at * pose.axis,
        axis: pose.axis,
        xdir: pose.xdir,
        major_radius,
        minor_radius,
        sweep: pose.sweep,
        section,
        angular: pose.angular,
    })
}

/// The circle through a profile: its centre's distance from the axis and height, and its radius.
pub(super) fn circle(profile: &NurbsCurve) -> Option<(f64, f64, f64)> {
    // in the half plane of the axis, whatever rounding has left beside it
    let row: Vec<DVec3> = samples(profile).into_iter().map(|p| DVec3::new(p.x, 0.0, p.z)).collect();
    let fitted = axis::fit(std::slice::from_ref(&row), false)?;
    Some((fitted.centre.x, fitted.centre.z, fitted.mean(&row).1))
}

/// Bound of the distance from a torus: the profile is a part of the tube's circle.
pub(super) fn gap(turned: &Turned, radii: (f64, f64), section: (f64, f64), sweep: (f64, f64)) -> Option<f64> {
    Some(turned.gap(sweep)? + tube(radii.0, radii.1, 0.0).gap(&turned.profile, section)?)
}

/// The circle of the tube in the half plane of a profile.
fn tube(major: f64, minor: f64, height: f64) -> Conic {
    Conic { centre: DVec3::new(major, 0.0, height), normal: -DVec3::Y, xdir: DVec3::X, radii: (minor, minor) }
}
