//! Parts that nobody here wrote, imported whole: every face lies on the surface that another kernel gives it, and no distance is above that kernel's claim.
//!
//! The parts lie outside the repository: in `real` of the folder that the environment variable `PERPEND_SHARED` names, by default
//! `../shared` beside the workspace. Without them the test says so and passes.

#![allow(clippy::print_stderr, reason = "a test that skips says so aloud; the figures are wanted by readers")]

mod common;

use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use glam::DVec2;
use perpend::kernel::Side;
use perpend::{DVec3, Definition, Direction, Entity, NurbsSurface, Prepared, Query, QueryOptions, Scratch};
use perpend_step::{Import, ReadOptions, import_file};
use serde_json::Value;

/// A part: its folder and file, how many faces it has, and how many of them are of a known class.
const MODELS: [(&str, &str, usize, usize); 6] = [
    ("aero-assembly", "original.step", 507, 459),
    ("as1-assembly", "original.stp", 160, 90),
    ("iea15mw-blade", "original.stp", 3, 0),
    ("nist-ftc-06", "original.step", 187, 187),
    ("odri-lower-leg", "original.step", 329, 278),
    ("tigl-nacelle", "original.stp", 6, 0),
];

/// A face as the corpus has it.
struct CorpusFace {
    id: u64,
    prepared: Prepared,
    size: f64,
    /// How far the corpus' surface may be from the file's.
    off: f64,
    reversed: bool,
    tolerance: f64,
}

fn corpus_faces(folder: &Path) -> Vec<CorpusFace> {
    let text = std::fs::read_to_string(folder.join("corpus.json")).expect("a corpus");
    let json: Value = serde_json::from_str(&text).expect("JSON");
    let surfaces = json["entities"].as_array().expect("entities").iter().filter(|one| one["kind"] == "surface");
    surfaces
        .map(|json| {
            let surface = surface(json);
            let definition = Arc::new(Definition::from(surface));
            let number = |value: &Value| value.as_f64().unwrap_or(0.0);
            CorpusFace {
                id: json["id"].as_u64().expect("an id"),
                size: definition.size(),
                prepared: Prepared::new(definition, None),
                off: number(&json["nurbs_dev"]),
                reversed: json["orientation"] == "reversed",
                tolerance: number(&json["tolerance"])
                    .max(number(&json["trims"]["edge_tolerance"]))
                    .max(number(&json["trims"]["dev"])),
            }
        })
        .collect()
}

fn surface(json: &Value) -> NurbsSurface {
    let list = |json: &Value| json.as_array().expect("a list").clone();
    let numbers = |json: &Value| -> Vec<f64> { list(json).iter().map(|x| x.as_f64().expect("a number")).collect() };
    let degree = |key: &str| json[key].as_u64().expect("a degree") as usize;
    let point = |json: &Value| DVec3::from_slice(&numbers(json));
    let points = list(&json["points"]).iter().map(|row| list(row).iter().map(point).collect()).collect();
    let weights = (!json["weights"].is_null()).then(|| list(&json["weights"]).iter().map(numbers).collect());
    let knots = (numbers(&json["knots_u"]), numbers(&json["knots_v"]));
    NurbsSurface::new((degree("degree_u"), degree("degree_v")), knots, points, weights).expect("valid")
}

/// Points of an imported face, inside its trims.
fn samples(face: &Entity, count: usize) -> Vec<DVec3> {
    let Definition::NurbsSurface(surface) = &**face.definition() else { panic!("a face is a surface") };
    let region = face.trimming().expect("an imported face is trimmed").region();
    let (min, max) = region.bounds();
    let mut found = Vec::new();
    for i in 0..count {
        for j in 0..count {
            let share = DVec2::new((i as f64 + 0.5) / count as f64, (j as f64 + 0.5) / count as f64);
            let at = min + share * (max - min);
            if region.side(at) == Side::Inside {
                found.push(surface.point(at.x, at.y));
            }
        }
    }
    found
}

/// How far the points lie from a corpus surface at most.
fn deviation(points: &[DVec3], face: &CorpusFace, scratch: &mut Scratch) -> f64 {
    let distance = |p: &DVec3| {
        let query = Query::new(*p, QueryOptions::default()).expect("finite");
        face.prepared.project(&query, scratch).expect("no limit").distance
    };
    points.iter().map(distance).fold(0.0, f64::max)
}

#[test]
fn faces_lie_where_another_kernel_puts_them_and_no_distance_is_above_its_claim() {
    let Some(shared) = common::real() else { return };
    for (name, file, count, known) in MODELS {
        let folder = shared.join(name);
        let start = Instant::now();
        let Import { model, faces, known_faces, .. } =
            import_file(&folder.join(file), &ReadOptions::default()).expect("a STEP file");
        let took = start.elapsed();
        assert_eq!((faces, known_faces), (count, known), "{name}");
        let corpus = corpus_faces(&folder);
        let imported: Vec<&Entity> = model.entities().iter().filter(|entity| entity.trimming().is_some()).collect();
        assert_eq!(imported.len(), corpus.len(), "{name}");
        let mut scratch = Scratch::default();
        let (mut worst, mut of_corpus) = (0.0_f64, vec![usize::MAX; corpus.len()]);
        let mut turned = 0;
        for (k, face) in imported.iter().enumerate() {
            let points = [7, 41, 301].into_iter().map(|n| samples(face, n)).find(|points| points.len() > 8);
            let points = points.unwrap_or_else(|| panic!("{name}: nothing inside {}", face.name()));
            // the kernels list faces of assemblies in different orders
            let order = (0..corpus.len()).map(|step| (k + step) % corpus.len());
            let at = order.filter(|at| !of_corpus.contains(&usize::MAX) || !of_corpus[..k].contains(at)).find(|at| {
                deviation(&points[..3.min(points.len())], &corpus[*at], &mut scratch)
                    <= 1e-9 * corpus[*at].size + corpus[*at].off
                    && is_same_part(face, &corpus[*at])
            });
            let at = at.unwrap_or_else(|| panic!("{name}: no surface of the corpus holds {}", face.name()));
            of_corpus[k] = at;
            let off = deviation(&points, &corpus[at], &mut scratch);
            worst = worst.max((off - corpus[at].off) / corpus[at].size);
            assert!(off <= 1e-9 * corpus[at].size + corpus[at].off, "{name}: {} is {off:e} off", face.name());
            turned += usize::from(normals_differ(face, &corpus[at], &points, &mut scratch));
        }
        eprintln!("{name}: imported in {took:?}; faces off by {worst:.1e} of their size at most; {turned} turned");
        assert_eq!(turned, 0, "{name}: outward normals");
        let ids: Vec<u64> = of_corpus.iter().map(|at| corpus[*at].id).collect();
        compare_claims(name, &folder, &model, &imported, &ids, &corpus);
    }
}

