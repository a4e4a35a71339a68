//! What does a query to a prepared surface cost: the mix of the test set, near points, far points, a gap near the limit?

mod common;

use divan::Bencher;
use perpend_projection::{Method, QueryOptions};

const SET: &str = "seeds-surfaces";

fn main() {
    divan::main();
}

/// By the certified solver: one surface of the set is recognised.
fn options() -> QueryOptions {
    QueryOptions { method: Some(Method::Hierarchy), ..QueryOptions::default() }
}

#[divan::bench(args = common::names(SET), max_time = 0.3)]
fn mix(bencher: Bencher, name: &str) {
    common::ask(bencher, common::entity(SET, name), options(), |_| true);
}

#[divan::bench(args = common::names(SET), max_time = 0.3)]
fn near(bencher: Bencher, name: &str) {
    common::ask(bencher, common::entity(SET, name), options(), |distance| distance < 0.02);
}

#[divan::bench(args = common::names(SET), max_time = 0.3)]
fn far(bencher: Bencher, name: &str) {
    common::ask(bencher, common::entity(SET, name), options(), |distance| distance > 20.0);
}

#[divan::bench(args = common::names(SET), max_time = 0.3)]
fn gap_1e_11(bencher: Bencher, name: &str) {
    let entity = common::entity(SET, name);
    let gap = Some(1e-11 * entity.prepared.definition().size());
    common::ask(bencher, entity, QueryOptions { gap, ..options() }, |_| true);
}
