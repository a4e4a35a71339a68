//! Faces of models that nobody here wrote, beside what another kernel made of them.
//!
//! The models lie outside the repository: in `real` of the folder that the environment variable `PERPEND_SHARED` names, by default
//! `../shared` beside the workspace. Without them the test says so and passes.

#![allow(clippy::print_stderr, reason = "a test that skips says so aloud; the counts are wanted by readers")]

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::{DVec2, DVec3};
use perpend::kernel::{PlaneCurve, Side, TrimCurveData, TrimLoopData, Trimming, TrimmingData};
use perpend::{Definition, Frame, NurbsCurve, NurbsSurface, Prepared, Query, Scratch};
use serde_json::Value;

use super::area::area;
use crate::face::{BuiltFace, build, edge_curve};
use crate::source::{SourceCurve, SourceEdge, SourceFace, SourceLoop, SourceSurface, SourceUse};

/// What another kernel says of a face.
struct Expected {
    name: String,
    surface: NurbsSurface,
    trimming: Trimming,
    area: f64,
    edge_tolerance: f64,
}

pub(super) fn real() -> PathBuf {
    let shared = std::env::var_os("PERPEND_SHARED").map(PathBuf::from);
    shared.unwrap_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared")).join("real")
}

fn number(json: &Value) -> f64 {
    json.as_f64().expect("a number")
}

fn numbers(json: &Value) -> Vec<f64> {
    json.as_array().expect("a list").iter().map(number).collect()
}

fn point(json: &Value) -> DVec3 {
    let [x, y, z] = numbers(json)[..] else { panic!("three coordinates") };
    DVec3::new(x, y, z)
}

fn frame(params: &Value) -> Frame {
    let origin = if params["origin"].is_null() { &params["center"] } else { &params["origin"] };
    Frame::new(point(origin), point(&params["axis"]), point(&params["xdir"])).expect("a frame")
}

fn nurbs_curve(json: &Value) -> NurbsCurve {
    let points = json["points"].as_array().expect("points").iter().map(point).collect();
    let weights = (!json["weights"].is_null()).then(|| numbers(&json["weights"]));
    let degree = json["degree"].as_u64().expect("a degree") as usize;
    NurbsCurve::new(degree, numbers(&json["knots"]), points, weights).expect("a curve")
}

fn nurbs_surface(json: &Value) -> NurbsSurface {
    let rows = |json: &Value| json.as_array().expect("rows").clone();
    let points = rows(&json["points"]).iter().map(|row| rows(row).iter().map(point).collect()).collect();
    let weights = (!json["weights"].is_null()).then(|| rows(&json["weights"]).iter().map(numbers).collect());
    let degree = |key: &str| json[key].as_u64().expect("a degree") as usize;
    let degrees = (degree("degree_u"), degree("degree_v"));
    NurbsSurface::new(degrees, (numbers(&json["knots_u"]), numbers(&json["knots_v"])), points, weights)
        .expect("a surface")
}

fn curve(kind: &str, params: &Value, nurbs: impl Fn() -> NurbsCurve) -> SourceCurve {
    match kind {
        "line" => SourceCurve::Line { point: point(&params["origin"]), direction: point(&params["direction"]) },
        "circle" => SourceCurve::Circle { frame: frame(params), radius: number(&params["radius"]) },
        _ => SourceCurve::Nurbs(nurbs()),
    }
}

fn surface(json: &Value) -> SourceSurface {
    let params = &json["origin_params"];
    match json["origin_type"].as_str().expect("a type") {
        "plane" => SourceSurface::Plane(frame(params)),
        "cylinder" => SourceSurface::Cylinder { frame: frame(params), radius: number(&params["radius"]) },
        "cone" => SourceSurface::Cone {
            frame: frame(params),
            radius: number(&params["ref_radius"]),
            half_angle: number(&params["semi_angle"]),
        },
        "sphere" => SourceSurface::Sphere { frame: frame(params), radius: number(&params["radius"]) },
        "torus" => SourceSurface::Torus {
            frame: frame(params),
            major: number(&params["major_radius"]),
            minor: number(&params["minor_radius"]),
        },
        "revolution" => {
            let basis = &params["basis"];
            let kind = basis["type"].as_str().expect("a type");
            let profile = curve(kind, &basis["params"], || nurbs_curve(&basis["nurbs"]));
            SourceSurface::Revolution { profile, point: point(&params["origin"]), axis: point(&params["axis"]) }
        }
        _ => SourceSurface::Nurbs(nurbs_surface(json)),
    }
}

