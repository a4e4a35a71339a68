//! Newton's method for the nearest point of a leaf, inside a box of its parameters; and the last steps of a query's foot, at parameters to which the
//! definition's own round.

use fearless_simd::{Simd, dispatch};
use glam::DVec3;
use perpend_kernel::Direction;

use super::jet::Jet;
use super::leaf::Leaf;
use super::piece::middle;
use super::state::Foot;
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
    /// Where a step of Newton's method leads from here; the point itself where the box holds it.
    pub next: (f64, f64),
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

    /// The point that the box is, if it is one.
    pub(super) fn corner(&self) -> Option<(f64, f64)> {
        (self.s.0 == self.s.1 && self.t.0 == self.t.1).then_some((self.s.0, self.t.0))
    }

    /// Both halves in a direction.
    pub(super) fn halves(&self, direction: Direction) -> [Self; 2] {
        let (mut low, mut high) = (*self, *self);
        match direction {
            Direction::U => {
                low.s.1 = middle(self.s);
                high.s.0 = low.s.1;
            }
            Direction::V => {
                low.t.1 = middle(self.t);
                high.t.0 = low.t.1;
            }
        }
        [low, high]
    }
}

/// How a search starts and when it stops.
#[derive(Debug, Clone, Copy)]
pub(super) struct Search {
    pub domain: Domain,
    pub start: (f64, f64),
    /// How many points are evaluated at most.
    pub evaluations: u32,
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
    visit: &mut dyn FnMut(&Found) -> bool,
) -> Found {
    dispatch!(leaf.level, simd => search_within(simd, leaf, x, search, done, visit))
}

/// The same where the level is known already.
#[inline(always)]
pub(super) fn search_within<S: Simd>(
    simd: S,
    leaf: &Leaf,
    x: DVec3,
    search: Search,
    done: &mut Work,
    mut visit: impl FnMut(&Found) -> bool,
) -> Found {
    let Search { domain, start: (mut s, mut t), evaluations, decrease } = search;
    let mut evaluated = 0;
    let mut best: Option<Evaluated> = None;
    while evaluated < evaluations.max(1) {
        let there = evaluate_within(simd, leaf, x, &domain, (s, t));
        evaluated += 1;
        match &best {
            Some(best) if there.squared >= best.squared => {
                // halve back towards the best point, unless there is nothing left to gain beside rounding
                let (half_s, half_t) = (0.5 * (s + best.found.s), 0.5 * (t + best.found.t));
                let close = (half_s - s).abs() + (half_t - t).abs() < 1e-15;
                if close || there.squared - best.squared <= decrease.max(8.0 * ROUNDING * best.squared) {
                    break;
                }
                (s, t) = (half_s, half_t);
            }
            _ => {
                let (promised, moves) = (there.promised, there.moves);
                (s, t) = there.found.next;
                let closed = visit(&best.insert(there).found);
                if closed || promised <= decrease || moves < 1e-15 {
                    break;
                }
            }
        }
    }
    done.evaluations += u64::from(evaluated);
    done.newton += u64::from(evaluated);
    best.expect("the start is a point").found
}

/// The point of a leaf at these parameters.
pub(super) fn point(leaf: &Leaf, x: DVec3, at: (f64, f64)) -> Found {
    evaluate(leaf, x, &Domain::WHOLE, at).found
}

/// An evaluated point and the step from it.
struct Evaluated {
    found: Found,
    squared: f64,
    /// The decrease of half `D` that the step's slope promises.
    promised: f64,
    /// The longer of its two parts.
    moves: f64,
}

fn evaluate(leaf: &Leaf, x: DVec3, domain: &Domain, at: (f64, f64)) -> Evaluated {
    dispatch!(leaf.level, simd => evaluate_within(simd, leaf, x, domain, at))
}

