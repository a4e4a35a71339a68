//! The wave (Piegl et al. 2008, §4 to §6): an entity as uniform cells, a cubical wave from the query, and Newton's method.
//!
//! # Order of work
//!
//! Preparing spreads nearly equally spaced points over the entity ([`decompose`]; on surfaces along the [`longest`] iso-curves), takes the
//! box of each [`segment`] between them, and registers it with the uniform [`cells`] that it meets. A query sends a cubical wave through the cells
//! (the [`front`]); each segment that it meets is decomposed a second time ([`sample`]), once in the life of the entity, and the nearest sample is
//! the start of [`newton`].
//!
//! # What it is worth
//!
//! The start is the nearest of all samples, proven by the distance of the cells that the wave has not reached. The foot is not: where two
//! parts of an entity are as near as samples tell, the start may lie on the wrong one. So the answer is a proposal.
//!
//! # What makes the same query give the same proposal
//!
//! Samples depend on their segment alone, whichever query first asks for them; cells and segments come in an order that the query fixes; of
//! samples as near the first counts.

mod arc_length;
mod cells;
mod decompose;
mod front;
mod jet;
mod longest;
mod marks;
mod newton;
mod nodes;
mod sample;
mod segment;
mod settings;
mod speed;
mod track;
mod view;

use std::sync::{Arc, OnceLock};

use glam::DVec3;
use perpend_kernel::{Aabb, Definition, Direction, NurbsCurve, NurbsSurface};

use self::cells::Cells;
use self::decompose::{Decomposition, decompose};
use self::front::Front;
pub(crate) use self::marks::Marks;
use self::newton::Course;
use self::nodes::nodes;
use self::sample::{Samples, affordable};
pub use self::settings::{Steps, WaveSettings};
use self::track::Track;
pub use self::view::{DecompositionCost, WaveTrace};
use crate::answer::Method;
use crate::landmarks::{Landmarks, turns};
use crate::query::Query;
use crate::scratch::Scratch;
use crate::solver::Proposer;
use crate::statistics::Work;

/// The most points along a curve, and along each direction of a surface, beside those on cuts.
const MOST_POINTS: [usize; 2] = [1 << 12, 1 << 8];

/// An entity prepared for waves, after Piegl et al. 2008: its nearly equally spaced points, its cells, and the segments registered with them.
///
/// Immutable but for samples, which are made when a wave first needs them; shared by threads. What a wave finds is a proposal: nothing
/// proves it but the certificate.
#[derive(Debug)]
pub struct Wave {
    definition: Arc<Definition>,
    settings: WaveSettings,
    tracks: [Track; 2],
    /// The points of the decomposition, in u and in v; a single 0 in v on a curve.
    parameters: [Vec<f64>; 2],
    cost: DecompositionCost,
    /// The segments' boxes, those along v innermost.
    boxes: Vec<Aabb>,
    cells: Cells,
    samples: Vec<OnceLock<Box<Samples>>>,
    /// The curves on a surface's edges, at both ends of u and at both ends of v; none where an edge is a point.
    boundary: [OnceLock<Option<Box<Wave>>>; 4],
}

/// The nearest sample.
#[derive(Debug, Clone, Copy)]
struct Start {
    parameters: (f64, f64),
    point: DVec3,
    distance_squared: f64,
}

impl Wave {
    /// Prepares a definition.
    #[must_use]
    pub fn new(definition: Arc<Definition>, settings: WaveSettings) -> Self {
        let landmarks = Landmarks::of(&definition);
        Self::with(definition, settings, &landmarks, &[])
    }

