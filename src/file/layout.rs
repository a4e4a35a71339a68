//! How a model's file is laid out.
//!
//! One field a line; numbers fill lines; a row of a net begins a line. Floats are the shortest decimals that read back bit
//! for bit.

use std::fmt::{self, Display};
use std::io::{self, Write};

use glam::DVec3;
use perpend_kernel::{Definition, Direction, NurbsCurve, NurbsSurface};
use perpend_knowledge::Record;
use ron::ser::PrettyConfig;

use crate::entity::Entity;
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
        writeln!(out, "    ],")?;
    }
    writeln!(out, ")")?;
    out.flush()
}

fn entity(out: &mut impl Write, entity: &Entity) -> io::Result<()> {
    writeln!(out, "        (\n            id: {},", entity.id())?;
    writeln!(out, "            name: {},", ron::to_string(entity.name()).map_err(io::Error::other)?)?;
    definition(out, 12, entity.definition())?;
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
