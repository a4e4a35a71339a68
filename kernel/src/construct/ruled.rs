//! Ruled surfaces.

use super::compatible::compatible;
use crate::curve::NurbsCurve;
use crate::edit::InvalidEdit;
use crate::knots::KnotVector;
use crate::surface::NurbsSurface;

/// The surface of the segments from `start(u)` to `end(u)`, v in `[0, 1]`; its domain in u is that of `start`.
///
/// Where the curves differ they are made compatible: `end` is mapped to the domain of `start`, the lower degree elevated, and
/// each gets the other's knots. Knots that differ by no more than the rounding of the mapping count as one. The NURBS Book, §8.4.
/// Corresponding points are those of equal parameters; with unequal weights a ruling is a segment still, not run through evenly.
///
/// # Errors
///
/// The knots of `end` fall together over the domain of `start`; too many control points.
pub fn ruled(start: &NurbsCurve, end: &NurbsCurve) -> Result<NurbsSurface, InvalidEdit> {
    let rails = compatible(&[start, end])?;
    let (start, end) = (&rails[0], &rails[1]);
    let points = start.control_points.iter().zip(&end.control_points).flat_map(|(a, b)| [*a, *b]).collect();
    let rational = start.weights.is_some() || end.weights.is_some();
    let weight = |curve: &NurbsCurve, i: usize| curve.weights().map_or(1.0, |w| w[i]);
    let weights = (0..start.control_points.len()).flat_map(|i| [weight(start, i), weight(end, i)]);
    let weights = rational.then(|| weights.collect());
    Ok(NurbsSurface::checked(start.knots.clone(), KnotVector::bezier(1, 0.0, 1.0), points, weights)?)
}
