//! The whole of what is known of an entity.

use perpend_kernel::{EntityId, Fingerprint};
use serde::{Deserialize, Serialize};

use crate::classification::{Classification, Origin};
use crate::finite::{self, NonFinite};
use crate::intent::Intent;
use crate::item::Item;
use crate::relationship::Relationship;
use crate::representation::Representation;

/// The whole of what is known of an entity. An absent part is not known.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Record {
    /// Raised by every edit of the entity.
    #[serde(default)]
    pub revision: u64,
    /// What shape it is, where it comes from and what it is for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub classification: Option<Classification>,
    /// How its parametrisation behaves.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub representation: Option<Representation>,
    /// How it was made, and why so.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub intent: Vec<Intent>,
    /// How it depends on other entities.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub relationships: Vec<Relationship>,
}

impl Record {
    /// Checks that every number of the record is finite.
    ///
    /// # Errors
    ///
    /// The first number that is not, by the name of its field.
    pub fn validate(&self) -> Result<(), NonFinite> {
        finite::check(self)
    }

    /// The names of the items that were computed from another definition than the one with this hash.
    #[must_use]
    pub fn stale(&self, definition: Fingerprint) -> Vec<String> {
        let mut stale = Vec::new();
        if let Some(kind) = self.classification.as_ref().and_then(|c| c.kind.as_ref())
            && kind.is_stale(definition)
        {
            stale.push("classification.kind".to_owned());
        }
        if let Some(part) = &self.representation {
            list(part.speed.as_deref(), "speed", definition, &mut stale);
            list(part.breaks.as_deref(), "breaks", definition, &mut stale);
            list(part.irregularities.as_deref(), "irregularities", definition, &mut stale);
            one(part.closed.as_ref(), "closed", definition, &mut stale);
            one(part.periodic.as_ref(), "periodic", definition, &mut stale);
            one(part.bounds.as_ref(), "box", definition, &mut stale);
            one(part.length.as_ref(), "length", definition, &mut stale);
            one(part.area.as_ref(), "area", definition, &mut stale);
            one(part.weights.as_ref(), "weights", definition, &mut stale);
            list(part.cleaning.as_deref(), "cleaning", definition, &mut stale);
        }
        let checked =
            self.relationships.iter().enumerate().filter(|(_, r)| r.checked.is_some_and(|c| c.of != definition));
        stale.extend(checked.map(|(i, _)| format!("relationships[{i}].checked")));
        stale
    }

    /// Every reference to another entity, with the name of the field that holds it.
    #[must_use]
    pub fn references(&self) -> Vec<(String, EntityId)> {
        let mut references = Vec::new();
        if let Some(Origin::Derived { from, .. }) = self.classification.as_ref().and_then(|c| c.origin.as_ref()) {
            references.extend(from.iter().enumerate().map(|(i, id)| (format!("classification.origin.from[{i}]"), *id)));
        }
        for (k, intent) in self.intent.iter().enumerate() {
            references
                .extend(intent.inputs.iter().enumerate().map(|(i, id)| (format!("intent[{k}].inputs[{i}]"), *id)));
        }
        for (k, relationship) in self.relationships.iter().enumerate() {
            references.push((format!("relationships[{k}].target"), relationship.target));
        }
        references
    }

    /// Removes what was computed from another definition than the one with this hash. Origin, destination, intent and
    /// relationships stay: only those who stated them can say whether they still hold.
    pub fn forget_stale(&mut self, definition: Fingerprint) {
        if let Some(part) = &mut self.classification {
            part.kind.take_if(|kind| kind.is_stale(definition));
        }
        if let Some(part) = &mut self.representation {
            forget(&mut part.speed, definition);
            forget(&mut part.breaks, definition);
            forget(&mut part.irregularities, definition);
            part.closed.take_if(|item| item.is_stale(definition));
            part.periodic.take_if(|item| item.is_stale(definition));
            part.bounds.take_if(|item| item.is_stale(definition));
            part.length.take_if(|item| item.is_stale(definition));
            part.area.take_if(|item| item.is_stale(definition));
            part.weights.take_if(|item| item.is_stale(definition));
            forget(&mut part.cleaning, definition);
            if *part == Representation::default() {
                self.representation = None;
            }
        }
        for relationship in &mut self.relationships {
            relationship.checked.take_if(|checked| checked.of != definition);
        }
    }
}

fn one<T>(item: Option<&Item<T>>, name: &str, definition: Fingerprint, stale: &mut Vec<String>) {
    if item.is_some_and(|item| item.is_stale(definition)) {
        stale.push(format!("representation.{name}"));
    }
}

fn list<T>(items: Option<&[Item<T>]>, name: &str, definition: Fingerprint, stale: &mut Vec<String>) {
    let old = items.unwrap_or_default().iter().enumerate().filter(|(_, item)| item.is_stale(definition));
    stale.extend(old.map(|(i, _)| format!("representation.{name}[{i}]")));
}

/// A list that has lost an item is not known any more: what is left would claim to be all.
fn forget<T>(items: &mut Option<Vec<Item<T>>>, definition: Fingerprint) {
    items.take_if(|items| items.iter().any(|item| item.is_stale(definition)));
}
