//! Knowledge that its definition contradicts.
//!
//! What can be checked in a moment is: a few evaluations for an entity, one for each item of a list. What passes is not proved by it.

use glam::DVec3;
use perpend_kernel::{Aabb, Definition, Direction, Fingerprint, KnotVector};

use crate::acquire::enclosure;
use crate::item::{Basis, Item};
use crate::record::Record;
use crate::representation::{Break, Irregularity, ParameterPoint, Representation, Speed};

/// An item of a record that its definition contradicts.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error(
    "{field} is false: {problem}, off by {deviation:.3e}; leave the item out, or have it acquired again (Trust::Repair, --repair)"
)]
pub struct Contradiction {
    /// The field.
    pub field: String,
    /// What the definition says, in words.
    pub problem: String,
    /// How far the stated value is off, in its unit.
    pub deviation: f64,
}

/// The parts of the domain at whose ends and middles an entity is evaluated, per direction.
const PARTS: usize = 8;

/// What an evaluated value may be off, as a share of the largest such value: far above rounding, far below a lie.
const LOSS: f64 = 1e-9;

/// The ratio of weights from which evaluated derivatives tell nothing.
const EXTREME: f64 = 1e12;

/// A speed that a stated cusp may have, as a share of size per domain: its place is known to some digits only.
const SLOW: f64 = 1e-4;

impl Record {
    /// The items of the representation that the definition contradicts by more than their tolerance and gap. Stale items are not
    /// looked at; the class has a proof of its own ([`crate::prove`]).
    ///
    /// Looked at: speeds at a few places; breaks stand at knots, and tangents are continuous where they say so; closedness; box;
    /// arc length, between chords and control polygon; weights; places of irregularities, and the measure of poles, seams, loops,
    /// cusps and vanishing derivatives. Areas, inflections and zero curvature are not.
    #[must_use]
    pub fn contradictions(&self, definition: &Definition) -> Vec<Contradiction> {
        let Some(part) = &self.representation else { return Vec::new() };
        let mut check = Check::new(definition);
        check.whole(part);
        check.lists(part);
        check.found
    }
}

struct Check<'a> {
    definition: &'a Definition,
    of: Fingerprint,
    size: f64,
    /// What rounding may move a first derivative by.
    drift: f64,
    found: Vec<Contradiction>,
}

/// What a stated value may be off.
fn allowed<T>(item: &Item<T>) -> f64 {
    let open = match item.basis {
        Basis::Proved { gap } => gap,
        Basis::Measured { error } => error,
        Basis::Fitted { residual, .. } => residual,
        Basis::Defined | Basis::Declared => 0.0,
    };
    item.tolerance.max(0.0) + open.max(0.0)
}

