//! Offsets of entities whose offset is again a NURBS of the same class.
//!
//! The class comes from recognition. Planes, lines, circles, cylinders and spheres keep their parameters: their control points
//! are moved by an affine map that takes the shape to its offset. On cones and tori no affine map does that; their offset is
//! the shape's own form (`u` along the profile, `v` around, quarter turns), over the input's domain and in its directions.

use glam::{DAffine3, DMat3, DVec3};
use perpend_kernel::{Cone, Definition, Direction, Frame, InvalidDefinition, NurbsCurve, NurbsSurface, Torus};

use crate::classification::Kind;
use crate::recognise::{default_tolerance, recognise};

type Outcome = Result<Result<Definition, InvalidDefinition>, &'static str>;

/// The offset of an entity; why there is none that perpend makes.
pub(super) fn of(input: &Definition, distance: f64, normal: Option<DVec3>) -> Outcome {
    let tolerance = default_tolerance(input);
    let kind = recognise(input, tolerance).value;
    match input {
        Definition::NurbsCurve(curve) => of_curve(curve, kind, tolerance, distance, normal),
        Definition::NurbsSurface(surface) => of_surface(surface, kind, tolerance, distance),
    }
}

fn of_curve(curve: &NurbsCurve, kind: Kind, tolerance: f64, distance: f64, normal: Option<DVec3>) -> Outcome {
    let map = match kind {
        Kind::Line { direction, range, .. } => {
            let normal = normal.ok_or("a line is offset in a plane: give its normal")?;
            let tangent = if range.1 < range.0 { -direction } else { direction };
            let side = tangent.cross(normal / normal.abs().max_element().max(f64::MIN_POSITIVE));
            // below this its direction is mostly rounding
            if side.length() <= 1e-8 {
                return Err("the normal is zero or runs along the line; give that of a plane that holds the line");
            }
            DAffine3::from_translation(distance * side.normalize())
        }
        Kind::Circle { centre, axis, radius, sweep, .. } => {
            let side = match normal {
                None => 1.0,
                Some(normal) => {
                    let along = normal.normalize_or_zero().dot(axis);
                    if 1.0 - along.abs() > 1e-9 {
                        return Err("the normal is not that of the circle's plane");
                    }
                    along.signum() * if sweep.1 < sweep.0 { -1.0 } else { 1.0 }
                }
            };
            about(centre, DMat3::IDENTITY * share(radius, tolerance, side * distance)?)
        }
        _ => {
            return Err(
                "the offset of a curve that is no line and no circle is no NURBS curve; enter an approximation of it",
            );
        }
    };
    Ok(curve.transformed(&map).map(Into::into))
}

