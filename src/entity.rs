//! An entity of a model.

use std::sync::{Arc, OnceLock};

use perpend_kernel::{Definition, DefinitionData, EntityId, InvalidDefinition};
use perpend_knowledge::{Contradiction, NonFinite, Record, Refuted};
use perpend_projection::Prepared;
use serde::{Deserialize, Serialize};

use crate::enter::IntoDefinition;
use crate::original::{Original, OriginalData};
use crate::trust::{FIELD, False, Trust};
use crate::written::{Writing, Written};

/// An entity: its identity, its definition, what is known of it, and what queries need of it.
///
/// Its form in serde is that of a model's file, and reading it validates: an application can hold entities in files of its
/// own. Two entities are equal where their files are; what was prepared does not count.
#[derive(Debug, Clone, Deserialize)]
#[serde(try_from = "EntityData")]
pub struct Entity {
    pub(crate) id: EntityId,
    pub(crate) name: String,
    pub(crate) definition: Arc<Definition>,
    pub(crate) record: Option<Record>,
    pub(crate) original: Option<Original>,
    pub(crate) prepared: OnceLock<Arc<Prepared>>,
}

/// An entity as a file holds it, not validated.
#[derive(Debug, Deserialize)]
#[serde(rename = "Entity", deny_unknown_fields)]
pub(crate) struct EntityData {
    pub(crate) id: EntityId,
    #[serde(default)]
    pub(crate) name: String,
    pub(crate) definition: Written,
    #[serde(default)]
    pub(crate) knowledge: Option<Record>,
    #[serde(default)]
    pub(crate) original: Option<OriginalData>,
}

/// Why an entity is refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EntityError {
    /// Its definition breaks a rule.
    #[error("definition: {0}")]
    Definition(#[from] InvalidDefinition),
    /// A number of its record is not finite.
    #[error("knowledge: {0}")]
    Knowledge(#[from] NonFinite),
    /// Its record states a class that it is proved not to have.
    #[error("knowledge: {FIELD}: {0}")]
    FalseClass(#[from] Refuted),
    /// Its record states something else that its definition contradicts.
    #[error("knowledge: {0}")]
    FalseItem(#[from] Contradiction),
    /// Its original breaks a rule itself.
    #[error("original: {0}")]
    Original(Box<EntityError>),
    /// Its original's record holds parts that are the entity's own.
    #[error(
        "original: knowledge holds classification.kind and representation alone: move the other parts to the entity's own knowledge"
    )]
    OriginalStates,
    /// Its original is no entity of which it could have been purged.
    #[error(
        "original: it is of another kind or over another domain than the definition, so nothing was purged from it: remove it"
    )]
    OtherOriginal,
    /// Its record states a deviation from the original that is less than what can be proved.
    #[error(
        "knowledge: representation.cleaning: the definition is proven within {proven:e} of the original, and {stated:e} is stated: correct the gap"
    )]
    FalseDeviation {
        /// What the record states.
        stated: f64,
        /// What is proven.
        proven: f64,
    },
}

impl From<False> for EntityError {
    fn from(found: False) -> Self {
        match found {
            False::Class(refuted) => refuted.into(),
            False::Item(contradiction) => contradiction.into(),
        }
    }
}

impl Entity {
    pub(crate) fn new(id: EntityId, name: String, definition: Definition, record: Option<Record>) -> Self {
        Self { id, name, definition: Arc::new(definition), record, original: None, prepared: OnceLock::new() }
    }

    /// The id by which the model's queries call it.
    #[must_use]
    pub fn id(&self) -> EntityId {
        self.id
    }

    /// The name; it need not be unique.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The defining data.
    #[must_use]
    pub fn definition(&self) -> &Arc<Definition> {
        &self.definition
    }

    /// What is known of it; none: nothing yet.
    #[must_use]
    pub fn record(&self) -> Option<&Record> {
        self.record.as_ref()
    }

    /// What it was before it was purged, if it was and that is kept.
    #[must_use]
    pub fn original(&self) -> Option<&Original> {
        self.original.as_ref()
    }

    /// How often it was edited, as far as its record says.
    #[must_use]
    pub fn revision(&self) -> u64 {
        self.record.as_ref().map_or(0, |record| record.revision)
    }

    /// The items of its record that were computed from another definition than it has now, by the names of their fields.
    ///
    /// They are kept and written, and they are not to be believed.
    #[must_use]
    pub fn stale(&self) -> Vec<String> {
        self.record.as_ref().map_or_else(Vec::new, |record| record.stale(self.definition.fingerprint()))
    }

    /// What queries need of it, built on first use and shared by threads.
    #[must_use]
    pub fn prepared(&self) -> &Arc<Prepared> {
        self.prepared.get_or_init(|| Arc::new(Prepared::new(Arc::clone(&self.definition), self.record.as_ref())))
    }
}

impl PartialEq for Entity {
    fn eq(&self, other: &Self) -> bool {
        (self.id, &self.name, &self.definition, &self.record, &self.original)
            == (other.id, &other.name, &other.definition, &other.record, &other.original)
    }
}

impl TryFrom<EntityData> for Entity {
    type Error = EntityError;

    fn try_from(data: EntityData) -> Result<Self, EntityError> {
        Self::settled(data, Trust::Refuse)
    }
}

impl Entity {
    /// Validates an entity of a file.
    pub(crate) fn settled(data: EntityData, trust: Trust) -> Result<Self, EntityError> {
        let entered = IntoDefinition::enter(DefinitionData::from(data.definition))?;
        let mut record = data.knowledge;
        if let Some(record) = &record {
            record.validate()?;
        }
        trust.settle(&mut record, &entered.definition)?;
        let original = data
            .original
            .map(|original| Original::settled(original, trust, &entered.definition, &mut record))
            .transpose()?;
        entered.note(&mut record);
        Ok(Self { original, ..Self::new(data.id, data.name, entered.definition, record) })
    }
}

impl Serialize for Entity {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        use serde::ser::SerializeStruct;
        let mut s = serializer.serialize_struct("Entity", 5)?;
        s.serialize_field("id", &self.id)?;
        s.serialize_field("name", &self.name)?;
        s.serialize_field("definition", &Writing(&self.definition))?;
        s.serialize_field("knowledge", &self.record)?;
        match &self.original {
            Some(original) => s.serialize_field("original", &Some(original))?,
            None => s.skip_field("original")?,
        }
        s.end()
    }
}
