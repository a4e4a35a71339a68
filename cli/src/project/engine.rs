//! From a batch of rows to rows of answers, on all threads.

use std::collections::HashMap;

use perpend::{BodyError, BodyFoot, DVec3, EntityId, FootPoint, Model, Query, QueryError, QueryOptions, Scratch};
use rayon::prelude::*;

use crate::project::answer::{Layout, Named, Ranked};
use crate::project::points::{Batch, Row};
use crate::project::query::{self, Asked, Complaint};
use crate::project::tally::{Certified, Tally};

/// How many rows a thread takes at a time: enough that handing them out costs nothing beside them, and few enough that all
/// threads get some.
const ROWS: usize = 64;

/// What is asked of the rows.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Target {
    /// This entity.
    Entity(EntityId),
    /// The entity that the row names.
    Named,
    /// The nearest entity of the model.
    Nearest,
    /// So many of the nearest.
    Several(usize),
    /// All within this distance.
    Within(f64),
    /// The nearest face of this body, with the distance to the body signed or not.
    Body { id: EntityId, signed: bool },
}

impl Target {
    /// Whether a row may have several answers.
    pub(crate) fn is_ranked(self) -> bool {
        matches!(self, Self::Several(_) | Self::Within(_))
    }

    /// Whether a row is asked of one entity, and not of many.
    fn is_of_entity(self) -> bool {
        matches!(self, Self::Entity(_) | Self::Named)
    }
}

/// Answers rows.
pub(crate) struct Engine<'a> {
    pub(crate) model: &'a Model,
    pub(crate) target: Target,
    pub(crate) options: QueryOptions,
    pub(crate) layout: Layout<'a>,
    /// What counts as certified, per entity.
    pub(crate) of_entity: HashMap<EntityId, Certified>,
    /// And for the whole model.
    pub(crate) of_model: Certified,
}

/// The answers to some rows.
#[derive(Debug, Default)]
pub(crate) struct Answers {
    /// The rows to write.
    pub(crate) text: Vec<u8>,
    pub(crate) tally: Tally,
    pub(crate) complaints: Vec<Complaint>,
}

/// A thread's working memory; it never changes an answer.
#[derive(Default)]
struct Memory {
    scratch: Scratch,
    /// The last foot and its entity: the next query to it spares what is farther away.
    hint: Option<(EntityId, DVec3)>,
}

/// An answer: the entities and their feet, the nearest first; none within the maximum distance.
pub(crate) type Answer = Vec<(EntityId, FootPoint)>;

/// What a row asked with its answer, or what is wrong with it.
pub(crate) type Asking = Result<(Asked, Answer), Complaint>;

impl<'a> Engine<'a> {
    pub(crate) fn new(model: &'a Model, target: Target, options: QueryOptions, layout: Layout<'a>) -> Self {
        let of_entity = model.entities().iter().map(perpend::Entity::id);
        let of_entity = of_entity.filter_map(|id| Some((id, Certified::of_entity(model, id, options.gap)?))).collect();
        let of_model = Certified::of_model(model, options.gap);
        Self { model, target, options, layout, of_entity, of_model }
    }

    /// The answers to a batch, in order, in parts.
    pub(crate) fn answer(&self, batch: &Batch) -> Vec<Answers> {
        self.in_parts(batch, |rows, askings| {
            let mut answers = Answers::default();
            for (row, asking) in rows.iter().zip(askings) {
                self.take(*row, asking, &mut answers);
            }
            answers
        })
    }

    /// What the rows of a batch ask, each with its line and its answer, in order, in parts.
    pub(crate) fn ask(&self, batch: &Batch) -> Vec<Vec<(u64, Asking)>> {
        self.in_parts(batch, |rows, askings| rows.iter().map(|row| row.line()).zip(askings).collect())
    }

    /// Whether the answer to a point is certified.
    pub(crate) fn is_certified(&self, id: EntityId, foot: &FootPoint, point: DVec3) -> bool {
        self.certified(id).holds(foot, point.abs().max_element())
    }

    fn certified(&self, id: EntityId) -> Certified {
        if self.target.is_of_entity() { self.of_entity[&id] } else { self.of_model }
    }

