//! Ruled surfaces.

use crate::curve::NurbsCurve;
use crate::edit::{InvalidEdit, mapped};
use crate::invalid::Along;
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
    let (first, last) = start.domain();
    let end = NurbsCurve { knots: mapped(&end.knots, first, last, Along::Curve)?, ..end.clone() };
    let degree = start.degree().max(end.degree());
    let start = start.elevate_degree(degree - start.degree())?;
    let end = end.elevate_degree(degree - end.degree())?;
    let end = NurbsCurve { knots: snapped(&end.knots, &start.knots)?, ..end };
    let (start, end) =
        (start.refine(&missing(&start.knots, &end.knots))?, end.refine(&missing(&end.knots, &start.knots))?);
    let points = start.control_points.iter().zip(&end.control_points).flat_map(|(a, b)| [*a, *b]).collect();
    let rational = start.weights.is_some() || end.weights.is_some();
    let weight = |curve: &NurbsCurve, i: usize| curve.weights().map_or(1.0, |w| w[i]);
    let weights = (0..start.control_points.len()).flat_map(|i| [weight(&start, i), weight(&end, i)]);
    let weights = rational.then(|| weights.collect());
    Ok(NurbsSurface::checked(start.knots.clone(), KnotVector::bezier(1, 0.0, 1.0), points, weights)?)
}

/// The knots with those that are others' but for rounding replaced by them.
fn snapped(knots: &KnotVector, others: &KnotVector) -> Result<KnotVector, InvalidEdit> {
    let (first, last) = others.domain();
    let rounding = 4.0 * f64::EPSILON * first.abs().max(last.abs());
    let others: Vec<f64> = others.distinct().map(|(knot, _)| knot).collect();
    let snap = |knot: &f64| {
        let after = others.partition_point(|other| other < knot).min(others.len() - 1);
        let nearest = [others[after.saturating_sub(1)], others[after]]
            .into_iter()
            .min_by(|a, b| (a - knot).abs().total_cmp(&(b - knot).abs()))
            .unwrap_or(*knot);
        if (nearest - knot).abs() <= rounding { nearest } else { *knot }
    };
    let snapped = knots.as_slice().iter().map(snap).collect();
    Ok(KnotVector::new(knots.degree(), snapped, knots.point_count(), Along::Curve)?)
}

/// The knots of `wanted`, as often as they lack in `present`.
fn missing(present: &KnotVector, wanted: &KnotVector) -> Vec<f64> {
    wanted
        .distinct()
        .flat_map(|(knot, count)| std::iter::repeat_n(knot, count.saturating_sub(present.multiplicity(knot))))
        .collect()
}
