//! `perpend show`: the entities of a model, and what is known of them.

use std::fmt::Write as _;
use std::process::ExitCode;

use perpend::{Aabb, Body, DVec3, Definition, Direction, Entity, EntityId, Model, Record, Shell};
use serde::Serialize;

use crate::args::ShowArguments;
use crate::check::{form, solid};
use crate::error::CommandError;
use crate::report::{self, counted, rounded};

/// No column of a table is wider than this many letters.
const WIDEST: usize = 60;

pub(crate) fn run(arguments: &ShowArguments) -> Result<ExitCode, CommandError> {
    let mut model = arguments.trust.read(&arguments.model)?;
    if arguments.json {
        match arguments.entity {
            None => {
                model.learn_all();
            }
            Some(id) if model.entity(id).is_some() => {
                model.learn(id).expect("the model has the entity");
            }
            Some(_) => {} // a body, or told below
        }
    }
    let is_shown = |id: EntityId| arguments.entity.is_none_or(|asked| asked == id);
    let entities: Vec<&Entity> = model.entities().iter().filter(|entity| is_shown(entity.id())).collect();
    let bodies: Vec<&Body> = model.bodies().iter().filter(|body| is_shown(body.id())).collect();
    if let Some(id) = arguments.entity
        && entities.is_empty()
        && bodies.is_empty()
    {
        return Err(CommandError::unknown_entity(arguments.model.clone(), &model, id));
    }
    let text = if arguments.json {
        json(&entities, &bodies)
    } else if let (Some(_), [entity]) = (arguments.entity, entities.as_slice()) {
        details(&model, entity)
    } else if let (Some(_), [body]) = (arguments.entity, bodies.as_slice()) {
        body_details(body)
    } else {
        table(&model, &entities, &bodies)
    };
    report::answer(text.as_bytes())?;
    Ok(ExitCode::SUCCESS)
}

#[derive(Serialize)]
struct Listing<'a> {
    entities: Vec<EntityForm<'a>>,
}

#[derive(Serialize)]
struct EntityForm<'a> {
    id: EntityId,
    name: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    colour: Option<[f64; 3]>,
    definition: DefinitionForm<'a>,
    knowledge: Option<&'a Record>,
}

/// What an entity or a body is.
#[derive(Serialize)]
#[serde(untagged)]
enum DefinitionForm<'a> {
    Plain {
        kind: &'static str,
        degree: PerDirection,
        points: PerDirection,
    },
    Trimmed {
        kind: &'static str,
        /// The entity that it trims; none: the surface is its own.
        surface: Option<EntityId>,
        degree: PerDirection,
        points: PerDirection,
        reversed: bool,
        tolerance: f64,
        loops: Vec<LoopForm>,
    },
    Body {
        kind: &'static str,
        shells: &'a [Shell],
    },
}

#[derive(Serialize)]
struct LoopForm {
    outer: bool,
    /// How many p-curves it has.
    curves: usize,
    /// The curves in space that follow them.
    edges: Vec<EntityId>,
}

/// A number of a curve, or one for each direction of a surface.
#[derive(Serialize)]
#[serde(untagged)]
enum PerDirection {
    Curve(usize),
    Surface(usize, usize),
}

/// The entities with their records, and the bodies, for programs.
pub(crate) fn json(entities: &[&Entity], bodies: &[&Body]) -> String {
    let of_entities = entities.iter().map(|entity| EntityForm {
        id: entity.id(),
        name: entity.name(),
        colour: entity.colour(),
        definition: definition(entity),
        knowledge: entity.record(),
    });
    let of_bodies = bodies.iter().map(|body| EntityForm {
        id: body.id(),
        name: body.name(),
        colour: body.colour(),
        definition: DefinitionForm::Body { kind: "Body", shells: body.shells() },
        knowledge: None,
    });
    let entities = of_entities.chain(of_bodies).collect();
    let mut text =
        serde_json::to_string_pretty(&Listing { entities }).expect("a record is plain data with names for keys");
    text.push('\n');
    text
}

fn definition(entity: &Entity) -> DefinitionForm<'static> {
    let (degree, points) = match &**entity.definition() {
        Definition::NurbsCurve(curve) => {
            (PerDirection::Curve(curve.degree()), PerDirection::Curve(curve.control_points().len()))
        }
        Definition::NurbsSurface(surface) => {
            let (p, q) = surface.degree();
            (PerDirection::Surface(p, q), PerDirection::Surface(surface.rows(), surface.columns()))
        }
    };
    match entity.trimming() {
        None => DefinitionForm::Plain { kind: kind(entity), degree, points },
        Some(trimming) => DefinitionForm::Trimmed {
            kind: kind(entity),
            surface: entity.carrier(),
            degree,
            points,
            reversed: trimming.reversed(),
            tolerance: trimming.tolerance(),
            loops: trimming
                .loops()
                .iter()
                .map(|one| LoopForm {
                    outer: one.outer,
                    curves: one.curves.len(),
                    edges: one.curves.iter().filter_map(|curve| curve.edge).collect(),
                })
                .collect(),
        },
    }
}

/// The kind's name, as files write it.
fn kind(entity: &Entity) -> &'static str {
    if entity.trimming().is_some() { "TrimmedSurface" } else { entity.definition().kind() }
}

