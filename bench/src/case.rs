//! Queries to one entity, asked again and again: what one costs.

use std::sync::Arc;
use std::time::Instant;

use glam::DVec3;
use perpend_projection::{FootPoint, Prepared, Query, QueryError, QueryOptions, Scratch};

/// How often a pass asks its queries; the fastest counts. The first finds the caches as another entity left them.
const TURNS: usize = 2;

/// An entity with queries, and the time that they take.
#[derive(Debug)]
pub struct Case {
    /// What is asked.
    pub name: String,
    /// The fastest mean time of a query so far, in microseconds.
    pub micros: f64,
    prepared: Arc<Prepared>,
    queries: Vec<Query>,
    hinted: bool,
    repeats: usize,
    scratch: Scratch,
}

impl Case {
    /// Queries at points, all with the same options.
    ///
    /// # Errors
    ///
    /// A point or an option that no query may have.
    pub fn new(
        name: impl Into<String>,
        prepared: &Arc<Prepared>,
        points: impl IntoIterator<Item = DVec3>,
        options: QueryOptions,
    ) -> Result<Self, QueryError> {
        let queries: Vec<Query> = points.into_iter().map(|p| Query::new(p, options)).collect::<Result<_, _>>()?;
        // a turn of few queries is too short for the clock
        let repeats = 50_usize.div_ceil(queries.len().max(1));
        Ok(Self {
            name: name.into(),
            micros: f64::INFINITY,
            prepared: Arc::clone(prepared),
            queries,
            hinted: false,
            repeats,
            scratch: Scratch::default(),
        })
    }

    /// The same, each query with the foot of the one before as its hint.
    #[must_use]
    pub fn hinted(self) -> Self {
        Self { hinted: true, ..self }
    }

    /// How many queries there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.queries.len()
    }

    /// Whether nothing is asked.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.queries.is_empty()
    }

    /// Asks all queries; the answers go nowhere.
    pub fn ask_all(&mut self) {
        self.ask(|foot| {
            std::hint::black_box(foot);
        });
    }

    /// The answers, in order.
    pub fn answers(&mut self) -> Vec<FootPoint> {
        let mut answers = Vec::with_capacity(self.queries.len());
        self.ask(|foot| answers.push(foot));
        answers
    }

    /// Asks all queries, and keeps the mean time of one if it is the fastest so far.
    pub fn time(&mut self) {
        for _ in 0..TURNS {
            let start = Instant::now();
            for _ in 0..self.repeats {
                self.ask_all();
            }
            let mean = start.elapsed().as_secs_f64() * 1e6 / (self.queries.len() * self.repeats) as f64;
            self.micros = self.micros.min(mean);
        }
    }

    fn ask(&mut self, mut take: impl FnMut(FootPoint)) {
        let mut hint = None;
        for query in &self.queries {
            let foot = self.prepared.project_near(query, hint, &mut self.scratch).expect("no distance limit");
            hint = self.hinted.then_some(foot.point);
            take(foot);
        }
    }
}

/// Times cases in turn, `passes` times: a disturbance then falls on one pass of many cases and not on all passes of one.
pub fn time_all(cases: &mut [Case], passes: usize) {
    for _ in 0..passes {
        cases.iter_mut().for_each(Case::time);
    }
}

/// The geometric mean of the cases' times, in microseconds.
#[must_use]
pub fn geometric_mean(cases: &[Case]) -> f64 {
    let logarithms: f64 = cases.iter().map(|case| case.micros.ln()).sum();
    (logarithms / cases.len() as f64).exp()
}

/// The case that takes longest; none where there are none.
#[must_use]
pub fn slowest(cases: &[Case]) -> Option<&Case> {
    cases.iter().max_by(|a, b| a.micros.total_cmp(&b.micros))
}
