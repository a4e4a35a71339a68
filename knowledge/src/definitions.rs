//! Where definitions are found by id.

use perpend_kernel::{Definition, EntityId};

/// Resolves ids, so that a record can be replayed and checked against the entities that it speaks of.
pub trait Definitions {
    /// The definition of the entity with this id; none where there is no such entity.
    fn get(&self, id: EntityId) -> Option<&Definition>;
}
