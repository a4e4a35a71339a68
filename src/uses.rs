//! What uses an entity as a part of itself: faces their carriers and edges, bodies their faces.

use std::collections::HashSet;

use perpend_kernel::EntityId;

use crate::entity::Entity;
use crate::model::Model;
use crate::referent::Referent;
use crate::trimmed::edges;

/// That an entity is a part of a trimmed face or a body.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Use {
    /// The face or the body.
    pub(crate) by: EntityId,
    /// As what it uses the entity.
    role: Role,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Role {
    Carrier,
    Edge { of: usize, curve: usize },
    Face { shell: usize, face: usize },
}

impl Use {
    /// The field that names the entity.
    pub(crate) fn field(&self) -> String {
        match self.role {
            Role::Carrier => "definition.surface".to_owned(),
            Role::Edge { of, curve } => format!("definition.loops[{of}].curves[{curve}].edge"),
            Role::Face { shell, face } => format!("definition.shells[{shell}].faces[{face}]"),
        }
    }

    /// Whether it can use an entity that is this.
    pub(crate) fn admits(&self, is: Referent) -> bool {
        match self.role {
            Role::Carrier => is == Referent::Surface,
            Role::Edge { .. } => is == Referent::Curve,
            Role::Face { .. } => matches!(is, Referent::Surface | Referent::Trimmed),
        }
    }
}

impl Model {
    /// The entities that trimmed faces name as parts of themselves, as carriers or as edges: the faces stand for them.
    #[must_use]
    pub fn parts_of_faces(&self) -> HashSet<EntityId> {
        let carriers = self.entities.iter().filter_map(Entity::carrier);
        let edges = self.entities.iter().filter_map(Entity::trimming).flat_map(|trimming| trimming.edges());
        carriers.chain(edges).collect()
    }

    /// All uses of an entity as a part.
    pub(crate) fn uses(&self, id: EntityId) -> impl Iterator<Item = Use> + '_ {
        let of_faces = self.entities.iter().filter(move |entity| entity.id != id).flat_map(move |entity| {
            let carrier = entity.carrier().filter(|carrier| *carrier == id).map(|_| Role::Carrier);
            let named = entity.trimming().into_iter().flat_map(|trimming| edges(trimming));
            let edges = named.filter(move |(.., edge)| *edge == id).map(|(of, curve, _)| Role::Edge { of, curve });
            carrier.into_iter().chain(edges).map(move |role| Use { by: entity.id, role })
        });
        let of_bodies = self.bodies.iter().flat_map(move |body| {
            body.shells.iter().enumerate().flat_map(move |(shell, one)| {
                let faces = one.faces.iter().enumerate().filter(move |(_, face)| **face == id);
                faces.map(move |(face, _)| Use { by: body.id, role: Role::Face { shell, face } })
            })
        });
        of_faces.chain(of_bodies)
    }
}
