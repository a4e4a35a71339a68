//! Boxes along the directions of a piece.

use glam::{DMat3, DVec3};
use perpend_kernel::Aabb;

use super::ROUNDING;

/// A box along three orthonormal axes, relative to a given origin.
#[derive(Debug, Clone, Copy)]
pub(super) struct OrientedBox {
    /// The axes, as rows.
    axes: DMat3,
    extent: Aabb,
}

impl OrientedBox {
    /// The box around points within `reach` of the origin, with its first axis along `along` and its third along the normal of `along` and
    /// `across`.
    ///
    /// The distance to the box is a bound only if the axes are orthonormal. Where the two directions are parallel to rounding
    /// their cross product is noise; so the normal is made orthogonal, twice at most, and the result is tested, and where it fails the
    /// box is aligned with the coordinate axes.
    pub(super) fn around(points: &[DVec3], reach: f64, along: DVec3, across: DVec3) -> Self {
        let axes = orthonormal(along, across)
            .or_else(|| orthonormal(along, along.any_orthogonal_vector()))
            .unwrap_or([DVec3::X, DVec3::Y, DVec3::Z]);
        let axes = DMat3::from_cols(axes[0], axes[1], axes[2]).transpose();
        let bounds = Aabb::around(points.iter().map(|p| axes * *p));
        // the products of the points and of the query with the axes round, each by less than 6 u of their lengths
        let margin = DVec3::splat(16.0 * ROUNDING * reach);
        Self { axes, extent: Aabb { min: bounds.min - margin, max: bounds.max + margin } }
    }

    /// The axes, as rows.
    pub(super) fn axes(&self) -> &DMat3 {
        &self.axes
    }

    /// Square of the distance from `x` to the box, less a margin: what is left of the axes' orthonormality stretches it by
    /// at most 9 u, and the product with them rounds by 6 u.
    pub(super) fn distance_squared(&self, x: DVec3) -> f64 {
        self.extent.distance_squared(self.axes * x) * (1.0 - 64.0 * ROUNDING)
    }
}

/// The unit vectors along `along`, along the part of `across` normal to it, and along their normal; none where these are not
/// orthonormal to 1e-15.
fn orthonormal(along: DVec3, across: DVec3) -> Option<[DVec3; 3]> {
    let x = along.try_normalize()?;
    let mut n = x.cross(across).try_normalize()?;
    let orthogonal = |a: DVec3, b: DVec3| a.dot(b).abs() < 1e-15;
    for _ in 0..2 {
        if orthogonal(x, n) {
            break;
        }
        n = (n - n.dot(x) * x).try_normalize()?;
    }
    let m = n.cross(x).try_normalize()?;
    (orthogonal(x, n) && orthogonal(m, n) && orthogonal(m, x)).then_some([x, m, n])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parallel_directions_give_an_honest_box() {
        // The directions are parallel to rounding: their normal is noise, and a box along it once cut off the foot.
        let net = [
            DVec3::ZERO,
            DVec3::new(-0.68, 0.040_000_000_000_000_01, -0.679_999_999_999_999_9),
            DVec3::new(-0.8, 0.1, -0.6),
            DVec3::new(0.6, -0.3, -0.4),
        ];
        let along = net[2] - net[0] + net[3] - net[1];
        let across = net[1] - net[0] + net[3] - net[2];
        let p = DVec3::new(-6.0, 3.0, -9.0);
        let nearest = net.iter().map(|c| c.distance(p)).fold(f64::MAX, f64::min);
        let bounds = OrientedBox::around(&net, 1.2, along, across);
        assert!(bounds.distance_squared(p).sqrt() <= nearest, "no control point is nearer than the box");
        for row in 0..3 {
            let length = bounds.axes.row(row).length();
            assert!((length - 1.0).abs() < 4e-16);
        }
    }
}
