//! Lower bounds of the form, and of the squared distance itself, on a box where they are convex, seen from an evaluated point.
//!
//! With `H >= diag(a, c)` on the box and any point `x0` of it,
//!
//! ```text
//! G >= G(x0) + min (Gs ds + a ds²/2) + min (Gt dt + c dt²/2)
//! ```
//!
//! over the steps that stay in the box, and so for the squared distance: the last two minima are at most 0, and tiny where `x0` is nearly the foot. Value and gradient are
//! evaluated; their errors are paid for.

use glam::{DVec3, DVec4};

use super::ROUNDING;
use super::convex::{self, Curvature};
use super::leaf::Leaf;
use super::newton::{Domain, Found};

/// The least that the form of `tau` can be on a box of the leaf's parameters that holds the point `found`, where `curvature` is a lower bound of the
/// Hessian on that box. In a direction in which the box has no extent, curvature and slope do not matter.
pub(super) fn least_from(leaf: &Leaf, x: DVec3, found: &Found, domain: Domain, curvature: Curvature, tau: f64) -> f64 {
    let Found { distance: d, s, t, jet, .. } = found;
    let (w, q) = (jet.p.w, jet.point() - x);
    let mut bound = (d - tau) * (d + tau) * w * w - value_error(leaf, *d);
    let mut along = |derivative: DVec4, degree: usize, curvature: f64, at: f64, (from, to): (f64, f64)| {
        let (slope, direction) = slope(q, w, derivative, tau);
        let error = gradient_error(leaf, *d, tau, direction, derivative.w, degree);
        bound += convex::descent(slope, error, curvature, from - at, to - at);
    };
    if domain.s.0 < domain.s.1 {
        along(jet.ps, leaf.degree.0, curvature.s, *s, domain.s);
    }
    if domain.t.0 < domain.t.1 {
        along(jet.pt, leaf.degree.1, curvature.t, *t, domain.t);
    }
    bound
}

/// The least that the squared distance from `x` can be on a box of the leaf's parameters that holds the point `found`, where `curvature` is a lower bound of
/// its Hessian there. In a direction in which the box has no extent, curvature and slope do not matter.
#[inline(always)]
pub(super) fn nearest_from(leaf: &Leaf, x: DVec3, found: &Found, domain: Domain, curvature: Curvature) -> f64 {
    let Found { distance: d, s, t, jet, .. } = found;
    let offset = jet.point() - x;
    let mut bound = d * d - square_error(leaf, *d);
    for (derivative, degree, curvature, at, (from, to)) in [
        (jet.ps.truncate(), leaf.degree.0, curvature.s, *s, domain.s),
        (jet.pt.truncate(), leaf.degree.1, curvature.t, *t, domain.t),
    ] {
        if from < to {
            let error = slope_error(leaf, *d, derivative, degree);
            bound += convex::descent(2.0 * offset.dot(derivative), error, curvature, from - at, to - at);
        }
    }
    bound
}

/// Error of `|S - x|²` evaluated at a point at distance `d`.
///
/// With `c = 3 (p + q) + 8`, `A` errs by at most `c u r W` and `w` by `c u W` (as in [`value_error`]), so `S = A / w` by `e = (2 c rho + 2) u r`, `rho` being the ratio
/// of the weights. Hence `2 d e + e²`, `8 u d²` for the difference and its square, and `4 u d²` for what is added to it and for the `tau²` that it is compared with.
#[inline(always)]
pub(super) fn square_error(leaf: &Leaf, d: f64) -> f64 {
    let e = point_error(leaf);
    2.0 * d * e + e * e + 12.0 * ROUNDING * d * d
}

/// The error `e` of an evaluated point of the leaf.
#[inline(always)]
fn point_error(leaf: &Leaf) -> f64 {
    let (c, rho) = roundings(leaf);
    (2.0 * c * rho + 2.0) * ROUNDING * leaf.radius
}

/// The roundings `c` of an evaluation, and the ratio `rho` of the leaf's weights.
#[inline(always)]
fn roundings(leaf: &Leaf) -> (f64, f64) {
    let (p, q) = leaf.degree;
    ((3 * (p + q) + 8) as f64, leaf.heaviest / leaf.lightest)
}

