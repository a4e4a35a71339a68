//! Continuity over a line of knots, and over a seam.
//!
//! The Taylor series of both sides are compared by their coefficients, not at samples: the jump of each order is a polynomial
//! along the line, and its coefficients bound it. So do those of `det(n₋, s, n₊)`, the derivatives across and along the
//! line, for the angle between tangent planes. What cannot be bounded so, near a pole, is measured at samples, and says so.

use glam::DVec3;
use perpend_kernel::{Definition, Direction, NurbsSurface};

use super::bernstein::Side;
use super::jets::{Jet, differences, extent, reciprocal};
use super::near::Near;
use super::source::Piece;

/// Points along each piece of a line of knots at which angles are measured, at most.
const SAMPLES: usize = 9;

/// Halvings of a piece along the line of knots, for bounds.
const HALVINGS: u32 = 2;

/// How a definition goes on over a line of knots.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Joint {
    /// Whether a derivative jumps at all.
    pub jumps: bool,
    /// The order of parametric continuity; less than 0 where not even the points are one.
    pub c: i32,
    /// The largest jump up to that order, as a share of the neighbouring spans' size.
    pub c_within: f64,
    /// The order of geometric continuity.
    pub g: i32,
    /// The largest angle up to that order.
    pub g_within: f64,
    /// Whether `g_within` is a bound; else it was measured.
    pub is_proven: bool,
    /// By how much the tangent (the tangent plane) turns, as far as that was looked for.
    pub turn: Turn,
    /// The largest distance of corresponding points.
    pub gap: f64,
}

/// The largest angle by which a tangent (tangent plane) turns.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Turn {
    /// The largest angle that was met.
    pub angle: f64,
    /// By how much a larger one may have been missed: a bound if `is_proven`, else an estimate.
    pub error: f64,
    pub is_proven: bool,
}

/// What a comparison needs to know of the definition.
#[derive(Debug, Clone, Copy)]
pub(super) struct Terms<'a> {
    pub definition: &'a Definition,
    pub direction: Direction,
    pub rational: bool,
    /// The largest distance of a control point from the origin of the pieces.
    pub reach: f64,
    /// [`super::AcquireOptions::continuity`].
    pub tolerance: f64,
}

/// Compares the strips of pieces before and after a line of knots, of which the knots promise continuity of order
/// `promised` (none over a seam, whose points are then compared too).
pub(super) fn joint(before: &[Piece], after: &[Piece], promised: Option<usize>, terms: Terms) -> Joint {
    let size = extent(before, after).max(f64::MIN_POSITIVE);
    let width = |strip: &[Piece]| strip[0].to.0 - strip[0].from.0;
    let (left, right) = (width(before), width(after));
    let step = left.max(right);
    let jets: Vec<[Jet; 2]> = before
        .iter()
        .zip(after)
        .map(|(a, b)| {
            let jet = |piece, at_end, step| Jet::of(piece, at_end, step, terms.reach, terms.rational);
            [jet(a, true, step / left), jet(b, false, step / right)]
        })
        .collect();
    let jumps: Vec<Jumps> = jets.iter().map(|[a, b]| Jumps::of(a, b, promised, terms.tolerance * size)).collect();
    let held = jumps.iter().map(|jumps| jumps.held.len()).min().unwrap_or(0);
    let c = promised.map_or(-1, |order| order as i32) + held as i32;
    let c_within = jumps.iter().flat_map(|j| &j.held[..held]).fold(0.0, |most: f64, jump| most.max(jump / size));
    let gap = if promised.is_none() { jumps.iter().map(|j| j.first).fold(0.0, f64::max) } else { 0.0 };
    let all_held = jumps.iter().all(|j| j.is_all && j.held.len() == held);
    let mut joint = Joint {
        jumps: !all_held,
        c,
        c_within,
        g: c,
        g_within: 0.0,
        is_proven: true,
        turn: Turn { is_proven: true, ..Turn::default() },
        gap,
    };
    if c == 0 {
        joint.turn = turn(&jets);
        let angle = joint.turn.angle + joint.turn.error;
        if angle <= terms.tolerance {
            (joint.g, joint.g_within, joint.is_proven) = (1, angle, joint.turn.is_proven);
        } else if joint.turn.angle <= terms.tolerance && !joint.turn.is_proven {
            (joint.g, joint.g_within, joint.is_proven) = (1, joint.turn.angle, false);
        }
    }
    let is_smooth = joint.jumps && c <= 1 && joint.g >= 1;
    if is_smooth
        && let Some((bend, is_proven)) = bend(&jets, c, before[0].to.0, after[0].from.0, size, terms)
        && bend <= terms.tolerance
    {
        (joint.g, joint.g_within) = (2, joint.g_within.max(bend));
        joint.is_proven &= is_proven;
    }
    joint
}

