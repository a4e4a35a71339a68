//! The proof of a class, by its conventions and by control points.

use std::f64::consts::{FRAC_PI_2, TAU};

use glam::DVec3;
use perpend_kernel::{Definition, NurbsCurve, NurbsSurface};

use super::conic::Conic;
use super::refuted::Refuted;
use super::turned::Turned;
use super::{cone, cylinder, extrusion, line, plane, revolution, ruled, sphere, torus};
use crate::classification::Kind;

/// Bound of the relative rounding of a form of this degree in all.
///
/// Extraction rounds a coefficient by at most 2.5 ε times the degree, a product of Bernstein forms and its quotient by a few
/// ε more a factor and term; the sums are of one sign in their weights. This counts at least twice what is lost.
pub(super) fn rounding(degree: usize) -> f64 {
    (64.0 + 8.0 * degree as f64) * f64::EPSILON
}

/// Bound of the distance between a definition and the shape that a class states, both ways, rounding included; none where no
/// bound is found, since the definition is not built as such a shape is.
pub(super) fn gap(kind: &Kind, definition: &Definition) -> Result<Option<f64>, Refuted> {
    check(kind)?;
    let found = match definition {
        Definition::NurbsCurve(curve) => of_curve(kind, curve),
        Definition::NurbsSurface(surface) => of_surface(kind, surface),
    };
    let wrong = || Refuted::WrongDefinition { class: name(kind), definition: definition.kind() };
    let bound = found.ok_or_else(wrong)?;
    Ok(bound.filter(|bound| bound.is_finite()))
}

fn of_curve(kind: &Kind, curve: &NurbsCurve) -> Option<Option<f64>> {
    Some(match *kind {
        Kind::Line { origin, direction, range } => line::gap(curve, origin, direction, range),
        Kind::Circle { centre, axis, xdir, radius, sweep } => {
            Conic { centre, normal: axis, xdir, radii: (radius, radius) }.gap(curve, sweep)
        }
        Kind::Ellipse { centre, axis, xdir, radii, sweep } => {
            Conic { centre, normal: axis, xdir, radii }.gap(curve, sweep)
        }
        Kind::FreeForm => Some(0.0),
        _ => return None,
    })
}

fn of_surface(kind: &Kind, surface: &NurbsSurface) -> Option<Option<f64>> {
    let turned = |angular, centre, axis, xdir| Turned::about(surface, angular, centre, axis, Some(xdir));
    Some(match *kind {
        Kind::Plane { origin, normal, sides } => plane::gap(surface, origin, normal, sides),
        Kind::Cylinder { centre, axis, xdir, radius, height, sweep, angular } => {
            turned(angular, centre, axis, xdir).and_then(|(turned, _)| cylinder::gap(&turned, radius, height, sweep))
        }
        Kind::Cone { apex, axis, xdir, half_angle, height, sweep, angular } => {
            turned(angular, apex, axis, xdir).and_then(|(turned, _)| cone::gap(&turned, half_angle, height, sweep))
        }
        Kind::Sphere { centre, axis, xdir, radius, sweep, latitude, angular } => {
            turned(angular, centre, axis, xdir).and_then(|(turned, _)| sphere::gap(&turned, radius, latitude, sweep))
        }
        Kind::Torus { centre, axis, xdir, major_radius, minor_radius, sweep, section, angular } => {
            let radii = (major_radius, minor_radius);
            turned(angular, centre, axis, xdir).and_then(|(turned, _)| torus::gap(&turned, radii, section, sweep))
        }
        Kind::Ruled { ruling } => ruled::gap(surface, ruling),
        Kind::Revolution { origin, axis, sweep, angular } => revolution::gap(surface, angular, origin, axis, sweep),
        Kind::Extrusion { vector, along } => extrusion::gap(surface, vector, along),
        Kind::FreeForm => Some(0.0),
        _ => return None,
    })
}

