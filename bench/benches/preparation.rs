//! What comes before the second query: the plan of an entity, the first query to it, and how both grow with its size?

mod common;

use std::sync::Arc;

use divan::Bencher;
use perpend_bench::{PreparedEntity, wavy};
use perpend_kernel::Definition;
use perpend_projection::{Prepared, Query, QueryOptions, Scratch};

const SET: &str = "seeds-surfaces";

fn main() {
    divan::main();
}

#[divan::bench(args = common::names(SET), max_time = 0.3)]
fn plan(bencher: Bencher, name: &str) {
    let definition = common::entity(SET, name).prepared.definition();
    bencher.bench_local(|| Prepared::new(Arc::clone(definition), None));
}

#[divan::bench(args = common::names(SET), max_time = 0.3)]
fn first_query(bencher: Bencher, name: &str) {
    let PreparedEntity { prepared, rows, .. } = common::entity(SET, name);
    first(bencher, prepared.definition(), rows[555].point);
}

#[divan::bench(args = [8, 16, 32, 64, 128], max_time = 0.5)]
fn first_query_to_a_wave_of_spans(bencher: Bencher, spans: usize) {
    let wave = Arc::new(Definition::from(wavy(spans).expect("a multiple of 8")));
    let above = wave.control_box().centre() + 0.3 * wave.size();
    first(bencher, &wave, above);
}

fn first(bencher: Bencher, definition: &Arc<Definition>, p: perpend::DVec3) {
    let query = Query::new(p, QueryOptions::default()).expect("a finite point");
    bencher.bench_local(|| {
        let prepared = Prepared::new(Arc::clone(definition), None);
        let foot = prepared.project(&query, &mut Scratch::default());
        (prepared, foot)
    });
}
