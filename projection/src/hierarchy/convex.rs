//! When a form is convex on a box, and how strongly: a diagonal lower bound of its Hessian.

use fearless_simd::prelude::*;
use fearless_simd::{Level, dispatch, f64x4};

use super::net::{self, Differences, Extent, LANES, Layout, with_extent};

/// `H >= diag(s, t)` on a box, both positive: the form's second derivatives in the leaf's parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Curvature {
    pub s: f64,
    pub t: f64,
}

impl Curvature {
    /// From lower bounds of both second derivatives and the largest |mixed derivative|: with `rho² = mixed² / (s t)`, if both are positive and `rho`
    /// is less than [`CORRELATED`], `H >= (1 - rho) diag(s, t)`. A millionth of that pays for the rounding of `1 - rho`.
    #[inline(always)]
    pub(super) fn uncorrelated(s: f64, t: f64, mixed: f64) -> Option<Self> {
        // not `<=`: a NaN must fail too
        if !(s > 0.0 && t > 0.0) {
            return None;
        }
        let rho = mixed / (s * t).sqrt();
        let left = (1.0 - rho) * (1.0 - 1e-6);
        (rho <= CORRELATED).then_some(Self { s: left * s, t: left * t })
    }
}

/// A box's net, the box's extents, and the bound of the coefficients' rounding.
#[derive(Debug, Clone, Copy)]
pub(super) struct Patch<'a> {
    pub g: &'a [f64],
    pub layout: Layout,
    pub extent: (f64, f64),
    pub rounding: f64,
}

/// Below this share of the mean curvature the matrix test's bound is not worth a Newton iteration.
const WORTHWHILE: f64 = 0.02;

/// Above this correlation of the interval test the matrix test, if it holds, gives the better bound.
const CORRELATED: f64 = 0.98;

/// How a form bends on a box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Bend {
    /// Convex, with a proven lower bound of the Hessian.
    Convex(Curvature),
    /// Convex in s alone (`in_s`) or in t alone, with a lower bound of its second differences there, as far as the coefficients tell.
    Valley { in_s: bool, bend: f64 },
    /// Neither, as far as the coefficients tell.
    Open,
}

/// How the form is found to bend. `scratch` is working memory.
pub(super) fn bend(level: Level, patch: Patch<'_>, scratch: &mut Vec<f64>) -> Bend {
    dispatch!(level, simd => with_extent!(patch.layout, extent => {
        let differences = net::differences(simd, patch.g, extent);
        match either(simd, patch, extent, differences, scratch) {
            Some(curvature) => Bend::Convex(curvature),
            None => one_way(patch, differences),
        }
    }))
}

/// A proven lower bound of the Hessian on the box, if the form is found convex there.
pub(super) fn curvature(level: Level, patch: Patch<'_>, scratch: &mut Vec<f64>) -> Option<Curvature> {
    match bend(level, patch, scratch) {
        Bend::Convex(curvature) => Some(curvature),
        Bend::Valley { .. } | Bend::Open => None,
    }
}

/// A form in two variables that is convex in one of them alone.
fn one_way(Patch { layout, rounding, .. }: Patch<'_>, differences: Differences) -> Bend {
    let (down, along) = (differences.down - 4.0 * rounding, differences.along - 4.0 * rounding);
    match (layout.m > 0 && layout.n > 0, down > 0.0, along > 0.0) {
        (true, true, false) => Bend::Valley { in_s: true, bend: down },
        (true, false, true) => Bend::Valley { in_s: false, bend: along },
        _ => Bend::Open,
    }
}

#[inline(always)]
fn either<S: Simd>(
    simd: S,
    patch: Patch<'_>,
    extent: impl Extent,
    differences: Differences,
    scratch: &mut Vec<f64>,
) -> Option<Curvature> {
    match patch.layout {
        Layout { m: 0, .. } => in_one(patch, differences).map(|t| Curvature { s: 0.0, t: t / patch.extent.1.powi(2) }),
        Layout { n: 0, .. } => in_one(patch, differences).map(|s| Curvature { s: s / patch.extent.0.powi(2), t: 0.0 }),
        _ => by_intervals(patch, differences).or_else(
            #[inline(always)]
            || by_matrices(simd, patch, extent, scratch),
        ),
    }
}

