//! Taking curves apart where they have cusps and loops.

use perpend_kernel::{Definition, Direction, EntityId, NurbsCurve};
use perpend_knowledge::{Intent, Operation, Origin, cuts, cuts_at, parted};

use crate::edit::EditError;
use crate::entity::Entity;
use crate::model::Model;

impl Model {
    /// Adds the parts of a curve between its cusps and loops as new entities, which have none (Piegl et al. 2008, §2), and gives
    /// their ids, in order; none where there is nothing to cut. See [`knowledge::cuts`](crate::knowledge::cuts).
    ///
    /// The curve itself stays as it is. Each part keeps its parameters, and says in its record which part of what it is.
    ///
    /// # Errors
    ///
    /// An unknown id; a surface; a part that would be a single point; no ids left for the parts. The model is as it was then.
    pub fn decompose(&mut self, id: EntityId) -> Result<Vec<EntityId>, EditError> {
        let entity = &self.entities[self.position(id)?];
        let Definition::NurbsCurve(curve) = entity.definition.as_ref() else { return Err(EditError::NotACurve { id }) };
        let places = places(entity, curve);
        if places.is_empty() {
            return Ok(Vec::new());
        }
        let parts = parted(curve, &places).map_err(|source| EditError::Decompose { id, source })?;
        let (name, count) = (entity.name.clone(), parts.len());
        if u64::MAX - self.next_id < count as u64 {
            return Err(EditError::NoIds { id, count, last: self.next_id - 1 });
        }
        let mut ids = Vec::with_capacity(count);
        for (k, part) in parts.into_iter().enumerate() {
            let range = part.domain();
            let name = format!("{name} {} of {count}", k + 1);
            // a part of a valid curve is valid, so that nothing is left half done
            let part = self.insert(&name, part).map_err(|source| EditError::Definition { id, source })?;
            self.say_part(part, id, range);
            ids.push(part);
        }
        Ok(ids)
    }

    /// Notes of a new entity that it is a part of another one.
    fn say_part(&mut self, part: EntityId, of: EntityId, range: (f64, f64)) {
        let entity = &mut self.entities[self.index[&part]];
        let split = Intent {
            decision: "a part without cusps and loops".to_owned(),
            of: Some(entity.definition.fingerprint()),
            ..Intent::new(Operation::Split { direction: Direction::U, range }, &[of])
        };
        let record = entity.record.get_or_insert_default();
        let operation = split.operation.name().to_owned();
        record.classification.get_or_insert_default().origin = Some(Origin::Derived { operation, from: vec![of] });
        record.relationships.extend(split.relationships());
        record.intent.push(split);
    }
}

/// Where a curve is to be cut: by its record, where that knows its irregularities, else found now.
fn places(entity: &Entity, curve: &NurbsCurve) -> Vec<f64> {
    let of = entity.definition.fingerprint();
    let known = entity.record.as_ref().and_then(|record| record.representation.as_ref()?.irregularities.as_deref());
    match known {
        Some(items) if items.iter().all(|item| !item.is_stale(of)) && !items.is_empty() => cuts_at(curve, items),
        _ => cuts(curve),
    }
}
