//! An entity made ready for queries.

use std::sync::{Arc, OnceLock};

use glam::DVec3;
use perpend_kernel::{Aabb, Definition, Trimming};
use perpend_knowledge::Record;

use crate::answer::{Continuum, FootPoint, Method, Ties};
use crate::bernstein::{Bernstein, LocalPoint, LocalSet};
use crate::closed_form::ClosedForm;
use crate::dispatch::{Dispatched, dispatch};
use crate::exclusion::{Criteria, Exclusion};
use crate::foot::Reader;
use crate::hierarchy::{Frame, Hierarchy, TieSet};
use crate::landmarks::Landmarks;
use crate::plan::Plan;
use crate::query::{Query, QueryError, QueryOptions};
use crate::scratch::Scratch;
use crate::solver::{Proposer, Solution, Solved, Solver, Tie, unit_normal};
use crate::stationary::{StationaryOptions, StationaryPoint, StationaryPoints, parameter_box};
use crate::trimmed::Trimmed;
use crate::wave::{Wave, WaveSettings};

/// Stationary points closer than this share of the entity's size are not told apart unless a query asks for it.
const DEFAULT_TOLERANCE: f64 = 1e-6;

/// An entity made ready for queries: built once, immutable, shared by threads.
#[derive(Debug)]
pub struct Prepared {
    definition: Arc<Definition>,
    size: f64,
    reach: f64,
    landmarks: Landmarks,
    plan: Plan,
    closed_form: Option<ClosedForm>,
    /// What part of the definition counts, where not all of it does.
    trimmed: Option<Trimmed>,
    /// Built when the first query needs it: where a closed form answers, none may.
    hierarchy: OnceLock<Hierarchy>,
    /// Built when a query first names them.
    wave: OnceLock<Wave>,
    exclusion: OnceLock<Exclusion>,
    control_polygon: OnceLock<Exclusion>,
    bernstein: OnceLock<Bernstein>,
}

impl Prepared {
    /// Prepares a definition with what is known of it, and makes the plan by which its queries are answered.
    ///
    /// Knowledge is proved before it is believed: a record may be wrong, and answers stay true. What is not known and matters is
    /// acquired: the class, by recognition.
    #[must_use]
    pub fn new(definition: Arc<Definition>, record: Option<&Record>) -> Self {
        let landmarks = Landmarks::of(&definition);
        let Dispatched { plan, closed_form } = dispatch(&definition, record, &landmarks);
        Self {
            size: definition.size(),
            reach: definition.reach(),
            definition,
            landmarks,
            plan,
            closed_form,
            trimmed: None,
            hierarchy: OnceLock::new(),
            wave: OnceLock::new(),
            exclusion: OnceLock::new(),
            control_polygon: OnceLock::new(),
            bernstein: OnceLock::new(),
        }
    }

    /// The same of which only a trimmed part counts: the trim was validated against the definition, which is a surface.
    #[must_use]
    pub fn with_trimming(self, trimming: Arc<Trimming>) -> Self {
        let trimmed = Trimmed::new(&self.definition, trimming);
        Self { trimmed: Some(trimmed), ..self }
    }

    /// What part of the definition counts, where not all of it does.
    #[must_use]
    pub fn trimming(&self) -> Option<&Arc<Trimming>> {
        self.trimmed.as_ref().map(Trimmed::trimming)
    }

    /// A box that holds the entity: of the control points, or of those that a trim leaves.
    #[must_use]
    pub fn bounds(&self) -> Aabb {
        self.trimmed.as_ref().map_or_else(|| self.definition.control_box(), Trimmed::bounds)
    }

    /// The same with cells and samples as these settings ask, in place of those that the plan's settings give.
    #[must_use]
    pub fn with_wave(self, settings: WaveSettings) -> Self {
        let wave = Wave::with(Arc::clone(&self.definition), settings, &self.landmarks, &self.plan.settings.cuts);
        Self { wave: wave.into(), ..self }
    }

    /// The cells and samples of [`Method::Wave`], made when first asked for.
    #[must_use]
    pub fn wave(&self) -> &Wave {
        self.wave.get_or_init(|| {
            let settings = WaveSettings::of(&self.definition, &self.plan.settings);
            Wave::with(Arc::clone(&self.definition), settings, &self.landmarks, &self.plan.settings.cuts)
        })
    }

    /// The definition.
    #[must_use]
    pub fn definition(&self) -> &Arc<Definition> {
        &self.definition
    }

    /// How queries are answered, and why so.
    #[must_use]
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// The nearest point of the entity, with its proof; none where nothing lies within the query's `max_distance`.
    #[must_use]
    pub fn project(&self, query: &Query, scratch: &mut Scratch) -> Option<FootPoint> {
        self.project_near(query, None, scratch)
    }

