//! Readers of the test sets: entities as JSON, points and distances as CSV.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use glam::DVec3;
use serde_json::Value;

use super::shape::Shape;

/// An entity of a set.
pub struct Entry {
    pub id: u64,
    pub name: String,
    pub shape: Shape,
}

/// The folder of the sets that were made for this project.
pub fn data() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data")
}

/// The folder of the real models: `real` in the folder that `PERPEND_SHARED` names, by default `shared` beside the workspace.
pub fn real() -> PathBuf {
    let shared = std::env::var_os("PERPEND_SHARED").map(PathBuf::from);
    shared.unwrap_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared")).join("real")
}

/// The entities of a JSON file.
pub fn entities(file: &Path) -> Vec<Entry> {
    let text = std::fs::read_to_string(file).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
    let json: Value = serde_json::from_str(&text).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
    json["entities"].as_array().expect("a list of entities").iter().map(entry).collect()
}

fn entry(json: &Value) -> Entry {
    let number = |key: &str| json[key].as_u64().unwrap_or_else(|| panic!("{key} of {}", json["name"]));
    let degree = |key: &str| usize::try_from(number(key)).expect("a small degree");
    let shape = match json["kind"].as_str() {
        Some("curve") => Shape::curve(
            degree("degree"),
            numbers(&json["knots"]),
            list(&json["points"]).iter().map(point).collect(),
            (!json["weights"].is_null()).then(|| numbers(&json["weights"])),
        ),
        _ => Shape::surface(
            [degree("degree_u"), degree("degree_v")],
            [numbers(&json["knots_u"]), numbers(&json["knots_v"])],
            list(&json["points"]).iter().flat_map(list).map(point).collect(),
            (!json["weights"].is_null()).then(|| list(&json["weights"]).iter().flat_map(numbers).collect()),
        ),
    };
    Entry { id: number("id"), name: json["name"].as_str().unwrap_or_default().to_owned(), shape }
}

fn list(json: &Value) -> &[Value] {
    json.as_array().expect("a list")
}

fn numbers(json: &Value) -> Vec<f64> {
    list(json).iter().map(|x| x.as_f64().expect("a number")).collect()
}

fn point(json: &Value) -> DVec3 {
    DVec3::from_slice(&numbers(json))
}

/// A row of a CSV file: the entity, the point, and the other columns by name, empty ones left out.
pub struct Row {
    pub entity: u64,
    pub point: DVec3,
    columns: HashMap<String, f64>,
}

impl Row {
    pub fn get(&self, column: &str) -> Option<f64> {
        self.columns.get(column).copied()
    }

    /// The distance that the file gives.
    pub fn distance(&self) -> f64 {
        self.columns["distance"]
    }
}

/// The rows of a CSV file.
pub fn rows(file: &Path) -> Vec<Row> {
    parse(&std::fs::read_to_string(file).unwrap_or_else(|e| panic!("{}: {e}", file.display())))
}

/// The rows of a CSV text with a header; columns that hold no number are left out.
pub fn parse(text: &str) -> Vec<Row> {
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().expect("a header").split(',').collect();
    let row = |line: &str| {
        let numbers = line.split(',').map(|field| field.parse::<f64>().ok());
        let named = header.iter().zip(numbers).filter_map(|(name, x)| Some(((*name).to_owned(), x?)));
        let columns: HashMap<String, f64> = named.collect();
        let point = DVec3::new(columns["x"], columns["y"], columns["z"]);
        Row { entity: columns["entity"] as u64, point, columns }
    };
    lines.filter(|line| !line.is_empty()).map(row).collect()
}
