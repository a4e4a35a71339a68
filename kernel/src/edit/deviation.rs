//! How far two descriptions over one domain are apart, proved by control points.
//!
//! Both are brought to one degree and one knot vector, by degree elevation and knot insertion; then control points are compared. With
//! `P, w` the one and `Q, z` the other, over the same knots,
//!
//! ```text
//! C - C' = (Σ B_i (w_i (P_i - Q_i) + (w_i - z_i)(Q_i - C'))) / Σ B_i w_i
//! ```
//!
//! and `C'` lies, wherever `B_i` is not zero, in the hull of the `Q` that share a span with it: the diagonal of their box bounds
//! `|Q_i - C'|`. So no point is farther than the largest `|P_i - Q_i| + |w_i - z_i| / w_i · diagonal_i`.

use glam::DVec3;

use crate::bounds::Aabb;
use crate::curve::NurbsCurve;
use crate::invalid::Direction;
use crate::knots::KnotVector;
use crate::surface::NurbsSurface;

impl NurbsCurve {
    /// A proven bound of the distance between the points of both curves at equal parameters, rounding included; none where
    /// the domains differ, or where the common refinement would have too many control points.
    #[must_use]
    pub fn deviation_from(&self, other: &Self) -> Option<f64> {
        if self == other {
            return Some(0.0);
        }
        let mut steps = 0;
        let raise = |curve: &Self, by: usize| curve.elevate_degree(by).ok();
        let (mine, theirs) = level(self.degree(), other.degree());
        let (a, b) = (raise(self, mine)?, raise(other, theirs)?);
        let (for_a, for_b) = missing(&a.knots, &b.knots)?;
        steps += mine + theirs + usize::from(!for_a.is_empty()) + usize::from(!for_b.is_empty());
        let (a, b) = (a.refine(&for_a).ok()?, b.refine(&for_b).ok()?);
        let window = (a.degree(), 0);
        let net = |curve: &Self| (curve.control_points.clone(), curve.weights.clone());
        Some(compare(net(&a), net(&b), 1, window, (a.degree() + 1) * steps))
    }
}

impl NurbsSurface {
    /// A proven bound of the distance between the points of both surfaces at equal parameters; see
    /// [`NurbsCurve::deviation_from`].
    #[must_use]
    pub fn deviation_from(&self, other: &Self) -> Option<f64> {
        if self == other {
            return Some(0.0);
        }
        let mut rounding = 0;
        let (mut a, mut b) = (self.clone(), other.clone());
        for direction in [Direction::U, Direction::V] {
            let (mine, theirs) = level(a.knots(direction).degree(), b.knots(direction).degree());
            a = a.elevate_degree(direction, mine).ok()?;
            b = b.elevate_degree(direction, theirs).ok()?;
            let (for_a, for_b) = missing(a.knots(direction), b.knots(direction))?;
            let steps = mine + theirs + usize::from(!for_a.is_empty()) + usize::from(!for_b.is_empty());
            rounding += steps * (a.knots(direction).degree() + 1);
            (a, b) = (a.refine(direction, &for_a).ok()?, b.refine(direction, &for_b).ok()?);
        }
        let (window, columns) = (a.degree(), a.columns());
        Some(compare((a.control_points, a.weights), (b.control_points, b.weights), columns, window, rounding))
    }
}

/// By how much each of two degrees is to be raised.
fn level(a: usize, b: usize) -> (usize, usize) {
    (b.saturating_sub(a), a.saturating_sub(b))
}

/// The knots that each of two vectors of one degree lacks; none where the domains differ.
fn missing(a: &KnotVector, b: &KnotVector) -> Option<(Vec<f64>, Vec<f64>)> {
    if a.domain() != b.domain() {
        return None;
    }
    let lacking = |of: &KnotVector, other: &KnotVector| {
        other
            .breaks()
            .flat_map(|knot| {
                let times = knot.multiplicity.saturating_sub(of.multiplicity(knot.at));
                std::iter::repeat_n(knot.at, times)
            })
            .collect()
    };
    Some((lacking(a, b), lacking(b, a)))
}

