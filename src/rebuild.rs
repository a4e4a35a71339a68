//! Edits that reach further: an entity is made anew, and all that is made of it after it, or nothing at all.

use std::collections::HashMap;
use std::sync::{Arc, OnceLock};

use perpend_kernel::{Definition, EntityId, Fingerprint, InvalidTrim, Trimming};
use perpend_knowledge::{
    Basis, BuildError, Built, Checked, Definitions, Intent, Item, Making, MakingError, Operation, Origin, Record,
    Relation, default_tolerance, prove,
};

use crate::dependence::{Dependence, shown};
use crate::entity::{Entity, Part};
use crate::model::Model;
use crate::referent::Referent;
use crate::standing::Standing;
use crate::trimmed::note;

/// Why an entity was not made anew. The model is as it was, bit for bit.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RebuildError {
    /// The model has no entity of this id.
    #[error("the model has no entity {id}")]
    UnknownEntity {
        /// The id.
        id: EntityId,
    },
    /// The record does not say how the entity was made, or names operations that perpend does not run.
    #[error(
        "entity {id} was not made by operations that perpend runs: replace its definition, or remake it by an operation"
    )]
    NotMade {
        /// The entity.
        id: EntityId,
    },
    /// No step in force has this operation.
    #[error("entity {id}: none of the steps that made it is {operation}: edit one of {}, or remake it", steps.join(", "))]
    NoStep {
        /// The entity.
        id: EntityId,
        /// The operation that was given.
        operation: &'static str,
        /// The operations of its steps.
        steps: Vec<&'static str>,
    },
    /// The definition was replaced by hand after the entity was made: an edit would lose that.
    #[error(
        "entity {id} was replaced by hand after it was made, which an edit would lose: rebuild or remake it first, or replace it again"
    )]
    Overridden {
        /// The entity.
        id: EntityId,
    },
    /// An input does not exist.
    #[error("entity {id}: the input {input} is not in the model: insert that entity first")]
    UnknownInput {
        /// The entity.
        id: EntityId,
        /// The input.
        input: EntityId,
    },
    /// An entity would be made of itself.
    #[error("entity {id} would be made of itself ({}): name other inputs", shown(circle))]
    Cycle {
        /// The entity.
        id: EntityId,
        /// Entities each of which is made of the one before it, and the first of the last.
        circle: Vec<EntityId>,
    },
    /// An entity cannot be built.
    #[error("entity {id}{}: {source}", if id == edited { String::new() } else { format!(", which is made of entity {edited}, cannot be rebuilt") })]
    Build {
        /// The entity that was edited.
        edited: EntityId,
        /// The entity that cannot be built: that one, or one that is made of it.
        id: EntityId,
        /// What its operation lacks.
        source: Box<BuildError>,
    },
    /// A face trims another entity: it is made when that is.
    #[error("entity {id} trims entity {carrier} and follows it: edit entity {carrier}, or replace the face")]
    FollowsCarrier {
        /// The face.
        id: EntityId,
        /// The entity that it trims.
        carrier: EntityId,
    },
    /// The trim of a face does not hold of its new surface.
    #[error("entity {id}{}: definition: {source}", if id == edited { String::new() } else { format!(", which follows entity {edited}") })]
    Trim {
        /// The entity that was edited.
        edited: EntityId,
        /// The face: that one, or one that follows it.
        id: EntityId,
        /// The rule that the trim breaks.
        source: InvalidTrim,
    },
    /// An entity would become what a face or a body that it is a part of cannot use.
    #[error(
        "entity {id} would become one {is}, and {field} of entity {by} names it: remove or replace entity {by} first"
    )]
    Part {
        /// The entity.
        id: EntityId,
        /// What it would become.
        is: Referent,
        /// The face or body that it is a part of.
        by: EntityId,
        /// The field that names it.
        field: String,
    },
}

/// Definitions and records under way, over those of a model.
#[derive(Debug)]
pub(crate) struct Staged<'a> {
    model: &'a Model,
    /// In the order in which they changed.
    pub(crate) order: Vec<EntityId>,
    changed: HashMap<EntityId, Change>,
}

/// What an entity is to become.
#[derive(Debug)]
pub(crate) struct Change {
    pub(crate) definition: Arc<Definition>,
    pub(crate) record: Option<Record>,
    pub(crate) part: Option<Part>,
    /// Whether the trim was validated against this definition.
    is_checked: bool,
}

/// What is to be taken over.
pub(crate) type Changes = Vec<(EntityId, Change)>;

