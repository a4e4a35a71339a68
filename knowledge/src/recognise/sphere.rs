//! Spheres.

use std::f64::consts::FRAC_PI_2;

use glam::DVec3;
use perpend_kernel::NurbsSurface;

use super::conic::Conic;
use super::curves::samples;
use super::revolution::{Pose, about};
use super::torus;
use super::turned::Turned;
use crate::classification::Kind;

/// The sphere with its centre on the axis that fits the profile.
pub(super) fn candidate(pose: &Pose) -> Option<Kind> {
    let profile = &pose.turned.profile;
    let points = samples(profile);
    let n = points.len() as f64;
    let middle = points.iter().map(|p| p.z).sum::<f64>() / n;
    // ρ² + z² = 2 z z₀ + const is linear in z₀
    let square = |p: &DVec3| p.x * p.x + (p.z - middle) * (p.z - middle);
    let mean = points.iter().map(square).sum::<f64>() / n;
    let spread: f64 = points.iter().map(|p| (p.z - middle) * (p.z - middle)).sum();
    let mut at = middle + points.iter().map(|p| (p.z - middle) * (square(p) - mean)).sum::<f64>() / (2.0 * spread);
    let mut radius = 0.0;
    for _ in 0..4 {
        // Gauss–Newton: distance and its derivative by the centre's height, less their means
        let pairs: Vec<(f64, f64)> = points
            .iter()
            .map(|p| {
                let distance = p.x.hypot(p.z - at);
                (distance, (at - p.z) / distance)
            })
            .collect();
        radius = pairs.iter().map(|(d, _)| d).sum::<f64>() / n;
        let slope = pairs.iter().map(|(_, s)| s).sum::<f64>() / n;
        let norm: f64 = pairs.iter().map(|(_, s)| (s - slope) * (s - slope)).sum();
        let step = pairs.iter().map(|(d, s)| (d - radius) * (s - slope)).sum::<f64>() / norm;
        if step.is_finite() {
            at -= step;
        }
    }
    if !(at.is_finite() && radius > 0.0) {
        return None;
    }
    let (first, last) = meridian(radius, at).angles(profile)?.range();
    let inside = |latitude: f64| latitude.clamp(-FRAC_PI_2, FRAC_PI_2);
    Some(Kind::Sphere {
        centre: pose.centre + at * pose.axis,
        axis: pose.axis,
        xdir: pose.xdir,
        radius,
        sweep: pose.sweep,
        latitude: (inside(first), inside(last)),
        angular: pose.angular,
    })
}

/// The sphere about the centre of the profile's circle.
///
/// Of a narrow slice the axis is badly known across the slice, and the meridian tells the centre far better: the axis is moved
/// to it.
pub(super) fn about_meridian(pose: &Pose, surface: &NurbsSurface, tolerance: f64) -> Option<Kind> {
    let (beside, _, radius) = torus::circle(&pose.turned.profile)?;
    if beside.abs() > 1e-3 * radius {
        return None;
    }
    let (sin, cos) = (0.5 * (pose.sweep.0 + pose.sweep.1)).sin_cos();
    let middle = cos * pose.xdir + sin * pose.axis.cross(pose.xdir);
    candidate(&about(surface, pose.angular, pose.centre + beside * middle, pose.axis, tolerance)?)
}

/// Bound of the distance from a sphere: the profile is a part of a meridian.
pub(super) fn gap(turned: &Turned, radius: f64, latitude: (f64, f64), sweep: (f64, f64)) -> Option<f64> {
    Some(turned.gap(sweep)? + meridian(radius, 0.0).gap(&turned.profile, latitude)?)
}

/// The circle of latitudes in the half plane of a profile.
fn meridian(radius: f64, height: f64) -> Conic {
    Conic { centre: height * DVec3::Z, normal: -DVec3::Y, xdir: DVec3::X, radii: (radius, radius) }
}
