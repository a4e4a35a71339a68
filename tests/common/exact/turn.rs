//! Angles of 32 digits.

use std::f64::consts::{FRAC_PI_2, TAU};

use crate::common::double_double::Dd;

/// π/2.
const QUARTER: Dd = Dd { high: FRAC_PI_2, low: 6.123_233_995_736_766e-17 };

/// Cosine and sine of an angle, by Taylor's series about the nearest multiple of π/2.
pub fn direction(angle: f64) -> [Dd; 2] {
    let quarters = (angle / FRAC_PI_2).round();
    let rest = Dd::from(angle) - Dd::from(quarters) * QUARTER;
    let square = rest * rest;
    let (mut cos, mut sin) = (Dd::ONE, rest);
    let (mut even, mut odd) = (Dd::ONE, rest);
    for k in 1..16 {
        let n = 2.0 * f64::from(k);
        even = -(even * square) / Dd::from(n * (n - 1.0));
        odd = -(odd * square) / Dd::from(n * (n + 1.0));
        (cos, sin) = (cos + even, sin + odd);
    }
    match quarters.rem_euclid(4.0) as u8 {
        0 => [cos, sin],
        1 => [-sin, cos],
        2 => [-cos, -sin],
        _ => [sin, -cos],
    }
}

/// A range of angles, of either direction.
#[derive(Debug, Clone, Copy)]
pub struct Range {
    /// Directions of both ends, from the lower angle to the higher.
    pub ends: [[Dd; 2]; 2],
    /// A full turn: the ends meet.
    pub full: bool,
    /// The higher end as seen from the lower one.
    width: Dd,
}

impl Range {
    pub fn new(range: (f64, f64)) -> Self {
        let (low, high) = (range.0.min(range.1), range.0.max(range.1));
        // a full turn but for the rounding of the two ends
        let full = high - low >= TAU - 4.0 * f64::EPSILON * low.abs().max(high.abs()).max(TAU);
        let mut ends = [direction(low), direction(high)];
        if full {
            ends[1] = ends[0];
        }
        Self { ends, full, width: order(from(ends[0], ends[1])) }
    }

    /// Whether the direction `(x, y)` lies in the range. Of a null vector: whether the range is full.
    pub fn holds(&self, x: Dd, y: Dd) -> bool {
        self.full || order(from(self.ends[0], [x, y])) <= self.width
    }
}

/// The direction `b` as seen from the direction `a`.
fn from(a: [Dd; 2], b: [Dd; 2]) -> [Dd; 2] {
    [a[0] * b[0] + a[1] * b[1], a[0] * b[1] - a[1] * b[0]]
}

/// A number of `[0, 4)` that grows with the angle of a direction from 0 to a full turn.
fn order([x, y]: [Dd; 2]) -> Dd {
    let [u, v] = [magnitude(x), magnitude(y)];
    if u + v <= Dd::ZERO {
        return Dd::from(4.0);
    }
    let share = y / (u + v);
    match (x >= Dd::ZERO, y >= Dd::ZERO) {
        (true, true) => share,
        (false, _) => Dd::from(2.0) - share,
        (true, false) => Dd::from(4.0) + share,
    }
}

pub fn magnitude(x: Dd) -> Dd {
    if x < Dd::ZERO { -x } else { x }
}
