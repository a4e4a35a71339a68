//! What makes an answer right, false or uncertified. The bounds are those that the answers' documentation promises.

use glam::DVec3;

/// The spacing of f64 at 1.
pub const EPSILON: f64 = f64::EPSILON;

/// Rounding of a distance measured between points of the world: 16 ulps of the largest coordinate.
pub fn rounding(reach: f64, p: DVec3, distance: f64) -> f64 {
    1e-13 * distance + 16.0 * EPSILON * reach.max(p.abs().max_element())
}

/// Whether the distance of a real point proves `lower_bound` false. No allowance is made for the place of the
/// entity in the world: a bound pays for its own rounding.
pub fn is_false_bound(lower_bound: f64, real: f64, size: f64) -> bool {
    !(lower_bound <= real + 1e-12 * size + 1e-15 * real)
}

/// Whether the answer is proven to within `gap`.
pub fn is_certified(distance: f64, lower_bound: f64, gap: f64, reach: f64, p: DVec3) -> bool {
    distance - lower_bound <= gap + 32.0 * EPSILON * (reach + p.abs().max_element())
}
