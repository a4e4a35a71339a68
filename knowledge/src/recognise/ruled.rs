//! Ruled surfaces.

use glam::{DVec3, DVec4};
use perpend_kernel::{Direction, NurbsSurface};

use super::extrusion::order;
use super::least_squares::least_squares;
use super::proof::rounding;

/// Bound of the distance from the segments between the ends of every iso-curve along `ruling`.
///
/// Where every row of homogeneous control points is `a` times the first and `b` times the last one, `a` and `b` not
/// negative, every iso-curve runs from its start to its end on the segment between them. What a row is beside that moves
/// points by no more than the largest quotient of a control point's residual by its weight.
pub(super) fn gap(surface: &NurbsSurface, ruling: Direction) -> Option<f64> {
    let (n, m, index) = order(surface, ruling);
    let (centre, size) = (surface.control_box().centre(), surface.control_box().diagonal());
    let point = |i, j| -> DVec4 {
        let weight = surface.weights().map_or(1.0, |w| w[index(i, j)]);
        let arm: DVec3 = (surface.control_points()[index(i, j)] - centre) / size;
        (arm * weight).extend(weight)
    };
    let row = |j| (0..n).map(|i| point(i, j)).collect::<Vec<DVec4>>();
    let numbers = |row: &[DVec4]| row.iter().flat_map(DVec4::to_array).collect::<Vec<f64>>();
    let (first, last) = (row(0), row(m - 1));
    let mut off = 0.0_f64;
    for j in 1..m - 1 {
        let middle = row(j);
        let shares = least_squares([numbers(&first), numbers(&last)], numbers(&middle))?;
        let (a, b) = (shares[0].max(0.0), shares[1].max(0.0));
        for ((p, q), r) in middle.iter().zip(&first).zip(&last) {
            let rest = *p - a * *q - b * *r;
            // points lie within half the size of the centre
            off = off.max((rest.truncate().length() + 0.5 * rest.w.abs()) / p.w);
        }
    }
    let gap = size * (off + rounding(surface.degree().0 + surface.degree().1));
    gap.is_finite().then_some(gap)
}
