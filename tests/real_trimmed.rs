//! The trimmed faces of models that nobody here wrote: all are accepted, no real point of a face is nearer than an answer says, and where another kernel's claim is farther, the
//! answer's point is shown to lie inside the trims.
//!
//! The models lie outside the repository, as for the other tests of real models; without them the test says so and passes. The variable
//! `PERPEND_QUERIES` says how many random queries are asked over all models (by default a few thousand); `PERPEND_MODEL` names one model.

#![allow(clippy::print_stderr, reason = "a test that skips says so aloud; the tables are wanted by readers")]

mod common;

#[path = "trimmed/hard_points.rs"]
mod hard_points;

use std::collections::{BTreeMap, HashMap};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use common::corpus;
use common::face_judgement::{FaceFault, OUTSIDE, judge_on_face};
use common::face_oracle::FaceOracle;
use common::judgement::EPSILON;
use common::outline::Verdict;
use common::random::Random;
use common::real_faces::{self, RealFace};
use glam::{DVec2, DVec3};
use hard_points::hard_points;
use perpend::kernel::Trimming;
use perpend::{Definition, NurbsSurface, Prepared, Query, QueryOptions, Scratch};

/// Random queries over all models unless the environment asks for others.
const QUERIES: usize = 3_000;

const MODELS: [&str; 9] = [
    "aero-assembly",
    "as1-assembly",
    "bladex-propeller",
    "iea15mw-blade",
    "nist-ftc-06",
    "odri-lower-leg",
    "tigl-nacelle",
    "utah-teapot",
    "zeiss-cad-cube-cmm",
];

/// The gap that is asked for, as a share of the carrier's size.
const GAP: f64 = 1e-9;

/// A face that the kernel accepts.
struct Face {
    id: u64,
    name: String,
    trim_tolerance: f64,
    surface: NurbsSurface,
    trimming: Arc<Trimming>,
    prepared: Prepared,
}

/// The models that are there.
fn folders() -> Vec<(&'static str, PathBuf)> {
    let wanted = std::env::var("PERPEND_MODEL").ok();
    let named = MODELS.into_iter().filter(|name| wanted.as_deref().is_none_or(|wanted| wanted == *name));
    let folders = named.map(|name| (name, corpus::real().join(name)));
    let there = folders.filter(|(_, folder)| {
        let is_there = folder.is_dir();
        if !is_there {
            eprintln!("skipped: {} is absent; PERPEND_SHARED names the folder that holds real/", folder.display());
        }
        is_there
    });
    there.collect()
}

/// The face with its solver, or why it is refused.
fn entered(face: RealFace) -> Result<Face, String> {
    let definition = face.shape.definition();
    let Definition::NurbsSurface(surface) = &definition else { return Err("it is a curve".to_owned()) };
    let surface = surface.clone();
    let (trimming, _) = Trimming::enter(face.trimming, &surface).map_err(|error| error.to_string())?;
    let trimming = Arc::new(trimming);
    let prepared = Prepared::new(Arc::new(definition), None).with_trimming(Arc::clone(&trimming));
    let RealFace { id, name, trim_tolerance, .. } = face;
    Ok(Face { id, name, trim_tolerance, surface, trimming, prepared })
}

impl Face {
    fn size(&self) -> f64 {
        self.prepared.definition().size()
    }

    fn query(&self, p: DVec3) -> Query {
        Query::new(p, QueryOptions { gap: Some(GAP * self.size()), ..QueryOptions::default() }).expect("a good query")
    }
}

fn faces(name: &str, folder: &std::path::Path) -> (Vec<Face>, Vec<String>) {
    let (mut faces, mut refused) = (Vec::new(), Vec::new());
    for face in real_faces::faces(folder) {
        let id = face.id;
        match entered(face) {
            Ok(face) => faces.push(face),
            Err(error) => refused.push(format!("{name}, face {id}: {error}")),
        }
    }
    (faces, refused)
}

#[test]
fn every_face_is_accepted() {
    let mut all_refused = Vec::new();
    for (name, folder) in folders() {
        let (faces, refused) = faces(name, &folder);
        eprintln!("{name}: {} trimmed faces accepted, {} refused", faces.len(), refused.len());
        all_refused.extend(refused);
    }
    assert!(all_refused.is_empty(), "{} refused\n{}", all_refused.len(), all_refused.join("\n"));
}

/// Rounding of a claim: some ulps of the largest coordinate and of the distance.
fn claim_rounding(reach: f64, p: DVec3, distance: f64) -> f64 {
    1e-13 * distance + 32.0 * EPSILON * reach.max(p.abs().max_element())
}

