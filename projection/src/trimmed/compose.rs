//! The boundary of a trimmed surface in space: `S(c(t))` as Bézier curves.
//!
//! On one Bézier patch of the carrier, de Casteljau's algorithm with the p-curve's polynomials in place of numbers gives the curve exactly, but for
//! rounding: with `c = (X, Y) / W` every level is `P_i ← (W - X) P_i + X P_{i+1}`, products in the Bernstein basis. A parameter that is constant
//! along the piece is put in as a number, so that lines along the parameters keep the patch's degree.

use std::ops::{Add, Mul};

use glam::{DVec3, DVec4};
use perpend_kernel::bezier::halve;
use perpend_kernel::binomial;

use crate::hierarchy::Patch;

/// A polynomial in Bernstein form with values in the homogeneous space.
pub(super) type Net = Vec<DVec4>;

/// The curve over a piece of a p-curve that lies in the patch; the piece as `(w u, w v, w)`.
pub(super) fn composed(patch: Patch<'_>, piece: &[DVec3]) -> Net {
    let (p, q) = patch.degree;
    if let Some(affine) = affine(patch, piece) {
        return affine;
    }
    let along_u = Factor::of(piece, 0, patch.u);
    let along_v = Factor::of(piece, 1, patch.v);
    let columns: Vec<Net> =
        (0..=q).map(|j| blended((0..=p).map(|i| vec![patch.net[i * (q + 1) + j]]).collect(), &along_u)).collect();
    blended(columns, &along_v)
}

/// On a flat parallelogram the control points map one by one.
fn affine(patch: Patch<'_>, piece: &[DVec3]) -> Option<Net> {
    let [a, b, c, d]: [DVec4; 4] = patch.net.try_into().ok().filter(|_| patch.degree == (1, 1))?;
    let is_polynomial = [a, b, c, d].iter().all(|corner| corner.w == a.w);
    if !is_polynomial || (a - b - c + d).truncate().abs().max_element() > 0.0 {
        return None;
    }
    let along_u = Factor::of(piece, 0, patch.u);
    let along_v = Factor::of(piece, 1, patch.v);
    let weights = piece.iter().map(|point| point.z);
    Some(
        weights
            .enumerate()
            .map(|(k, w)| {
                let (s, t) = (along_u.at(k, w), along_v.at(k, w));
                a * w + (c - a) * s + (b - a) * t
            })
            .collect(),
    )
}

/// A parameter of the patch along the piece: a number, or a quotient of polynomials.
enum Factor {
    Constant(f64),
    /// Numerator and denominator.
    Varying(Vec<f64>, Vec<f64>),
}

impl Factor {
    fn of(piece: &[DVec3], axis: usize, (from, to): (f64, f64)) -> Self {
        let share = |point: &DVec3| (point[axis] - from * point.z) / (to - from);
        let first = piece[0][axis] / piece[0].z;
        if piece.iter().all(|point| point[axis] / point.z == first) {
            return Self::Constant(((first - from) / (to - from)).clamp(0.0, 1.0));
        }
        Self::Varying(piece.iter().map(share).collect(), piece.iter().map(|point| point.z).collect())
    }

    /// The numerator's coefficient `k`, where the denominator's is `w`.
    fn at(&self, k: usize, w: f64) -> f64 {
        match self {
            Self::Constant(x) => x * w,
            Self::Varying(numerator, _) => numerator[k],
        }
    }
}

/// De Casteljau's algorithm on polynomials of one degree.
fn blended(mut row: Vec<Net>, by: &Factor) -> Net {
    while row.len() > 1 {
        row = row
            .windows(2)
            .map(|pair| match by {
                Factor::Constant(x) => pair[0].iter().zip(&pair[1]).map(|(a, b)| *a * (1.0 - x) + *b * *x).collect(),
                Factor::Varying(x, w) => {
                    let rest: Vec<f64> = w.iter().zip(x).map(|(w, x)| w - x).collect();
                    let (low, high) = (product(&rest, &pair[0]), product(x, &pair[1]));
                    low.iter().zip(&high).map(|(a, b)| *a + *b).collect()
                }
            })
            .collect();
    }
    row.pop().expect("a patch has a row")
}

/// The product of two polynomials in Bernstein form.
fn product(a: &[f64], b: &[DVec4]) -> Net {
    let (m, n) = (a.len() - 1, b.len() - 1);
    let mut sum = vec![DVec4::ZERO; m + n + 1];
    for (i, a) in a.iter().enumerate() {
        for (j, b) in b.iter().enumerate() {
            sum[i + j] += binomial(m, i) * binomial(n, j) / binomial(m + n, i + j) * *a * *b;
        }
    }
    sum
}

/// The two halves of a Bézier net.
pub(super) fn halves<T: Copy + Add<Output = T> + Mul<f64, Output = T>>(mut low: Vec<T>) -> [Vec<T>; 2] {
    let mut high = low.clone();
    halve(&mut low, &mut high);
    [low, high]
}