/// The bound of the module's head, and the rounding of the steps that led here.
///
/// A step (one elevation, one refinement) rounds a share by at most `2.5 p ε`, its use and the sum by `(p + 3) ε`, the division by
/// `2 ε`: together below `8 (p + 1) ε` of the largest |point|; in the rational case numerator and weight have it, each times
/// a length of at most twice that. `rounding` is the sum of `p + 1` over the steps.
fn compare(
    (p, w): (Vec<DVec3>, Option<Vec<f64>>),
    (q, z): (Vec<DVec3>, Option<Vec<f64>>),
    columns: usize,
    window: (usize, usize),
    rounding: usize,
) -> f64 {
    let reach = p.iter().chain(&q).map(|point| point.length()).fold(0.0, f64::max);
    let apart = p.iter().zip(&q).map(|(p, q)| (*p - *q).length());
    let rational = w.is_some() || z.is_some();
    let largest = if rational {
        let (w, z) = (scaled(w, p.len()), scaled(z, q.len()));
        let spread = spread(&q, columns, window);
        let weights = w.iter().zip(&z).zip(spread).map(|((w, z), spread)| (w - z).abs() / w * spread);
        apart.zip(weights).map(|(apart, weight)| apart + weight).fold(0.0, f64::max)
    } else {
        apart.fold(0.0, f64::max)
    };
    let factor = if rational { 24 } else { 8 };
    (1.0 + 8.0 * f64::EPSILON) * largest + (factor * rounding + 8) as f64 * f64::EPSILON * reach
}

/// Weights by the first of them: a common factor changes nothing.
fn scaled(weights: Option<Vec<f64>>, count: usize) -> Vec<f64> {
    weights.map_or_else(|| vec![1.0; count], |weights| weights.iter().map(|w| w / weights[0]).collect())
}

/// The diagonal of the box of each control point and those that share a span with it, `window` to each side.
fn spread(points: &[DVec3], columns: usize, window: (usize, usize)) -> Vec<f64> {
    let rows = points.len() / columns;
    let around = |at: usize, reach: usize, end: usize| at.saturating_sub(reach)..(at + reach + 1).min(end);
    let across: Vec<Aabb> = (0..points.len())
        .map(|k| Aabb::around(around(k % columns, window.1, columns).map(|j| points[k - k % columns + j])))
        .collect();
    (0..points.len())
        .map(|k| {
            let rows = around(k / columns, window.0, rows);
            rows.fold(Aabb::EMPTY, |all, i| all.join(across[i * columns + k % columns])).diagonal()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wave(weights: Option<Vec<f64>>) -> NurbsCurve {
        let points = (0..7).map(|i| DVec3::new(f64::from(i), f64::from(i * i % 5), f64::from(i % 2))).collect();
        let knots = vec![0.0, 0.0, 0.0, 0.0, 0.2, 0.5, 0.9, 1.0, 1.0, 1.0, 1.0];
        NurbsCurve::new(3, knots, points, weights).expect("valid")
    }

    #[test]
    fn other_forms_of_a_curve_deviate_by_rounding() {
        for weights in [None, Some(vec![1.0, 2.0, 0.5, 1.0, 4.0, 1.0, 1.5])] {
            let curve = wave(weights);
            assert_eq!(curve.deviation_from(&curve), Some(0.0));
            let other = curve.refine(&[0.1, 0.2, 0.7]).and_then(|c| c.elevate_degree(2)).expect("valid");
            for bound in [curve.deviation_from(&other), other.deviation_from(&curve)] {
                assert!(bound.expect("one domain") < 2e-12, "{bound:?}");
            }
        }
    }

    #[test]
    fn weights_with_a_common_factor_are_the_same_curve() {
        let (curve, seven) = (wave(None), wave(Some(vec![7.0; 7])));
        assert!(curve.deviation_from(&seven).expect("one domain") < 1e-13);
    }

    #[test]
    fn a_moved_point_and_another_weight_are_bounded() {
        let weights = vec![1.0, 2.0, 0.5, 1.0, 4.0, 1.0, 1.5];
        let curve = wave(Some(weights.clone()));
        let mut points = curve.control_points().to_vec();
        points[3].z += 0.25;
        let moved =
            NurbsCurve::new(3, curve.knots().as_slice().to_vec(), points, Some(weights.clone())).expect("valid");
        assert!((curve.deviation_from(&moved).expect("one domain") - 0.25).abs() < 1e-12);
        let mut other = weights;
        other[3] = 1.1;
        let heavier = wave(Some(other));
        let bound = curve.deviation_from(&heavier).expect("one domain");
        let seen = (0..=1000).map(|k| f64::from(k) / 1000.0).map(|u| curve.point(u).distance(heavier.point(u)));
        let seen = seen.fold(0.0, f64::max);
        assert!(seen > 0.0 && seen <= bound && bound < 20.0 * seen, "{seen} seen, {bound} proven");
    }

    #[test]
    fn other_domains_are_not_compared() {
        let curve = wave(None);
        assert_eq!(curve.deviation_from(&curve.with_domain(0.0, 2.0).expect("valid")), None);
    }
}
