//! `perpend report`: a page that shows a model and how far points lie from it.

mod base64;
mod chart;
mod colours;
mod number;
mod page;
mod scene;
mod statistics;
mod survey;

use std::collections::HashSet;
use std::path::Path;
use std::process::ExitCode;

use perpend::{Aabb, Body, BodyError, DVec3, Entity, EntityId, FootPoint, Model, QueryOptions};

use crate::args::ReportArguments;
use crate::deviation_report::page::Report;
use crate::deviation_report::scene::Part;
use crate::deviation_report::survey::{Measured, Survey};
use crate::error::CommandError;
use crate::project::answer::Layout;
use crate::project::complaints::Complaints;
use crate::project::engine::{Engine, Target};
use crate::project::output::Output;
use crate::project::points::{Batch, Columns, Points};
use crate::project::source::Source;
use crate::project::{BATCH, is_same_file, progress};
use crate::report::{counted, say};

/// The chord error, as a share of the size, where none is given: less than a pixel on a large screen.
const CHORD: f64 = 2e-4;

pub(crate) fn run(arguments: &ReportArguments) -> Result<ExitCode, CommandError> {
    for input in [&arguments.model, &arguments.points] {
        if is_same_file(&arguments.output, input) {
            return Err(CommandError::OutputIsInput { path: arguments.output.clone() });
        }
    }
    let output = Output::open(Some(&arguments.output))?;
    let model = arguments.trust.read(&arguments.model)?;
    if model.is_empty() {
        return Err(CommandError::NoEntities { model: arguments.model.clone() });
    }
    let asked = Asked::of(arguments, &model)?;
    let (survey, bad) = survey(arguments, asked, &model)?;
    let shown = shown(&model, asked, &survey);
    let size = size(&shown);
    let chord = arguments.chord.unwrap_or(if size > 0.0 { CHORD * size } else { CHORD });
    let part = Part::new(&shown, chord).expect("the command line takes no other chord errors");
    let [model_name, points_name] = [&arguments.model, &arguments.points].map(|path| name(path));
    let report = Report {
        title: arguments.title.clone().unwrap_or_else(|| format!("Deviations of {points_name}")),
        model: model_name,
        points: points_name,
        unit: model.units().symbol(),
        part: &part,
        survey: &survey,
        bad,
        scale: arguments.scale,
        size,
    };
    output.write(report.page().as_bytes())?.finish()?;
    tell(arguments, &survey, bad);
    Ok(if bad == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Measures all points; with how many rows could not be read.
fn survey(arguments: &ReportArguments, asked: Asked, model: &Model) -> Result<(Survey, u64), CommandError> {
    let source = Source::of(&arguments.points);
    let (input, length) = source.open()?;
    let bar = progress::bar(length, true);
    let mut points = Points::new(bar.wrap_read(input)).map_err(|problem| source.wrong(problem))?;
    let columns = points.header().map_err(|problem| source.wrong(problem))?;
    let target = target(asked, source, &columns, model)?;
    if let Target::Body { id, signed: true } = target
        && let Err(source @ BodyError::InsideOut { .. }) =
            model.signed_distance(id, DVec3::ZERO, &QueryOptions::default())
    {
        return Err(CommandError::Body { model: arguments.model.clone(), source });
    }
    let layout = Layout { columns: &columns, normals: false, ranks: false };
    let engine = Engine::new(model, target, QueryOptions::default(), layout);
    let mut complaints = Complaints::new(source, &bar);
    let mut survey = Survey::new(arguments.most_points as usize);
    let mut batch = Batch::default();
    loop {
        points.read(&mut batch, BATCH).map_err(|problem| source.wrong(problem))?;
        if batch.len() == 0 {
            break;
        }
        for (line, asking) in engine.ask(&batch).into_iter().flatten() {
            match asking {
                // one foot, since neither several were asked for nor a maximum distance
                Ok((asked, feet)) => feet.iter().for_each(|(id, foot)| {
                    survey.take(measured(line, asked.point, *id, foot, &engine));
                }),
                Err(complaint) => complaints.take(&complaint),
            }
        }
    }
    complaints.finish();
    bar.finish_and_clear();
    Ok((survey, complaints.count()))
}

fn measured(line: u64, point: DVec3, entity: EntityId, foot: &FootPoint, engine: &Engine<'_>) -> Measured {
    Measured {
        line,
        point,
        entity,
        deviation: foot.signed_distance.unwrap_or(foot.distance),
        lower_bound: foot.lower_bound,
        has_side: foot.signed_distance.is_some(),
        is_certified: engine.is_certified(entity, foot, point),
    }
}

/// What the points are measured against.
#[derive(Debug, Clone, Copy)]
enum Asked {
    Entity(EntityId),
    Body(EntityId),
    /// The whole model, or what each row names.
    All,
}

impl Asked {
    fn of(arguments: &ReportArguments, model: &Model) -> Result<Self, CommandError> {
        let path = || arguments.model.clone();
        match (arguments.entity, arguments.body) {
            (Some(id), _) if model.body(id).is_some() => Ok(Self::Body(id)),
            (Some(id), _) if model.entity(id).is_none() => Err(CommandError::unknown_entity(path(), model, id)),
            (_, Some(id)) if model.body(id).is_none() => Err(CommandError::unknown_body(path(), model, id)),
            (Some(id), _) => Ok(Self::Entity(id)),
            (_, Some(id)) => Ok(Self::Body(id)),
            (None, None) => Ok(Self::All),
        }
    }
}

/// What the rows are measured against.
fn target(asked: Asked, source: Source<'_>, columns: &Columns, model: &Model) -> Result<Target, CommandError> {
    let of_body = |body: &Body| Target::Body { id: body.id(), signed: body.is_closed() };
    let twice = |option| Err(CommandError::TwoEntities { name: source.to_string(), option });
    match (asked, columns.entity) {
        (Asked::Entity(_), Some(_)) => twice("entity"),
        (Asked::Body(_), Some(_)) => twice("body"),
        (Asked::Entity(id), None) => Ok(Target::Entity(id)),
        (Asked::Body(id), None) => Ok(model.body(id).map_or(Target::Nearest, of_body)),
        (Asked::All, Some(_)) => Ok(Target::Named),
        // the one body that the model is tells the sides better than its faces do
        (Asked::All, None) => Ok(only_body(model).map_or(Target::Nearest, of_body)),
    }
}

/// The body that is all of the model, if it is closed.
fn only_body(model: &Model) -> Option<&Body> {
    let [body] = model.bodies() else { return None };
    let parts = model.parts_of_faces();
    let faces: HashSet<EntityId> = body.faces().collect();
    let is_of_body = |entity: &Entity| faces.contains(&entity.id()) || parts.contains(&entity.id());
    (body.is_closed() && model.entities().iter().all(is_of_body)).then_some(body)
}

/// What is drawn: what was asked, faces in place of their parts, and what is nearest to a point.
fn shown<'a>(model: &'a Model, asked: Asked, survey: &Survey) -> Vec<&'a Entity> {
    let wanted: HashSet<EntityId> = match asked {
        Asked::Entity(id) => HashSet::from([id]),
        Asked::Body(id) => model.body(id).into_iter().flat_map(Body::faces).collect(),
        Asked::All => {
            let parts = model.parts_of_faces();
            model.entities().iter().map(Entity::id).filter(|id| !parts.contains(id)).collect()
        }
    };
    let is_shown = |id: EntityId| wanted.contains(&id) || survey.of_entity.contains_key(&id);
    model.entities().iter().filter(|entity| is_shown(entity.id())).collect()
}

/// The diagonal of the entities' control points' box.
fn size(entities: &[&Entity]) -> f64 {
    let boxes = entities.iter().map(|entity| entity.definition().control_box());
    boxes.fold(Aabb::EMPTY, Aabb::join).diagonal()
}

/// A file's name without its folder.
fn name(path: &Path) -> String {
    path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
}

/// What the run came to, for the user.
fn tell(arguments: &ReportArguments, survey: &Survey, bad: u64) {
    let points: usize = survey.of_entity.values().map(Vec::len).sum();
    let drawn = match survey.drawn.every {
        1 => "all drawn".to_owned(),
        every => format!("one of {every} drawn"),
    };
    say(format_args!("{}: {}, {drawn}", arguments.output.display(), counted(points as u64, "point")));
    say(format_args!("not certified:  {}", survey.uncertified));
    say(format_args!("bad rows:       {bad}"));
}
