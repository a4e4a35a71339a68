//! Edits of a model. Each either happens whole or leaves the model as it was.

use std::sync::{Arc, OnceLock};

use perpend_kernel::{EntityId, InvalidDefinition, InvalidEdit};
use perpend_knowledge::{InvalidTolerance, NonFinite, Record};

use crate::enter::IntoDefinition;
use crate::entity::Entity;
use crate::model::Model;
use crate::rebuild::{RebuildError, Staged};
use crate::trimmed::InvalidTrimmedSurface;

/// Why an edit was refused. The model is as it was.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EditError {
    /// The model has no entity of this id.
    #[error("the model has no entity {id}")]
    UnknownEntity {
        /// The id.
        id: EntityId,
    },
    /// The new definition breaks a rule.
    #[error("entity {id}: definition: {source}")]
    Definition {
        /// The entity to be edited.
        id: EntityId,
        /// The rule.
        source: InvalidDefinition,
    },
    /// A number of the new record is not finite.
    #[error("entity {id}: knowledge: {source}")]
    Knowledge {
        /// The entity to be edited.
        id: EntityId,
        /// The number.
        source: NonFinite,
    },
    /// The new record refers to an entity that the model does not have.
    #[error("entity {id}: knowledge: {field} is {target}, which the model does not have: insert that entity first")]
    DanglingReference {
        /// The entity to be edited.
        id: EntityId,
        /// The field that holds the reference.
        field: String,
        /// The entity that is missing.
        target: EntityId,
    },
    /// An entity that is made of the edited one cannot be rebuilt, or the new record makes an entity of itself.
    #[error(transparent)]
    Rebuild(Box<RebuildError>),
    /// Another entity's record refers to the entity that is to be removed.
    #[error(
        "entity {id} is in use: knowledge.{field} of entity {by} refers to it; change that record or remove entity {by} first"
    )]
    InUse {
        /// The entity that was to be removed.
        id: EntityId,
        /// The entity that refers to it.
        by: EntityId,
        /// The field that holds the reference.
        field: String,
    },
    /// The entity that is to be removed is a part of a trimmed face or a body.
    #[error("entity {id} is in use: {field} of entity {by} names it; remove or replace entity {by} first")]
    PartOf {
        /// The entity that was to be removed.
        id: EntityId,
        /// The face or body that it is a part of.
        by: EntityId,
        /// The field that names it.
        field: String,
    },
    /// The new trimmed face breaks a rule.
    #[error("entity {id}: definition: {source}")]
    Trimmed {
        /// The entity to be edited.
        id: EntityId,
        /// The rule.
        source: Box<InvalidTrimmedSurface>,
    },
    /// The face trims another entity, and follows that.
    #[error("entity {id} trims entity {carrier} and follows it: prepare entity {carrier}")]
    FollowsCarrier {
        /// The face.
        id: EntityId,
        /// The entity that it trims.
        carrier: EntityId,
    },
    /// The model has no body of this id.
    #[error("the model has no body {id}")]
    UnknownBody {
        /// The id.
        id: EntityId,
    },
    /// A colour has a part that is no share of light.
    #[error("entity {id}: colour is ({:?}, {:?}, {:?}); red, green and blue are from 0 to 1", colour[0], colour[1], colour[2])]
    Colour {
        /// The entity or body.
        id: EntityId,
        /// What was given.
        colour: [f64; 3],
    },
    /// The tolerance of a consent is no length above 0.
    #[error("entity {id}: {source}")]
    Tolerance {
        /// The entity to be purged.
        id: EntityId,
        /// The tolerance.
        source: InvalidTolerance,
    },
    /// Curves alone are taken apart.
    #[error("entity {id} is a surface; curves are taken apart: choose one")]
    NotACurve {
        /// The entity.
        id: EntityId,
    },
    /// A curve could not be taken apart.
    #[error("entity {id}: {source}")]
    Decompose {
        /// The curve.
        id: EntityId,
        /// Why not.
        source: InvalidEdit,
    },
    /// The model has given nearly all ids, and those of the parts are not left.
    #[error(
        "entity {id}: its {count} parts need ids, and the model has given those up to {last}: lower `next_id` and the highest ids in its file"
    )]
    NoIds {
        /// The curve.
        id: EntityId,
        /// How many ids are needed.
        count: usize,
        /// The last id that counts as given.
        last: u64,
    },
    /// No original is kept of the entity.
    #[error("entity {id} has no original: it was not purged, or its original was dropped")]
    NoOriginal {
        /// The entity.
        id: EntityId,
    },
}

impl Model {
    /// Adds an entity as the last one and returns its id. Names need not be unique.
    ///
    /// Unclamped knots are clamped, and the record says so; an analytic shape enters with its class and the operation that makes
    /// it.
    ///
    /// # Errors
    ///
    /// The first rule that the defining data break.
    ///
    /// # Panics
    ///
    /// After 2⁶⁴ - 1 ids.
    pub fn insert(&mut self, name: &str, definition: impl IntoDefinition) -> Result<EntityId, InvalidDefinition> {
        let entered = definition.enter()?;
        let id = self.give_id();
        let mut record = None;
        entered.note(&mut record);
        self.push(Entity::new(id, name.to_owned(), entered.definition, record));
        Ok(id)
    }

