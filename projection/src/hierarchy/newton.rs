//! Newton's method for the nearest point of a leaf, inside a box of its parameters.

use glam::DVec3;

use super::ROUNDING;
use super::jet::Jet;
use super::leaf::Leaf;
use crate::statistics::Statistics;

/// A point of a leaf.
#[derive(Debug, Clone, Copy)]
pub(super) struct Found {
    /// Its distance from the query.
    pub distance: f64,
    pub s: f64,
    pub t: f64,
    pub jet: Jet,
}

/// A box of a leaf's parameters.
#[derive(Debug, Clone, Copy)]
pub(super) struct Domain {
    pub s: (f64, f64),
    pub t: (f64, f64),
}

impl Domain {
    pub(super) const WHOLE: Self = Self { s: (0.0, 1.0), t: (0.0, 1.0) };

    pub(super) fn clamp(&self, s: f64, t: f64) -> (f64, f64) {
        (s.max(self.s.0).min(self.s.1), t.max(self.t.0).min(self.t.1))
    }

    pub(super) fn contains(&self, s: f64, t: f64) -> bool {
        self.clamp(s, t) == (s, t)
    }
}

/// How a search starts and when it stops.
#[derive(Debug, Clone, Copy)]
pub(super) struct Search {
    pub domain: Domain,
    pub start: (f64, f64),
    /// The evaluation at the start, where the caller has it.
    pub known: Option<Jet>,
    pub iterations: u32,
    /// Stops when the next step would lower the squared distance by less than this. A step size in the parameter would be the
    /// wrong measure: it says nothing of the distance.
    pub decrease: f64,
}

/// The best point that Newton's method for `D = |S - x|²` meets from the start, projected onto the box, halving its way back
/// when `D` grows. `visit` sees every improvement, and stops the search by returning true.
pub(super) fn search(
    leaf: &Leaf,
    x: DVec3,
    search: Search,
    statistics: &mut Statistics,
    mut visit: impl FnMut(&Found) -> bool,
) -> Found {
    let Search { domain, start: (mut s, mut t), mut known, iterations, decrease } = search;
    let one = leaf.degree.1 == 0;
    let mut best: Option<(f64, Found)> = None;
    for _ in 0..iterations.max(1) {
        let jet = known.take().unwrap_or_else(|| {
            statistics.evaluations += 1;
            leaf.jet(s, t)
        });
        let c = jet.cartesian();
        let r = c.p - x;
        let squared = r.length_squared();
        match &best {
            Some((least, found)) if squared >= *least => {
                // halve back towards the best point, unless there is nothing left to gain beside rounding
                let (half_s, half_t) = (0.5 * (s + found.s), 0.5 * (t + found.t));
                let worse = squared - least;
                if (half_s - s).abs() + (half_t - t).abs() < 1e-15 || worse <= decrease.max(8.0 * ROUNDING * least) {
                    break;
                }
                (s, t) = (half_s, half_t);
                continue;
            }
            _ => {
                let found = Found { distance: squared.sqrt(), s, t, jet };
                best = Some((squared, found));
                if visit(&found) {
                    break;
                }
            }
        }
        // half the gradient and half the Hessian of D
        let (gs, gt) = (r.dot(c.ps), r.dot(c.pt));
        let (ss, st, tt) = (c.ps.length_squared(), c.ps.dot(c.pt), c.pt.length_squared());
        let (hss, hst, htt) = (ss + r.dot(c.pss), st + r.dot(c.pst), tt + r.dot(c.ptt));
        let held = |x: f64, (from, to): (f64, f64), g: f64| (x <= from && g >= 0.0) || (x >= to && g <= 0.0);
        let (hold_s, hold_t) = (held(s, domain.s, gs), one || held(t, domain.t, gt));
        let (ds, dt) = match (hold_s, hold_t) {
            (true, true) => break,
            (true, false) => (0.0, step(gt, htt, tt)),
            (false, true) => (step(gs, hss, ss), 0.0),
            (false, false) => step2((gs, gt), (hss, hst, htt), (ss, st, tt)),
        };
        let (next_s, next_t) = domain.clamp(s + ds, t + dt);
        let moved = (next_s - s).abs().max((next_t - t).abs());
        (s, t) = (next_s, next_t);
        if moved < 1e-15 || -(gs * ds + gt * dt) <= decrease {
            break;
        }
    }
    best.expect("the start is a point").1
}

/// One Newton step in one parameter. The second derivative is used wherever it is positive, however small (beside a centre of
/// curvature it is); else its absolute value, kept away from 0 by the first derivative.
fn step(g: f64, h: f64, first: f64) -> f64 {
    let h = if h > 1e-13 * first { h } else { h.abs().max(1e-3 * first) };
    if h > 0.0 { -g / h } else { 0.0 }
}

/// One Newton step in two parameters; where the Hessian is not positive, one of Gauss and Newton, and where the directions are
/// parallel, one in each by itself.
fn step2((gs, gt): (f64, f64), (hss, hst, htt): (f64, f64, f64), (ss, st, tt): (f64, f64, f64)) -> (f64, f64) {
    let solve = |a: f64, b: f64, c: f64| {
        let determinant = a * c - b * b;
        ((gt * b - gs * c) / determinant, (gs * b - gt * a) / determinant)
    };
    if hss > 0.0 && hss * htt - hst * hst > 1e-13 * ss * tt {
        solve(hss, hst, htt)
    } else if ss * tt - st * st > 1e-6 * ss * tt {
        solve(ss, st, tt)
    } else {
        (step(gs, ss, ss), step(gt, tt, tt))
    }
}
