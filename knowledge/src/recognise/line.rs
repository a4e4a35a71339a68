//! Straight segments.

use glam::{DVec3, DVec4};
use perpend_kernel::NurbsCurve;

use super::along::{Extent, Hull, extent, pieces};
use crate::classification::Kind;

/// The line from the start to the farthest control point, over the lengths that the curve runs; none where a control point is beside it by more than
/// the tolerance.
pub(super) fn candidate(curve: &NurbsCurve, tolerance: f64) -> Option<Kind> {
    let points = curve.control_points();
    let (origin, end) = (points[0], points[points.len() - 1]);
    let far = points.iter().copied().max_by(|a, b| a.distance(origin).total_cmp(&b.distance(origin)))?;
    // the end itself where it is as far, up to rounding: it is a point of the curve
    let towards = if end.distance(origin) >= far.distance(origin) * (1.0 - 1e-9) { end } else { far };
    let direction = (towards - origin).try_normalize()?;
    if points.iter().any(|p| across(*p, origin, direction) > tolerance) {
        return None;
    }
    let range = lengths(curve, origin, direction)?.range();
    Some(Kind::Line { origin, direction, range })
}

/// Bound of the distance between a curve and a segment of a line.
pub(super) fn gap(curve: &NurbsCurve, origin: DVec3, direction: DVec3, range: (f64, f64)) -> Option<f64> {
    let extent = lengths(curve, origin, direction)?;
    let wide = curve.control_points().iter().map(|p| across(*p, origin, direction)).fold(0.0, f64::max);
    let reach = curve.control_points().iter().map(|p| p.distance(origin)).fold(0.0, f64::max);
    Some(wide + extent.off(range) + extent.rounding(curve.degree()) * reach)
}

/// The distance of a point from a line.
fn across(p: DVec3, origin: DVec3, direction: DVec3) -> f64 {
    let arm = p - origin;
    (arm - arm.dot(direction) * direction).length()
}

/// How far the curve runs along the line.
pub(super) fn lengths(curve: &NurbsCurve, origin: DVec3, direction: DVec3) -> Option<Extent> {
    let pieces = pieces(curve, |p| DVec3::new((p - origin).dot(direction), 0.0, 0.0));
    extent(&pieces, |piece: &[DVec4], _| {
        let at = |p: &DVec4| p.x / p.w;
        let (least, greatest) =
            piece.iter().map(at).fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), t| (low.min(t), high.max(t)));
        Some(Hull { least, greatest, start: at(&piece[0]), end: at(&piece[piece.len() - 1]) })
    })
}
