//! The parametrisation factor, where the record does not know it.

use glam::DVec3;
use perpend_kernel::{Definition, Direction};

use super::nodes::{nodes, thinned};

/// The most parameters a direction at which the speed of a surface is taken, and of a curve in all.
const SAMPLES: [usize; 2] = [1 << 10, 32];

/// `(max - min) / max` of the length of the first derivative along a direction, over samples; 1 where it vanishes everywhere. A curve
/// has 0 in v.
///
/// Heuristic: samples see neither the least nor the greatest speed exactly. The factor chooses how densely points are spread, and no
/// answer rests on it.
pub(super) fn factor(definition: &Definition, direction: Direction) -> f64 {
    let (mut least, mut greatest) = (f64::INFINITY, 0.0_f64);
    let mut take = |derivative: DVec3| {
        let speed = derivative.length();
        (least, greatest) = (least.min(speed), greatest.max(speed));
    };
    match definition {
        Definition::NurbsCurve(_) if direction == Direction::V => return 0.0,
        Definition::NurbsCurve(curve) => {
            for u in thinned(nodes(curve.knots(), curve.domain()), SAMPLES[0]) {
                let mut d = [DVec3::ZERO; 2];
                curve.derivatives(u, &mut d);
                take(d[1]);
            }
        }
        Definition::NurbsSurface(surface) => {
            let along = |direction| thinned(nodes(surface.knots(direction), surface.domain(direction)), SAMPLES[1]);
            let across = along(Direction::V);
            for u in along(Direction::U) {
                for v in &across {
                    let mut d = [DVec3::ZERO; 4];
                    surface.derivatives(u, *v, 1, &mut d);
                    take(if direction == Direction::U { d[2] } else { d[1] });
                }
            }
        }
    }
    // not `<=`: a speed beyond all numbers gives 1, too
    if greatest > 0.0 && greatest.is_finite() { ((greatest - least) / greatest).clamp(0.0, 1.0) } else { 1.0 }
}
