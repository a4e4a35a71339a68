//! Closed forms and their proof: the foot that the shape proposes, the definition evaluated there, and the bound of the shape.

use std::sync::Arc;

use glam::DVec3;
use perpend_kernel::{Definition, Direction, NurbsCurve, NurbsSurface};

use crate::analytic::{Analytic, Proposal};
use crate::answer::Method;
use crate::query::{DEFAULT_GAP, Query};
use crate::scratch::Scratch;
use crate::solver::{Solution, Solved, Solver, unit_normal};

/// What rounding may leave between a distance and its bound beside the gap, in ulps of the largest coordinate in play: what an answer
/// calls certified.
const ROUNDING: f64 = 32.0 * f64::EPSILON;

/// Nearer to the border of the domain than this share of it, a foot may be on it but for rounding.
const NEAR_BORDER: f64 = 1e-6;

/// The closed form of a definition whose class is known and proved.
#[derive(Debug)]
pub(crate) struct ClosedForm {
    analytic: Analytic,
    definition: Arc<Definition>,
    size: f64,
    reach: f64,
    /// In u and in v; of a surface.
    borders: [Border; 2],
    has_one_minimum: bool,
}

/// Where the domain ends in a direction, and the parameters between which nothing is near its ends.
#[derive(Debug, Clone, Copy, Default)]
struct Border {
    first: f64,
    low: f64,
    high: f64,
    last: f64,
}

impl Border {
    fn of((first, last): (f64, f64)) -> Self {
        let near = NEAR_BORDER * (last - first);
        Self { first, low: first + near, high: last - near, last }
    }
}

impl ClosedForm {
    pub(crate) fn new(analytic: Analytic, definition: &Arc<Definition>, has_one_minimum: bool) -> Self {
        let (size, reach) = (definition.size(), definition.reach());
        let borders = match &**definition {
            Definition::NurbsCurve(_) => Default::default(),
            Definition::NurbsSurface(surface) => {
                [Direction::U, Direction::V].map(|along| Border::of(surface.domain(along)))
            }
        };
        Self { analytic, definition: Arc::clone(definition), size, reach, borders, has_one_minimum }
    }

    /// Whether the whole shape, of which the definition is a part, has one local minimum of the distance at most, but for points from which a circle
    /// or all of it is equally near.
    pub(crate) fn has_one_minimum(&self) -> bool {
        self.has_one_minimum
    }

    /// Bound of the distance between the definition and the shape, both ways, in the model's unit.
    pub(crate) fn deviation(&self) -> f64 {
        self.analytic.deviation()
    }

    /// The definition at a proposal's parameters, seen from the query.
    #[inline]
    fn evaluate(&self, query: &Query, proposal: &Proposal) -> Solution {
        let &Proposal { mut u, mut v, distance: promised, lower_bound, tie } = proposal;
        let p = query.point;
        let ulp = f64::EPSILON * self.reach;
        let (point, normal) = match &*self.definition {
            Definition::NurbsCurve(curve) if self.analytic.is_elliptic() => {
                let point;
                (u, point) = polished(curve, u, p, ulp);
                (point, DVec3::ZERO)
            }
            Definition::NurbsCurve(curve) => (curve.point(u), DVec3::ZERO),
            Definition::NurbsSurface(surface) => {
                let mut d = [DVec3::ZERO; 4];
                surface.derivatives(u, v, 1, &mut d);
                // a step is tried only where the point is farther than the shape: most are not
                let far = promised + 2.0 * ulp;
                if d[0].distance_squared(p) > far * far || self.near_border(u, v) {
                    (u, v) = self.settled(surface, (u, v), &mut d, p, far);
                }
                (d[0], unit_normal(d[2], d[1]))
            }
        };
        let offset = point - p;
        let distance = offset.length();
        let lower_bound = if lower_bound < distance { lower_bound } else { distance };
        Solution { u, v, point: Some(point), distance, lower_bound, normal, offset, tie }
    }

    /// Whether parameters lie within [`NEAR_BORDER`] of the border of the domain, and not on it in both directions.
    #[inline]
    fn near_border(&self, u: f64, v: f64) -> bool {
        let near = |at: f64, border: &Border| {
            let inside = at >= border.low && at <= border.high;
            !inside && at != border.first && at != border.last
        };
        near(u, &self.borders[0]) || near(v, &self.borders[1])
    }

    /// The parameters of a foot that is farther than `far`, where a step leads nearer, or that lies beside the border; with the derivatives there.
    #[inline(never)]
    fn settled(
        &self,
        surface: &NurbsSurface,
        (mut u, mut v): (f64, f64),
        d: &mut [DVec3; 4],
        p: DVec3,
        far: f64,
    ) -> (f64, f64) {
        let ulp = f64::EPSILON * self.reach;
        if d[0].distance(p) > far
            && let Some(better) = polished_on(surface, (u, v), d, p, ulp)
        {
            ((u, v), *d) = better;
        }
        let border = self.on_border(surface, u, v);
        if border != (u, v) {
            (u, v) = border;
            surface.derivatives(u, v, 1, d);
        }
        (u, v)
    }

