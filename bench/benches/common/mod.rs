//! The test sets for benchmarks: read once, and every answer judged before it is timed.

use std::collections::HashMap;
use std::sync::{LazyLock, Mutex};

use divan::Bencher;
use divan::counter::ItemsCount;
use perpend_bench::{Case, Judge, PreparedEntity, Row, corpora, prepared_set};
use perpend_projection::QueryOptions;

/// The sets that were read so far.
static SETS: LazyLock<Mutex<HashMap<&'static str, &'static [PreparedEntity]>>> = LazyLock::new(Mutex::default);

/// The entities of a set.
pub(crate) fn entities(set: &'static str) -> &'static [PreparedEntity] {
    SETS.lock().expect("nobody panics with it").entry(set).or_insert_with(|| {
        let file = |ending: &str| corpora().join(format!("{set}{ending}"));
        prepared_set(&file(".json"), &file(".truth.csv")).expect("the test sets are there").leak()
    })
}

/// The names of the entities of a set.
pub(crate) fn names(set: &'static str) -> impl Iterator<Item = &'static str> {
    entities(set).iter().map(|entity| entity.name.as_str())
}

/// The entity of this name.
pub(crate) fn entity(set: &'static str, name: &str) -> &'static PreparedEntity {
    entities(set).iter().find(|entity| entity.name == name).expect("one of the names")
}

/// Times queries to an entity by rows; `wanted` is given the distance in shares of the size.
#[allow(dead_code, reason = "not every file asks by rows")]
pub(crate) fn ask(bencher: Bencher, entity: &PreparedEntity, options: QueryOptions, wanted: impl Fn(f64) -> bool) {
    let definition = entity.prepared.definition();
    let rows: Vec<&Row> = entity.rows.iter().filter(|row| wanted(row.distance / definition.size())).collect();
    let points = rows.iter().map(|row| row.point);
    let mut case = Case::new(&*entity.name, &entity.prepared, points, options).expect("finite points");
    let judge = Judge::new(definition);
    let judge = options.gap.map_or(judge, |gap| judge.with_gap(gap));
    for (row, foot) in rows.iter().zip(case.answers()) {
        assert!(judge.faults(row, &foot).none(), "{}: {row:?} is answered by {foot:?}", entity.name);
    }
    time(bencher, case);
}

/// Times the queries of a case.
pub(crate) fn time(bencher: Bencher, mut case: Case) {
    bencher.counter(ItemsCount::new(case.len())).bench_local(|| case.ask_all());
}
