//! What an entity was before it was purged.

use std::sync::Arc;

use perpend_kernel::Definition;
use perpend_knowledge::{Basis, Classification, Cleaning, Item, Record, displacement};
use serde::{Deserialize, Serialize};

use crate::enter::IntoDefinition;
use crate::entity::EntityError;
use crate::trust::Trust;
use crate::written::{Form, Writing, Written};

/// What an entity was before it was purged: its definition, and what was known of that.
///
/// It is kept until the application drops it ([`Model::drop_original`](crate::Model::drop_original)), through files too.
#[derive(Debug, Clone, PartialEq)]
pub struct Original {
    pub(crate) definition: Arc<Definition>,
    pub(crate) record: Option<Record>,
}

/// An original as a file holds it, not validated.
#[derive(Debug, Deserialize)]
#[serde(rename = "Original", deny_unknown_fields)]
pub(crate) struct OriginalData {
    definition: Written,
    #[serde(default)]
    knowledge: Option<Record>,
}

impl Original {
    /// The defining data.
    #[must_use]
    pub fn definition(&self) -> &Arc<Definition> {
        &self.definition
    }

    /// What was computed from them: the class and the representation. The rest of the record is the entity's own still.
    #[must_use]
    pub fn record(&self) -> Option<&Record> {
        self.record.as_ref()
    }

    /// What is kept of an entity that is to be purged.
    pub(crate) fn of(definition: &Arc<Definition>, record: Option<&Record>) -> Self {
        let of = definition.fingerprint();
        let computed = record.map(|record| {
            let kind = record.classification.as_ref().and_then(|part| part.kind.clone());
            let classification = kind.map(|kind| Classification { kind: Some(kind), ..Classification::default() });
            let mut record =
                Record { classification, representation: record.representation.clone(), ..Record::default() };
            record.forget_stale(of);
            record.classification.take_if(|part| part.kind.is_none());
            record
        });
        Self { definition: Arc::clone(definition), record: computed.filter(|record| *record != Record::default()) }
    }

    /// Validates an original of a file, and what the record of its entity says of the deviation between both.
    pub(crate) fn settled(
        data: OriginalData,
        trust: Trust,
        definition: &Definition,
        record: &mut Option<Record>,
    ) -> Result<Self, EntityError> {
        let Form::Plain(plain) = Form::from(data.definition) else { return Err(within(EntityError::NoOriginal)) };
        let entered = IntoDefinition::enter(plain).map_err(within)?;
        let mut known = data.knowledge;
        if let Some(known) = &known {
            known.validate().map_err(within)?;
            let classified = known.classification.clone().unwrap_or_default();
            let computed = Record {
                classification: known
                    .classification
                    .as_ref()
                    .map(|_| Classification { kind: classified.kind, ..Classification::default() }),
                representation: known.representation.clone(),
                ..Record::default()
            };
            if computed != *known {
                return Err(EntityError::OriginalStates);
            }
        }
        trust.settle(&mut known, &entered.definition).map_err(within)?;
        let Some(proven) = displacement(&entered.definition, definition) else {
            return Err(EntityError::OtherOriginal);
        };
        for item in purges(record.as_mut(), definition) {
            // the bound is computed as it was when it was written; another version may round it otherwise
            if let Basis::Proved { gap } = &mut item.basis
                && proven > *gap * (1.0 + 1e-9)
            {
                match trust {
                    Trust::Refuse => return Err(EntityError::FalseDeviation { stated: *gap, proven }),
                    Trust::Repair => *gap = proven,
                }
            }
        }
        Ok(Self { definition: Arc::new(entered.definition), record: known })
    }
}

fn within(error: impl Into<EntityError>) -> EntityError {
    EntityError::Original(Box::new(error.into()))
}

/// The purges that a record tells of this definition.
pub(crate) fn purges<'a>(
    record: Option<&'a mut Record>,
    definition: &Definition,
) -> impl Iterator<Item = &'a mut Item<Cleaning>> {
    let of = definition.fingerprint();
    let part = record.and_then(|record| record.representation.as_mut());
    let items = part.and_then(|part| part.cleaning.as_mut()).into_iter().flatten();
    items.filter(move |item| item.of == of && matches!(item.value, Cleaning::Purged { .. }))
}

impl Serialize for Original {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        use serde::ser::SerializeStruct;
        let mut s = serializer.serialize_struct("Original", 2)?;
        s.serialize_field("definition", &Writing(&self.definition))?;
        s.serialize_field("knowledge", &self.record)?;
        s.end()
    }
}
