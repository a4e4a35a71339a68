//! What the machine takes for the work that every solver does: a point of a bicubic B-spline surface with all second derivatives.

use std::time::Instant;

use glam::DVec3;
use perpend_bench::spread;
use perpend_kernel::{Direction, NurbsSurface};

/// How many places are evaluated in a pass.
const PLACES: u32 = 20_000;

/// Microseconds of an evaluation of a bicubic surface at scattered parameters.
pub(crate) fn evaluation_micros(surface: &NurbsSurface, passes: usize) -> f64 {
    let along = |direction: Direction, share: f64| {
        let (first, last) = surface.domain(direction);
        first + (last - first) * share
    };
    let at = |k: u32| {
        let share = spread(k) + 0.5;
        (along(Direction::U, share.x), along(Direction::V, share.y))
    };
    let places: Vec<(f64, f64)> = (0..PLACES).map(at).collect();
    let pass = |_| {
        let start = Instant::now();
        for (u, v) in &places {
            let mut d = [DVec3::ZERO; 9];
            surface.derivatives(*u, *v, 2, &mut d);
            std::hint::black_box(&d);
        }
        start.elapsed().as_secs_f64() * 1e6 / places.len() as f64
    };
    // the figure scales all others: it is timed more often than they are
    (0..5 * passes).map(pass).fold(f64::INFINITY, f64::min)
}
