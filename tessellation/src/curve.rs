//! Polylines of curves.

use glam::{DVec3, DVec4};
use perpend_kernel::bezier::curve_pieces;
use perpend_kernel::{NurbsCurve, cartesian};

use crate::patch::{halves, middle};
use crate::refine::{Part, inner_share, refine};
use crate::tessellate::{InvalidChord, Limits};

/// A polyline of a curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Polyline {
    /// The corners: the curve evaluated at `parameters`.
    pub points: Vec<DVec3>,
    /// The ascending parameters of the corners; the first and the last are the ends of the domain.
    pub parameters: Vec<f64>,
    /// The proven chord error: every point of the curve is within it of the polyline, and every point of the polyline of the curve.
    pub error: f64,
}

/// The polyline of a curve within a chord error, a length.
///
/// Every knot is a corner. Where the limit of [`Limits::segments`] is reached the worst parts have been split first, and
/// [`Polyline::error`] says what is left.
///
/// # Errors
///
/// The chord error is not positive.
pub fn polyline(curve: &NurbsCurve, chord: f64, limits: Limits) -> Result<Polyline, InvalidChord> {
    InvalidChord::check(chord)?;
    let pieces = curve_pieces(curve.knots(), &curve.homogeneous_points());
    let first = pieces.into_iter().map(|piece| Arc { over: (piece.span.start, piece.span.end), points: piece.points });
    let mut arcs = refine(first.collect(), chord, limits.segments);
    arcs.parts.sort_by(|a, b| a.over.0.total_cmp(&b.over.0));
    let mut parameters: Vec<f64> = arcs.parts.iter().map(|arc| arc.over.0).collect();
    parameters.push(curve.domain().1);
    let points = parameters.iter().map(|t| curve.point(*t)).collect();
    Ok(Polyline { points, parameters, error: arcs.error })
}

/// A part of a curve.
struct Arc {
    points: Vec<DVec4>,
    over: (f64, f64),
}

impl Part for Arc {
    /// Curve and chord are the same convex combinations, of the control points and of the points of the chord nearest to them; the ends are
    /// on the chord.
    fn error(&self) -> f64 {
        let places: Vec<DVec3> = self.points.iter().map(|point| cartesian(*point)).collect();
        let (from, to) = (places[0], places[places.len() - 1]);
        let farthest = places.iter().map(|place| distance_to_segment(*place, from, to)).fold(0.0, f64::max);
        inner_share(&self.points) * farthest
    }

    fn split(&self) -> Option<[Self; 2]> {
        let at = middle(self.over)?;
        let (low, high) = halves(&self.points);
        Some([Self { points: low, over: (self.over.0, at) }, Self { points: high, over: (at, self.over.1) }])
    }
}

fn distance_to_segment(p: DVec3, from: DVec3, to: DVec3) -> f64 {
    let along = to - from;
    let length_squared = along.length_squared();
    let share = if length_squared > 0.0 { ((p - from).dot(along) / length_squared).clamp(0.0, 1.0) } else { 0.0 };
    (p - (from + share * along)).length()
}
