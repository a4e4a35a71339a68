//! An entity of known shape, asked through the facade; its answers are held to the exact distance.

use std::collections::HashMap;
use std::f64::consts::TAU;

use glam::DVec3;
use perpend::{Definition, EntityId, FootPoint, Frame, Method, Model, Multiplicity, Parameter, Place, QueryOptions};

use super::probes::Probe;
use super::shapes::frame_of;
use crate::common::exact::Exact;
use crate::common::judgement::{EPSILON, is_certified, two_ulps};
use crate::common::points;
use crate::common::random::Random;
use crate::common::shape::Shape;

/// What a closed form may be off, in ulps of the largest coordinate in play. The exact form is rounded to control points and weights
/// (some 2 a direction of the frame and 1 a weight), is evaluated with about 2 a degree, and the foot's parameter is rounded once or
/// taken from a pole or seam beside it. Measured: 3 of most classes, up to 13 beside a pole.
pub(crate) const ULPS: f64 = 16.0;

/// The share of a class' queries that the closed form must answer: all, but of an elliptic arc some that lie beside the evolute,
/// where rounding does not tell how many feet there are.
pub(crate) fn nearly_all(class: &str) -> f64 {
    if class == "Ellipse" { 0.75 } else { 1.0 }
}

/// How many queries were asked, and how many of them the closed form answered.
#[derive(Debug, Default)]
pub(crate) struct Tally {
    pub(crate) queries: usize,
    pub(crate) analytic: usize,
    /// By class.
    failures: HashMap<&'static str, Vec<String>>,
    /// The largest error met, in ulps, with where.
    pub(crate) worst: (f64, String),
    by_class: HashMap<&'static str, (usize, usize)>,
}

impl Tally {
    /// Fails where an answer was wrong, or where the closed form answered less than a share of some class' queries.
    pub(crate) fn settle(self, share: impl Fn(&str) -> f64) {
        eprintln!("{} of {} analytic, worst {:?}, {:?}", self.analytic, self.queries, self.worst, self.by_class);
        let shown = self.failures.iter().flat_map(|(class, failures)| {
            std::iter::once(format!("{class}: {} answers fail", failures.len())).chain(failures.iter().take(3).cloned())
        });
        let shown = shown.collect::<Vec<_>>().join("\n");
        assert!(self.failures.is_empty(), "of {} answers\n{shown}", self.queries);
        for (class, (queries, analytic)) in self.by_class {
            let wanted = share(class) * queries as f64;
            assert!(analytic as f64 >= wanted, "{class}: the closed form answers {analytic} of {queries}");
        }
    }
}

/// An entity alone in its model.
pub(crate) struct Case<'a> {
    pub(crate) exact: &'a Exact,
    pub(crate) what: String,
    pub(crate) model: Model,
    pub(crate) id: EntityId,
    definition: Definition,
    pub(crate) shape: Shape,
    /// How far the definition is from the exact shape beyond rounding, by samples of 30 digits: what editing left.
    deviation: f64,
}

impl<'a> Case<'a> {
    /// An entity that `model` holds alone.
    pub(crate) fn new(exact: &'a Exact, what: String, model: Model) -> Self {
        let entity = &model.entities()[0];
        let (id, definition) = (entity.id(), Definition::clone(entity.definition()));
        let shape = Shape::of(&definition);
        let count = if shape.curve { 60 } else { 7 };
        let across = if shape.curve { 0 } else { count };
        let at = |k: usize, along: usize| {
            let [first, last] = shape.domain(along);
            first + (last - first) * k as f64 / count as f64
        };
        let samples = (0..=count).flat_map(|i| (0..=across).map(move |j| (i, j)));
        let deviation = samples.map(|(i, j)| exact.distance(shape.point(at(i, 0), at(j, 1)))).fold(0.0, f64::max);
        Self { exact, what, model, id, definition, shape, deviation }
    }

    /// An ulp of the largest coordinate in play.
    fn ulp(&self, p: DVec3) -> f64 {
        EPSILON * (self.shape.reach().max(self.exact.reach()) + p.abs().max_element())
    }

