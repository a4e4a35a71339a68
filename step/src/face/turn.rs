//! Angles and the parameters of the rational arcs that run along them.
//!
//! An arc of a kernel shape has equal spans of at most 90 degrees. On a span of half-angle `h` about the angle `m` its parameter is linear in
//! `tan((angle - m) / 2)`, which is `-tan(h / 2)` at the start and `tan(h / 2)` at the end.

use std::f64::consts::{FRAC_PI_2, TAU};

/// An arc of a kernel shape over the parameters `[0, 1]`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Turn {
    start: f64,
    angle: f64,
    spans: f64,
}

impl Turn {
    /// The arc over a range of angles.
    pub(super) fn new(range: (f64, f64)) -> Self {
        let difference = range.1 - range.0;
        // what the kernel takes for a full turn, it makes one
        let largest = range.0.abs().max(range.1.abs()).max(TAU);
        let is_full = (difference - TAU).abs() <= 2.0 * f64::EPSILON * largest;
        let angle = if is_full { TAU } else { difference };
        Self { start: range.0, angle, spans: (angle / FRAC_PI_2 - 1e-12).ceil().max(1.0) }
    }

    /// The parameter at an angle; at the nearer end outside of the range.
    pub(super) fn parameter(&self, angle: f64) -> f64 {
        let share = ((angle - self.start) / self.angle).clamp(0.0, 1.0) * self.spans;
        let span = share.floor().min(self.spans - 1.0);
        let quarter = 0.25 * self.angle / self.spans;
        // the angle from the middle of its span, halved
        let from_middle = (2.0 * (share - span) - 1.0) * quarter;
        let in_span = 0.5 * (1.0 + from_middle.tan() / quarter.tan());
        ((span + in_span.clamp(0.0, 1.0)) / self.spans).clamp(0.0, 1.0)
    }

    /// The angles where two spans meet.
    pub(super) fn joints(&self) -> Vec<f64> {
        (1..self.spans as usize).map(|k| self.start + self.angle * k as f64 / self.spans).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use perpend::{Circle, Frame};

    #[test]
    fn parameters_are_those_of_the_points_of_the_arc() {
        for range in [(0.0, TAU), (-1.3, 0.2), (0.4, 2.9), (-3.0, 3.0), (5.0, 5.0 + TAU), (0.0, FRAC_PI_2)] {
            let arc = Circle::new(Frame::WORLD, 1.0, range).and_then(|arc| arc.to_nurbs()).expect("an arc");
            let turn = Turn::new(range);
            for k in 0..=200 {
                let angle = range.0 + (range.1 - range.0) * f64::from(k) / 200.0;
                let at = arc.point(turn.parameter(angle));
                assert!(at.distance(glam::DVec3::new(angle.cos(), angle.sin(), 0.0)) < 4e-15, "{range:?} {angle}");
            }
        }
    }
}
