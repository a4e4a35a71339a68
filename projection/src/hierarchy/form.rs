//! The form whose signs are the proof, and the bound of its rounding.
//!
//! For a leaf with homogeneous net `(A, w)` about its own origin, a query at `x` and a distance `tau`,
//!
//! ```text
//! G(s, t) = |A(s, t) - x w(s, t)|² - tau² w(s, t)²
//! ```
//!
//! is non-negative exactly where the leaf is no nearer than `tau`. It is a Bernstein polynomial of twice the leaf's degree with
//! coefficients
//!
//! ```text
//! g = c0 - 2 x · c1 + (|x|² - tau²) c2,     c0 ~ |A|²,  c1 ~ A w,  c2 ~ w²
//! ```
//!
//! so three tables give it for every query without a division. They are made by the first proof that needs the form; the ranges of a polynomial leaf
//! are made of the same coefficients and keep none. Where all weights are 1, `c2 = 1` has no table: then the form
//! leaves `tau` out and is compared with `tau²` instead of 0, and stays good when `tau` falls.
//!
//! # Rounding
//!
//! With `r = max|A / w|`, `W = max w`, `N = (p + 1)(q + 1)` and `u = 2⁻⁵³`, to first order in `u`:
//! a coefficient of `c0` is a sum of at most `N` products, each of two scaled points (two roundings), a scalar product (three),
//! the sum (`N - 1`) and the division by the two binomials (two): relative to `Σ |terms| <= r² c2` an error of `(N + 6) u`;
//! likewise `(N + 5) u r c2` for the vector `c1` and `(N + 4) u c2` for `c2`. Combining them takes four multiplications and four
//! additions, each with partial sums of at most `((|x| + r)² + tau²) c2`: `5 u` of it, and `5 u |x|² + 2 u tau²` for
//! `|x|² - tau²`. All together, with `c2 <= W²`,
//!
//! ```text
//! |error of g| <= K u ((|x| + r)² + tau²) W²,     K = 1.25 (N + 16), for N < 7: 1.25 (N + 20)
//! ```
//!
//! where `N + 17` was used up: what is left over pays for the rounding of the differences that the tests form of `g`.

use fearless_simd::prelude::*;
use fearless_simd::{Level, dispatch, f64x4};
use glam::{DVec3, DVec4};
use perpend_kernel::binomial;
use smallvec::SmallVec;

use super::ROUNDING;
use super::net::{LANES, Layout};

/// What the form needs to know of a leaf.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shape<'a> {
    pub degree: (usize, usize),
    pub rational: bool,
    pub net: &'a [DVec4],
}

impl Shape<'_> {
    /// The net of the form: twice the leaf's degrees.
    pub(super) fn layout(&self) -> Layout {
        Layout { m: 2 * self.degree.0, n: 2 * self.degree.1 }
    }
}

/// The factor `K` of the rounding bound.
pub(super) fn rounding_factor((p, q): (usize, usize)) -> f64 {
    let n = (p + 1) * (q + 1);
    1.25 * (n as f64 + if n < 7 { 20.0 } else { 16.0 })
}

/// The bound of a coefficient's rounding error; `heaviest` is `W`.
pub(super) fn rounding_bound(degree: (usize, usize), x: f64, r: f64, tau: f64, heaviest: f64) -> f64 {
    rounding_factor(degree) * ROUNDING * ((x + r).powi(2) + tau * tau) * heaviest * heaviest
}

/// Appends the form's net at `x` to `out`. `tau` enters that of a rational leaf only.
pub(super) fn form(level: Level, leaf: Shape<'_>, tables: &[f64], x: DVec3, tau: f64, out: &mut Vec<f64>) {
    let len = leaf.layout().len();
    let from = out.len();
    out.resize(from + len, 0.0);
    let (g, kappa) = (&mut out[from..], x.length_squared() - tau * tau);
    dispatch!(level, simd => if leaf.rational {
        combine::<_, true>(simd, tables, x, kappa, g);
    } else {
        combine::<_, false>(simd, tables, x, x.length_squared(), g);
    });
}

#[inline(always)]
fn combine<S: Simd, const RATIONAL: bool>(simd: S, tables: &[f64], x: DVec3, last: f64, g: &mut [f64]) {
    let len = g.len();
    let table = |k: usize| &tables[k * len..(k + 1) * len];
    let (c0, cx, cy, cz) = (table(0), table(1), table(2), table(3));
    let c2 = if RATIONAL { table(4) } else { c0 };
    let x = -2.0 * x;
    for at in (0..len).step_by(LANES) {
        let lanes = at..at + LANES;
        let load = |table: &[f64]| f64x4::from_slice(simd, &table[lanes.clone()]);
        let linear = load(c0) + load(cx) * x.x + load(cy) * x.y + load(cz) * x.z;
        let sum = if RATIONAL { linear + load(c2) * last } else { linear + last };
        sum.store_slice(&mut g[lanes]);
    }
}

