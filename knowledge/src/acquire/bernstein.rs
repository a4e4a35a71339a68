//! Polynomials in one or two parameters over the unit interval, by their Bernstein coefficients.
//!
//! A polynomial in one parameter has degree 0 in the second. All operations are convex combinations of coefficients, or
//! products of them: they lose a few `degree * ε` of the largest coefficient, nothing more.

use std::borrow::Cow;
use std::ops::{Add, Mul};
use std::sync::OnceLock;

use glam::{DVec3, DVec4};

/// What a coefficient can be.
pub(crate) trait Coefficient: Copy + Default + Add<Output = Self> + Mul<f64, Output = Self> {}

impl Coefficient for f64 {}
impl Coefficient for DVec3 {}
impl Coefficient for DVec4 {}

/// The parameter of a polynomial that an operation goes along.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Side {
    First,
    Second,
}

/// A polynomial: coefficient `(i, j)` at `i * (degree.1 + 1) + j`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Form<T> {
    pub degree: (usize, usize),
    pub coefficients: Vec<T>,
}

impl<T: Coefficient> Form<T> {
    /// The coefficients, each mapped.
    pub(crate) fn map<R: Coefficient>(&self, f: impl FnMut(T) -> R) -> Form<R> {
        Form { degree: self.degree, coefficients: self.coefficients.iter().copied().map(f).collect() }
    }

    /// The coefficients of rows `from..=to` of the first parameter.
    pub(crate) fn rows(&self, from: usize, to: usize) -> Self {
        let columns = self.degree.1 + 1;
        let coefficients = self.coefficients[from * columns..(to + 1) * columns].to_vec();
        Self { degree: (to - from, self.degree.1), coefficients }
    }

    /// The product, by `times` of coefficients. The NURBS Book, equation 1.27 and its tensor product, in scaled form.
    pub(crate) fn product<B: Coefficient, R: Coefficient>(
        &self,
        other: &Form<B>,
        times: impl Fn(T, B) -> R,
    ) -> Form<R> {
        let ((m, n), (k, l)) = (self.degree, other.degree);
        let degree = (m + k, n + l);
        let (a, b) = (self.scaled(), other.scaled());
        let mut coefficients = vec![R::default(); (degree.0 + 1) * (degree.1 + 1)];
        for i in 0..=m {
            for j in 0..=n {
                let x = a[i * (n + 1) + j];
                for g in 0..=k {
                    let start = (i + g) * (degree.1 + 1) + j;
                    let sums = &mut coefficients[start..=start + l];
                    for (sum, y) in sums.iter_mut().zip(&b[g * (l + 1)..=g * (l + 1) + l]) {
                        *sum = *sum + times(x, *y);
                    }
                }
            }
        }
        let (rows, columns) = (binomials(degree.0), binomials(degree.1));
        for (at, sum) in coefficients.iter_mut().enumerate() {
            *sum = *sum * (1.0 / (rows[at / (degree.1 + 1)] * columns[at % (degree.1 + 1)]));
        }
        Form { degree, coefficients }
    }

    /// The same polynomial with its degree in the first parameter raised by `by`.
    pub(crate) fn raised(&self, by: usize) -> Self {
        let one = Form { degree: (by, 0), coefficients: vec![1.0; by + 1] };
        if by == 0 { self.clone() } else { self.product(&one, |a, b| a * b) }
    }

    /// The polynomial over the lower and over the upper half of a parameter.
    pub(crate) fn halves(mut self, side: Side) -> (Self, Self) {
        let (m, n) = self.degree;
        let (steps, stride, lines, next) = match side {
            Side::First => (m, n + 1, n + 1, 1),
            Side::Second => (n, 1, m + 1, n + 1),
        };
        let mut lower = self.clone();
        for line in 0..lines {
            let base = line * next;
            for step in 1..=steps {
                for i in 0..=steps - step {
                    let (at, after) = (base + i * stride, base + (i + 1) * stride);
                    self.coefficients[at] = (self.coefficients[at] + self.coefficients[after]) * 0.5;
                }
                lower.coefficients[base + step * stride] = self.coefficients[base];
            }
        }
        (lower, self)
    }

    /// The value of a polynomial in one parameter, by de Casteljau's algorithm.
    pub(crate) fn at(&self, t: f64) -> T {
        let mut c = self.coefficients.clone();
        for last in (1..c.len()).rev() {
            for i in 0..last {
                c[i] = c[i] * (1.0 - t) + c[i + 1] * t;
            }
        }
        c[0]
    }

    /// The corners in the order of the coefficients, with their places in the unit square.
    pub(crate) fn corners(&self) -> impl Iterator<Item = (usize, (f64, f64))> + use<T> {
        let (m, n) = self.degree;
        let all = [(0, 0.0, 0.0), (n, 0.0, 1.0), (m * (n + 1), 1.0, 0.0), (m * (n + 1) + n, 1.0, 1.0)];
        all.into_iter()
            .filter(move |(_, s, t)| (m > 0 || *s == 0.0) && (n > 0 || *t == 0.0))
            .map(|(k, s, t)| (k, (s, t)))
    }

