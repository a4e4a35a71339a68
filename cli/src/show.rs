//! `perpend show`: the entities of a model, and what is known of them.

use std::fmt::Write as _;
use std::process::ExitCode;

use perpend::{Aabb, DVec3, Definition, Direction, Entity, EntityId, Model, Record};
use serde::Serialize;

use crate::args::ShowArguments;
use crate::check::shape;
use crate::error::CommandError;
use crate::report::{self, rounded};

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
            Some(_) => {} // told below
        }
    }
    let entities: Vec<&Entity> = match arguments.entity {
        None => model.entities().iter().collect(),
        Some(id) => {
            vec![model.entity(id).ok_or_else(|| CommandError::unknown_entity(arguments.model.clone(), &model, id))?]
        }
    };
    let text = if arguments.json {
        json(&entities)
    } else if let (Some(_), [entity]) = (arguments.entity, entities.as_slice()) {
        details(&model, entity)
    } else {
        table(&model, &entities)
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
    definition: DefinitionForm,
    knowledge: Option<&'a Record>,
}

#[derive(Serialize)]
struct DefinitionForm {
    kind: &'static str,
    degree: PerDirection,
    points: PerDirection,
}

/// A number of a curve, or one for each direction of a surface.
#[derive(Serialize)]
#[serde(untagged)]
enum PerDirection {
    Curve(usize),
    Surface(usize, usize),
}

/// The entities with their records, for programs.
pub(crate) fn json(entities: &[&Entity]) -> String {
    let entities = entities
        .iter()
        .map(|entity| EntityForm {
            id: entity.id(),
            name: entity.name(),
            definition: definition(entity.definition()),
            knowledge: entity.record(),
        })
        .collect();
    let mut text =
        serde_json::to_string_pretty(&Listing { entities }).expect("a record is plain data with names for keys");
    text.push('\n');
    text
}

fn definition(definition: &Definition) -> DefinitionForm {
    let (degree, points) = match definition {
        Definition::NurbsCurve(curve) => {
            (PerDirection::Curve(curve.degree()), PerDirection::Curve(curve.control_points().len()))
        }
        Definition::NurbsSurface(surface) => {
            let (p, q) = surface.degree();
            (PerDirection::Surface(p, q), PerDirection::Surface(surface.rows(), surface.columns()))
        }
    };
    DefinitionForm { kind: definition.kind(), degree, points }
}

/// One line for each entity.
fn table(model: &Model, entities: &[&Entity]) -> String {
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
            entity.definition().kind().to_owned(),
            degree,
            points,
            weights.to_owned(),
            rounded(entity.definition().size()),
            known(entity),
        ]
    }));
    let mut widths = [0; 8];
    for row in &rows {
        for (width, cell) in widths.iter_mut().zip(row) {
            *width = cell.chars().count().max(*width);
        }
    }
    let mut text = String::new();
    for row in &rows {
        let cells: Vec<String> = row.iter().zip(widths).map(|(cell, width)| format!("{cell:width$}")).collect();
        let _ = writeln!(text, "{}", cells.join("  ").trim_end());
    }
    text
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
    line("definition", shape(definition));
    match &**definition {
        Definition::NurbsCurve(curve) => line("domain", range(curve.domain())),
        Definition::NurbsSurface(surface) => {
            let [u, v] = [Direction::U, Direction::V].map(|direction| range(surface.domain(direction)));
            line("domain", format!("{u} x {v}"));
        }
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

fn point(p: DVec3) -> String {
    format!("({:?}, {:?}, {:?})", p.x, p.y, p.z)
}

fn range((from, to): (f64, f64)) -> String {
    format!("[{from:?}, {to:?}]")
}
