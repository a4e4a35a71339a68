//! How a model's file is laid out.
//!
//! One field a line; numbers fill lines; a row of a net begins a line. Floats are the shortest decimals that read back bit
//! for bit.

use std::fmt::{self, Display};
use std::io::{self, Write};

use glam::{DVec2, DVec3};
use perpend_kernel::{Definition, Direction, EntityId, NurbsCurve, NurbsSurface, TrimCurve, TrimLoop};
use perpend_knowledge::Record;
use ron::ser::PrettyConfig;

use crate::body::{Body, Shell};
use crate::entity::{Entity, Part};
use crate::file::data::FORMAT;
use crate::model::Model;

/// Lists are broken so that lines stay within this many characters where they can.
const WIDTH: usize = 120;

/// Writes the text of a model's file.
pub(super) fn write(model: &Model, out: impl Write) -> io::Result<()> {
    let mut out = io::BufWriter::new(out);
    writeln!(out, "Model(\n    format: {FORMAT},")?;
    writeln!(out, "    units: {:?},", model.units())?;
    writeln!(out, "    next_id: {},", model.next_id())?;
    if model.is_empty() {
        writeln!(out, "    entities: [],")?;
    } else {
        writeln!(out, "    entities: [")?;
        model.entities().iter().try_for_each(|one| entity(&mut out, one))?;
        model.bodies().iter().try_for_each(|one| body(&mut out, one))?;
        writeln!(out, "    ],")?;
    }
    writeln!(out, ")")?;
    out.flush()
}

fn entity(out: &mut impl Write, entity: &Entity) -> io::Result<()> {
    head(out, entity.id(), entity.name(), entity.colour())?;
    match &entity.part {
        Some(part) => trimmed(out, 12, entity.definition(), part)?,
        None => definition(out, 12, entity.definition())?,
    }
    if let Some(known) = entity.record() {
        record(out, 12, known)?;
    }
    if let Some(original) = entity.original() {
        writeln!(out, "            original: Some((")?;
        definition(out, 16, original.definition())?;
        if let Some(known) = original.record() {
            record(out, 16, known)?;
        }
        writeln!(out, "            )),")?;
    }
    writeln!(out, "        ),")
}

fn body(out: &mut impl Write, body: &Body) -> io::Result<()> {
    head(out, body.id(), body.name(), body.colour())?;
    writeln!(out, "            definition: Body(\n                shells: [")?;
    for Shell { faces, closed } in body.shells() {
        writeln!(out, "                    (")?;
        list(out, 24, "faces: [", faces.iter(), "],")?;
        writeln!(out, "                        closed: {closed},\n                    ),")?;
    }
    writeln!(out, "                ],\n            ),\n        ),")
}

/// What entities and bodies begin with.
fn head(out: &mut impl Write, id: EntityId, name: &str, colour: Option<[f64; 3]>) -> io::Result<()> {
    writeln!(out, "        (\n            id: {id},")?;
    writeln!(out, "            name: {},", ron::to_string(name).map_err(io::Error::other)?)?;
    match colour {
        Some(colour) => writeln!(out, "            colour: Some({}),", Point(DVec3::from_array(colour))),
        None => Ok(()),
    }
}

fn trimmed(out: &mut impl Write, indent: usize, definition: &Definition, part: &Part) -> io::Result<()> {
    let within = indent + 4;
    writeln!(out, "{:indent$}definition: TrimmedSurface(", "")?;
    write!(out, "{:within$}surface: ", "")?;
    match (part.carrier, definition) {
        (None, Definition::NurbsSurface(own)) => {
            write!(out, "Own(")?;
            surface(out, within + 4, own)?;
            writeln!(out, "{:within$})),", "")?;
        }
        (Some(id), _) => writeln!(out, "Ref({id}),")?,
        (None, Definition::NurbsCurve(_)) => unreachable!("what is trimmed is a surface"),
    }
    let trimming = &part.trimming;
    writeln!(out, "{:within$}reversed: {},", "", trimming.reversed())?;
    writeln!(out, "{:within$}tolerance: {},", "", Number(trimming.tolerance()))?;
    writeln!(out, "{:within$}loops: [", "")?;
    trimming.loops().iter().try_for_each(|one| trim_loop(out, within + 4, one))?;
    writeln!(out, "{:within$}],\n{:indent$}),", "", "")
}

fn trim_loop(out: &mut impl Write, indent: usize, one: &TrimLoop) -> io::Result<()> {
    let within = indent + 4;
    writeln!(out, "{:indent$}(\n{:within$}outer: {},\n{:within$}curves: [", "", "", one.outer, "")?;
    one.curves.iter().try_for_each(|curve| trim_curve(out, within + 4, curve))?;
    writeln!(out, "{:within$}],\n{:indent$}),", "", "")
}

