//! Evaluation of a Bézier piece: point and derivatives up to order two.

use glam::{DVec3, DVec4};

/// Homogeneous point and derivatives in the piece's own parameters `s, t` in `[0, 1]`.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Jet {
    pub p: DVec4,
    pub ps: DVec4,
    pub pt: DVec4,
    pub pss: DVec4,
    pub pst: DVec4,
    pub ptt: DVec4,
}

/// The same of the point itself, divided by the weight.
#[derive(Debug, Clone, Copy)]
pub(super) struct CartesianJet {
    pub p: DVec3,
    pub ps: DVec3,
    pub pt: DVec3,
    pub pss: DVec3,
    pub pst: DVec3,
    pub ptt: DVec3,
}

impl Jet {
    /// Evaluates the net of degree `(p, q)` in row order; a curve has `q = 0`.
    pub(super) fn at(net: &[DVec4], (p, q): (usize, usize), s: f64, t: f64) -> Self {
        // the usual degrees with loops of known length, the others with room for the highest
        match (p, q) {
            (1, 0) => curve::<2>(net, p, s),
            (2, 0) => curve::<3>(net, p, s),
            (3, 0) => curve::<4>(net, p, s),
            (_, 0) => curve::<26>(net, p, s),
            (1, 1) => surface::<2, 2>(net, p, q, s, t),
            (1, 2) => surface::<2, 3>(net, p, q, s, t),
            (2, 1) => surface::<3, 2>(net, p, q, s, t),
            (2, 2) => surface::<3, 3>(net, p, q, s, t),
            (3, 1) => surface::<4, 2>(net, p, q, s, t),
            (3, 2) => surface::<4, 3>(net, p, q, s, t),
            (3, 3) => surface::<4, 4>(net, p, q, s, t),
            _ => surface::<26, 26>(net, p, q, s, t),
        }
    }

    /// The point and its derivatives by the quotient rule (The NURBS Book, equations 4.8 and 4.20).
    pub(super) fn cartesian(&self) -> CartesianJet {
        let r = 1.0 / self.p.w;
        let p = self.p.truncate() * r;
        let ps = (self.ps.truncate() - self.ps.w * p) * r;
        let pt = (self.pt.truncate() - self.pt.w * p) * r;
        CartesianJet {
            p,
            ps,
            pt,
            pss: (self.pss.truncate() - 2.0 * self.ps.w * ps - self.pss.w * p) * r,
            pst: (self.pst.truncate() - self.ps.w * pt - self.pt.w * ps - self.pst.w * p) * r,
            ptt: (self.ptt.truncate() - 2.0 * self.pt.w * pt - self.ptt.w * p) * r,
        }
    }
}

fn curve<const N: usize>(net: &[DVec4], p: usize, s: f64) -> Jet {
    let b = basis::<N>(p, s);
    let mut jet = Jet::default();
    for (i, a) in net[..=p].iter().enumerate() {
        jet.p += b[0][i] * *a;
        jet.ps += b[1][i] * *a;
        jet.pss += b[2][i] * *a;
    }
    jet
}

fn surface<const N: usize, const M: usize>(net: &[DVec4], p: usize, q: usize, s: f64, t: f64) -> Jet {
    let (bs, bt) = (basis::<N>(p, s), basis::<M>(q, t));
    let mut jet = Jet::default();
    for (i, row) in net[..(p + 1) * (q + 1)].chunks_exact(q + 1).enumerate() {
        let mut line = [DVec4::ZERO; 3];
        for (j, a) in row.iter().enumerate() {
            line[0] += bt[0][j] * *a;
            line[1] += bt[1][j] * *a;
            line[2] += bt[2][j] * *a;
        }
        jet.p += bs[0][i] * line[0];
        jet.ps += bs[1][i] * line[0];
        jet.pt += bs[0][i] * line[1];
        jet.pss += bs[2][i] * line[0];
        jet.pst += bs[1][i] * line[1];
        jet.ptt += bs[0][i] * line[2];
    }
    jet
}

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
