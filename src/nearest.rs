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
    /// The entity nearest to `p` with its nearest point; none where nothing is within `max_distance`, or the model is empty.
    ///
    /// Of entities at the same distance, the one with the lowest id. `lower_bound` holds for the whole model. Without a gap
    /// of its own, a query has each entity's: 1e-9 times its size.
    ///
    /// # Errors
    ///
    /// A coordinate that is no finite number or beyond 1e150; an option without meaning.
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
        batch::answers(ps, |index, p, scratch| {
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
        let p = query.point;
        let tree = &self.overview().tree;
        let mut search = Search { query, best: None, lower_bound: f64::INFINITY };
        let (first, _) = tree.descend(p)?;
        search.visit(self, first, scratch);
        let mut candidates: Vec<Candidate> = Vec::new();
        tree.nearer_than(p, square_above(search.limit()), &mut candidates);
        candidates.retain(|candidate| candidate.item != first);
        let rank = |c: &Candidate| (c.distance_squared, self.entities[c.item as usize].id);
        candidates.sort_unstable_by(|a, b| {
            let ((a, of_a), (b, of_b)) = (rank(a), rank(b));
            a.total_cmp(&b).then(of_a.cmp(&of_b))
        });
        for candidate in candidates {
            if candidate.distance_squared >= square_above(search.limit()) {
                break; // the others are farther still
            }
            search.visit(self, candidate.item, scratch);
        }
        let lower_bound = search.lower_bound;
        search.best.map(|(id, foot)| (id, FootPoint { lower_bound: foot.lower_bound.min(lower_bound), ..foot }))
    }
}

/// A query to the whole model under way.
struct Search<'a> {
    query: &'a Query,
    best: Option<(EntityId, FootPoint)>,
    /// Proven for all entities that were looked at.
    lower_bound: f64,
}

impl Search<'_> {
    /// The distance beyond which nothing is wanted.
    fn limit(&self) -> f64 {
        let best = self.best.map_or(f64::INFINITY, |(_, foot)| foot.distance);
        self.query.options.max_distance.unwrap_or(f64::INFINITY).min(best)
    }

    fn visit(&mut self, model: &Model, item: u32, scratch: &mut Scratch) {
        let entity = &model.entities[item as usize];
        let limit = self.limit();
        let options = QueryOptions { max_distance: limit.is_finite().then_some(limit), ..self.query.options };
        let query = Query { options, ..*self.query };
        match entity.prepared().project(&query, scratch) {
            Some(foot) => {
                self.lower_bound = self.lower_bound.min(foot.lower_bound);
                let better = self.best.is_none_or(|(id, best)| (foot.distance, entity.id) < (best.distance, id));
                if better {
                    self.best = Some((entity.id, foot));
                }
            }
            None => {
                // Nothing of it is nearer than the limit, but for the gap within which that is proven.
                let gap = options.gap.unwrap_or_else(|| 1e-9 * entity.definition.size());
                self.lower_bound = self.lower_bound.min((limit - gap).max(0.0));
            }
        }
    }
}

/// At least the square of `distance`, and above it: boxes exactly that far are met too.
fn square_above(distance: f64) -> f64 {
    distance * distance * (1.0 + 8.0 * f64::EPSILON) + f64::MIN_POSITIVE
}
