//! Entities that are asked together: the walk over boxes, with entities in place of pieces.

use glam::DVec3;
use perpend_kernel::{Aabb, EntityId};
use perpend_projection::{BoxTree, Candidate, FootPoint, Place, Query, QueryOptions, Scratch};

use crate::entity::Entity;
use crate::model::Model;

/// Entities that are farther than the nearest by less than this share of the group's size are asked where they are nearest: steers effort alone.
const NEARLY: f64 = 1e-6;

/// An entity and its nearest point.
pub(crate) type Found = (EntityId, FootPoint);

/// Entities that are asked together.
#[derive(Debug, Clone)]
pub(crate) struct Group {
    /// Their places in the model.
    items: Vec<usize>,
    /// Over their boxes, in the order of `items`.
    tree: BoxTree,
    boxes: Vec<Aabb>,
    /// The box of them all.
    pub(crate) bounds: Aabb,
}

impl Group {
    pub(crate) fn new(model: &Model, items: Vec<usize>) -> Self {
        let boxes = boxes(&model.entities, &items);
        let bounds = boxes.iter().fold(Aabb::EMPTY, |all, one| all.join(*one));
        Self { items, tree: BoxTree::new(&boxes), boxes, bounds }
    }

    /// How many there are.
    pub(crate) fn len(&self) -> usize {
        self.items.len()
    }

    pub(crate) fn entity<'m>(&self, model: &'m Model, item: usize) -> &'m Entity {
        &model.entities[self.items[item]]
    }

    /// Whether a point lies in the box of an entity, or hardly beside it.
    fn holds(&self, item: u32, p: DVec3) -> bool {
        self.boxes[item as usize].distance_squared(p) <= (NEARLY * self.bounds.diagonal()).powi(2)
    }

    /// Those whose boxes may lie within a distance, in order of id.
    pub(crate) fn near(&self, model: &Model, p: DVec3, distance: f64) -> Vec<usize> {
        let near = self.candidates(model, p, distance + self.rounding(p));
        let mut items: Vec<usize> = near.into_iter().map(|candidate| candidate.item as usize).collect();
        items.sort_unstable_by_key(|item| self.entity(model, *item).id);
        items
    }

    /// How far the distance to a box may be off by rounding, in the model's coordinates, seen from a point.
    fn rounding(&self, p: DVec3) -> f64 {
        8.0 * f64::EPSILON * self.bounds.reach().max(p.abs().max_element())
    }

    /// The nearest entity with its nearest point; none where it is proven that nothing is within the maximum distance, or there are none.
    pub(crate) fn nearest(&self, model: &Model, query: &Query, scratch: &mut Scratch) -> Option<Found> {
        let asked = Asked { group: self, model, query };
        let limit = query.options.max_distance.unwrap_or(f64::INFINITY);
        let mut found: Option<Found> = None;
        // the least lower bound of those that were asked
        let mut lower_bound = f64::INFINITY;
        // entities whose bound does not say that they are beyond the limit
        let mut open: Vec<u32> = Vec::new();
        let outset = limit + self.rounding(query.point);
        self.tree.visit_nearest(query.point, square_above(outset), |item| {
            let reach = found.map_or(f64::INFINITY, |found| found.1.distance).min(limit);
            // a face that has the foot in its box, on an edge, is likely as near
            let is_beside = found.is_some_and(|found| is_on_border(&found.1) && self.holds(item, found.1.point));
            if is_beside || asked.may_be_near(item, reach, scratch) {
                let one = asked.visit(item, scratch);
                lower_bound = lower_bound.min(one.1.lower_bound);
                if one.1.lower_bound <= limit {
                    open.push(item);
                }
                if found.is_none_or(|found| (one.1.distance, one.0) < (found.1.distance, found.0)) {
                    found = Some(one);
                }
            }
            square_above(found.map_or(outset, |found| found.1.distance.min(outset)))
        });
        let mut found = found?;
        // The entities that were not asked are no nearer, as far as boxes in the model's coordinates tell: the distance to
        // one rounds by a few ulps of these, which counts where the model lies far from its origin.
        let proven = (found.1.distance.min(limit) - self.rounding(query.point)).max(0.0);
        found.1.lower_bound = lower_bound.min(proven);
        let is_found = found.1.distance <= limit || open.iter().any(|item| asked.may_be_within(*item, limit, scratch));
        is_found.then_some(found)
    }

    /// The `k` nearest entities with their nearest points, the nearest first.
    pub(crate) fn nearest_k(&self, model: &Model, k: usize, query: &Query, scratch: &mut Scratch) -> Vec<Found> {
        let mut found: Vec<Found> = Vec::new();
        if k == 0 {
            return found;
        }
        let asked = Asked { group: self, model, query };
        let limit = query.options.max_distance.unwrap_or(f64::INFINITY);
        let rounding = self.rounding(query.point);
        // farther than this, an entity is none of those sought
        let reach = |found: &[Found]| if found.len() < k { limit } else { limit.min(found[k - 1].1.distance) };
        self.tree.visit_nearest(query.point, square_above(limit + rounding), |item| {
            if asked.may_be_near(item, reach(&found), scratch) {
                let one = asked.visit(item, scratch);
                if one.1.distance <= limit || asked.may_be_within(item, limit, scratch) {
                    let at = found.partition_point(|other| (other.1.distance, other.0) < (one.1.distance, one.0));
                    found.insert(at, one);
                    found.truncate(k);
                }
            }
            square_above(reach(&found) + rounding)
        });
        found
    }

    /// All entities that are not proven to lie beyond the maximum distance of the query, with their nearest points, the nearest first.
    pub(crate) fn within(&self, model: &Model, query: &Query, scratch: &mut Scratch) -> Vec<Found> {
        let asked = Asked { group: self, model, query };
        let radius = query.options.max_distance.unwrap_or(f64::INFINITY) + self.rounding(query.point);
        let near = self.candidates(model, query.point, radius);
        let mut found: Vec<Found> = near
            .into_iter()
            .filter_map(|candidate| {
                let entity = asked.entity(candidate.item);
                entity.prepared().project(query, scratch).map(|foot| (entity.id, foot))
            })
            .collect();
        found.sort_by(|a, b| a.1.distance.total_cmp(&b.1.distance).then(a.0.cmp(&b.0)));
        found
    }

    /// The entities whose boxes may lie within a distance, the nearest box first, then the lowest id.
    fn candidates(&self, model: &Model, p: DVec3, distance: f64) -> Vec<Candidate> {
        let mut candidates: Vec<Candidate> = Vec::new();
        self.tree.nearer_than(p, square_above(distance), &mut candidates);
        let id = |candidate: &Candidate| model.entities[self.items[candidate.item as usize]].id;
        candidates.sort_unstable_by(|a, b| a.distance_squared.total_cmp(&b.distance_squared).then(id(a).cmp(&id(b))));
        candidates
    }
}

