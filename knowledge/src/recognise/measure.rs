//! How far a definition is from a stated shape, measured at points of it.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};
use perpend_kernel::{Definition, Direction};

use super::curves::parameters;
use crate::classification::Kind;

/// The largest distance from the shape, within its ranges, over points of the definition; none for a class without a closed
/// form. It is at most the deviation, and shows how much a record lies.
pub(super) fn deviation(kind: &Kind, definition: &Definition) -> Option<f64> {
    let points: Vec<DVec3> = match definition {
        Definition::NurbsCurve(curve) => parameters(curve.domain(), 256).map(|u| curve.point(u)).collect(),
        Definition::NurbsSurface(surface) => parameters(surface.domain(Direction::U), 32)
            .flat_map(|u| parameters(surface.domain(Direction::V), 32).map(move |v| surface.point(u, v)))
            .collect(),
    };
    points.into_iter().try_fold(0.0_f64, |most, p| Some(most.max(distance(kind, p)?)))
}

fn distance(kind: &Kind, p: DVec3) -> Option<f64> {
    let about = |centre, axis: DVec3, xdir: DVec3| {
        let arm: DVec3 = p - centre;
        (DVec2::new(arm.dot(xdir), arm.dot(axis.cross(xdir))), arm.dot(axis))
    };
    Some(match *kind {
        Kind::Line { origin, direction, range } => {
            let arm = p - origin;
            (arm - clamp(arm.dot(direction), range) * direction).length()
        }
        Kind::Circle { centre, axis, xdir, radius, sweep } => {
            let (flat, height) = about(centre, axis, xdir);
            arc(flat, radius, sweep).hypot(height)
        }
        Kind::Plane { origin, normal, .. } => (p - origin).dot(normal).abs(),
        Kind::Cylinder { centre, axis, xdir, radius, height, sweep, .. } => {
            let (flat, z) = about(centre, axis, xdir);
            arc(flat, radius, sweep).hypot(z - clamp(z, height))
        }
        Kind::Sphere { centre, axis, xdir, radius, sweep, latitude, .. } => {
            let (flat, z) = about(centre, axis, xdir);
            arc(meridian(flat, z, sweep).0, radius, latitude).hypot(meridian(flat, z, sweep).1)
        }
        Kind::Cone { apex, axis, xdir, half_angle, height, sweep, .. } => {
            let (flat, z) = about(apex, axis, xdir);
            let (half_plane, beside) = meridian(flat, z, sweep);
            let ruling = DVec2::new(half_angle.sin(), half_angle.cos());
            let along = clamp(half_plane.dot(ruling), (height.0 / ruling.y, height.1 / ruling.y));
            (half_plane - along * ruling).length().hypot(beside)
        }
        Kind::Torus { centre, axis, xdir, major_radius, minor_radius, sweep, section, .. } => {
            let (flat, z) = about(centre, axis, xdir);
            let (half_plane, beside) = meridian(flat, z, sweep);
            arc(half_plane - major_radius * DVec2::X, minor_radius, section).hypot(beside)
        }
        _ => return None,
    })
}

fn clamp(value: f64, range: (f64, f64)) -> f64 {
    value.max(range.0.min(range.1)).min(range.0.max(range.1))
}

/// The angle of the range that is nearest to an angle, up to full turns.
fn within(angle: f64, range: (f64, f64)) -> f64 {
    let middle = 0.5 * (range.0 + range.1);
    clamp(angle + TAU * ((middle - angle) / TAU).round(), range)
}

/// The distance from an arc about the origin.
fn arc(p: DVec2, radius: f64, sweep: (f64, f64)) -> f64 {
    p.distance(radius * DVec2::from_angle(within(p.to_angle(), sweep)))
}

/// The point in the half plane of the nearest meridian of a sweep, and how far it is beside it.
fn meridian(flat: DVec2, z: f64, sweep: (f64, f64)) -> (DVec2, f64) {
    let towards = DVec2::from_angle(within(flat.to_angle(), sweep));
    (DVec2::new(flat.dot(towards), z), towards.perp_dot(flat))
}