#[inline(always)]
fn evaluate_within<S: Simd>(simd: S, leaf: &Leaf, x: DVec3, domain: &Domain, (s, t): (f64, f64)) -> Evaluated {
    let jet = Jet::within(simd, &leaf.net, leaf.degree, leaf.rational, s, t);
    let r = jet.point() - x;
    let squared = r.length_squared();
    let (next, promised) = newton_step(domain, leaf.degree.1 == 0, (s, t), &jet, r);
    let moves = (next.0 - s).abs().max((next.1 - t).abs());
    Evaluated { found: Found { distance: squared.sqrt(), s, t, jet, next }, squared, promised, moves }
}

/// A foot as exactly as its coordinates allow, at parameters of the definition.
#[derive(Debug, Clone, Copy)]
pub(super) struct Polished {
    /// Parameters of the definition.
    pub u: f64,
    pub v: f64,
    /// At the leaf's parameters of these.
    pub found: Found,
}

/// The foot near a point of a leaf as exactly as its coordinates allow.
///
/// Squared distances that differ by rounding alone cannot tell two points apart: near the surface they leave half the digits of
/// the parameters open. What tells is the part of `S - x` along the directions in which the point may still move; Newton's
/// steps are taken while that falls. Every point is evaluated at parameters that the definition's own round to, so that
/// the last is the answer.
pub(super) fn polish(leaf: &Leaf, x: DVec3, foot: &Foot, done: &mut Work) -> Polished {
    dispatch!(leaf.level, simd => polish_within(simd, leaf, x, foot, done))
}

#[inline(always)]
fn polish_within<S: Simd>(simd: S, leaf: &Leaf, x: DVec3, foot: &Foot, done: &mut Work) -> Polished {
    let noise = |distance: f64| 4.0 * ROUNDING * (distance + leaf.radius);
    let mut at = foot.next;
    let mut best: Option<(Polished, f64)> = None;
    for _ in 0..POLISHING {
        done.evaluations += 1;
        let (u, v) = leaf.parameters(at.0, at.1);
        let Evaluated { found, .. } = evaluate_within(simd, leaf, x, &Domain::WHOLE, leaf.own_parameters(u, v));
        let left = residual(leaf, x, &found);
        match &best {
            None if found.distance > foot.distance + noise(foot.distance) && at != (foot.s, foot.t) => {
                // the step led farther away: the foot itself, then
                at = (foot.s, foot.t);
                continue;
            }
            Some((best, before)) => {
                let farther = found.distance > best.found.distance + noise(best.found.distance);
                if left >= *before || farther {
                    break;
                }
            }
            None => {}
        }
        at = found.next;
        let rests = at == (found.s, found.t) || left <= squared(noise(found.distance));
        best = Some((Polished { u, v, found }, left));
        if rests {
            break;
        }
    }
    best.expect("the foot itself is no farther than itself").0
}

/// Steps of [`polish`]: from where a search ends, Newton's method needs one or two; a flat minimum is approached by a factor.
const POLISHING: u32 = 10;

/// The squared length of the part of `S - x` along the directions in which a point of the leaf may still move.
#[inline(always)]
fn residual(leaf: &Leaf, x: DVec3, Found { s, t, jet, .. }: &Found) -> f64 {
    // a slower direction is one of rounding: a pole has none along its edge
    let slowest = squared(64.0 * ROUNDING * leaf.radius);
    let r = jet.point() - x;
    let along = |at: f64, range: (f64, f64), d: DVec3| {
        let (g, dd) = (r.dot(d), d.length_squared());
        if is_held(at, range, g) || dd <= slowest { 0.0 } else { g * g / dd }
    };
    let one = leaf.degree.1 == 0;
    along(*s, (0.0, 1.0), jet.ps.truncate()) + if one { 0.0 } else { along(*t, (0.0, 1.0), jet.pt.truncate()) }
}

/// Whether a point at a border of its range would leave it downhill.
#[inline(always)]
fn is_held(x: f64, (from, to): (f64, f64), slope: f64) -> bool {
    (x <= from && slope >= 0.0) || (x >= to && slope <= 0.0)
}