impl Definitions for Staged<'_> {
    fn get(&self, id: EntityId) -> Option<&Definition> {
        match self.changed.get(&id) {
            Some(change) => Some(&change.definition),
            None => self.model.get(id),
        }
    }
}

impl<'a> Staged<'a> {
    pub(crate) fn new(model: &'a Model) -> Self {
        Self { model, order: Vec::new(), changed: HashMap::new() }
    }

    /// Gives an entity a definition; what trims it stays, and is validated anew in [`changes`](Self::changes).
    pub(crate) fn set(&mut self, id: EntityId, definition: Arc<Definition>, record: Option<Record>) {
        let part = self.model.entity(id).and_then(|entity| entity.part.clone());
        self.insert(id, Change { definition, record, part, is_checked: false });
    }

    /// Gives an entity a definition and what trims it, which was validated against that.
    pub(crate) fn set_with(
        &mut self,
        id: EntityId,
        definition: Arc<Definition>,
        record: Option<Record>,
        part: Option<Part>,
    ) {
        self.insert(id, Change { definition, record, part, is_checked: true });
    }

    fn insert(&mut self, id: EntityId, change: Change) {
        if self.changed.insert(id, change).is_none() {
            self.order.push(id);
        }
    }

    /// Rebuilds all that is made of an entity whose definition has changed, and lets the faces that trim it follow.
    pub(crate) fn spread(&mut self, edited: EntityId) -> Result<(), RebuildError> {
        let model = self.model;
        let dependence = Dependence::of(&model.entities, &model.index);
        for at in dependence.after(model.index[&edited]) {
            let entity = &model.entities[at];
            let is_touched = dependence.made_from(at).iter().any(|input| {
                let input = &model.entities[*input];
                self.changed.get(&input.id).is_some_and(|change| *change.definition != *input.definition)
            });
            let record = entity.record.clone().unwrap_or_default();
            if let Some(carrier) = entity.carrier() {
                if let Some(Change { definition, .. }) = self.changed.get(&carrier).filter(|_| is_touched) {
                    let definition = Arc::clone(definition);
                    self.set(entity.id, Arc::clone(&definition), Some(followed(record, &definition)));
                }
                continue;
            }
            let Some(making) = record.making().filter(|_| is_touched) else { continue };
            if Standing::of(entity, model) != Standing::Made {
                continue;
            }
            let built = making.run(self).map_err(|error| failed(edited, entity.id, error))?;
            if built.definition == *entity.definition {
                continue;
            }
            let remade = remade(&record, &making, &built, self);
            self.set(entity.id, Arc::new(built.definition), Some(remade));
        }
        Ok(())
    }

    /// What is to be taken over, once every trim holds of its new surface, and every entity is what those need that it is a part of.
    pub(crate) fn changes(self, edited: EntityId) -> Result<Changes, RebuildError> {
        let Self { model, order, mut changed } = self;
        let mut changes = Vec::with_capacity(order.len());
        for id in order {
            let Some(mut change) = changed.remove(&id) else { continue };
            let before = &model.entities[model.index[&id]];
            if !change.is_checked && change.definition != before.definition {
                change.check_trim().map_err(|source| RebuildError::Trim { edited, id, source })?;
            }
            let is = change.referent();
            if is != Referent::of(before)
                && let Some(one) = model.uses(id).find(|one| !one.admits(is))
            {
                return Err(RebuildError::Part { id, is, by: one.by, field: one.field() });
            }
            changes.push((id, change));
        }
        Ok(changes)
    }
}

impl Change {
    /// Validates the trim against the new surface. What trimmed a surface that became a curve is no face any more.
    fn check_trim(&mut self) -> Result<(), InvalidTrim> {
        let (Some(part), Definition::NurbsSurface(surface)) = (&mut self.part, self.definition.as_ref()) else {
            self.part = None;
            return Ok(());
        };
        let (trimming, entry) = Trimming::enter(part.trimming.data(), surface)?;
        part.trimming = Arc::new(trimming);
        note(&entry, &self.definition, &mut self.record);
        Ok(())
    }

    fn referent(&self) -> Referent {
        match self.definition.as_ref() {
            Definition::NurbsCurve(_) => Referent::Curve,
            Definition::NurbsSurface(_) if self.part.is_some() => Referent::Trimmed,
            Definition::NurbsSurface(_) => Referent::Surface,
        }
    }
}

/// The record of a face whose carrier has changed.
fn followed(mut record: Record, definition: &Definition) -> Record {
    record.revision = record.revision.saturating_add(1);
    record.forget_stale(definition.fingerprint());
    record
}

