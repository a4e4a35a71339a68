//! Control points of a smaller space, fitted to those of a larger one.

use glam::{DVec3, DVec4};

use super::banded::least_squares;
use crate::bounds::Aabb;
use crate::homogeneous::{cartesian, homogeneous};

/// Control points, and weights where there are any.
pub(super) type Fitted = (Vec<DVec3>, Option<Vec<f64>>);

/// The `count` points a line for which the blends `rows` come nearest to `points`, by least squares in homogeneous form about the
/// centre of the box; point `k` of line `j` stands at `k * width + j`.
///
/// A point of which a row is a mere copy, the ends among them, keeps its bits. None where a weight is not positive.
pub(super) fn fit(
    rows: &[(usize, Vec<f64>)],
    points: &[DVec3],
    weights: Option<&[f64]>,
    width: usize,
    count: usize,
) -> Option<Fitted> {
    let centre = Aabb::around(points.iter().copied()).centre();
    let weight = |k: usize| weights.map_or(1.0, |w| w[k]);
    let right = points.iter().enumerate().map(|(k, p)| homogeneous(*p - centre, weight(k))).collect();
    let solved: Vec<DVec4> = least_squares(rows, right, width, count);
    let rational = weights.is_some();
    let place = |q: &DVec4| centre + if rational { cartesian(*q) } else { q.truncate() };
    let mut fitted: Vec<DVec3> = solved.iter().map(place).collect();
    let mut blended: Option<Vec<f64>> = rational.then(|| solved.iter().map(|q| q.w).collect());
    for (row, (first, shares)) in rows.iter().enumerate() {
        if *shares == [1.0] {
            let (from, to) = (row * width..(row + 1) * width, first * width..(first + 1) * width);
            fitted[to.clone()].copy_from_slice(&points[from.clone()]);
            if let (Some(blended), Some(weights)) = (&mut blended, weights) {
                blended[to].copy_from_slice(&weights[from]);
            }
        }
    }
    let positive = blended.iter().flatten().all(|w| *w > 0.0);
    positive.then_some((fitted, blended))
}
