//! Queries to one entity by one thread.

use glam::DVec3;
use perpend_kernel::EntityId;
use perpend_projection::{FootPoint, Prepared, Query, QueryError, QueryOptions, Scratch, Statistics, Ties};

/// An entity made ready, with working memory and the last foot: for loops that ask one entity many times, best with each
/// point near the one before it.
///
/// The answers are those of [`Model::project_with`](crate::Model::project_with), bit for bit.
#[derive(Debug)]
pub struct Projector<'a> {
    id: EntityId,
    prepared: &'a Prepared,
    scratch: Scratch,
    /// The last foot: it spares the next query the pieces that are farther away.
    hint: Option<DVec3>,
}

impl<'a> Projector<'a> {
    pub(crate) fn new(id: EntityId, prepared: &'a Prepared) -> Self {
        Self { id, prepared, scratch: Scratch::default(), hint: None }
    }

    /// The nearest point to `p`; none where the entity is beyond `max_distance`.
    ///
    /// # Errors
    ///
    /// A coordinate that is no finite number or beyond 1e75; an option without meaning.
    pub fn project(&mut self, p: DVec3, options: &QueryOptions) -> Result<Option<FootPoint>, QueryError> {
        let query = Query::new(p, *options)?;
        let foot = self.prepared.project_near(&query, self.hint, &mut self.scratch);
        self.hint = foot.map(|foot| foot.point).or(self.hint);
        Ok(foot)
    }

    /// All nearest points to `p`; none where the entity is beyond `max_distance`.
    ///
    /// # Errors
    ///
    /// As [`project`](Self::project); a trimmed face, of which this is not available.
    pub fn project_ties(&mut self, p: DVec3, options: &QueryOptions) -> Result<Option<Ties>, QueryError> {
        if self.prepared.trimming().is_some() {
            return Err(QueryError::TrimmedFace { id: self.id, what: "all nearest points" });
        }
        Ok(self.prepared.project_ties(&Query::new(p, *options)?, &mut self.scratch))
    }

    /// What the queries so far have cost.
    #[must_use]
    pub fn statistics(&self) -> Statistics {
        self.scratch.statistics
    }
}
