//! Distances to bounded shapes, to some 30 digits, by ways of their own: all stationary points are enumerated, edges and corners
//! included, and the least distance counts. No half plane is turned to, no foot is clamped into a range.
//!
//! Every distance is that of a real point of the shape, so it is never too small.

pub mod curve;
mod patch;
mod profile;
pub mod turn;
pub mod vector;

use glam::DVec3;
use perpend::kernel::{extrusion, revolution};
use perpend::{
    Circle, Cone, Cylinder, Definition, Ellipse, Frame, IntoDefinition, Kind, Line, NurbsCurve, NurbsSurface, Sphere,
    Torus,
};

use self::curve::{Arc, least, to_segment};
use self::patch::Patch;
use self::turn::Range;
use self::vector::{Axes, Vector};
use super::double_double::Dd;
use super::shape::Shape;

/// A bounded shape, by the numbers of which it is made.
#[derive(Debug, Clone)]
pub enum Exact {
    Segment { a: DVec3, b: DVec3 },
    Circle { frame: Frame, radius: f64, sweep: (f64, f64) },
    Ellipse { frame: Frame, radii: (f64, f64), sweep: (f64, f64) },
    Parallelogram { corner: DVec3, a: DVec3, b: DVec3 },
    Cylinder { frame: Frame, radius: f64, height: (f64, f64), sweep: (f64, f64) },
    Cone { frame: Frame, radii: (f64, f64), height: (f64, f64), sweep: (f64, f64) },
    Sphere { frame: Frame, radius: f64, latitude: (f64, f64), sweep: (f64, f64) },
    Torus { frame: Frame, major: f64, minor: f64, tube: (f64, f64), sweep: (f64, f64) },
    Extrusion { profile: Shape, vector: DVec3 },
    Revolution { profile: Shape, origin: DVec3, axis: DVec3, sweep: f64 },
}