    /// Asks all points, alone and in a batch and with hints, and judges every answer.
    pub(crate) fn ask(&self, probes: &[Probe], tally: &mut Tally) {
        let options = QueryOptions::default();
        let points: Vec<DVec3> = probes.iter().map(|probe| probe.point).collect();
        let batch = self.model.project_all(self.id, &points, &options);
        let mut projector = self.model.projector(self.id).expect("the entity is there");
        for (probe, answer) in probes.iter().zip(batch) {
            let p = probe.point;
            let foot = answer.expect("a finite point").expect("no distance is too far");
            let alone = self.model.project(self.id, p).expect("a finite point");
            let hinted = projector.project(p, &options).expect("a finite point").expect("no distance is too far");
            let exactly = self.exact.distance(p);
            let mut faults = self.faults(probe, &foot, exactly);
            if !same_bits(&foot, &alone) || !same_bits(&foot, &hinted) {
                faults.push(format!("alone {alone:?}, with a hint {hinted:?}"));
            }
            let error = (foot.distance - exactly).abs() / self.ulp(p);
            if error > tally.worst.0 && foot.method == Method::Analytic {
                tally.worst = (error, format!("{} at {p}", self.what));
            }
            tally.queries += 1;
            let by_class = tally.by_class.entry(self.exact.class()).or_default();
            by_class.0 += 1;
            if foot.method == Method::Analytic {
                tally.analytic += 1;
                by_class.1 += 1;
            }
            if !faults.is_empty() {
                let faults = faults.join("; ");
                let failures = tally.failures.entry(self.exact.class()).or_default();
                failures.push(format!("{} at {p:?}: {faults}; {foot:?} of {:?}", self.what, self.exact));
            }
        }
    }

    /// What is wrong with an answer.
    fn faults(&self, probe: &Probe, foot: &FootPoint, exactly: f64) -> Vec<String> {
        let p = probe.point;
        let size = self.shape.size();
        let (ulp, gap) = (self.ulp(p), 1e-9 * size);
        let few = ULPS * ulp + 2.0 * self.deviation;
        // the certified solver polishes as far as its gap
        let allowed = few + if foot.method == Method::Hierarchy { gap } else { 0.0 };
        let mut faults = Vec::new();
        let at = [foot.parameter.u(), foot.parameter.v().unwrap_or(0.0)];
        let off = foot.distance - exactly;
        // where points crowd at one end of the parameters, an ulp of a parameter is many of the coordinates; the nearest parameter or
        // the one beside it is meant
        if off.is_nan() || off.abs() > allowed && off.abs() > allowed + 0.75 * two_ulps(&self.shape, at) {
            faults.push(format!("the distance is {exactly:e}, off by {off:e}, {allowed:e} allowed"));
        }
        let bounded = foot.lower_bound >= 0.0 && foot.lower_bound <= foot.distance;
        if !bounded || foot.lower_bound > exactly + few {
            faults.push(format!("the bound is false by {:e}: the distance is {exactly:e}", foot.lower_bound - exactly));
        }
        // from a million sizes away the certified solver's bound is rounded by more
        let near = (p - 0.5 * (self.shape.bounds()[0] + self.shape.bounds()[1])).length() <= 1e4 * size;
        if (foot.method == Method::Analytic || near)
            && !is_certified(foot.distance, foot.lower_bound, gap, self.shape.reach(), p)
        {
            faults.push("it is not certified".to_owned());
        }
        let inside = |along: usize| (self.shape.domain(along)[0]..=self.shape.domain(along)[1]).contains(&at[along]);
        if !inside(0) || !(self.shape.curve || inside(1)) {
            faults.push("the parameter is outside the domain".to_owned());
            return faults;
        }
        if foot.point != self.evaluated(foot.parameter) {
            faults.push("the point is not the definition at the parameter, bit for bit".to_owned());
        }
        let there = self.shape.distance_at(p, at[0].into(), at[1].into());
        if (foot.distance - there).abs() > ULPS * ulp || foot.lower_bound > there + ulp {
            faults.push(format!("the point there is at {there:e}"));
        }
        let places = self.places(at, self.noise(foot.point));
        if !places.contains(&foot.place) {
            faults.push(format!("the place is one of {places:?}"));
        }
        // what the certified solver did not meet is no fault of it
        let told = foot.method == Method::Analytic;
        if let Some(wanted) = probe.multiplicity.filter(|wanted| told && *wanted != foot.multiplicity) {
            // far from the origin, a point is not on an axis as exactly as the gap would have it
            let blurred = ULPS * ulp > 1e-3 * gap && foot.multiplicity == Multiplicity::Tied;
            if !(blurred && wanted == Multiplicity::Continuum) {
                faults.push(format!("the multiplicity is {wanted:?}"));
            }
        }
        if told && foot.multiplicity != Multiplicity::Unique && self.is_alone(p) {
            faults.push("no other point is as near".to_owned());
        }
        faults.extend(self.wrong_sign(p, foot, at));
        faults
    }

