//! Points, curves and surfaces as entities.

use std::io::{self, Write};

use glam::DVec3;
use perpend::{Definition, Direction, Kind, KnotVector, NurbsCurve, NurbsSurface};

use super::text::{Id, Text, list, real};

/// A surface with a name in the standard, and its outward normal there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Analytic {
    Plane {
        origin: DVec3,
        axis: DVec3,
        xdir: DVec3,
    },
    Cylinder {
        centre: DVec3,
        axis: DVec3,
        xdir: DVec3,
        radius: f64,
    },
    /// `radius` in the plane of `centre`; it grows along the axis.
    Cone {
        centre: DVec3,
        axis: DVec3,
        xdir: DVec3,
        radius: f64,
        half_angle: f64,
    },
    Sphere {
        centre: DVec3,
        axis: DVec3,
        xdir: DVec3,
        radius: f64,
    },
    Torus {
        centre: DVec3,
        axis: DVec3,
        xdir: DVec3,
        major: f64,
        minor: f64,
    },
}

/// The direction of an angle about an axis. The standard's surfaces have their seam at angle 0, so this is put where a surface starts.
fn turned(axis: DVec3, xdir: DVec3, angle: f64) -> DVec3 {
    if angle == 0.0 { xdir } else { angle.cos() * xdir + angle.sin() * axis.cross(xdir) }
}

impl Analytic {
    /// The analytic form of a class, where the standard has one whose seams lie where the surface has its own.
    pub(super) fn of(kind: &Kind) -> Option<Self> {
        Some(match *kind {
            Kind::Plane { origin, normal, sides } => {
                let xdir = sides.map_or_else(|| normal.any_orthonormal_vector(), |(side, _)| side.normalize());
                Self::Plane { origin, axis: normal, xdir }
            }
            Kind::Cylinder { centre, axis, xdir, radius, sweep, .. } => {
                Self::Cylinder { centre, axis, xdir: turned(axis, xdir, sweep.0), radius }
            }
            Kind::Cone { apex, axis, xdir, half_angle, height, sweep, .. } => {
                let first = height.0.min(height.1);
                Self::Cone {
                    centre: apex + first * axis,
                    axis,
                    xdir: turned(axis, xdir, sweep.0),
                    radius: first * half_angle.tan(),
                    half_angle,
                }
            }
            Kind::Sphere { centre, axis, xdir, radius, sweep, .. } => {
                Self::Sphere { centre, axis, xdir: turned(axis, xdir, sweep.0), radius }
            }
            Kind::Torus { centre, axis, xdir, major_radius, minor_radius, sweep, section, .. } => {
                let whole = (section.1 - section.0).abs() > std::f64::consts::TAU * (1.0 - 1e-9);
                if whole && section.0.abs() > 1e-12 {
                    return None;
                }
                let xdir = turned(axis, xdir, sweep.0);
                Self::Torus { centre, axis, xdir, major: major_radius, minor: minor_radius }
            }
            _ => return None,
        })
    }

    /// The direction of the standard's normal at a point of the surface, of any length.
    pub(super) fn normal(&self, at: DVec3) -> DVec3 {
        let across = |centre: DVec3, axis: DVec3| {
            let from = at - centre;
            from - from.dot(axis) * axis
        };
        match *self {
            Self::Plane { axis, .. } => axis,
            Self::Cylinder { centre, axis, .. } => across(centre, axis),
            Self::Cone { centre, axis, half_angle, .. } => {
                across(centre, axis).normalize_or_zero() - half_angle.tan() * axis
            }
            Self::Sphere { centre, .. } => at - centre,
            Self::Torus { centre, axis, major, .. } => at - (centre + major * across(centre, axis).normalize_or_zero()),
        }
    }

