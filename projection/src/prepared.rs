//! An entity made ready for queries.

use std::sync::Arc;

use perpend_kernel::Definition;

use crate::answer::{FootPoint, Ties};
use crate::query::Query;
use crate::scratch::Scratch;

/// An entity made ready for queries: built once, immutable, shared by threads.
#[derive(Debug)]
pub struct Prepared {
    definition: Arc<Definition>,
}

impl Prepared {
    /// Prepares a definition.
    #[must_use]
    pub fn new(definition: Arc<Definition>) -> Self {
        Self { definition }
    }

    /// The definition.
    #[must_use]
    pub fn definition(&self) -> &Arc<Definition> {
        &self.definition
    }

    /// The nearest point; none where nothing is within `max_distance`.
    #[must_use]
    pub fn project(&self, query: &Query, scratch: &mut Scratch) -> Option<FootPoint> {
        let _ = (query, scratch);
        None
    }

    /// All nearest points.
    #[must_use]
    pub fn project_ties(&self, query: &Query, scratch: &mut Scratch) -> Option<Ties> {
        let _ = (query, scratch);
        None
    }
}
