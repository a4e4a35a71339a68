//! Closed forms: the nearest point of a shape whose class is known.
//!
//! Everything is reduced to plane curves: [`planar`] curves to themselves, surfaces that are [`turned`] about an axis to their profile in a half plane, those that are
//! [`extruded`] to their profile across the vector. A [`profile`] is a segment, an [`arc`], an elliptic arc ([`ellipse`]) or, of general revolutions and
//! extrusions, a plane NURBS curve with its own certified solver. The foot's parameters are the roots of univariate forms ([`inverse`]).
//!
//! # Proof
//!
//! Every point of the definition lies within the proven gap of the shape within its ranges, so that no point of it is nearer than the shape's distance less that gap. The
//! shape's distance is computed with an error of at most `34 u |q| + 64 u B`, where `q` is the query from the shape's origin and `B` the entity's size and
//! largest radius: entering the axes costs `10 u |q|` (a subtraction, three scalar products, axes that are orthonormal to `4 u`), a ray of a
//! sector `8 u |q| + 16 u B`, an arc's axes `3 u |q|` and its own ray as much again, and the last norm `2 u |q|`. The origin itself is rounded, and the axes of a record are
//! orthonormal to a few ulps only: `4 ε` of its coordinates and `16 ε B` more. The parameters need no proof: where they are off, the
//! definition's own point there is farther than the bound allows.
//!
//! A ruled surface is left to the hierarchy: its distance along the rulings is a function of one variable, but neither a polynomial of low degree nor convex, so
//! that a proof would search pieces of it as the hierarchy does.

mod arc;
mod axes;
mod ellipse;
mod extruded;
mod inverse;
mod net;
mod parallelogram;
mod planar;
mod profile;
mod range;
mod sector;
#[cfg(test)]
mod tests;
mod turned;

use glam::{DVec2, DVec3};
use perpend_kernel::Definition;
use perpend_knowledge::Kind;

use self::axes::{Axes, ROUNDING};
use self::extruded::Extruded;
use self::parallelogram::Parallelogram;
use self::planar::Planar;
use self::profile::Search;
use self::sector::Asked;
use self::turned::{About, Stated, Turned};
use crate::hierarchy::{Frame, Workspace};
use crate::query::{DEFAULT_GAP, Query};
use crate::solver::Tie;
use crate::statistics::Work;

/// The closed form of a shape.
#[derive(Debug)]
pub(crate) struct Analytic {
    shape: Shape,
    axes: Axes,
    /// Bound of the distance between the definition and the shape as it is computed with, in local lengths.
    deviation: f64,
    /// The definition's size in the model's unit.
    size: f64,
    /// Bound of the rounding of a foot's distance beside what grows with the query's.
    rounding: f64,
}

/// To what an entity is reduced.
#[derive(Debug)]
enum Shape {
    Planar(Planar),
    Turned(Turned),
    Extruded(Extruded),
    Parallelogram(Parallelogram),
}

/// A shape as its constructor leaves it.
#[derive(Debug)]
struct Built<S> {
    shape: S,
    axes: Axes,
    /// Bound of what it is off beside the proven gap, in local lengths.
    deviation: f64,
    /// Its largest radius.
    radius: f64,
}

impl<S> Built<S> {
    fn map<T>(self, into: impl FnOnce(S) -> T) -> Built<T> {
        Built { shape: into(self.shape), axes: self.axes, deviation: self.deviation, radius: self.radius }
    }
}

/// A foot with both parameters, in local lengths.
#[derive(Debug, Clone, Copy)]
struct Pair {
    at: DVec2,
    distance: f64,
    unproven: f64,
    tie: Tie,
}

/// A foot as the shape has it, in parameters of the definition.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Proposal {
    pub u: f64,
    pub v: f64,
    /// To the shape, in the model's unit: what the definition has at the foot but for its deviation from the shape.
    pub distance: f64,
    /// Proven: no point of the definition is nearer, in the model's unit.
    pub lower_bound: f64,
    pub tie: Tie,
}

/// Queries farther away than this, in lengths of the entity, are left to the hierarchy: products of four lengths stay finite.
const FARTHEST: f64 = 1e60;

impl Analytic {
    /// The closed form of a definition of this class; `gap` is the proven bound of the distance between the two, both ways. None
    /// where the class has none.
    pub(crate) fn new(definition: &Definition, kind: &Kind, gap: f64) -> Option<Self> {
        let frame = Frame::of(definition);
        let built = build(definition, &frame, kind, gap)?;
        let Built { shape, axes, deviation, radius } = built;
        let bound = radius + 2.0;
        let deviation =
            deviation + axes.local(gap) + 16.0 * f64::EPSILON * bound + 4.0 * f64::EPSILON * axes.local(axes.reach());
        (deviation.is_finite()).then_some(Self {
            shape,
            axes,
            deviation,
            size: frame.size,
            rounding: 64.0 * ROUNDING * bound,
        })
    }

    /// Bound of the distance between the definition and the shape, in the model's unit.
    pub(crate) fn deviation(&self) -> f64 {
        self.deviation / self.axes.local(1.0)
    }

    /// Whether the shape is an ellipse or an arc of one, whose parameter is not known as exactly as its points.
    pub(crate) fn is_elliptic(&self) -> bool {
        matches!(&self.shape, Shape::Planar(planar) if planar.is_elliptic())
    }

