//! Curves over one domain, of one degree, with the same knots.

use crate::curve::NurbsCurve;
use crate::edit::{InvalidEdit, mapped};
use crate::invalid::Along;
use crate::knots::KnotVector;

/// The curves over the domain of the first one, elevated to the highest of their degrees, each with the knots of all.
///
/// Knots that differ by no more than the rounding of the mapping count as one. The NURBS Book, §8.4 and §10.3.
///
/// # Errors
///
/// Knots fall together over the domain of the first curve; too many control points.
pub(super) fn compatible(curves: &[&NurbsCurve]) -> Result<Vec<NurbsCurve>, InvalidEdit> {
    let Some(leading) = curves.first() else { return Ok(Vec::new()) };
    let (first, last) = leading.domain();
    let degree = curves.iter().map(|curve| curve.degree()).max().unwrap_or_default();
    let mut alike: Vec<NurbsCurve> = Vec::with_capacity(curves.len());
    let mut all: Vec<(f64, usize)> = Vec::new();
    for (k, curve) in curves.iter().enumerate() {
        let mut curve = (*curve).clone();
        if k > 0 {
            curve.knots = mapped(&curve.knots, first, last, Along::Curve)?;
        }
        curve = curve.elevate_degree(degree - curve.degree())?;
        if k > 0 {
            curve.knots = snapped(&curve.knots, &all, (first, last))?;
        }
        all = joined(&all, curve.knots.distinct());
        alike.push(curve);
    }
    alike.iter().map(|curve| curve.refine(&missing(&curve.knots, &all))).collect()
}

/// All knots of both, ascending, each as often as it occurs in the one that has more of it.
fn joined(known: &[(f64, usize)], more: impl Iterator<Item = (f64, usize)>) -> Vec<(f64, usize)> {
    let mut all: Vec<(f64, usize)> = known.iter().copied().chain(more).collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    all.chunk_by(|a, b| a.0 == b.0)
        .map(|run| (run[0].0, run.iter().map(|(_, count)| *count).max().unwrap_or_default()))
        .collect()
}

/// The knots with those that are others' but for rounding replaced by them.
fn snapped(knots: &KnotVector, others: &[(f64, usize)], domain: (f64, f64)) -> Result<KnotVector, InvalidEdit> {
    let rounding = 4.0 * f64::EPSILON * domain.0.abs().max(domain.1.abs());
    let snap = |knot: &f64| {
        let after = others.partition_point(|(other, _)| other < knot).min(others.len() - 1);
        let nearest = [others[after.saturating_sub(1)].0, others[after].0]
            .into_iter()
            .min_by(|a, b| (a - knot).abs().total_cmp(&(b - knot).abs()))
            .unwrap_or(*knot);
        if (nearest - knot).abs() <= rounding { nearest } else { *knot }
    };
    let snapped = knots.as_slice().iter().map(snap).collect();
    Ok(KnotVector::new(knots.degree(), snapped, knots.point_count(), Along::Curve)?)
}

/// The knots of `wanted`, as often as they lack in `present`.
fn missing(present: &KnotVector, wanted: &[(f64, usize)]) -> Vec<f64> {
    wanted
        .iter()
        .flat_map(|(knot, count)| std::iter::repeat_n(*knot, count.saturating_sub(present.multiplicity(*knot))))
        .collect()
}