    pub(super) fn write<W: Write>(&self, text: &mut Text<W>) -> io::Result<Id> {
        match *self {
            Self::Plane { origin, axis, xdir } => {
                let place = placement(text, origin, axis, xdir)?;
                text.add(format_args!("PLANE('',{place})"))
            }
            Self::Cylinder { centre, axis, xdir, radius } => {
                let place = placement(text, centre, axis, xdir)?;
                text.add(format_args!("CYLINDRICAL_SURFACE('',{place},{})", real(radius)))
            }
            Self::Cone { centre, axis, xdir, radius, half_angle } => {
                let place = placement(text, centre, axis, xdir)?;
                text.add(format_args!("CONICAL_SURFACE('',{place},{},{})", real(radius), real(half_angle)))
            }
            Self::Sphere { centre, axis, xdir, radius } => {
                let place = placement(text, centre, axis, xdir)?;
                text.add(format_args!("SPHERICAL_SURFACE('',{place},{})", real(radius)))
            }
            Self::Torus { centre, axis, xdir, major, minor } => {
                let place = placement(text, centre, axis, xdir)?;
                text.add(format_args!("TOROIDAL_SURFACE('',{place},{},{})", real(major), real(minor)))
            }
        }
    }
}

pub(super) fn point<W: Write>(text: &mut Text<W>, DVec3 { x, y, z }: DVec3) -> io::Result<Id> {
    text.add(format_args!("CARTESIAN_POINT('',({},{},{}))", real(x), real(y), real(z)))
}

fn direction<W: Write>(text: &mut Text<W>, DVec3 { x, y, z }: DVec3) -> io::Result<Id> {
    text.add(format_args!("DIRECTION('',({},{},{}))", real(x), real(y), real(z)))
}

pub(super) fn placement<W: Write>(text: &mut Text<W>, origin: DVec3, axis: DVec3, xdir: DVec3) -> io::Result<Id> {
    let (origin, axis, xdir) = (point(text, origin)?, direction(text, axis)?, direction(text, xdir)?);
    text.add(format_args!("AXIS2_PLACEMENT_3D('',{origin},{axis},{xdir})"))
}

/// The curve of an edge: a line, a circle or an ellipse where it is proved to be one, else as it is defined. It runs as the curve does.
pub(super) fn edge_curve<W: Write>(text: &mut Text<W>, curve: &NurbsCurve, kind: &Kind) -> io::Result<Id> {
    match *kind {
        Kind::Line { .. } => {
            let (from, to) = (curve.point(curve.domain().0), curve.point(curve.domain().1));
            let (along, length) = (to - from).normalize_and_length();
            let (from, along) = (point(text, from)?, direction(text, along)?);
            let vector = text.add(format_args!("VECTOR('',{along},{})", real(length)))?;
            text.add(format_args!("LINE('',{from},{vector})"))
        }
        Kind::Circle { centre, axis, xdir, radius, sweep } => {
            let place = turning(text, (centre, axis, xdir), sweep)?;
            text.add(format_args!("CIRCLE('',{place},{})", real(radius)))
        }
        Kind::Ellipse { centre, axis, xdir, radii, sweep } => {
            let place = turning(text, (centre, axis, xdir), sweep)?;
            text.add(format_args!("ELLIPSE('',{place},{},{})", real(radii.0), real(radii.1)))
        }
        _ => spline_curve(text, curve),
    }
}

/// The placement of a conic about which angles run as the sweep does.
fn turning<W: Write>(
    text: &mut Text<W>,
    (centre, axis, xdir): (DVec3, DVec3, DVec3),
    sweep: (f64, f64),
) -> io::Result<Id> {
    placement(text, centre, if sweep.1 >= sweep.0 { axis } else { -axis }, xdir)
}

/// A free curve: an analytic one between its ends, or as it is defined.
pub(super) fn free_curve<W: Write>(text: &mut Text<W>, curve: &NurbsCurve, kind: &Kind) -> io::Result<Id> {
    let basis = edge_curve(text, curve, kind)?;
    let (from, to) = match *kind {
        Kind::Line { .. } => (0.0, 1.0),
        Kind::Circle { sweep, .. } | Kind::Ellipse { sweep, .. } if sweep.1 >= sweep.0 => sweep,
        // about the opposite axis
        Kind::Circle { sweep, .. } | Kind::Ellipse { sweep, .. } => (-sweep.0, -sweep.1),
        _ => return Ok(basis),
    };
    text.add(format_args!(
        "TRIMMED_CURVE('',{basis},(PARAMETER_VALUE({})),(PARAMETER_VALUE({})),.T.,.PARAMETER.)",
        real(from),
        real(to)
    ))
}

