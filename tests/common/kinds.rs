//! Stated shapes as point sets: points of them, and distances from them, in closed form.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};
use perpend::{Basis, Item, Kind};

/// The name of a class.
pub fn name(kind: &Kind) -> String {
    let text = format!("{kind:?}");
    text.split([' ', '{']).next().unwrap_or_default().to_owned()
}

/// The proven gap of an item.
pub fn gap(item: &Item<Kind>) -> f64 {
    match item.basis {
        Basis::Proved { gap } => gap,
        basis => panic!("recognition proves, and this is {basis:?}"),
    }
}

/// The point of a shape where its ranges are run through by the shares `s` (about the axis) and `t`.
pub fn at(kind: &Kind, s: f64, t: f64) -> Option<DVec3> {
    let along = |range: (f64, f64), s: f64| (1.0 - s) * range.0 + s * range.1;
    let turn = |axis: DVec3, xdir: DVec3, sweep| {
        let angle: f64 = along(sweep, s);
        angle.cos() * xdir + angle.sin() * axis.cross(xdir)
    };
    Some(match *kind {
        Kind::Line { origin, direction, range } => origin + along(range, s) * direction,
        Kind::Circle { centre, axis, xdir, radius, sweep } => centre + radius * turn(axis, xdir, sweep),
        Kind::Ellipse { centre, axis, xdir, radii, sweep } => {
            let angle = along(sweep, s);
            centre + radii.0 * angle.cos() * xdir + radii.1 * angle.sin() * axis.cross(xdir)
        }
        Kind::Plane { origin, sides: Some((a, b)), .. } => origin + s * a + t * b,
        Kind::Cylinder { centre, axis, xdir, radius, height, sweep, .. } => {
            centre + radius * turn(axis, xdir, sweep) + along(height, t) * axis
        }
        Kind::Cone { apex, axis, xdir, half_angle, height, sweep, .. } => {
            let height = along(height, t);
            apex + height * half_angle.tan() * turn(axis, xdir, sweep) + height * axis
        }
        Kind::Sphere { centre, axis, xdir, radius, sweep, latitude, .. } => {
            let latitude = along(latitude, t);
            centre + radius * (latitude.cos() * turn(axis, xdir, sweep) + latitude.sin() * axis)
        }
        Kind::Torus { centre, axis, xdir, major_radius, minor_radius, sweep, section, .. } => {
            let angle = along(section, t);
            let out = major_radius + minor_radius * angle.cos();
            centre + out * turn(axis, xdir, sweep) + minor_radius * angle.sin() * axis
        }
        _ => return None,
    })
}

/// The distance of a point from the whole line, circle, plane, sphere, cylinder, cone or torus.
pub fn distance(kind: &Kind, p: DVec3) -> Option<f64> {
    let flat = |centre: DVec3, axis: DVec3| {
        let arm = p - centre;
        let height = arm.dot(axis);
        DVec2::new((arm - height * axis).length(), height)
    };
    Some(match *kind {
        Kind::Line { origin, direction, .. } => flat(origin, direction).x,
        Kind::Circle { centre, axis, radius, .. } => flat(centre, axis).distance(DVec2::new(radius, 0.0)),
        Kind::Plane { origin, normal, .. } => (p - origin).dot(normal).abs(),
        Kind::Cylinder { centre, axis, radius, .. } => (flat(centre, axis).x - radius).abs(),
        Kind::Sphere { centre, radius, .. } => (p.distance(centre) - radius).abs(),
        Kind::Cone { apex, axis, half_angle, .. } => {
            let ruling = DVec2::new(half_angle.sin(), half_angle.cos());
            flat(apex, axis).perp_dot(ruling).abs()
        }
        Kind::Torus { centre, axis, major_radius, minor_radius, .. } => {
            (flat(centre, axis).distance(DVec2::new(major_radius, 0.0)) - minor_radius).abs()
        }
        _ => return None,
    })
}

/// The size of a turn: how many radians, and whether it is whole.
pub fn turn(range: (f64, f64)) -> f64 {
    (range.1 - range.0).abs().min(TAU)
}