/// The quintic with the same ends, first and second derivatives there, and how far the two curves are apart at most at equal parameter.
///
/// Raised to the degree of the net, its control points differ from the net by vectors whose largest bounds the difference of the homogeneous curves;
/// with weights at least `w` and points within `r` of the origin, the curves differ by at most `(|ΔA| + r |Δw|) / w`.
pub(super) fn quintic(net: &[DVec4]) -> (Net, f64) {
    let n = net.len() - 1;
    let end = |at: &dyn Fn(usize) -> DVec4| {
        let first = at(0) + (at(1) - at(0)) * (n as f64 / 5.0);
        let bend = at(2) - 2.0 * at(1) + at(0);
        (first, bend * ((n * (n - 1)) as f64 / 20.0) + 2.0 * first - at(0))
    };
    let (b, c) = end(&|k| net[k]);
    let (e, d) = end(&|k| net[n - k]);
    let low = vec![net[0], b, c, d, e, net[n]];
    let mut raised = low.clone();
    for degree in 5..n {
        let next = (degree + 1) as f64;
        raised = (0..=degree + 1)
            .map(|i| {
                let share = i as f64 / next;
                let below = if i > 0 { raised[i - 1] * share } else { DVec4::ZERO };
                let above = if i <= degree { raised[i] * (1.0 - share) } else { DVec4::ZERO };
                below + above
            })
            .collect();
    }
    let (mut vector, mut weight) = (0.0_f64, 0.0_f64);
    for (a, b) in net.iter().zip(&raised) {
        vector = vector.max((*a - *b).truncate().length());
        weight = weight.max((a.w - b.w).abs());
    }
    let lightest = net.iter().chain(&low).fold(f64::INFINITY, |least, h| least.min(h.w));
    let reach = low.iter().fold(0.0_f64, |reach, h| reach.max(h.truncate().length() / h.w));
    (low, if lightest > 0.0 { (vector + reach * weight) / lightest } else { f64::INFINITY })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hierarchy::double_double::Random;

    fn value(net: &[DVec4], t: f64) -> DVec3 {
        let mut work = net.to_vec();
        while work.len() > 1 {
            work = work.windows(2).map(|pair| pair[0] * (1.0 - t) + pair[1] * t).collect();
        }
        work[0].truncate() / work[0].w
    }

    fn surface(patch: Patch<'_>, u: f64, v: f64) -> DVec3 {
        let (s, t) = ((u - patch.u.0) / (patch.u.1 - patch.u.0), (v - patch.v.0) / (patch.v.1 - patch.v.0));
        let rows: Vec<DVec4> = patch
            .net
            .chunks(patch.degree.1 + 1)
            .map(|row| {
                let mut work = row.to_vec();
                while work.len() > 1 {
                    work = work.windows(2).map(|pair| pair[0] * (1.0 - t) + pair[1] * t).collect();
                }
                work[0]
            })
            .collect();
        value(&rows, s)
    }

    /// The composition is the surface at the p-curve's points, for polynomial and rational patches and p-curves, lines along the parameters
    /// included; and the quintic stays within its bound, which halving lowers by the sixth power.
    #[test]
    fn curves_on_patches_are_the_surface_at_their_points() {
        let mut random = Random(11);
        for case in 0..400 {
            let degree = [(1, 1), (2, 1), (3, 3), (2, 2), (5, 2)][case % 5];
            let rational = case % 2 == 1;
            let weight = |random: &mut Random| if rational { random.between(0.5, 2.0) } else { 1.0 };
            let mut net = Vec::new();
            for i in 0..=degree.0 {
                for j in 0..=degree.1 {
                    let w = weight(&mut random);
                    let point = DVec3::new(i as f64, j as f64, 0.0) + 0.4 * random.point();
                    net.push((point * w).extend(w));
                }
            }
            let patch = Patch { degree, net: &net, u: (1.0, 3.0), v: (-2.0, -1.0) };
            let n = 1 + case % 3;
            let flat = case % 7 == 0;
            let piece: Vec<DVec3> = (0..=n)
                .map(|_| {
                    let w = weight(&mut random);
                    let v = if flat { -1.25 } else { random.between(-2.0, -1.0) };
                    DVec3::new(random.between(1.0, 3.0) * w, v * w, w)
                })
                .collect();
            let net = composed(patch, &piece);
            for k in 0..=20 {
                let t = f64::from(k) / 20.0;
                let c = value(&piece.iter().map(|p| DVec4::new(p.x, p.y, 0.0, p.z)).collect::<Vec<_>>(), t);
                let error = value(&net, t).distance(surface(patch, c.x, c.y));
                assert!(error < 1e-13 * (1.0 + net.len() as f64), "case {case}: {error:e}");
            }
            if net.len() > 6 {
                let mut part = net;
                for _ in 0..6 {
                    let (low, bound) = quintic(&part);
                    let worst = (0..=40)
                        .map(|k| value(&low, f64::from(k) / 40.0).distance(value(&part, f64::from(k) / 40.0)))
                        .fold(0.0, f64::max);
                    assert!(worst <= bound + 1e-14, "case {case}: {worst:e} above {bound:e}");
                    [part, _] = halves(part);
                }
                let (_, bound) = quintic(&part);
                assert!(bound < 1e-5, "case {case}: {bound:e}");
            }
        }
    }
}