    /// Prepares a definition whose landmarks are known; `cuts` are parameters of a curve at which it is cut beside them.
    pub(crate) fn with(
        definition: Arc<Definition>,
        mut settings: WaveSettings,
        landmarks: &Landmarks,
        cuts: &[f64],
    ) -> Self {
        settings.decomposition = settings.decomposition.map(Steps::bounded);
        settings.sampling = settings.sampling.bounded();
        let tracks = match &*definition {
            Definition::NurbsCurve(curve) => curve_tracks(curve, landmarks, cuts),
            Definition::NurbsSurface(surface) => surface_tracks(surface, landmarks),
        };
        let (u, v) = match &*definition {
            Definition::NurbsCurve(curve) => {
                (points(curve, &tracks[0], settings.decomposition[0], MOST_POINTS[0]), None)
            }
            Definition::NurbsSurface(surface) => {
                let [along_u, along_v] = longest::longest(surface);
                let spread = |curve: Option<NurbsCurve>, k: usize| match curve {
                    Some(curve) => points(&curve, &tracks[k], settings.decomposition[k], MOST_POINTS[1]),
                    // a surface without extent in this direction
                    None => Decomposition {
                        parameters: vec![tracks[k].domain().0, tracks[k].domain().1],
                        ..Decomposition::default()
                    },
                };
                (spread(along_u, 0), Some(spread(along_v, 1)))
            }
        };
        let mut cost = DecompositionCost::of(&u);
        if let Some(v) = &v {
            cost = cost.and(DecompositionCost::of(v));
        }
        let parameters = [u.parameters, v.map_or_else(|| vec![0.0], |v| v.parameters)];
        let boxes = match &*definition {
            Definition::NurbsCurve(curve) => segment::curve_boxes(curve, &parameters[0]),
            Definition::NurbsSurface(surface) => segment::surface_boxes(surface, &parameters[0], &parameters[1]),
        };
        let cells = Cells::new(&boxes, parameters[0].len().max(parameters[1].len()));
        let samples = boxes.iter().map(|_| OnceLock::new()).collect();
        Self { definition, settings, tracks, parameters, cost, boxes, cells, samples, boundary: Default::default() }
    }

    /// The foot that the method finds, with the distance that it claims for it, in the model's unit.
    fn foot(
        &self,
        query: &Query,
        marks: &mut Marks,
        work: &mut Work,
        trace: Option<&mut WaveTrace>,
    ) -> ([f64; 2], f64) {
        let start = self.nearest_sample(query.point, marks, work, trace);
        let tolerances = query.options.newton;
        let course = Course {
            definition: &self.definition,
            tracks: &self.tracks,
            query: query.point,
            tolerances,
            coincidence: tolerances.coincidence.unwrap_or_else(|| 1e-6 * self.definition.size()),
        };
        let mut best = course.run([start.parameters.0, start.parameters.1], work);
        if matches!(*self.definition, Definition::NurbsSurface(_)) {
            for (k, end) in best.pushed.into_iter().enumerate() {
                let Some(end) = end else { continue };
                let Some(edge) = self.edge(k, end) else { continue };
                let ([along, _], _) = edge.foot(query, marks, work, None);
                let on_edge = if k == 0 { [end, along] } else { [along, end] };
                // from there it may lead back inside
                let arrived = course.run(on_edge, work);
                if arrived.distance < best.distance {
                    best = arrived;
                }
            }
        }
        (best.parameters, best.distance)
    }

    /// The nearest of all samples: the wave goes out until its shell is farther than the best of those it has met.
    fn nearest_sample(
        &self,
        query: DVec3,
        marks: &mut Marks,
        work: &mut Work,
        mut trace: Option<&mut WaveTrace>,
    ) -> Start {
        marks.begin(self.boxes.len());
        let mut front = Front::new(&self.cells, query);
        let mut best = Start { parameters: (0.0, 0.0), point: query, distance_squared: f64::INFINITY };
        while front.search_distance_squared() < best.distance_squared {
            front.advance(|run| {
                let from = self.cells.index(run.x.0, run.y, run.z);
                let to = from + run.x.1 - run.x.0;
                work.cells += (to - from + 1) as u64;
                if let Some(trace) = trace.as_deref_mut() {
                    trace.cells.extend((run.x.0..=run.x.1).map(|x| [x, run.y, run.z]));
                }
                for segment in self.cells.registered(from, to) {
                    let index = *segment as usize;
                    if !marks.meet(*segment) || self.boxes[index].distance_squared(query) >= best.distance_squared {
                        continue;
                    }
                    work.pieces += 1;
                    if let Some(trace) = trace.as_deref_mut() {
                        trace.segments.push(index);
                    }
                    let samples = self.samples[index].get_or_init(|| {
                        let samples = self.sample(index);
                        work.evaluations += samples.evaluations;
                        Box::new(samples)
                    });
                    if let Some((k, distance_squared)) = samples.nearest(query, best.distance_squared) {
                        best = Start { parameters: samples.parameters(k), point: samples.points[k], distance_squared };
                    }
                }
            });
        }
        if let Some(trace) = trace {
            (trace.start, trace.start_point) = (best.parameters, best.point);
        }
        best
    }

