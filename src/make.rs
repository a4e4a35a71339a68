//! Entities made by operations.

use perpend_kernel::EntityId;
use perpend_knowledge::{BuildError, Intent, Making, MakingError, Operation, Record};

use crate::entity::Entity;
use crate::model::Model;
use crate::rebuild::remade;

/// Why an entity was not made. The model is as it was.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MakeError {
    /// An input does not exist.
    #[error("the model has no entity {id} to make another of")]
    UnknownInput {
        /// The input.
        id: EntityId,
    },
    /// The operation makes nothing.
    #[error(transparent)]
    Build(Box<BuildError>),
}

impl Model {
    /// Makes an entity by an operation of other entities, adds it as the last one and returns its id.
    ///
    /// Its record says how it was made: the operation with all its parameters and inputs (the intent), what those are to it, with
    /// the same parameters (the relationships), whether it was designed or derived (the origin), and its class where the
    /// operation determines that. So it can be made again ([`replay`](Self::replay)), and is when one of its inputs changes
    /// ([`edit`](Self::edit), [`replace`](Self::replace)).
    ///
    /// ```
    /// use perpend::{Circle, DVec3, Frame, Model, Operation};
    ///
    /// let mut model = Model::new();
    /// let rim = model.make("rim", Circle::whole(Frame::WORLD, 30.0)?, &[])?;
    /// let wall = model.make("wall", Operation::Extrude { vector: DVec3::new(0.0, 0.0, 80.0) }, &[rim])?;
    ///
    /// model.edit(rim, Circle::whole(Frame::WORLD, 35.0)?)?;
    ///
    /// let foot = model.project(wall, DVec3::new(50.0, 0.0, 40.0))?;
    /// assert!((foot.distance - 15.0).abs() < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// An input that does not exist; an operation that makes nothing of its inputs, or that perpend does not run.
    ///
    /// # Panics
    ///
    /// After 2⁶⁴ - 1 ids.
    pub fn make(
        &mut self,
        name: &str,
        operation: impl Into<Operation>,
        inputs: &[EntityId],
    ) -> Result<EntityId, MakeError> {
        let making = Making { steps: vec![Intent::new(operation, inputs)].into(), first: None };
        let built = making.run(self).map_err(|error| match error {
            MakingError::UnknownEntity { id } => MakeError::UnknownInput { id },
            MakingError::Build(error) => MakeError::Build(Box::new(error)),
            other => unreachable!("there is a step: {other}"),
        })?;
        let record = Record { revision: 0, ..remade(&Record::default(), &making, &built, self) };
        let id = self.give_id();
        self.push(Entity::new(id, name.to_owned(), built.definition, Some(record)));
        Ok(id)
    }
}
