//! Entities with what their maker knows of them.

use std::collections::BTreeMap;

use perpend::{Basis, EntityId, Intent, IntoDefinition, Item, Kind, Model, Operation, Origin, Relation, Relationship};

use super::Outcome;

/// How far a shape may be from the class that its record states, as a share of its size: the facade's own for analytic shapes.
const SAME_CLASS: f64 = 1e-10;

/// What the maker of an entity knows of it.
pub(crate) struct Known {
    kind: Option<Kind>,
    origin: Origin,
    destination: Vec<String>,
    intent: Vec<Intent>,
    relationships: Vec<Relationship>,
}

impl Known {
    /// Designed for a purpose.
    pub(crate) fn designed(destination: &str) -> Self {
        let destination = vec![destination.to_owned()];
        Self { kind: None, origin: Origin::Designed, destination, intent: Vec::new(), relationships: Vec::new() }
    }

    /// Computed from other entities for a purpose.
    pub(crate) fn derived(operation: &str, from: &[EntityId], destination: &str) -> Self {
        let origin = Origin::Derived { operation: operation.to_owned(), from: from.to_vec() };
        Self { origin, ..Self::designed(destination) }
    }

    /// Of a class that its definition does not state.
    pub(crate) fn kind(self, kind: Kind) -> Self {
        Self { kind: Some(kind), ..self }
    }

    pub(crate) fn made_by(mut self, operation: Operation, inputs: &[EntityId], decision: &str) -> Self {
        let (inputs, decision) = (inputs.to_vec(), decision.to_owned());
        self.intent.push(Intent { operation, inputs, alternatives: Vec::new(), decision });
        self
    }

    pub(crate) fn related(mut self, kind: Relation, target: EntityId) -> Self {
        self.relationships.push(Relationship { kind, target, parameters: BTreeMap::new(), checked: None });
        self
    }
}

/// Adds an entity with what is known of it.
pub(crate) fn add(model: &mut Model, name: &str, definition: impl IntoDefinition, known: Known) -> Outcome<EntityId> {
    let id = model.insert(name, definition)?;
    let entity = model.entity(id).expect("it was just inserted");
    // an analytic shape enters with its class
    let mut record = entity.record().cloned().unwrap_or_default();
    let classification = record.classification.get_or_insert_default();
    if let Some(value) = known.kind {
        let (tolerance, of) = (SAME_CLASS * entity.definition().size(), entity.definition().fingerprint());
        classification.kind = Some(Item { value, basis: Basis::Defined, tolerance, of });
    }
    classification.origin = Some(known.origin);
    classification.destination = known.destination;
    record.intent = known.intent;
    record.relationships = known.relationships;
    model.set_record(id, record)?;
    Ok(id)
}
