//! Taylor series of both sides of a line of knots.

use glam::{DVec3, DVec4};
use perpend_kernel::{Aabb, binomial};

use super::bernstein::{hodograph, rational_hodograph};
use super::near::{Near, parted};
use super::source::Piece;

/// The Taylor series of a piece in the first parameter at one of its ends; every term is a polynomial in the second one, and
/// stands for a step of the same length on both sides.
pub(super) struct Jet {
    /// The points times their weights, term by term.
    pub points: Vec<Near<DVec3>>,
    /// The weights, term by term.
    pub weights: Vec<Near<f64>>,
    /// The derivative along the line, times the square of the weight where weights differ, per unit of the second parameter's
    /// span; none for a curve.
    pub along: Option<Near<DVec3>>,
    rational: bool,
}

impl Jet {
    /// `step` is the length of the step as a multiple of the piece's width; `reach` bounds the control points.
    pub(super) fn of(piece: &Piece, at_end: bool, step: f64, reach: f64, rational: bool) -> Self {
        let (p, q) = piece.form.degree;
        // extraction leaves 5p u of every coefficient; the subtraction of the middle u of the reach
        let first = f64::EPSILON * 8.0 * (p + q + 4) as f64;
        let columns = q + 1;
        let mut rows: Vec<Vec<DVec4>> = piece.form.coefficients.chunks(columns).map(<[DVec4]>::to_vec).collect();
        if at_end {
            rows.reverse();
        }
        let mut jet = Self { points: Vec::new(), weights: Vec::new(), along: None, rational };
        let mut scale = 1.0;
        for k in 0..=p {
            let factor = binomial(p, k) * scale;
            let row: Vec<DVec4> = rows[0].iter().map(|c| *c * factor).collect();
            // each difference doubles the errors, and adds its own
            let error = factor.abs() * first * 2.0_f64.powi(k as i32) * if k > 0 { 2.0 } else { 1.0 };
            let (points, weights) = parted(&row, error * reach, if rational { error } else { 0.0 });
            jet.points.push(points);
            jet.weights.push(weights);
            // the differences of a reversed row count backwards: an odd one changes its sign
            scale *= if at_end { -step } else { step };
            for i in 0..p - k {
                let (row, rest) = rows[i..].split_at_mut(1);
                for (c, next) in row[0].iter_mut().zip(&rest[0]) {
                    *c = *next - *c;
                }
            }
        }
        if q > 0 {
            let homogeneous = super::bernstein::Form {
                degree: (q, 0),
                coefficients: if at_end {
                    &piece.form.coefficients[p * columns..]
                } else {
                    &piece.form.coefficients[..columns]
                }
                .to_vec(),
            };
            let form =
                if rational { rational_hodograph(&homogeneous) } else { hodograph(&homogeneous.map(|c| c.truncate())) };
            jet.along = Some(Near { form, error: first * 4.0 * q as f64 * reach });
        }
        jet
    }

    /// The first derivative across the line; times the square of the weight where weights differ.
    pub(super) fn across(&self) -> Near<DVec3> {
        if !self.rational {
            return self.points[1].clone();
        }
        let scaled = |a: &Near<DVec3>, w: &Near<f64>| a.product(w, |a, w| a * w);
        scaled(&self.points[1], &self.weights[0]).plus(-1.0, &scaled(&self.points[0], &self.weights[1]))
    }

    /// The term of order `k`, zero beyond the degree.
    fn term(&self, k: usize) -> Option<(&Near<DVec3>, &Near<f64>)> {
        Some((self.points.get(k)?, self.weights.get(k)?))
    }
}

/// The Taylor series of the difference of both sides, times both weights: `A₊ w₋ - A₋ w₊`. Where all weights are 1, of the
/// difference itself. Orders from `first` on, up to the last that can differ from zero.
pub(super) fn differences<'a>(
    before: &'a Jet,
    after: &'a Jet,
    first: usize,
) -> impl Iterator<Item = (usize, Near<DVec3>)> + 'a {
    let p = before.points.len() - 1;
    let last = if before.rational { 2 * p } else { p };
    (first..=last).map(move |k| (k, difference(before, after, k)))
}

fn difference(before: &Jet, after: &Jet, k: usize) -> Near<DVec3> {
    if !before.rational {
        return after.points[k].plus(-1.0, &before.points[k]);
    }
    let mut sum: Option<Near<DVec3>> = None;
    for i in 0..=k {
        for (one, other, sign) in [(after, before, 1.0), (before, after, -1.0)] {
            if let (Some((a, _)), Some((_, w))) = (one.term(i), other.term(k - i)) {
                let product = a.product(w, |a, w| a * w);
                sum = Some(match sum {
                    None => Near { form: product.form.map(|c| c * sign), ..product },
                    Some(sum) => sum.plus(sign, &product),
                });
            }
        }
    }
    sum.unwrap_or_else(|| Near { form: before.points[0].form.map(|_| DVec3::ZERO), error: 0.0 })
}

/// Bounds of the Taylor series of `1 / (w₋ w₊)`, up to order `last`: what turns bounds of [`differences`] into bounds of the
/// jumps of the definition itself.
pub(super) fn reciprocal(before: &Jet, after: &Jet, last: usize) -> Vec<f64> {
    let low = |w: &Near<f64>| w.form.coefficients.iter().copied().fold(f64::INFINITY, f64::min) - w.error;
    let least = low(&before.weights[0]) * low(&after.weights[0]);
    if !before.rational {
        return std::iter::once(1.0).chain(std::iter::repeat_n(0.0, last)).collect();
    }
    if least <= 0.0 {
        return vec![f64::INFINITY; last + 1];
    }
    let size = |jet: &Jet, k: usize| jet.weights.get(k).map_or(0.0, Near::bound);
    let product = |k: usize| (0..=k).map(|i| size(before, i) * size(after, k - i)).sum::<f64>();
    let mut series = vec![1.0 / least];
    for k in 1..=last {
        let sum: f64 = (1..=k).map(|i| product(i) * series[k - i]).sum();
        series.push(sum / least);
    }
    series
}

/// The largest diagonal of the control points' boxes of pieces that face each other.
pub(super) fn extent(before: &[Piece], after: &[Piece]) -> f64 {
    let pairs = before.iter().zip(after);
    pairs.map(|(a, b)| Aabb::around(a.points().chain(b.points())).diagonal()).fold(0.0, f64::max)
}
