//! What knowing an entity's class saves: time per query of its closed form and of the certified hierarchy, in one run on one thread.
//!
//! `knowledge [FOLDER]`: the folder of the corpora `quadrics` and `circles-table1`, `tests/data` if left out. Surfaces that are reduced to a
//! profile follow, and a ruled surface, which is not.

#![allow(clippy::print_stdout, reason = "a benchmark prints its table")]

use std::f64::consts::TAU;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use glam::DVec3;
use perpend_bench::{Corpus, Failure, rows, spread};
use perpend_kernel::{Definition, Ellipse, Frame, NurbsCurve, extrusion, revolution, ruled};
use perpend_projection::{Method, Prepared, Query, QueryOptions, Scratch};

/// Passes over the queries, of which the fastest counts: other programs only ever add time.
const PASSES: usize = 15;

fn main() -> Result<(), Failure> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| "tests/data".to_owned());
    println!(
        "{:<24}{:>7}{:>14}{:>14}{:>14}{:>8}{:>10}{:>13}",
        "entity", "rows", "hierarchy us", "analytic us", "evaluation us", "ratio", "declined", "worst / ulp"
    );
    let mut ratios = Vec::new();
    for name in ["circles-table1", "quadrics"] {
        let path = Path::new(&folder).join(name);
        let corpus = Corpus::read(&path.with_extension("json"))?;
        let rows = rows(&path.with_extension("truth.csv"))?;
        for entity in &corpus.entities {
            let points: Vec<DVec3> = rows.iter().filter(|row| row.entity == entity.id).map(|row| row.point).collect();
            ratios.push(compared(&entity.name, entity.definition()?, &points)?);
        }
    }
    let mean = ratios.iter().map(|ratio| ratio.ln()).sum::<f64>() / ratios.len() as f64;
    println!("geometric mean of the ratios over both corpora: {:.1}", mean.exp());
    for (name, definition) in profiles()? {
        let (size, centre) = (definition.size(), definition.control_box().centre());
        let points: Vec<DVec3> = (0..1500).map(|k| centre + 1.5 * size * spread(k)).collect();
        compared(name, definition, &points)?;
    }
    Ok(())
}

/// Surfaces over free and elliptic profiles, and a ruled one.
fn profiles() -> Result<Vec<(&'static str, Definition)>, Failure> {
    let knots = vec![0.0, 0.0, 0.0, 0.0, 0.2, 0.4, 0.7, 1.0, 1.0, 1.0, 1.0];
    let curve = |offset: DVec3, heights: [f64; 7]| {
        let points = heights.iter().enumerate().map(|(i, h)| offset + DVec3::new(i as f64, *h, 0.0)).collect();
        NurbsCurve::new(3, knots.clone(), points, None)
    };
    let profile = curve(DVec3::ZERO, [1.0, 2.0, 1.2, 0.8, 2.5, 1.5, 1.0])?;
    let other = curve(4.0 * DVec3::Z, [2.0, 1.0, 2.2, 0.3, 1.5, 2.5, 0.0])?;
    let ellipse = Ellipse::whole(Frame::WORLD, (2.0, 1.0))?.to_nurbs()?;
    Ok(vec![
        ("elliptic extrusion", extrusion(&ellipse, 3.0 * DVec3::Z)?.into()),
        ("free extrusion", extrusion(&profile, 3.0 * DVec3::Z)?.into()),
        ("oblique extrusion", extrusion(&profile, DVec3::new(0.0, 1.0, 3.0))?.into()),
        ("free revolution", revolution(&profile, DVec3::ZERO, DVec3::X, TAU)?.into()),
        ("ruled", ruled(&profile, &other)?.into()),
    ])
}

/// Prints a line of the table and gives the ratio of times.
fn compared(name: &str, definition: Definition, points: &[DVec3]) -> Result<f64, Failure> {
    let definition = Arc::new(definition);
    let prepared = Prepared::new(Arc::clone(&definition), None);
    let mut scratch = Scratch::default();
    let queries = |method| -> Result<Vec<Query>, Failure> {
        let options = QueryOptions { method: Some(method), ..QueryOptions::default() };
        Ok(points.iter().map(|p| Query::new(*p, options)).collect::<Result<_, _>>()?)
    };
    let (slow, fast) = (queries(Method::Hierarchy)?, queries(Method::Analytic)?);
    let (mut declined, mut worst) = (0, 0.0_f64);
    for ((slow, fast), p) in slow.iter().zip(&fast).zip(points) {
        let proven = prepared.project(slow, &mut scratch).ok_or("no distance limit")?;
        let closed = prepared.project(fast, &mut scratch).ok_or("no distance limit")?;
        declined += u32::from(closed.method != Method::Analytic);
        let ulp = f64::EPSILON * (definition.reach() + p.abs().max_element());
        worst = worst.max((closed.distance - proven.distance).abs() / ulp);
    }
    let [mut hierarchy, mut analytic, mut evaluation] = [f64::INFINITY; 3];
    let each = |work: &mut dyn FnMut(usize)| {
        let start = Instant::now();
        (0..points.len()).for_each(work);
        start.elapsed().as_secs_f64() * 1e6 / points.len() as f64
    };
    for _ in 0..PASSES {
        let ask = |query: &Query, scratch: &mut Scratch| {
            std::hint::black_box(prepared.project(query, scratch));
        };
        hierarchy = each(&mut |k| ask(&slow[k], &mut scratch)).min(hierarchy);
        analytic = each(&mut |k| ask(&fast[k], &mut scratch)).min(analytic);
        evaluation = each(&mut |_| evaluated(&definition)).min(evaluation);
    }
    let ratio = hierarchy / analytic;
    println!(
        "{name:<24}{:>7}{hierarchy:>14.3}{analytic:>14.3}{evaluation:>14.3}{ratio:>8.1}{declined:>10}{worst:>13.1}",
        points.len()
    );
    Ok(ratio)
}

/// What every answer evaluates at least: the point, and on a surface its first derivatives for the normal.
fn evaluated(definition: &Definition) {
    match std::hint::black_box(definition) {
        Definition::NurbsCurve(curve) => {
            std::hint::black_box(curve.point(std::hint::black_box(0.37)));
        }
        Definition::NurbsSurface(surface) => {
            let mut d = [DVec3::ZERO; 4];
            surface.derivatives(std::hint::black_box(0.37), std::hint::black_box(0.61), 1, &mut d);
            std::hint::black_box(d);
        }
    }
}