    fn evaluated(&self, parameter: Parameter) -> DVec3 {
        match (&self.definition, parameter) {
            (Definition::NurbsCurve(curve), Parameter::Curve(u)) => curve.point(u),
            (Definition::NurbsSurface(surface), Parameter::Surface(u, v)) => surface.point(u, v),
            _ => panic!("a curve's parameter for a surface, or the reverse"),
        }
    }

    /// By what angle rounding may turn a tangent about the axis, and with it the normal: beside a pole the tangent is no longer than the
    /// rounding of its ends.
    fn noise(&self, point: DVec3) -> f64 {
        let (centre, axis) = match (frame_of(self.exact), self.exact) {
            (Some(frame), _) => (frame.centre, frame.axis),
            (_, Exact::Revolution { origin, axis, .. }) => (*origin, *axis),
            _ => return 0.0,
        };
        64.0 * self.ulp(DVec3::ZERO) / (point - centre).cross(axis).length()
    }

    /// Whether a free-form profile may have a kink there: at a full inner knot.
    fn is_kink(&self, at: [f64; 2]) -> bool {
        let free = matches!(self.exact, Exact::Extrusion { .. } | Exact::Revolution { .. });
        let full = |k: usize| {
            let [first, last] = self.shape.domain(k);
            let beside = |t: &&f64| (**t - at[k]).abs() <= 1e-6 * (last - first) && **t > first && **t < last;
            self.shape.knots[k].iter().filter(beside).count() >= self.shape.degree[k]
        };
        free && (full(0) || full(1))
    }

    /// Whether a free-form profile makes the surface stop or fold there: at a cusp of it, or where it runs along its own circles.
    fn is_singular(&self, at: [f64; 2]) -> bool {
        let free = matches!(self.exact, Exact::Extrusion { .. } | Exact::Revolution { .. });
        let Definition::NurbsSurface(surface) = &self.definition else { return false };
        let mut d = [DVec3::ZERO; 4];
        surface.derivatives(at[0], at[1], 1, &mut d);
        let widths = [0, 1].map(|k| self.shape.domain(k)[1] - self.shape.domain(k)[0]);
        let size = self.shape.size();
        free && d[1].cross(d[2]).length() * widths[0] * widths[1] < 1e-6 * size * size
    }

    /// What the place at these parameters may be called.
    fn places(&self, at: [f64; 2], noise: f64) -> Vec<Place> {
        let shape = &self.shape;
        let same = 64.0 * EPSILON * shape.reach();
        let last = [shape.rows - 1, shape.columns - 1];
        let control = |along: usize, i: usize, j: usize| {
            if along == 0 { shape.points[i * shape.columns + j] } else { shape.points[j * shape.columns + i] }
        };
        // of an edge: whether it is reached, is one point, is met by its opposite
        let edges = [0, 1].map(|along| {
            let [first, end] = shape.domain(along);
            let side = if at[along] == first { Some(0) } else { (at[along] == end).then_some(last[along]) };
            if shape.curve && along == 1 {
                return (false, false, false);
            }
            let others = 0..=last[1 - along];
            let closed = others.clone().all(|j| control(along, 0, j).distance(control(along, last[along], j)) <= same);
            let Some(side) = side else { return (false, false, closed) };
            let pole = !shape.curve
                && others.clone().all(|j| control(along, side, j).distance(control(along, side, 0)) <= same);
            (true, pole, closed)
        });
        let horn = matches!(self.exact, Exact::Torus { major, minor, .. } if major == minor);
        let mut places = Vec::new();
        if edges.iter().any(|(_, pole, _)| *pole) {
            return vec![Place::Pole];
        }
        if horn {
            places.push(Place::Cusp);
        }
        // a normal that rounding may turn by as much is none
        if noise > 1e-3 {
            places.push(Place::Cusp);
        }
        if self.is_kink(at) {
            places.push(Place::Crease);
        }
        if self.is_singular(at) {
            places.extend([Place::Cusp, Place::Crease]);
        }
        let open = |(on, _, closed): (bool, bool, bool)| on && !closed;
        let seam = |(on, _, closed): (bool, bool, bool)| on && closed;
        places.push(if open(edges[0]) && open(edges[1]) {
            Place::Corner
        } else if seam(edges[0]) || seam(edges[1]) {
            Place::Seam
        } else if open(edges[0]) || open(edges[1]) {
            if shape.curve { Place::End } else { Place::Edge }
        } else {
            Place::Interior
        });
        places
    }

