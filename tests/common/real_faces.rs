//! The trimmed faces of the real models.

use std::path::Path;

use glam::DVec2;
use perpend_kernel::{EntityId, TrimCurveData, TrimLoopData, TrimmingData};
use serde_json::Value;

use super::corpus;
use super::shape::Shape;

/// A face as its file has it.
pub struct RealFace {
    pub id: u64,
    pub name: String,
    pub shape: Shape,
    pub trimming: TrimmingData,
    /// How far the file's edges lie from its p-curves, in the model's unit.
    pub trim_tolerance: f64,
}

/// The faces of a model that have trims, in the file's order.
pub fn faces(folder: &Path) -> Vec<RealFace> {
    let file = folder.join("corpus.json");
    let text = std::fs::read_to_string(&file).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
    let json: Value = serde_json::from_str(&text).unwrap_or_else(|e| panic!("{}: {e}", file.display()));
    let entries = corpus::entities(&file);
    let faces = json["entities"].as_array().expect("a list of entities").iter().zip(entries);
    faces
        .filter(|(json, _)| !json["trims"].is_null())
        .map(|(json, entry)| {
            let trims = &json["trims"];
            let loops = trims["loops"].as_array().expect("a list of loops");
            let loops: Vec<TrimLoopData> = loops.iter().map(trim_loop).collect();
            let promised = trims["edge_tolerance"].as_f64().unwrap_or(0.0);
            let gap = loops.iter().map(|one| widest_gap(one, &entry.shape)).fold(0.0, f64::max);
            let tolerance = promised.max(1.001 * gap).max(json["tolerance"].as_f64().unwrap_or(0.0));
            let trimming = TrimmingData { reversed: json["orientation"] == "reversed", tolerance, loops };
            let trim_tolerance = tolerance.max(trims["dev"].as_f64().unwrap_or(0.0));
            RealFace { id: entry.id, name: entry.name, shape: entry.shape, trimming, trim_tolerance }
        })
        .collect()
}

/// How far apart in space the ends of neighbouring p-curves are at most. The file's own `closed_gap` is a length in the parameter plane.
fn widest_gap(one: &TrimLoopData, shape: &Shape) -> f64 {
    let inside = |uv: DVec2| [0, 1].map(|k| uv[k].clamp(shape.domain(k)[0], shape.domain(k)[1]));
    let point = |uv: DVec2| {
        let [u, v] = inside(uv);
        shape.point(u, v)
    };
    let count = one.curves.len();
    let gap = |k: usize| {
        let (before, this) = (&one.curves[k].points, &one.curves[(k + 1) % count].points);
        point(before[before.len() - 1]).distance(point(this[0]))
    };
    (0..count).map(gap).fold(0.0, f64::max)
}

fn trim_loop(json: &Value) -> TrimLoopData {
    let curves = json["curves"].as_array().expect("a list of p-curves");
    TrimLoopData { outer: json["outer"] == true, curves: curves.iter().map(trim_curve).collect() }
}

fn trim_curve(json: &Value) -> TrimCurveData {
    let numbers = |json: &Value| -> Vec<f64> {
        json.as_array().expect("a list").iter().map(|x| x.as_f64().expect("a number")).collect()
    };
    TrimCurveData {
        degree: usize::try_from(json["degree"].as_u64().expect("a degree")).expect("a small degree"),
        knots: numbers(&json["knots"]),
        points: json["points"].as_array().expect("a list").iter().map(|p| DVec2::from_slice(&numbers(p))).collect(),
        weights: (!json["weights"].is_null()).then(|| numbers(&json["weights"])),
        edge: json["edge"].as_u64().map(EntityId::new),
    }
}