fn edge(json: &Value) -> SourceEdge {
    let nurbs = nurbs_curve(json);
    let (first, last) = nurbs.domain();
    let (start, end) = (nurbs.point(first), nurbs.point(last));
    let tolerance = number(&json["tolerance"]);
    SourceEdge {
        entity: json["id"].as_u64().expect("an id"),
        curve: curve(json["origin_type"].as_str().expect("a type"), &json["origin_params"], || nurbs.clone()),
        start,
        end,
        closed: start.distance(end) <= tolerance
            && nurbs.point(0.5 * (first + last)).distance(start) > 10.0 * tolerance,
        same_sense: true,
    }
}

fn flat(json: &Value) -> TrimCurveData {
    let plane = |json: &Value| DVec2::new(number(&json[0]), number(&json[1]));
    TrimCurveData {
        degree: json["degree"].as_u64().expect("a degree") as usize,
        knots: numbers(&json["knots"]),
        points: json["points"].as_array().expect("points").iter().map(plane).collect(),
        weights: (!json["weights"].is_null()).then(|| numbers(&json["weights"])),
        edge: None,
    }
}

fn plane_curve(data: &TrimCurveData) -> PlaneCurve {
    PlaneCurve::new(data.degree, data.knots.clone(), data.points.clone(), data.weights.clone()).expect("a p-curve")
}

/// Edges, and faces with what is expected of them.
type Part = (Vec<SourceEdge>, Vec<(SourceFace, Expected)>);

fn part(file: &Path) -> Part {
    let text = std::fs::read_to_string(file).expect("the corpus is readable");
    let json: Value = serde_json::from_str(&text).expect("the corpus is JSON");
    let all = json["entities"].as_array().expect("entities");
    let is = |kind: &'static str| all.iter().filter(move |one| one["kind"] == kind);
    if is("surface").all(|one| one["trims"].is_null()) {
        return (Vec::new(), Vec::new());
    }
    let edges: Vec<SourceEdge> = is("curve").map(edge).collect();
    let index: HashMap<u64, usize> = edges.iter().enumerate().map(|(i, edge)| (edge.entity, i)).collect();
    let faces = is("surface").filter(|one| !one["trims"].is_null()).map(|one| face(one, &edges, &index)).collect();
    (edges, faces)
}

fn face(json: &Value, edges: &[SourceEdge], index: &HashMap<u64, usize>) -> (SourceFace, Expected) {
    let carrier = nurbs_surface(json);
    let same_sense = json["orientation"] == "forward";
    let trims = &json["trims"];
    let (mut loops, mut data) = (Vec::new(), Vec::new());
    for one in trims["loops"].as_array().expect("loops") {
        let (mut uses, mut curves) = (Vec::new(), Vec::new());
        for curve in one["curves"].as_array().expect("curves") {
            let trim = flat(curve);
            let plane = plane_curve(&trim);
            curves.push(trim);
            let Some(id) = curve["edge"].as_u64() else { continue };
            let (a, b) = plane.domain();
            let at = |share: f64| {
                let uv = plane.point(a + share * (b - a));
                carrier.point(uv.x, uv.y)
            };
            let edge_at = nurbs_of(&edges[index[&id]]);
            let (c, d) = edge_at.domain();
            let on = |share: f64| edge_at.point(c + share * (d - c));
            let apart = |forward: bool| -> f64 {
                let share = |s: f64| if forward { s } else { 1.0 - s };
                [0.0, 0.25, 0.75, 1.0].map(|s| at(s).distance(on(share(s)))).iter().sum()
            };
            uses.push(SourceUse { edge: index[&id], forward: apart(true) < apart(false), pcurve: None });
        }
        // a file's loops have the material on the left seen from outside
        if !same_sense {
            uses.reverse();
            uses.iter_mut().for_each(|one| one.forward = !one.forward);
        }
        let outer = one["outer"].as_bool().expect("outer");
        loops.push(SourceLoop::Edges { outer, uses });
        data.push(TrimLoopData { outer, curves });
    }
    let size = carrier.control_box().diagonal();
    let edge_tolerance = number(&trims["edge_tolerance"]);
    let data = TrimmingData { reversed: !same_sense, tolerance: 0.02 * size, loops: data };
    let expected = Expected {
        name: json["name"].as_str().expect("a name").to_owned(),
        trimming: Trimming::enter(data, &carrier).expect("a trim").0,
        surface: carrier,
        area: number(&json["area"]),
        edge_tolerance,
    };
    let source = SourceFace {
        entity: json["id"].as_u64().expect("an id"),
        name: expected.name.clone(),
        surface: surface(json),
        same_sense,
        loops,
        colour: None,
    };
    (source, expected)
}