/// Bounds of the jumps of the orders after the promised one.
struct Jumps {
    /// Those within the tolerance.
    held: Vec<f64>,
    /// Whether all that can differ are.
    is_all: bool,
    /// The first one.
    first: f64,
}

impl Jumps {
    fn of(before: &Jet, after: &Jet, promised: Option<usize>, tolerance: f64) -> Self {
        let next = promised.map_or(0, |order| order + 1);
        let mut jumps = Self { held: Vec::new(), is_all: true, first: 0.0 };
        let mut sizes: Vec<f64> = vec![0.0; next];
        for (k, difference) in differences(before, after, next) {
            sizes.push(difference.bound());
            let series = reciprocal(before, after, k);
            let jump: f64 = sizes.iter().enumerate().map(|(i, size)| size * series[k - i]).sum();
            if k == next {
                jumps.first = jump;
            }
            // NaN where extreme weights overflow: it is not held then
            if jump <= tolerance {
                jumps.held.push(jump);
            } else {
                jumps.is_all = false;
                break;
            }
        }
        jumps
    }
}

/// The angle between two vectors.
pub(super) fn angle(a: DVec3, b: DVec3) -> f64 {
    let (a, b) = (a.normalize_or_zero(), b.normalize_or_zero());
    a.cross(b).length().atan2(a.dot(b))
}

fn turn(jets: &[[Jet; 2]]) -> Turn {
    let mut turn = Turn { is_proven: true, ..Turn::default() };
    let (mut bound, mut coarse) = (0.0_f64, 0.0_f64);
    for [before, after] in jets {
        let (mut a, mut b) = (before.across(), after.across());
        if let Some(along) = &before.along {
            (a, b) = (a.cross(along), b.cross(along));
        } else if a.longest() <= 1e3 * a.error || b.longest() <= 1e3 * b.error {
            // the curve stops: the next derivative that does not vanish has its direction, up to rounding
            let first = |jet: &Jet, sign: f64| {
                let mut found = (1..jet.points.len()).map(|k| (k, &jet.points[k]));
                let (k, term) = found.find(|(_, term)| term.longest() > 1e3 * term.error)?;
                Some(term.form.coefficients[0] * if k % 2 == 0 { sign } else { 1.0 })
            };
            if let (Some(a), Some(b)) = (first(before, -1.0), first(after, 1.0)) {
                turn.angle = turn.angle.max(angle(a, b));
            }
            (turn.is_proven, turn.error) = (false, 1e-3);
            continue;
        }
        let samples = if before.along.is_some() { SAMPLES.min(2 * before.points[0].form.degree.0 + 1) } else { 1 };
        for k in 0..samples {
            let t = if samples == 1 { 0.0 } else { k as f64 / (samples - 1) as f64 };
            let (a, b) = ((a.form.at(t), a.error), (b.form.at(t), b.error));
            let found = if [a, b].iter().all(|(n, error)| n.length() > 1e6 * error) { angle(a.0, b.0) } else { 0.0 };
            turn.angle = turn.angle.max(found);
            if k % 2 == 0 {
                coarse = coarse.max(found);
            }
        }
        match widest(&a, &b, HALVINGS) {
            Some(angle) => bound = bound.max(angle),
            None => turn.is_proven = false,
        }
    }
    if turn.error == 0.0 {
        turn.error = if turn.is_proven { (bound - turn.angle).max(0.0) } else { turn.angle - coarse };
    }
    turn
}

/// A bound of the angle between `a` and `b` at the same parameter, over the whole of it; none where one of them may vanish.
fn widest(a: &Near<DVec3>, b: &Near<DVec3>, halvings: u32) -> Option<f64> {
    let cones = a.cone().zip(b.cone());
    let by_cones = cones.map(|((m, alpha), (n, beta))| angle(m, n) + alpha + beta);
    let by_sine = {
        let sine = a.cross(b).bound() / (a.least() * b.least());
        let cosine = a.product(b, |a, b| a.dot(b));
        let ahead = cosine.form.coefficients.iter().all(|c| *c > cosine.error);
        (ahead && sine < 0.5).then(|| sine.asin() * (1.0 + 8.0 * f64::EPSILON))
    };
    let bound = match (by_cones, by_sine) {
        (Some(x), Some(y)) => Some(x.min(y)),
        (x, y) => x.or(y),
    };
    if halvings == 0 || a.form.degree.0 == 0 || bound.is_some_and(|bound| bound <= 1e-9) {
        return bound;
    }
    let (a, b) = (a.halves(Side::First), b.halves(Side::First));
    let (lower, upper) = (widest(&a.0, &b.0, halvings - 1)?, widest(&a.1, &b.1, halvings - 1)?);
    Some(lower.max(upper))
}

