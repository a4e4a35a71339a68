//! From a model to a STEP file (AP214).

mod edge;
mod face;
mod geometry;
mod part;
mod product;
mod style;
mod text;
mod topology;

use std::io::{self, Write};
use std::sync::Arc;

use glam::DVec3;
use perpend::kernel::Trimming;
use perpend::{Definition, EntityId, Model};

use geometry::{free_curve, known_kind, placement};
use part::{BodySource, FaceSource, Part};
use style::Styles;
use text::{Id, Text, list, string};
use topology::Topology;

/// What is written, and under which name.
#[derive(Debug, Clone, Copy, Default)]
pub struct WriteOptions<'a> {
    /// The name of the product.
    pub name: &'a str,
    /// One entity or body alone; none: all of the model.
    pub only: Option<EntityId>,
}

/// An edge whose curve in space was fitted, and missed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fitted {
    /// The face.
    pub face: EntityId,
    /// How far points of the face's trim are from the curve that was written, measured.
    pub deviation: f64,
}

/// What was written.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Written {
    /// How many bodies.
    pub bodies: usize,
    /// How many faces, those of bodies included.
    pub faces: usize,
    /// How many free curves.
    pub curves: usize,
    /// The edges that were fitted and are farther from their trims than a tenth of the tolerance.
    pub fitted: Vec<Fitted>,
    /// The faces whose loops are points within rounding: they are left out.
    pub empty: Vec<EntityId>,
}

/// Writes a model as a STEP file of AP214, in its own unit; numbers read back bit for bit.
///
/// Planes, cylinders, cones, spheres and tori that are known and proved here within rounding are written as such, and so are lines, circles
/// and ellipses of edges and free curves; everything else as B-splines, as it is defined. A face is bounded by its loops, or by the border of
/// its surface's domain. The curve of an edge is the related entity where that follows the trim, else the exact image of the p-curve
/// (iso-curves, planes), else a cubic that is fitted to it within a tenth of the tolerance. Edges are shared by the faces of a body where
/// they lie on each other within the tolerance, and by other faces where they are one entity. The tolerance is each face's own; the uncertainty
/// that the file states is the largest of them. What is a part of something else, as the edges of faces, is written there alone.
///
/// # Errors
///
/// Those of the writer.
pub fn write(model: &Model, options: WriteOptions<'_>, out: impl Write) -> io::Result<Written> {
    let part = Part::new(model, options.only);
    let finest = finest(model);
    let coarsest = coarsest(&part, finest);
    let edges = |id: EntityId| model.entity(id).map(|entity| Arc::clone(entity.definition()));
    let mut writer = Writer {
        text: Text::new(out),
        styles: Styles::default(),
        edges: &edges,
        finest,
        coarsest,
        written: Written::default(),
    };
    product::header(&mut writer.text, options.name)?;
    let shape = product::product(&mut writer.text, options.name)?;
    let context = product::context(&mut writer.text, model.units(), coarsest)?;
    let origin = placement(&mut writer.text, DVec3::ZERO, DVec3::Z, DVec3::X)?;
    let whole = writer.text.add(format_args!("SHAPE_REPRESENTATION('',({origin}),{context})"))?;
    writer.text.add(format_args!("SHAPE_DEFINITION_REPRESENTATION({shape},{whole})"))?;
    let (mut solids, mut sheets) = (Vec::new(), Vec::new());
    for body in &part.bodies {
        writer.body(body, &mut solids, &mut sheets)?;
    }
    let mut topology = Topology::new(coarsest, false);
    for face in &part.faces {
        let Some(id) = writer.face(&mut topology, face)? else { continue };
        let shell = writer.text.add(format_args!("OPEN_SHELL('',({id}))"))?;
        let name = string(face.entity.name());
        sheets.push(writer.text.add(format_args!("SHELL_BASED_SURFACE_MODEL({name},({shell}))"))?);
    }
    let mut curves = Vec::new();
    for entity in &part.curves {
        if let Definition::NurbsCurve(curve) = &**entity.definition() {
            let id = free_curve(&mut writer.text, curve, &known_kind(entity.record(), entity.definition()))?;
            if let Some(colour) = entity.colour() {
                writer.styles.curve(&mut writer.text, id, colour)?;
            }
            let name = string(entity.name());
            curves.push(writer.text.add(format_args!("GEOMETRIC_CURVE_SET({name},({id}))"))?);
        }
    }
    let kinds = [
        ("ADVANCED_BREP_SHAPE_REPRESENTATION", solids),
        ("MANIFOLD_SURFACE_SHAPE_REPRESENTATION", sheets),
        ("GEOMETRICALLY_BOUNDED_WIREFRAME_SHAPE_REPRESENTATION", curves),
    ];
    for (keyword, items) in kinds.into_iter().filter(|(_, items)| !items.is_empty()) {
        let items = list([origin].into_iter().chain(items), |id| id.to_string());
        let representation = writer.text.add(format_args!("{keyword}('',{items},{context})"))?;
        writer.text.add(format_args!("SHAPE_REPRESENTATION_RELATIONSHIP('','',{whole},{representation})"))?;
    }
    let Writer { mut text, styles, mut written, .. } = writer;
    styles.finish(&mut text, context)?;
    text.line("ENDSEC;")?;
    text.line("END-ISO-10303-21;")?;
    (written.bodies, written.curves) = (part.bodies.len(), part.curves.len());
    Ok(written)
}

