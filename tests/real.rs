//! Models that nobody here wrote: every query is answered and certified, never farther than the best distance known, and where
//! another kernel claims to be nearer, an evaluation shows who is right.
//!
//! The models lie outside the repository: in `real` of the folder that the environment variable `PERPEND_SHARED` names, by default
//! `../shared` beside the workspace. Without them the test says so and passes.

#![allow(clippy::print_stderr, reason = "a test that skips says so aloud; the counts are wanted by readers")]

mod common;

use std::collections::HashMap;
use std::path::Path;
use std::process::Command;

use common::corpus::{self, Row};
use common::judgement::{EPSILON, is_certified, is_false_bound};
use common::oracle::Oracle;
use common::shape::{Shape, bezier_knots};
use glam::DVec3;
use perpend::{EntityId, FootPoint, Model, QueryOptions};

/// A real model with its shapes by the ids of its file.
struct Real {
    model: Model,
    ids: HashMap<u64, EntityId>,
    oracles: HashMap<u64, Oracle>,
}

/// The model as the tool beside the models writes it: a RON file, ids kept. None where the tool or its interpreter is absent.
fn from_ron(folder: &Path) -> Option<Model> {
    let tool = folder.parent()?.parent()?.join("tools/to_ron.py");
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(folder.file_name()?).with_extension("ron");
    let done = Command::new("python3").arg(tool).arg(folder.join("corpus.json")).arg(&file).status().ok()?;
    done.success().then(|| Model::read(&file).expect("the tool writes models"))
}

fn load(folder: &Path, wanted: &[Row]) -> Real {
    let model = from_ron(folder);
    if model.is_none() {
        eprintln!("{}: read from its JSON, since tools/to_ron.py did not run", folder.display());
    }
    let ron = model.is_some();
    let mut real = Real { model: model.unwrap_or_default(), ids: HashMap::new(), oracles: HashMap::new() };
    for entry in corpus::entities(&folder.join("corpus.json")) {
        let definition = entry.shape.definition();
        let id = if ron {
            let id = EntityId::new(entry.id);
            let read = real.model.entity(id).expect("ids are kept");
            assert_eq!(**read.definition(), definition, "entity {id} of {}", folder.display());
            id
        } else {
            real.model.insert(&entry.name, definition).expect("a valid entity")
        };
        if wanted.iter().any(|row| row.entity == entry.id) {
            real.oracles.insert(entry.id, Oracle::new(entry.shape));
        }
        real.ids.insert(entry.id, id);
    }
    real
}

impl Real {
    /// The answers to rows, in their order.
    fn answers(&self, rows: &[Row]) -> Vec<FootPoint> {
        let mut answers = vec![None; rows.len()];
        for (entity, id) in &self.ids {
            let places: Vec<usize> = (0..rows.len()).filter(|i| rows[*i].entity == *entity).collect();
            let points: Vec<DVec3> = places.iter().map(|i| rows[*i].point).collect();
            for (i, answer) in places.into_iter().zip(self.model.project_all(*id, &points, &QueryOptions::default())) {
                answers[i] = answer.expect("a finite point");
            }
        }
        answers.into_iter().map(|answer| answer.expect("every query is answered")).collect()
    }
}

/// Rounding of a claim: some ulps of the largest coordinate and of the distance, since others do not work about the
/// entity's centre.
fn claim_rounding(reach: f64, p: DVec3, distance: f64) -> f64 {
    1e-13 * distance + 32.0 * EPSILON * reach.max(p.abs().max_element())
}

fn certified_and_nowhere_beaten(name: &str) {
    let folder = corpus::real().join(name);
    if !folder.is_dir() {
        eprintln!("skipped: {} is absent; PERPEND_SHARED names the folder that holds real/", folder.display());
        return;
    }
    let queries = corpus::rows(&folder.join("queries.csv"));
    let real = load(&folder, &queries);
    let mut failures = Vec::new();
    for (row, foot) in queries.iter().zip(real.answers(&queries)) {
        let oracle = &real.oracles[&row.entity];
        let reach = oracle.shape.reach();
        if !is_certified(foot.distance, foot.lower_bound, 1e-9 * oracle.size, reach, row.point) {
            failures.push(format!("entity {} at {}: not certified: {foot:?}", row.entity, row.point));
        }
    }
    // the best distances known, each of a real point of the entity (of the plane and cylinder: in closed form)
    let closed_form = folder.join("truth.csv");
    let best = if closed_form.is_file() { closed_form } else { folder.join("best-known.csv") };
    let best = corpus::rows(&best);
    for (row, foot) in best.iter().zip(real.answers(&best)) {
        let oracle = &real.oracles[&row.entity];
        let rounding = claim_rounding(oracle.shape.reach(), row.point, row.distance());
        if foot.distance > row.distance() + rounding {
            let excess = foot.distance - row.distance();
            failures
                .push(format!("entity {} at {}: {excess:e} beyond the best known; {foot:?}", row.entity, row.point));
        }
        if is_false_bound(foot.lower_bound, row.distance() + rounding, oracle.size) {
            failures.push(format!(
                "entity {} at {}: false bound; {foot:?}, best {:e}",
                row.entity,
                row.point,
                row.distance()
            ));
        }
    }
    let claims = folder.join("occt-claim.csv");
    if claims.is_file() {
        let claims = corpus::rows(&claims);
        let verdicts = judge_claims(&real, &claims);
        eprintln!("{name}: {} queries; of {} claims {verdicts}", queries.len(), claims.len());
        failures.extend(verdicts.lost);
    }
    let shown = failures.iter().take(10).cloned().collect::<Vec<_>>().join("\n");
    assert!(failures.is_empty(), "{name}: {} failures\n{shown}", failures.len());
}