/// The least second derivative of a net in one variable over its own parameter, if that is positive.
fn in_one(patch: Patch<'_>, differences: Differences) -> Option<f64> {
    let degree = patch.layout.along();
    let least = differences.along - 4.0 * patch.rounding;
    (degree >= 2 && least > 0.0).then(|| least * (degree * (degree - 1)) as f64)
}

/// Second derivatives as intervals: with `rho² = max Gst² / (min Gss min Gtt) < 1`, `H >= (1 - rho) diag(min Gss, min Gtt)`.
///
/// A second difference of coefficients errs by 4 of their bounds.
fn by_intervals(patch: Patch<'_>, differences: Differences) -> Option<Curvature> {
    let Patch { layout: Layout { m, n }, extent, rounding, .. } = patch;
    let (down, along) = (differences.down - 4.0 * rounding, differences.along - 4.0 * rounding);
    let s = down * (m * (m - 1)) as f64 / extent.0.powi(2);
    let t = along * (n * (n - 1)) as f64 / extent.1.powi(2);
    let mixed = (differences.mixed + 4.0 * rounding) * (m * n) as f64 / (extent.0 * extent.1);
    Curvature::uncorrelated(s, t, mixed)
}

/// Lanes of `weight` whose index `j` lies in a range, zeros elsewhere.
#[inline(always)]
fn within<S: Simd>(j: f64x4<S>, from: f64, to: f64, weight: f64x4<S>) -> f64x4<S> {
    (j.simd_ge(from) & j.simd_le(to)).select(weight, f64x4::splat(j.simd, 0.0))
}

/// The negative first derivative along the row at `at`, raised to the net's degree, from the weights of both differences.
#[inline(always)]
fn slope<S: Simd>(simd: S, g: &[f64], at: usize, weights: [f64x4<S>; 2]) -> f64x4<S> {
    let (behind, here, next) = (net::before(simd, g, at, 1), net::load(simd, g, at), net::load(simd, g, at + 1));
    (here - next) * weights[0] + (behind - here) * weights[1]
}