    /// Whether the foot is known to be alone: of a whole shape, well away from its axis, centre and spine.
    fn is_alone(&self, p: DVec3) -> bool {
        let beside = |frame: &Frame| {
            let arm = p - frame.centre;
            let height = arm.dot(frame.axis);
            ((arm - height * frame.axis).length(), height)
        };
        let whole = |sweep: (f64, f64)| sweep.1 - sweep.0 >= TAU;
        match self.exact {
            Exact::Segment { .. } | Exact::Parallelogram { .. } => true,
            Exact::Circle { frame, radius, sweep } | Exact::Cylinder { frame, radius, sweep, .. } => {
                whole(*sweep) && beside(frame).0 > 0.05 * radius
            }
            Exact::Sphere { frame, radius, sweep, .. } => whole(*sweep) && beside(frame).0 > 0.05 * radius,
            Exact::Torus { frame, major, minor, tube, sweep } => {
                let (out, height) = beside(frame);
                whole(*sweep) && whole(*tube) && out > 0.05 * major && (out - major).hypot(height) > 0.05 * minor
            }
            _ => false,
        }
    }

    fn wrong_sign(&self, p: DVec3, foot: &FootPoint, at: [f64; 2]) -> Option<String> {
        let (Some(normal), Some(signed)) = (foot.normal, foot.signed_distance) else {
            let (none, singular) =
                (foot.normal.is_none() && foot.signed_distance.is_none(), [Place::Pole, Place::Cusp]);
            let noisy = self.noise(foot.point) > 1e-3 || self.is_singular(at);
            let right = none && (self.shape.curve || singular.contains(&foot.place) || noisy);
            return (!right).then(|| "normal and signed distance are both there or both not".to_owned());
        };
        let place = points::place(&self.shape, at, &mut Random::new(0));
        // the reference is taken a little inside the domain, and beside a pole it is another one
        let clear = self.noise(foot.point) < 1e-3 && !self.is_kink(at) && !self.is_singular(at);
        if clear && normal.dot(place.normal) < 1.0 - 1e-5 && place.normal != DVec3::ZERO {
            return Some(format!("the normal is {}", place.normal));
        }
        let side = (p - foot.point).dot(normal);
        let clear = side.abs() > 64.0 * self.ulp(p);
        (signed.abs() != foot.distance || (clear && (signed > 0.0) != (side > 0.0)))
            .then(|| format!("the query lies {side:e} along the normal"))
    }
}

fn same_bits(a: &FootPoint, b: &FootPoint) -> bool {
    let bits = |foot: &FootPoint| {
        let (normal, signed) = (foot.normal.unwrap_or_default(), foot.signed_distance.unwrap_or_default());
        let at = [foot.parameter.u(), foot.parameter.v().unwrap_or_default()];
        let numbers = [at[0], at[1], foot.distance, foot.lower_bound, signed];
        let numbers = numbers.into_iter().chain(foot.point.to_array()).chain(normal.to_array());
        numbers.map(f64::to_bits).collect::<Vec<_>>()
    };
    bits(a) == bits(b) && (a.place, a.multiplicity, a.method) == (b.place, b.multiplicity, b.method)
}
