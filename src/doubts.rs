//! What is stated of an entity's making and does not hold.

use perpend_kernel::EntityId;
use perpend_knowledge::{Deviation, Record, default_tolerance, deviation};

use crate::model::Model;

/// A statement of how an entity was made that does not give the entity.
#[derive(Debug, Clone, PartialEq)]
pub struct Doubt {
    /// The part of the record: `intent` or `relationships`.
    pub part: &'static str,
    /// How far the entity's definition is from what the part gives.
    pub drift: Deviation,
}

impl Model {
    /// The parts of an entity's record that state how it was made and give another shape: the definition was replaced by hand since, or the
    /// statement is false. Parts that only an application can run are not judged. Nothing is changed.
    #[must_use]
    pub fn doubts(&self, id: EntityId) -> Vec<Doubt> {
        let Some(entity) = self.entity(id) else { return Vec::new() };
        let Some(record) = entity.record() else { return Vec::new() };
        let intent = Record { intent: record.intent.clone(), ..Record::default() };
        let edges = Record { relationships: record.relationships.clone(), ..Record::default() };
        let tolerance = default_tolerance(&entity.definition);
        let judge = |part: &'static str, record: &Record| {
            let making = record.making().filter(|making| !making.is_by_data())?;
            let made = making.run(self).ok()?.definition;
            let drift = deviation(&made, &entity.definition);
            (drift.proven > tolerance).then_some(Doubt { part, drift })
        };
        [judge("intent", &intent), judge("relationships", &edges)].into_iter().flatten().collect()
    }
}