    /// The foot that the shape proposes; none where it declines.
    ///
    /// Compiled into its caller, and with it what all arcs and segments need: numbers that are returned through memory are waited for.
    #[inline(always)]
    pub(crate) fn propose(&self, query: &Query, workspace: &mut Workspace, done: &mut Work) -> Option<Proposal> {
        let q = self.axes.enter(query.point);
        let reach = q.length();
        if reach > FARTHEST {
            return None;
        }
        let rounding = 34.0 * ROUNDING * reach + self.rounding;
        let gap = self.axes.local(query.options.gap.unwrap_or(DEFAULT_GAP * self.size));
        let coincidence = self.axes.local(query.options.coincidence.unwrap_or(1e-6 * self.size));
        // the centre itself is known to an ulp of the size at best
        let noise = 2.0 * ROUNDING * (1.0 + self.axes.local(query.point.abs().max_element() + self.axes.reach()));
        let asked = Asked { gap: if gap > rounding { gap } else { rounding }, coincidence, noise, reach };
        let mut search =
            Search { workspace, done, budget: query.options.work, gap: 0.9 * gap - 2.0 * (self.deviation + rounding) };
        let Pair { at, distance, unproven, tie } = match &self.shape {
            Shape::Planar(planar) => {
                let foot = planar.foot(q, &asked, &mut search)?;
                Pair {
                    at: DVec2::new(foot.parameter, 0.0),
                    distance: foot.distance,
                    unproven: foot.unproven,
                    tie: foot.tie,
                }
            }
            Shape::Turned(turned) => turned.foot(q, &asked, &mut search)?,
            Shape::Extruded(extruded) => extruded.foot(q, &asked, &mut search)?,
            Shape::Parallelogram(parallelogram) => parallelogram.foot(q, &asked),
        };
        let lower = distance - unproven - self.deviation - rounding;
        let (distance, lower_bound) = (self.axes.length(distance), self.axes.length(lower.max(0.0)));
        Some(Proposal { u: at.x, v: at.y, distance, lower_bound, tie })
    }
}

fn build(definition: &Definition, frame: &Frame, kind: &Kind, gap: f64) -> Option<Built<Shape>> {
    match (definition, kind) {
        (Definition::NurbsCurve(curve), &Kind::Line { origin, direction, range }) => {
            Planar::line(curve, frame, origin, direction, range).map(|built| built.map(Shape::Planar))
        }
        (Definition::NurbsCurve(curve), &Kind::Circle { centre, axis, xdir, radius, sweep }) => {
            Planar::circle(curve, frame, (centre, axis, xdir), radius, sweep).map(|built| built.map(Shape::Planar))
        }
        (Definition::NurbsCurve(curve), &Kind::Ellipse { centre, axis, xdir, radii, sweep }) => {
            Planar::ellipse(curve, frame, (centre, axis, xdir), radii, sweep).map(|built| built.map(Shape::Planar))
        }
        (Definition::NurbsSurface(surface), &Kind::Plane { origin, normal, sides: Some(sides) }) => {
            parallelogram::parallelogram(surface, frame, (origin, normal), sides, gap)
        }
        (Definition::NurbsSurface(surface), &Kind::Extrusion { vector, along }) => {
            Extruded::new(surface, frame, vector, along, gap).map(|built| built.map(Shape::Extruded))
        }
        (Definition::NurbsSurface(surface), kind) => {
            let (about, stated) = turning(kind, surface)?;
            Turned::new(surface, frame, about, stated, gap).map(|built| built.map(Shape::Turned))
        }
        _ => None,
    }
}

/// What turns about which axis; none for classes that do not turn.
fn turning(kind: &Kind, surface: &perpend_kernel::NurbsSurface) -> Option<(About, Stated)> {
    Some(match *kind {
        Kind::Cylinder { centre, axis, xdir, radius, height, sweep, angular } => (
            About { centre, axis, xdir, sweep, angular },
            Stated::Segment(DVec2::new(radius, height.0), DVec2::new(radius, height.1)),
        ),
        Kind::Cone { apex, axis, xdir, half_angle, height, sweep, angular } => {
            let slope = half_angle.tan();
            let at = |height: f64| DVec2::new(height * slope, height);
            (About { centre: apex, axis, xdir, sweep, angular }, Stated::Segment(at(height.0), at(height.1)))
        }
        Kind::Sphere { centre, axis, xdir, radius, sweep, latitude, angular } => {
            (About { centre, axis, xdir, sweep, angular }, Stated::Arc(DVec2::ZERO, radius, latitude))
        }
        Kind::Torus { centre, axis, xdir, major_radius, minor_radius, sweep, section, angular } => (
            About { centre, axis, xdir, sweep, angular },
            Stated::Arc(DVec2::new(major_radius, 0.0), minor_radius, section),
        ),
        Kind::Revolution { origin, axis, sweep, angular } => {
            // angles count from the profile: from its control point that is farthest from the axis
            let grid = net::Grid::new(surface, angular);
            let across = |p: DVec3| (p - origin) - (p - origin).dot(axis) * axis;
            let arms = (0..grid.count().1).map(|j| across(grid.point(0, j)));
            let xdir = arms.max_by(|a, b| a.length().total_cmp(&b.length()))?;
            (About { centre: origin, axis, xdir: xdir.try_normalize()?, sweep: (0.0, sweep), angular }, Stated::General)
        }
        _ => return None,
    })
}
