//! Circular cylinders.

use glam::DVec3;

use super::curves::samples;
use super::line;
use super::revolution::Pose;
use super::turned::Turned;
use crate::classification::Kind;

/// The cylinder through a profile's mean radius; height 0 is the profile's start.
pub(super) fn candidate(pose: &Pose) -> Option<Kind> {
    let points = samples(&pose.turned.profile);
    let radius = points.iter().map(|p| p.x).sum::<f64>() / points.len() as f64;
    let (first, last) = line::lengths(&pose.turned.profile, DVec3::ZERO, DVec3::Z)?.range();
    (radius > 0.0).then(|| Kind::Cylinder {
        centre: pose.centre + first * pose.axis,
        axis: pose.axis,
        xdir: pose.xdir,
        radius,
        height: (0.0, last - first),
        sweep: pose.sweep,
        angular: pose.angular,
    })
}

/// Bound of the distance from a cylinder: the profile is a ruling.
pub(super) fn gap(turned: &Turned, radius: f64, height: (f64, f64), sweep: (f64, f64)) -> Option<f64> {
    Some(turned.gap(sweep)? + line::gap(&turned.profile, radius * DVec3::X, DVec3::Z, height)?)
}
