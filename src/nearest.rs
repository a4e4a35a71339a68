//! Queries to a whole model, and to its bodies.

use std::sync::OnceLock;

use glam::DVec3;
use perpend_kernel::{Aabb, EntityId};
use perpend_projection::{FootPoint, Query, QueryError, QueryOptions, Scratch};

use crate::batch;
use crate::group::Group;
use crate::model::Model;
use crate::query::at_index;
use crate::solid::Solid;

/// What queries to the whole model and to its bodies need, each part made when it is first asked for.
#[derive(Debug, Clone)]
pub(crate) struct Overview {
    /// All entities that are no part of others.
    whole: OnceLock<Group>,
    /// The bodies, in their order.
    solids: Vec<OnceLock<Solid>>,
    /// The box of all control points.
    pub(crate) bounds: Aabb,
}

impl Model {
    /// The entity nearest to `p` with its nearest point; none where it is proven that nothing is within `max_distance`, or the
    /// model is empty.
    ///
    /// Of entities at the same distance, the one with the lowest id. `lower_bound` holds for the whole model. Without a gap
    /// of its own, a query has each entity's: 1e-9 times its size.
    ///
    /// Entities that are parts of trimmed faces, as carriers or edges, and no faces of a body, are not asked: the faces stand for them.
    ///
    /// # Errors
    ///
    /// A coordinate that is no finite number or beyond 1e75; an option without meaning.
    pub fn nearest(&self, p: DVec3, options: &QueryOptions) -> Result<Option<(EntityId, FootPoint)>, QueryError> {
        Ok(self.whole().nearest(self, &Query::new(p, *options)?, &mut Scratch::default()))
    }

    /// [`nearest`](Self::nearest) for many points, in their order, on all cores where the feature `rayon` is on.
    #[must_use]
    pub fn nearest_all(
        &self,
        ps: &[DVec3],
        options: &QueryOptions,
    ) -> Vec<Result<Option<(EntityId, FootPoint)>, QueryError>> {
        self.each(ps, options, |query, scratch| self.whole().nearest(self, query, scratch))
    }

    /// The `k` entities nearest to `p`, each with its nearest point, in ascending order of distance, then of id; fewer where the model has
    /// no more, or no more within `max_distance`.
    ///
    /// Each foot is that of [`project`](Self::project), with that entity's own bound. Of an entity that is left out it is proven that it is
    /// no nearer than the last one listed, but for the gap of the query.
    ///
    /// # Errors
    ///
    /// As [`nearest`](Self::nearest).
    pub fn nearest_k(
        &self,
        p: DVec3,
        k: usize,
        options: &QueryOptions,
    ) -> Result<Vec<(EntityId, FootPoint)>, QueryError> {
        Ok(self.whole().nearest_k(self, k, &Query::new(p, *options)?, &mut Scratch::default()))
    }

    /// [`nearest_k`](Self::nearest_k) for many points, in their order, on all cores where the feature `rayon` is on.
    #[must_use]
    pub fn nearest_k_all(
        &self,
        ps: &[DVec3],
        k: usize,
        options: &QueryOptions,
    ) -> Vec<Result<Vec<(EntityId, FootPoint)>, QueryError>> {
        self.each(ps, options, |query, scratch| self.whole().nearest_k(self, k, query, scratch))
    }

    /// All entities within `radius` of `p`, each with its nearest point, in ascending order of distance, then of id.
    ///
    /// Of every entity that is left out it is proven that no point of it is within the radius. Every one listed has
    /// `lower_bound <= radius`: where its `distance` is too, it has a point within; where not, that was not decided within the
    /// work bound. Where `max_distance` is less than the radius, it takes its place.
    ///
    /// # Errors
    ///
    /// As [`nearest`](Self::nearest); a radius that is negative or not a number.
    pub fn within(
        &self,
        p: DVec3,
        radius: f64,
        options: &QueryOptions,
    ) -> Result<Vec<(EntityId, FootPoint)>, QueryError> {
        let query = Query::new(p, within(radius, options)?)?;
        Ok(self.whole().within(self, &query, &mut Scratch::default()))
    }

