//! Newton's method for the nearest point of a leaf, inside a box of its parameters.

use glam::DVec3;

use super::jet::{CartesianJet, Jet};
use super::leaf::Leaf;
use super::{ROUNDING, squared};
use crate::statistics::Work;

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
    done: &mut Work,
    mut visit: impl FnMut(&Found) -> bool,
) -> Found {
    let Search { domain, start: (mut s, mut t), mut known, iterations, decrease } = search;
    let one = leaf.degree.1 == 0;
    let mut best: Option<(f64, Found)> = None;
    for _ in 0..iterations.max(1) {
        let jet = known.take().unwrap_or_else(|| {
            done.evaluations += 1;
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
        let Some(((ds, dt), promised)) = newton_step(&domain, one, (s, t), &c, r) else { break };
        done.newton += 1;
        let (next_s, next_t) = domain.clamp(s + ds, t + dt);
        let moved = (next_s - s).abs().max((next_t - t).abs());
        (s, t) = (next_s, next_t);
        if moved < 1e-15 || promised <= decrease {
            break;
        }
    }
    best.expect("the start is a point").1
}

/// The foot near `start` as exactly as its coordinates allow.
///
/// Squared distances that differ by rounding alone cannot tell two points apart: near the surface they leave half the digits of
/// the parameters open. What tells is the part of `S - x` along the directions in which the point may still move; Newton's
/// steps are taken while that falls.
pub(super) fn polish(leaf: &Leaf, x: DVec3, start: (f64, f64), known: Option<Jet>, done: &mut Work) -> Found {
    let (domain, one) = (Domain::WHOLE, leaf.degree.1 == 0);
    // a slower direction is one of rounding: a pole has none along its edge
    let slowest = squared(64.0 * ROUNDING * leaf.radius);
    let mut evaluate = |s: f64, t: f64, jet: Option<Jet>| {
        let jet = jet.unwrap_or_else(|| {
            done.evaluations += 1;
            leaf.jet(s, t)
        });
        let c = jet.cartesian();
        let r = c.p - x;
        let found = Found { distance: r.length(), s, t, jet };
        (found, c, r, residual(&domain, one, (s, t), &c, r, slowest))
    };
    let (mut best, mut c, mut r, mut left) = evaluate(start.0, start.1, known);
    let mut steps = 0;
    for _ in 0..POLISHING {
        let Some(((ds, dt), _)) = newton_step(&domain, one, (best.s, best.t), &c, r) else { break };
        let (s, t) = domain.clamp(best.s + ds, best.t + dt);
        if (s, t) == (best.s, best.t) || left <= squared(ROUNDING * (best.distance + leaf.radius)) {
            break;
        }
        let next = evaluate(s, t, None);
        steps += 1;
        let noise = 4.0 * ROUNDING * (best.distance + leaf.radius);
        if next.3 >= left || next.0.distance > best.distance + noise {
            break;
        }
        (best, c, r, left) = next;
    }
    done.newton += steps;
    best
}

/// Steps of [`polish`]: from where a search ends, Newton's method needs one or two; a flat minimum is approached by a factor.
const POLISHING: u32 = 10;

/// The squared length of the part of `r` along the directions in which a point of the box may still move.
fn residual(domain: &Domain, one: bool, (s, t): (f64, f64), c: &CartesianJet, r: DVec3, slowest: f64) -> f64 {
    let along = |x: f64, range: (f64, f64), d: DVec3| {
        let (g, dd) = (r.dot(d), d.length_squared());
        if is_held(x, range, g) || dd <= slowest { 0.0 } else { g * g / dd }
    };
    along(s, domain.s, c.ps) + if one { 0.0 } else { along(t, domain.t, c.pt) }
}

/// Whether a point at a border of its range would leave it downhill.
fn is_held(x: f64, (from, to): (f64, f64), slope: f64) -> bool {
    (x <= from && slope >= 0.0) || (x >= to && slope <= 0.0)
}

/// A Newton step for half of `D = |S - x|²`, with the decrease of half `D` that its slope promises; none where the box holds
/// the point in every direction.
fn newton_step(
    domain: &Domain,
    one: bool,
    (s, t): (f64, f64),
    c: &CartesianJet,
    r: DVec3,
) -> Option<((f64, f64), f64)> {
    // half the gradient and half the Hessian of D
    let (gs, gt) = (r.dot(c.ps), r.dot(c.pt));
    let (ss, tt) = (c.ps.length_squared(), c.pt.length_squared());
    let (hss, hst, htt) = (ss + r.dot(c.pss), c.ps.dot(c.pt) + r.dot(c.pst), tt + r.dot(c.ptt));
    let (ds, dt) = match (is_held(s, domain.s, gs), one || is_held(t, domain.t, gt)) {
        (true, true) => return None,
        (true, false) => (0.0, step(gt, htt, tt)),
        (false, true) => (step(gs, hss, ss), 0.0),
        (false, false) => {
            let (ds, dt) = step2((gs, gt), (hss, hst, htt), (ss, tt));
            let (to_s, to_t) = domain.clamp(s + ds, t + dt);
            // the border stops a parameter: what is left of the slope there leads the other, else the step may lead uphill
            let stopped_s = (to_s != s + ds).then(|| {
                let ds = to_s - s;
                (ds, domain.clamp(s, t + step(gt + hst * ds, htt, tt)).1 - t)
            });
            let stopped_t = (to_t != t + dt).then(|| {
                let dt = to_t - t;
                (domain.clamp(s + step(gs + hst * dt, hss, ss), t).0 - s, dt)
            });
            let model = |(a, b): &(f64, f64)| gs * a + gt * b + 0.5 * (hss * a * a + htt * b * b) + hst * a * b;
            let stopped = [stopped_s, stopped_t].into_iter().flatten();
            stopped.min_by(|a, b| model(a).total_cmp(&model(b))).unwrap_or((ds, dt))
        }
    };
    Some(((ds, dt), -(gs * ds + gt * dt)))
}

/// One Newton step in one parameter. The second derivative is used wherever it is positive, however small (beside a centre of
/// curvature it is); else its absolute value, kept away from 0 by the first derivative.
fn step(g: f64, h: f64, first: f64) -> f64 {
    let h = if h > 1e-13 * first { h } else { h.abs().max(1e-3 * first) };
    if h > 0.0 { -g / h } else { 0.0 }
}

/// One Newton step in two parameters. Where the Hessian is not positive, it is taken apart into its two directions (in parameters
/// scaled to unit speed), and each makes its own step as in [`step`]: along a circle of feet that are all as near, one is flat.
fn step2((gs, gt): (f64, f64), (hss, hst, htt): (f64, f64, f64), (ss, tt): (f64, f64)) -> (f64, f64) {
    let determinant = hss * htt - hst * hst;
    if hss > 0.0 && determinant > 1e-13 * ss * tt {
        return ((gt * hst - gs * htt) / determinant, (gs * hst - gt * hss) / determinant);
    }
    let (speed_s, speed_t) = (ss.sqrt(), tt.sqrt());
    if speed_s == 0.0 || speed_t == 0.0 {
        return (step(gs, hss, ss), step(gt, htt, tt));
    }
    let (a, b, c) = (hss / ss, hst / (speed_s * speed_t), htt / tt);
    let (mean, half, radius) = (0.5 * (a + c), 0.5 * (a - c), (0.5 * (a - c)).hypot(b));
    // the direction of the greater eigenvalue
    let (x, y) = if radius == 0.0 {
        (1.0, 0.0)
    } else if half >= 0.0 {
        (half + radius, b)
    } else {
        (b, radius - half)
    };
    let length = x.hypot(y);
    let (x, y) = (x / length, y / length);
    let (gs, gt) = (gs / speed_s, gt / speed_t);
    let along = step(gs * x + gt * y, mean + radius, 1.0);
    let across = step(gt * x - gs * y, mean - radius, 1.0);
    ((along * x - across * y) / speed_s, (along * y + across * x) / speed_t)
}
