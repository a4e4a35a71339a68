//! From a batch of rows to rows of answers, on all threads.

use std::collections::HashMap;

use perpend::{Body, BodyError, BodyFoot, DVec3, EntityId, FootPoint, Model, Query, QueryError, QueryOptions, Scratch};
use rayon::prelude::*;

use crate::project::answer::{Layout, Named};
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
    /// The nearest face of this body; where the body is closed the sign is its own: negative inside.
    Body(EntityId),
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

/// An answer: the entity and the foot, or none within the maximum distance.
pub(crate) type Answer = Option<(EntityId, FootPoint)>;

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
        match self.target {
            Target::Nearest | Target::Body(_) => self.of_model,
            Target::Entity(_) | Target::Named => self.of_entity[&id],
        }
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
        let mut nearest = match self.target {
            Target::Nearest => self.model.nearest_all(&points, &self.options).into_iter(),
            Target::Body(body) => self.of_body(body, &points).into_iter(),
            Target::Entity(_) | Target::Named => Vec::new().into_iter(),
        };
        let mut askings = Vec::with_capacity(rows.len());
        for (row, asked) in rows.iter().zip(asked) {
            askings.push(asked.and_then(|asked| {
                let answer = match self.target {
                    Target::Nearest | Target::Body(_) => nearest.next().unwrap_or(Ok(None)),
                    Target::Entity(id) => self.project(id, asked.point, memory),
                    Target::Named => asked.entity.map_or(Ok(None), |id| self.project(id, asked.point, memory)),
                };
                answer.map(|answer| (asked, answer)).map_err(|error| self.refused(*row, asked.point, &error))
            }));
        }
        askings
    }

    fn project(&self, id: EntityId, point: DVec3, memory: &mut Memory) -> Result<Answer, QueryError> {
        let entity = self.model.entity(id).ok_or(QueryError::UnknownEntity { id })?;
        let query = Query::new(point, self.options)?;
        let hint = memory.hint.filter(|(of, _)| *of == id).map(|(_, foot)| foot);
        let foot = entity.prepared().project_near(&query, hint, &mut memory.scratch);
        memory.hint = foot.map(|foot| (id, foot.point)).or(memory.hint);
        Ok(foot.map(|foot| (id, foot)))
    }

    fn of_body(&self, body: EntityId, points: &[DVec3]) -> Vec<Result<Answer, QueryError>> {
        if !self.model.body(body).is_some_and(Body::is_closed) {
            return self.model.nearest_of_all(body, points, &self.options);
        }
        let signed = self.model.signed_distance_all(body, points, &self.options).into_iter();
        let answer = |(signed, point): (Result<BodyFoot, BodyError>, &DVec3)| match signed {
            Ok(BodyFoot { face, foot, signed_distance, .. }) => {
                Ok(Some((face, FootPoint { signed_distance: Some(signed_distance), ..foot })))
            }
            Err(BodyError::Query(error)) => Err(error),
            // the faces do not tell the side
            Err(_) => {
                let nearest = self.model.nearest_of(body, *point, &self.options)?;
                Ok(nearest.map(|(face, foot)| (face, FootPoint { signed_distance: None, ..foot })))
            }
        };
        signed.zip(points).map(answer).collect()
    }

    fn refused(&self, row: Row<'_>, point: DVec3, error: &QueryError) -> Complaint {
        let problem = match error {
            QueryError::InvalidPoint { .. } => "the coordinate is beyond ±1e75; give a smaller one".to_owned(),
            other => other.to_string(),
        };
        Complaint::out_of_range(row, self.layout.columns, point, problem)
    }

    /// Writes and counts the answer to a row.
    fn take(&self, row: Row<'_>, asking: Asking, answers: &mut Answers) {
        answers.tally.rows += 1;
        let answer = match asking {
            Ok((asked, Some((id, foot)))) => {
                answers.tally.answer(&foot, asked.point.abs().max_element(), self.certified(id));
                Some((id, foot))
            }
            Ok((_, None)) => {
                answers.tally.beyond += 1;
                None
            }
            Err(complaint) => {
                answers.tally.bad += 1;
                answers.complaints.push(complaint);
                None
            }
        };
        let named = match self.target {
            Target::Entity(id) => Named::Id(Some(id)),
            Target::Named => {
                Named::Written(self.layout.columns.entity.and_then(|at| row.field(at)).unwrap_or_default())
            }
            Target::Nearest | Target::Body(_) => Named::Id(answer.map(|(id, _)| id)),
        };
        self.layout.row(&mut answers.text, row, named, answer.as_ref().map(|(_, foot)| foot));
    }
}
