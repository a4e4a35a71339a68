//! `perpend export`: a model for other programs.

use std::io::{self, Write};
use std::num::NonZeroUsize;
use std::process::ExitCode;
use std::sync::atomic::{AtomicUsize, Ordering};

use perpend::{AtomicFile, Body, Definition, Entity, EntityId, Model};
use perpend_step::WriteOptions;
use perpend_tessellation::obj::ObjWriter;
use perpend_tessellation::{Limits, Mesh, Polyline, polyline, stl, tessellate};
use rayon::prelude::*;

use crate::args::{ExportArguments, Format};
use crate::error::{CommandError, known_ids};
use crate::project::is_same_file;
use crate::report::{self, counted};
use crate::show;

pub(crate) fn run(arguments: &ExportArguments) -> Result<ExitCode, CommandError> {
    let format = format(arguments)?;
    let file = Some(arguments.output.as_path()).filter(|path| path.as_os_str() != "-");
    if let Some(path) = file
        && is_same_file(path, &arguments.model)
    {
        return Err(CommandError::OutputIsModel { path: path.to_owned() });
    }
    // that it can be written is known before the work starts
    let file = file.map(AtomicFile::create).transpose()?;
    let model = arguments.trust.read(&arguments.model)?;
    if let Some(id) = arguments.entity
        && model.entity(id).is_none()
        && model.body(id).is_none()
    {
        let known = known_ids(&model);
        return Err(CommandError::UnknownEntity { model: arguments.model.clone(), id, known });
    }
    let job = Job { arguments, model };
    match format {
        Format::Step => job.step(file),
        Format::Obj => job.obj(file),
        Format::Stl => job.stl(file),
        Format::Json => job.json(file),
    }?;
    Ok(ExitCode::SUCCESS)
}

/// The format that is asked for, and that the options fit it.
fn format(arguments: &ExportArguments) -> Result<Format, CommandError> {
    let named = || {
        let ending = arguments.output.extension()?.to_str()?.to_ascii_lowercase();
        Some(match ending.as_str() {
            "step" | "stp" => Format::Step,
            "obj" => Format::Obj,
            "stl" => Format::Stl,
            "json" => Format::Json,
            _ => return None,
        })
    };
    let format = arguments
        .format
        .or_else(named)
        .ok_or_else(|| CommandError::UnknownFormat { path: arguments.output.clone() })?;
    if arguments.chord.is_some() && matches!(format, Format::Step | Format::Json) {
        return Err(CommandError::IdleOption { option: "--chord", format: name(format) });
    }
    if arguments.most_triangles.is_some() && matches!(format, Format::Step | Format::Json) {
        return Err(CommandError::IdleOption { option: "--most-triangles", format: name(format) });
    }
    if arguments.ascii && format != Format::Stl {
        return Err(CommandError::IdleOption { option: "--ascii", format: name(format) });
    }
    Ok(format)
}

fn name(format: Format) -> &'static str {
    match format {
        Format::Step => "STEP",
        Format::Obj => "OBJ",
        Format::Stl => "STL",
        Format::Json => "JSON",
    }
}

/// Triangles of all faces together, where no other number is asked for: half a gigabyte of STL.
const MOST_TRIANGLES: usize = 10_000_000;

/// The steps by which a chord error that would do is looked for: triangles of curved faces are two to four times as many for a quarter of it.
const CHORD_STEP: f64 = 4.0;

struct Job<'a> {
    arguments: &'a ExportArguments,
    model: Model,
}

/// Faces that are written as one.
struct Group<'a> {
    name: String,
    faces: Vec<&'a Entity>,
}

