//! Points a second, as `perpend project` asks them of a whole model.

use glam::DVec3;
use perpend::QueryOptions;
use perpend_bench::Failure;

use crate::Run;
use crate::table::{Goal, Table};
use crate::timing::least_seconds;
use crate::whole::MANY;

/// How many points are asked at once.
const POINTS: usize = 20_000;

pub(crate) fn measure(run: &Run, table: &mut Table) -> Result<(), Failure> {
    table.heading(format!("{POINTS} scattered points at once through nearest_all"));
    let pools = [1, 2].map(|count| rayon::ThreadPoolBuilder::new().num_threads(count).build());
    let [one, two] = pools;
    let (one, two) = (one?, two?);
    for part in run.parts.iter().filter(|part| part.faces >= MANY) {
        let points: Vec<DVec3> = part.points.iter().copied().cycle().take(POINTS).collect();
        let ask = || {
            std::hint::black_box(part.model.nearest_all(&points, &QueryOptions::default()));
        };
        ask();
        let [one, two] = least_seconds(run.passes, [&mut || one.install(ask), &mut || two.install(ask)]);
        table.line(format!("{}, 1 thread", part.name), Goal::None, "points/s", POINTS as f64 / one);
        table.line(format!("{}, 2 threads", part.name), Goal::None, "points/s", POINTS as f64 / two);
        table.line("  throughput of 1", Goal::AtLeast(1.9), "x", one / two);
    }
    Ok(())
}