fn failed(edited: EntityId, id: EntityId, error: MakingError) -> RebuildError {
    match error {
        MakingError::Build(source) => RebuildError::Build { edited, id, source: Box::new(source) },
        MakingError::UnknownEntity { id: input } => RebuildError::UnknownInput { id, input },
        _ => RebuildError::NotMade { id },
    }
}

/// The record of an entity that was made: of its steps, what they tell of it, and nothing that was computed from an older
/// definition.
pub(crate) fn remade(old: &Record, making: &Making<'_>, built: &Built, inputs: &impl Definitions) -> Record {
    let hash = built.definition.fingerprint();
    let mut record = old.clone();
    record.revision = record.revision.saturating_add(1);
    record.forget_stale(hash);
    let mut steps = making.steps.to_vec();
    if let Some(last) = steps.last_mut() {
        last.of = Some(hash);
    }
    let class = record.classification.get_or_insert_default();
    // A class that its operation gives is still proved, as it will be on loading: where rounding is all there is, none is stated.
    let tolerance = default_tolerance(&built.definition);
    let kind = built.kind.clone().filter(|kind| prove(kind, &built.definition, tolerance).is_ok());
    if let Some(value) = kind {
        class.kind = Some(Item { value, basis: Basis::Defined, tolerance, of: hash });
    }
    let from: Vec<EntityId> = steps.iter().flat_map(|step| step.inputs.iter().copied()).collect();
    match &class.origin {
        None | Some(Origin::Designed | Origin::Derived { .. }) => {
            class.origin = Some(if from.is_empty() {
                Origin::Designed
            } else {
                let operation = steps.last().map_or("", |step| step.operation.name()).to_owned();
                Origin::Derived { operation, from }
            });
        }
        Some(Origin::Imported { .. } | Origin::Fitted { .. }) => {}
    }
    let mut edges: Vec<_> = steps.iter().flat_map(Intent::relationships).collect();
    for edge in &mut edges {
        // the definition was made through it just now, so that running it again gives the same bits
        let target = inputs.get(edge.target).map(Definition::fingerprint);
        edge.checked = target.map(|target| Checked { deviation: 0.0, tolerance, of: hash, target });
    }
    let is_stated_anew = |kind: &Relation, target| edges.iter().any(|edge| edge.kind == *kind && edge.target == target);
    let others = old.relationships.iter().filter(|edge| {
        !(edge.is_of_operation() || edge.parameters.is_empty() && is_stated_anew(&edge.kind, edge.target))
    });
    let mut others: Vec<_> = others.cloned().collect();
    for other in &mut others {
        other.checked.take_if(|checked| checked.of != hash);
    }
    record.relationships = edges;
    record.relationships.extend(others);
    record.intent.truncate(making.first.unwrap_or(0));
    record.intent.extend(steps);
    record
}

impl Model {
    /// Changes the parameters of the operation that made an entity, and makes it and all that is made of it anew, in order of
    /// dependence: all or nothing. Returns the entities that changed, this one first.
    ///
    /// Of an entity that was made in several steps, the last one with this operation is changed; the operation of a single
    /// step may be another one that takes as many inputs. Entities that were replaced by hand after they had been made keep
    /// their definition, and so do those whose operation perpend does not run; [`impact`](Self::impact) names them beforehand.
    ///
    /// # Errors
    ///
    /// An entity that was not made by operations, or was replaced by hand since; an entity that cannot be built. The model is
    /// as it was then, bit for bit.
    pub fn edit(&mut self, id: EntityId, operation: impl Into<Operation>) -> Result<Vec<EntityId>, RebuildError> {
        let operation = operation.into();
        let entity = self.not_following(id)?;
        match Standing::of(entity, self) {
            Standing::Made => {}
            Standing::Overridden => return Err(RebuildError::Overridden { id }),
            Standing::Unmade | Standing::Reference(_) => return Err(RebuildError::NotMade { id }),
        }
        let record = entity.record.clone().unwrap_or_default();
        let making = record.making().ok_or(RebuildError::NotMade { id })?;
        let mut steps = making.steps.to_vec();
        let names = || making.steps.iter().map(|step| step.operation.name()).collect();
        let at = match &*steps {
            [_] => 0,
            _ => steps
                .iter()
                .rposition(|step| step.operation.name() == operation.name())
                .ok_or_else(|| RebuildError::NoStep { id, operation: operation.name(), steps: names() })?,
        };
        steps[at].operation = operation;
        let making = Making { steps: steps.into(), first: making.first };
        self.make_anew(id, &record, &making)
    }