    fn scaled(&self) -> Vec<T> {
        let (rows, columns) = (binomials(self.degree.0), binomials(self.degree.1));
        let columns_count = self.degree.1 + 1;
        let scaled = |(at, c): (usize, &T)| *c * (rows[at / columns_count] * columns[at % columns_count]);
        self.coefficients.iter().enumerate().map(scaled).collect()
    }
}

/// The derivative in the first parameter of the rational `(x, y, z) / w`, times `w²`: equal to `x' w - x w'`, of degree `2p - 2`.
///
/// With `hi` and `lo` the polynomials of the last and of the first `p` coefficients it is `p (x_hi w_lo - x_lo w_hi)`: the
/// terms that cancel in the plain form are left out.
pub(crate) fn rational_hodograph(form: &Form<DVec4>) -> Form<DVec3> {
    let p = form.degree.0;
    let (lo, hi) = (form.rows(0, p - 1), form.rows(1, p));
    let crossed = hi.product(&lo, |a, b| a.truncate() * b.w - b.truncate() * a.w);
    crossed.map(|c| c * p as f64)
}

/// The derivative in the first parameter.
pub(crate) fn hodograph(form: &Form<DVec3>) -> Form<DVec3> {
    let (p, columns) = (form.degree.0, form.degree.1 + 1);
    let c = &form.coefficients;
    let coefficients = (0..p * columns).map(|k| (c[k + columns] - c[k]) * p as f64).collect();
    Form { degree: (p - 1, form.degree.1), coefficients }
}

/// The highest degree whose binomial coefficients are kept: more than a product of four derivatives of the highest degree has.
const KEPT: usize = 256;

/// The row of binomial coefficients, to a few `n ε`.
fn binomials(n: usize) -> Cow<'static, [f64]> {
    static ROWS: OnceLock<Vec<Vec<f64>>> = OnceLock::new();
    let rows = ROWS.get_or_init(|| (0..=KEPT).map(row).collect());
    rows.get(n).map_or_else(|| Cow::Owned(row(n)), |row| Cow::Borrowed(row.as_slice()))
}

fn row(n: usize) -> Vec<f64> {
    let mut row = vec![1.0; n + 1];
    for i in 1..=n {
        row[i] = row[i - 1] * (n + 1 - i) as f64 / i as f64;
    }
    row
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By de Casteljau, at any place.
    fn value(form: &Form<f64>, s: f64, t: f64) -> f64 {
        let line = |c: Vec<f64>, t: f64| {
            let mut c = c;
            while c.len() > 1 {
                c = c.windows(2).map(|w| w[0] * (1.0 - t) + w[1] * t).collect();
            }
            c[0]
        };
        line(form.coefficients.chunks(form.degree.1 + 1).map(|row| line(row.to_vec(), t)).collect(), s)
    }

    fn form(degree: (usize, usize), seed: usize) -> Form<f64> {
        let count = (degree.0 + 1) * (degree.1 + 1);
        Form { degree, coefficients: (0..count).map(|k| ((k * 7 + seed) % 11) as f64 - 4.0).collect() }
    }

    #[test]
    fn products_and_raised_forms_have_the_values_of_their_factors() {
        let (a, b) = (form((3, 2), 1), form((2, 4), 5));
        let (product, raised) = (a.product(&b, |x, y| x * y), a.raised(3));
        for k in 0..=20 {
            let (s, t) = (f64::from(k) / 20.0, f64::from(k * 3 % 20) / 20.0);
            assert!((value(&product, s, t) - value(&a, s, t) * value(&b, s, t)).abs() < 1e-12);
            assert!((value(&raised, s, t) - value(&a, s, t)).abs() < 1e-13);
        }
    }

    #[test]
    fn halves_are_the_whole() {
        let a = form((3, 2), 2);
        for (side, at) in [(Side::First, [0.5_f64, 1.0_f64]), (Side::Second, [1.0, 0.5])] {
            let (lower, upper) = a.clone().halves(side);
            let rest = [at[0].fract(), at[1].fract()];
            for (s, t) in [(0.25, 0.5), (0.75, 0.125), (1.0, 0.0)] {
                assert!((value(&lower, s, t) - value(&a, s * at[0], t * at[1])).abs() < 1e-13);
                assert!((value(&upper, s, t) - value(&a, rest[0] + s * at[0], rest[1] + t * at[1])).abs() < 1e-13);
            }
        }
    }

    #[test]
    fn the_crossed_hodograph_is_the_derivative_of_the_quotient() {
        let (x, w) = (form((3, 0), 3), form((3, 0), 3).map(|c| c.abs() + 1.0));
        let c = x.coefficients.iter().zip(&w.coefficients).map(|(x, w)| DVec4::new(*x, 0.0, 0.0, *w)).collect();
        let crossed = rational_hodograph(&Form { degree: (3, 0), coefficients: c }).map(|c| c.x);
        let quotient = |s: f64| value(&x, s, 0.0) / value(&w, s, 0.0);
        for k in 1..20 {
            let s = f64::from(k) / 20.0;
            let difference = (quotient(s + 1e-6) - quotient(s - 1e-6)) / 2e-6;
            assert!((value(&crossed, s, 0.0) / value(&w, s, 0.0).powi(2) - difference).abs() < 1e-7);
        }
    }
}