/// A query to a group.
#[derive(Clone, Copy)]
struct Asked<'a> {
    group: &'a Group,
    model: &'a Model,
    query: &'a Query,
}

impl<'a> Asked<'a> {
    fn entity(self, item: u32) -> &'a Entity {
        &self.model.entities[self.group.items[item as usize]]
    }

    /// Whether an entity, asked with a limit, is not proven to lie beyond it.
    fn may_be_within(self, item: u32, limit: f64, scratch: &mut Scratch) -> bool {
        let query = self.limited(Some(limit).filter(|limit| limit.is_finite()));
        self.entity(item).prepared().project(&query, scratch).is_some()
    }

    /// Whether an entity is not proven to lie beyond a distance by more than a share of the group's size. That costs less than to prove it beyond the distance
    /// itself, where it is about as far as that: faces that share an edge are.
    fn may_be_near(self, item: u32, distance: f64, scratch: &mut Scratch) -> bool {
        !distance.is_finite() || self.may_be_within(item, distance + NEARLY * self.group.bounds.diagonal(), scratch)
    }

    /// An entity's answer without a limit: it then bounds its distance, also where it is too far.
    fn visit(self, item: u32, scratch: &mut Scratch) -> Found {
        let entity = self.entity(item);
        let foot = entity.prepared().project(&self.limited(None), scratch);
        (entity.id, foot.expect("an entity has a nearest point where no distance is too far"))
    }

    fn limited(self, max_distance: Option<f64>) -> Query {
        Query { options: QueryOptions { max_distance, ..self.query.options }, ..*self.query }
    }
}

/// The boxes of entities: of a trimmed face, that of the part that counts, which is made ready for that.
#[cfg(feature = "rayon")]
fn boxes(entities: &[Entity], items: &[usize]) -> Vec<Aabb> {
    use rayon::prelude::*;
    items.par_iter().map(|at| bounds(&entities[*at])).collect()
}

#[cfg(not(feature = "rayon"))]
fn boxes(entities: &[Entity], items: &[usize]) -> Vec<Aabb> {
    items.iter().map(|at| bounds(&entities[*at])).collect()
}

fn bounds(entity: &Entity) -> Aabb {
    match entity.trimming() {
        Some(_) => entity.prepared().bounds(),
        None => entity.definition.control_box(),
    }
}

/// Whether a foot lies where faces meet others.
fn is_on_border(foot: &FootPoint) -> bool {
    matches!(foot.place, Place::TrimEdge | Place::Vertex | Place::Edge | Place::Corner)
}

/// Above the square of `distance` by more than rounding: a box that is not below it is at least `distance` away.
fn square_above(distance: f64) -> f64 {
    distance * distance * (1.0 + 8.0 * f64::EPSILON) + f64::MIN_POSITIVE
}
