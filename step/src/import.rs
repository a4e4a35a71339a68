//! From what a file says to a model: faces as trimmed surfaces that are known, edges as curves, bodies.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Instant;

use perpend::kernel::{TrimLoopData, TrimmingData};
use perpend::{
    Basis, Carrier, Classification, Definition, EntityId, IntoDefinition, InvalidDefinition, Item, Kind, Model,
    NurbsCurve, Origin, Record, Shape, Shell, TrimmedSurface,
};
use rayon::prelude::*;

use crate::face::{BuiltFace, FaceError, build, edge_curve};
use crate::read::{ReadError, ReadOptions, read, read_bytes};
use crate::source::{NotUnderstood, SourceBody, SourceFace, SourcePart};

/// A recognised class is proven within this share of its face's size.
const RECOGNITION: f64 = 1e-10;

/// The stack of the thread that builds.
const STACK: usize = 64 << 20;

/// A part as a model.
#[derive(Debug)]
pub struct Import {
    /// Faces as trimmed surfaces, their edges as curves, and bodies. Names are those of the file, else the numbers of its entities.
    pub model: Model,
    /// What was left out, and why; by the numbers of the file's entities.
    pub not_understood: Vec<NotUnderstood>,
    /// How many faces the model has.
    pub faces: usize,
    /// How many of them are planes, cylinders, cones, spheres and tori that are known as such.
    pub known_faces: usize,
    /// How many edges.
    pub edges: usize,
    /// How many bodies.
    pub bodies: usize,
}

/// Imports a STEP file of this name.
///
/// # Errors
///
/// As [`import`], or the file cannot be opened.
pub fn import_file(path: &Path, options: &ReadOptions) -> Result<Import, ReadError> {
    import(read_bytes(path, options)?, options)
}

/// Imports the bytes of a STEP file.
///
/// Every face becomes a trimmed surface in the file's unit where perpend has that unit, else in millimetres. P-curves are made by projecting the edges; those
/// of the file are hints. Analytic faces are known: their class is proved against their exact NURBS form. What is not understood is listed in
/// [`Import::not_understood`] and never dropped silently.
///
/// # Errors
///
/// The bytes are not a STEP file, break its syntax, or pass a limit of the options: size, time, number of pieces.
pub fn import(bytes: Vec<u8>, options: &ReadOptions) -> Result<Import, ReadError> {
    let started = Instant::now();
    let part = read(bytes, options)?;
    let left = options.max_time.saturating_sub(started.elapsed());
    let stop = Arc::new(AtomicBool::new(false));
    let (sender, receiver) = channel();
    let seen = Arc::clone(&stop);
    thread::Builder::new().name("perpend-import".to_owned()).stack_size(STACK).spawn(move || {
        // nobody listens once the time is over
        let _ = sender.send(built(part, &seen));
    })?;
    match receiver.recv_timeout(left) {
        Ok(import) => Ok(import),
        Err(RecvTimeoutError::Timeout) => {
            stop.store(true, Ordering::Relaxed);
            Err(ReadError::TooSlow { limit: options.max_time })
        }
        Err(RecvTimeoutError::Disconnected) => {
            Err(ReadError::Failed { message: "building its faces ended early".to_owned() })
        }
    }
}

/// The model of a part; of what is left when `stop` is set nothing is built.
fn built(part: SourcePart, stop: &AtomicBool) -> Import {
    let SourcePart { units, tolerance, edges, faces, bodies, mut not_understood } = part;
    let curves: Vec<Result<NurbsCurve, FaceError>> =
        edges.par_iter().map(|edge| guarded(stop, || edge_curve(edge, tolerance))).collect();
    let made: Vec<Result<MadeFace, String>> = faces
        .par_iter()
        .map(|face| {
            let built = guarded(stop, || build(face, &edges, &curves, tolerance)).map_err(|error| error.to_string())?;
            MadeFace::new(built).map_err(|error| error.to_string())
        })
        .collect();
    let mut model = Model::new();
    model.set_units(units);
    let mut edge_ids: Vec<Option<EntityId>> = vec![None; edges.len()];
    for edge in made.iter().flatten().flat_map(MadeFace::edges) {
        if edge_ids[edge].is_none()
            && let Ok(curve) = &curves[edge]
        {
            let entity = edges[edge].entity;
            match insert_edge(&mut model, curve, entity) {
                Ok(id) => edge_ids[edge] = Some(id),
                Err(error) => {
                    let (keyword, reason) = ("EDGE_CURVE".to_owned(), error.to_string());
                    not_understood.push(NotUnderstood { entity, keyword, reason });
                }
            }
        }
    }
    let mut face_ids: Vec<Option<EntityId>> = Vec::with_capacity(faces.len());
    let reversed = turned(&bodies, faces.len());
    let (mut count, mut known) = (0, 0);
    for ((face, made), reversed) in faces.iter().zip(made).zip(reversed) {
        let is_known = made.as_ref().is_ok_and(|face| face.kind.is_some());
        match made.and_then(|made| insert_face(&mut model, face, made, &edge_ids, reversed)) {
            Ok(id) => {
                (count, known) = (count + 1, known + usize::from(is_known));
                face_ids.push(Some(id));
            }
            Err(reason) => {
                face_ids.push(None);
                let keyword = "ADVANCED_FACE".to_owned();
                not_understood.push(NotUnderstood { entity: face.entity, keyword, reason });
            }
        }
    }
    let mut body_count = 0;
    for body in &bodies {
        match insert_body(&mut model, body, &face_ids) {
            Ok(inserted) => body_count += usize::from(inserted),
            Err(reason) => {
                let keyword = "SOLID_MODEL".to_owned();
                not_understood.push(NotUnderstood { entity: body.entity, keyword, reason });
            }
        }
    }
    let edges = edge_ids.iter().flatten().count();
    Import { model, not_understood, faces: count, known_faces: known, edges, bodies: body_count }
}

