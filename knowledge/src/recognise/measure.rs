//! How far a definition is from a stated shape, measured at points of it.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};
use perpend_kernel::{Definition, Direction, NurbsSurface};

use super::curves::parameters;
use super::turned::other;
use crate::classification::Kind;

/// The largest distance from the shape, within its ranges, over points of the definition. Of a shape with parameters it is at most the
/// deviation; of a sweep of the definition's own profile, it is measured from where each profile point is swept, which may be a little
/// more. It shows how much a record lies. None where the class is of the other kind of definitions.
pub(super) fn deviation(kind: &Kind, definition: &Definition) -> Option<f64> {
    if let Definition::NurbsSurface(surface) = definition
        && let Some(swept) = swept(kind, surface)
    {
        return Some(swept);
    }
    let (points, corners): (Vec<DVec3>, Vec<DVec3>) = match definition {
        Definition::NurbsCurve(curve) => {
            let (first, last) = curve.domain();
            let all = parameters((first, last), 256).chain(towards((first, last)));
            (all.map(|u| curve.point(u)).collect(), vec![curve.point(first), curve.point(last)])
        }
        Definition::NurbsSurface(surface) => {
            let [u, v] = [Direction::U, Direction::V].map(|along| surface.domain(along));
            let along = |domain| parameters(domain, 32).chain(towards(domain));
            let at = |u: f64, v: f64| surface.point(u, v);
            let corners = vec![at(u.0, v.0), at(u.0, v.1), at(u.1, v.0), at(u.1, v.1)];
            (along(u).flat_map(|s| along(v).map(move |t| at(s, t))).collect(), corners)
        }
    };
    let off = points.into_iter().try_fold(0.0_f64, |most, p| Some(most.max(distance(kind, p)?)))?;
    // a shape that goes on beyond the ends of the definition is off there
    let nearest = |p: &DVec3| corners.iter().map(|corner| corner.distance(*p)).fold(f64::INFINITY, f64::min);
    Some(ends(kind).iter().map(nearest).fold(off, f64::max))
}

/// Parameters that close in on both ends of a domain: where a range that stops short leaves little of the definition out.
fn towards((first, last): (f64, f64)) -> impl Iterator<Item = f64> + Clone {
    (6..=20).flat_map(move |k| {
        let step = (last - first) * 0.5_f64.powi(k);
        [first + step, last - step]
    })
}

/// The points at which the ranges of a shape end, of one that does not close.
fn ends(kind: &Kind) -> Vec<DVec3> {
    let around = |centre: DVec3, axis: DVec3, xdir: DVec3, angle: f64, radius: f64, height: f64| {
        centre + radius * (angle.cos() * xdir + angle.sin() * axis.cross(xdir)) + height * axis
    };
    let is_open = |sweep: (f64, f64)| (sweep.1 - sweep.0).abs() < TAU * (1.0 - 1e-9);
    let corners = |(centre, axis, xdir): (DVec3, DVec3, DVec3), sweep: (f64, f64), profile: [(f64, f64); 2]| {
        let sides = if is_open(sweep) { vec![sweep.0, sweep.1] } else { Vec::new() };
        let all = sides.iter().flat_map(|angle| profile.map(|(rho, z)| around(centre, axis, xdir, *angle, rho, z)));
        all.collect()
    };
    match *kind {
        Kind::Line { origin, direction, range } => vec![origin + range.0 * direction, origin + range.1 * direction],
        Kind::Circle { centre, axis, xdir, radius, sweep } if is_open(sweep) => {
            [sweep.0, sweep.1].map(|angle| around(centre, axis, xdir, angle, radius, 0.0)).to_vec()
        }
        Kind::Ellipse { centre, axis, xdir, radii, sweep } if is_open(sweep) => {
            let at = |angle: f64| centre + radii.0 * angle.cos() * xdir + radii.1 * angle.sin() * axis.cross(xdir);
            vec![at(sweep.0), at(sweep.1)]
        }
        Kind::Plane { origin, sides: Some((a, b)), .. } => vec![origin, origin + a, origin + b, origin + a + b],
        Kind::Cylinder { centre, axis, xdir, radius, height, sweep, .. } => {
            corners((centre, axis, xdir), sweep, [(radius, height.0), (radius, height.1)])
        }
        Kind::Cone { apex, axis, xdir, half_angle, height, sweep, .. } => {
            let at = |height: f64| (height * half_angle.tan(), height);
            corners((apex, axis, xdir), sweep, [at(height.0), at(height.1)])
        }
        Kind::Sphere { centre, axis, xdir, radius, sweep, latitude, .. } => {
            let at = |angle: f64| (radius * angle.cos(), radius * angle.sin());
            corners((centre, axis, xdir), sweep, [at(latitude.0), at(latitude.1)])
        }
        Kind::Torus { centre, axis, xdir, major_radius, minor_radius, sweep, section, .. } if is_open(section) => {
            let at = |angle: f64| (major_radius + minor_radius * angle.cos(), minor_radius * angle.sin());
            corners((centre, axis, xdir), sweep, [at(section.0), at(section.1)])
        }
        _ => Vec::new(),
    }
}