/// The Hessian as a Bernstein form with 2×2 matrices for coefficients.
///
/// The nets of second derivatives, raised to degree `(m, n)`, are
///
/// ```text
/// A[i,j] = (m-i)(m-i-1) Dss[i,j] + 2 i (m-i) Dss[i-1,j] + i (i-1) Dss[i-2,j]          and C likewise in t
/// B[i,j] = (m-i) (F[i,j] - F[i+1,j]) + i (F[i-1,j] - F[i,j]),     F[i,j] = (n-j) Dt[i,j] + j Dt[i,j-1]
/// ```
///
/// with the differences `D` of the form's net, and `D` = 0 outside. The Hessian is a convex combination of the matrices
/// `[[A, B], [B, C]]`, hence positive definite if all of them are, `A` and `C` lowered and `|B|` raised by their rounding.
/// With `A` and `C` scaled by their means the least eigenvalue of a matrix is at least `(a c - b²) / (a + c)`; the least of these,
/// times the means, is the bound.
#[inline(always)]
fn by_matrices<S: Simd>(simd: S, patch: Patch<'_>, size: impl Extent, scratch: &mut Vec<f64>) -> Option<Curvature> {
    let Patch { g, extent, rounding, .. } = patch;
    let (m, n, stride) = (size.m(), size.n(), size.stride());
    let g = &g[..size.rows_len() + LANES];
    let error = |factor: usize| 4.0 * rounding * factor as f64;
    let (error_a, error_b, error_c) = (error(m * (m - 1)), error(m * n), error(n * (n - 1)));
    let zero = f64x4::splat(simd, 0.0);
    // rows of the three nets side by side, kept for the second pass
    scratch.clear();
    scratch.resize(3 * size.rows_len(), 0.0);
    let (nets_a, rest) = scratch.split_at_mut(size.rows_len());
    let (nets_b, nets_c) = rest.split_at_mut(size.rows_len());
    let (mut sum_a, mut sum_c) = (zero, zero);
    let mut column = 0;
    while column < stride {
        let j = net::indices(simd, column);
        let last = n as f64;
        let inside = j.simd_le(last);
        let left = (zero + last) - j;
        // the weights of the differences at j, j - 1 and j - 2; 0 where one lies outside, also in the lanes beyond the row
        let second = [
            within(j, 0.0, last - 2.0, left * (left - 1.0)),
            within(j, 1.0, last - 1.0, j * left * 2.0),
            within(j, 2.0, last, j * (j - 1.0)),
        ];
        let first = [within(j, 0.0, last - 1.0, left), within(j, 1.0, last, j)];
        // rows i, i + 1 and i + 2; slopes of rows i - 1, i and i + 1; bends from i - 2, i - 1 and i
        let mut rows = [0, 1, 2].map(|i| net::load(simd, g, i * stride + column));
        let (mut slopes, mut bends) = ([zero, zero, slope(simd, g, column, first)], [zero, zero, zero]);
        for i in 0..=m {
            let at = i * stride + column;
            let (fi, mi) = (i as f64, (m - i) as f64);
            bends = [bends[1], bends[2], zero];
            slopes = [slopes[1], slopes[2], zero];
            if i + 2 <= m {
                bends[2] = rows[0] - rows[1] * 2.0 + rows[2];
            }
            if i < m {
                slopes[2] = slope(simd, g, at + stride, first);
            }
            let a = bends[2] * (mi * (mi - 1.0)) + bends[1] * (2.0 * fi * mi) + bends[0] * (fi * (fi - 1.0));
            let b = (slopes[1] - slopes[2]) * mi + (slopes[0] - slopes[1]) * fi;
            let (x, y, z) = (rows[0], net::load(simd, g, at + 1), net::load(simd, g, at + 2));
            let (w, v) = (net::before(simd, g, at, 1), net::before(simd, g, at, 2));
            let c = (x - y * 2.0 + z) * second[0] + (w - x * 2.0 + y) * second[1] + (v - w * 2.0 + x) * second[2];
            let (a, b, c) = (a - error_a, b.abs() + error_b, c - error_c);
            // not `<=`: a NaN must fail too
            let definite = a.simd_gt(0.0) & c.simd_gt(0.0) & (a * c).simd_gt(b * b);
            if !(definite | !inside).all_true() {
                return None;
            }
            sum_a += inside.select(a, zero);
            sum_c += inside.select(c, zero);
            a.store_slice(&mut nets_a[at..at + LANES]);
            b.store_slice(&mut nets_b[at..at + LANES]);
            c.store_slice(&mut nets_c[at..at + LANES]);
            rows = [rows[1], rows[2], if i + 3 <= m { net::load(simd, g, at + 3 * stride) } else { zero }];
        }
        column += LANES;
    }
    let count = ((m + 1) * (n + 1)) as f64;
    let mean = |sum: f64x4<S>| ((sum[0] + sum[1]) + (sum[2] + sum[3])) / count;
    let (mean_a, mean_c) = (mean(sum_a), mean(sum_c));
    let (scale_a, scale_c) = (mean_a.recip(), mean_c.recip());
    let mut theta = zero + f64::INFINITY;
    let mut column = 0;
    while column < stride {
        let inside = net::indices(simd, column).simd_le(n as f64);
        for i in 0..=m {
            let at = i * stride + column;
            let a = net::load(simd, nets_a, at) * scale_a;
            let (b, c) = (net::load(simd, nets_b, at), net::load(simd, nets_c, at) * scale_c);
            let eigenvalue = (a * c - b * b * (scale_a * scale_c)) / (a + c);
            theta = theta.min(inside.select(eigenvalue, zero + f64::INFINITY));
        }
        column += LANES;
    }
    let theta = net::least_lane(theta);
    (theta >= WORTHWHILE)
        .then(|| Curvature { s: theta * mean_a / extent.0.powi(2), t: theta * mean_c / extent.1.powi(2) })
}

/// The least of `slope d + curvature d² / 2` over `d` in `[from, to]`, where the slope is known to within `error`.
///
/// `from <= 0 <= to`; the result is at most 0.
#[inline(always)]
pub(super) fn descent(slope: f64, error: f64, curvature: f64, from: f64, to: f64) -> f64 {
    let least = |slope: f64, from: f64, to: f64| {
        let d = if curvature > 0.0 {
            (-slope / curvature).max(from).min(to)
        } else if slope > 0.0 {
            from
        } else {
            to
        };
        slope * d + 0.5 * curvature * d * d
    };
    least(slope - error, 0.0, to).min(least(slope + error, from, 0.0))
}

#[cfg(test)]
mod tests {
    use super::super::net::tests::{laid_out, levels};
    use super::*;
    use perpend_kernel::binomial;

