//! Queries to one entity by one thread.

use glam::DVec3;
use perpend_projection::{FootPoint, Prepared, Query, QueryError, QueryOptions, Scratch, Ties};

/// An entity made ready, with the working memory of queries: for loops that ask one entity many times.
///
/// The answers are those of [`Model::project_with`](crate::Model::project_with), bit for bit.
#[derive(Debug)]
pub struct Projector<'a> {
    prepared: &'a Prepared,
    scratch: Scratch,
}

impl<'a> Projector<'a> {
    pub(crate) fn new(prepared: &'a Prepared) -> Self {
        Self { prepared, scratch: Scratch::default() }
    }

    /// The nearest point to `p`; none where the entity is beyond `max_distance`.
    ///
    /// # Errors
    ///
    /// A coordinate that is no finite number or beyond 1e150; an option without meaning.
    pub fn project(&mut self, p: DVec3, options: &QueryOptions) -> Result<Option<FootPoint>, QueryError> {
        Ok(self.prepared.project(&Query::new(p, *options)?, &mut self.scratch))
    }

    /// All nearest points to `p`; none where the entity is beyond `max_distance`.
    ///
    /// # Errors
    ///
    /// As [`project`](Self::project).
    pub fn project_ties(&mut self, p: DVec3, options: &QueryOptions) -> Result<Option<Ties>, QueryError> {
        Ok(self.prepared.project_ties(&Query::new(p, *options)?, &mut self.scratch))
    }
}