    /// Makes an entity by another operation and of other inputs, whatever it was before, and all that is made of it anew: all
    /// or nothing. Returns the entities that changed, this one first.
    ///
    /// # Errors
    ///
    /// An unknown id or input; an entity that would be made of itself; an entity that cannot be built. The model is as it was
    /// then, bit for bit.
    pub fn remake(
        &mut self,
        id: EntityId,
        operation: impl Into<Operation>,
        inputs: &[EntityId],
    ) -> Result<Vec<EntityId>, RebuildError> {
        let entity = self.not_following(id)?;
        let record = entity.record.clone().unwrap_or_default();
        let steps = vec![Intent::new(operation, inputs)];
        let first = record.making().and_then(|making| making.first);
        self.make_anew(id, &record, &Making { steps: steps.into(), first })
    }

    /// Runs the steps of an entity again and takes what they give over, as well where the definition was replaced by hand; then
    /// all that is made of it is made anew: all or nothing. Returns the entities that changed.
    ///
    /// # Errors
    ///
    /// As [`edit`](Self::edit), but for a definition that was replaced by hand, which is lost.
    pub fn rebuild(&mut self, id: EntityId) -> Result<Vec<EntityId>, RebuildError> {
        let entity = self.not_following(id)?;
        let record = entity.record.clone().unwrap_or_default();
        let making = record.making().ok_or(RebuildError::NotMade { id })?;
        self.make_anew(id, &record, &making)
    }

    /// An entity that is made by itself, and not when its carrier is.
    fn not_following(&self, id: EntityId) -> Result<&Entity, RebuildError> {
        let entity = self.entity(id).ok_or(RebuildError::UnknownEntity { id })?;
        match entity.carrier() {
            Some(carrier) => Err(RebuildError::FollowsCarrier { id, carrier }),
            None => Ok(entity),
        }
    }

    fn make_anew(&mut self, id: EntityId, record: &Record, making: &Making<'_>) -> Result<Vec<EntityId>, RebuildError> {
        let at = self.index[&id];
        self.check_inputs(id, making.steps.iter().flat_map(|step| &step.inputs))?;
        let mut staged = Staged::new(self);
        let built = making.run(&staged).map_err(|error| failed(id, id, error))?;
        let record = remade(record, making, &built, &staged);
        let is_same = built.definition == *self.entities[at].definition;
        staged.set(id, Arc::new(built.definition), Some(record));
        if !is_same {
            staged.spread(id)?;
        }
        let changed = staged.order.clone();
        let changes = staged.changes(id)?;
        self.take_over(changes);
        Ok(changed)
    }

    /// Refuses inputs that do not exist, and those that are made of the entity.
    pub(crate) fn check_inputs<'i>(
        &self,
        id: EntityId,
        inputs: impl Iterator<Item = &'i EntityId>,
    ) -> Result<(), RebuildError> {
        let inputs: Vec<usize> = inputs
            .map(|input| self.index.get(input).copied().ok_or(RebuildError::UnknownInput { id, input: *input }))
            .collect::<Result<_, _>>()?;
        if inputs.is_empty() {
            return Ok(());
        }
        let dependence = Dependence::of(&self.entities, &self.index);
        match dependence.circle(self.index[&id], &inputs) {
            None => Ok(()),
            Some(circle) => {
                let circle = circle.into_iter().map(|at| self.entities[at].id).collect();
                Err(RebuildError::Cycle { id, circle })
            }
        }
    }

    /// Takes changes over; nothing can fail any more.
    pub(crate) fn take_over(&mut self, changes: Changes) {
        let mut hashes: HashMap<EntityId, Fingerprint> = HashMap::new();
        for (id, Change { definition, record, part, .. }) in changes {
            let entity = &mut self.entities[self.index[&id]];
            if definition != entity.definition {
                hashes.insert(id, definition.fingerprint());
                // it was the original of a definition that is no more
                entity.original = None;
            }
            entity.definition = definition;
            entity.part = part;
            entity.record = record;
            entity.prepared = OnceLock::new();
        }
        // what was checked against a definition that is no more does not stand any longer
        for record in self.entities.iter_mut().filter_map(|entity| entity.record.as_mut()) {
            for edge in &mut record.relationships {
                if let Some(hash) = hashes.get(&edge.target) {
                    edge.checked.take_if(|checked| checked.target != *hash);
                }
            }
        }
        self.overview = OnceLock::new();
    }
}