    /// The Bernstein net of a polynomial in two variables given by its power coefficients `a[i][j] s^i t^j`.
    fn bernstein(m: usize, n: usize, a: &[(usize, usize, f64)]) -> Vec<f64> {
        let part = |degree: usize, power: usize, i: usize| {
            if i < power { 0.0 } else { binomial(i, power) / binomial(degree, power) }
        };
        let at = |i: usize, j: usize| a.iter().map(|(k, l, c)| c * part(m, *k, i) * part(n, *l, j)).sum::<f64>();
        let plain: Vec<f64> = (0..=m).flat_map(|i| (0..=n).map(move |j| (i, j))).map(|(i, j)| at(i, j)).collect();
        laid_out(Layout { m, n }, &plain)
    }

    /// What both tests find, at every level the same.
    fn both(patch: Patch<'_>) -> [Option<Curvature>; 2] {
        let found = levels().into_iter().map(|level| {
            dispatch!(level, simd => [
                by_intervals(patch, net::differences(simd, patch.g, net::Any(patch.layout))),
                by_matrices(simd, patch, net::Fixed::<4, 4>, &mut Vec::new()),
            ])
        });
        let found: Vec<_> = found.collect();
        assert!(found.iter().all(|other| *other == found[0]), "the same bits at every level");
        found[0]
    }

    #[test]
    fn the_bound_is_below_the_hessian_and_close_to_it() {
        let extent = (1.0, 1.0);
        // 3 s² + 2 s t + t²: Hessian [[6, 2], [2, 2]]
        let g = bernstein(4, 4, &[(2, 0, 3.0), (1, 1, 2.0), (0, 2, 1.0)]);
        let layout = Layout { m: 4, n: 4 };
        let patch = Patch { g: &g, layout, extent, rounding: 0.0 };
        for found in both(patch) {
            let Curvature { s, t } = found.expect("convex");
            assert!((6.0 - s) * (2.0 - t) >= 4.0 - 1e-12 && s < 6.0 && t < 2.0, "H - diag({s}, {t}) is not negative");
            assert!(s > 0.5 && t > 0.2, "the bound is not idle: {s} {t}");
        }
        // a saddle, and a valley whose Hessian is singular
        for form in [[(2, 0, 1.0), (0, 2, -1.0), (1, 1, 0.0)], [(2, 0, 1.0), (1, 1, 2.0), (0, 2, 1.0)]] {
            let g = bernstein(4, 4, &form);
            let patch = Patch { g: &g, layout, extent, rounding: 1e-15 };
            assert!(curvature(Level::new(), patch, &mut Vec::new()).is_none());
        }
    }

    #[test]
    fn a_varying_hessian_is_bounded_everywhere() {
        // s⁴ + s² + 3 t² + s t² (Hessian [[12 s² + 2, 2 t], [2 t, 6 + 2 s]]), on a shrunken box
        let g = bernstein(4, 4, &[(4, 0, 1.0), (2, 0, 1.0), (0, 2, 3.0), (1, 2, 1.0)]);
        let patch = Patch { g: &g, layout: Layout { m: 4, n: 4 }, extent: (1.0, 1.0), rounding: 0.0 };
        let Curvature { s: a, t: c } = curvature(Level::new(), patch, &mut Vec::new()).expect("convex");
        for i in 0..=20 {
            for j in 0..=20 {
                let (s, t) = (f64::from(i) / 20.0, f64::from(j) / 20.0);
                assert!((12.0 * s * s + 2.0 - a) * (6.0 + 2.0 * s - c) >= 4.0 * t * t && 2.0 > a && 6.0 > c);
            }
        }
    }

    #[test]
    fn the_descent_is_the_worst_over_all_slopes_within_the_error() {
        for (slope, error, curvature, from, to) in [
            (1.0, 0.0, 2.0, -1.0, 0.3),
            (0.2, 0.5, 1.0, -0.4, 0.7),
            (-3.0, 0.1, 0.5, 0.0, 1.0),
            (2.0, 0.0, 0.0, 0.0, 1.0),
        ] {
            let found = descent(slope, error, curvature, from, to);
            for i in 0..=100 {
                let d = from + (to - from) * f64::from(i) / 100.0;
                for e in [-error, 0.0, error] {
                    assert!(found <= (slope + e) * d + 0.5 * curvature * d * d + 1e-15);
                }
            }
        }
    }
}
