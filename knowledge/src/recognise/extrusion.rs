//! Extrusions.

use glam::DVec3;
use perpend_kernel::{Direction, NurbsSurface};

use super::proof::rounding;
use super::weights::Separated;
use crate::classification::Kind;

/// The extrusion along the mean of the steps from one edge to the opposite one.
pub(super) fn candidate(surface: &NurbsSurface, along: Direction) -> Option<Kind> {
    let (n, m, index) = order(surface, along);
    let points = surface.control_points();
    let vector = (0..n).map(|i| points[index(i, m - 1)] - points[index(i, 0)]).sum::<DVec3>() / n as f64;
    (vector.length() > 0.0).then_some(Kind::Extrusion { vector, along })
}

/// Bound of the distance from the iso-curve at the start of `along`, moved along `vector`.
///
/// The surface is near to `profile + t vector` where every column of control points is the first one, moved alike, and the
/// weights are products; `t` runs from 0 to 1 where its coefficients start at 0, end at 1 and lie between.
pub(super) fn gap(surface: &NurbsSurface, vector: DVec3, along: Direction) -> Option<f64> {
    let (n, m, index) = order(surface, along);
    let points = surface.control_points();
    let length = vector.length();
    let step = |i, j| points[index(i, j)] - points[index(i, 0)];
    let (mut off, mut beyond) = (0.0_f64, 0.0_f64);
    for j in 0..m {
        let share = match j {
            0 => 0.0,
            j if j == m - 1 => 1.0,
            _ => (0..n).map(|i| step(i, j).dot(vector)).sum::<f64>() / (n as f64 * length * length),
        };
        beyond = beyond.max((share - 1.0).max(-share) * length);
        off = (0..n).map(|i| (step(i, j) - share * vector).length()).fold(off, f64::max);
    }
    let weight = |i, j| surface.weights().map_or(1.0, |w| w[index(i, j)]);
    let size = surface.control_box().diagonal();
    let moved = Separated::new((n, m), weight).moves(size + 2.0 * off);
    let gap = off + beyond + moved + rounding(surface.degree().0 + surface.degree().1) * (size + length);
    gap.is_finite().then_some(gap)
}

/// Counts across and along a direction, and where a control point stands.
pub(super) fn order(surface: &NurbsSurface, along: Direction) -> (usize, usize, impl Fn(usize, usize) -> usize) {
    let (rows, columns) = (surface.rows(), surface.columns());
    let by_v = along == Direction::V;
    let (n, m) = if by_v { (rows, columns) } else { (columns, rows) };
    (n, m, move |i, j| if by_v { i * columns + j } else { j * columns + i })
}
