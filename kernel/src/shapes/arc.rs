//! Arcs of the unit circle as rational quadratics.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::check::is_full;
use crate::knots::KnotVector;

/// An arc of the unit circle: `points[k]` is `(x, y, weight)`, the knots run over `[0, 1]`.
#[derive(Debug, Clone)]
pub(crate) struct Arc {
    pub(crate) knots: KnotVector,
    pub(crate) points: Vec<(f64, f64, f64)>,
}

impl Arc {
    /// The arc over a valid range of angles.
    ///
    /// Joints lie on the circle; the point between joints `e` and `f` is where their tangents meet, `(e + f) / (1 + e·f)`, with
    /// weight `√((1 + e·f) / 2)`, the cosine of half the angle. The NURBS Book, §7.3 and algorithm A7.1.
    pub(crate) fn new(range: (f64, f64)) -> Self {
        let full = is_full(range);
        let angle = if full { TAU } else { range.1 - range.0 };
        // no span more for an excess that is rounding
        let spans = (angle / FRAC_PI_2 - 1e-12).ceil().max(1.0);
        let count = spans as usize;
        let mut joints: Vec<(f64, f64)> = (0..=count)
            .map(|k| if k == count { range.1 } else { range.0 + angle * k as f64 / spans })
            .map(direction)
            .collect();
        if full {
            joints[count] = joints[0];
        }
        let mut points = vec![(joints[0].0, joints[0].1, 1.0)];
        for pair in joints.windows(2) {
            let (e, f) = (pair[0], pair[1]);
            let lift = 1.0 + (e.0 * f.0 + e.1 * f.1);
            points.push(((e.0 + f.0) / lift, (e.1 + f.1) / lift, (0.5 * lift).sqrt()));
            points.push((f.0, f.1, 1.0));
        }
        let mut knots = vec![0.0; 3];
        for k in 1..count {
            knots.extend([k as f64 / spans; 2]);
        }
        knots.extend([1.0; 3]);
        Self { knots: KnotVector::trusted(2, knots), points }
    }
}

/// Cosine and sine; exact at multiples of 90 degrees, so that poles are points and full turns close.
pub(crate) fn direction(angle: f64) -> (f64, f64) {
    let quarters = angle / FRAC_PI_2;
    if quarters == quarters.round() && quarters * FRAC_PI_2 == angle && quarters.abs() < 1e6 {
        return [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)][quarters.rem_euclid(4.0) as usize];
    }
    (angle.cos(), angle.sin())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_full_turn_has_four_spans_wherever_it_starts() {
        for start in [0.0, 1.0, -7.3, 100.0, FRAC_PI_2] {
            let arc = Arc::new((start, start + TAU));
            assert_eq!(arc.points.len(), 9, "{start}");
            assert_eq!(arc.points[0], arc.points[8]);
        }
    }

    #[test]
    fn quarters_are_exact() {
        let arc = Arc::new((0.0, TAU));
        let weight = 0.5_f64.sqrt();
        assert_eq!(arc.points[..4], [(1.0, 0.0, 1.0), (1.0, 1.0, weight), (0.0, 1.0, 1.0), (-1.0, 1.0, weight)]);
        assert_eq!(direction(-FRAC_PI_2), (0.0, -1.0));
    }
}