    /// The parameters on the border of the domain where they lie beside it by no more than rounding of the model's coordinates: a foot beside a
    /// pole or an edge is told from one on it by less than that.
    fn on_border(&self, surface: &NurbsSurface, u: f64, v: f64) -> (f64, f64) {
        let border = |at: f64, border: &Border| match at {
            at if at < border.low => border.first,
            at if at > border.high => border.last,
            at => at,
        };
        let there = (border(u, &self.borders[0]), border(v, &self.borders[1]));
        if there == (u, v) {
            return there;
        }
        let moved = surface.point(u, v).distance(surface.point(there.0, there.1));
        if moved <= 4.0 * f64::EPSILON * self.reach { there } else { (u, v) }
    }
}

/// The foot's parameter after a step of Gauss and Newton on the curve, where that is nearer by more than rounding, an `ulp` of the
/// coordinates; with the point there.
///
/// The angle on a flat ellipse is known to rounding of the larger half-axis over the smaller one; its points can be had to rounding.
fn polished(curve: &NurbsCurve, u: f64, p: DVec3, ulp: f64) -> (f64, DVec3) {
    let mut d = [DVec3::ZERO; 2];
    curve.derivatives(u, &mut d);
    let (first, last) = curve.domain();
    let step = (d[0] - p).dot(d[1]) / d[1].length_squared();
    let next = (u - step).clamp(first, last);
    if step.is_finite() && next != u {
        let point = curve.point(next);
        if point.distance(p) + 2.0 * ulp < d[0].distance(p) {
            return (next, point);
        }
    }
    (u, d[0])
}

/// As [`polished`], on a surface whose derivatives at `(u, v)` are `d`: none where the step promises no more than rounding or does not
/// keep the promise.
///
/// The parameters of a profile that is flat as seen along the vector of its extrusion are not known as exactly as its points, nor is
/// an angle beside a pole.
fn polished_on(
    surface: &NurbsSurface,
    (u, v): (f64, f64),
    d: &[DVec3; 4],
    p: DVec3,
    ulp: f64,
) -> Option<((f64, f64), [DVec3; 4])> {
    let (arm, along_u, along_v) = (d[0] - p, d[2], d[1]);
    let (a, b, c) = (along_u.length_squared(), along_u.dot(along_v), along_v.length_squared());
    let (g, h) = (arm.dot(along_u), arm.dot(along_v));
    let determinant = a * c - b * b;
    let (du, dv) = ((b * h - c * g) / determinant, (b * g - a * h) / determinant);
    // the square of the distance falls by this
    let promise = -(g * du + h * dv);
    let distance = arm.length();
    let promised = (distance * distance - promise).max(0.0).sqrt();
    if promised.is_nan() || promised + 2.0 * ulp >= distance {
        return None;
    }
    let ((first_u, last_u), (first_v, last_v)) = (surface.domain(Direction::U), surface.domain(Direction::V));
    // where an edge stops one parameter, the other has its own least value
    let stopped = |t: f64, step: f64, first: f64, last: f64| (t + step).clamp(first, last) - t;
    let (to_u, to_v) = (stopped(u, du, first_u, last_u), stopped(v, dv, first_v, last_v));
    let (to_u, to_v) = match (to_u == (u + du) - u, to_v == (v + dv) - v) {
        (false, true) => (to_u, -(h + b * to_u) / c),
        (true, false) => (-(g + b * to_v) / a, to_v),
        _ => (to_u, to_v),
    };
    let next = ((u + to_u).clamp(first_u, last_u), (v + to_v).clamp(first_v, last_v));
    let mut there = [DVec3::ZERO; 4];
    surface.derivatives(next.0, next.1, 1, &mut there);
    (there[0].distance(p) + 2.0 * ulp < distance).then_some((next, there))
}

impl Solver for ClosedForm {
    fn method(&self) -> Method {
        Method::Analytic
    }

    /// Declines where the shape's proven gap is wider than what is asked, or where the foot's parameter is not to be had as exactly.
    #[inline]
    fn solve(&self, query: &Query, _hint: Option<DVec3>, scratch: &mut Scratch) -> Solved {
        let Some(proposal) = self.analytic.propose(query, &mut scratch.hierarchy, &mut scratch.statistics.proposal)
        else {
            return Solved::Declined;
        };
        let solution = self.evaluate(query, &proposal);
        scratch.statistics.proposal.evaluations += 1;
        let limit = query.options.max_distance.unwrap_or(f64::INFINITY);
        if solution.lower_bound > limit {
            scratch.statistics.queries += 1;
            return Solved::Beyond;
        }
        let gap = query.options.gap.unwrap_or(DEFAULT_GAP * self.size);
        let rounding = ROUNDING * (self.reach + query.point.abs().max_element());
        // whether a foot just beyond the limit is all there is, the certified solver tells more finely
        if solution.distance - solution.lower_bound > gap + rounding || solution.distance > limit {
            return Solved::Declined;
        }
        scratch.statistics.queries += 1;
        Solved::Foot(solution)
    }
}
