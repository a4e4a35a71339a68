//! What an edit of an entity would touch.

use perpend_kernel::EntityId;
use perpend_knowledge::{MakingError, Relation};

use crate::dependence::Dependence;
use crate::edit::EditError;
use crate::entity::Entity;
use crate::model::Model;
use crate::standing::Standing;

/// An entity that an edit of another one would touch.
#[derive(Debug, Clone, PartialEq)]
pub struct Impact {
    /// The entity.
    pub id: EntityId,
    /// The entities touched before it to which it is related, with what they are to it; the edited one among them.
    pub because: Vec<(Relation, EntityId)>,
    /// What the edit would do to it.
    pub effect: Effect,
}

/// What an edit of another entity does to one.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Effect {
    /// It is made anew, or, trimming another entity, follows that.
    Rebuilt,
    /// Its definition was replaced by hand after it had been made. It is kept, and may no longer fit.
    Overridden,
    /// It is made of what is touched by an operation that cannot be run. It is kept, and may no longer fit.
    Kept {
        /// Why the operation cannot be run.
        why: MakingError,
    },
    /// It only refers to what is touched. It is kept, and what it states may no longer hold.
    Refers,
}

impl Model {
    /// Every entity that an edit of this one would touch, and why: first those that are made of it, in the order in which they
    /// would be rebuilt, each with whether it would be; then those that only refer to one that changes, in the order of the
    /// model.
    ///
    /// Whether a rebuild would succeed, the edit itself shows, which leaves the model as it was where not.
    ///
    /// # Errors
    ///
    /// An unknown id.
    pub fn impact(&self, id: EntityId) -> Result<Vec<Impact>, EditError> {
        let start = self.position(id)?;
        let dependence = Dependence::of(&self.entities, &self.index);
        // whose definitions may change
        let mut changes = vec![false; self.entities.len()];
        changes[start] = true;
        let mut touched = Vec::new();
        for at in dependence.after(start) {
            if !dependence.made_from(at).iter().any(|input| changes[*input]) {
                continue;
            }
            let entity = &self.entities[at];
            let effect = if entity.carrier().is_some() { Effect::Rebuilt } else { self.effect(entity) };
            changes[at] = effect == Effect::Rebuilt;
            touched.push(Impact { id: entity.id, because: self.because(at, &changes), effect });
        }
        let listed: Vec<EntityId> = touched.iter().map(|one| one.id).collect();
        for (at, entity) in self.entities.iter().enumerate().filter(|(at, _)| *at != start) {
            let because = self.because(at, &changes);
            if !because.is_empty() && !listed.contains(&entity.id) {
                touched.push(Impact { id: entity.id, because, effect: Effect::Refers });
            }
        }
        Ok(touched)
    }

    /// What an edit of what an entity is made of does to it.
    fn effect(&self, entity: &Entity) -> Effect {
        match Standing::of(entity, self) {
            Standing::Made => Effect::Rebuilt,
            Standing::Overridden => Effect::Overridden,
            Standing::Reference(why) => Effect::Kept { why },
            Standing::Unmade => Effect::Refers,
        }
    }

    /// What the changing entities to which one is related are to it.
    fn because(&self, at: usize, changes: &[bool]) -> Vec<(Relation, EntityId)> {
        let entity = &self.entities[at];
        let is_changing = |id: &EntityId| self.index.get(id).is_some_and(|input| *input != at && changes[*input]);
        let record = entity.record.iter();
        let stated = record.flat_map(|record| &record.relationships).map(|edge| (edge.kind.clone(), edge.target));
        // inputs to which no relationship is stated: what the operation makes of them
        let making = entity.record.as_ref().and_then(|record| record.making());
        let steps = making.map_or_else(Vec::new, |making| making.steps.to_vec());
        let implied = steps.iter().flat_map(|step| step.relationships()).map(|edge| (edge.kind, edge.target));
        let carrier = entity.carrier().map(|carrier| (Relation::PartOf, carrier));
        let edges = entity.trimming().into_iter().flat_map(|trimming| trimming.edges());
        let trimmed = carrier.into_iter().chain(edges.map(|edge| (Relation::Boundary, edge)));
        let mut because: Vec<(Relation, EntityId)> = Vec::new();
        for (relation, target) in stated.chain(implied).chain(trimmed) {
            if is_changing(&target) && !because.contains(&(relation.clone(), target)) {
                because.push((relation, target));
            }
        }
        because
    }
}