fn of_surface(surface: &NurbsSurface, kind: Kind, tolerance: f64, distance: f64) -> Outcome {
    let outwards = |direction: &dyn Fn(DVec3) -> DVec3| side(surface, direction).map(|side| side * distance);
    let map = match kind {
        Kind::Plane { normal, .. } => DAffine3::from_translation(outwards(&|_| normal)? * normal),
        Kind::Sphere { centre, radius, .. } => {
            about(centre, DMat3::IDENTITY * share(radius, tolerance, outwards(&|p| p - centre)?)?)
        }
        Kind::Cylinder { centre, axis, radius, .. } => {
            let radial = |p: DVec3| (p - centre) - (p - centre).dot(axis) * axis;
            let scale = share(radius, tolerance, outwards(&radial)?)?;
            let along = DMat3::from_cols(axis * axis.x, axis * axis.y, axis * axis.z);
            about(centre, DMat3::IDENTITY * scale + along * (1.0 - scale))
        }
        Kind::Cone { apex, axis, xdir, half_angle, height, sweep, angular } => {
            let (sine, cosine) = half_angle.sin_cos();
            let radial = |p: DVec3| (p - apex) - (p - apex).dot(axis) * axis;
            let outwards = outwards(&|p| radial(p).normalize_or_zero() * cosine - sine * axis)?;
            let (low, high) = ascending(height);
            // a radius that is rounding is the apex
            let radius = |h: f64| {
                let radius = h * half_angle.tan() + outwards * cosine;
                if radius.abs() <= tolerance { 0.0 } else { radius }
            };
            let (radii, heights) = ((radius(low), radius(high)), (low - outwards * sine, high - outwards * sine));
            if radii.0 < 0.0 {
                return Err("the offset passes the apex of the cone; choose a smaller distance");
            }
            let frame = Frame { centre: apex, axis, xdir };
            let shape = Cone { frame, radii, height: heights, sweep: ascending(sweep) }.to_nurbs();
            return Ok(shape.and_then(|shape| placed(shape, surface, height, sweep, angular)));
        }
        Kind::Torus { centre, axis, xdir, major_radius: major, minor_radius, sweep, section, angular } => {
            let spine = |p: DVec3| {
                let radial = (p - centre) - (p - centre).dot(axis) * axis;
                centre + major * radial.normalize_or_zero()
            };
            let minor = minor_radius + outwards(&|p| p - spine(p))?;
            if !(minor > tolerance && minor <= major) {
                return Err("the offset passes the spine or the axis of the torus; choose a smaller distance");
            }
            let frame = Frame { centre, axis, xdir };
            let shape = Torus { frame, major, minor, tube: ascending(section), sweep: ascending(sweep) }.to_nurbs();
            return Ok(shape.and_then(|shape| placed(shape, surface, section, sweep, angular)));
        }
        _ => {
            return Err(
                "the offset of a surface that is no plane, sphere, cylinder, cone or torus is no NURBS surface; enter an approximation of it",
            );
        }
    };
    Ok(surface.transformed(&map).map(Into::into))
}

/// The factor by which a radius changes; none where what is left of it is rounding.
fn share(radius: f64, tolerance: f64, more: f64) -> Result<f64, &'static str> {
    let left = radius + more;
    if left > tolerance {
        Ok(left / radius)
    } else {
        Err("the offset reaches the centre or axis; choose a smaller distance")
    }
}

/// The linear map about a centre.
fn about(centre: DVec3, matrix3: DMat3) -> DAffine3 {
    DAffine3 { matrix3, translation: centre - matrix3 * centre }
}

/// 1 where the normal of a surface points along `direction`, -1 where against it.
fn side(surface: &NurbsSurface, direction: &dyn Fn(DVec3) -> DVec3) -> Result<f64, &'static str> {
    let at = |along, share: f64| {
        let (first, last) = surface.domain(along);
        (1.0 - share) * first + share * last
    };
    // the first may lie where the normal vanishes
    [0.5, 0.375, 0.71, 0.2]
        .into_iter()
        .map(|share| {
            let (u, v) = (at(Direction::U, share), at(Direction::V, share));
            surface.normal(u, v).normalize_or_zero().dot(direction(surface.point(u, v)).normalize_or_zero())
        })
        .find(|along| along.abs() > 0.5)
        .map(f64::signum)
        .ok_or("the surface has no normal where it was looked for")
}

fn ascending(range: (f64, f64)) -> (f64, f64) {
    (range.0.min(range.1), range.0.max(range.1))
}

/// A shape in the directions and over the domain of the surface that it is the offset of.
fn placed(
    shape: NurbsSurface,
    like: &NurbsSurface,
    profile: (f64, f64),
    sweep: (f64, f64),
    angular: Direction,
) -> Result<Definition, InvalidDefinition> {
    let mut shape = shape;
    if profile.1 < profile.0 {
        shape = shape.reversed(Direction::U);
    }
    if sweep.1 < sweep.0 {
        shape = shape.reversed(Direction::V);
    }
    if angular == Direction::U {
        shape = shape.swapped();
    }
    for direction in [Direction::U, Direction::V] {
        let (first, last) = like.domain(direction);
        shape = shape.with_domain(direction, first, last)?;
    }
    Ok(shape.into())
}