/// Faces of one plane or cylinder are told apart by where their trims are.
fn is_same_part(face: &Entity, corpus: &CorpusFace) -> bool {
    let bounds = face.prepared().bounds();
    let other = corpus.prepared.definition().control_box();
    let room = 1e-6 * corpus.size + corpus.tolerance;
    bounds.centre().cmpge(other.min - room).all() && bounds.centre().cmple(other.max + room).all()
}

/// Whether the outward normals of the two disagree.
fn normals_differ(face: &Entity, corpus: &CorpusFace, points: &[DVec3], scratch: &mut Scratch) -> bool {
    let mut agreeing = 0_i64;
    for p in points.iter().take(20) {
        let query = Query::new(*p, QueryOptions::default()).expect("finite");
        let ours = face.prepared().project(&query, scratch).and_then(|foot| foot.normal);
        let theirs = corpus.prepared.project(&query, scratch).and_then(|foot| foot.normal);
        if let (Some(ours), Some(theirs)) = (ours, theirs) {
            let theirs = if corpus.reversed { -theirs } else { theirs };
            agreeing += if ours.dot(theirs) > 0.0 { 1 } else { -1 };
        }
    }
    agreeing < 0
}

fn compare_claims(
    name: &str,
    folder: &Path,
    model: &perpend::Model,
    imported: &[&Entity],
    ids: &[u64],
    corpus: &[CorpusFace],
) {
    let text = std::fs::read_to_string(folder.join("occt-claim.csv")).expect("claims");
    let options = QueryOptions::default();
    let (mut compared, mut whole, mut inside, mut nearer, mut farthest) = (0, 0, 0, 0, f64::NEG_INFINITY);
    let mut scratch = Scratch::default();
    for line in text.lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        let number = |k: usize| fields[k].parse::<f64>().ok();
        let p = DVec3::new(number(1).expect("x"), number(2).expect("y"), number(3).expect("z"));
        let id: u64 = fields[0].parse().expect("an id");
        let Some(k) = ids.iter().position(|other| *other == id) else { continue };
        let tolerance = corpus.iter().map(|face| face.tolerance).fold(0.0, f64::max);
        let own = corpus.iter().find(|face| face.id == id).map_or(0.0, |face| face.tolerance + face.off);
        if let Some(claim) = number(8) {
            let foot = imported[k]
                .prepared()
                .project(&Query::new(p, options).expect("finite"), &mut scratch)
                .expect("no limit");
            farthest = farthest.max(foot.distance - claim);
            let allowed = own.max(imported[k].trimming().expect("trimmed").tolerance());
            assert!(
                foot.distance <= claim + allowed,
                "{name}: {} is {} away and not {claim}",
                imported[k].name(),
                foot.distance
            );
            if foot.distance < claim - allowed {
                nearer += 1;
                let Definition::NurbsSurface(surface) = &**imported[k].definition() else { panic!("a surface") };
                let (u, v) = (foot.parameter.u(), foot.parameter.v().expect("a surface"));
                assert!(surface.point(u, v).distance(p) <= claim, "{name}: a real point");
                let hair = [Direction::U, Direction::V].map(|along| surface.domain(along)).map(|(a, b)| 1e-9 * (b - a));
                let region = imported[k].trimming().expect("trimmed").region();
                let is_inside = (-1..=1).any(|i| {
                    (-1..=1).any(|j| {
                        region.side(DVec2::new(u + f64::from(i) * hair[0], v + f64::from(j) * hair[1])) != Side::Outside
                    })
                });
                assert!(is_inside, "{name}: trimmed away");
            }
            compared += 1;
        }
        if let Some(claim) = number(13) {
            if claim == 0.0 {
                // inside a solid, for that kernel
                let side = |body: &perpend::Body| model.signed_distance(body.id(), p, &options);
                let is_inside = model
                    .bodies()
                    .iter()
                    .filter_map(|body| side(body).ok())
                    .any(|foot| foot.signed_distance <= tolerance);
                assert!(is_inside, "{name}: {p} lies inside a solid");
                inside += 1;
                continue;
            }
            let (_, foot) = model.nearest(p, &options).expect("finite").expect("no limit");
            assert!(foot.distance <= claim + tolerance, "{name}: the model is {} away and not {claim}", foot.distance);
            whole += 1;
        }
    }
    eprintln!(
        "  {compared} claims for faces, {whole} for the whole, {inside} inside a solid; ours farther by {farthest:.1e} at most, nearer by more than the tolerance {nearer} times"
    );
    assert!(compared > 0);
}