    /// A new id.
    pub(crate) fn give_id(&mut self) -> EntityId {
        let id = EntityId::new(self.next_id);
        self.next_id = self.next_id.checked_add(1).expect("a model has ids for 2^64 - 1 entities");
        id
    }

    /// Adds an entity as the last one.
    pub(crate) fn push(&mut self, entity: Entity) {
        self.index.insert(entity.id, self.entities.len());
        self.entities.push(entity);
        self.overview = OnceLock::new();
    }

    /// Gives an entity a new definition and raises its revision; then all that is made of it is made anew, in order of
    /// dependence: all or nothing.
    ///
    /// Knowledge that was computed from the old definition is forgotten. Origin, destination, intent and relationships stay:
    /// only those who stated them can say whether they still hold. So an entity that an operation had made is *overridden*: it
    /// keeps the definition that it was given here when its inputs change, until it is [rebuilt](Self::rebuild),
    /// [remade](Self::remake) or replaced by an analytic shape, whose own operation then is what makes it.
    ///
    /// The original of an entity that was purged goes with the definition that was made of it. A trimmed face is no longer trimmed
    /// then; [`replace_trimmed`](Self::replace_trimmed) gives it another trim. Faces that trim the entity follow it.
    ///
    /// # Errors
    ///
    /// An unknown id; the first rule that the defining data break; an entity that is made of this one and cannot be rebuilt.
    pub fn replace(&mut self, id: EntityId, definition: impl IntoDefinition) -> Result<(), EditError> {
        let at = self.position(id)?;
        let entered = definition.enter().map_err(|source| EditError::Definition { id, source })?;
        let mut record = self.entities[at].record.clone().unwrap_or_default();
        record.revision = record.revision.saturating_add(1);
        record.forget_stale(entered.definition.fingerprint());
        let mut record = Some(record);
        entered.note(&mut record);
        let is_same = entered.definition == *self.entities[at].definition;
        let mut staged = Staged::new(self);
        staged.set_with(id, Arc::new(entered.definition), record, None);
        if !is_same {
            staged.spread(id).map_err(|error| EditError::Rebuild(Box::new(error)))?;
        }
        let changes = staged.changes(id).map_err(|error| EditError::Rebuild(Box::new(error)))?;
        self.take_over(changes);
        Ok(())
    }

    /// Gives an entity a new name and raises its revision.
    ///
    /// # Errors
    ///
    /// An unknown id.
    pub fn rename(&mut self, id: EntityId, name: &str) -> Result<(), EditError> {
        let at = self.position(id)?;
        name.clone_into(&mut self.entities[at].name);
        self.edited(at);
        Ok(())
    }

    /// Gives an entity a new record. Its revision becomes the record's, but never falls.
    ///
    /// # Errors
    ///
    /// An unknown id; a number that is not finite; a reference to an entity that the model does not have; steps that would make
    /// the entity of itself.
    pub fn set_record(&mut self, id: EntityId, record: Record) -> Result<(), EditError> {
        let at = self.position(id)?;
        record.validate().map_err(|source| EditError::Knowledge { id, source })?;
        for (field, target) in record.references() {
            if self.entity(target).is_none() {
                return Err(EditError::DanglingReference { id, field, target });
            }
        }
        let inputs = record.made_from();
        self.check_inputs(id, inputs.iter()).map_err(|error| EditError::Rebuild(Box::new(error)))?;
        let entity = &mut self.entities[at];
        let revision = entity.revision().max(record.revision);
        entity.record = Some(Record { revision, ..record });
        entity.prepared = OnceLock::new();
        self.overview = OnceLock::new();
        Ok(())
    }

    /// Removes an entity and returns it. Its id is not given again.
    ///
    /// # Errors
    ///
    /// An unknown id; another entity's record that refers to it; a face or a body that it is a part of.
    pub fn remove(&mut self, id: EntityId) -> Result<Entity, EditError> {
        let at = self.position(id)?;
        for other in self.entities.iter().filter(|other| other.id != id) {
            let references = other.record.as_ref().map_or_else(Vec::new, Record::references);
            if let Some((field, _)) = references.into_iter().find(|(_, target)| *target == id) {
                return Err(EditError::InUse { id, by: other.id, field });
            }
        }
        if let Some(one) = self.uses(id).next() {
            return Err(EditError::PartOf { id, by: one.by, field: one.field() });
        }
        let entity = self.entities.remove(at);
        self.index.remove(&id);
        for (at, entity) in self.entities.iter().enumerate().skip(at) {
            self.index.insert(entity.id, at);
        }
        self.overview = OnceLock::new();
        Ok(entity)
    }

    pub(crate) fn position(&self, id: EntityId) -> Result<usize, EditError> {
        self.index.get(&id).copied().ok_or(EditError::UnknownEntity { id })
    }

    pub(crate) fn edited(&mut self, at: usize) {
        let record = self.entities[at].record.get_or_insert_default();
        record.revision = record.revision.saturating_add(1);
        self.overview = OnceLock::new();
    }
}