/// Error of the derivative `2 (S - x) · S_s`, `degree` being the leaf's in that direction.
///
/// `A_s` errs by at most `2 n c u r W` and `w_s`, which is at most `2 n W`, by `2 n c u W`; so `S_s = (A_s - w_s S) / w` errs by at most
/// `2 n u r rho (2 c + 2 c rho + 14)`, and the product by `8 u d |S_s|` more.
#[inline(always)]
fn slope_error(leaf: &Leaf, d: f64, derivative: DVec3, degree: usize) -> f64 {
    let (c, rho) = roundings(leaf);
    let error = 2.0 * degree as f64 * ROUNDING * leaf.radius * rho * (2.0 * c + 2.0 * c * rho + 14.0);
    2.0 * (d * error + derivative.length() * (point_error(leaf) + 4.0 * ROUNDING * d))
}

/// The derivative `2 (A - x w) · (A_s - x w_s) - 2 tau² w w_s` of the form, and its direction `A_s - x w_s = w S_s + w_s (S - x)`, from the point's offset
/// `S - x`, its weight and their derivatives.
fn slope(offset: DVec3, w: f64, derivative: DVec4, tau: f64) -> (f64, DVec3) {
    let direction = derivative.truncate() * w + offset * derivative.w;
    (2.0 * w * (offset.dot(direction) - tau * tau * derivative.w), direction)
}

/// Error of `|A - x w|² - tau² w²` evaluated at a point at distance `d`.
///
/// The basis functions have a relative error of at most `(2 p + 1) u` each, the sums add one rounding a term: `A - x w` errs by at most
/// `c u (d + 2 r) W` with `c = 3 (p + q) + 8`, and `|A - x w| <= d W`. Hence `2 c u (d² + 2 d r) W²`, and a few `u d² W²` for the square and for
/// `tau² w²`; the factor below is more than twice that.
pub(super) fn value_error(leaf: &Leaf, d: f64) -> f64 {
    let (p, q) = leaf.degree;
    let factor = (4 * (p + q + 8) * (1 + p + q)) as f64;
    factor * ROUNDING * (d * d + 2.0 * d * leaf.radius) * leaf.heaviest * leaf.heaviest
}

/// Error of the derivative `2 (A - x w) · (A_s - x w_s) - 2 tau² w w_s`, `degree` being the leaf's in that direction.
///
/// A derivative is a sum over differences of basis functions, `Σ |B'| <= 2 p`, so `A_s - x w_s` errs by at most `2 p c u (d + 2 r) W`. This does not
/// fall with `d`: beside the surface it is what limits the test.
fn gradient_error(leaf: &Leaf, d: f64, tau: f64, direction: DVec3, weight: f64, degree: usize) -> f64 {
    let (p, q) = leaf.degree;
    let (w, twice) = (leaf.heaviest, 2.0 * degree as f64);
    let reach = d + 2.0 * leaf.radius;
    let sum = reach * w * direction.length()
        + twice * d * reach * w * w
        + tau * tau * w * weight.abs()
        + twice * tau * tau * w * w;
    (8 * (p + q + 8)) as f64 * ROUNDING * sum
}

#[cfg(test)]
mod tests {
    use super::super::double_double::{DoubleDouble, Random, basis, squared_distance};
    use super::super::piece::Piece;
    use super::*;
    use fearless_simd::Level;

    /// `G` and its two derivatives at `(s, t)`, in double-double from the leaf's net.
    fn exact(leaf: &Leaf, x: DVec3, tau: f64, s: f64, t: f64) -> [f64; 3] {
        let (p, q) = leaf.degree;
        let number = DoubleDouble::from;
        let (bs, bt) = (basis(p, s), basis(q, t));
        // the value and both derivatives of A - x w, and of w as a fourth coordinate
        let mut jets = [[number(0.0); 4]; 3];
        for (e, h) in leaf.net.iter().enumerate() {
            let (i, j) = (e / (q + 1), e % (q + 1));
            let shares = [bs[i][0] * bt[j][0], bs[i][1] * bt[j][0], bs[i][0] * bt[j][1]];
            for (jet, share) in jets.iter_mut().zip(shares) {
                for k in 0..3 {
                    jet[k] = jet[k] + share * (number(h[k]) - number(x[k]) * number(h.w));
                }
                jet[3] = jet[3] + share * number(h.w);
            }
        }
        let square = number(tau) * number(tau);
        let product = |a: &[DoubleDouble; 4], b: &[DoubleDouble; 4]| {
            (0..3).fold(number(0.0), |sum, k| sum + a[k] * b[k]) - square * a[3] * b[3]
        };
        let value = product(&jets[0], &jets[0]).to_f64();
        let [ds, dt] = [1, 2].map(|k| (number(2.0) * product(&jets[0], &jets[k])).to_f64());
        [value, ds, dt]
    }