/// Multiplicities and distinct knots.
fn knots(knots: &KnotVector) -> (String, String) {
    let distinct: Vec<(f64, usize)> = knots.distinct().collect();
    (list(&distinct, |(_, multiplicity)| multiplicity.to_string()), list(&distinct, |(knot, _)| real(*knot)))
}

fn logical(value: bool) -> &'static str {
    if value { ".T." } else { ".F." }
}

pub(super) fn spline_curve<W: Write>(text: &mut Text<W>, curve: &NurbsCurve) -> io::Result<Id> {
    let net = curve.control_points();
    let points = net.iter().map(|p| point(text, *p)).collect::<io::Result<Vec<Id>>>()?;
    let (degree, points) = (curve.degree(), list(points, |id| id.to_string()));
    let closed = logical(net[0] == net[net.len() - 1]);
    let (multiplicities, knots) = knots(curve.knots());
    match curve.weights() {
        None => text.add(format_args!(
            "B_SPLINE_CURVE_WITH_KNOTS('',{degree},{points},.UNSPECIFIED.,{closed},.U.,{multiplicities},{knots},.UNSPECIFIED.)"
        )),
        Some(weights) => {
            let weights = list(weights, |w| real(*w));
            text.add(format_args!(
                "(BOUNDED_CURVE()B_SPLINE_CURVE({degree},{points},.UNSPECIFIED.,{closed},.U.)\
                 B_SPLINE_CURVE_WITH_KNOTS({multiplicities},{knots},.UNSPECIFIED.)CURVE()GEOMETRIC_REPRESENTATION_ITEM()\
                 RATIONAL_B_SPLINE_CURVE({weights})REPRESENTATION_ITEM(''))"
            ))
        }
    }
}

pub(super) fn spline_surface<W: Write>(text: &mut Text<W>, surface: &NurbsSurface) -> io::Result<Id> {
    let columns = surface.columns();
    let net = surface.control_points();
    let points = net.iter().map(|p| point(text, *p)).collect::<io::Result<Vec<Id>>>()?;
    let points = list(points.chunks(columns), |row| list(row, Id::to_string));
    let (p, q) = surface.degree();
    let closed_u = logical(net[..columns] == net[net.len() - columns..]);
    let closed_v = logical(net.chunks(columns).all(|row| row[0] == row[columns - 1]));
    let (along_u, knots_u) = knots(surface.knots(Direction::U));
    let (along_v, knots_v) = knots(surface.knots(Direction::V));
    match surface.weights() {
        None => text.add(format_args!(
            "B_SPLINE_SURFACE_WITH_KNOTS('',{p},{q},{points},.UNSPECIFIED.,{closed_u},{closed_v},.U.,{along_u},{along_v},\
             {knots_u},{knots_v},.UNSPECIFIED.)"
        )),
        Some(weights) => {
            let weights = list(weights.chunks(columns), |row| list(row, |w| real(*w)));
            text.add(format_args!(
                "(BOUNDED_SURFACE()B_SPLINE_SURFACE({p},{q},{points},.UNSPECIFIED.,{closed_u},{closed_v},.U.)\
                 B_SPLINE_SURFACE_WITH_KNOTS({along_u},{along_v},{knots_u},{knots_v},.UNSPECIFIED.)\
                 GEOMETRIC_REPRESENTATION_ITEM()RATIONAL_B_SPLINE_SURFACE({weights})REPRESENTATION_ITEM('')SURFACE())"
            ))
        }
    }
}

/// The class that is known of a definition and proved here within rounding; where none is, the one that is recognised; otherwise free form.
pub(super) fn known_kind(record: Option<&perpend::Record>, definition: &Definition) -> Kind {
    let tolerance = perpend::knowledge::default_tolerance(definition);
    let item = record.and_then(|record| record.classification.as_ref()?.kind.as_ref());
    match item.filter(|item| perpend::knowledge::prove(&item.value, definition, tolerance).is_ok()) {
        Some(item) => item.value.clone(),
        None => perpend::knowledge::recognise(definition, tolerance).value,
    }
}
