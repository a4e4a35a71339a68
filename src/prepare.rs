//! Preparation of entities: cleaning, and purging with the application's consent.

use std::sync::Arc;

use perpend_kernel::{Definition, EntityId};
use perpend_knowledge::{Basis, Cleaning, Item, PreparedDefinition, Record, clean, displacement, prove, purge};

use crate::edit::EditError;
use crate::model::Model;
use crate::original::{Original, purges};
use crate::rebuild::{Staged, remade};
use crate::standing::{agrees, notes};

/// The consent of an application to changing an entity, and by how much.
///
/// There is no default: purging changes what an entity is, and only who answers for that can say how far it may.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Consent {
    tolerance: f64,
}

impl Consent {
    /// Consent to points that move by at most `tolerance` from where they were in the original, a length in the model's unit.
    #[must_use]
    pub fn within(tolerance: f64) -> Self {
        Self { tolerance }
    }

    /// How far points may move.
    #[must_use]
    pub fn tolerance(self) -> f64 {
        self.tolerance
    }
}

/// What cleaning or purging did to an entity.
#[derive(Debug, Clone, PartialEq)]
pub struct Preparation {
    /// The steps, in order; none where the entity is as it was.
    pub steps: Vec<Cleaning>,
    /// No point moved farther than this: proven, rounding included. Of a purge, from the original that is kept.
    pub deviation: f64,
}

impl Model {
    /// Removes what an entity's definition does not need: knots and control points, degrees, equal weights. The shape and its
    /// parameters stay, to a rounding that is proven (see [`knowledge::clean`](crate::knowledge::clean)).
    ///
    /// Where there is nothing to remove, nothing changes. Else the revision rises, and the record says what was done; a
    /// class that is proved of the new definition too stays, and what else was computed from the old one is forgotten. What is
    /// made of the entity is made anew, as by [`replace`](Self::replace).
    ///
    /// # Errors
    ///
    /// An unknown id; a face that trims another entity, which is cleaned in its place; an entity that is made of this one and cannot
    /// be built, or a trim that does not hold of it any more.
    pub fn clean(&mut self, id: EntityId) -> Result<Preparation, EditError> {
        let entity = &self.entities[self.position(id)?];
        if let Some(carrier) = entity.carrier() {
            return Err(EditError::FollowsCarrier { id, carrier });
        }
        let PreparedDefinition { definition, steps, deviation: moved } = clean(&entity.definition);
        let unchanged = Preparation { steps: Vec::new(), deviation: 0.0 };
        if steps.is_empty() {
            return Ok(unchanged);
        }
        let mut record = entity.record.clone();
        let original = entity.original.clone();
        if let Some(original) = &original {
            // what was consented to holds from the original on
            let Some(total) = displacement(&original.definition, &definition) else { return Ok(unchanged) };
            let mut purged: Vec<_> = purges(record.as_mut(), &entity.definition).collect();
            if purged.iter().any(|item| total > item.tolerance) {
                return Ok(unchanged);
            }
            purged.iter_mut().for_each(|item| item.basis = Basis::Proved { gap: total });
        }
        let history = history(record.as_ref(), &entity.definition);
        let record = told(record, &entity.definition, &definition, history, &steps, (moved, moved));
        self.become_prepared(id, Arc::new(definition), record, original)?;
        Ok(Preparation { steps, deviation: moved })
    }

    /// Removes knots and control points that an entity hardly needs, near knots first, as far as the consent goes; what
    /// [`clean`](Self::clean) would remove goes too.
    ///
    /// The original is kept, with what was known of it, until [`drop_original`](Self::drop_original);
    /// [`restore`](Self::restore) takes it back. The deviation is proven from the original, also where an entity is purged again: what
    /// is purged is the original always, so that deviations do not add up. The parameters stay, so that a trim bounds what it bounded,
    /// moved by no more than that. Where nothing can go, the entity is as the original. What
    /// is made of the entity is made anew.
    ///
    /// # Errors
    ///
    /// An unknown id; a tolerance that is no finite length above 0; a face that trims another entity, which is purged in its place; an
    /// entity that is made of this one and cannot be built, or a trim that does not hold of it any more.
    pub fn purge(&mut self, id: EntityId, consent: Consent) -> Result<Preparation, EditError> {
        let entity = &self.entities[self.position(id)?];
        if let Some(carrier) = entity.carrier() {
            return Err(EditError::FollowsCarrier { id, carrier });
        }
        let tolerance = consent.tolerance;
        let original =
            entity.original.clone().unwrap_or_else(|| Original::of(&entity.definition, entity.record.as_ref()));
        let PreparedDefinition { definition, steps, deviation } =
            purge(&original.definition, tolerance).map_err(|source| EditError::Tolerance { id, source })?;
        if steps.is_empty() {
            if entity.original.is_some() {
                self.restore(id)?;
            }
        } else if *entity.definition != definition {
            let history = history(original.record.as_ref(), &original.definition);
            let bounds = (deviation, tolerance);
            let record = told(entity.record.clone(), &entity.definition, &definition, history, &steps, bounds);
            self.become_prepared(id, Arc::new(definition), record, Some(original))?;
        }
        Ok(Preparation { steps, deviation })
    }