    /// The value that the convexity test starts from, and its gradient, each within its own bound; near the surface too,
    /// where the gradient's error does not fall with the distance. No bound is idle: a hundredth of each is exceeded.
    #[test]
    fn evaluated_values_and_gradients_err_within_their_bounds() {
        let mut random = Random(9);
        let (mut worst_value, mut worst_gradient) = (0.0_f64, 0.0_f64);
        let (mut worst_square, mut worst_slope) = (0.0_f64, 0.0_f64);
        for round in 0..2000 {
            let degree = [(1, 0), (3, 0), (9, 0), (25, 0), (1, 1), (3, 3), (2, 5), (9, 9)][round % 8];
            let rational = round % 3 > 0;
            let count = (degree.0 + 1) * (degree.1 + 1);
            let net = (0..count)
                .map(|_| {
                    let weight = if rational { 10.0_f64.powf(random.between(-3.0, 0.0)) } else { 1.0 };
                    (random.point() * weight).extend(weight)
                })
                .collect();
            let piece = Piece { degree, net, rational, u: (0.0, 1.0), v: (0.0, 1.0) };
            let leaf = Leaf::new(piece, Level::new(), &mut Vec::new());
            let (s, t) = (random.between(0.0, 1.0), random.between(0.0, 1.0));
            let jet = leaf.jet(s, t);
            let x = jet.point() + random.point() * 10.0_f64.powf(random.between(-12.0, 2.0));
            let d = jet.point().distance(x);
            let tau = d * random.between(0.9, 1.0);
            let exact = exact(&leaf, x, tau, s, t);
            let w = jet.p.w;
            let value = (d - tau) * (d + tau) * w * w;
            worst_value = worst_value.max((value - exact[0]).abs() / value_error(&leaf, d));
            let square = squared_distance(&leaf.net, degree, x, (s, t));
            let off = |value: f64, exact: DoubleDouble| (DoubleDouble::from(value) - exact).to_f64().abs();
            worst_square = worst_square.max(off(d * d, square[0]) / square_error(&leaf, d));
            for (derivative, n, exact) in [(jet.ps, degree.0, square[1]), (jet.pt, degree.1, square[2])] {
                let (offset, derivative) = (jet.point() - x, derivative.truncate());
                let error = slope_error(&leaf, d, derivative, n);
                if n > 0 {
                    worst_slope = worst_slope.max(off(2.0 * offset.dot(derivative), exact) / error);
                }
            }
            let derivatives = [(jet.ps, degree.0, exact[1]), (jet.pt, degree.1, exact[2])];
            for (derivative, n, exact) in derivatives.into_iter().filter(|(_, n, _)| *n > 0) {
                let (slope, direction) = slope(jet.point() - x, w, derivative, tau);
                let error = gradient_error(&leaf, d, tau, direction, derivative.w, n);
                worst_gradient = worst_gradient.max((slope - exact).abs() / error);
            }
        }
        assert!(worst_value < 1.0 && worst_gradient < 1.0, "{worst_value} {worst_gradient}");
        assert!(worst_square < 1.0 && worst_slope < 1.0, "{worst_square} {worst_slope}");
        assert!(worst_square > 1e-2 && worst_slope > 1e-2, "idle bounds: {worst_square} {worst_slope}");
        assert!(worst_value > 1e-2 && worst_gradient > 1e-2, "idle bounds: {worst_value} {worst_gradient}");
    }
}
