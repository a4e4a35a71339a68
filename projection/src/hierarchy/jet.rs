//! Evaluation of a Bézier piece: point and derivatives up to order two.

use fearless_simd::prelude::*;
use fearless_simd::{Level, dispatch, f64x4};
use glam::{DVec3, DVec4};

/// The point and its derivatives in the piece's own parameters `s, t` in `[0, 1]`; as fourth coordinate of each, the same of the weight. Of a
/// polynomial piece that is 1, and 0 for the derivatives, but for rounding.
#[derive(Debug, Clone, Copy)]
pub(super) struct Jet {
    pub p: DVec4,
    pub ps: DVec4,
    pub pt: DVec4,
    pub pss: DVec4,
    pub pst: DVec4,
    pub ptt: DVec4,
}

impl Jet {
    /// Evaluates the net of degree `(p, q)` in row order; a curve has `q = 0`. The same bits at every level: products are
    /// rounded before they are added.
    pub(super) fn at(level: Level, net: &[DVec4], degree: (usize, usize), rational: bool, s: f64, t: f64) -> Self {
        dispatch!(level, simd => Self::within(simd, net, degree, rational, s, t))
    }

    /// The same where the level is known already.
    #[inline(always)]
    pub(super) fn within<S: Simd>(
        simd: S,
        net: &[DVec4],
        degree: (usize, usize),
        rational: bool,
        s: f64,
        t: f64,
    ) -> Self {
        // the usual degrees with loops of known length, the others with room for the highest
        match degree {
            (1, 0) => curve::<_, 2>(simd, net, 1, s).jet(rational),
            (2, 0) => curve::<_, 3>(simd, net, 2, s).jet(rational),
            (3, 0) => curve::<_, 4>(simd, net, 3, s).jet(rational),
            (p @ 4..8, 0) => curve::<_, 8>(simd, net, p, s).jet(rational),
            (p, 0) => any_curve(simd, net, p, s).jet(rational),
            (1, 1) => surface::<_, 2, 2>(simd, net, 1, 1, s, t).jet(rational),
            (1, 2) => surface::<_, 2, 3>(simd, net, 1, 2, s, t).jet(rational),
            (2, 1) => surface::<_, 3, 2>(simd, net, 2, 1, s, t).jet(rational),
            (2, 2) => surface::<_, 3, 3>(simd, net, 2, 2, s, t).jet(rational),
            (3, 1) => surface::<_, 4, 2>(simd, net, 3, 1, s, t).jet(rational),
            (3, 2) => surface::<_, 4, 3>(simd, net, 3, 2, s, t).jet(rational),
            (2, 3) => surface::<_, 3, 4>(simd, net, 2, 3, s, t).jet(rational),
            (3, 3) => surface::<_, 4, 4>(simd, net, 3, 3, s, t).jet(rational),
            (p @ ..6, q @ ..6) => surface::<_, 6, 6>(simd, net, p, q, s, t).jet(rational),
            (p, q) => any_surface(simd, net, p, q, s, t).jet(rational),
        }
    }

    /// The point.
    pub(super) fn point(&self) -> DVec3 {
        self.p.truncate()
    }
}

/// Homogeneous point and derivatives.
struct Homogeneous<S: Simd> {
    p: f64x4<S>,
    ps: f64x4<S>,
    pt: f64x4<S>,
    pss: f64x4<S>,
    pst: f64x4<S>,
    ptt: f64x4<S>,
}

impl<S: Simd> Homogeneous<S> {
    #[inline(always)]
    fn zero(simd: S) -> Self {
        let zero = f64x4::splat(simd, 0.0);
        Self { p: zero, ps: zero, pt: zero, pss: zero, pst: zero, ptt: zero }
    }

    #[inline(always)]
    fn jet(self, rational: bool) -> Jet {
        let Self { p, ps, pt, pss, pst, ptt } = if rational { self.divided() } else { self };
        let plain = |x: f64x4<S>| DVec4::from_array(x.into());
        Jet { p: plain(p), ps: plain(ps), pt: plain(pt), pss: plain(pss), pst: plain(pst), ptt: plain(ptt) }
    }

    /// By the quotient rule (The NURBS Book, equations 4.8 and 4.20), the weights left as they are.
    #[inline(always)]
    fn divided(self) -> Self {
        let Self { p, ps, pt, pss, pst, ptt } = self;
        let simd = p.simd;
        let (w, ws, wt, wss, wst, wtt) = (p[3], ps[3], pt[3], pss[3], pst[3], ptt[3]);
        let r = 1.0 / w;
        // the factors of a whole quotient, and of one whose fourth coordinate takes no part in what follows
        let (whole, point) = (f64x4::simd_from(simd, [r, r, r, 1.0]), f64x4::simd_from(simd, [r, r, r, 0.0]));
        let at = p * point;
        let (by_s, by_t) = (ps - at * ws, pt - at * wt);
        let (along_s, along_t) = (by_s * point, by_t * point);
        Self {
            p: p * whole,
            ps: by_s * whole,
            pt: by_t * whole,
            pss: (pss - along_s * (2.0 * ws) - at * wss) * whole,
            pst: (pst - along_t * ws - along_s * wt - at * wst) * whole,
            ptt: (ptt - along_t * (2.0 * wt) - at * wtt) * whole,
        }
    }
}

#[inline(always)]
fn curve<S: Simd, const N: usize>(simd: S, net: &[DVec4], p: usize, s: f64) -> Homogeneous<S> {
    let b = basis::<N>(p, s);
    let mut sum = Homogeneous::zero(simd);
    for (i, a) in net[..=p].iter().enumerate() {
        let a = f64x4::simd_from(simd, a.to_array());
        sum.p += a * b[0][i];
        sum.ps += a * b[1][i];
        sum.pss += a * b[2][i];
    }
    sum
}

