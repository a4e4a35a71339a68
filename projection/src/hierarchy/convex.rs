//! When a form is convex on a box, and how strongly: a diagonal lower bound of its Hessian.

use super::net;

/// `H >= diag(s, t)` on a box, both positive: the form's second derivatives in the leaf's parameters.
#[derive(Debug, Clone, Copy)]
pub(super) struct Curvature {
    pub s: f64,
    pub t: f64,
}

/// A box's net with its degrees, the box's extents, and the bound of the coefficients' rounding.
#[derive(Debug, Clone, Copy)]
pub(super) struct Patch<'a> {
    pub g: &'a [f64],
    pub m: usize,
    pub n: usize,
    pub extent: (f64, f64),
    pub rounding: f64,
}

/// Below this share of the mean curvature the matrix test's bound is not worth a Newton iteration.
const WORTHWHILE: f64 = 0.02;

/// Above this correlation of the interval test the matrix test, if it holds, gives the better bound.
pub(super) const CORRELATED: f64 = 0.98;

/// A proven lower bound of the Hessian on the box, if the form is found convex there.
///
/// `scratch` is working memory.
pub(super) fn curvature(patch: Patch<'_>, scratch: &mut Vec<[f64; 3]>) -> Option<Curvature> {
    match (patch.m, patch.n) {
        (0, _) => along_t(patch),
        (_, 0) => along_s(patch),
        _ => by_intervals(patch).or_else(|| by_matrices(patch, scratch)),
    }
}

fn along_s(Patch { g, m, n, extent, rounding }: Patch<'_>) -> Option<Curvature> {
    if m < 2 {
        return None;
    }
    let least = net::least_second_down(g, n + 1) - 4.0 * rounding;
    (least > 0.0).then(|| Curvature { s: least * (m * (m - 1)) as f64 / extent.0.powi(2), t: 0.0 })
}

fn along_t(Patch { g, n, extent, rounding, .. }: Patch<'_>) -> Option<Curvature> {
    if n < 2 {
        return None;
    }
    let least = net::least_second_along(g, n + 1) - 4.0 * rounding;
    (least > 0.0).then(|| Curvature { s: 0.0, t: least * (n * (n - 1)) as f64 / extent.1.powi(2) })
}

/// Second derivatives as intervals: with `rho² = max Gst² / (min Gss min Gtt) < 1`, `H >= (1 - rho) diag(min Gss, min Gtt)`.
///
/// A second difference of coefficients errs by 4 of their bounds.
fn by_intervals(patch: Patch<'_>) -> Option<Curvature> {
    let Patch { g, m, n, extent, rounding } = patch;
    let s = along_s(patch)?.s;
    let t = along_t(patch)?.t;
    let mixed = (net::largest_mixed(g, n + 1) + 4.0 * rounding) * (m * n) as f64 / (extent.0 * extent.1);
    let rho = mixed / (s * t).sqrt();
    (rho <= CORRELATED).then_some(Curvature { s: (1.0 - rho) * s, t: (1.0 - rho) * t })
}

