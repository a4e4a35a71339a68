//! Planes.

use glam::DVec3;
use perpend_kernel::NurbsSurface;

use super::proof::rounding;
use crate::classification::Kind;

/// The parallelogram of a surface's corners, and the plane through its control points.
pub(super) fn candidates(surface: &NurbsSurface) -> Vec<Kind> {
    let (points, columns) = (surface.control_points(), surface.columns());
    let origin = points[0];
    let (a, b) = (points[points.len() - columns] - origin, points[columns - 1] - origin);
    let mut kinds = Vec::new();
    if let Some(normal) = a.cross(b).try_normalize() {
        kinds.push(Kind::Plane { origin, normal, sides: Some((a, b)) });
    }
    let far = points.iter().copied().max_by(|p, q| p.distance(origin).total_cmp(&q.distance(origin)));
    let area = |far: DVec3, p: &DVec3| (far - origin).cross(*p - origin).length();
    let apart = far.and_then(|far| Some((far, *points.iter().max_by(|p, q| area(far, p).total_cmp(&area(far, q)))?)));
    if let Some(normal) = apart.and_then(|(far, p)| (far - origin).cross(p - origin).try_normalize()) {
        kinds.push(Kind::Plane { origin, normal, sides: None });
    }
    kinds
}

/// Bound of the distance of a surface from a plane and, with sides, from the parallelogram, both ways.
///
/// Within the sides: every control point lies in the parallelogram up to `beyond`, and every edge's along its side. Then the
/// boundary runs once around the parallelogram's, so that the surface covers it but for a strip along the boundary, and there
/// the edges are that near.
pub(super) fn gap(surface: &NurbsSurface, origin: DVec3, normal: DVec3, sides: Option<(DVec3, DVec3)>) -> Option<f64> {
    let points = surface.control_points();
    let (mut flat, mut reach) = (0.0_f64, 0.0_f64);
    for p in points {
        flat = flat.max((*p - origin).dot(normal).abs());
        reach = reach.max(p.distance(origin));
    }
    let rounding = rounding(surface.degree().0 + surface.degree().1) * reach;
    let Some((a, b)) = sides else { return Some(flat + rounding) };
    let area = a.cross(b).length();
    // coordinates across a side, as lengths: they do not depend on how long the side is
    let across = [b.cross(normal).try_normalize()?, normal.cross(a).try_normalize()?];
    let width = [area / b.length(), area / a.length()];
    let (rows, columns) = (surface.rows(), surface.columns());
    let mut beyond = (a.dot(normal).abs()).max(b.dot(normal).abs());
    for (k, p) in points.iter().enumerate() {
        let (i, j) = (k / columns, k % columns);
        for (direction, (at, last)) in [(i, rows - 1), (j, columns - 1)].into_iter().enumerate() {
            let along = (*p - origin).dot(across[direction]);
            let width = width[direction];
            let off = match at {
                0 => along.abs(),
                at if at == last => (along - width).abs(),
                _ => (-along).max(along - width),
            };
            beyond = beyond.max(off);
        }
    }
    // a step beyond two sides at once, measured across each, is longer where they meet at a sharp angle
    let sharp = area / (a.length() * b.length());
    Some(flat + rounding + 4.0 * beyond / sharp)
}
