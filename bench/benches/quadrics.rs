//! What does a query to a known shape cost: as NURBS by the certified solver, and recognised?

mod common;

use divan::Bencher;
use perpend_projection::{Method, QueryOptions};

fn main() {
    divan::main();
}

fn as_nurbs() -> QueryOptions {
    QueryOptions { method: Some(Method::Hierarchy), ..QueryOptions::default() }
}

#[divan::bench(args = common::names("quadrics"), max_time = 0.3)]
fn quadrics_as_nurbs(bencher: Bencher, name: &str) {
    common::ask(bencher, common::entity("quadrics", name), as_nurbs(), |_| true);
}

#[divan::bench(args = common::names("quadrics"), max_time = 0.3)]
fn quadrics_recognised(bencher: Bencher, name: &str) {
    common::ask(bencher, common::entity("quadrics", name), QueryOptions::default(), |_| true);
}

#[divan::bench(args = common::names("circles-table1"), max_time = 0.3)]
fn circles_as_nurbs(bencher: Bencher, name: &str) {
    common::ask(bencher, common::entity("circles-table1", name), as_nurbs(), |_| true);
}

#[divan::bench(args = common::names("circles-table1"), max_time = 0.3)]
fn circles_recognised(bencher: Bencher, name: &str) {
    common::ask(bencher, common::entity("circles-table1", name), QueryOptions::default(), |_| true);
}
