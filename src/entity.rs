//! An entity of a model.

use std::sync::{Arc, OnceLock};

use perpend_kernel::{Definition, EntityId, InvalidDefinition, TrimEntry, Trimming};
use perpend_knowledge::{Contradiction, NonFinite, Record, Refuted};
use perpend_projection::Prepared;
use serde::{Deserialize, Serialize};

use crate::body::is_colour;
use crate::enter::{Entered, IntoDefinition};
use crate::original::{Original, OriginalData};
use crate::referent::Referent;
use crate::trimmed::{self, InvalidTrimmedSurface};
use crate::trust::{FIELD, False, Trust};
use crate::written::{Form, Source, Writing, WritingTrimmed, Written};

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
    /// What makes it a trimmed face.
    pub(crate) part: Option<Part>,
    pub(crate) colour: Option<[f64; 3]>,
    pub(crate) record: Option<Record>,
    pub(crate) original: Option<Original>,
    pub(crate) prepared: OnceLock<Arc<Prepared>>,
}

/// What makes a surface a trimmed face.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Part {
    pub(crate) trimming: Arc<Trimming>,
    /// The entity whose definition the face has, where that is not its own.
    pub(crate) carrier: Option<EntityId>,
}

/// An entity as a file holds it, not validated.
#[derive(Debug, Deserialize)]
#[serde(rename = "Entity", deny_unknown_fields)]
pub(crate) struct EntityData {
    pub(crate) id: EntityId,
    #[serde(default)]
    pub(crate) name: String,
    #[serde(default)]
    pub(crate) colour: Option<[f64; 3]>,
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
    /// It is a trimmed face that breaks a rule.
    #[error("definition: {0}")]
    Trimmed(Box<InvalidTrimmedSurface>),
    /// It trims another entity, which is not at hand.
    #[error(
        "definition: surface is Ref({carrier}), which only a model resolves: read the model that holds both, or write the surface as Own(NurbsSurface(…))"
    )]
    Reference {
        /// The entity that it trims.
        carrier: EntityId,
    },
    /// It is a body, which is no entity.
    #[error("definition: Body names entities, which only a model holds: read the model that holds them")]
    Body,
    /// Its original is a face or a body.
    #[error("definition is no NurbsCurve or NurbsSurface, and nothing else is purged: remove it")]
    NoOriginal,
    /// Its colour is none.
    #[error("colour is ({:?}, {:?}, {:?}); red, green and blue are from 0 to 1", .0[0], .0[1], .0[2])]
    Colour([f64; 3]),
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

impl From<InvalidTrimmedSurface> for EntityError {
    fn from(source: InvalidTrimmedSurface) -> Self {
        Self::Trimmed(source.into())
    }
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
        Self {
            id,
            name,
            definition: Arc::new(definition),
            part: None,
            colour: None,
            record,
            original: None,
            prepared: OnceLock::new(),
        }
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

    /// The defining data; of a trimmed face, those of its carrier.
    #[must_use]
    pub fn definition(&self) -> &Arc<Definition> {
        &self.definition
    }

    /// What part of the surface counts, if it is a trimmed face.
    #[must_use]
    pub fn trimming(&self) -> Option<&Arc<Trimming>> {
        self.part.as_ref().map(|part| &part.trimming)
    }

    /// The entity whose definition a trimmed face has and follows; none where the surface is its own.
    #[must_use]
    pub fn carrier(&self) -> Option<EntityId> {
        self.part.as_ref().and_then(|part| part.carrier)
    }

    /// Its colour, red, green and blue from 0 to 1.
    #[must_use]
    pub fn colour(&self) -> Option<[f64; 3]> {
        self.colour
    }

    /// What is known of it, of a trimmed face's carrier; none: nothing yet.
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
        self.prepared.get_or_init(|| {
            let prepared = Prepared::new(Arc::clone(&self.definition), self.record.as_ref());
            Arc::new(match &self.part {
                Some(part) => prepared.with_trimming(Arc::clone(&part.trimming)),
                None => prepared,
            })
        })
    }
}

