//! How an entity is made: the steps that are in force, and what running them gives.

use std::borrow::Cow;

use perpend_kernel::{Definition, EntityId};

use crate::build::{BuildError, Built};
use crate::definitions::Definitions;
use crate::intent::Intent;
use crate::operation::{Operation, Takes};
use crate::record::Record;
use crate::relate;

/// The steps that make an entity, as its record says.
#[derive(Debug, Clone, PartialEq)]
pub struct Making<'a> {
    /// The steps in force, in their order.
    pub steps: Cow<'a, [Intent]>,
    /// Index of the first of them in the record's intent; none: the record has no intent, and the step was read off the
    /// parameters of its relationships.
    pub first: Option<usize>,
}

/// Why the steps of an entity could not be run.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MakingError {
    /// There is no such entity.
    #[error("the model has no entity {id}")]
    UnknownEntity {
        /// The id.
        id: EntityId,
    },
    /// There are no steps.
    #[error("nothing says how the entity was made: state an operation")]
    NoSteps,
    /// The operation made nothing.
    #[error(transparent)]
    Build(#[from] BuildError),
}

impl Record {
    /// The steps in force; none where the record does not say how the entity was made.
    #[must_use]
    pub fn making(&self) -> Option<Making<'_>> {
        if self.intent.is_empty() {
            let (operation, inputs) = relate::operation(&self.relationships)?;
            let steps = vec![Intent::new(operation, &inputs)];
            return Some(Making { steps: Cow::Owned(steps), first: None });
        }
        let first = self.intent.iter().rposition(starts_afresh).unwrap_or(0);
        Some(Making { steps: Cow::Borrowed(&self.intent[first..]), first: Some(first) })
    }

    /// The entities of which the entity is made, each once: the inputs of the steps in force.
    #[must_use]
    pub fn made_from(&self) -> Vec<EntityId> {
        let mut from: Vec<EntityId> = Vec::new();
        if let Some(making) = self.making() {
            for id in making.steps.iter().flat_map(|step| &step.inputs) {
                if !from.contains(id) {
                    from.push(*id);
                }
            }
        }
        from
    }
}

/// Whether a step needs nothing that was made before it.
fn starts_afresh(step: &Intent) -> bool {
    match step.operation.takes() {
        Takes::Exactly(0) | Takes::AtLeast(_) => true,
        Takes::Exactly(count) => step.inputs.len() >= count,
        Takes::Any => false,
    }
}

impl Making<'_> {
    /// Runs the steps.
    ///
    /// # Errors
    ///
    /// An input that does not exist; a step that makes nothing.
    pub fn run(&self, definitions: &impl Definitions) -> Result<Built, MakingError> {
        let mut made: Option<Built> = None;
        for step in self.steps.iter() {
            let mut inputs: Vec<&Definition> = Vec::with_capacity(step.inputs.len() + 1);
            if let Some(made) = &made
                && !starts_afresh(step)
            {
                inputs.push(&made.definition);
            }
            for id in &step.inputs {
                inputs.push(definitions.get(*id).ok_or(MakingError::UnknownEntity { id: *id })?);
            }
            made = Some(step.operation.build(&inputs)?);
        }
        made.ok_or(MakingError::NoSteps)
    }

    /// The last step, which made the definition.
    #[must_use]
    pub fn last(&self) -> Option<&Intent> {
        self.steps.last()
    }

    /// Whether the definition was entered as it is: running the steps has nothing to make it from.
    #[must_use]
    pub fn is_by_data(&self) -> bool {
        matches!(*self.steps, [Intent { operation: Operation::ByData, .. }])
    }
}