impl Job<'_> {
    fn step(&self, file: Option<AtomicFile>) -> Result<(), CommandError> {
        let name =
            self.arguments.model.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
        let options = WriteOptions { name: &name, only: self.arguments.entity };
        let mut written = perpend_step::Written::default();
        put(file, |out| {
            written = perpend_step::write(&self.model, options, out)?;
            Ok(())
        })?;
        for face in &written.empty {
            report::say(format_args!("face {face} is left out: its loops are points within rounding"));
        }
        for fitted in &written.fitted {
            report::say(format_args!(
                "face {}: an edge was fitted, and is {} {} off the trim",
                fitted.face,
                report::rounded(fitted.deviation),
                self.model.units().symbol()
            ));
        }
        let bodies = match written.bodies {
            1 => "1 body".to_owned(),
            count => format!("{count} bodies"),
        };
        self.done(&format!(
            "{bodies}, {}, {}",
            counted(written.faces as u64, "face"),
            counted(written.curves as u64, "free curve")
        ));
        Ok(())
    }

    fn obj(&self, file: Option<AtomicFile>) -> Result<(), CommandError> {
        let (groups, curves) = self.contents();
        if groups.is_empty() && curves.is_empty() {
            return Err(self.nothing(Format::Obj, "the model is empty", "triangles and polylines"));
        }
        let faces: Vec<&Entity> = groups.iter().flat_map(|group| &group.faces).copied().collect();
        let meshes = self.meshes(&faces)?;
        let lines = self.polylines(&curves)?;
        put(file, |out| {
            let mut obj = ObjWriter::new(out, &format!("lengths in {}", self.model.units().symbol()))?;
            for (face, mesh) in faces.iter().zip(&meshes) {
                obj.mesh(&object_name(face), mesh)?;
            }
            for (curve, line) in curves.iter().zip(&lines) {
                obj.polyline(&object_name(curve), line)?;
            }
            Ok(())
        })?;
        let segments: usize = lines.iter().map(|line| line.points.len() - 1).sum();
        self.done(&format!("{}, {}", self.tally(&meshes), counted(segments as u64, "segment")));
        Ok(())
    }

    fn stl(&self, file: Option<AtomicFile>) -> Result<(), CommandError> {
        let (groups, curves) = self.contents();
        if groups.is_empty() {
            return Err(self.nothing(Format::Stl, "there is no surface", "triangles alone"));
        }
        let faces: Vec<&Entity> = groups.iter().flat_map(|group| &group.faces).copied().collect();
        let meshes = self.meshes(&faces)?;
        let all: Vec<&Mesh> = meshes.iter().collect();
        put(file, |out| {
            if !self.arguments.ascii {
                return stl::binary(out, &all);
            }
            let mut rest = &all[..];
            let mut solids: Vec<(&str, &[&Mesh])> = Vec::new();
            for group in &groups {
                let (of_group, others) = rest.split_at(group.faces.len());
                solids.push((&group.name, of_group));
                rest = others;
            }
            stl::ascii(out, &solids)
        })?;
        if !curves.is_empty() {
            report::say(format_args!("{} left out: STL holds triangles alone", counted(curves.len() as u64, "curve")));
        }
        self.done(&self.tally(&meshes));
        Ok(())
    }

    fn json(mut self, file: Option<AtomicFile>) -> Result<(), CommandError> {
        let ids: Option<Vec<EntityId>> = self.arguments.entity.map(|id| match self.model.body(id) {
            Some(body) => body.faces().collect(),
            None => vec![id],
        });
        match &ids {
            None => {
                self.model.learn_all();
            }
            Some(ids) => {
                for id in ids {
                    self.model.learn(*id).expect("the model has the entity");
                }
            }
        }
        let entities: Vec<&Entity> = match &ids {
            None => self.model.entities().iter().collect(),
            Some(ids) => ids.iter().filter_map(|id| self.model.entity(*id)).collect(),
        };
        let is_asked = |body: &&Body| self.arguments.entity.is_none_or(|id| id == body.id());
        let bodies: Vec<&Body> = self.model.bodies().iter().filter(is_asked).collect();
        let count = entities.len();
        put(file, |out| out.write_all(show::json(&entities, &bodies).as_bytes()))?;
        self.done(&if count == 1 { "1 entity".to_owned() } else { format!("{count} entities") });
        Ok(())
    }

    /// Faces and free curves. What is part of something else, as the edges of faces, stands there alone, unless it is asked for.
    fn contents(&self) -> (Vec<Group<'_>>, Vec<&Entity>) {
        let (model, only) = (&self.model, self.arguments.entity);
        let (mut groups, mut curves) = (Vec::new(), Vec::new());
        let mut parts = model.parts_of_faces();
        for body in model.bodies() {
            parts.extend(body.faces());
            if only.is_none_or(|id| id == body.id()) {
                let faces = body.faces().filter_map(|id| model.entity(id)).collect();
                let name = if body.name().is_empty() { format!("body {}", body.id()) } else { body.name().to_owned() };
                groups.push(Group { name, faces });
            }
        }
        for entity in model.entities() {
            if only.map_or_else(|| parts.contains(&entity.id()), |id| id != entity.id()) {
                continue;
            }
            match &**entity.definition() {
                Definition::NurbsSurface(_) => groups.push(Group { name: object_name(entity), faces: vec![entity] }),
                Definition::NurbsCurve(_) => curves.push(entity),
            }
        }
        (groups, curves)
    }

    fn chord(&self) -> f64 {
        // a model of no size is empty, and asks nobody
        self.arguments.chord.unwrap_or_else(|| (1e-3 * self.model.size()).max(f64::MIN_POSITIVE))
    }

    fn meshes(&self, faces: &[&Entity]) -> Result<Vec<Mesh>, CommandError> {
        let (chord, limits) = (self.chord(), Limits::default());
        let most = self.arguments.most_triangles.map_or(MOST_TRIANGLES, NonZeroUsize::get);
        let Some(meshes) = meshes_within(faces, chord, most) else {
            let model = self.arguments.model.clone();
            let remedy = match self.chord_that_does(faces, chord, most) {
                Some(would) => format!("--chord {would:?} would do, or more of them with --most-triangles"),
                None => "give more of them with --most-triangles, or one --entity".to_owned(),
            };
            return Err(CommandError::TooManyTriangles { model, chord, most, remedy });
        };
        let limit = || format!("{} triangles and {} segments of trims", limits.triangles, limits.segments);
        for (face, mesh) in faces.iter().zip(&meshes) {
            self.judged(face, mesh.error, limit)?;
        }
        Ok(meshes)
    }

    /// A chord error above `chord` with which the faces have been drawn with no more triangles than `most`; none where the model's size is
    /// too little.
    fn chord_that_does(&self, faces: &[&Entity], chord: f64, most: usize) -> Option<f64> {
        let does = |chord: f64| {
            meshes_within(faces, chord, most).is_some_and(|meshes| meshes.iter().all(|mesh| mesh.error <= chord))
        };
        // from coarse to fine: what does not do is found out last, and once
        let mut would = None;
        let mut next = self.model.size();
        while next > chord && does(next) {
            would = Some(next);
            next /= CHORD_STEP;
        }
        would
    }

    fn polylines(&self, curves: &[&Entity]) -> Result<Vec<Polyline>, CommandError> {
        let limits = Limits::default();
        let line = |entity: &&Entity| {
            let Definition::NurbsCurve(curve) = &**entity.definition() else { unreachable!("these are curves") };
            let line = polyline(curve, self.chord(), limits).expect("the chord error is positive");
            self.judged(entity, line.error, || counted(limits.segments as u64, "segment")).map(|()| line)
        };
        curves.iter().map(line).collect()
    }

    /// An error where the limits did not suffice.
    fn judged(&self, entity: &Entity, reached: f64, limit: impl Fn() -> String) -> Result<(), CommandError> {
        let chord = self.chord();
        if reached <= chord {
            return Ok(());
        }
        let model = self.arguments.model.clone();
        Err(CommandError::ChordTooSmall { model, id: entity.id(), limit: limit(), chord, reached })
    }

    fn tally(&self, meshes: &[Mesh]) -> String {
        let triangles: usize = meshes.iter().map(|mesh| mesh.triangles.len()).sum();
        let error = meshes.iter().map(|mesh| mesh.error).fold(0.0, f64::max);
        format!(
            "{}, {}, within {} {}",
            counted(meshes.len() as u64, "face"),
            counted(triangles as u64, "triangle"),
            report::rounded(error),
            self.model.units().symbol()
        )
    }

    fn nothing(&self, format: Format, what: &str, holds: &'static str) -> CommandError {
        let model = self.arguments.model.clone();
        CommandError::NothingToWrite { model, what: what.to_owned(), format: name(format), holds }
    }

    fn done(&self, what: &str) {
        report::say(format_args!("{}: {what}", self.arguments.output.display()));
    }
}