    /// [`within`](Self::within) for many points, in their order, on all cores where the feature `rayon` is on.
    #[must_use]
    pub fn within_all(
        &self,
        ps: &[DVec3],
        radius: f64,
        options: &QueryOptions,
    ) -> Vec<Result<Vec<(EntityId, FootPoint)>, QueryError>> {
        match within(radius, options) {
            Ok(options) => self.each(ps, &options, |query, scratch| self.whole().within(self, query, scratch)),
            Err(error) => vec![Err(error); ps.len()],
        }
    }

    /// The face of a body nearest to `p` with its nearest point; none where it is proven that the body is beyond `max_distance`.
    ///
    /// As [`nearest`](Self::nearest) of the body's faces alone.
    ///
    /// # Errors
    ///
    /// As [`nearest`](Self::nearest); an id that no body has.
    pub fn nearest_of(
        &self,
        body: EntityId,
        p: DVec3,
        options: &QueryOptions,
    ) -> Result<Option<(EntityId, FootPoint)>, QueryError> {
        let solid = self.solid(body)?;
        Ok(solid.faces.nearest(self, &Query::new(p, *options)?, &mut Scratch::default()))
    }

    /// [`nearest_of`](Self::nearest_of) for many points, in their order, on all cores where the feature `rayon` is on.
    #[must_use]
    pub fn nearest_of_all(
        &self,
        body: EntityId,
        ps: &[DVec3],
        options: &QueryOptions,
    ) -> Vec<Result<Option<(EntityId, FootPoint)>, QueryError>> {
        match self.solid(body) {
            Ok(solid) => self.each(ps, options, |query, scratch| solid.faces.nearest(self, query, scratch)),
            Err(error) => vec![Err(error); ps.len()],
        }
    }

    fn each<A: Send>(
        &self,
        ps: &[DVec3],
        options: &QueryOptions,
        answer: impl Fn(&Query, &mut Scratch) -> A + Sync + Send,
    ) -> Vec<Result<A, QueryError>> {
        batch::answers(ps, Scratch::default, |scratch, index, p| {
            let query = Query::new(*p, *options).map_err(|error| at_index(error, index))?;
            Ok(answer(&query, scratch))
        })
    }

    pub(crate) fn overview(&self) -> &Overview {
        self.overview.get_or_init(|| {
            let boxes = self.entities.iter().map(|entity| entity.definition.control_box());
            Overview {
                whole: OnceLock::new(),
                solids: vec![OnceLock::new(); self.bodies.len()],
                bounds: boxes.fold(Aabb::EMPTY, Aabb::join),
            }
        })
    }

    fn whole(&self) -> &Group {
        self.overview().whole.get_or_init(|| {
            let mut parts = self.parts_of_faces();
            // a body's faces are asked, whatever else they are
            for face in self.bodies.iter().flat_map(crate::Body::faces) {
                parts.remove(&face);
            }
            let items = self.entities.iter().enumerate().filter(|(_, entity)| !parts.contains(&entity.id));
            Group::new(self, items.map(|(at, _)| at).collect())
        })
    }

    /// A body made ready for queries.
    pub(crate) fn solid(&self, id: EntityId) -> Result<&Solid, QueryError> {
        let at = self.body_index.get(&id).copied().ok_or(QueryError::UnknownBody { id })?;
        Ok(self.overview().solids[at]
            .get_or_init(|| Solid::new(self, self.bodies[at].faces().map(|face| self.index[&face]).collect())))
    }
}

/// The options of a query for all that is within a radius.
fn within(radius: f64, options: &QueryOptions) -> Result<QueryOptions, QueryError> {
    if radius.is_nan() || radius < 0.0 {
        return Err(QueryError::InvalidOption { option: "radius", value: radius });
    }
    let radius = options.max_distance.map_or(radius, |most| most.min(radius));
    Ok(QueryOptions { max_distance: Some(radius), ..*options })
}