impl<'a> Check<'a> {
    fn new(definition: &'a Definition) -> Self {
        let knots = match definition {
            Definition::NurbsCurve(curve) => vec![curve.knots()],
            Definition::NurbsSurface(surface) => vec![surface.knots(Direction::U), surface.knots(Direction::V)],
        };
        let narrowest =
            knots.iter().flat_map(|knots| knots.spans()).map(|s| s.end - s.start).fold(f64::INFINITY, f64::min);
        let degree = knots.iter().map(|knots| knots.degree()).max().unwrap_or(1) as f64;
        let weights = definition.weights().unwrap_or(&[1.0]);
        let (low, high) = weights.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), w| (a.min(*w), b.max(*w)));
        // a derivative is a difference of neighbours, times the degree, per span; weights of very different sizes cancel
        let drift = 64.0 * f64::EPSILON * degree * (degree + 4.0) * definition.reach() * (high / low) / narrowest;
        // and of extremely different ones nothing is left
        let drift = if high / low < EXTREME { drift } else { f64::INFINITY };
        Self { definition, of: definition.fingerprint(), size: definition.size(), drift, found: Vec::new() }
    }

    fn say(&mut self, field: String, problem: String, deviation: f64) {
        let field = format!("representation.{field}");
        self.found.push(Contradiction { field, problem, deviation });
    }

    fn whole(&mut self, part: &Representation) {
        let of = self.of;
        if let Some(item) = part.bounds.as_ref().filter(|item| !item.is_stale(of)) {
            let Aabb { min, max } = item.value;
            let outside = |p: DVec3| (min - p).max(p - max).max_element().max(0.0);
            let off = self.samples().into_iter().map(outside).fold(0.0, f64::max);
            if off > allowed(item) + self.loss() {
                self.say("box".to_owned(), "a point of the entity lies outside".to_owned(), off);
            }
        }
        if let Some(item) = part.weights.as_ref().filter(|item| !item.is_stale(of)) {
            let weights = self.definition.weights().unwrap_or(&[1.0]);
            let (low, high) = weights.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), w| (a.min(*w), b.max(*w)));
            let off = (item.value.0 - low).abs().max((item.value.1 - high).abs());
            if off > allowed(item) {
                self.say("weights".to_owned(), format!("they reach from {low} to {high}"), off);
            }
        }
        if let Some(item) = part.length.as_ref().filter(|item| !item.is_stale(of)) {
            self.length(item);
        }
        for (item, name) in [(part.closed.as_ref(), "closed"), (part.periodic.as_ref(), "periodic")] {
            let Some(item) = item.filter(|item| !item.is_stale(of)) else { continue };
            for (says, direction) in [(item.value.0, Direction::U), (item.value.1, Direction::V)] {
                let gap = self.opening(direction);
                if says && gap > allowed(item) + self.loss() {
                    self.say(name.to_owned(), format!("start and end in {direction} are {gap:.3e} apart"), gap);
                }
            }
        }
    }

    fn length(&mut self, item: &Item<f64>) {
        if !self.is_curve() {
            return self.say("length".to_owned(), "a surface has an area".to_owned(), item.value.abs());
        }
        let (least, greatest) = enclosure(self.definition, 8 * PARTS);
        let off = (least - item.value).max(item.value - greatest);
        if off > allowed(item) + LOSS * greatest {
            self.say("length".to_owned(), format!("it lies between {least} and {greatest}"), off);
        }
    }

    fn lists(&mut self, part: &Representation) {
        let of = self.of;
        for (k, item) in part.speed.iter().flatten().enumerate().filter(|(_, item)| !item.is_stale(of)) {
            self.speed(k, item);
        }
        for (k, item) in part.breaks.iter().flatten().enumerate().filter(|(_, item)| !item.is_stale(of)) {
            let Break { direction, at, c, c_within, .. } = item.value;
            let field = format!("breaks[{k}]");
            if let Some(off) = self.off_knot(direction, at) {
                self.say(field, "no knot stands there".to_owned(), off);
            } else if c >= 1
                && let Some(jump) = self.jump(direction, at)
                && jump > 1e-6 + 1e3 * (allowed(item) + c_within)
            {
                self.say(field, "the first derivative jumps there by that share of itself".to_owned(), jump);
            }
        }
        for (k, item) in part.irregularities.iter().flatten().enumerate().filter(|(_, item)| !item.is_stale(of)) {
            self.irregularity(format!("irregularities[{k}]"), item);
        }
    }

    fn speed(&mut self, k: usize, item: &Item<Speed>) {
        let Speed { direction, min, max, factor, .. } = item.value;
        let field = format!("speed[{k}]");
        let loss = allowed(item) + LOSS * max.abs() + self.drift;
        let from = if max > 0.0 { (max - min) / max } else { 1.0 };
        if (factor - from).abs() > LOSS {
            return self.say(field, format!("min and max make the factor {from}"), (factor - from).abs());
        }
        for place in self.places() {
            let speed = self.velocity(direction, place).length();
            let off = (speed - max).max(min - speed);
            if off > loss {
                let (u, v) = place;
                let at = if self.is_curve() { format!("u = {u}") } else { format!("({u}, {v})") };
                return self.say(field, format!("the speed is {speed} at {at}"), off);
            }
        }
    }

    fn irregularity(&mut self, field: String, item: &Item<Irregularity>) {
        let slow = |direction| {
            let (first, last) = self.domain(direction);
            SLOW * self.size / (last - first)
        };
        let found: Option<(&str, f64)> = match item.value {
            Irregularity::Pole { direction, at, extent } => {
                let edge = self.along(direction, at);
                let real = edge.iter().map(|p| p.distance(edge[0])).fold(0.0, f64::max);
                let off = real - extent;
                (off > allowed(item) + self.loss()).then_some(("points of the edge are farther apart", off))
            }
            Irregularity::Seam { direction, gap, .. } => {
                let off = self.opening(direction) - gap;
                (off > allowed(item) + self.loss()).then_some(("start and end are farther apart", off))
            }
            Irregularity::Loop { from, to, gap } => {
                let off = self.point((from, 0.0)).distance(self.point((to, 0.0))) - gap;
                (off > allowed(item) + self.loss()).then_some(("the two points are farther apart", off))
            }
            Irregularity::VanishingDerivative { direction, at, speed } => {
                let real = self.slowest(direction, self.place(at));
                let off = real - speed;
                (off > allowed(item) + slow(direction) + self.drift).then_some(("the derivative is longer there", off))
            }
            Irregularity::Cusp { at: ParameterPoint::Curve(u), .. } => {
                let speed = self.slowest(Direction::U, (u, 0.0));
                (speed > slow(Direction::U) + self.drift)
                    .then_some(("the curve does not stop there: its speed is the deviation", speed))
            }
            Irregularity::Crease { direction, at, .. }
            | Irregularity::NearKnots { direction, at, .. }
            | Irregularity::TinySpan { direction, at, .. } => {
                self.off_knot(direction, at).map(|off| ("no knot stands there", off))
            }
            Irregularity::Inflection { at, .. }
            | Irregularity::Cusp { at, .. }
            | Irregularity::VanishingNormal { at, .. } => {
                let off = self.outside(at);
                (off > 0.0).then_some(("the place is outside the domain", off))
            }
            Irregularity::ZeroCurvature { from, to, .. } => {
                let off = self.outside(ParameterPoint::Curve(from)).max(self.outside(ParameterPoint::Curve(to)));
                (off > 0.0).then_some(("the place is outside the domain", off))
            }
        };
        if let Some((problem, off)) = found {
            self.say(field, problem.to_owned(), off);
        }
    }

    fn is_curve(&self) -> bool {
        matches!(self.definition, Definition::NurbsCurve(_))
    }

    /// What rounding may move an evaluated point by.
    fn loss(&self) -> f64 {
        LOSS * self.size + 64.0 * f64::EPSILON * self.definition.reach()
    }

    fn knots(&self, direction: Direction) -> Option<&KnotVector> {
        match (self.definition, direction) {
            (Definition::NurbsCurve(curve), Direction::U) => Some(curve.knots()),
            (Definition::NurbsCurve(_), Direction::V) => None,
            (Definition::NurbsSurface(surface), _) => Some(surface.knots(direction)),
        }
    }

    fn domain(&self, direction: Direction) -> (f64, f64) {
        self.knots(direction).map_or((0.0, 1.0), KnotVector::domain)
    }

    /// Parameters over the whole domain, ends included.
    fn steps(&self, direction: Direction, parts: usize) -> Vec<f64> {
        let (first, last) = self.domain(direction);
        let at = |k: usize| first + (last - first) * (k as f64 / parts as f64);
        (0..=parts).map(at).map(|u| u.clamp(first, last)).collect()
    }

    fn places(&self) -> Vec<(f64, f64)> {
        if self.is_curve() {
            return self.steps(Direction::U, 4 * PARTS).into_iter().map(|u| (u, 0.0)).collect();
        }
        let v = self.steps(Direction::V, PARTS);
        self.steps(Direction::U, PARTS).into_iter().flat_map(|u| v.iter().map(move |v| (u, *v))).collect()
    }

    fn samples(&self) -> Vec<DVec3> {
        self.places().into_iter().map(|place| self.point(place)).collect()
    }

    fn place(&self, at: ParameterPoint) -> (f64, f64) {
        let middle = |direction| {
            let (first, last) = self.domain(direction);
            0.5 * first + 0.5 * last
        };
        match at {
            ParameterPoint::Curve(u) => (u, 0.0),
            ParameterPoint::Surface(u, v) => (u, v),
            ParameterPoint::Iso(Direction::U, u) => (u, middle(Direction::V)),
            ParameterPoint::Iso(Direction::V, v) => (middle(Direction::U), v),
        }
    }

    fn point(&self, (u, v): (f64, f64)) -> DVec3 {
        match self.definition {
            Definition::NurbsCurve(curve) => curve.point(curve.knots().clamp(u)),
            Definition::NurbsSurface(surface) => {
                surface.point(surface.knots(Direction::U).clamp(u), surface.knots(Direction::V).clamp(v))
            }
        }
    }

    /// The first derivative in a direction; none of a curve in V.
    fn velocity(&self, direction: Direction, (u, v): (f64, f64)) -> DVec3 {
        match (self.definition, direction) {
            (Definition::NurbsCurve(curve), Direction::U) => {
                let mut d = [DVec3::ZERO; 2];
                curve.derivatives(curve.knots().clamp(u), &mut d);
                d[1]
            }
            (Definition::NurbsCurve(_), Direction::V) => DVec3::ZERO,
            (Definition::NurbsSurface(surface), _) => {
                let mut d = [DVec3::ZERO; 4];
                let (u, v) = (surface.knots(Direction::U).clamp(u), surface.knots(Direction::V).clamp(v));
                surface.derivatives(u, v, 1, &mut d);
                d[if direction == Direction::U { 2 } else { 1 }]
            }
        }
    }

    /// The least speed at a place: at a knot, each side has its own.
    fn slowest(&self, direction: Direction, (u, v): (f64, f64)) -> f64 {
        match self.definition {
            Definition::NurbsCurve(curve) => {
                let mut d = [DVec3::ZERO; 2];
                curve.derivatives_from_left(curve.knots().clamp(u), &mut d);
                d[1].length().min(self.velocity(direction, (u, v)).length())
            }
            Definition::NurbsSurface(surface) => {
                let (u, v) = (surface.knots(Direction::U).clamp(u), surface.knots(Direction::V).clamp(v));
                let side = |below: [bool; 2]| {
                    let mut d = [DVec3::ZERO; 4];
                    surface.derivatives_from(u, v, below, 1, &mut d);
                    d[if direction == Direction::U { 2 } else { 1 }].length()
                };
                let sides = [[false, false], [false, true], [true, false], [true, true]];
                sides.into_iter().map(side).fold(f64::INFINITY, f64::min)
            }
        }
    }

    /// By how much the first derivative jumps over a knot, as a share of itself: in the middle of the line. None where it is too
    /// short to tell.
    fn jump(&self, direction: Direction, at: f64) -> Option<f64> {
        let (before, after) = match (self.definition, direction) {
            (Definition::NurbsCurve(curve), _) => {
                let (mut a, mut b) = ([DVec3::ZERO; 2], [DVec3::ZERO; 2]);
                curve.derivatives_from_left(at, &mut a);
                curve.derivatives(at, &mut b);
                (a[1], b[1])
            }
            (Definition::NurbsSurface(surface), _) => {
                let (u, v) = self.place(ParameterPoint::Iso(direction, at));
                let side = |below: [bool; 2]| {
                    let mut d = [DVec3::ZERO; 4];
                    surface.derivatives_from(u, v, below, 1, &mut d);
                    d[if direction == Direction::U { 2 } else { 1 }]
                };
                (side([direction == Direction::U, direction == Direction::V]), side([false, false]))
            }
        };
        let longest = before.length().max(after.length());
        let (first, last) = self.domain(direction);
        (longest * (last - first) > 1e-3 * self.size && longest > 1e8 * self.drift)
            .then(|| before.distance(after) / longest)
    }

    /// The points of an iso-curve.
    fn along(&self, direction: Direction, at: f64) -> Vec<DVec3> {
        match direction {
            Direction::U => self.steps(Direction::V, PARTS).into_iter().map(|v| self.point((at, v))).collect(),
            Direction::V => self.steps(Direction::U, PARTS).into_iter().map(|u| self.point((u, at))).collect(),
        }
    }

    /// The largest distance that was met between start and end of a direction; of a curve in V: its size.
    fn opening(&self, direction: Direction) -> f64 {
        let (first, last) = self.domain(direction);
        if self.is_curve() {
            let is_there = direction == Direction::U;
            return if is_there { self.point((first, 0.0)).distance(self.point((last, 0.0))) } else { self.size };
        }
        let (start, end) = (self.along(direction, first), self.along(direction, last));
        start.iter().zip(&end).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
    }

    /// The distance to the nearest knot, where none stands at the parameter.
    fn off_knot(&self, direction: Direction, at: f64) -> Option<f64> {
        let Some(knots) = self.knots(direction) else { return Some(f64::INFINITY) };
        let knots = knots.as_slice();
        let above = knots.partition_point(|knot| *knot < at);
        let near = [above.checked_sub(1), Some(above)].into_iter().flatten().filter_map(|k| knots.get(k));
        let off = near.map(|knot| (knot - at).abs()).fold(f64::INFINITY, f64::min);
        let (first, last) = self.domain(direction);
        (off > LOSS * (last - first)).then_some(off)
    }

    /// How far a place lies outside the domain.
    fn outside(&self, at: ParameterPoint) -> f64 {
        let beyond = |direction, at: f64| {
            let (first, last) = self.domain(direction);
            (first - at).max(at - last).max(0.0)
        };
        match at {
            ParameterPoint::Curve(u) => beyond(Direction::U, u),
            ParameterPoint::Surface(u, v) => beyond(Direction::U, u).max(beyond(Direction::V, v)),
            ParameterPoint::Iso(direction, at) => beyond(direction, at),
        }
    }
}
