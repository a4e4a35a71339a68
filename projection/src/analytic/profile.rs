//! Plane curves: what everything is reduced to.

use glam::{DVec2, DVec3};
use perpend_kernel::{Definition, KnotVector, NurbsCurve};
use perpend_knowledge::{Basis, Kind, default_tolerance, recognise};

use super::arc::{Arc, Place};
use super::ellipse::EllipticArc;
use super::range::Range;
use super::sector::Asked;
use crate::hierarchy::{Hierarchy, Workspace};
use crate::landmarks::Landmarks;
use crate::query::{Query, QueryOptions};
use crate::solver::Tie;
use crate::statistics::Work;

/// A curve in a plane.
#[derive(Debug)]
pub(super) enum Profile {
    Segment(Segment),
    Arc(Arc),
    EllipticArc(Box<EllipticArc>),
    /// None of these: the certified solver of the curve itself.
    Curve(Box<Hierarchy>),
}

/// The nearest point of a profile.
#[derive(Debug, Clone, Copy)]
pub(super) struct Foot {
    pub parameter: f64,
    /// Of the query from the point, what is beside the plane included.
    pub distance: f64,
    /// How far the proven distance may be below, rounding of the common steps aside.
    pub unproven: f64,
    /// The point's first coordinate.
    pub x: f64,
    pub tie: Tie,
}

/// A curve's control points in the plane, with their weights.
#[derive(Debug)]
pub(super) struct Net {
    pub knots: KnotVector,
    pub points: Vec<(DVec2, f64)>,
}

/// Working memory.
pub(super) struct Search<'a> {
    pub workspace: &'a mut Workspace,
    pub done: &'a mut Work,
    /// How often a query may split.
    pub budget: u32,
    /// The gap that is left for a profile that is searched.
    pub gap: f64,
}

/// A straight segment.
#[derive(Debug)]
pub(super) struct Segment {
    middle: DVec2,
    along: DVec2,
    range: Range,
}

impl Segment {
    /// The segment of `half` to both sides of its middle, in the direction in which the net runs.
    pub(super) fn new(middle: DVec2, along: DVec2, half: f64, net: &Net) -> Option<Self> {
        let lengths = net.points.iter().map(|(p, w)| ((*p - middle).dot(along), *w));
        Some(Self { middle, along, range: Range::new(half, &net.knots, lengths)? })
    }

    fn foot(&self, q: DVec2, beside: f64, asked: &Asked) -> Foot {
        let arm = q - self.middle;
        let clamped = self.range.clamp(arm.dot(self.along), asked.tolerance());
        let across = self.along.perp_dot(arm);
        Foot {
            parameter: clamped.parameter,
            distance: (across * across + clamped.outside * clamped.outside + beside).sqrt(),
            unproven: 0.0,
            x: self.middle.x + clamped.at * self.along.x,
            tie: Tie::None,
        }
    }
}

impl Asked {
    /// What rounding may have moved a foot along a straight line by.
    pub(super) fn tolerance(&self) -> f64 {
        8.0 * super::axes::ROUNDING * (1.0 + self.reach)
    }
}

impl Profile {
    /// The nearest point to `q`, which is `beside` the plane (a squared length). None where the search of a general curve leaves more open
    /// than asked, or a case of an ellipse is in doubt.
    #[inline(always)]
    pub(super) fn foot(&self, q: DVec2, beside: f64, asked: &Asked, search: &mut Search<'_>) -> Option<Foot> {
        match self {
            Self::Segment(segment) => Some(segment.foot(q, beside, asked)),
            Self::Arc(arc) => Some(arc.foot(q, beside, asked)),
            Self::EllipticArc(arc) => arc.foot(q, beside, asked),
            Self::Curve(hierarchy) => searched(hierarchy, q, beside, asked, search),
        }
    }

    /// The profile that a general net makes, in closed form where its class has one; with the bound of its distance from that, and of the largest
    /// radius that was used.
    pub(super) fn of(net: &Net) -> Option<(Self, f64, f64)> {
        let points = net.points.iter().map(|(p, _)| p.extend(0.0)).collect();
        let weights = net.points.iter().map(|(_, w)| *w).collect();
        let knots = net.knots.as_slice().to_vec();
        let curve = NurbsCurve::new(net.knots.degree(), knots, points, Some(weights)).ok()?;
        let definition = Definition::from(curve);
        let kind = recognise(&definition, default_tolerance(&definition));
        if let Basis::Proved { gap } = kind.basis
            && let Some((profile, radius)) = closed(&kind.value, net)
        {
            return Some((profile, gap, radius));
        }
        let cusps = Landmarks::of(&definition).cusps;
        Some((Self::Curve(Box::new(Hierarchy::new(&definition, &cusps))), 0.0, 0.0))
    }
}

/// The closed form of a plane curve's class, and its largest radius.
fn closed(kind: &Kind, net: &Net) -> Option<(Profile, f64)> {
    let flat = |p: DVec3| p.truncate();
    match *kind {
        Kind::Line { origin, direction, range } => {
            let along = flat(direction).try_normalize()?;
            let (low, high) = (range.0.min(range.1), range.0.max(range.1));
            let along = if range.1 < range.0 { -along } else { along };
            let middle = flat(origin) + 0.5 * (range.0 + range.1) * flat(direction);
            Some((Profile::Segment(Segment::new(middle, along, 0.5 * (high - low), net)?), 0.0))
        }
        Kind::Circle { centre, axis, xdir, radius, sweep } => {
            let place = Place { centre: flat(centre), x: flat(xdir), y: flat(axis.cross(xdir)), radius, sweep };
            Some((Profile::Arc(Arc::new(place, None, &net.knots, net.points.iter().copied())?), radius))
        }
        Kind::Ellipse { centre, axis, xdir, radii, sweep } => {
            let place = Place { centre: flat(centre), x: flat(xdir), y: flat(axis.cross(xdir)), radius: 1.0, sweep };
            let arc = EllipticArc::new(place, radii, &net.knots, net.points.iter().copied())?;
            Some((Profile::EllipticArc(Box::new(arc)), radii.0.max(radii.1)))
        }
        _ => None,
    }
}

/// The nearest point of a general curve by its own certified solver.
#[inline(never)]
fn searched(hierarchy: &Hierarchy, q: DVec2, beside: f64, asked: &Asked, search: &mut Search<'_>) -> Option<Foot> {
    if search.gap <= 0.0 {
        return None;
    }
    let options = QueryOptions {
        gap: Some(search.gap),
        coincidence: Some(asked.coincidence),
        work: search.budget,
        ..QueryOptions::default()
    };
    let query = Query::new(q.extend(0.0), options).ok()?;
    let found = hierarchy.project(&query, None, search.workspace)?;
    *search.done += found.done;
    let solution = hierarchy.in_model_units(&found);
    let (distance, bound) = (solution.distance, solution.lower_bound);
    let whole = (distance * distance + beside).sqrt();
    let proven = (bound * bound + beside).sqrt();
    Some(Foot {
        parameter: solution.u,
        distance: whole,
        unproven: whole - proven,
        x: q.x + solution.offset.x,
        tie: solution.tie,
    })
}