    fn in_parts<T: Send>(&self, batch: &Batch, told: impl Fn(&[Row<'_>], Vec<Asking>) -> T + Sync) -> Vec<T> {
        (0..batch.len().div_ceil(ROWS))
            .into_par_iter()
            .map_init(Memory::default, |memory, part| {
                let end = batch.len().min((part + 1) * ROWS);
                let rows: Vec<Row<'_>> = (part * ROWS..end).map(|index| batch.row(index)).collect();
                told(&rows, self.ask_part(&rows, memory))
            })
            .collect()
    }

    fn ask_part(&self, rows: &[Row<'_>], memory: &mut Memory) -> Vec<Asking> {
        let asked: Vec<Result<Asked, Complaint>> =
            rows.iter().map(|row| query::read(*row, self.layout.columns, self.model)).collect();
        let points: Vec<DVec3> = asked.iter().flatten().map(|asked| asked.point).collect();
        let mut of_many = self.of_many(&points).into_iter();
        let mut askings = Vec::with_capacity(rows.len());
        for (row, asked) in rows.iter().zip(asked) {
            askings.push(asked.and_then(|asked| {
                let answer = match self.target {
                    Target::Entity(id) => self.project(id, asked.point, memory),
                    Target::Named => asked.entity.map_or(Ok(Vec::new()), |id| self.project(id, asked.point, memory)),
                    _ => of_many.next().unwrap_or(Ok(Vec::new())),
                };
                answer.map(|answer| (asked, answer)).map_err(|error| self.refused(*row, asked.point, error))
            }));
        }
        askings
    }

    /// The answers of the whole model, or of a body.
    fn of_many(&self, points: &[DVec3]) -> Vec<Result<Answer, BodyError>> {
        let (model, options) = (self.model, &self.options);
        let one = |answer: Result<Option<(EntityId, FootPoint)>, QueryError>| -> Result<Answer, BodyError> {
            Ok(answer?.into_iter().collect())
        };
        let many = |answer: Result<Answer, QueryError>| answer.map_err(BodyError::from);
        match self.target {
            Target::Entity(_) | Target::Named => Vec::new(),
            Target::Nearest => model.nearest_all(points, options).into_iter().map(one).collect(),
            Target::Several(k) => model.nearest_k_all(points, k, options).into_iter().map(many).collect(),
            Target::Within(radius) => model.within_all(points, radius, options).into_iter().map(many).collect(),
            Target::Body { id, signed: false } => {
                model.nearest_of_all(id, points, options).into_iter().map(one).collect()
            }
            Target::Body { id, signed: true } => {
                let signed = model.signed_distance_all(id, points, options);
                signed.into_iter().zip(points).map(|(answer, p)| self.signed(id, *p, answer)).collect()
            }
        }
    }

    /// The answer of a body, with the sign of the body; none beyond the maximum distance.
    fn signed(&self, body: EntityId, p: DVec3, answer: Result<BodyFoot, BodyError>) -> Result<Answer, BodyError> {
        let BodyFoot { face, foot, signed_distance, .. } = answer?;
        let limit = self.options.max_distance;
        let is_within = limit.is_none_or(|limit| foot.distance <= limit)
            || self.model.nearest_of(body, p, &self.options)?.is_some();
        let foot = FootPoint { signed_distance: Some(signed_distance), ..foot };
        Ok(is_within.then_some((face, foot)).into_iter().collect())
    }

    fn project(&self, id: EntityId, point: DVec3, memory: &mut Memory) -> Result<Answer, BodyError> {
        let entity = self.model.entity(id).ok_or(QueryError::UnknownEntity { id })?;
        let query = Query::new(point, self.options)?;
        let hint = memory.hint.filter(|(of, _)| *of == id).map(|(_, foot)| foot);
        let foot = entity.prepared().project_near(&query, hint, &mut memory.scratch);
        memory.hint = foot.map(|foot| (id, foot.point)).or(memory.hint);
        Ok(foot.map(|foot| (id, foot)).into_iter().collect())
    }

    fn refused(&self, row: Row<'_>, point: DVec3, error: BodyError) -> Complaint {
        match error {
            BodyError::Query(QueryError::InvalidPoint { .. }) => {
                let problem = "the coordinate is beyond ±1e75; give a smaller one".to_owned();
                Complaint::out_of_range(row, self.layout.columns, point, problem)
            }
            other => Complaint::refused(row, other.to_string()),
        }
    }

    /// Writes and counts the answers to a row.
    fn take(&self, row: Row<'_>, asking: Asking, answers: &mut Answers) {
        answers.tally.rows += 1;
        let feet = match asking {
            Ok((asked, feet)) => {
                answers.tally.beyond += u64::from(feet.is_empty());
                for (id, foot) in &feet {
                    answers.tally.answer(foot, asked.point.abs().max_element(), self.certified(*id));
                }
                feet
            }
            Err(complaint) => {
                answers.tally.bad += 1;
                answers.complaints.push(complaint);
                Vec::new()
            }
        };
        let named = |id: Option<EntityId>| match self.target {
            Target::Entity(id) => Named::Id(Some(id)),
            Target::Named => {
                Named::Written(self.layout.columns.entity.and_then(|at| row.field(at)).unwrap_or_default())
            }
            _ => Named::Id(id),
        };
        if feet.is_empty() {
            self.layout.row(&mut answers.text, row, named(None), None);
        }
        for (k, (id, foot)) in feet.iter().enumerate() {
            self.layout.row(&mut answers.text, row, named(Some(*id)), Some(Ranked { rank: k + 1, foot }));
        }
    }
}