/// What became of another kernel's claims.
#[derive(Default)]
struct Verdicts {
    /// Ours is nearer.
    beaten: usize,
    /// Theirs is nearer by more than rounding, and the point that they name is not at that distance.
    contradicted: usize,
    /// Theirs is nearer by more than rounding without a point; our bound and the oracle deny it.
    denied: usize,
    /// Theirs is nearer, and the point that they name is there.
    lost: Vec<String>,
}

impl std::fmt::Display for Verdicts {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { beaten, contradicted, denied, lost } = self;
        let lost = lost.len();
        write!(
            f,
            "{beaten} are beaten, {contradicted} contradicted by their own point, {denied} proven false, {lost} lost"
        )
    }
}

fn judge_claims(real: &Real, claims: &[Row]) -> Verdicts {
    let mut verdicts = Verdicts::default();
    let stated = claims.iter().zip(real.answers(claims)).filter(|(row, _)| row.get("distance").is_some());
    for (row, foot) in stated {
        let (oracle, claim, p) = (&real.oracles[&row.entity], row.distance(), row.point);
        let tolerance = claim_rounding(oracle.shape.reach(), p, claim);
        if claim > foot.distance + tolerance {
            verdicts.beaten += 1;
            continue;
        }
        if claim >= foot.distance - tolerance {
            continue;
        }
        let named = row.get("u").zip(row.get("v"));
        let at_named = named.map(|(u, v)| {
            let inside = |along: usize, t: f64| t.clamp(oracle.shape.domain(along)[0], oracle.shape.domain(along)[1]);
            oracle.shape.distance_at(p, inside(0, u).into(), inside(1, v).into())
        });
        match at_named {
            Some(there) if there > claim + tolerance => verdicts.contradicted += 1,
            None if foot.lower_bound > claim && oracle.nearest(p).distance > claim + tolerance => verdicts.denied += 1,
            _ => verdicts.lost.push(format!(
                "entity {} at {p}: claim {claim:e} (its point is at {at_named:?}), ours {foot:?}",
                row.entity
            )),
        }
    }
    verdicts
}

#[test]
fn claims_are_judged_by_the_point_that_they_name() {
    let corners = [(0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0)].map(|(x, y)| DVec3::new(x, y, 0.0));
    let shape = Shape::surface([1, 1], [bezier_knots(1), bezier_knots(1)], corners.to_vec(), None);
    let mut model = Model::new();
    let id = model.insert("square", shape.definition()).expect("a valid entity");
    let (ids, oracles) = (HashMap::from([(1, id)]), HashMap::from([(1, Oracle::new(shape))]));
    let claims = corpus::parse(
        "entity,x,y,z,distance,u,v\n\
         1,0.5,0.5,2,2,0.5,0.5\n\
         1,0.5,0.5,2,2.5,0.1,0.1\n\
         1,0.5,0.5,2,1.9,0.5,0.5\n\
         1,0.5,0.5,2,1.9,,\n",
    );
    let verdicts = judge_claims(&Real { model, ids, oracles }, &claims);
    let counts = (verdicts.beaten, verdicts.contradicted, verdicts.denied, verdicts.lost.len());
    assert_eq!(counts, (1, 1, 1, 0), "an agreement, a claim beaten, one that its point contradicts, one proven false");
}

macro_rules! models {
    ($($test:ident: $folder:literal,)*) => {
        $(
            #[test]
            fn $test() {
                certified_and_nowhere_beaten($folder);
            }
        )*
    };
}

models! {
    the_aero_assembly_is_certified_and_nowhere_beaten: "aero-assembly",
    the_as1_assembly_is_certified_and_nowhere_beaten: "as1-assembly",
    the_propeller_is_certified_and_nowhere_beaten: "bladex-propeller",
    the_wind_turbine_blade_is_certified_and_nowhere_beaten: "iea15mw-blade",
    the_nist_test_case_is_certified_and_nowhere_beaten: "nist-ftc-06",
    the_lower_leg_is_certified_and_nowhere_beaten: "odri-lower-leg",
    the_nacelle_is_certified_and_nowhere_beaten: "tigl-nacelle",
    the_teapot_is_certified_and_nowhere_beaten: "utah-teapot",
    the_cube_is_certified_and_nowhere_beaten: "zeiss-cad-cube-cmm",
}