#[test]
fn no_claim_of_another_kernel_is_nearer_beyond_the_trims_tolerance() {
    let mut failures = Vec::new();
    for (name, folder) in folders() {
        let file = folder.join("occt-claim.csv");
        if !file.is_file() {
            continue;
        }
        let (faces, _) = faces(name, &folder);
        let by_id: HashMap<u64, &Face> = faces.iter().map(|face| (face.id, face)).collect();
        let mut oracles: HashMap<u64, FaceOracle> = HashMap::new();
        let mut scratch = Scratch::default();
        let (mut agreed, mut nearer, mut worst) = (0, 0, 0.0_f64);
        for row in corpus::rows(&file) {
            let Some((face, claim)) = by_id.get(&row.entity).zip(row.get("trimmed_distance")) else { continue };
            let foot = face.prepared.project(&face.query(row.point), &mut scratch).expect("no limit");
            let allowed = GAP * face.size()
                + claim_rounding(face.prepared.definition().reach(), row.point, claim)
                + face.trim_tolerance;
            let told = || format!("{name}, face {} at {:?}: claim {claim:e}, ours {foot:?}", face.id, row.point);
            worst = worst.max(foot.distance - claim);
            if foot.distance > claim + allowed {
                failures.push(format!("{} beyond the claim by {:e}", told(), foot.distance - claim));
                continue;
            }
            if foot.distance >= claim - allowed {
                agreed += 1;
                continue;
            }
            nearer += 1;
            let oracle = oracles.entry(face.id).or_insert_with(|| FaceOracle::new(&face.surface, &face.trimming));
            let uv = DVec2::new(foot.parameter.u(), foot.parameter.v().expect("a surface"));
            let is_there = (face.surface.point(uv.x, uv.y).distance(row.point) - foot.distance).abs() <= allowed;
            let is_inside = oracle.outline.side(uv) != Verdict::Outside || oracle.outline.distance(uv) <= OUTSIDE;
            if !(is_there && is_inside) {
                failures.push(format!("{}: nearer by {:e} outside the trims", told(), claim - foot.distance));
            }
        }
        eprintln!(
            "{name}: {agreed} claims met, {nearer} beaten by a point of the face; farthest beyond a claim {worst:e}"
        );
    }
    let shown = failures.iter().take(20).cloned().collect::<Vec<_>>().join("\n");
    assert!(failures.is_empty(), "{} failures\n{shown}", failures.len());
}

/// What was found of a model.
#[derive(Default)]
struct Table {
    queries: usize,
    faults: BTreeMap<FaceFault, usize>,
    uncertified: usize,
    /// The largest excess over a real point, in sizes of the carrier.
    worst: f64,
    slowest: Vec<(Duration, String)>,
}

/// A row of the random queries: the face, the point, what is wrong.
fn asked(face: &Face, oracle: &FaceOracle, points: &[DVec3], table: &mut Table, told: &mut Vec<String>) {
    let mut scratch = Scratch::default();
    let gap = GAP * face.size();
    let mut longest = Duration::ZERO;
    // what is made for the first query is no part of the others' time
    let _ = face.prepared.project(&face.query(points[0]), &mut scratch);
    for p in points {
        let start = Instant::now();
        let foot = face.prepared.project(&face.query(*p), &mut scratch).expect("no limit");
        longest = longest.max(start.elapsed());
        let judged = judge_on_face(oracle, &face.surface, *p, &foot, gap, oracle.nearest(*p).distance);
        table.queries += 1;
        let excess = (foot.distance - judged.real) / face.size();
        table.worst = table.worst.max(excess);
        let wrong = match judged.fault {
            Some(fault) => {
                *table.faults.entry(fault).or_default() += 1;
                format!("{fault:?}")
            }
            None if !judged.is_proven => {
                table.uncertified += 1;
                format!("not certified, gap {:e}", foot.gap())
            }
            None => continue,
        };
        told.push(format!(
            "face {} ({}) at {p:?}: {wrong}; a point of the face is at {:e}, outline at {:e}; {foot:?}",
            face.id, face.name, judged.real, judged.from_outline
        ));
    }
    table.slowest.push((longest, format!("face {} ({})", face.id, face.name)));
}

#[test]
fn nothing_that_the_oracle_finds_is_nearer() {
    let queries: usize = std::env::var("PERPEND_QUERIES").ok().and_then(|n| n.parse().ok()).unwrap_or(QUERIES);
    let folders = folders();
    let mut all_told = Vec::new();
    for (k, (name, folder)) in folders.iter().enumerate() {
        let (faces, _) = faces(name, folder);
        if faces.is_empty() {
            continue;
        }
        let mut random = Random::new(100 + k as u64);
        let share = queries.div_ceil(folders.len());
        // a query needs company: making the oracle costs as much as some
        let each = share.div_ceil(faces.len()).max(15);
        let asked_faces = share.div_ceil(each);
        let mut table = Table::default();
        let mut told = Vec::new();
        for i in 0..asked_faces {
            let face =
                &faces[(i * faces.len() / asked_faces + random.count(0, faces.len() / asked_faces)) % faces.len()];
            let oracle = FaceOracle::new(&face.surface, &face.trimming);
            let points = hard_points(&oracle, &face.surface, &[], each, &mut random);
            asked(face, &oracle, &points, &mut table, &mut told);
        }
        let Table { queries, faults, uncertified, worst, mut slowest } = table;
        slowest.sort_by_key(|(time, _)| std::cmp::Reverse(*time));
        slowest.truncate(3);
        eprintln!(
            "{name}: {queries} queries of {asked_faces} faces, faults {faults:?}, {uncertified} not certified, worst excess {worst:e} of the size"
        );
        for (time, face) in slowest {
            eprintln!("    {time:?} for a query of {face}");
        }
        told.iter().take(4).for_each(|line| eprintln!("    {line}"));
        all_told.extend(told.into_iter().map(|line| format!("{name}, {line}")));
    }
    let shown = all_told.iter().take(20).cloned().collect::<Vec<_>>().join("\n");
    assert!(all_told.is_empty(), "{} failures\n{shown}", all_told.len());
}
