//! From a solver's solution to the answer: the definition evaluated there, the place, the normal.

use glam::DVec3;
use perpend_kernel::{Definition, Direction, NurbsCurve, NurbsSurface};

use crate::answer::{FootPoint, Method, Multiplicity, Parameter, Place};
use crate::landmarks::{Landmarks, turns, vanishes};
use crate::solver::{Solution, Tie};

/// A normal that rounding may turn by this much, in radians, says nothing: the derivatives vanish but for rounding.
const LOST: f64 = 0.5;

/// Reads answers off the parameters of one definition.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reader<'a> {
    pub definition: &'a Definition,
    pub landmarks: &'a Landmarks,
    /// The definition's size.
    pub size: f64,
    /// Its largest |coordinate|.
    pub reach: f64,
}

impl Reader<'_> {
    /// The answer that a solution of this method is.
    #[inline]
    pub(crate) fn answer(self, solution: &Solution, method: Method) -> FootPoint {
        let (u, v) = (solution.u, solution.v);
        match self.definition {
            Definition::NurbsCurve(curve) if self.landmarks.is_plain(0, u) => {
                let point = solution.point.unwrap_or_else(|| curve.point(u));
                Self::found(solution, method, (Parameter::Curve(u), point, Place::Interior, None))
            }
            Definition::NurbsSurface(surface)
                if self.landmarks.is_plain(0, u) && self.landmarks.is_plain(1, v) && solution.normal != DVec3::ZERO =>
            {
                let point = solution.point.unwrap_or_else(|| surface.point(u, v));
                Self::found(solution, method, (Parameter::Surface(u, v), point, Place::Interior, Some(solution.normal)))
            }
            _ => self.particular(solution, method),
        }
    }

    /// As [`answer`](Self::answer), at a place that may be particular.
    #[inline(never)]
    fn particular(self, solution: &Solution, method: Method) -> FootPoint {
        let lower = self.on_lower_side(solution);
        let solution = lower.as_ref().unwrap_or(solution);
        let (u, v) = (solution.u, solution.v);
        let read = match self.definition {
            Definition::NurbsCurve(curve) => {
                let point = solution.point.unwrap_or_else(|| curve.point(u));
                (Parameter::Curve(u), point, self.place_on_curve(curve, u), None)
            }
            Definition::NurbsSurface(surface) => {
                let (place, normal) = self.place_on_surface(surface, u, v, solution.normal);
                let point = solution.point.unwrap_or_else(|| surface.point(u, v));
                (Parameter::Surface(u, v), point, place, normal)
            }
        };
        Self::found(solution, method, read)
    }

    #[inline]
    fn found(
        solution: &Solution,
        method: Method,
        (parameter, point, place, normal): (Parameter, DVec3, Place, Option<DVec3>),
    ) -> FootPoint {
        let distance = solution.distance;
        let side = normal.map(|normal| -solution.offset.dot(normal));
        FootPoint {
            parameter,
            point,
            distance,
            lower_bound: solution.lower_bound.min(distance),
            place,
            multiplicity: match solution.tie {
                Tie::None => Multiplicity::Unique,
                Tie::Apart => Multiplicity::Tied,
                Tie::Connected => Multiplicity::Continuum,
            },
            normal,
            signed_distance: side.map(|side| if side < 0.0 { -distance } else { distance }),
            method,
        }
    }

    /// A foot on a seam has two parameters: the lower one is given, where both are one point but for rounding. None where it is the lower one.
    ///
    /// The ends of a definition that closes only to an ulp of its coordinates may differ by more than rounding in the entity's own;
    /// then the foot stays where it was found, since the distance belongs to it.
    fn on_lower_side(self, solution: &Solution) -> Option<Solution> {
        let landmarks = self.landmarks;
        let lower = |d: usize, at: f64| {
            let (first, last) = landmarks.ends[d];
            if landmarks.closed[d] && at == last { first } else { at }
        };
        let (u, v) = (lower(0, solution.u), lower(1, solution.v));
        if (u, v) == (solution.u, solution.v) {
            return None;
        }
        let at = |u: f64, v: f64| match self.definition {
            Definition::NurbsCurve(curve) => curve.point(u),
            Definition::NurbsSurface(surface) => surface.point(u, v),
        };
        let moved = at(u, v) - at(solution.u, solution.v);
        let offset = solution.offset + moved;
        let distance = offset.length();
        let is_one_point = moved.length() <= 16.0 * f64::EPSILON * (self.size + solution.distance);
        let lower_bound = solution.lower_bound.min(distance);
        is_one_point.then_some(Solution { u, v, point: None, offset, distance, lower_bound, ..*solution })
    }

    fn place_on_curve(self, curve: &NurbsCurve, u: f64) -> Place {
        let (first, last) = curve.domain();
        let (closed, at_end) = (self.landmarks.closed[0], u == first || u == last);
        let is_break = self.landmarks.breaks[0].contains(&u);
        if !at_end && !is_break && !self.landmarks.cusps.contains(&u) {
            return Place::Interior;
        }
        if at_end && !closed {
            return Place::End;
        }
        let (mut before, mut after) = ([DVec3::ZERO; 2], [DVec3::ZERO; 2]);
        curve.derivatives_from_left(if at_end && closed { last } else { u }, &mut before);
        curve.derivatives(if at_end && closed { first } else { u }, &mut after);
        let cusp = vanishes(before[1], curve) || vanishes(after[1], curve);
        match at_end {
            _ if cusp => Place::Cusp,
            _ if turns(before[1], after[1], 0.0) => Place::Crease,
            true => Place::Seam,
            false => Place::Interior,
        }
    }

    fn place_on_surface(self, surface: &NurbsSurface, u: f64, v: f64, normal: DVec3) -> (Place, Option<DVec3>) {
        let landmarks = self.landmarks;
        let ends = landmarks.ends;
        let at = [u, v];
        let on = |direction: usize| at[direction] == ends[direction].0 || at[direction] == ends[direction].1;
        let pole = (0..2)
            .any(|d| (landmarks.poles[d][0] && at[d] == ends[d].0) || (landmarks.poles[d][1] && at[d] == ends[d].1));
        if pole {
            return (Place::Pole, None);
        }
        let open_edge = |d: usize| on(d) && !landmarks.closed[d];
        let around = |d: usize| (on(d) && landmarks.closed[d]) || landmarks.breaks[d].contains(&at[d]);
        let mut normal = (normal != DVec3::ZERO).then_some(normal);
        let mut crease = false;
        if around(0) || around(1) {
            (normal, crease) = self.normals_around(surface, [u, v], [around(0), around(1)]);
        }
        let place = if normal.is_none() && !crease {
            Place::Cusp
        } else if open_edge(0) && open_edge(1) {
            Place::Corner
        } else if crease {
            Place::Crease
        } else if (0..2).any(|d| on(d) && landmarks.closed[d]) {
            Place::Seam
        } else if open_edge(0) || open_edge(1) {
            Place::Edge
        } else {
            Place::Interior
        };
        (place, normal)
    }

    /// The mean of the unit normals on all sides of a seam or break, and whether they differ.
    fn normals_around(self, surface: &NurbsSurface, at: [f64; 2], around: [bool; 2]) -> (Option<DVec3>, bool) {
        let ends = self.landmarks.ends;
        let mut normals: smallvec::SmallVec<[(DVec3, f64); 4]> = smallvec::SmallVec::new();
        for below in [[false, false], [true, false], [false, true], [true, true]] {
            if (0..2).any(|d| below[d] && !around[d]) {
                continue;
            }
            // the far side of a seam lies at the other end of the domain
            let side = [0, 1].map(|d| {
                let on_seam = around[d] && (at[d] == ends[d].0 || at[d] == ends[d].1);
                match (on_seam, below[d]) {
                    (true, true) => ends[d].1,
                    (true, false) => ends[d].0,
                    (false, _) => at[d],
                }
            });
            let mut d = [DVec3::ZERO; 4];
            surface.derivatives_from(side[0], side[1], below, 1, &mut d);
            let rounding = [Direction::U, Direction::V].map(|along| self.rounding(surface, along, side));
            // the angle by which rounding of the derivatives may turn the normal: large beside a pole
            let noise = rounding[0] / d[2].length() + rounding[1] / d[1].length();
            if noise < LOST {
                normals.extend(d[2].cross(d[1]).try_normalize().map(|normal| (normal, noise)));
            }
        }
        let crease = normals.windows(2).any(|pair| turns(pair[0].0, pair[1].0, pair[0].1 + pair[1].1));
        let sum: DVec3 = normals.iter().map(|(normal, _)| *normal).sum();
        (sum.try_normalize(), crease)
    }

    /// How far rounding may move the first derivative along a direction: that of a point, over the span, times the degree.
    fn rounding(self, surface: &NurbsSurface, along: Direction, at: [f64; 2]) -> f64 {
        let knots = surface.knots(along);
        let span = knots.find_span(at[along as usize]);
        let width = knots.as_slice()[span + 1] - knots.as_slice()[span];
        64.0 * f64::EPSILON * self.reach * knots.degree() as f64 / width
    }
}
