//! Acquiring knowledge.

use std::sync::OnceLock;

use perpend_kernel::EntityId;
use perpend_knowledge::{AcquireOptions, Record};

use crate::edit::EditError;
use crate::entity::Entity;
use crate::model::Model;

impl Model {
    /// Acquires what is absent or stale of an entity's class and representation: speeds and parametrisation factors, continuity,
    /// irregularities, box, length or area. What a person declared stays as it is. Says whether anything was learned.
    ///
    /// The revision does not rise: the entity is as it was.
    ///
    /// # Errors
    ///
    /// An unknown id.
    pub fn learn(&mut self, id: EntityId) -> Result<bool, EditError> {
        self.learn_with(id, &AcquireOptions::default())
    }

    /// As [`learn`](Self::learn), with tolerances and a table of parametrisation categories of the application's own.
    ///
    /// # Errors
    ///
    /// An unknown id.
    pub fn learn_with(&mut self, id: EntityId, options: &AcquireOptions) -> Result<bool, EditError> {
        let at = self.position(id)?;
        let learned = learned(&self.entities[at], options);
        Ok(self.keep(at, learned))
    }

    /// As [`learn`](Self::learn), of all entities, on all cores where the feature `rayon` is on. Says of how many anything was
    /// learned.
    pub fn learn_all(&mut self) -> usize {
        self.learn_all_with(&AcquireOptions::default())
    }

    /// As [`learn_all`](Self::learn_all), with tolerances and a table of parametrisation categories of the application's own.
    pub fn learn_all_with(&mut self, options: &AcquireOptions) -> usize {
        let learned = all(&self.entities, |entity| learned(entity, options));
        learned.into_iter().enumerate().map(|(at, record)| usize::from(self.keep(at, record))).sum()
    }

    fn keep(&mut self, at: usize, record: Option<Record>) -> bool {
        let is_new = record.is_some();
        if is_new {
            // a plan is made from what is known
            self.entities[at].record = record;
            self.entities[at].prepared = OnceLock::new();
            self.overview = OnceLock::new();
        }
        is_new
    }
}

/// The entity's record with what is absent or stale acquired; none where nothing is.
fn learned(entity: &Entity, options: &AcquireOptions) -> Option<Record> {
    let mut record = entity.record.clone().unwrap_or_default();
    record.learn(&entity.definition, options).then_some(record)
}

/// An entity at a time for each thread: one may take as long as a thousand others.
#[cfg(feature = "rayon")]
fn all<A: Send>(entities: &[Entity], of: impl Fn(&Entity) -> A + Sync + Send) -> Vec<A> {
    use rayon::prelude::*;
    entities.par_iter().with_max_len(1).map(of).collect()
}

#[cfg(not(feature = "rayon"))]
fn all<A: Send>(entities: &[Entity], of: impl Fn(&Entity) -> A + Sync + Send) -> Vec<A> {
    entities.iter().map(of).collect()
}