/// The name of a class.
fn name(kind: &Kind) -> &'static str {
    match kind {
        Kind::Line { .. } => "Line",
        Kind::Circle { .. } => "Circle",
        Kind::Ellipse { .. } => "Ellipse",
        Kind::Plane { .. } => "Plane",
        Kind::Sphere { .. } => "Sphere",
        Kind::Cylinder { .. } => "Cylinder",
        Kind::Cone { .. } => "Cone",
        Kind::Torus { .. } => "Torus",
        Kind::Ruled { .. } => "Ruled",
        Kind::Revolution { .. } => "Revolution",
        Kind::Extrusion { .. } => "Extrusion",
        Kind::FreeForm => "FreeForm",
    }
}

/// What must hold for the parameters whatever the definition is.
fn check(kind: &Kind) -> Result<(), Refuted> {
    match *kind {
        Kind::Line { direction, .. } => unit("direction", direction),
        Kind::Circle { axis, xdir, radius, sweep, .. } => {
            frame(axis, xdir)?;
            positive("radius", radius)?;
            turn("sweep", sweep)
        }
        Kind::Ellipse { axis, xdir, radii, sweep, .. } => {
            frame(axis, xdir)?;
            positive("radii", radii.0.min(radii.1))?;
            turn("sweep", sweep)
        }
        Kind::Plane { normal, sides, .. } => {
            unit("normal", normal)?;
            let spanned = sides.is_none_or(|(a, b)| a.cross(b).length() > 0.0);
            hold(spanned, "sides", "are two vectors that are not parallel")
        }
        Kind::Sphere { axis, xdir, radius, sweep, latitude, .. } => {
            frame(axis, xdir)?;
            positive("radius", radius)?;
            let within = latitude.0.abs().max(latitude.1.abs()) <= FRAC_PI_2 * (1.0 + f64::EPSILON);
            hold(within, "latitude", "lies within -π/2 and π/2")?;
            turn("sweep", sweep)
        }
        Kind::Cylinder { axis, xdir, radius, sweep, .. } => {
            frame(axis, xdir)?;
            positive("radius", radius)?;
            turn("sweep", sweep)
        }
        Kind::Cone { axis, xdir, half_angle, height, sweep, .. } => {
            frame(axis, xdir)?;
            hold(half_angle > 0.0 && half_angle < FRAC_PI_2, "half_angle", "lies between 0 and π/2")?;
            hold(height.0.min(height.1) >= 0.0, "height", "is not negative: it counts from the apex along the axis")?;
            turn("sweep", sweep)
        }
        Kind::Torus { axis, xdir, major_radius, minor_radius, sweep, section, .. } => {
            frame(axis, xdir)?;
            positive("major_radius", major_radius)?;
            positive("minor_radius", minor_radius)?;
            turn("section", section)?;
            turn("sweep", sweep)
        }
        Kind::Revolution { axis, sweep, .. } => {
            unit("axis", axis)?;
            turn("sweep", (0.0, sweep))
        }
        Kind::Extrusion { vector, .. } => hold(vector.length() > 0.0, "vector", "is not zero"),
        Kind::Ruled { .. } | Kind::FreeForm => Ok(()),
    }
}

fn hold(holds: bool, field: &'static str, expected: &'static str) -> Result<(), Refuted> {
    if holds { Ok(()) } else { Err(Refuted::Malformed { field, expected }) }
}

fn positive(field: &'static str, value: f64) -> Result<(), Refuted> {
    hold(value > 0.0 && value.is_finite(), field, "is positive and finite")
}

/// A few ulps are what a unit vector is off when it was normalised; proofs allow for them.
fn unit(field: &'static str, vector: DVec3) -> Result<(), Refuted> {
    hold((vector.length() - 1.0).abs() <= 8.0 * f64::EPSILON, field, "is a vector of length 1")
}

fn frame(axis: DVec3, xdir: DVec3) -> Result<(), Refuted> {
    unit("axis", axis)?;
    unit("xdir", xdir)?;
    hold(axis.dot(xdir).abs() <= 8.0 * f64::EPSILON, "xdir", "is perpendicular to the axis")
}

fn turn(field: &'static str, range: (f64, f64)) -> Result<(), Refuted> {
    let turn = (range.1 - range.0).abs();
    let slack = 4.0 * f64::EPSILON * (TAU + range.0.abs() + range.1.abs());
    hold(turn <= TAU + slack, field, "is at most a full turn")
}