/// The Hessian as a Bernstein form with 2×2 matrices for coefficients.
///
/// The nets of second derivatives, raised to degree `(m, n)`, are
///
/// ```text
/// A[i,j] = (m-i)(m-i-1) Dss[i,j] + 2 i (m-i) Dss[i-1,j] + i (i-1) Dss[i-2,j]          and C likewise in t
/// B[i,j] = (m-i)(n-j) Dst[i,j] + i (n-j) Dst[i-1,j] + (m-i) j Dst[i,j-1] + i j Dst[i-1,j-1]
/// ```
///
/// with the differences `D` of the form's net, and `D` = 0 outside. The Hessian is a convex combination of the matrices
/// `[[A, B], [B, C]]`, hence positive definite if all of them are, `A` and `C` lowered and `|B|` raised by their rounding.
/// With `A` and `C` scaled by their means the least eigenvalue of a matrix is at least `(a c - b²) / (a + c)`; the least of these,
/// times the means, is the bound.
fn by_matrices(patch: Patch<'_>, scratch: &mut Vec<[f64; 3]>) -> Option<Curvature> {
    let Patch { g, m, n, extent, rounding } = patch;
    if m < 2 || n < 2 {
        return None;
    }
    let width = n + 1;
    let second = |at: usize, step: usize| g[at] - 2.0 * g[at + step] + g[at + 2 * step];
    let mixed = |at: usize| g[at] - g[at + width] - g[at + 1] + g[at + width + 1];
    let error = |factor: usize| 4.0 * rounding * factor as f64;
    let (error_a, error_b, error_c) = (error(m * (m - 1)), error(m * n), error(n * (n - 1)));
    // the raised second derivative at index `i` of degree `degree`, from the differences at `at - k * step`
    let raised = |i: usize, degree: usize, at: usize, step: usize| {
        let (here, left) = (i as f64, (degree - i) as f64);
        let mut sum = 0.0;
        if i + 2 <= degree {
            sum += left * (left - 1.0) * second(at, step);
        }
        if i >= 1 && i < degree {
            sum += 2.0 * here * left * second(at - step, step);
        }
        if i >= 2 {
            sum += here * (here - 1.0) * second(at - 2 * step, step);
        }
        sum
    };
    scratch.clear();
    let (mut mean_a, mut mean_c) = (0.0, 0.0);
    for i in 0..=m {
        let (fi, mi) = (i as f64, (m - i) as f64);
        for j in 0..=n {
            let (fj, nj) = (j as f64, (n - j) as f64);
            let at = i * width + j;
            let a = raised(i, m, at, width) - error_a;
            let c = raised(j, n, at, 1) - error_c;
            let mut b = 0.0;
            if i < m && j < n {
                b += mi * nj * mixed(at);
            }
            if i > 0 && j < n {
                b += fi * nj * mixed(at - width);
            }
            if i < m && j > 0 {
                b += mi * fj * mixed(at - 1);
            }
            if i > 0 && j > 0 {
                b += fi * fj * mixed(at - width - 1);
            }
            let b = b.abs() + error_b;
            // not `<=`: a NaN must fail too
            if !(a > 0.0 && c > 0.0 && a * c > b * b) {
                return None;
            }
            scratch.push([a, b, c]);
            mean_a += a;
            mean_c += c;
        }
    }
    let count = scratch.len() as f64;
    let (mean_a, mean_c) = (mean_a / count, mean_c / count);
    let (scale_a, scale_c) = (mean_a.recip(), mean_c.recip());
    let eigenvalue = |[a, b, c]: &[f64; 3]| {
        let (a, c) = (a * scale_a, c * scale_c);
        (a * c - b * b * scale_a * scale_c) / (a + c)
    };
    let theta = scratch.iter().map(eigenvalue).fold(f64::INFINITY, f64::min);
    (theta >= WORTHWHILE)
        .then(|| Curvature { s: theta * mean_a / extent.0.powi(2), t: theta * mean_c / extent.1.powi(2) })
}

/// The least of `slope d + curvature d² / 2` over `d` in `[from, to]`, where the slope is known to within `error`.
///
/// `from <= 0 <= to`; the result is at most 0.
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
    use super::*;
    use perpend_kernel::binomial;

    /// The Bernstein net of a polynomial in two variables given by its power coefficients `a[i][j] s^i t^j`.
    fn bernstein(m: usize, n: usize, a: &[(usize, usize, f64)]) -> Vec<f64> {
        let part = |degree: usize, power: usize, i: usize| {
            if i < power { 0.0 } else { binomial(i, power) / binomial(degree, power) }
        };
        let at = |i: usize, j: usize| a.iter().map(|(k, l, c)| c * part(m, *k, i) * part(n, *l, j)).sum::<f64>();
        (0..=m).flat_map(|i| (0..=n).map(move |j| (i, j))).map(|(i, j)| at(i, j)).collect()
    }

    #[test]
    fn the_bound_is_below_the_hessian_and_close_to_it() {
        let extent = (1.0, 1.0);
        // 3 s² + 2 s t + t²: Hessian [[6, 2], [2, 2]]
        let g = bernstein(4, 4, &[(2, 0, 3.0), (1, 1, 2.0), (0, 2, 1.0)]);
        let patch = Patch { g: &g, m: 4, n: 4, extent, rounding: 0.0 };
        for found in [by_intervals(patch), by_matrices(patch, &mut Vec::new())] {
            let Curvature { s, t } = found.expect("convex");
            assert!((6.0 - s) * (2.0 - t) >= 4.0 - 1e-12 && s < 6.0 && t < 2.0, "H - diag({s}, {t}) is not negative");
            assert!(s > 0.5 && t > 0.2, "the bound is not idle: {s} {t}");
        }
        // a saddle, and a valley whose Hessian is singular
        for form in [[(2, 0, 1.0), (0, 2, -1.0), (1, 1, 0.0)], [(2, 0, 1.0), (1, 1, 2.0), (0, 2, 1.0)]] {
            let g = bernstein(4, 4, &form);
            let patch = Patch { g: &g, m: 4, n: 4, extent, rounding: 1e-15 };
            assert!(curvature(patch, &mut Vec::new()).is_none());
        }
    }

    #[test]
    fn a_varying_hessian_is_bounded_everywhere() {
        // s⁴ + s² + 3 t² + s t² (Hessian [[12 s² + 2, 2 t], [2 t, 6 + 2 s]]), on a shrunken box
        let g = bernstein(4, 4, &[(4, 0, 1.0), (2, 0, 1.0), (0, 2, 3.0), (1, 2, 1.0)]);
        let patch = Patch { g: &g, m: 4, n: 4, extent: (1.0, 1.0), rounding: 0.0 };
        let Curvature { s: a, t: c } = curvature(patch, &mut Vec::new()).expect("convex");
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