/// The result of building something of a file that may be hostile: a panic is an error of that thing alone.
fn guarded<T>(stop: &AtomicBool, build: impl FnOnce() -> Result<T, FaceError>) -> Result<T, FaceError> {
    if stop.load(Ordering::Relaxed) {
        return Err(FaceError::GivenUp);
    }
    catch_unwind(AssertUnwindSafe(build)).unwrap_or(Err(FaceError::Failed))
}

/// A face with its proven class.
struct MadeFace {
    built: BuiltFace,
    kind: Option<Item<Kind>>,
}

impl MadeFace {
    fn new(built: BuiltFace) -> Result<Self, InvalidDefinition> {
        let kind = match &built.shape {
            Some(shape) => proven(shape, &built)?,
            None => None,
        };
        Ok(Self { built, kind })
    }

    /// The part's edges that its p-curves follow, loop by loop.
    fn edges(&self) -> impl Iterator<Item = usize> + '_ {
        self.built.loops.iter().flat_map(|one| &one.curves).filter_map(|(_, edge)| *edge)
    }
}

/// The class of an analytic face, proved against its carrier.
fn proven(shape: &Shape, built: &BuiltFace) -> Result<Option<Item<Kind>>, InvalidDefinition> {
    let Some(kind) = (*shape).enter()?.kind else { return Ok(None) };
    let definition = Definition::from(built.surface.clone());
    let tolerance = RECOGNITION * definition.size();
    let gap = perpend::knowledge::prove(&kind, &definition, tolerance).ok();
    let of = definition.fingerprint();
    Ok(gap.map(|gap| Item { value: kind, basis: Basis::Proved { gap }, tolerance, of }))
}

fn origin(entity: u64) -> Origin {
    Origin::Imported { format: "STEP".to_owned(), from: format!("#{entity}") }
}

fn insert_edge(model: &mut Model, curve: &NurbsCurve, entity: u64) -> Result<EntityId, InvalidDefinition> {
    let id = model.insert(&format!("edge #{entity}"), curve.clone())?;
    let classification = Classification { origin: Some(origin(entity)), ..Classification::default() };
    let record = Record { classification: Some(classification), ..Record::default() };
    model.set_record(id, record).expect("the edge was just inserted");
    Ok(id)
}

fn insert_face(
    model: &mut Model,
    face: &SourceFace,
    made: MadeFace,
    edges: &[Option<EntityId>],
    reversed: bool,
) -> Result<EntityId, String> {
    let MadeFace { built, kind } = made;
    let loops = built
        .loops
        .into_iter()
        .map(|one| TrimLoopData {
            outer: one.outer,
            curves: one
                .curves
                .into_iter()
                .map(|(mut curve, edge)| {
                    curve.edge = edge.and_then(|edge| edges[edge]);
                    curve
                })
                .collect(),
        })
        .collect();
    let trimming = TrimmingData { reversed: built.reversed != reversed, tolerance: built.tolerance, loops };
    let name = if face.name.is_empty() { format!("face #{}", face.entity) } else { face.name.clone() };
    let trimmed = TrimmedSurface { surface: Carrier::Own(built.surface), trimming };
    let id = model.insert_trimmed(&name, trimmed).map_err(|error| error.to_string())?;
    let mut record = model.entity(id).and_then(|entity| entity.record().cloned()).unwrap_or_default();
    let classification = record.classification.get_or_insert_default();
    classification.origin = Some(origin(face.entity));
    classification.kind = kind;
    model.set_record(id, record).map_err(|error| error.to_string())?;
    if face.colour.is_some() {
        model.set_colour(id, face.colour).map_err(|error| error.to_string())?;
    }
    Ok(id)
}

/// Which faces belong to shells that are used the other way round.
fn turned(bodies: &[SourceBody], faces: usize) -> Vec<bool> {
    let mut turned = vec![false; faces];
    for shell in bodies.iter().flat_map(|body| &body.shells).filter(|shell| shell.reversed) {
        shell.faces.iter().for_each(|face| turned[*face] = true);
    }
    turned
}

/// Inserts a body of the faces that were understood; false where none was.
fn insert_body(model: &mut Model, body: &SourceBody, faces: &[Option<EntityId>]) -> Result<bool, String> {
    let shells: Vec<Shell> = body
        .shells
        .iter()
        .map(|shell| {
            let ids: Vec<EntityId> = shell.faces.iter().filter_map(|face| faces[*face]).collect();
            Shell { closed: shell.closed && ids.len() == shell.faces.len(), faces: ids }
        })
        .filter(|shell| !shell.faces.is_empty())
        .collect();
    if shells.is_empty() {
        return Ok(false);
    }
    let name = if body.name.is_empty() { format!("body #{}", body.entity) } else { body.name.clone() };
    let id = model.insert_body(&name, shells).map_err(|error| error.to_string())?;
    if body.colour.is_some() {
        model.set_colour(id, body.colour).map_err(|error| error.to_string())?;
    }
    Ok(true)
}
