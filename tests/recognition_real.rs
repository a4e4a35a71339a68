//! Real models: what their files call an analytic shape is recognised as one, with the file's parameters, and nothing is accepted
//! that is farther from its shape than was proved.
//!
//! The models lie outside the repository, as for the other test of real models; without them the test says so and passes.

#![allow(clippy::print_stderr, reason = "a test that skips says so aloud; the counts are wanted by readers")]

mod common;

use std::time::Instant;

use common::corpus;
use common::kinds::{distance, gap, name, turn};
use glam::DVec3;
use perpend::Kind;
use perpend::knowledge::{default_tolerance, recognise};
use serde_json::Value;

fn vector(json: &Value) -> DVec3 {
    let at = |k: usize| json[k].as_f64().expect("a number");
    DVec3::new(at(0), at(1), at(2))
}

/// How far the parameters are from those of the file, as a length, and the shape's radius by sagitta.
fn parameters(kind: &Kind, truth: &Value, size: f64) -> (f64, f64) {
    let number = |key: &str| truth[key].as_f64().unwrap_or_else(|| panic!("{key} in {truth}"));
    let direction = |axis: DVec3, key: &str| axis.cross(vector(&truth[key]).normalize()).length() * size;
    let line = |p: DVec3, axis: DVec3| {
        let arm = p - vector(&truth["origin"]);
        let axis_there = vector(&truth["axis"]).normalize();
        (arm - arm.dot(axis_there) * axis_there).length().max(direction(axis, "axis"))
    };
    // the sagitta of an arc over `angle` by its radius, at most the radius
    let slender = |angle: f64| 1.0 / (1.0 - (0.5 * angle.min(std::f64::consts::PI)).cos());
    match *kind {
        Kind::Line { origin, direction: d, .. } => {
            let there = vector(&truth["direction"]).normalize();
            let arm = origin - vector(&truth["origin"]);
            ((arm - arm.dot(there) * there).length().max(direction(d, "direction")), 1.0)
        }
        Kind::Circle { centre, axis, radius, sweep, .. } => {
            let off = centre.distance(vector(&truth["center"])).max((radius - number("radius")).abs());
            (off.max(direction(axis, "axis")), slender(turn(sweep)))
        }
        Kind::Plane { origin, normal, .. } => {
            let there = vector(&truth["normal"]).normalize();
            (direction(normal, "normal").max((origin - vector(&truth["origin"])).dot(there).abs()), 1.0)
        }
        Kind::Cylinder { centre, axis, radius, sweep, .. } => {
            (line(centre, axis).max((radius - number("radius")).abs()), slender(turn(sweep)))
        }
        Kind::Cone { apex, axis, half_angle, sweep, .. } => {
            let angle = (half_angle - number("semi_angle").abs()).abs() * size;
            (apex.distance(vector(&truth["apex"])).max(direction(axis, "axis")).max(angle), slender(turn(sweep)))
        }
        Kind::Sphere { centre, radius, sweep, latitude, .. } => {
            let off = centre.distance(vector(&truth["origin"])).max((radius - number("radius")).abs());
            (off, slender(turn(sweep).min(turn(latitude))))
        }
        Kind::Torus { centre, axis, major_radius, minor_radius, sweep, section, .. } => {
            let radii =
                (major_radius - number("major_radius")).abs().max((minor_radius - number("minor_radius")).abs());
            let off = centre.distance(vector(&truth["origin"])).max(direction(axis, "axis")).max(radii);
            (off, slender(turn(sweep).min(turn(section))))
        }
        _ => (0.0, 1.0),
    }
}

