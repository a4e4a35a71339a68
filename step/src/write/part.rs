//! What of a model is written, and how it hangs together.

use perpend::kernel::Trimming;
use perpend::{Definition, Entity, EntityId, Model, NurbsSurface};

/// A face: a surface, and what part of it counts.
#[derive(Debug, Clone, Copy)]
pub(super) struct FaceSource<'a> {
    pub(super) entity: &'a Entity,
    pub(super) surface: &'a NurbsSurface,
    pub(super) trimming: Option<&'a Trimming>,
    pub(super) colour: Option<[f64; 3]>,
}

impl<'a> FaceSource<'a> {
    fn new(entity: &'a Entity) -> Option<Self> {
        match &**entity.definition() {
            Definition::NurbsSurface(surface) => {
                let trimming = entity.trimming().map(AsRef::as_ref);
                Some(Self { entity, surface, trimming, colour: entity.colour() })
            }
            Definition::NurbsCurve(_) => None,
        }
    }
}

/// Faces that hang together.
#[derive(Debug)]
pub(super) struct ShellSource<'a> {
    pub(super) faces: Vec<FaceSource<'a>>,
    pub(super) closed: bool,
}

/// A body.
#[derive(Debug)]
pub(super) struct BodySource<'a> {
    pub(super) name: &'a str,
    pub(super) shells: Vec<ShellSource<'a>>,
    pub(super) colour: Option<[f64; 3]>,
}

/// A model as it is written: what is part of something else stands there alone.
#[derive(Debug, Default)]
pub(super) struct Part<'a> {
    pub(super) bodies: Vec<BodySource<'a>>,
    pub(super) faces: Vec<FaceSource<'a>>,
    pub(super) curves: Vec<&'a Entity>,
}

impl<'a> Part<'a> {
    /// All of a model, or one entity or body of it.
    pub(super) fn new(model: &'a Model, only: Option<EntityId>) -> Self {
        let mut part = Self::default();
        let mut inside = model.parts_of_faces();
        for body in model.bodies() {
            inside.extend(body.faces());
            if only.is_some_and(|id| id != body.id()) {
                continue;
            }
            let faces = |ids: &[EntityId]| ids.iter().filter_map(|id| FaceSource::new(model.entity(*id)?)).collect();
            let shells =
                body.shells().iter().map(|shell| ShellSource { faces: faces(&shell.faces), closed: shell.closed });
            part.bodies.push(BodySource { name: body.name(), shells: shells.collect(), colour: body.colour() });
        }
        for entity in model.entities() {
            let counts = only.map_or_else(|| !inside.contains(&entity.id()), |id| id == entity.id());
            if !counts {
                continue;
            }
            match FaceSource::new(entity) {
                Some(face) => part.faces.push(face),
                None => part.curves.push(entity),
            }
        }
        part
    }
}