/// The largest distance from where a surface's own profile is swept; none for other classes.
fn swept(kind: &Kind, surface: &NurbsSurface) -> Option<f64> {
    let (Kind::Extrusion { along, .. } | Kind::Revolution { angular: along, .. } | Kind::Ruled { ruling: along }) =
        kind
    else {
        return None;
    };
    let at = |across: f64, t: f64| match along {
        Direction::U => surface.point(t, across),
        Direction::V => surface.point(across, t),
    };
    let (first, last) = surface.domain(*along);
    let off = |across: f64, t: f64| {
        let (start, p) = (at(across, first), at(across, t));
        match *kind {
            Kind::Extrusion { vector, .. } => segment(p, start, start + vector),
            Kind::Revolution { origin, axis, sweep, .. } => turned(p - origin, start - origin, axis, sweep),
            _ => segment(p, start, at(across, last)),
        }
    };
    let all = parameters(surface.domain(other(*along)), 32);
    let far = all.flat_map(|across| parameters((first, last), 32).map(move |t| (across, t)));
    Some(far.map(|(across, t)| off(across, t)).fold(0.0, f64::max))
}

/// The distance of `p` from the segment between two points.
fn segment(p: DVec3, from: DVec3, to: DVec3) -> f64 {
    let along = to - from;
    let share = ((p - from).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    // a segment without length is its start
    p.distance(if share.is_finite() { from + share * along } else { from })
}

/// The distance of `p` from the arc on which `start` is turned about an axis through the origin.
fn turned(p: DVec3, start: DVec3, axis: DVec3, sweep: f64) -> f64 {
    let across = |x: DVec3| x - x.dot(axis) * axis;
    let height = (p - start).dot(axis);
    let Some(xdir) = across(start).try_normalize() else { return across(p).length().hypot(height) };
    let flat = DVec2::new(p.dot(xdir), p.dot(axis.cross(xdir)));
    arc(flat, across(start).length(), (0.0, sweep)).hypot(height)
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
        Kind::Ellipse { centre, axis, xdir, radii, sweep } => {
            let (flat, height) = about(centre, axis, xdir);
            elliptic(flat, radii, sweep).hypot(height)
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

/// The distance from an arc of an ellipse about the origin: the least over samples, closed in on by thirds.
fn elliptic(p: DVec2, radii: (f64, f64), sweep: (f64, f64)) -> f64 {
    const SAMPLES: u32 = 64;
    let off = |angle: f64| p.distance(DVec2::new(radii.0 * angle.cos(), radii.1 * angle.sin()));
    let step = (sweep.1 - sweep.0) / f64::from(SAMPLES);
    let at = |k: u32| sweep.0 + step * f64::from(k);
    let nearest = (0..=SAMPLES).min_by(|a, b| off(at(*a)).total_cmp(&off(at(*b)))).unwrap_or(0);
    let (mut low, mut high) = (at(nearest.saturating_sub(1)), at((nearest + 1).min(SAMPLES)));
    for _ in 0..80 {
        let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if off(a) < off(b) { high = b } else { low = a }
    }
    off(0.5 * (low + high)).min(off(low)).min(off(high))
}

/// The point in the half plane of the nearest meridian of a sweep, and how far it is beside it.
fn meridian(flat: DVec2, z: f64, sweep: (f64, f64)) -> (DVec2, f64) {
    let towards = DVec2::from_angle(within(flat.to_angle(), sweep));
    (DVec2::new(flat.dot(towards), z), towards.perp_dot(flat))
}