    /// Gives an entity that was purged its original again, bit for bit, with what was known of that. The revision rises.
    ///
    /// An entity that an operation had made, and whose inputs have changed since, is made anew instead: a purged entity does not
    /// follow its inputs, and its original is what they gave then.
    ///
    /// # Errors
    ///
    /// An unknown id; no original is kept; an entity that is made of this one and cannot be built.
    pub fn restore(&mut self, id: EntityId) -> Result<(), EditError> {
        let entity = &self.entities[self.position(id)?];
        let original = entity.original.clone().ok_or(EditError::NoOriginal { id })?;
        let mut record = entity.record.clone().unwrap_or_default();
        record.forget_stale(original.definition.fingerprint());
        if let Some(known) = original.record {
            record.representation = known.representation;
            if let Some(kind) = known.classification.and_then(|part| part.kind) {
                record.classification.get_or_insert_default().kind = Some(kind);
            }
        }
        let (definition, record) = match self.made_today(&original.definition, &record) {
            Some(today) => today,
            None => {
                record.revision = record.revision.saturating_add(1);
                (original.definition, record)
            }
        };
        self.become_prepared(id, definition, record, None)
    }

    /// What the steps that had made an original give today, with the record of that; none where that is the original still, or
    /// they had not made it, or cannot be run.
    fn made_today(&self, original: &Definition, record: &Record) -> Option<(Arc<Definition>, Record)> {
        let making = record.making().filter(|making| notes(making, original))?;
        let built = making.run(self).ok()?;
        if agrees(&built.definition, original) {
            return None;
        }
        let record = remade(record, &making, &built, self);
        Some((Arc::new(built.definition), record))
    }

    /// Gives up the original of an entity that was purged: it is now what it is. The revision rises.
    ///
    /// # Errors
    ///
    /// An unknown id; no original is kept.
    pub fn drop_original(&mut self, id: EntityId) -> Result<(), EditError> {
        let at = self.position(id)?;
        self.entities[at].original.take().ok_or(EditError::NoOriginal { id })?;
        self.edited(at);
        Ok(())
    }

    /// Gives an entity a definition that was made of the one it has, or is its original, and makes anew what is made of it.
    fn become_prepared(
        &mut self,
        id: EntityId,
        definition: Arc<Definition>,
        record: Record,
        original: Option<Original>,
    ) -> Result<(), EditError> {
        let mut staged = Staged::new(self);
        staged.set(id, definition, Some(record));
        staged.spread(id).map_err(|error| EditError::Rebuild(Box::new(error)))?;
        let changes = staged.changes(id).map_err(|error| EditError::Rebuild(Box::new(error)))?;
        self.take_over(changes);
        let at = self.position(id)?;
        self.entities[at].original = original;
        Ok(())
    }
}

/// The record of an entity whose definition was prepared: `bounds` are how far points moved and what was allowed.
fn told(
    record: Option<Record>,
    old: &Definition,
    new: &Definition,
    history: Vec<Item<Cleaning>>,
    steps: &[Cleaning],
    (gap, tolerance): (f64, f64),
) -> Record {
    let of = new.fingerprint();
    let mut record = record.unwrap_or_default();
    record.revision = record.revision.saturating_add(1);
    if let Some(part) = &mut record.classification {
        // what it was shown to be it is still, if that can be proved
        part.kind = part.kind.take().filter(|kind| !kind.is_stale(old.fingerprint())).and_then(|kind| {
            let gap = prove(&kind.value, new, kind.tolerance).ok()?;
            Some(Item { basis: Basis::Proved { gap }, of, ..kind })
        });
    }
    record.forget_stale(of);
    let done = steps.iter().map(|step| Item { value: step.clone(), basis: Basis::Proved { gap }, tolerance, of });
    let all = history.into_iter().map(|item| Item { of, ..item }).chain(done).collect();
    record.representation.get_or_insert_default().cleaning = Some(all);
    record
}

/// What was done to a definition so far, as its record tells.
fn history(record: Option<&Record>, definition: &Definition) -> Vec<Item<Cleaning>> {
    let of = definition.fingerprint();
    let items = record.and_then(|record| record.representation.as_ref()).and_then(|part| part.cleaning.as_deref());
    items.unwrap_or_default().iter().filter(|item| item.of == of).cloned().collect()
}