#[inline(always)]
fn surface<S: Simd, const N: usize, const M: usize>(
    simd: S,
    net: &[DVec4],
    p: usize,
    q: usize,
    s: f64,
    t: f64,
) -> Homogeneous<S> {
    let (bs, bt) = (basis::<N>(p, s), basis::<M>(q, t));
    let mut sum = Homogeneous::zero(simd);
    for (i, row) in net[..(p + 1) * (q + 1)].chunks_exact(q + 1).enumerate() {
        let mut line = [f64x4::splat(simd, 0.0); 3];
        for (j, a) in row.iter().enumerate() {
            let a = f64x4::simd_from(simd, a.to_array());
            line[0] += a * bt[0][j];
            line[1] += a * bt[1][j];
            line[2] += a * bt[2][j];
        }
        sum.p += line[0] * bs[0][i];
        sum.ps += line[0] * bs[1][i];
        sum.pt += line[1] * bs[0][i];
        sum.pss += line[0] * bs[2][i];
        sum.pst += line[1] * bs[1][i];
        sum.ptt += line[2] * bs[0][i];
    }
    sum
}

/// The degrees without loops of their own, apart from the others: their tables take much of the stack.
#[inline(never)]
fn any_curve<S: Simd>(simd: S, net: &[DVec4], p: usize, s: f64) -> Homogeneous<S> {
    simd.vectorize(
        #[inline(always)]
        || curve::<S, MOST>(simd, net, p, s),
    )
}

#[inline(never)]
fn any_surface<S: Simd>(simd: S, net: &[DVec4], p: usize, q: usize, s: f64, t: f64) -> Homogeneous<S> {
    simd.vectorize(
        #[inline(always)]
        || surface::<S, MOST, MOST>(simd, net, p, q, s, t),
    )
}

/// Basis functions of the highest degree.
const MOST: usize = 26;

/// The Bernstein polynomials of degree `n` at `x` and their first two derivatives; `N > n`.
#[inline(always)]
fn basis<const N: usize>(n: usize, x: f64) -> [[f64; N]; 3] {
    let y = 1.0 - x;
    let mut b = [[0.0; N]; 3];
    match n {
        1 => {
            (b[0][0], b[0][1]) = (y, x);
            (b[1][0], b[1][1]) = (-1.0, 1.0);
        }
        2 => {
            (b[0][0], b[0][1], b[0][2]) = (y * y, 2.0 * x * y, x * x);
            (b[1][0], b[1][1], b[1][2]) = (-2.0 * y, 2.0 * (y - x), 2.0 * x);
            (b[2][0], b[2][1], b[2][2]) = (2.0, -4.0, 2.0);
        }
        3 => {
            let (xx, yy, xy) = (x * x, y * y, x * y);
            (b[0][0], b[0][1], b[0][2], b[0][3]) = (yy * y, 3.0 * yy * x, 3.0 * y * xx, xx * x);
            (b[1][0], b[1][1]) = (-3.0 * yy, 3.0 * (yy - 2.0 * xy));
            (b[1][2], b[1][3]) = (3.0 * (2.0 * xy - xx), 3.0 * xx);
            (b[2][0], b[2][1], b[2][2], b[2][3]) = (6.0 * y, 6.0 * (x - 2.0 * y), 6.0 * (y - 2.0 * x), 6.0 * x);
        }
        _ => {
            // degree by degree; the derivatives are differences of the functions one and two degrees below
            b[0][0] = 1.0;
            for degree in 1..=n {
                if degree + 1 == n {
                    let factor = (n * (n - 1)) as f64;
                    for i in 0..=n {
                        let at = |k: usize| if i >= k && i - k <= n - 2 { b[0][i - k] } else { 0.0 };
                        b[2][i] = factor * (at(2) - 2.0 * at(1) + at(0));
                    }
                }
                if degree == n {
                    for i in 0..=n {
                        let at = |k: usize| if i >= k && i - k < n { b[0][i - k] } else { 0.0 };
                        b[1][i] = n as f64 * (at(1) - at(0));
                    }
                }
                let mut carried = 0.0;
                for value in &mut b[0][..degree] {
                    let share = *value;
                    *value = carried + y * share;
                    carried = x * share;
                }
                b[0][degree] = carried;
            }
        }
    }
    b
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_degree_is_a_partition_of_unity_with_the_right_derivatives() {
        for n in 1..=25 {
            for x in [0.0, 0.2, 0.5, 0.91, 1.0] {
                let b = basis::<26>(n, x);
                assert!((b[0][..=n].iter().sum::<f64>() - 1.0).abs() < 1e-14);
                assert!(b[1][..=n].iter().sum::<f64>().abs() < 1e-12);
                assert!(b[2][..=n].iter().sum::<f64>().abs() < 1e-10);
                let (h, inner) = (1e-5, f64::clamp(x, 1e-4, 1.0 - 1e-4));
                let (low, at, high) = (basis::<26>(n, inner - h), basis::<26>(n, inner), basis::<26>(n, inner + h));
                for i in 0..=n {
                    assert!((at[1][i] - (high[0][i] - low[0][i]) / (2.0 * h)).abs() < 1e-5 * (n * n) as f64, "{n} {i}");
                    assert!((at[2][i] - (high[1][i] - low[1][i]) / (2.0 * h)).abs() < 1e-4 * (n * n) as f64, "{n} {i}");
                }
            }
        }
    }
}
