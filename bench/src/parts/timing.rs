//! Ways to do something, timed in turn.

use std::ops::Range;
use std::time::Instant;

/// How many queries are timed at once: they take less time than another program is given before it is this one's turn again.
const SLICE: usize = 25;

/// The least seconds that each of several ways takes, in `passes` turns of all of them: a disturbance then falls on one turn and not on all of one way.
pub(crate) fn least_seconds<const N: usize>(passes: usize, mut ways: [&mut dyn FnMut(); N]) -> [f64; N] {
    let mut least = [f64::INFINITY; N];
    for _ in 0..passes {
        for (way, least) in ways.iter_mut().zip(&mut least) {
            *least = least.min(seconds(way));
        }
    }
    least
}

/// The same for ways to ask `count` queries, of which each asks those in a range: the sum of the least seconds of short ranges, so that a long way is
/// disturbed no more than a short one.
pub(crate) fn least_seconds_of<const N: usize>(
    passes: usize,
    count: usize,
    mut ways: [&mut dyn FnMut(Range<usize>); N],
) -> [f64; N] {
    let slices: Vec<Range<usize>> = (0..count).step_by(SLICE).map(|from| from..count.min(from + SLICE)).collect();
    let mut least = [const { Vec::new() }; N];
    least.iter_mut().for_each(|least| least.resize(slices.len(), f64::INFINITY));
    for _ in 0..passes {
        for (way, least) in ways.iter_mut().zip(&mut least) {
            for (slice, least) in slices.iter().zip(least) {
                *least = least.min(seconds(|| way(slice.clone())));
            }
        }
    }
    least.map(|least: Vec<f64>| least.into_iter().sum())
}

fn seconds(way: impl FnOnce()) -> f64 {
    let start = Instant::now();
    way();
    start.elapsed().as_secs_f64()
}