/// The angle that the jump of the curvature makes over `size`, and whether that is a bound; none where there is no curvature.
fn bend(jets: &[[Jet; 2]], c: i32, before: f64, after: f64, size: f64, terms: Terms) -> Option<(f64, bool)> {
    if let Definition::NurbsSurface(surface) = terms.definition {
        if c == 1
            && let Some(bound) = bend_of_surface(jets, size)
        {
            return Some((bound, true));
        }
        return Some((measured_bend(surface, terms.direction, before, after, size)?, false));
    }
    let side = |jet: &Jet| {
        // the Taylor series of the quotient
        let (w0, w1) = (jet.weights[0].form.coefficients[0], jet.weights[1].form.coefficients[0]);
        let at = |k: usize| jet.points.get(k).map_or(DVec3::ZERO, |p| p.form.coefficients[0]);
        let w2 = jet.weights.get(2).map_or(0.0, |w| w.form.coefficients[0]);
        let s0 = at(0) / w0;
        let s1 = (at(1) - s0 * w1) / w0;
        let s2 = (at(2) - s0 * w2 - s1 * w1) / w0;
        let noise = |k: usize| jet.points.get(k).map_or(0.0, |p| p.error);
        let heavy = 1.0 + w1.abs() / w0 + w2.abs() / w0;
        let (e1, e2) = (4.0 * heavy * noise(1) / w0, 4.0 * heavy * heavy * (noise(1) + noise(2)) / w0);
        let length = s1.length();
        if length <= 100.0 * e1 {
            return None;
        }
        let tangent = s1 / length;
        let curvature = 2.0 * (s2 - tangent * s2.dot(tangent)) / (length * length);
        // to first order, twice: the error of the tangent is below a hundredth of it
        let error = 2.0 * (2.0 * e2 + 8.0 * s2.length() * e1 / length) / (length * length);
        Some((curvature, error))
    };
    let ((a, e), (b, f)) = (side(&jets[0][0])?, side(&jets[0][1])?);
    Some(((a.distance(b) + e + f) * size, true))
}

/// Where the first derivatives are one, the curvature across the line jumps by the jump of the second derivative's part along
/// the normal: `2 |N · ΔS₂| |s|² / |N|³` with `N = n × s`.
fn bend_of_surface(jets: &[[Jet; 2]], size: f64) -> Option<f64> {
    let mut most = 0.0_f64;
    for [before, after] in jets {
        let along = before.along.as_ref()?;
        let (_, jump) = differences(before, after, 2).next()?;
        let normal = before.across().cross(along);
        let triple = normal.product(&jump, |n, d| n.dot(d));
        // numerators of rational derivatives are the derivatives times w₋², the jump's is the jump times w₋ w₊; w is at most 1
        let (one, other) = (&before.weights[0], &after.weights[0]);
        let is_same = one.plus(-1.0, other).longest() <= 4.0 * (one.error + other.error);
        let least_weight = other.form.coefficients.iter().copied().fold(f64::INFINITY, f64::min);
        let share = if is_same { 1.0 + 1e-9 } else { one.bound().powi(3) / least_weight };
        let least = normal.least();
        most = most.max(2.0 * share * triple.bound() * along.bound().powi(2) / least.powi(3));
    }
    (most.is_finite()).then_some(most * size)
}

/// The same at samples of the line, by the definition's own derivatives.
fn measured_bend(surface: &NurbsSurface, direction: Direction, before: f64, after: f64, size: f64) -> Option<f64> {
    let across = super::other(direction);
    let mut most = None;
    for span in surface.knots(across).spans().take(64) {
        for k in 0..SAMPLES {
            let place = span.start + (span.end - span.start) * (k as f64 + 0.5) / SAMPLES as f64;
            let curvature = |at: f64, left: bool| {
                let mut d = [DVec3::ZERO; 9];
                let (u, v, below, step, cross) = match direction {
                    Direction::U => (at, place, [left, false], 3, 1),
                    Direction::V => (place, at, [false, left], 1, 3),
                };
                surface.derivatives_from(u, v, below, 2, &mut d);
                let (over, along) = (d[step], d[cross]);
                let (second, mixed, far) = (d[2 * step], d[step + cross], d[2 * cross]);
                let n = over.cross(along).try_normalize()?;
                // the direction across the line in the tangent plane: a `over` + b `along`, at right angles to `along`
                let share = over.dot(along) / along.length_squared();
                let length = (over - along * share).length();
                let (a, b) = (1.0 / length, -share / length);
                Some(a * a * second.dot(n) + 2.0 * a * b * mixed.dot(n) + b * b * far.dot(n))
            };
            if let (Some(x), Some(y)) = (curvature(before, true), curvature(after, false)) {
                let jump = (x - y).abs() * size;
                most = Some(most.map_or(jump, |most: f64| most.max(jump)));
            }
        }
    }
    most.filter(|most| most.is_finite())
}