impl Exact {
    /// The name of its class.
    pub fn class(&self) -> &'static str {
        match self {
            Self::Segment { .. } => "Line",
            Self::Circle { .. } => "Circle",
            Self::Ellipse { .. } => "Ellipse",
            Self::Parallelogram { .. } => "Plane",
            Self::Cylinder { .. } => "Cylinder",
            Self::Cone { .. } => "Cone",
            Self::Sphere { .. } => "Sphere",
            Self::Torus { .. } => "Torus",
            Self::Extrusion { .. } => "Extrusion",
            Self::Revolution { .. } => "Revolution",
        }
    }

    /// The distance from `p`, rounded once.
    pub fn distance(&self, p: DVec3) -> f64 {
        let about = |frame: &Frame| {
            let axes = Axes::new(frame.centre, frame.axis, frame.xdir);
            Vector(axes.coordinates(p))
        };
        let arc = |radii: (f64, f64), sweep| {
            let [x, y] = [DVec3::X, DVec3::Y].map(Vector::from);
            Arc { centre: Vector::ZERO, x, y, radii: [radii.0.into(), radii.1.into()], range: Range::new(sweep) }
        };
        let distance = match self {
            Self::Segment { a, b } => to_segment(Vector::between(*a, p), Vector::ZERO, Vector::between(*a, *b)),
            Self::Circle { frame, radius, sweep } => arc((*radius, *radius), *sweep).distance_of_circle(about(frame)),
            Self::Ellipse { frame, radii, sweep } => arc(*radii, *sweep).distance_of_ellipse(about(frame)),
            Self::Parallelogram { corner, a, b } => to_parallelogram(Vector::between(*corner, p), *a, *b),
            Self::Cylinder { frame, radius, height, sweep } => {
                Patch::ruled((*radius, *radius), *height, *sweep).distance(about(frame))
            }
            Self::Cone { frame, radii, height, sweep } => Patch::ruled(*radii, *height, *sweep).distance(about(frame)),
            Self::Sphere { frame, radius, latitude, sweep } => {
                Patch::round(0.0, *radius, *latitude, *sweep).distance(about(frame))
            }
            Self::Torus { frame, major, minor, tube, sweep } => {
                Patch::round(*major, *minor, *tube, *sweep).distance(about(frame))
            }
            Self::Extrusion { profile, vector } => profile::of_extrusion(profile, *vector, p),
            Self::Revolution { profile, origin, axis, sweep } => {
                let axis = Vector::from(*axis).unit().expect("an axis");
                profile::of_revolution(profile, *origin, axis, *sweep, p)
            }
        };
        distance.value()
    }

    /// The definition as the kernel makes it, and the class with which it would enter a model; none for free-form profiles.
    pub fn made(&self) -> (Definition, Option<Kind>) {
        let entered = match self.clone() {
            Self::Segment { a, b } => Line::new(a, b).expect("valid").enter(),
            Self::Circle { frame, radius, sweep } => Circle::new(frame, radius, sweep).expect("valid").enter(),
            Self::Ellipse { frame, radii, sweep } => Ellipse::new(frame, radii, sweep).expect("valid").enter(),
            Self::Parallelogram { corner, a, b } => return parallelogram(corner, a, b),
            Self::Cylinder { frame, radius, height, sweep } => {
                Cylinder::new(frame, radius, height, sweep).expect("valid").enter()
            }
            Self::Cone { frame, radii, height, sweep } => {
                Cone::new(frame, radii, height, sweep).expect("valid").enter()
            }
            Self::Sphere { frame, radius, latitude, sweep } => {
                Sphere::new(frame, radius, latitude, sweep).expect("valid").enter()
            }
            Self::Torus { frame, major, minor, tube, sweep } => {
                Torus::new(frame, major, minor, tube, sweep).expect("valid").enter()
            }
            Self::Extrusion { profile, vector } => {
                return (extrusion(&curve(&profile), vector).expect("valid").into(), None);
            }
            Self::Revolution { profile, origin, axis, sweep } => {
                let turned = revolution(&curve(&profile), origin, axis, sweep);
                return (turned.expect("valid").into(), None);
            }
        };
        let entered = entered.expect("valid");
        (entered.definition, entered.kind)
    }

    /// The largest |coordinate| among the numbers of which it is made: what its rounding is measured by.
    pub fn reach(&self) -> f64 {
        let frame = |frame: &Frame, extent: f64| frame.centre.abs().max_element() + extent;
        let far = |range: (f64, f64)| range.0.abs().max(range.1.abs());
        match self {
            Self::Segment { a, b } => a.abs().max(b.abs()).max_element(),
            Self::Circle { frame: f, radius, .. } | Self::Sphere { frame: f, radius, .. } => frame(f, *radius),
            Self::Ellipse { frame: f, radii, .. } => frame(f, far(*radii)),
            Self::Parallelogram { corner, a, b } => (corner.abs() + a.abs() + b.abs()).max_element(),
            Self::Cylinder { frame: f, radius, height, .. } => frame(f, radius.max(far(*height))),
            Self::Cone { frame: f, radii, height, .. } => frame(f, far(*radii).max(far(*height))),
            Self::Torus { frame: f, major, minor, .. } => frame(f, major + minor),
            Self::Extrusion { profile, vector } => profile.reach() + vector.abs().max_element(),
            Self::Revolution { profile, origin, .. } => profile.reach() + 2.0 * origin.abs().max_element(),
        }
    }
}

fn curve(profile: &Shape) -> NurbsCurve {
    match profile.definition() {
        Definition::NurbsCurve(curve) => curve,
        Definition::NurbsSurface(_) => panic!("a profile is a curve"),
    }
}

fn parallelogram(corner: DVec3, a: DVec3, b: DVec3) -> (Definition, Option<Kind>) {
    let knots = || vec![0.0, 0.0, 1.0, 1.0];
    let points = vec![vec![corner, corner + b], vec![corner + a, corner + a + b]];
    let surface = NurbsSurface::new((1, 1), (knots(), knots()), points, None).expect("valid");
    let kind = Kind::Plane { origin: corner, normal: a.cross(b).normalize(), sides: Some((a, b)) };
    (surface.into(), Some(kind))
}

fn to_parallelogram(p: Vector, a: DVec3, b: DVec3) -> Dd {
    let (a, b) = (Vector::from(a), Vector::from(b));
    let far = a.plus(b);
    let edges = [(Vector::ZERO, a), (Vector::ZERO, b), (a, far), (b, far)].map(|(from, to)| to_segment(p, from, to));
    // the foot on the plane, by Cramer's rule for the shares of the sides
    let (aa, ab, bb, pa, pb) = (a.dot(a), a.dot(b), b.dot(b), p.dot(a), p.dot(b));
    let determinant = aa * bb - ab * ab;
    let (s, t) = ((pa * bb - pb * ab) / determinant, (pb * aa - pa * ab) / determinant);
    let inside = |share: Dd| share > Dd::ZERO && share < Dd::ONE;
    if inside(s) && inside(t) {
        return least([least(edges), p.minus(a.times(s).plus(b.times(t))).length()]);
    }
    least(edges)
}