/// The Bernstein coefficients of `c0`, `c1` and `c2`, in row order.
pub(super) struct Coefficients {
    /// `c0`.
    pub squares: Vec<f64>,
    /// `c1` and, as fourth coordinate, `c2`.
    pub vectors: Vec<DVec4>,
}

impl Coefficients {
    /// Points are scaled by their binomials once, products are summed over unordered pairs, and the sums are divided once.
    pub(super) fn of(leaf: Shape<'_>) -> Self {
        let ((p, q), Layout { m, n }) = (leaf.degree, leaf.layout());
        let mut scaled: SmallVec<[DVec4; 16]> = leaf.net.into();
        for (i, row) in scaled.chunks_exact_mut(q + 1).enumerate() {
            row.iter_mut().enumerate().for_each(|(j, a)| *a *= binomial(p, i) * binomial(q, j));
        }
        let len = (m + 1) * (n + 1);
        let (mut squares, mut vectors) = (vec![0.0; len], vec![DVec4::ZERO; len]);
        for i in 0..=p {
            for j in 0..=q {
                let a = scaled[i * (q + 1) + j];
                let at = 2 * i * (n + 1) + 2 * j;
                squares[at] += a.truncate().length_squared();
                vectors[at] += a.w * a;
                for k in i..=p {
                    // in the row itself, the points behind this one
                    let from = if k == i { j + 1 } else { 0 };
                    let at = (i + k) * (n + 1) + j;
                    let sums = squares[at..].iter_mut().zip(&mut vectors[at..]).skip(from);
                    for ((square, vector), b) in sums.zip(&scaled[k * (q + 1) + from..(k + 1) * (q + 1)]) {
                        *square += 2.0 * a.truncate().dot(b.truncate());
                        *vector += b.w * a + a.w * *b;
                    }
                }
            }
        }
        for i in 0..=m {
            for j in 0..=n {
                let binomials = binomial(m, i) * binomial(n, j);
                squares[i * (n + 1) + j] /= binomials;
                vectors[i * (n + 1) + j] /= binomials;
            }
        }
        Self { squares, vectors }
    }
}

/// The tables, each laid out as the form's net: `c0`, the coordinates of `c1`, and `c2` where the leaf is rational.
pub(super) fn tables(leaf: Shape<'_>) -> Box<[f64]> {
    let (layout, Coefficients { squares, vectors }) = (leaf.layout(), Coefficients::of(leaf));
    let len = layout.len();
    let mut tables = vec![0.0; len * if leaf.rational { 5 } else { 4 }];
    for (k, table) in tables.chunks_exact_mut(len).enumerate() {
        for i in 0..=layout.m {
            for j in 0..=layout.n {
                let from = i * (layout.n + 1) + j;
                table[layout.at(i, j)] = if k == 0 { squares[from] } else { vectors[from][k - 1] };
            }
        }
        layout.pad(table);
    }
    tables.into()
}

#[cfg(test)]
mod tests {
    use super::super::double_double::{DoubleDouble, Random};
    use super::super::net;
    use super::*;

    /// The form's coefficients in double-double, by the plain double sum.
    fn exact(leaf: Shape<'_>, x: DVec3, tau: f64) -> Vec<DoubleDouble> {
        let ((p, q), Layout { m, n }) = (leaf.degree, leaf.layout());
        let number = DoubleDouble::from;
        let mut kappa = x.to_array().iter().fold(number(0.0), |sum, x| sum + number(*x) * number(*x));
        if leaf.rational {
            kappa = kappa - number(tau) * number(tau);
        }
        let mut sums = vec![number(0.0); (m + 1) * (n + 1)];
        for (e, a) in leaf.net.iter().enumerate() {
            for (f, b) in leaf.net.iter().enumerate() {
                let (i, j, k, l) = (e / (q + 1), e % (q + 1), f / (q + 1), f % (q + 1));
                let mut value = kappa * number(a.w) * number(b.w);
                for d in 0..3 {
                    let cross = number(a[d]) * number(b.w) + number(b[d]) * number(a.w);
                    value = value + number(a[d]) * number(b[d]) - number(x[d]) * cross;
                }
                let factor = [binomial(p, i), binomial(p, k), binomial(q, j), binomial(q, l)];
                value = factor.iter().fold(value, |value, c| value * number(*c));
                value = value / binomial(m, i + k) / binomial(n, j + l);
                let at = (i + k) * (n + 1) + j + l;
                sums[at] = sums[at] + value;
            }
        }
        sums
    }

