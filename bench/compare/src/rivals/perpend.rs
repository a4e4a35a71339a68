//! perpend itself: every method, with knowledge and without, prepared and cold, on one thread and on all.

use std::hint::black_box;
use std::sync::Arc;
use std::time::{Duration, Instant};

use perpend::knowledge::AcquireOptions;
use perpend::{DVec3, Definition, EntityId, FootPoint, Method, Model, Prepared, Query, QueryOptions, Record, Scratch};

use crate::Failure;
use crate::case::{Case, Set};
use crate::contender::{Answer, Ask, Contender, Entrant, Own, Pace};

/// The name of the row that ratios are taken to: one thread, prepared, and nothing of a class used.
pub(crate) const REFERENCE: &str = "perpend hierarchy, nothing known";
/// The name of the row that answers by the class that was learned.
pub(crate) const RECOGNISED: &str = "perpend plan, learned";

/// How a row asks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Use {
    /// Prepared, one thread.
    Warm,
    /// Through `Model::projector`: each query has the last foot as its hint.
    Projector,
    /// Through `Model::project_all`.
    AllThreads,
    /// Prepared anew for each query.
    Cold,
}

struct Perpend {
    /// None: the plan's own.
    method: Option<Method>,
    /// With a record that was learned, or none.
    is_learned: bool,
    usage: Use,
}

pub(super) fn contenders() -> Vec<Box<dyn Contender>> {
    let methods = [
        None,
        Some(Method::Hierarchy),
        Some(Method::Wave),
        Some(Method::Exclusion),
        Some(Method::ControlPolygon),
        Some(Method::Bernstein),
    ];
    let mut rows: Vec<Box<dyn Contender>> = Vec::new();
    for method in methods {
        for is_learned in [true, false] {
            rows.push(Box::new(Perpend { method, is_learned, usage: Use::Warm }));
        }
    }
    for usage in [Use::Projector, Use::AllThreads, Use::Cold] {
        rows.push(Box::new(Perpend { method: None, is_learned: true, usage }));
        rows.push(Box::new(Perpend { method: Some(Method::Hierarchy), is_learned: false, usage }));
    }
    rows.push(Box::new(Perpend { method: None, is_learned: false, usage: Use::Cold }));
    rows
}

impl Contender for Perpend {
    fn name(&self) -> String {
        let method = match self.method {
            None => "plan",
            Some(Method::Analytic) => "closed form",
            Some(Method::Hierarchy) => "hierarchy",
            Some(Method::Wave) => "wave",
            Some(Method::Exclusion) => "exclusion",
            Some(Method::ControlPolygon) => "control polygon",
            Some(Method::Bernstein) => "Bernstein",
            Some(Method::Trimmed) => "trimmed",
        };
        let known = if self.is_learned { "learned" } else { "nothing known" };
        let usage = match self.usage {
            Use::Warm => "",
            Use::Projector => ", projector",
            Use::AllThreads => ", all threads",
            Use::Cold => ", cold",
        };
        format!("perpend {method}, {known}{usage}")
    }

    fn pace(&self, _: Set) -> Pace {
        match (self.method, self.usage) {
            (_, Use::Cold) => Pace::Few,
            (None | Some(Method::Analytic | Method::Hierarchy | Method::Trimmed), _) => Pace::All,
            (Some(Method::Wave | Method::Exclusion | Method::ControlPolygon | Method::Bernstein), _) => Pace::Few,
        }
    }

    fn enter(&self, case: &Case, _: &[DVec3]) -> Result<Option<Box<dyn Entrant>>, Failure> {
        let definition = Definition::clone(&case.definition);
        let options = QueryOptions { method: self.method, ..QueryOptions::default() };
        if matches!(self.usage, Use::Projector | Use::AllThreads) {
            let mut model = Model::new();
            let id = model.insert("", definition)?;
            if self.is_learned {
                model.learn(id)?;
            }
            let in_model = InModel { model, id, options };
            return Ok(Some(if self.usage == Use::Projector {
                Box::new(InTurn(in_model))
            } else {
                Box::new(Together(in_model))
            }));
        }
        let record = self.is_learned.then(|| {
            let mut record = Record::default();
            record.learn(&definition, &AcquireOptions::default());
            record
        });
        let definition = Arc::new(definition);
        Ok(Some(if self.usage == Use::Cold {
            Box::new(Cold { definition, record, options })
        } else {
            let prepared = Prepared::new(definition, record.as_ref());
            Box::new(Warm { prepared, scratch: Scratch::default(), options })
        }))
    }
}

impl From<FootPoint> for Answer {
    fn from(foot: FootPoint) -> Self {
        Self { distance: foot.distance, parameter: Some(foot.parameter), lower_bound: Some(foot.lower_bound) }
    }
}

struct Warm {
    prepared: Prepared,
    scratch: Scratch,
    options: QueryOptions,
}

impl Ask for Warm {
    fn ask(&mut self, p: DVec3) -> Option<Answer> {
        let query = Query::new(p, self.options).ok()?;
        black_box(self.prepared.project(&query, &mut self.scratch)).map(Answer::from)
    }
}

struct Cold {
    definition: Arc<Definition>,
    record: Option<Record>,
    options: QueryOptions,
}

impl Ask for Cold {
    fn ask(&mut self, p: DVec3) -> Option<Answer> {
        let prepared = Prepared::new(Arc::clone(&self.definition), self.record.as_ref());
        let query = Query::new(p, self.options).ok()?;
        black_box(prepared.project(&query, &mut Scratch::default())).map(Answer::from)
    }
}

struct InModel {
    model: Model,
    id: EntityId,
    options: QueryOptions,
}

/// One after the other, in their order.
struct InTurn(InModel);

impl Entrant for InTurn {
    fn judge(&mut self, points: &[DVec3], answers: &mut [Option<Answer>]) -> Result<(), Failure> {
        let mut projector = self.0.model.projector(self.0.id)?;
        for (p, answer) in points.iter().zip(answers) {
            *answer = projector.project(*p, &self.0.options)?.map(Answer::from);
        }
        Ok(())
    }

    fn pass(&mut self, points: &[DVec3], stride: usize) -> Result<Duration, Failure> {
        let start = Instant::now();
        let mut projector = self.0.model.projector(self.0.id)?;
        for p in points.iter().step_by(stride) {
            let _foot = black_box(projector.project(black_box(*p), &self.0.options));
        }
        Ok(start.elapsed())
    }
}

/// All at once, on all threads.
struct Together(InModel);

impl Entrant for Together {
    fn judge(&mut self, points: &[DVec3], answers: &mut [Option<Answer>]) -> Result<(), Failure> {
        let feet = self.0.model.project_all(self.0.id, points, &self.0.options);
        for (foot, answer) in feet.into_iter().zip(answers) {
            *answer = foot?.map(Answer::from);
        }
        Ok(())
    }

    fn pass(&mut self, points: &[DVec3], stride: usize) -> Result<Duration, Failure> {
        let points: Vec<DVec3> = points.iter().step_by(stride).copied().collect();
        let start = Instant::now();
        black_box(self.0.model.project_all(self.0.id, black_box(&points), &self.0.options));
        Ok(start.elapsed())
    }

    /// Its threads allocate apart, out of the count's sight; the warm row holds the same.
    fn own(&self) -> Own {
        Own { is_heap_unseen: true, ..Own::default() }
    }
}