/// Where a Newton step for half of `D = |S - x|²` leads within the box, and the decrease of half `D` that its slope promises; nowhere, and 0, where
/// the box holds the point in every direction.
#[inline(always)]
fn newton_step(domain: &Domain, one: bool, (s, t): (f64, f64), c: &Jet, r: DVec3) -> ((f64, f64), f64) {
    // half the gradient and half the Hessian of D
    let (ps, pss) = (c.ps.truncate(), c.pss.truncate());
    let (gs, ss) = (r.dot(ps), ps.length_squared());
    let hss = ss + r.dot(pss);
    if one {
        if is_held(s, domain.s, gs) {
            return ((s, t), 0.0);
        }
        let ds = step(gs, hss, ss);
        return (domain.clamp(s + ds, t), -gs * ds);
    }
    let (pt, pst, ptt) = (c.pt.truncate(), c.pst.truncate(), c.ptt.truncate());
    let (gt, tt) = (r.dot(pt), pt.length_squared());
    let (hst, htt) = (ps.dot(pt) + r.dot(pst), tt + r.dot(ptt));
    let (ds, dt) = match (is_held(s, domain.s, gs), is_held(t, domain.t, gt)) {
        (true, true) => return ((s, t), 0.0),
        (true, false) => {
            let dt = step(gt, htt, tt);
            return (domain.clamp(s, t + dt), -gt * dt);
        }
        (false, true) => {
            let ds = step(gs, hss, ss);
            return (domain.clamp(s + ds, t), -gs * ds);
        }
        (false, false) => step2((gs, gt), (hss, hst, htt), (ss, tt)),
    };
    let (to_s, to_t) = domain.clamp(s + ds, t + dt);
    if (to_s, to_t) == (s + ds, t + dt) {
        return ((to_s, to_t), -(gs * ds + gt * dt));
    }
    stopped(domain, (s, t), (gs, gt), (hss, hst, htt), (ss, tt), (ds, dt))
}

/// A step that a border stops: what is left of the slope there leads the other parameter, else the step may lead uphill.
#[inline(never)]
fn stopped(
    domain: &Domain,
    (s, t): (f64, f64),
    (gs, gt): (f64, f64),
    (hss, hst, htt): (f64, f64, f64),
    (ss, tt): (f64, f64),
    (ds, dt): (f64, f64),
) -> ((f64, f64), f64) {
    let (to_s, to_t) = domain.clamp(s + ds, t + dt);
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
    let (ds, dt) = stopped.min_by(|a, b| model(a).total_cmp(&model(b))).unwrap_or((ds, dt));
    (domain.clamp(s + ds, t + dt), -(gs * ds + gt * dt))
}

/// One Newton step in one parameter. The second derivative is used wherever it is positive, however small (beside a centre of
/// curvature it is); else its absolute value, kept away from 0 by the first derivative.
#[inline(always)]
fn step(g: f64, h: f64, first: f64) -> f64 {
    let h = if h > 1e-13 * first { h } else { h.abs().max(1e-3 * first) };
    if h > 0.0 { -g / h } else { 0.0 }
}

/// One Newton step in two parameters. Where the Hessian is not positive, it is taken apart into its two directions (in parameters
/// scaled to unit speed), and each makes its own step as in [`step`]: along a circle of feet that are all as near, one is flat.
#[inline(always)]
fn step2((gs, gt): (f64, f64), (hss, hst, htt): (f64, f64, f64), (ss, tt): (f64, f64)) -> (f64, f64) {
    let determinant = hss * htt - hst * hst;
    if hss > 0.0 && determinant > 1e-13 * ss * tt {
        let inverse = 1.0 / determinant;
        return ((gt * hst - gs * htt) * inverse, (gs * hst - gt * hss) * inverse);
    }
    step2_apart((gs, gt), (hss, hst, htt), (ss, tt))
}

/// The two directions of a Hessian that is not positive, each by itself.
#[inline(never)]
fn step2_apart((gs, gt): (f64, f64), (hss, hst, htt): (f64, f64, f64), (ss, tt): (f64, f64)) -> (f64, f64) {
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
