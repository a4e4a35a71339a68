//! Bodies: faces grouped in shells.

use std::collections::HashSet;
use std::sync::OnceLock;

use perpend_kernel::EntityId;
use serde::{Deserialize, Serialize};

use crate::edit::EditError;
use crate::model::Model;
use crate::referent::Referent;

/// A body: faces of a model, grouped in shells.
///
/// Its id is of the same kind as those of entities, and no entity has it. A body has no parameters: it is asked by
/// [`Model::nearest_of`] and [`Model::signed_distance`].
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    pub(crate) id: EntityId,
    pub(crate) name: String,
    pub(crate) shells: Vec<Shell>,
    pub(crate) colour: Option<[f64; 3]>,
}

/// Faces that hang together.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shell {
    /// Surfaces and trimmed faces of the model.
    pub faces: Vec<EntityId>,
    /// Whether they enclose a volume: no edge is left open beyond the faces' tolerances. A solid has one such shell around it, and one
    /// around each void.
    pub closed: bool,
}

/// Why a body was refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum InvalidBody {
    /// It has no shells.
    #[error("shells is empty; a body has at least one: give its faces, or remove the body")]
    NoShells,
    /// A shell has no faces.
    #[error("shells[{shell}].faces is empty; a shell has at least one face: remove the shell")]
    NoFaces {
        /// Index of the shell.
        shell: usize,
    },
    /// A face is no surface of the model.
    #[error("shells[{shell}].faces[{face}] is {id}, {is}: name a surface or a trimmed face")]
    Face {
        /// Index of the shell.
        shell: usize,
        /// Index of the face in it.
        face: usize,
        /// What is named.
        id: EntityId,
        /// What that is.
        is: Referent,
    },
    /// A face is named twice.
    #[error("shells[{shell}].faces[{face}] is {id}, which the body has already: name each face once")]
    Repeated {
        /// Index of the shell.
        shell: usize,
        /// Index of the face in it.
        face: usize,
        /// The face.
        id: EntityId,
    },
}

impl Body {
    /// The id by which the model's queries call it.
    #[must_use]
    pub fn id(&self) -> EntityId {
        self.id
    }

    /// The name; it need not be unique.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its shells.
    #[must_use]
    pub fn shells(&self) -> &[Shell] {
        &self.shells
    }

    /// Its colour, red, green and blue from 0 to 1.
    #[must_use]
    pub fn colour(&self) -> Option<[f64; 3]> {
        self.colour
    }

    /// All faces, shell by shell.
    pub fn faces(&self) -> impl Iterator<Item = EntityId> + '_ {
        self.shells.iter().flat_map(|shell| shell.faces.iter().copied())
    }

    /// Whether every shell is closed, so that the body has an inside.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.shells.iter().all(|shell| shell.closed)
    }
}

/// Checks the shells of a body.
pub(crate) fn check(shells: &[Shell], referent: impl Fn(EntityId) -> Referent) -> Result<(), InvalidBody> {
    if shells.is_empty() {
        return Err(InvalidBody::NoShells);
    }
    let mut met: HashSet<EntityId> = HashSet::new();
    for (shell, one) in shells.iter().enumerate() {
        if one.faces.is_empty() {
            return Err(InvalidBody::NoFaces { shell });
        }
        for (face, id) in one.faces.iter().copied().enumerate() {
            let is = referent(id);
            if !matches!(is, Referent::Surface | Referent::Trimmed) {
                return Err(InvalidBody::Face { shell, face, id, is });
            }
            if !met.insert(id) {
                return Err(InvalidBody::Repeated { shell, face, id });
            }
        }
    }
    Ok(())
}

/// Whether a colour is one: three numbers from 0 to 1.
pub(crate) fn is_colour(colour: [f64; 3]) -> bool {
    colour.iter().all(|part| (0.0..=1.0).contains(part))
}

impl Model {
    /// Adds a body as the last one and returns its id.
    ///
    /// The outward normal of a face points away from the material: `S_u × S_v`, or against it where the face is
    /// [reversed](perpend_kernel::Trimming::reversed).
    ///
    /// # Errors
    ///
    /// No shells, a shell without faces, a face that is no surface of the model or is named twice.
    ///
    /// # Panics
    ///
    /// After 2⁶⁴ - 1 ids.
    pub fn insert_body(&mut self, name: &str, shells: Vec<Shell>) -> Result<EntityId, InvalidBody> {
        check(&shells, |id| self.referent(id))?;
        let id = self.give_id();
        self.body_index.insert(id, self.bodies.len());
        self.bodies.push(Body { id, name: name.to_owned(), shells, colour: None });
        self.overview = OnceLock::new();
        Ok(id)
    }

    /// Removes a body and returns it; its faces stay. Its id is not given again.
    ///
    /// # Errors
    ///
    /// An id that no body has.
    pub fn remove_body(&mut self, id: EntityId) -> Result<Body, EditError> {
        let at = self.body_index.get(&id).copied().ok_or(EditError::UnknownBody { id })?;
        let body = self.bodies.remove(at);
        self.body_index = self.bodies.iter().enumerate().map(|(at, body)| (body.id, at)).collect();
        self.overview = OnceLock::new();
        Ok(body)
    }

    /// The body with this id.
    #[must_use]
    pub fn body(&self, id: EntityId) -> Option<&Body> {
        self.body_index.get(&id).map(|at| &self.bodies[*at])
    }

    /// All bodies, in the order of the file; a new one is the last.
    #[must_use]
    pub fn bodies(&self) -> &[Body] {
        &self.bodies
    }

    /// Gives an entity or a body a colour, red, green and blue from 0 to 1, or takes it away. No revision rises.
    ///
    /// # Errors
    ///
    /// An unknown id; a number that is not between 0 and 1.
    pub fn set_colour(&mut self, id: EntityId, colour: Option<[f64; 3]>) -> Result<(), EditError> {
        if let Some(colour) = colour.filter(|colour| !is_colour(*colour)) {
            return Err(EditError::Colour { id, colour });
        }
        match self.body_index.get(&id).copied() {
            Some(at) => self.bodies[at].colour = colour,
            None => {
                let at = self.position(id)?;
                self.entities[at].colour = colour;
            }
        }
        Ok(())
    }
}
