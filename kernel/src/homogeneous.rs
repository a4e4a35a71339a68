//! Homogeneous control points: `(w x, w y, w z, w)`.

use glam::{DVec3, DVec4};

use crate::basis::binomial;

/// A point with its weight, in homogeneous form.
#[must_use]
pub fn homogeneous(point: DVec3, weight: f64) -> DVec4 {
    (point * weight).extend(weight)
}

/// The point that a homogeneous point stands for: `(x, y, z) / w`.
#[must_use]
pub fn cartesian(point: DVec4) -> DVec3 {
    point.truncate() / point.w
}

/// Point and derivatives of a rational curve from those of its homogeneous form.
///
/// `curve[k]` becomes the `k`-th derivative; homogeneous derivatives past the end of `of` are 0.
/// The NURBS Book, algorithm A4.2 (equation 4.8).
pub(crate) fn rational_derivatives(of: &[DVec4], curve: &mut [DVec3]) {
    let at = |k: usize| of.get(k).copied().unwrap_or(DVec4::ZERO);
    for k in 0..curve.len() {
        let mut sum = at(k).truncate();
        for i in 1..=k {
            sum -= binomial(k, i) * at(i).w * curve[k - i];
        }
        curve[k] = sum / of[0].w;
    }
}

/// Point and partial derivatives of a rational surface from those of its homogeneous form.
///
/// `surface[k * side + l]` becomes the derivative of order `k` in u and `l` in v, for `k + l < side`; `at(k, l)` gives the
/// homogeneous one. The NURBS Book, algorithm A4.4 (equation 4.20).
pub(crate) fn rational_partials(at: impl Fn(usize, usize) -> DVec4, side: usize, surface: &mut [DVec3]) {
    let w = at(0, 0).w;
    if side == 2 {
        // the sums below, written out: this order is asked for with every normal
        let (form, by_v, by_u) = (at(0, 0), at(0, 1), at(1, 0));
        surface[0] = form.truncate() / w;
        surface[1] = (by_v.truncate() - by_v.w * surface[0]) / w;
        surface[2] = (by_u.truncate() - by_u.w * surface[0]) / w;
        return;
    }
    for k in 0..side {
        for l in 0..side - k {
            let mut sum = at(k, l).truncate();
            for i in 0..=k {
                for j in 0..=l {
                    if i + j > 0 {
                        let factor = binomial(k, i) * binomial(l, j) * at(i, j).w;
                        sum -= factor * surface[(k - i) * side + l - j];
                    }
                }
            }
            surface[k * side + l] = sum / w;
        }
    }
}
