//! Trimmed faces: what loops of p-curves leave of a surface.

use std::sync::{Arc, OnceLock};

use perpend_kernel::{Definition, EntityId, InvalidTrim, NurbsSurface, TrimEntry, Trimming, TrimmingData};
use perpend_knowledge::{Basis, Cleaning, Item, Record};

use crate::edit::EditError;
use crate::entity::{Entity, Part};
use crate::model::Model;
use crate::rebuild::Staged;
use crate::referent::Referent;

/// The surface that a face trims: its carrier.
#[derive(Debug, Clone, PartialEq)]
pub enum Carrier {
    /// The face's own.
    Own(NurbsSurface),
    /// Another entity of the model, which the face follows: its definition is that entity's, whatever becomes of that.
    Ref(EntityId),
}

/// A face that is to enter a model: a carrier, and what part of it counts.
#[derive(Debug, Clone, PartialEq)]
pub struct TrimmedSurface {
    /// The surface.
    pub surface: Carrier,
    /// What part of it counts.
    pub trimming: TrimmingData,
}

/// Why a trimmed face was refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum InvalidTrimmedSurface {
    /// Its trim breaks a rule.
    #[error(transparent)]
    Trim(#[from] InvalidTrim),
    /// What it trims is no surface, or trimmed itself.
    #[error("surface is Ref({id}), {is}: name a surface that is not trimmed, or write it as Own(NurbsSurface(…))")]
    Carrier {
        /// What is named.
        id: EntityId,
        /// What that is.
        is: Referent,
    },
    /// What it names as the curve in space of a p-curve is none.
    #[error("loops[{of}].curves[{curve}].edge is {id}, {is}: name a curve, or leave the edge out")]
    Edge {
        /// Index of the loop.
        of: usize,
        /// Index of the p-curve in it.
        curve: usize,
        /// What is named.
        id: EntityId,
        /// What that is.
        is: Referent,
    },
}

/// Validates a trim against its surface, and that what it names are curves.
pub(crate) fn enter(
    data: TrimmingData,
    surface: &NurbsSurface,
    referent: impl Fn(EntityId) -> Referent,
) -> Result<(Arc<Trimming>, TrimEntry), InvalidTrimmedSurface> {
    let (trimming, entry) = Trimming::enter(data, surface)?;
    for (of, curve, id) in edges(&trimming) {
        let is = referent(id);
        if is != Referent::Curve {
            return Err(InvalidTrimmedSurface::Edge { of, curve, id, is });
        }
    }
    Ok((Arc::new(trimming), entry))
}

/// The curves in space that a trim names: of which loop and p-curve, and which.
pub(crate) fn edges(trimming: &Trimming) -> impl Iterator<Item = (usize, usize, EntityId)> + '_ {
    let loops = trimming.loops().iter().enumerate();
    loops.flat_map(|(of, one)| {
        let curves = one.curves.iter().enumerate();
        curves.filter_map(move |(curve, trim)| trim.edge.map(|id| (of, curve, id)))
    })
}

/// Adds to a record what the entry of a trim tells: that p-curves were clamped.
pub(crate) fn note(entry: &TrimEntry, definition: &Definition, record: &mut Option<Record>) {
    let [u, v] = entry.clamped;
    if u == 0.0 && v == 0.0 {
        return;
    }
    let value = Cleaning::TrimClamped { share: (u, v) };
    let item = Item { value, basis: Basis::Defined, tolerance: 0.0, of: definition.fingerprint() };
    let representation = record.get_or_insert_default().representation.get_or_insert_default();
    let cleaning = representation.cleaning.get_or_insert_default();
    if !cleaning.contains(&item) {
        cleaning.push(item);
    }
}

