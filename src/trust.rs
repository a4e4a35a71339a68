//! What happens to knowledge of a file that is false.

use perpend_kernel::Definition;
use perpend_knowledge::{
    AcquireOptions, Contradiction, Record, Refuted, believed_tolerance, default_tolerance, prove, recognise,
};

/// What happens, on loading, to knowledge that is false: a class that the definition is proved not to have, an item of the
/// representation that it contradicts ([`Record::contradictions`] says what is looked at).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Trust {
    /// The file is refused, with the entity, the field and the deviation.
    #[default]
    Refuse,
    /// What is false is acquired again from the definition; so is what was computed from another definition.
    Repair,
}

/// What is false in a record.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum False {
    Class(Refuted),
    Item(Contradiction),
}

/// The field of the class.
pub(crate) const FIELD: &str = "classification.kind";

impl Trust {
    /// Looks at what a record states of its definition.
    pub(crate) fn settle(self, record: &mut Option<Record>, definition: &Definition) -> Result<(), False> {
        self.settle_class(record, definition).map_err(False::Class)?;
        let Some(record) = record else { return Ok(()) };
        match self {
            Self::Refuse => {
                record.contradictions(definition).into_iter().next().map_or(Ok(()), |c| Err(False::Item(c)))
            }
            Self::Repair => {
                record.repair(definition, &AcquireOptions::default());
                Ok(())
            }
        }
    }

    /// Proves the class that a record states of its definition, within the tolerance that the record names, as far as
    /// [`believed_tolerance`] lets it. A class of another definition is stale: it is not believed, and so not proved.
    fn settle_class(self, record: &mut Option<Record>, definition: &Definition) -> Result<(), Refuted> {
        let class = record.as_mut().and_then(|record| record.classification.as_mut());
        let Some(kind) = class.and_then(|class| class.kind.as_mut()) else { return Ok(()) };
        let tolerance = default_tolerance(definition);
        let outcome = if kind.is_stale(definition.fingerprint()) {
            None
        } else {
            Some(prove(&kind.value, definition, believed_tolerance(kind.tolerance, definition)))
        };
        match (self, outcome) {
            (Self::Repair, None | Some(Err(_))) => *kind = recognise(definition, tolerance),
            (Self::Refuse, Some(Err(refuted))) => return Err(refuted),
            (Self::Refuse, None) | (_, Some(Ok(_))) => {}
        }
        Ok(())
    }
}
