//! What does a point of a scan cost, with the foot before it as the hint and without?

mod common;

use divan::Bencher;
use perpend_bench::{Case, Judge, scan};
use perpend_kernel::Definition;
use perpend_projection::{Method, QueryOptions};

const SET: &str = "seeds-surfaces";

fn main() {
    divan::main();
}

/// A raster of 50 by 50 points within 1 % of the size.
fn case(name: &str) -> Case {
    let entity = common::entity(SET, name);
    let Definition::NurbsSurface(surface) = &**entity.prepared.definition() else { panic!("{name} is no surface") };
    let points = scan(surface, 50);
    let options = QueryOptions { method: Some(Method::Hierarchy), ..QueryOptions::default() };
    let mut case = Case::new(name, &entity.prepared, points.iter().copied(), options).expect("finite points");
    let judge = Judge::new(entity.prepared.definition());
    for (p, foot) in points.iter().zip(case.answers()) {
        assert!(!judge.is_open(*p, &foot), "{name}: {p} is not certified: {foot:?}");
    }
    case
}

#[divan::bench(args = common::names(SET), max_time = 0.3)]
fn hinted(bencher: Bencher, name: &str) {
    common::time(bencher, case(name).hinted());
}

#[divan::bench(args = common::names(SET), max_time = 0.3)]
fn without_hints(bencher: Bencher, name: &str) {
    common::time(bencher, case(name));
}
