//! How an entity was made, and why so.

use perpend_kernel::{EntityId, Fingerprint};
use serde::{Deserialize, Serialize};

use crate::bare;
use crate::operation::Operation;

/// An operation that took part in making an entity: a step.
///
/// The steps of a record run in their order. One that names all the entities that its operation takes starts afresh, and the
/// steps before it are history; one that names one entity less works on what the step before it made, which stands before
/// its inputs. The steps from the last fresh start on are *in force*.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Intent {
    /// The operation with its parameters.
    pub operation: Operation,
    /// The entities that it worked on.
    #[serde(default)]
    pub inputs: Vec<EntityId>,
    /// What else was considered.
    #[serde(default)]
    pub alternatives: Vec<String>,
    /// What was decided, and why.
    #[serde(default)]
    pub decision: String,
    /// The hash of the definition that the entity had after this step; none: not noted.
    ///
    /// Where that of the last step is not the hash of the entity's definition, the definition was replaced by hand since.
    #[serde(default, with = "bare", skip_serializing_if = "Option::is_none")]
    pub of: Option<Fingerprint>,
}

impl Intent {
    /// A step with nothing said of alternatives and decisions.
    #[must_use]
    pub fn new(operation: impl Into<Operation>, inputs: &[EntityId]) -> Self {
        let inputs = inputs.to_vec();
        Self { operation: operation.into(), inputs, alternatives: Vec::new(), decision: String::new(), of: None }
    }
}
