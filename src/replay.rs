//! What the steps of an entity give today, beside what it is.

use perpend_kernel::{Definition, EntityId};
use perpend_knowledge::{
    BuildError, Checked, Definitions, Deviation, MakingError, Record, default_tolerance, deviation,
};

use crate::model::Model;
use crate::standing::Standing;

/// What the steps of an entity give today, beside what it is.
#[derive(Debug, Clone, PartialEq)]
pub struct Replay {
    /// What they give.
    pub definition: Definition,
    /// How far the entity's definition is from that, parameter by parameter.
    pub drift: Deviation,
    /// Whether the definition was replaced by hand after the steps had made it.
    pub is_overridden: bool,
}

/// Why an entity could not be replayed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ReplayError {
    /// The model has no entity of this id.
    #[error("the model has no entity {id}")]
    UnknownEntity {
        /// The id.
        id: EntityId,
    },
    /// The record does not say how the entity was made.
    #[error("entity {id}: its record does not say how it was made; state its intent, or remake it by an operation")]
    NotMade {
        /// The entity.
        id: EntityId,
    },
    /// No relationship says by which operation, with all its parameters, the entity is related.
    #[error(
        "entity {id}: its relationships do not name one operation with all its parameters, so they cannot be checked"
    )]
    Unrelated {
        /// The entity.
        id: EntityId,
    },
    /// An operation cannot be run.
    #[error("entity {id}: {source}")]
    Build {
        /// The entity.
        id: EntityId,
        /// What it lacks.
        source: Box<BuildError>,
    },
}

fn failed(id: EntityId, error: MakingError) -> ReplayError {
    match error {
        MakingError::UnknownEntity { id } => ReplayError::UnknownEntity { id },
        MakingError::Build(source) => ReplayError::Build { id, source: Box::new(source) },
        _ => ReplayError::NotMade { id },
    }
}

impl Model {
    /// Runs the steps that made an entity again and reports how far it is from what they give. Nothing is changed.
    ///
    /// The steps are those of the record's intent, from the last one on that starts afresh; a record without intent is
    /// replayed by its relationships, where these name an operation with all its parameters. Data that were entered are their
    /// own replay.
    ///
    /// An entity that perpend made, and whose inputs changed by perpend's own edits alone, has a drift of 0: the same
    /// operation on the same inputs gives the same bits.
    ///
    /// # Errors
    ///
    /// An unknown id; a record that does not say how the entity was made; a step that cannot be run, among them those that only
    /// an application can run.
    pub fn replay(&self, id: EntityId) -> Result<Replay, ReplayError> {
        let entity = self.entity(id).ok_or(ReplayError::UnknownEntity { id })?;
        let making = entity.record.as_ref().and_then(Record::making).ok_or(ReplayError::NotMade { id })?;
        let hash = entity.definition.fingerprint();
        if making.is_by_data() && making.last().is_some_and(|step| step.of.is_none_or(|of| of == hash)) {
            let definition = entity.definition.as_ref().clone();
            let drift = deviation(&definition, &definition);
            return Ok(Replay { definition, drift, is_overridden: false });
        }
        let definition = making.run(self).map_err(|error| failed(id, error))?.definition;
        let drift = deviation(&definition, &entity.definition);
        let is_overridden = Standing::of(entity, self) == Standing::Overridden;
        Ok(Replay { definition, drift, is_overridden })
    }

    /// Runs the operation of which the relationships of an entity speak, with the parameters that stand there, and notes in
    /// each of them how far the entity was from that: `checked`. Neither the definition nor the revision change.
    ///
    /// # Errors
    ///
    /// As [`replay`](Self::replay); relationships that do not name one operation with all its parameters.
    pub fn check_relationships(&mut self, id: EntityId) -> Result<Deviation, ReplayError> {
        let entity = self.entity(id).ok_or(ReplayError::UnknownEntity { id })?;
        let related = entity.record.as_ref().map_or_else(Vec::new, |record| record.relationships.clone());
        let edges = Record { relationships: related, ..Record::default() };
        let making = edges.making().ok_or(ReplayError::Unrelated { id })?;
        let replayed = making.run(self).map_err(|error| failed(id, error))?.definition;
        let drift = deviation(&replayed, &entity.definition);
        let (of, tolerance) = (entity.definition.fingerprint(), default_tolerance(&entity.definition));
        let mut edges = edges.relationships;
        for edge in edges.iter_mut().filter(|edge| edge.is_of_operation()) {
            let target = self.get(edge.target).map(Definition::fingerprint);
            edge.checked = target.map(|target| Checked { deviation: drift.proven, tolerance, of, target });
        }
        let at = self.index[&id];
        if let Some(record) = &mut self.entities[at].record {
            record.relationships = edges;
        }
        Ok(drift)
    }
}
