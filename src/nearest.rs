//! Queries to a whole model: the same walk over boxes, with entities in place of pieces.

use glam::DVec3;
use perpend_kernel::{Aabb, EntityId};
use perpend_projection::{BoxTree, Candidate, FootPoint, Query, QueryError, QueryOptions, Scratch};

use crate::batch;
use crate::model::Model;
use crate::query::at_index;

/// What queries to the whole model need.
#[derive(Debug, Clone)]
pub(crate) struct Overview {
    /// Over the control boxes of the entities, in their order.
    tree: BoxTree,
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
    /// # Errors
    ///
    /// A coordinate that is no finite number or beyond 1e75; an option without meaning.
    pub fn nearest(&self, p: DVec3, options: &QueryOptions) -> Result<Option<(EntityId, FootPoint)>, QueryError> {
        Ok(self.nearest_to(&Query::new(p, *options)?, &mut Scratch::default()))
    }

    /// [`nearest`](Self::nearest) for many points, in their order, on all cores where the feature `rayon` is on.
    #[must_use]
    pub fn nearest_all(
        &self,
        ps: &[DVec3],
        options: &QueryOptions,
    ) -> Vec<Result<Option<(EntityId, FootPoint)>, QueryError>> {
        batch::answers(ps, Scratch::default, |scratch, index, p| {
            let query = Query::new(*p, *options).map_err(|error| at_index(error, index))?;
            Ok(self.nearest_to(&query, scratch))
        })
    }

    pub(crate) fn overview(&self) -> &Overview {
        self.overview.get_or_init(|| {
            let boxes: Vec<Aabb> = self.entities.iter().map(|entity| entity.definition.control_box()).collect();
            let bounds = boxes.iter().fold(Aabb::EMPTY, |all, one| all.join(*one));
            Overview { tree: BoxTree::new(&boxes), bounds }
        })
    }

    fn nearest_to(&self, query: &Query, scratch: &mut Scratch) -> Option<(EntityId, FootPoint)> {
        let tree = &self.overview().tree;
        let limit = query.options.max_distance.unwrap_or(f64::INFINITY);
        // An entity is asked without a limit: its answer then bounds its distance, also where it is too far.
        let query = Query { options: QueryOptions { max_distance: None, ..query.options }, ..*query };
        let (first, _) = tree.descend(query.point)?;
        let mut found = self.visit(first, &query, scratch);
        // entities whose bound does not say that they are beyond the limit
        let mut open: Vec<u32> = (found.1.lower_bound <= limit).then_some(first).into_iter().collect();
        let mut candidates: Vec<Candidate> = Vec::new();
        tree.nearer_than(query.point, square_above(found.1.distance), &mut candidates);
        candidates.retain(|candidate| candidate.item != first);
        let id = |candidate: &Candidate| self.entities[candidate.item as usize].id;
        candidates.sort_unstable_by(|a, b| a.distance_squared.total_cmp(&b.distance_squared).then(id(a).cmp(&id(b))));
        for candidate in candidates {
            if candidate.distance_squared >= square_above(found.1.distance) {
                break; // the others are farther still
            }
            let other = self.visit(candidate.item, &query, scratch);
            open.extend((other.1.lower_bound <= limit).then_some(candidate.item));
            let lower_bound = found.1.lower_bound.min(other.1.lower_bound);
            if (other.1.distance, other.0) < (found.1.distance, found.0) {
                found = other;
            }
            found.1.lower_bound = lower_bound;
        }
        // The entities that were not asked are no nearer, as far as boxes in the model's coordinates tell: the distance to
        // one rounds by a few ulps of these, which counts where the model lies far from its origin.
        let reach = self.overview().bounds.reach().max(query.point.abs().max_element());
        let proven = (found.1.distance - 8.0 * f64::EPSILON * reach).max(0.0);
        found.1.lower_bound = found.1.lower_bound.min(proven);
        let is_found =
            found.1.distance <= limit || open.iter().any(|item| self.may_be_within(*item, limit, &query, scratch));
        is_found.then_some(found)
    }

    /// Whether an entity, asked with the limit, is not proven to lie beyond it.
    fn may_be_within(&self, item: u32, limit: f64, query: &Query, scratch: &mut Scratch) -> bool {
        let query = Query { options: QueryOptions { max_distance: Some(limit), ..query.options }, ..*query };
        self.entities[item as usize].prepared().project(&query, scratch).is_some()
    }

    fn visit(&self, item: u32, query: &Query, scratch: &mut Scratch) -> (EntityId, FootPoint) {
        let entity = &self.entities[item as usize];
        let foot = entity.prepared().project(query, scratch);
        (entity.id, foot.expect("an entity has a nearest point where no distance is too far"))
    }
}

/// Above the square of `distance` by more than rounding: a box that is not below it is at least `distance` away.
fn square_above(distance: f64) -> f64 {
    distance * distance * (1.0 + 8.0 * f64::EPSILON) + f64::MIN_POSITIVE
}
