//! Ways to do something, timed in turn.

use std::time::Instant;

/// The least seconds that each of several ways takes, in `passes` turns of all of them: a disturbance then falls on one turn and not on all of one way.
pub(crate) fn least_seconds<const N: usize>(passes: usize, mut ways: [&mut dyn FnMut(); N]) -> [f64; N] {
    let mut least = [f64::INFINITY; N];
    for _ in 0..passes {
        for (way, least) in ways.iter_mut().zip(&mut least) {
            let start = Instant::now();
            way();
            *least = least.min(start.elapsed().as_secs_f64());
        }
    }
    least
}