    /// The samples of a segment.
    fn sample(&self, segment: usize) -> Samples {
        let across = self.parameters[1].len().saturating_sub(1).max(1);
        let range = |k: usize, i: usize| (self.parameters[k][i], self.parameters[k][i + 1]);
        let budget = |directions| affordable(self.settings.sampling, self.boxes.len(), directions);
        match &*self.definition {
            Definition::NurbsCurve(curve) => Samples::of_curve(curve, range(0, segment), budget(1)),
            Definition::NurbsSurface(surface) => {
                Samples::of_surface(surface, [range(0, segment / across), range(1, segment % across)], budget(2))
            }
        }
    }

    /// The curve on a surface's edge, made ready when a foot is first pushed over it.
    fn edge(&self, k: usize, end: f64) -> Option<&Self> {
        let Definition::NurbsSurface(surface) = &*self.definition else { return None };
        let last = usize::from(end == self.tracks[k].domain().1);
        let wave = self.boundary[2 * k + last].get_or_init(|| {
            let held = [Direction::U, Direction::V][k];
            let curve = surface.iso_curve(held, end).ok()?;
            let settings = WaveSettings { decomposition: [self.settings.decomposition[1 - k]; 2], ..self.settings };
            Some(Box::new(Self::new(Arc::new(curve.into()), settings)))
        });
        wave.as_deref()
    }
}

impl Proposer for Wave {
    fn method(&self) -> Method {
        Method::Wave
    }

    fn propose(&self, query: &Query, scratch: &mut Scratch) -> Option<(f64, f64)> {
        let ([u, v], distance) = self.foot(query, &mut scratch.marks, &mut scratch.statistics.proposal, None);
        distance.is_finite().then_some((u, v))
    }
}

/// The points along a curve, and on its cuts where those are not too many.
fn points(curve: &NurbsCurve, track: &Track, steps: Steps, most: usize) -> Decomposition {
    let cuts = if track.cuts().len() < most { track.cuts() } else { &[] };
    let steps = Steps { tolerance: steps.tolerance.max(1.0 / (steps.jitter * most as f64)), ..steps };
    decompose(|u| curve.point(u), &nodes(curve.knots(), curve.domain()), cuts, steps, most)
}

/// A curve is cut at breaks, cusps and loops; where it closes without a kink, it goes on over the seam.
fn curve_tracks(curve: &NurbsCurve, landmarks: &Landmarks, cuts: &[f64]) -> [Track; 2] {
    let (first, last) = curve.domain();
    let (mut before, mut after) = ([DVec3::ZERO; 2], [DVec3::ZERO; 2]);
    curve.derivatives_from_left(last, &mut before);
    curve.derivatives(first, &mut after);
    let wraps = landmarks.closed[0] && !turns(before[1], after[1], 0.0);
    let cuts = [&landmarks.breaks[0], &landmarks.cusps, cuts].concat();
    [Track::new((first, last), cuts, wraps), Track::new((0.0, 0.0), Vec::new(), false)]
}

/// A surface is cut at breaks; where it closes and no leg of its net turns there, it goes on over the seam.
fn surface_tracks(surface: &NurbsSurface, landmarks: &Landmarks) -> [Track; 2] {
    let (rows, columns) = (surface.rows(), surface.columns());
    let at = |i: usize, j: usize| surface.control_points()[i * columns + j];
    let smooth_u = (0..columns).all(|j| !turns(at(rows - 1, j) - at(rows - 2, j), at(1, j) - at(0, j), 0.0));
    let smooth_v = (0..rows).all(|i| !turns(at(i, columns - 1) - at(i, columns - 2), at(i, 1) - at(i, 0), 0.0));
    let track = |k: usize, direction, smooth: bool| {
        Track::new(surface.domain(direction), landmarks.breaks[k].clone(), landmarks.closed[k] && smooth)
    };
    [track(0, Direction::U, smooth_u), track(1, Direction::V, smooth_v)]
}