/// The faces' triangles; none where they are more than `most` together, whatever the order of the work.
fn meshes_within(faces: &[&Entity], chord: f64, most: usize) -> Option<Vec<Mesh>> {
    let total = AtomicUsize::new(0);
    let mesh = |face: &&Entity| {
        if total.load(Ordering::Relaxed) > most {
            return None;
        }
        let Definition::NurbsSurface(surface) = &**face.definition() else { unreachable!("groups hold surfaces") };
        let trimming = face.trimming().map(AsRef::as_ref);
        let mesh = tessellate(surface, trimming, chord, Limits::default()).expect("the chord error is positive");
        let count = mesh.triangles.len();
        (total.fetch_add(count, Ordering::Relaxed) + count <= most).then_some(mesh)
    };
    faces.par_iter().map(mesh).collect()
}

/// The name of an entity; where it has none, what it is and its id.
fn object_name(entity: &Entity) -> String {
    if !entity.name().is_empty() {
        return entity.name().to_owned();
    }
    let kind = match &**entity.definition() {
        Definition::NurbsSurface(_) => "face",
        Definition::NurbsCurve(_) => "curve",
    };
    format!("{kind} {}", entity.id())
}

/// Writes to the file, whole or not at all, or to standard output.
fn put(file: Option<AtomicFile>, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), CommandError> {
    match file {
        Some(mut file) => match write(&mut file) {
            Ok(()) => Ok(file.commit()?),
            Err(error) => Err(file.failed(error).into()),
        },
        None => {
            let mut out = io::BufWriter::new(io::stdout().lock());
            write(&mut out).and_then(|()| out.flush()).map_err(CommandError::StandardOutput)
        }
    }
}
