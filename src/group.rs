//! Entities that are asked together: the walk over boxes, with entities in place of pieces.

use glam::DVec3;
use perpend_kernel::{Aabb, EntityId};
use perpend_projection::{BoxTree, Candidate, FootPoint, Place, Query, QueryOptions, Scratch};

use crate::entity::Entity;
use crate::model::Model;

/// Entities that are farther than the nearest by less than this share of the group's size are taken for about as near: steers effort alone.
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
        let near = asked.nearly();
        let mut best: Option<Best> = None;
        // the least lower bound of those that were asked
        let mut lower_bound = f64::INFINITY;
        // entities whose bound does not say that they are beyond the limit
        let mut open: Vec<u32> = Vec::new();
        let outset = limit + self.rounding(query.point);
        self.tree.visit_nearest(query.point, square_above(outset), |item| {
            let next = match best {
                None => Some(asked.best(item, scratch)),
                // a face that has the foot in its box, on an edge, is likely as near
                Some(best) if is_on_border(&best.found.1) && self.holds(item, best.found.1.point) => {
                    Some(asked.best(item, scratch))
                }
                Some(best) => asked.best_within(item, best.found.1.distance.min(limit) + near, scratch),
            };
            if let Some(mut next) = next {
                if let Some(best) = &mut best
                    && next.found.1.distance + near >= best.found.1.distance
                {
                    // which is nearer, and by which digits, their own answers tell
                    *best = best.without_limit(asked, scratch);
                    next = next.without_limit(asked, scratch);
                }
                let (id, foot) = next.found;
                lower_bound = lower_bound.min(foot.lower_bound);
                if limit.is_finite() && foot.lower_bound <= limit {
                    open.push(item);
                }
                let is_nearer = |best: Best| (foot.distance, id) < (best.found.1.distance, best.found.0);
                if best.is_none_or(is_nearer) {
                    best = Some(next);
                }
            }
            square_above(best.map_or(outset, |best| best.found.1.distance.min(outset)))
        });
        let mut found = best?.without_limit(asked, scratch).found;
        lower_bound = lower_bound.min(found.1.lower_bound);
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
        let (rounding, near) = (self.rounding(query.point), asked.nearly());
        // farther than this, an entity is none of those sought
        let reach = |found: &[Found]| if found.len() < k { limit } else { limit.min(found[k - 1].1.distance) };
        self.tree.visit_nearest(query.point, square_above(limit + rounding), |item| {
            let within = reach(&found);
            if !within.is_finite() || asked.may_be_within(item, within + near, scratch) {
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

/// The nearest entity so far.
#[derive(Debug, Clone, Copy)]
struct Best {
    item: u32,
    found: Found,
    /// Whether it was asked with a limit: its own answer may differ in the last digits.
    is_limited: bool,
}

impl Best {
    /// The same with the entity's own answer.
    fn without_limit(self, asked: Asked<'_>, scratch: &mut Scratch) -> Self {
        if self.is_limited { asked.best(self.item, scratch) } else { self }
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

    /// Distances that differ by less are compared by the entities' own answers. A limit that is farther than the nearest by this is also proven at less cost
    /// than one at the nearest itself, where an entity is about as far as that: faces that share an edge are.
    fn nearly(self) -> f64 {
        (NEARLY * self.group.bounds.diagonal()).max(2.0 * self.query.options.gap.unwrap_or(0.0))
    }

    /// An entity as the nearest so far.
    fn best(self, item: u32, scratch: &mut Scratch) -> Best {
        Best { item, found: self.visit(item, scratch), is_limited: false }
    }

    /// The same, asked with a limit; none where it is proven to lie beyond that.
    fn best_within(self, item: u32, limit: f64, scratch: &mut Scratch) -> Option<Best> {
        let entity = self.entity(item);
        let foot = entity.prepared().project(&self.limited(Some(limit)), scratch)?;
        Some(Best { item, found: (entity.id, foot), is_limited: true })
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
