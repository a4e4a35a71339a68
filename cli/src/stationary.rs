//! `perpend stationary`: all stationary points of the distance from a point to an entity.

use std::fmt::Write as _;
use std::process::ExitCode;

use perpend::{Continuum, EntityId, ParameterBox, StationaryOptions, StationaryPoint, StationaryPoints};
use serde::Serialize;

use crate::args::StationaryArguments;
use crate::error::CommandError;
use crate::names;
use crate::report::{self, counted, rounded};

pub(crate) fn run(arguments: &StationaryArguments) -> Result<ExitCode, CommandError> {
    let model = arguments.trust.read(&arguments.model)?;
    let id = arguments.entity;
    if model.entity(id).is_none() {
        return Err(CommandError::unknown_entity(arguments.model.clone(), &model, id));
    }
    let options = StationaryOptions { tolerance: arguments.tolerance, ..StationaryOptions::default() };
    let found = model.stationary_points(id, arguments.point, &options)?;
    let text = if arguments.json { json(arguments, &found) } else { words(&found, model.units().symbol()) };
    report::answer(text.as_bytes())?;
    Ok(ExitCode::SUCCESS)
}

#[derive(Serialize)]
struct Listing<'a> {
    id: EntityId,
    point: [f64; 3],
    stationary: Vec<PointForm>,
    continua: Vec<&'a [ParameterBox]>,
    complete: bool,
}

#[derive(Serialize)]
struct PointForm {
    u: f64,
    v: Option<f64>,
    point: [f64; 3],
    distance: f64,
    kind: Option<&'static str>,
    place: &'static str,
    descends_inward: bool,
    certainty: &'static str,
    range: ParameterBox,
}

impl PointForm {
    fn of(point: &StationaryPoint) -> Self {
        Self {
            u: point.parameter.u(),
            v: point.parameter.v(),
            point: point.point.to_array(),
            distance: point.distance,
            kind: point.kind.map(names::extremum),
            place: names::place(point.place),
            descends_inward: point.descends_inward,
            certainty: names::certainty(point.certainty),
            range: point.range,
        }
    }
}

fn json(arguments: &StationaryArguments, found: &StationaryPoints) -> String {
    let listing = Listing {
        id: arguments.entity,
        point: arguments.point.to_array(),
        stationary: found.points.iter().map(PointForm::of).collect(),
        continua: found.continua.iter().map(|continuum| &continuum.boxes[..]).collect(),
        complete: found.complete,
    };
    let mut text = serde_json::to_string_pretty(&listing).expect("plain data with names for keys");
    text.push('\n');
    text
}

fn words(found: &StationaryPoints, unit: &str) -> String {
    let mut rows = vec![["kind", "place", "u", "v", "distance", "certainty"].map(str::to_owned)];
    rows[0][4] = format!("distance/{unit}");
    for point in &found.points {
        let inward = if point.descends_inward { ", falls inward" } else { "" };
        rows.push([
            point.kind.map_or("unknown", names::extremum).to_owned(),
            format!("{}{inward}", names::place(point.place)),
            rounded(point.parameter.u()),
            point.parameter.v().map_or_else(|| "-".to_owned(), rounded),
            rounded(point.distance),
            names::certainty(point.certainty).to_owned(),
        ]);
    }
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..6).map(width).collect();
    let mut text = String::new();
    for row in &rows {
        let line: Vec<String> = row.iter().zip(&widths).map(|(field, width)| format!("{field:<width$}")).collect();
        let _ = writeln!(text, "{}", line.join("  ").trim_end());
    }
    for Continuum { boxes } in &found.continua {
        let hull = |range: fn(&ParameterBox) -> (f64, f64)| {
            boxes.iter().map(range).fold((f64::MAX, f64::MIN), |(low, high), (from, to)| (low.min(from), high.max(to)))
        };
        let (u, v) = (hull(|b| b.u), hull(|b| b.v));
        let boxes = counted(boxes.len() as u64, "box").replace("boxs", "boxes");
        let v = if v == (0.0, 0.0) { String::new() } else { format!(", v {} to {}", rounded(v.0), rounded(v.1)) };
        let _ = writeln!(text, "continuum  u {} to {}{v} ({boxes})", rounded(u.0), rounded(u.1));
    }
    let _ = writeln!(
        text,
        "{}",
        if found.complete {
            "complete: everywhere else is proven to hold none"
        } else {
            "the work bound was met: parts of the continua may hold none, and everywhere else is proven to hold none"
        }
    );
    text
}