impl PartialEq for Entity {
    fn eq(&self, other: &Self) -> bool {
        (self.id, &self.name, &self.definition, &self.part, self.colour, &self.record, &self.original)
            == (other.id, &other.name, &other.definition, &other.part, other.colour, &other.record, &other.original)
    }
}

impl TryFrom<EntityData> for Entity {
    type Error = EntityError;

    fn try_from(data: EntityData) -> Result<Self, EntityError> {
        // on its own, an entity knows no others: what they are is for its model to say
        Self::settled(data, Trust::Refuse, &|_| None, &|_| Referent::Curve)
    }
}

impl Entity {
    /// Validates an entity of a file. `carrier` gives the definitions that trimmed faces name, and `referent` tells what an id stands for.
    pub(crate) fn settled(
        data: EntityData,
        trust: Trust,
        carrier: &impl Fn(EntityId) -> Option<Arc<Definition>>,
        referent: &impl Fn(EntityId) -> Referent,
    ) -> Result<Self, EntityError> {
        if let Some(colour) = data.colour.filter(|colour| !is_colour(*colour)) {
            return Err(EntityError::Colour(colour));
        }
        let (shape, trimming) = match Form::from(data.definition) {
            Form::Plain(data) => (Settled::Own(IntoDefinition::enter(data)?.into()), None),
            Form::Trimmed(Source::Own(data), trimming) => (Settled::Own(data.enter()?.into()), Some((trimming, None))),
            Form::Trimmed(Source::Ref(id), trimming) => {
                let shared = carrier(id).ok_or(EntityError::Reference { carrier: id })?;
                (Settled::Shared(shared), Some((trimming, Some(id))))
            }
            Form::Body(_) => return Err(EntityError::Body),
        };
        let mut entry = TrimEntry::default();
        let part = match (trimming, shape.definition()) {
            (None, _) => None,
            (Some((data, carrier)), Definition::NurbsSurface(surface)) => {
                let (trimming, entered) = trimmed::enter(data, surface, referent)?;
                entry = entered;
                Some(Part { trimming, carrier })
            }
            (Some((_, carrier)), Definition::NurbsCurve(_)) => {
                let id = carrier.unwrap_or(data.id);
                return Err(InvalidTrimmedSurface::Carrier { id, is: Referent::Curve }.into());
            }
        };
        let mut record = data.knowledge;
        if let Some(record) = &record {
            record.validate()?;
        }
        trust.settle(&mut record, shape.definition())?;
        let original = data
            .original
            .map(|original| Original::settled(original, trust, shape.definition(), &mut record))
            .transpose()?;
        if let Settled::Own(entered) = &shape {
            entered.note(&mut record);
        }
        trimmed::note(&entry, shape.definition(), &mut record);
        Ok(Self {
            id: data.id,
            name: data.name,
            definition: shape.into_definition(),
            part,
            colour: data.colour,
            record,
            original,
            prepared: OnceLock::new(),
        })
    }
}

/// A valid definition of a file: of the entity's own, or of the one that it names.
enum Settled {
    Own(Box<Entered>),
    Shared(Arc<Definition>),
}

impl Settled {
    fn definition(&self) -> &Definition {
        match self {
            Self::Own(entered) => &entered.definition,
            Self::Shared(definition) => definition,
        }
    }

    fn into_definition(self) -> Arc<Definition> {
        match self {
            Self::Own(entered) => Arc::new(entered.definition),
            Self::Shared(definition) => definition,
        }
    }
}

impl Serialize for Entity {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        use serde::ser::SerializeStruct;
        let mut s = serializer.serialize_struct("Entity", 6)?;
        s.serialize_field("id", &self.id)?;
        s.serialize_field("name", &self.name)?;
        match &self.colour {
            Some(colour) => s.serialize_field("colour", &Some(colour))?,
            None => s.skip_field("colour")?,
        }
        match &self.part {
            Some(part) => s.serialize_field("definition", &WritingTrimmed(&self.definition, part))?,
            None => s.serialize_field("definition", &Writing(&self.definition))?,
        }
        s.serialize_field("knowledge", &self.record)?;
        match &self.original {
            Some(original) => s.serialize_field("original", &Some(original))?,
            None => s.skip_field("original")?,
        }
        s.end()
    }
}