fn trim_curve(out: &mut impl Write, indent: usize, TrimCurve { curve, edge }: &TrimCurve) -> io::Result<()> {
    let within = indent + 4;
    writeln!(out, "{:indent$}(\n{:within$}degree: {},", "", "", curve.degree())?;
    list(out, within, "knots: [", curve.knots().as_slice().iter().map(number), "],")?;
    list(out, within, "points: [", curve.points().map(Parameters), "],")?;
    if let Some(weights) = curve.weights() {
        list(out, within, "weights: Some([", weights.iter().map(number), "]),")?;
    }
    if let Some(edge) = edge {
        writeln!(out, "{:within$}edge: Some({edge}),", "")?;
    }
    writeln!(out, "{:indent$}),", "")
}

fn definition(out: &mut impl Write, indent: usize, definition: &Definition) -> io::Result<()> {
    write!(out, "{:indent$}definition: ", "")?;
    match definition {
        Definition::NurbsCurve(one) => curve(out, indent + 4, one)?,
        Definition::NurbsSurface(one) => surface(out, indent + 4, one)?,
    }
    writeln!(out, "{:indent$}),", "")
}

fn curve(out: &mut impl Write, indent: usize, curve: &NurbsCurve) -> io::Result<()> {
    writeln!(out, "NurbsCurve(\n{:indent$}degree: {},", "", curve.degree())?;
    list(out, indent, "knots: [", curve.knots().as_slice().iter().map(number), "],")?;
    list(out, indent, "control_points: [", curve.control_points().iter().map(point), "],")?;
    match curve.weights() {
        Some(weights) => list(out, indent, "weights: Some([", weights.iter().map(number), "]),"),
        None => Ok(()),
    }
}

fn surface(out: &mut impl Write, indent: usize, surface: &NurbsSurface) -> io::Result<()> {
    let ((p, q), row) = (surface.degree(), indent + 4);
    writeln!(out, "NurbsSurface(\n{:indent$}degree: ({p}, {q}),\n{:indent$}knots: (", "", "")?;
    for direction in [Direction::U, Direction::V] {
        list(out, row, "[", surface.knots(direction).as_slice().iter().map(number), "],")?;
    }
    writeln!(out, "{:indent$}),\n{:indent$}control_points: [", "", "")?;
    for points in surface.control_points().chunks(surface.columns()) {
        list(out, row, "[", points.iter().map(point), "],")?;
    }
    writeln!(out, "{:indent$}],", "")?;
    if let Some(weights) = surface.weights() {
        writeln!(out, "{:indent$}weights: Some([", "")?;
        for weights in weights.chunks(surface.columns()) {
            list(out, row, "[", weights.iter().map(number), "],")?;
        }
        writeln!(out, "{:indent$}]),", "")?;
    }
    Ok(())
}

/// A record is small: its layout is that of the RON writer, indented.
fn record(out: &mut impl Write, indent: usize, record: &Record) -> io::Result<()> {
    let config = PrettyConfig::new().depth_limit(3).separate_tuple_members(false).new_line("\n").indentor("    ");
    let text = ron::ser::to_string_pretty(record, config).map_err(io::Error::other)?;
    let mut lines = text.lines();
    write!(out, "{:indent$}knowledge: Some({}", "", lines.next().unwrap_or_default())?;
    lines.try_for_each(|line| write!(out, "\n{:indent$}{line}", ""))?;
    writeln!(out, "),")
}

/// A list on one line if it fits, else on lines of its own that are filled.
fn list<T: Display>(
    out: &mut impl Write,
    indent: usize,
    open: &str,
    items: impl Iterator<Item = T> + Clone,
    close: &str,
) -> io::Result<()> {
    let texts = items.map(|item| item.to_string());
    let mut length = indent + open.len() + close.len();
    let fits = texts.clone().all(|text| {
        length += text.len() + 2;
        length - 2 <= WIDTH
    });
    write!(out, "{:indent$}{open}", "")?;
    if fits {
        for (i, text) in texts.enumerate() {
            write!(out, "{}{text}", if i == 0 { "" } else { ", " })?;
        }
        return writeln!(out, "{close}");
    }
    let within = indent + 4;
    let mut column = usize::MAX;
    for text in texts {
        // an item, its comma and the space before it
        if column.saturating_add(text.len() + 2) > WIDTH {
            write!(out, "\n{:within$}{text},", "")?;
            column = within + text.len() + 1;
        } else {
            write!(out, " {text},")?;
            column += text.len() + 2;
        }
    }
    writeln!(out, "\n{:indent$}{close}", "")
}

fn number(value: &f64) -> impl Display {
    Number(*value)
}

fn point(p: &DVec3) -> impl Display {
    Point(*p)
}

struct Number(f64);

/// The shortest decimal that reads back bit for bit, always with a point or an exponent.
impl Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}", self.0)
    }
}

struct Point(DVec3);

impl Display for Point {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let DVec3 { x, y, z } = self.0;
        write!(f, "({x:?}, {y:?}, {z:?})")
    }
}

struct Parameters(DVec2);

impl Display for Parameters {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let DVec2 { x, y } = self.0;
        write!(f, "({x:?}, {y:?})")
    }
}
