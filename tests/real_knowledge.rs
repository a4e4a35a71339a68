//! Real models: with all that is learned of their faces and edges, and with nothing, every answer is the same within the gap; shapes
//! that their files call analytic are answered in closed form.
//!
//! The models lie outside the repository, as for the other tests of real models; without them the test says so and passes.

#![allow(clippy::print_stderr, reason = "a test that skips says so aloud; the counts are wanted by readers")]

mod common;

use common::corpus;
use common::judgement::{EPSILON, is_certified};
use common::random::Random;
use glam::DVec3;
use perpend::{Basis, Classification, Definition, FootPoint, Item, Kind, Method, Model, QueryOptions, Record};
use serde_json::Value;

/// The entities that the file says to be analytic, by id; a face says from what surface it was cut.
fn analytic_by_file(text: &str) -> Vec<u64> {
    let json: Value = serde_json::from_str(text).expect("JSON");
    let entities = json["entities"].as_array().expect("a list of entities");
    let analytic = ["line", "circle", "ellipse", "plane", "sphere", "cylinder", "cone", "torus"];
    let named = entities.iter().filter(|entity| {
        let origin = entity["origin_type"].as_str().unwrap_or_default().to_lowercase();
        analytic.contains(&origin.as_str())
    });
    named.filter_map(|entity| entity["id"].as_u64()).collect()
}

/// Points around, near and on a definition.
fn points(definition: &Definition, random: &mut Random, count: usize) -> Vec<DVec3> {
    let size = definition.size();
    let share = |random: &mut Random, (a, b): (f64, f64)| a + (b - a) * random.unit();
    let on = |random: &mut Random| match definition {
        Definition::NurbsCurve(curve) => curve.point(share(random, curve.domain())),
        Definition::NurbsSurface(surface) => {
            let [u, v] = [perpend::Direction::U, perpend::Direction::V].map(|d| share(random, surface.domain(d)));
            surface.point(u, v)
        }
    };
    (0..count)
        .map(|k| match k % 4 {
            0 => on(random),
            1 => on(random) + size * random.power(-9.0, -3.0) * random.direction(),
            2 => on(random) + size * random.power(-2.0, 0.5) * random.direction(),
            _ => on(random) + size * random.power(1.0, 2.0) * random.direction(),
        })
        .collect()
}

/// A model that is told that all is free: nothing special is known or recognised.
fn told_free(model: &Model) -> Model {
    let mut free = model.clone();
    for entity in model.entities() {
        let of = entity.definition().fingerprint();
        let kind = Item { value: Kind::FreeForm, basis: Basis::Declared, tolerance: 0.0, of };
        let classification = Some(Classification { kind: Some(kind), ..Classification::default() });
        free.set_record(entity.id(), Record { classification, ..Record::default() }).expect("valid");
    }
    free
}

#[derive(Default)]
struct Count {
    queries: usize,
    analytic: usize,
    /// Of entities that the file calls analytic: asked, and answered in closed form.
    named: [usize; 2],
    difference: f64,
}

fn same_answers(name: &str) {
    let folder = corpus::real().join(name);
    if !folder.is_dir() {
        eprintln!("skipped: {} is absent; PERPEND_SHARED names the folder that holds real/", folder.display());
        return;
    }
    let file = folder.join("corpus.json");
    let named = analytic_by_file(&std::fs::read_to_string(&file).expect("a file"));
    let mut random = Random::new(45_000);
    let (mut count, mut failures) = (Count::default(), Vec::new());
    for entry in corpus::entities(&file) {
        let definition = entry.shape.definition();
        let (size, reach) = (definition.size(), definition.reach());
        let mut nothing = Model::new();
        let id = nothing.insert(&entry.name, definition.clone()).expect("a valid entity");
        let mut learned = nothing.clone();
        learned.learn(id).expect("the entity is there");
        let free = told_free(&nothing);
        let points = points(&definition, &mut random, 16);
        let ask = |model: &Model| -> Vec<FootPoint> {
            let answers = model.project_all(id, &points, &QueryOptions::default());
            answers.into_iter().map(|answer| answer.expect("finite").expect("no limit")).collect()
        };
        let [nothing, learned, free] = [&nothing, &learned, &free].map(ask);
        for (k, p) in points.iter().enumerate() {
            let feet = [nothing[k], learned[k], free[k]];
            let distances = feet.map(|foot| foot.distance);
            let least = distances.into_iter().fold(f64::INFINITY, f64::min);
            let most = distances.into_iter().fold(0.0, f64::max);
            let rounding = 32.0 * EPSILON * (reach + p.abs().max_element());
            count.queries += 1;
            count.analytic += usize::from(learned[k].method == Method::Analytic);
            if named.contains(&entry.id) {
                count.named[0] += 1;
                count.named[1] += usize::from(learned[k].method == Method::Analytic);
            }
            count.difference = count.difference.max((most - least) / size);
            let false_bound = feet.iter().any(|foot| foot.lower_bound > least + rounding);
            let certified = feet.iter().all(|f| is_certified(f.distance, f.lower_bound, 1e-9 * size, reach, *p));
            if most - least > 1e-9 * size + rounding || false_bound || !certified {
                failures.push(format!("entity {} at {p:?}: {feet:?}", entry.id));
            }
        }
    }
    let Count { queries, analytic, named: [asked, answered], difference } = count;
    eprintln!(
        "{name}: {analytic} of {queries} answers in closed form; of entities that the file calls analytic {answered} of {asked}; the \
         largest difference {difference:.1e} of the size"
    );
    let shown = failures.iter().take(5).cloned().collect::<Vec<_>>().join("\n");
    assert!(failures.is_empty(), "{name}: {} failures\n{shown}", failures.len());
}

macro_rules! models {
    ($($test:ident: $folder:literal,)*) => {
        $(
            #[test]
            fn $test() {
                same_answers($folder);
            }
        )*
    };
}

models! {
    the_aero_assembly_is_answered_the_same: "aero-assembly",
    the_as1_assembly_is_answered_the_same: "as1-assembly",
    the_propeller_is_answered_the_same: "bladex-propeller",
    the_wind_turbine_blade_is_answered_the_same: "iea15mw-blade",
    the_nist_test_case_is_answered_the_same: "nist-ftc-06",
    the_lower_leg_is_answered_the_same: "odri-lower-leg",
    the_nacelle_is_answered_the_same: "tigl-nacelle",
    the_teapot_is_answered_the_same: "utah-teapot",
    the_cube_is_answered_the_same: "zeiss-cad-cube-cmm",
}