    /// Every coefficient of random leaves, fresh and after splits of the form, errs by less than its bound; and the bound is
    /// not so wide that it says nothing: a hundredth of it is exceeded.
    #[test]
    fn coefficients_err_within_their_bound_and_beyond_a_hundredth_of_it() {
        let mut random = Random(3);
        let (mut worst, mut worst_after_splits) = (0.0_f64, 0.0_f64);
        for round in 0..600 {
            let degrees = [(1, 0), (2, 0), (3, 0), (7, 0), (1, 1), (2, 1), (3, 3), (2, 4)];
            let (p, q) = degrees[round % degrees.len()];
            let rational = round % 3 > 0;
            let mut weight = || if rational { 2.0 * 10.0_f64.powf(random.between(-3.0, 0.0)) } else { 1.0 };
            let weights: Vec<f64> = (0..(p + 1) * (q + 1)).map(|_| weight()).collect();
            let points: Vec<DVec3> = weights.iter().map(|_| random.point()).collect();
            let net: Vec<DVec4> = points.iter().zip(&weights).map(|(p, w)| (*p * *w).extend(*w)).collect();
            let r = net.iter().map(|h| (h.truncate() / h.w).length()).fold(0.0, f64::max);
            let heaviest = weights.iter().copied().fold(0.0, f64::max);
            let x = random.point() * r * 10.0_f64.powf(random.between(-3.0, 3.0));
            let tau = (x.length() + r) * random.between(0.0, 1.0);
            let leaf = Shape { degree: (p, q), rational, net: &net };
            let (layout, level) = (leaf.layout(), Level::new());
            let mut found = Vec::new();
            form(level, leaf, &tables(leaf), x, tau, &mut found);
            let mut plainest = Vec::new();
            form(Level::baseline(), leaf, &tables(leaf), x, tau, &mut plainest);
            assert_eq!(found, plainest, "the same bits at every level");
            let mut expected = exact(leaf, x, tau);
            let mut bound = rounding_bound(leaf.degree, x.length(), r, tau, heaviest);
            let error = |found: &[f64], expected: &[DoubleDouble], bound: f64| {
                let width = layout.n + 1;
                let errors = expected.iter().enumerate().map(|(at, exact)| {
                    let found = found[layout.at(at / width, at % width)];
                    (DoubleDouble::from(found) - *exact).to_f64().abs() / bound
                });
                errors.fold(0.0, f64::max)
            };
            worst = worst.max(error(&found, &expected, bound));
            let Layout { m, n } = layout;
            for _ in 0..8 {
                let largest = net::largest(level, &found, layout);
                let (mut high, mut exact_high) = (found.clone(), expected.clone());
                if n == 0 || random.next().is_multiple_of(2) {
                    net::halve(level, &mut found, &mut high, layout, true);
                    halve(&mut expected, &mut exact_high, (0..=n).map(|j| (j, n + 1)), m);
                    bound += m as f64 * ROUNDING * largest;
                } else {
                    net::halve(level, &mut found, &mut high, layout, false);
                    halve(&mut expected, &mut exact_high, (0..=m).map(|i| (i * (n + 1), 1)), n);
                    bound += n as f64 * ROUNDING * largest;
                }
                if random.next().is_multiple_of(2) {
                    (found, expected) = (high, exact_high);
                }
            }
            worst_after_splits = worst_after_splits.max(error(&found, &expected, bound));
        }
        assert!(worst < 1.0 && worst_after_splits < 1.0, "the bound is exceeded: {worst}, {worst_after_splits}");
        assert!(worst > 0.01, "the bound could be a hundred times smaller: {worst}");
    }

    fn halve(
        low: &mut [DoubleDouble],
        high: &mut [DoubleDouble],
        lines: impl Iterator<Item = (usize, usize)>,
        degree: usize,
    ) {
        for (start, step) in lines {
            let at = |k: usize| start + k * step;
            high[at(degree)] = low[at(degree)];
            for k in 1..=degree {
                for i in (k..=degree).rev() {
                    low[at(i)] = (low[at(i)] + low[at(i - 1)]) / 2.0;
                }
                high[at(degree - k)] = low[at(degree)];
            }
        }
    }
}
