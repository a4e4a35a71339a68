//! Queries to one entity of a model.

use glam::DVec3;
use perpend_kernel::EntityId;
use perpend_projection::{
    FootPoint, Prepared, Query, QueryError, QueryOptions, Scratch, StationaryOptions, StationaryPoints, Ties,
};

use crate::batch;
use crate::model::Model;
use crate::projector::Projector;

impl Model {
    /// The point of an entity that is nearest to `p`, with its proof.
    ///
    /// # Errors
    ///
    /// An unknown id; a coordinate that is no finite number or beyond 1e75.
    pub fn project(&self, id: EntityId, p: DVec3) -> Result<FootPoint, QueryError> {
        let foot = self.project_with(id, p, &QueryOptions::default())?;
        Ok(foot.expect("an entity has a nearest point where no distance is too far"))
    }

    /// As [`project`](Self::project), with options; none where the entity is beyond `max_distance`.
    ///
    /// # Errors
    ///
    /// As [`project`](Self::project); an option without meaning.
    pub fn project_with(
        &self,
        id: EntityId,
        p: DVec3,
        options: &QueryOptions,
    ) -> Result<Option<FootPoint>, QueryError> {
        let prepared = self.prepared(id)?;
        Ok(prepared.project(&Query::new(p, *options)?, &mut Scratch::default()))
    }

    /// The nearest points to many points, in their order, on all cores where the feature `rayon` is on.
    ///
    /// Every answer is that of [`project_with`](Self::project_with), bit for bit. An error holds for its own point alone.
    #[must_use]
    pub fn project_all(
        &self,
        id: EntityId,
        ps: &[DVec3],
        options: &QueryOptions,
    ) -> Vec<Result<Option<FootPoint>, QueryError>> {
        let prepared = match self.prepared(id) {
            Ok(prepared) => prepared,
            Err(error) => return vec![Err(error); ps.len()],
        };
        batch::answers(
            ps,
            || Projector::new(id, prepared),
            |projector, index, p| projector.project(*p, options).map_err(|error| at_index(error, index)),
        )
    }

    /// All points of an entity that are nearest to `p` within the gap; none where it is beyond `max_distance`.
    ///
    /// # Errors
    ///
    /// As [`project_with`](Self::project_with); a trimmed face, of which this is not available.
    pub fn project_ties(&self, id: EntityId, p: DVec3, options: &QueryOptions) -> Result<Option<Ties>, QueryError> {
        let prepared = self.untrimmed(id, "all nearest points")?;
        Ok(prepared.project_ties(&Query::new(p, *options)?, &mut Scratch::default()))
    }

    /// All stationary points of the distance from `p` to an entity: minima, maxima and saddles, inside, on edges and creases, at ends and corners.
    ///
    /// ```
    /// use perpend::{Circle, DVec3, Extremum, Frame, Model, StationaryOptions};
    ///
    /// let mut model = Model::new();
    /// let rim = model.insert("rim", Circle::new(Frame::WORLD, 2.0, (0.0, std::f64::consts::TAU))?.to_nurbs()?)?;
    /// let found = model.stationary_points(rim, DVec3::new(0.5, 0.3, 1.0), &StationaryOptions::default())?;
    /// let kinds: Vec<_> = found.points.iter().map(|point| point.kind).collect();
    /// assert_eq!(kinds, [Some(Extremum::Minimum), Some(Extremum::Maximum)]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// An unknown id; a trimmed face, of which this is not available; a coordinate that is no finite number or beyond 1e75; a tolerance
    /// that is negative or not a number.
    pub fn stationary_points(
        &self,
        id: EntityId,
        p: DVec3,
        options: &StationaryOptions,
    ) -> Result<StationaryPoints, QueryError> {
        self.untrimmed(id, "stationary points")?.stationary_points(p, options, &mut Scratch::default())
    }

    /// An entity made ready for many queries by one thread, with the working memory that they reuse.
    ///
    /// # Errors
    ///
    /// An unknown id.
    pub fn projector(&self, id: EntityId) -> Result<Projector<'_>, QueryError> {
        Ok(Projector::new(id, self.prepared(id)?))
    }

    /// A query that is not answered of trimmed faces.
    fn untrimmed(&self, id: EntityId, what: &'static str) -> Result<&Prepared, QueryError> {
        let prepared = self.prepared(id)?;
        if prepared.trimming().is_some() { Err(QueryError::TrimmedFace { id, what }) } else { Ok(prepared) }
    }

    fn prepared(&self, id: EntityId) -> Result<&Prepared, QueryError> {
        self.entity(id).map(|entity| entity.prepared().as_ref()).ok_or(QueryError::UnknownEntity { id })
    }
}

/// The error of a single query, as one of the point at `index` of a batch.
pub(crate) fn at_index(error: QueryError, index: usize) -> QueryError {
    match error {
        QueryError::InvalidPoint { x, y, z, .. } => QueryError::InvalidPoint { index, x, y, z },
        error => error,
    }
}