/// No tolerance of a face is taken to be smaller: 1e-7 of the model's size.
fn finest(model: &Model) -> f64 {
    (1e-7 * model.size()).max(f64::MIN_POSITIVE)
}

/// The largest tolerance of a face.
fn coarsest(part: &Part<'_>, finest: f64) -> f64 {
    let of_bodies = part.bodies.iter().flat_map(|body| body.shells.iter().flat_map(|shell| &shell.faces));
    of_bodies.chain(&part.faces).filter_map(|face| face.trimming.map(Trimming::tolerance)).fold(finest, f64::max)
}

struct Writer<'a, W> {
    text: Text<W>,
    styles: Styles,
    edges: &'a dyn Fn(EntityId) -> Option<Arc<Definition>>,
    finest: f64,
    coarsest: f64,
    written: Written,
}

impl<W: Write> Writer<'_, W> {
    fn face(&mut self, topology: &mut Topology, source: &FaceSource<'_>) -> io::Result<Option<Id>> {
        let tolerance = source.trimming.map_or(self.finest, |trimming| trimming.tolerance().max(self.finest));
        let Some(id) = face::face(&mut self.text, topology, source, self.edges, tolerance, &mut self.written)? else {
            return Ok(None);
        };
        self.written.faces += 1;
        if let Some(colour) = source.colour {
            self.styles.surface(&mut self.text, id, colour)?;
        }
        Ok(Some(id))
    }

    /// A solid where all shells are closed: the first is the outer one, the others bound voids. Otherwise a model of its surfaces.
    fn body(&mut self, body: &BodySource<'_>, solids: &mut Vec<Id>, sheets: &mut Vec<Id>) -> io::Result<()> {
        let mut topology = Topology::new(self.coarsest, true);
        let mut shells = Vec::new();
        for shell in &body.shells {
            let faces = shell.faces.iter().filter_map(|face| self.face(&mut topology, face).transpose());
            let faces = faces.collect::<io::Result<Vec<Id>>>()?;
            if faces.is_empty() {
                continue;
            }
            let keyword = if shell.closed { "CLOSED_SHELL" } else { "OPEN_SHELL" };
            shells.push(self.text.add(format_args!("{keyword}('',{})", list(faces, |id| id.to_string())))?);
        }
        let name = string(body.name);
        let solid = body.shells.iter().all(|shell| shell.closed);
        let id = match &shells[..] {
            [outer] if solid => self.text.add(format_args!("MANIFOLD_SOLID_BREP({name},{outer})"))?,
            [outer, inner @ ..] if solid => {
                let mut voids = Vec::with_capacity(inner.len());
                for shell in inner {
                    voids.push(self.text.add(format_args!("ORIENTED_CLOSED_SHELL('',*,{shell},.T.)"))?);
                }
                let voids = list(voids, |id| id.to_string());
                self.text.add(format_args!("BREP_WITH_VOIDS({name},{outer},{voids})"))?
            }
            _ => {
                let shells = list(&shells, |id| id.to_string());
                self.text.add(format_args!("SHELL_BASED_SURFACE_MODEL({name},{shells})"))?
            }
        };
        if solid {
            solids.push(id)
        } else {
            sheets.push(id)
        }
        if let Some(colour) = body.colour {
            self.styles.surface(&mut self.text, id, colour)?;
        }
        Ok(())
    }
}
