//! Whether what a record says of the making of its entity is how the entity is now.

use perpend_kernel::Definition;
use perpend_knowledge::{Definitions, Making, MakingError, Record, default_tolerance, deviation};

use crate::entity::Entity;

/// How an entity stands to what its record says of its making.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Standing {
    /// Nothing is said.
    Unmade,
    /// The definition is what the steps made.
    Made,
    /// The definition was replaced by hand after the steps had made it.
    Overridden,
    /// The steps cannot be run: they are kept as a reference.
    Reference(MakingError),
}

impl Standing {
    /// A step that notes the entity's definition made it. Where none does, the steps are run: what they give decides, and a
    /// difference below [`default_tolerance`] counts as none.
    pub(crate) fn of(entity: &Entity, definitions: &impl Definitions) -> Self {
        let Some(making) = entity.record.as_ref().and_then(Record::making) else { return Self::Unmade };
        let is_noted = notes(&making, entity);
        if is_noted && making.runs() {
            return Self::Made;
        }
        match making.run(definitions) {
            Err(error) => Self::Reference(error),
            Ok(_) if is_noted => Self::Made,
            Ok(built) if agrees(&built.definition, &entity.definition) => Self::Made,
            Ok(_) => Self::Overridden,
        }
    }
}

/// Whether the record notes that the steps made the entity's definition.
fn notes(making: &Making<'_>, entity: &Entity) -> bool {
    let hash = entity.definition.fingerprint();
    match (making.first, &entity.record) {
        (None, Some(record)) => {
            let mut edges = record.relationships.iter().filter(|edge| edge.is_of_operation());
            edges.all(|edge| {
                edge.checked.is_some_and(|checked| checked.of == hash && checked.deviation <= checked.tolerance)
            })
        }
        _ => making.last().is_some_and(|step| step.of == Some(hash)),
    }
}

/// Whether what was built again is a definition, up to [`default_tolerance`].
pub(crate) fn agrees(replayed: &Definition, definition: &Definition) -> bool {
    deviation(replayed, definition).proven <= default_tolerance(definition)
}
