//! How an entity's queries are answered, and why so.

use perpend_kernel::EntityId;
use perpend_projection::{Plan, QueryError};

use crate::model::Model;

impl Model {
    /// How queries to an entity are answered, and what each item of knowledge contributed to that.
    ///
    /// This is the plan by which they are answered; it is made on the first query, or here.
    ///
    /// # Errors
    ///
    /// An unknown id.
    pub fn explain(&self, id: EntityId) -> Result<&Plan, QueryError> {
        self.entity(id).map(|entity| entity.prepared().plan()).ok_or(QueryError::UnknownEntity { id })
    }
}
