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
    /// The steps are run: what they give decides, and a difference below [`default_tolerance`] counts as none. What the record notes
    /// of that is not believed: a file can state it falsely, and an edit would lose a definition that its steps did not make.
    pub(crate) fn of(entity: &Entity, definitions: &impl Definitions) -> Self {
        let Some(making) = entity.record.as_ref().and_then(Record::making) else { return Self::Unmade };
        match making.run(definitions) {
            Err(error) => Self::Reference(error),
            Ok(built) if agrees(&built.definition, &entity.definition) => Self::Made,
            Ok(_) => Self::Overridden,
        }
    }
}

/// Whether a record notes that the last of its steps made a definition.
pub(crate) fn notes(making: &Making<'_>, definition: &Definition) -> bool {
    making.last().is_some_and(|step| step.of == Some(definition.fingerprint()))
}

/// Whether what was built again is a definition, up to [`default_tolerance`].
pub(crate) fn agrees(replayed: &Definition, definition: &Definition) -> bool {
    deviation(replayed, definition).proven <= default_tolerance(definition)
}
