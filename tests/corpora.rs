//! Every row of the four test sets: the distance is right, the bound is true, the proof complete, the foot where it is said to be.

mod common;

use common::corpus;
use common::judgement::{is_certified, rounding, two_ulps};
use common::shape::Shape;
use perpend::{Definition, Model, Parameter, QueryOptions};

/// Checks every row of a set; `rows` is how many there are.
fn check(set: &str, rows: usize) {
    let truth = corpus::rows(&corpus::data().join(format!("{set}.truth.csv")));
    assert_eq!(truth.len(), rows, "rows of {set}");
    let mut failures = Vec::new();
    let mut checked = 0;
    for entry in corpus::entities(&corpus::data().join(format!("{set}.json"))) {
        let shape = &entry.shape;
        let (size, reach) = (shape.size(), shape.reach());
        let definition = shape.definition();
        let mut model = Model::new();
        let id = model.insert(&entry.name, definition.clone()).expect("a valid entity");
        let rows: Vec<_> = truth.iter().filter(|row| row.entity == entry.id).collect();
        let points: Vec<_> = rows.iter().map(|row| row.point).collect();
        for (row, answer) in rows.iter().zip(model.project_all(id, &points, &QueryOptions::default())) {
            checked += 1;
            let (p, want) = (row.point, row.distance());
            let foot = answer.expect("a finite point").expect("no distance is too far");
            let mut fail =
                |what: &str| failures.push(format!("{set} {} at {p}: {what}; {foot:?}, truth {want:e}", entry.name));
            let tolerance = 1e-9 * size + rounding(reach, p, want);
            if [foot.distance, foot.lower_bound, foot.point.length()].iter().any(|x| x.is_nan()) {
                fail("a number is no number");
            }
            if (foot.distance - want).abs() > tolerance {
                fail("the distance is wrong");
            }
            if foot.lower_bound > want + 1e-10 * size + rounding(reach, p, want) {
                fail("the bound is false");
            }
            if !is_certified(foot.distance, foot.lower_bound, 1e-9 * size, reach, p) {
                fail("it is not certified");
            }
            if ((foot.point - p).length() - foot.distance).abs() > tolerance {
                fail("the foot is not at its distance");
            }
            let (u, v) = (foot.parameter.u(), foot.parameter.v().unwrap_or(0.0));
            let inside = |along: usize, t: f64| (shape.domain(along)[0]..=shape.domain(along)[1]).contains(&t);
            if !inside(0, u) || !(shape.curve || inside(1, v)) {
                fail("the parameter is outside the domain");
                continue;
            }
            if foot.point != evaluated(&definition, foot.parameter) {
                fail("the foot is not the definition at its parameter, bit for bit");
            }
            if is_off(shape, &foot, [u, v], tolerance) {
                fail("the foot is not on the entity");
            }
        }
    }
    assert_eq!(checked, rows, "every row names an entity of {set}");
    let shown = failures.iter().take(10).cloned().collect::<Vec<_>>().join("\n");
    assert!(failures.is_empty(), "{} of {rows} rows fail:\n{shown}", failures.len());
}

fn evaluated(definition: &Definition, parameter: Parameter) -> perpend::DVec3 {
    match (definition, parameter) {
        (Definition::NurbsCurve(curve), Parameter::Curve(u)) => curve.point(u),
        (Definition::NurbsSurface(surface), Parameter::Surface(u, v)) => surface.point(u, v),
        _ => panic!("a curve's parameter for a surface, or the reverse"),
    }
}

fn is_off(shape: &Shape, foot: &perpend::FootPoint, at: [f64; 2], tolerance: f64) -> bool {
    let off = (shape.point(at[0], at[1]) - foot.point).length();
    !(off <= tolerance || off <= tolerance + 2.0 * two_ulps(shape, at))
}

#[test]
fn every_row_of_the_curves_is_right_and_certified() {
    check("seeds-curves", 19_025);
}

#[test]
fn every_row_of_the_surfaces_is_right_and_certified() {
    check("seeds-surfaces", 16_318);
}

#[test]
fn every_row_of_the_quadrics_is_right_and_certified() {
    check("quadrics", 14_949);
}

#[test]
fn every_row_of_the_circles_is_right_and_certified() {
    check("circles-table1", 12_283);
}
