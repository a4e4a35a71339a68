//! Definitions that a few points show to be of no class, before anything is fitted.
//!
//! What is refused here would be refused by its proof: the points lie off by far more than the tolerance, so much more that it does not matter how
//! well the points tell the shape. What passes is fitted and proved as ever.

use glam::{DVec2, DVec3};
use perpend_kernel::{Direction, NurbsCurve, NurbsSurface};

use super::axis::through;
use super::curves::parameters;
use super::ellipse::equation;
use super::extrusion::order;

/// A point is off a shape that other points tell where it is farther from it than this many tolerances and this share of the points' extent. Where
/// these are the points that span the largest triangle, the shape of an accepted class is a few tolerances from theirs.
const OFF: (f64, f64) = (1e3, 1e-6);

/// Points that bend less than this tell no plane and no circle: twice the area of their triangle as a share of its longest side's square.
const BENT: f64 = 1e-2;

/// A curve is looked at where this many equal parts of its domain begin and end.
const PARTS: u32 = 8;

fn off(tolerance: f64, extent: f64) -> f64 {
    OFF.0 * tolerance + OFF.1 * extent
}

/// Whether points of a curve show that it is no arc of a circle or an ellipse.
pub(super) fn conics(curve: &NurbsCurve, tolerance: f64) -> bool {
    let row: Vec<DVec3> = parameters(curve.domain(), PARTS).map(|u| curve.point(u)).collect();
    let Some(((plane, area), extent)) = through(&row).zip(farthest(&row)) else { return false };
    if area < BENT * extent * extent {
        return false;
    }
    let off = off(tolerance, extent);
    let on_a_circle = |p: &DVec3| (p.distance(plane.centre) - row[0].distance(plane.centre)).abs() <= off;
    if row.iter().any(|p| (*p - row[0]).dot(plane.axis).abs() > off) {
        return true;
    }
    if row.iter().all(on_a_circle) {
        return false;
    }
    let (x, y) = plane.axis.any_orthonormal_pair();
    let flat: Vec<DVec2> =
        row.iter().map(|p| DVec2::new((*p - row[0]).dot(x), (*p - row[0]).dot(y)) / extent).collect();
    // the equation's slope is at most twice the smaller half-axis, which is at most about the extent over the bend
    equation(&flat).is_some_and(|equation| flat.iter().any(|p| equation.at(*p).abs() > off / (BENT * extent)))
}

/// Whether a row of points shows that it lies on no circle.
pub(super) fn circles(row: &[DVec3], tolerance: f64) -> bool {
    let Some(((circle, area), extent)) = through(row).zip(farthest(row)) else { return false };
    if area < BENT * extent * extent {
        return false;
    }
    let (off, radius) = (off(tolerance, extent), row[0].distance(circle.centre));
    row.iter().any(|p| (*p - row[0]).dot(circle.axis).abs() > off || (p.distance(circle.centre) - radius).abs() > off)
}

/// Whether control points show that a surface is no plane.
pub(super) fn planes(surface: &NurbsSurface, tolerance: f64) -> bool {
    let (points, columns) = (surface.control_points(), surface.columns());
    let origin = points[0];
    let (a, b) = (points[points.len() - columns] - origin, points[columns - 1] - origin);
    let (normal, extent) = (a.cross(b), a.length().max(b.length()));
    if normal.length() < BENT * extent * extent {
        return false;
    }
    let normal = normal.normalize();
    // a point is told by the corners as well as it lies near them
    let is_off = |p: &DVec3| {
        let arm = *p - origin;
        arm.dot(normal).abs() > off(tolerance, extent.max(arm.length())) / BENT
    };
    points.iter().any(is_off)
}

/// Whether control points show that the iso-curves along a direction are no segments between their ends: the surface is then neither an extrusion
/// along it nor ruled.
pub(super) fn rulings(surface: &NurbsSurface, along: Direction, tolerance: f64) -> bool {
    let (n, m, index) = order(surface, along);
    let points = surface.control_points();
    (0..n).any(|i| {
        let (start, end) = (points[index(i, 0)], points[index(i, m - 1)]);
        let chord = end - start;
        let direction = chord.normalize_or_zero();
        (1..m - 1).any(|j| {
            let arm = points[index(i, j)] - start;
            // where the ends are one, the whole iso-curve is there too
            (arm - arm.dot(direction) * direction).length() > off(tolerance, chord.length().max(arm.length()))
        })
    })
}

/// The largest distance from the first point of a row.
fn farthest(row: &[DVec3]) -> Option<f64> {
    row.iter().map(|p| p.distance(row[0])).reduce(f64::max)
}
