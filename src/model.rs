//! A model: entities, called by id.

use std::collections::HashMap;
use std::sync::OnceLock;

use perpend_kernel::{Definition, EntityId};
use perpend_knowledge::Definitions;

use crate::body::Body;
use crate::entity::Entity;
use crate::nearest::Overview;
use crate::units::Units;

/// A set of entities, called by id.
///
/// Queries take `&self` and may run on many threads at once; edits take `&mut self`. An id is never given twice in a
/// model's life, also not across files: the file keeps the next one.
#[derive(Debug, Clone)]
pub struct Model {
    pub(crate) units: Units,
    /// The next id to give; above every id of the model.
    pub(crate) next_id: u64,
    /// In the order of the file.
    pub(crate) entities: Vec<Entity>,
    /// Where in `entities` an id stands.
    pub(crate) index: HashMap<EntityId, usize>,
    /// In the order of the file.
    pub(crate) bodies: Vec<Body>,
    /// Where in `bodies` an id stands.
    pub(crate) body_index: HashMap<EntityId, usize>,
    /// What queries to the whole model need, built on first use.
    pub(crate) overview: OnceLock<Overview>,
}

impl Model {
    /// An empty model in millimetres. Its first entity gets the id 1.
    #[must_use]
    pub fn new() -> Self {
        Self::from_parts(Units::default(), 1, Vec::new(), Vec::new())
    }

    /// A model with these entities and bodies, whose ids differ and lie below `next_id`.
    pub(crate) fn from_parts(units: Units, next_id: u64, entities: Vec<Entity>, bodies: Vec<Body>) -> Self {
        let index = entities.iter().enumerate().map(|(at, entity)| (entity.id, at)).collect();
        let body_index = bodies.iter().enumerate().map(|(at, body)| (body.id, at)).collect();
        Self { units, next_id, entities, index, bodies, body_index, overview: OnceLock::new() }
    }

    /// The unit of all lengths.
    #[must_use]
    pub fn units(&self) -> Units {
        self.units
    }

    /// States the unit of all lengths; nothing is converted.
    pub fn set_units(&mut self, units: Units) {
        self.units = units;
    }

    /// The id that the next entity or body gets.
    #[must_use]
    pub fn next_id(&self) -> EntityId {
        EntityId::new(self.next_id)
    }

    /// How many entities there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.entities.len()
    }

    /// Whether there are no entities, and so no bodies either.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.entities.is_empty()
    }

    /// The entity with this id.
    #[must_use]
    pub fn entity(&self, id: EntityId) -> Option<&Entity> {
        self.index.get(&id).map(|at| &self.entities[*at])
    }

    /// All entities of this name, in the order of the file.
    pub fn named<'a>(&'a self, name: &'a str) -> impl Iterator<Item = &'a Entity> + 'a {
        self.entities.iter().filter(move |entity| entity.name == name)
    }

    /// All entities, in the order of the file; a new one is the last.
    #[must_use]
    pub fn entities(&self) -> &[Entity] {
        &self.entities
    }

    /// The size of the model: the diagonal of the box of all control points. 0 where it is empty.
    #[must_use]
    pub fn size(&self) -> f64 {
        self.overview().bounds.diagonal()
    }
}

impl Default for Model {
    fn default() -> Self {
        Self::new()
    }
}

/// Two models are equal where their files are.
impl PartialEq for Model {
    fn eq(&self, other: &Self) -> bool {
        (self.units, self.next_id, &self.entities, &self.bodies)
            == (other.units, other.next_id, &other.entities, &other.bodies)
    }
}

impl Definitions for Model {
    fn get(&self, id: EntityId) -> Option<&Definition> {
        self.entity(id).map(|entity| entity.definition.as_ref())
    }
}