/// One line for each entity.
fn table(model: &Model, entities: &[&Entity], bodies: &[&Body]) -> String {
    let size = format!("size/{}", model.units().symbol());
    let mut rows = vec![["id", "name", "kind", "degree", "points", "weights", &size, "knowledge"].map(str::to_owned)];
    rows.extend(entities.iter().map(|entity| {
        let (degree, points) = match &**entity.definition() {
            Definition::NurbsCurve(curve) => (curve.degree().to_string(), curve.control_points().len().to_string()),
            Definition::NurbsSurface(surface) => {
                let (p, q) = surface.degree();
                (format!("({p}, {q})"), format!("{} x {}", surface.rows(), surface.columns()))
            }
        };
        let weights = if entity.definition().weights().is_some() { "rational" } else { "all 1" };
        [
            entity.id().to_string(),
            format!("{:?}", entity.name()),
            kind(entity).to_owned(),
            degree,
            points,
            weights.to_owned(),
            rounded(entity.definition().size()),
            known(entity),
        ]
    }));
    rows.extend(bodies.iter().map(|body| {
        let faces = body.shells().iter().map(|shell| shell.faces.len()).sum::<usize>();
        let none = || "-".to_owned();
        let faces = counted(faces as u64, "face");
        [body.id().to_string(), format!("{:?}", body.name()), "Body".to_owned(), none(), faces, none(), none(), none()]
    }));
    let mut widths = [0; 8];
    for row in &rows {
        for (width, cell) in widths.iter_mut().zip(row) {
            *width = cell.chars().count().min(WIDEST).max(*width);
        }
    }
    let mut text = String::new();
    for row in &rows {
        let cells: Vec<String> = row.iter().zip(widths).map(|(cell, width)| padded(cell, width)).collect();
        let _ = writeln!(text, "{}", cells.join("  ").trim_end());
    }
    text
}

/// A cell of a table, filled up to its column's width; what is longer is cut there, and says so.
fn padded(cell: &str, width: usize) -> String {
    if cell.chars().count() <= width {
        return format!("{cell:width$}");
    }
    cell.chars().take(width - 1).chain(['…']).collect()
}

/// Which parts of the record there are.
fn known(entity: &Entity) -> String {
    let Some(record) = entity.record() else {
        return "none".to_owned();
    };
    let mut parts = vec![format!("revision {}", record.revision)];
    let named = [
        (record.classification.is_some(), "classification"),
        (record.representation.is_some(), "representation"),
        (!record.intent.is_empty(), "intent"),
        (!record.relationships.is_empty(), "relationships"),
    ];
    parts.extend(named.into_iter().filter(|(is_there, _)| *is_there).map(|(_, name)| name.to_owned()));
    if !entity.stale().is_empty() {
        parts.push("stale".to_owned());
    }
    parts.join(", ")
}

/// All of one entity.
fn details(model: &Model, entity: &Entity) -> String {
    let definition = entity.definition();
    let unit = model.units().symbol();
    let mut text = String::new();
    let mut line = |name: &str, value: String| {
        let _ = writeln!(text, "{name:<12}{value}");
    };
    line("id", entity.id().to_string());
    line("name", format!("{:?}", entity.name()));
    line("definition", form(entity));
    match &**definition {
        Definition::NurbsCurve(curve) => line("domain", range(curve.domain())),
        Definition::NurbsSurface(surface) => {
            let [u, v] = [Direction::U, Direction::V].map(|direction| range(surface.domain(direction)));
            line("domain", format!("{u} x {v}"));
        }
    }
    if let Some(trimming) = entity.trimming() {
        line("trim", format!("closed within {} {unit}", rounded(trimming.tolerance())));
        for one in trimming.loops() {
            let edges: Vec<String> =
                one.curves.iter().filter_map(|curve| curve.edge).map(|id| id.to_string()).collect();
            let edges = if edges.is_empty() { String::new() } else { format!(", edges {}", edges.join(", ")) };
            let side = if one.outer { "outer" } else { "inner" };
            line("", format!("{side} loop of {}{edges}", counted(one.curves.len() as u64, "p-curve")));
        }
    }
    if let Some(colour) = entity.colour() {
        line("colour", point(DVec3::from_array(colour)));
    }
    let Aabb { min, max } = definition.control_box();
    line("box", format!("{} to {} {unit}", point(min), point(max)));
    line("size", format!("{} {unit}", rounded(definition.size())));
    let stale = entity.stale();
    if !stale.is_empty() {
        line("stale", stale.join(", "));
    }
    match entity.record() {
        None => line("knowledge", "none".to_owned()),
        Some(record) => {
            let ron = ron::ser::to_string_pretty(record, ron::ser::PrettyConfig::default());
            line("knowledge", ron.expect("a record is plain data"));
        }
    }
    text
}

/// All of one body.
fn body_details(body: &Body) -> String {
    let mut text = String::new();
    let mut line = |name: &str, value: String| {
        let _ = writeln!(text, "{name:<12}{value}");
    };
    line("id", body.id().to_string());
    line("name", format!("{:?}", body.name()));
    line("definition", solid(body));
    for Shell { faces, closed } in body.shells() {
        let faces: Vec<String> = faces.iter().map(ToString::to_string).collect();
        line(if *closed { "closed" } else { "open" }, format!("faces {}", faces.join(", ")));
    }
    if let Some(colour) = body.colour() {
        line("colour", point(DVec3::from_array(colour)));
    }
    text
}

fn point(p: DVec3) -> String {
    format!("({:?}, {:?}, {:?})", p.x, p.y, p.z)
}

fn range((from, to): (f64, f64)) -> String {
    format!("[{from:?}, {to:?}]")
}