    /// As [`project`](Self::project), and the same answer; `hint` is any point of the entity, best one near the foot. It spares
    /// the look at pieces that are farther away than it.
    #[must_use]
    pub fn project_near(&self, query: &Query, hint: Option<DVec3>, scratch: &mut Scratch) -> Option<FootPoint> {
        if let Some(trimmed) = &self.trimmed {
            return trimmed.project(query, self.closed_form.as_ref(), self.reader(), scratch);
        }
        let asked = query.options.method.unwrap_or(self.plan.method);
        if let Some(closed_form) = &self.closed_form
            && asked == closed_form.method()
        {
            match closed_form.solve(query, hint, scratch) {
                Solved::Foot(solution) => return Some(self.reader().answer(&solution, closed_form.method())),
                Solved::Beyond => return None,
                Solved::Declined => scratch.statistics.declined += 1,
            }
        }
        if let Some(proposer) = self.proposer(asked)
            && let Some(proposal) = proposer.propose(query, scratch)
        {
            let (solved, corrected) = self.hierarchy().prove(query, proposal, scratch);
            let method = if corrected { Method::Hierarchy } else { proposer.method() };
            return match solved {
                Solved::Foot(solution) => Some(self.reader().answer(&solution, method)),
                Solved::Beyond | Solved::Declined => None,
            };
        }
        match self.hierarchy().solve(query, hint, scratch) {
            Solved::Foot(solution) => Some(self.reader().answer(&solution, Method::Hierarchy)),
            Solved::Beyond | Solved::Declined => None,
        }
    }

    /// All nearest points of the entity, within the query's gap; none where nothing lies within its `max_distance`.
    #[must_use]
    pub fn project_ties(&self, query: &Query, scratch: &mut Scratch) -> Option<Ties> {
        let hierarchy = self.hierarchy();
        let TieSet { nearest, feet, continua, complete } = hierarchy.ties(query, &mut scratch.hierarchy)?;
        let answer = |local| self.reader().answer(&hierarchy.in_model_units(local), Method::Hierarchy);
        Some(Ties {
            nearest: answer(&nearest),
            points: feet.iter().map(answer).collect(),
            continua: continua.into_iter().map(|boxes| Continuum { boxes }).collect(),
            complete,
        })
    }

    /// All stationary points of the distance from `p`: minima, maxima and saddles, inside, on edges, creases, ends and corners.
    ///
    /// # Errors
    ///
    /// A coordinate that is no finite number or beyond 1e75; a tolerance that is negative or not a number.
    pub fn stationary_points(
        &self,
        p: DVec3,
        options: &StationaryOptions,
        scratch: &mut Scratch,
    ) -> Result<StationaryPoints, QueryError> {
        options.validate()?;
        let query = Query::new(p, QueryOptions::default())?;
        let bernstein = self.bernstein();
        let frame = bernstein.frame();
        let tolerance = options.tolerance.unwrap_or(DEFAULT_TOLERANCE * self.size) * frame.scale;
        let local = frame.enter(query.point);
        let work = &mut scratch.statistics.proof;
        let LocalSet { points, continua, complete } = bernstein.stationary(local, tolerance, options.work, work);
        scratch.statistics.queries += 1;
        Ok(StationaryPoints {
            points: points.iter().map(|point| self.stationary_point(point, local, frame)).collect(),
            continua: continua
                .into_iter()
                .map(|boxes| Continuum { boxes: boxes.into_iter().map(parameter_box).collect() })
                .collect(),
            complete,
        })
    }

    fn stationary_point(&self, found: &LocalPoint, p: DVec3, frame: &Frame) -> StationaryPoint {
        let [u, v] = found.at;
        let offset = (found.point - p) / frame.scale;
        let normal = match &*self.definition {
            Definition::NurbsCurve(_) => DVec3::ZERO,
            Definition::NurbsSurface(surface) => {
                let mut d = [DVec3::ZERO; 4];
                surface.derivatives(u, v, 1, &mut d);
                unit_normal(d[2], d[1])
            }
        };
        let (distance, tie) = (offset.length(), Tie::None);
        let solution = Solution { u, v, point: None, distance, lower_bound: 0.0, normal, offset, tie };
        let foot = self.reader().answer(&solution, Method::Bernstein);
        // a point of a seam is given at the lower parameter, and so is its box
        let moved = |d: usize, to: f64| if to == found.at[d] { found.range[d] } else { (to, to) };
        StationaryPoint {
            parameter: foot.parameter,
            point: foot.point,
            distance: foot.distance,
            kind: found.kind,
            place: foot.place,
            descends_inward: found.descends_inward,
            range: parameter_box([moved(0, foot.parameter.u()), moved(1, foot.parameter.v().unwrap_or(v))]),
            certainty: found.certainty,
        }
    }

    /// The solver of this method, where it is one that only proposes.
    fn proposer(&self, method: Method) -> Option<&dyn Proposer> {
        match method {
            Method::Analytic | Method::Hierarchy | Method::Trimmed => None,
            Method::Wave => Some(self.wave()),
            Method::Exclusion => Some(self.subdivision(&self.exclusion, Criteria::Selimovic)),
            Method::ControlPolygon => Some(self.subdivision(&self.control_polygon, Criteria::ControlPolygon)),
            Method::Bernstein => Some(self.bernstein()),
        }
    }

    fn subdivision<'a>(&self, cell: &'a OnceLock<Exclusion>, criteria: Criteria) -> &'a Exclusion {
        cell.get_or_init(|| Exclusion::new(&self.definition, criteria))
    }

    fn bernstein(&self) -> &Bernstein {
        self.bernstein.get_or_init(|| Bernstein::new(&self.definition, &self.landmarks))
    }

    fn hierarchy(&self) -> &Hierarchy {
        self.hierarchy.get_or_init(|| Hierarchy::new(&self.definition, &self.plan.settings.cuts))
    }

    fn reader(&self) -> Reader<'_> {
        Reader { definition: &self.definition, landmarks: &self.landmarks, size: self.size, reach: self.reach }
    }
}