fn nurbs_of(edge: &SourceEdge) -> NurbsCurve {
    edge_curve(edge, 1e-6).expect("an edge")
}

/// The areas that the other kernel gives for the faces of a model.
pub(super) fn areas(file: &Path) -> Vec<f64> {
    let text = std::fs::read_to_string(file).expect("the corpus is readable");
    let json: Value = serde_json::from_str(&text).expect("the corpus is JSON");
    json["entities"].as_array().expect("entities").iter().filter_map(|one| one["area"].as_f64()).collect()
}

/// What is wrong with a face that was built; none where nothing is.
fn complaint(built: &BuiltFace, expected: &Expected, curves: &[NurbsCurve]) -> Option<String> {
    let size = expected.surface.control_box().diagonal();
    let data = TrimmingData {
        reversed: built.reversed,
        tolerance: built.tolerance,
        loops: built
            .loops
            .iter()
            .map(|one| TrimLoopData {
                outer: one.outer,
                curves: one.curves.iter().map(|(curve, _)| curve.clone()).collect(),
            })
            .collect(),
    };
    let (trimming, entry) = match Trimming::enter(data, &built.surface) {
        Ok(entered) => entered,
        Err(error) => return Some(format!("trim refused: {error}")),
    };
    if entry.clamped != [0.0; 2] && entry.clamped.iter().any(|share| *share > 1e-3) {
        return Some(format!("clamped by {:?}", entry.clamped));
    }
    // images of p-curves on their edges
    let limit = (2.0 * expected.edge_tolerance).max(2e-7 * size);
    let mut worst = 0.0_f64;
    for (curve, edge) in built.loops.iter().flat_map(|one| &one.curves) {
        let Some(edge) = edge else { continue };
        let plane = plane_curve(curve);
        let (a, b) = plane.domain();
        for k in 0..=24 {
            let uv = plane.point(a + (b - a) * f64::from(k) / 24.0);
            worst = worst.max(distance(&curves[*edge], built.surface.point(uv.x, uv.y)));
        }
    }
    if worst > limit {
        return Some(format!("p-curves {worst:e} off their edges, {limit:e} allowed"));
    }
    let loops: Vec<Vec<PlaneCurve>> =
        trimming.loops().iter().map(|one| one.curves.iter().map(|curve| curve.curve.clone()).collect()).collect();
    // regions
    let prepared = Prepared::new(Arc::new(Definition::from(built.surface.clone())), None);
    let mut scratch = Scratch::default();
    let (min, max) = expected.trimming.region().bounds();
    let (mut inside, mut seen) = (0, 0);
    for i in 0..16 {
        for j in 0..16 {
            let share = DVec2::new((f64::from(i) + 0.513) / 16.0, (f64::from(j) + 0.487) / 16.0);
            let uv = min + share * (max - min);
            let p = expected.surface.point(uv.x, uv.y);
            let is_inside = match expected.trimming.region().side(uv) {
                Side::Inside => true,
                Side::Outside => false,
                Side::Boundary => continue,
            };
            let mut of_loops = built.loops.iter().flat_map(|one| &one.curves).filter_map(|(_, edge)| *edge);
            let is_near = |edge: usize| {
                let curve = &curves[edge];
                coarse_distance(curve, p) < 0.05 * size && distance(curve, p) < 1e-3 * size
            };
            if of_loops.any(is_near) {
                continue;
            }
            let query = Query::new(p, Default::default()).expect("a query");
            let foot = prepared.project(&query, &mut scratch).expect("a foot");
            seen += 1;
            inside += usize::from(is_inside);
            if is_inside && foot.distance > 1e-9 * size {
                return Some(format!(
                    "a point of the face lies {:e} off the carrier, {:e} of its size",
                    foot.distance,
                    foot.distance / size
                ));
            }
            if foot.distance > 1e-9 * size {
                continue;
            }
            let at = DVec2::new(foot.parameter.u(), foot.parameter.v().expect("a surface"));
            if (trimming.region().side(at) == Side::Inside) != is_inside {
                return Some(format!(
                    "the point of ({}, {}) should be {}",
                    uv.x,
                    uv.y,
                    if is_inside { "inside" } else { "outside" }
                ));
            }
            let sign = |reversed: bool| if reversed { -1.0 } else { 1.0 };
            let mine = sign(built.reversed) * built.surface.normal(at.x, at.y).normalize_or_zero();
            let theirs = sign(expected.trimming.reversed()) * expected.surface.normal(uv.x, uv.y).normalize_or_zero();
            if is_inside && mine.dot(theirs) < 0.9 {
                return Some(format!("the outward normal is another: {}", mine.dot(theirs)));
            }
        }
    }
    let found = area(&built.surface, &loops);
    let theirs: Vec<Vec<PlaneCurve>> = expected
        .trimming
        .loops()
        .iter()
        .map(|one| one.curves.iter().map(|curve| curve.curve.clone()).collect())
        .collect();
    // the other kernel integrates less well than it trims: its number, or what its trims give here
    let areas = [expected.area, area(&expected.surface, &theirs)];
    if areas.iter().all(|area| (found - area).abs() > 1e-3 * area) {
        return Some(format!("area {found}, {areas:?} expected ({inside} of {seen} points inside)"));
    }
    for (one, data) in loops.iter().zip(&built.loops) {
        let signed: f64 = one
            .iter()
            .flat_map(|curve| {
                let (a, b) = curve.domain();
                (0..64).map(move |k| {
                    let at = |k: i32| curve.point(a + (b - a) * f64::from(k) / 64.0);
                    0.5 * at(k).perp_dot(at(k + 1))
                })
            })
            .sum();
        if (signed > 0.0) != data.outer {
            return Some("a loop runs the wrong way".to_owned());
        }
    }
    None
}

