//! What does a query to a prepared curve cost: the mix of the test set, near points, far points?

mod common;

use divan::Bencher;
use perpend_projection::QueryOptions;

const SET: &str = "seeds-curves";

fn main() {
    divan::main();
}

#[divan::bench(args = common::names(SET), max_time = 0.3)]
fn mix(bencher: Bencher, name: &str) {
    common::ask(bencher, common::entity(SET, name), QueryOptions::default(), |_| true);
}

#[divan::bench(args = common::names(SET), max_time = 0.3)]
fn near(bencher: Bencher, name: &str) {
    common::ask(bencher, common::entity(SET, name), QueryOptions::default(), |distance| distance < 0.02);
}

#[divan::bench(args = common::names(SET), max_time = 0.3)]
fn far(bencher: Bencher, name: &str) {
    common::ask(bencher, common::entity(SET, name), QueryOptions::default(), |distance| distance > 20.0);
}
