//! Entities with what their maker knows of them.

use perpend::{EntityId, Intent, IntoDefinition, Model, Operation, Origin};

use super::Outcome;

/// What the maker of an entity knows of it that its making does not tell.
pub(crate) struct Known {
    destination: &'static str,
    decision: &'static str,
}

impl Known {
    /// Designed for a purpose.
    pub(crate) fn designed(destination: &'static str) -> Self {
        Self { destination, decision: "" }
    }

    /// Why it is as it is.
    pub(crate) fn because(self, decision: &'static str) -> Self {
        Self { decision, ..self }
    }
}

/// Adds an entity of data.
pub(crate) fn add(model: &mut Model, name: &str, definition: impl IntoDefinition, known: Known) -> Outcome<EntityId> {
    let id = model.insert(name, definition)?;
    let entity = model.entity(id).expect("it was just inserted");
    let mut record = entity.record().cloned().unwrap_or_default();
    record.intent = vec![Intent { of: Some(entity.definition().fingerprint()), ..Intent::new(Operation::ByData, &[]) }];
    record.classification.get_or_insert_default().origin = Some(Origin::Designed);
    model.set_record(id, record)?;
    note(model, id, known)
}

/// Makes an entity by an operation: an analytic shape is one, too.
pub(crate) fn make(
    model: &mut Model,
    name: &str,
    operation: impl Into<Operation>,
    inputs: &[EntityId],
    known: Known,
) -> Outcome<EntityId> {
    let id = model.make(name, operation, inputs)?;
    note(model, id, known)
}

/// Adds to a record what its maker knows.
fn note(model: &mut Model, id: EntityId, known: Known) -> Outcome<EntityId> {
    let mut record = model.entity(id).and_then(|entity| entity.record()).cloned().unwrap_or_default();
    record.classification.get_or_insert_default().destination = vec![known.destination.to_owned()];
    if let Some(step) = record.intent.last_mut() {
        known.decision.clone_into(&mut step.decision);
    }
    model.set_record(id, record)?;
    Ok(id)
}
