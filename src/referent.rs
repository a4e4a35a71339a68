//! What an id stands for, where another part of the model names it.

use std::fmt;

use perpend_kernel::{Definition, EntityId};

use crate::entity::Entity;
use crate::model::Model;

/// What an id stands for in a model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Referent {
    /// Nothing: the model has no such entity.
    Missing,
    /// A curve.
    Curve,
    /// A surface that is not trimmed.
    Surface,
    /// A trimmed face.
    Trimmed,
    /// A body.
    Body,
}

impl fmt::Display for Referent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Missing => "which the model does not have",
            Self::Curve => "which is a curve",
            Self::Surface => "which is a surface",
            Self::Trimmed => "which is trimmed itself",
            Self::Body => "which is a body",
        })
    }
}

impl Model {
    /// What an id stands for.
    #[must_use]
    pub fn referent(&self, id: EntityId) -> Referent {
        match self.entity(id) {
            Some(entity) => Referent::of(entity),
            None if self.body(id).is_some() => Referent::Body,
            None => Referent::Missing,
        }
    }
}

impl Referent {
    pub(crate) fn of(entity: &Entity) -> Self {
        match entity.definition.as_ref() {
            Definition::NurbsCurve(_) => Self::Curve,
            Definition::NurbsSurface(_) if entity.part.is_some() => Self::Trimmed,
            Definition::NurbsSurface(_) => Self::Surface,
        }
    }
}
