//! The coordinates that a query works in: relative to the entity, and of its size.

use glam::{DVec3, DVec4};
use perpend_kernel::{Definition, homogeneous};

use super::ROUNDING;

/// An entity's own coordinates: its box's centre is the origin, and its size lies in `[1, 2)`.
///
/// The scale is a power of two, so that scaling is exact; the subtraction `p - origin` rounds once, by at most
/// `u |p - origin|` a coordinate, however far the entity lies from the world's origin.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Frame {
    pub origin: DVec3,
    pub scale: f64,
    /// The entity's size in the model's unit.
    pub size: f64,
}

impl Frame {
    pub(crate) fn of(definition: &Definition) -> Self {
        let bounds = definition.control_box();
        let size = bounds.diagonal();
        Self { origin: bounds.centre(), scale: power_of_two_below(size).recip(), size }
    }

    /// World coordinates to the entity's own.
    pub(crate) fn enter(&self, p: DVec3) -> DVec3 {
        (p - self.origin) * self.scale
    }

    /// A length of the entity's own coordinates in the model's unit.
    pub(crate) fn length(&self, local: f64) -> f64 {
        local / self.scale
    }

    /// The definition's control points in these coordinates, homogeneous, and whether their weights differ at all.
    ///
    /// Weights are divided by the largest. Where all are equal the entity is polynomial, whatever their value.
    pub(crate) fn net(&self, definition: &Definition) -> (Vec<DVec4>, bool) {
        let points = definition.control_points();
        match definition.weights() {
            Some(weights) if weights.iter().any(|w| *w != weights[0]) => {
                let largest = weights.iter().fold(0.0_f64, |a, w| a.max(*w));
                (points.iter().zip(weights).map(|(p, w)| homogeneous(self.enter(*p), w / largest)).collect(), true)
            }
            _ => (points.iter().map(|p| self.enter(*p).extend(1.0)).collect(), false),
        }
    }

    /// The reserve `dg`: how far rounding may have moved the surface that the forms speak of, in these coordinates.
    ///
    /// Every step from the definition to a leaf forms convex combinations, so each moves the surface by at most a few roundings
    /// of the largest |control point| `reach` (all factors of a combination are non-negative, with a relative error each; numerator
    /// and weight of a rational piece are moved alike, hence the factor two):
    ///
    /// - entering the frame and forming `w P`: 4u;
    /// - the extraction of the Bézier piece, `6 n + 1` per direction of degree `n` (five operations a level of the blossom, then
    ///   the sum), twice: `12 (p + q) + 4`;
    /// - up to [`DEEPEST`](super::DEEPEST) halvings, one rounding a level and `n` levels each;
    /// - as many new centres, 5u each (subtract, divide by the weight, multiply back).
    pub(super) fn reserve((p, q): (usize, usize), reach: f64) -> f64 {
        let halvings = super::DEEPEST as f64;
        (12.0 * (p + q) as f64 + 20.0 + halvings * (p.max(q) as f64 + 5.0)) * ROUNDING * reach
    }
}

/// The largest power of two that does not exceed `x`, for a normal `x > 0`.
pub(super) fn power_of_two_below(x: f64) -> f64 {
    f64::from_bits(x.to_bits() & (0x7ff << 52))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_of_two_bracket_their_number() {
        for x in [1.0, 1.5, 2.0, 3.7e-9, 1e100, 0.999_999_999_999_999_9] {
            let power = power_of_two_below(x);
            assert!(power <= x && x < 2.0 * power && power.log2().fract() == 0.0, "{x}: {power}");
        }
    }
}