/// The distance of a point from the nearest of some points of a curve.
fn coarse_distance(curve: &NurbsCurve, p: DVec3) -> f64 {
    let ((a, b), count) = (curve.domain(), curve.knots().spans().count() * 8);
    (0..=count).map(|k| curve.point(a + (b - a) * k as f64 / count as f64).distance(p)).fold(f64::INFINITY, f64::min)
}

/// The distance of a point from a curve, within some 1e-12 of its size.
fn distance(curve: &NurbsCurve, p: DVec3) -> f64 {
    let (a, b) = curve.domain();
    let count = (curve.knots().spans().count() * 12).max(48);
    let at = |k: usize| a + (b - a) * k as f64 / count as f64;
    let apart = |t: f64| curve.point(t).distance(p);
    let nearest = (0..=count).min_by(|i, j| apart(at(*i)).total_cmp(&apart(at(*j)))).expect("samples");
    let (mut low, mut high) = (at(nearest.saturating_sub(1)), at((nearest + 1).min(count)));
    for _ in 0..60 {
        let (c, d) = (low + 0.382 * (high - low), low + 0.618 * (high - low));
        if apart(c) < apart(d) { high = d } else { low = c }
    }
    apart(0.5 * (low + high)).min(apart(at(nearest)))
}

#[test]
fn faces_of_real_models_are_those_of_another_kernel() {
    let folder = real();
    if !folder.is_dir() {
        eprintln!("skipped: {} is absent", folder.display());
        return;
    }
    let mut lost = Vec::new();
    let mut folders: Vec<PathBuf> =
        std::fs::read_dir(&folder).expect("a folder").map(|one| one.expect("an entry").path()).collect();
    folders.sort();
    let only = std::env::var("PERPEND_MODEL").ok();
    for model in folders.iter().filter(|model| model.join("corpus.json").is_file()) {
        let name = model.file_name().expect("a name").to_string_lossy().into_owned();
        if only.as_ref().is_some_and(|only| !name.starts_with(only)) {
            continue;
        }
        let (edges, faces) = part(&model.join("corpus.json"));
        if faces.is_empty() {
            continue;
        }
        let tolerance = 1e-6;
        let start = std::time::Instant::now();
        let made: Vec<_> = edges.iter().map(|edge| edge_curve(edge, tolerance)).collect();
        let built: Vec<_> = faces.iter().map(|(face, _)| build(face, &edges, &made, tolerance)).collect();
        let time = start.elapsed();
        let curves: Vec<NurbsCurve> = edges.iter().map(nurbs_of).collect();
        let before = lost.len();
        for (built, (_, expected)) in built.iter().zip(&faces) {
            let complaint = match built {
                Ok(built) => complaint(built, expected, &curves),
                Err(error) => Some(error.to_string()),
            };
            lost.extend(complaint.map(|complaint| format!("{name} {}: {complaint}", expected.name)));
        }
        eprintln!("{name}: {} of {} faces, built in {time:?}", faces.len() - (lost.len() - before), faces.len());
    }
    assert!(lost.is_empty(), "{} faces are not as they should be:\n{}", lost.len(), lost.join("\n"));
}
