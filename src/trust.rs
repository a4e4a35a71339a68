//! What happens to knowledge of a file that is false.

use perpend_kernel::Definition;
use perpend_knowledge::{Record, Refuted, default_tolerance, prove, recognise};

/// What happens, on loading, to a stated class that its definition is proved not to have.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Trust {
    /// The file is refused, with the entity, the field and the deviation.
    #[default]
    Refuse,
    /// The class is acquired again from the definition; so is one that was computed from another definition.
    Repair,
}

/// The field of which this module speaks.
pub(crate) const FIELD: &str = "classification.kind";

impl Trust {
    /// Proves the class that a record states of its definition, within the tolerance that the record names or, if that is
    /// larger, recognition's own. A class of another definition is stale: it is not believed, and so not proved.
    pub(crate) fn settle(self, record: &mut Option<Record>, definition: &Definition) -> Result<(), Refuted> {
        let class = record.as_mut().and_then(|record| record.classification.as_mut());
        let Some(kind) = class.and_then(|class| class.kind.as_mut()) else { return Ok(()) };
        let tolerance = default_tolerance(definition);
        let outcome = if kind.is_stale(definition.fingerprint()) {
            None
        } else {
            Some(prove(&kind.value, definition, kind.tolerance.max(tolerance)))
        };
        match (self, outcome) {
            (Self::Repair, None | Some(Err(_))) => *kind = recognise(definition, tolerance),
            (Self::Refuse, Some(Err(refuted))) => return Err(refuted),
            (Self::Refuse, None) | (_, Some(Ok(_))) => {}
        }
        Ok(())
    }
}
