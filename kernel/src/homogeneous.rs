//! Homogeneous control points: `(w x, w y, w z, w)`.

use glam::{DVec3, DVec4};

use crate::basis::binomial;

/// A point with its weight, in homogeneous form.
#[must_use]
#[inline]
pub fn homogeneous(point: DVec3, weight: f64) -> DVec4 {
    (point * weight).extend(weight)
}

/// The point that a homogeneous point stands for: `(x, y, z) / w`.
#[must_use]
#[inline]
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

/// As [`rational_partials`] for orders up to 2, the sums written out: these are asked for with every normal and every step of Newton's method.
/// The entries beyond `k + l < D` are 0.
#[inline]
pub(crate) fn rational_low_partials<const D: usize>(form: &[[DVec4; D]; D]) -> [[DVec3; D]; D] {
    let mut s = [[DVec3::ZERO; D]; D];
    s[0][0] = cartesian(form[0][0]);
    if D > 1 {
        let inverse = 1.0 / form[0][0].w;
        let less = |of: DVec4, others: DVec3| (of.truncate() - others) * inverse;
        let (by_u, by_v) = (form[1][0], form[0][1]);
        s[1][0] = less(by_u, by_u.w * s[0][0]);
        s[0][1] = less(by_v, by_v.w * s[0][0]);
        if D > 2 {
            let (by_uu, by_uv, by_vv) = (form[2][0], form[1][1], form[0][2]);
            s[2][0] = less(by_uu, 2.0 * by_u.w * s[1][0] + by_uu.w * s[0][0]);
            s[1][1] = less(by_uv, by_u.w * s[0][1] + by_v.w * s[1][0] + by_uv.w * s[0][0]);
            s[0][2] = less(by_vv, 2.0 * by_v.w * s[0][1] + by_vv.w * s[0][0]);
        }
    }
    s
}

/// As [`rational_derivatives`] for orders up to 2, the sums written out.
#[inline]
pub(crate) fn rational_low_derivatives<const D: usize>(form: &[DVec4; D]) -> [DVec3; D] {
    let mut c = [DVec3::ZERO; D];
    c[0] = cartesian(form[0]);
    if D > 1 {
        let inverse = 1.0 / form[0].w;
        c[1] = (form[1].truncate() - form[1].w * c[0]) * inverse;
        if D > 2 {
            c[2] = (form[2].truncate() - (2.0 * form[1].w * c[1] + form[2].w * c[0])) * inverse;
        }
    }
    c
}