impl Model {
    /// Adds a trimmed face as the last entity and returns its id.
    ///
    /// Its definition is its carrier, so that all that is known and proved of surfaces holds of it; queries answer for the part that
    /// its loops bound. P-curves that leave the carrier's domain by a rounding of files are clamped, and the record says so.
    ///
    /// ```
    /// use perpend::{Carrier, DVec3, Frame, Model, Plane, TrimCurveData, TrimLoopData, TrimmedSurface, TrimmingData};
    /// use perpend::glam::DVec2;
    ///
    /// let mut model = Model::new();
    /// let plate = Plane::new(Frame::WORLD, (0.0, 4.0), (0.0, 4.0))?.to_nurbs()?;
    /// let corners = [(0.0, 0.0), (0.5, 0.0), (0.0, 0.5)].map(|(u, v)| DVec2::new(u, v));
    /// let side = |from: DVec2, to: DVec2| TrimCurveData {
    ///     degree: 1,
    ///     knots: vec![0.0, 0.0, 1.0, 1.0],
    ///     points: vec![from, to],
    ///     weights: None,
    ///     edge: None,
    /// };
    /// let curves = (0..3).map(|k| side(corners[k], corners[(k + 1) % 3])).collect();
    /// let trimming =
    ///     TrimmingData { reversed: false, tolerance: 1e-6, loops: vec![TrimLoopData { outer: true, curves }] };
    /// let face = model.insert_trimmed("gusset", TrimmedSurface { surface: Carrier::Own(plate), trimming })?;
    /// // the plate goes on under the point, the gusset does not
    /// assert!((model.project(face, DVec3::new(3.0, 0.0, 0.0))?.distance - 1.0).abs() < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// The first rule that the trim breaks; a carrier that the model does not have, is no surface or trimmed itself; an edge that is no
    /// curve of the model.
    ///
    /// # Panics
    ///
    /// After 2⁶⁴ - 1 ids.
    pub fn insert_trimmed(&mut self, name: &str, face: TrimmedSurface) -> Result<EntityId, InvalidTrimmedSurface> {
        let (definition, part, entry) = self.enter_trimmed(face)?;
        let mut record = None;
        note(&entry, &definition, &mut record);
        let id = self.give_id();
        let entity = Entity {
            id,
            name: name.to_owned(),
            definition,
            part: Some(part),
            colour: None,
            record,
            original: None,
            prepared: OnceLock::new(),
        };
        self.push(entity);
        Ok(id)
    }

    /// Gives an entity a trimmed face for its definition and raises its revision; else as [`replace`](Self::replace).
    ///
    /// # Errors
    ///
    /// An unknown id; what [`insert_trimmed`](Self::insert_trimmed) refuses; a carrier that is made of this entity; an entity that
    /// uses this one otherwise than a trimmed face can be used.
    pub fn replace_trimmed(&mut self, id: EntityId, face: TrimmedSurface) -> Result<(), EditError> {
        self.position(id)?;
        if let Carrier::Ref(carrier) = face.surface {
            if carrier == id {
                let source = InvalidTrimmedSurface::Carrier { id, is: Referent::Trimmed };
                return Err(EditError::Trimmed { id, source: source.into() });
            }
            self.check_inputs(id, std::iter::once(&carrier)).map_err(|error| EditError::Rebuild(Box::new(error)))?;
        }
        let (definition, part, entry) =
            self.enter_trimmed(face).map_err(|source| EditError::Trimmed { id, source: source.into() })?;
        let mut record = self.entities[self.index[&id]].record.clone().unwrap_or_default();
        record.revision = record.revision.saturating_add(1);
        record.forget_stale(definition.fingerprint());
        let mut record = Some(record);
        note(&entry, &definition, &mut record);
        let is_same = definition == self.entities[self.index[&id]].definition;
        let mut staged = Staged::new(self);
        staged.set_with(id, definition, record, Some(part));
        if !is_same {
            staged.spread(id).map_err(|error| EditError::Rebuild(Box::new(error)))?;
        }
        let changes = staged.changes(id).map_err(|error| EditError::Rebuild(Box::new(error)))?;
        self.take_over(changes);
        Ok(())
    }

    fn enter_trimmed(&self, face: TrimmedSurface) -> Result<(Arc<Definition>, Part, TrimEntry), InvalidTrimmedSurface> {
        let (definition, carrier) = match face.surface {
            Carrier::Own(surface) => (Arc::new(Definition::from(surface)), None),
            Carrier::Ref(id) => match self.referent(id) {
                Referent::Surface => (Arc::clone(&self.entities[self.index[&id]].definition), Some(id)),
                is => return Err(InvalidTrimmedSurface::Carrier { id, is }),
            },
        };
        let Definition::NurbsSurface(surface) = definition.as_ref() else { unreachable!("a carrier is a surface") };
        let (trimming, entry) = enter(face.trimming, surface, |id| self.referent(id))?;
        Ok((definition, Part { trimming, carrier }, entry))
    }
}