fn recognised(folder: &str) {
    let file = corpus::real().join(folder).join("corpus.json");
    if !file.is_file() {
        eprintln!("skipped: {} is absent; PERPEND_SHARED names the folder that holds real/", file.display());
        return;
    }
    let text = std::fs::read_to_string(&file).expect("readable");
    let json: Value = serde_json::from_str(&text).expect("JSON");
    let truths = json["entities"].as_array().expect("a list");
    let (mut failures, mut analytic, mut others) = (Vec::new(), 0, std::collections::BTreeMap::new());
    let mut seconds = 0.0;
    let (mut faces, mut worst) = (0, 0.0_f64);
    for (entry, truth) in corpus::entities(&file).into_iter().zip(truths) {
        let definition = entry.shape.definition();
        let (size, tolerance) = (definition.size(), default_tolerance(&definition));
        let start = Instant::now();
        let item = recognise(&definition, tolerance);
        seconds += start.elapsed().as_secs_f64();
        faces += usize::from(truth["kind"] == "surface");
        let found = name(&item.value);
        let origin = truth["origin_type"].as_str().unwrap_or_default();
        // what is accepted is that near, seen at points of the definition
        let rounding = 64.0 * f64::EPSILON * (definition.reach() + size);
        for k in 0..=64 {
            let share = |along: usize, k: i32| {
                let [a, b] = entry.shape.domain(along);
                a + (b - a) * f64::from(k) / 8.0
            };
            let p = match &definition {
                perpend::Definition::NurbsCurve(curve) => curve.point(share(0, k % 9)),
                perpend::Definition::NurbsSurface(surface) => surface.point(share(0, k % 9), share(1, k / 9)),
            };
            if let Some(off) = distance(&item.value, p).filter(|off| *off > gap(&item) + rounding) {
                failures.push(format!("entity {}: {off:e} from {:?}, gap {:e}", entry.id, item.value, gap(&item)));
            }
        }
        if ["line", "circle", "plane", "cylinder", "cone", "sphere", "torus"].contains(&origin) {
            analytic += 1;
            if found.to_lowercase() != origin {
                failures.push(format!("entity {}: {origin} is taken for {:?}", entry.id, item.value));
                continue;
            }
            if truth["origin_params"].is_null() {
                continue;
            }
            let (off, slender) = parameters(&item.value, &truth["origin_params"], size);
            let allowed = 1e-9 * size + 16.0 * f64::EPSILON * definition.reach() * slender;
            worst = worst.max(off / allowed);
            if off > allowed {
                let params = &truth["origin_params"];
                failures
                    .push(format!("entity {}: {off:e} off, {allowed:e} allowed: {:?}, {params}", entry.id, item.value));
            }
        } else {
            // a line that turns about an axis may be a cone or a cylinder
            if origin == "revolution" && !["Revolution", "Cone", "Cylinder"].contains(&found.as_str()) {
                failures.push(format!("entity {}: a revolution is taken for {:?}", entry.id, item.value));
            }
            *others.entry(format!("{origin} -> {found}")).or_insert(0) += 1;
        }
    }
    eprintln!(
        "{folder}: {analytic} analytic entities, parameters off by up to {worst:.2e} of what is allowed; {faces} faces, \
         {} entities in {seconds:.2} s; others {others:?}",
        truths.len()
    );
    let shown = failures.iter().take(10).cloned().collect::<Vec<_>>().join("\n");
    assert!(failures.is_empty(), "{folder}: {} failures\n{shown}", failures.len());
    // a face in milliseconds: a thousand in seconds
    assert!(seconds < 5e-3 * truths.len() as f64 + 1.0, "{seconds} s for {} entities", truths.len());
}

macro_rules! models {
    ($($test:ident: $folder:literal,)*) => {
        $(
            #[test]
            fn $test() {
                recognised($folder);
            }
        )*
    };
}

models! {
    the_aero_assembly_is_recognised: "aero-assembly",
    the_as1_assembly_is_recognised: "as1-assembly",
    the_propeller_is_recognised: "bladex-propeller",
    the_wind_turbine_blade_is_recognised: "iea15mw-blade",
    the_nist_test_case_is_recognised: "nist-ftc-06",
    the_lower_leg_is_recognised: "odri-lower-leg",
    the_nacelle_is_recognised: "tigl-nacelle",
    the_teapot_is_recognised: "utah-teapot",
    the_cube_is_recognised: "zeiss-cad-cube-cmm",
}
