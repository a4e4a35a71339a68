//! Where a curve stops, turns back, or is straight.
//!
//! With `n` the derivative times the square of the weight, `C' × C''` is `n × n' / w⁴`: both `n` and `n × n'` are polynomials
//! over a piece, and outside the stretches that exclusion by their coefficients leaves over, they do not vanish.

use glam::DVec3;
use perpend_kernel::Direction;

use super::bernstein::{Form, hodograph, rational_hodograph};
use super::continuity::angle;
use super::found::{Found, measured, proved};
use super::near::Near;
use super::options::AcquireOptions;
use super::source::{Piece, Source};
use super::zeros::zeros;
use crate::representation::{Irregularity, ParameterPoint};

/// A span is straight where `C' × C''` is nowhere above this share of the largest that the two could make.
const STRAIGHT: f64 = 1e-12;

/// Two places are one within this share of the domain.
const SAME: f64 = 1e-9;

/// The distance to both sides of a stop at which the tangent is taken, as a share of the span; a tenth of it tells the error.
const BESIDE: f64 = 1e-3;

/// A piece with what its derivatives tell.
struct Traced {
    from: f64,
    to: f64,
    n: Near<DVec3>,
    w: Form<f64>,
    /// The derivative of `n`, where there is one.
    slope: Option<Near<DVec3>>,
}

impl Traced {
    fn of(piece: &Piece, source: &Source) -> Self {
        let p = piece.form.degree.0;
        let n = if source.rational {
            rational_hodograph(&piece.form)
        } else {
            hodograph(&piece.form.map(|c| c.truncate()))
        };
        // extraction leaves 5p u of every coefficient, each product and sum a few more; the subtraction of the middle u
        let error = f64::EPSILON * 32.0 * (p + 4) as f64 * p as f64 * source.reach;
        let slope = (n.degree.0 > 0).then(|| {
            let degree = n.degree.0 as f64;
            let longest = n.coefficients.iter().map(|c| c.length()).fold(0.0, f64::max);
            Near { form: hodograph(&n), error: 2.0 * degree * error + 4.0 * degree * f64::EPSILON * longest }
        });
        Self { from: piece.from.0, to: piece.to.0, n: Near { form: n, error }, w: piece.form.map(|c| c.w), slope }
    }

    fn place(&self, t: f64) -> f64 {
        self.from + t * (self.to - self.from)
    }

    fn share(&self, u: f64) -> f64 {
        ((u - self.from) / (self.to - self.from)).clamp(0.0, 1.0)
    }

    /// The speed, and a bound of its error.
    fn speed(&self, t: f64) -> (f64, f64) {
        let scale = 1.0 / (self.w.at(t).powi(2) * (self.to - self.from));
        (self.n.form.at(t).length() * scale, self.n.error * scale)
    }

    /// `C' × C''` as far as its direction goes, and the curvature.
    fn bend(&self, t: f64) -> (DVec3, f64) {
        let Some(slope) = &self.slope else { return (DVec3::ZERO, 0.0) };
        let n = self.n.form.at(t);
        let bend = n.cross(slope.form.at(t));
        let curvature = bend.length() * self.w.at(t).powi(2) / n.length().powi(3);
        (bend, if curvature.is_finite() { curvature } else { 0.0 })
    }

    /// A bound of the curvature: weights are at most 1.
    fn curvature_bound(&self) -> Option<f64> {
        let Some(slope) = &self.slope else { return Some(0.0) };
        let bound = self.n.cross(slope).bound() / self.n.least().powi(3);
        bound.is_finite().then_some(bound)
    }

    /// The parameter of the least speed in a stretch, by golden section.
    fn slowest(&self, (from, to): (f64, f64)) -> f64 {
        const GOLDEN: f64 = 0.618_033_988_749_894_8;
        let (mut a, mut b) = (from, to);
        for _ in 0..60 {
            let (x, y) = (b - GOLDEN * (b - a), a + GOLDEN * (b - a));
            if self.speed(x).0 <= self.speed(y).0 { b = y } else { a = x }
        }
        let inner = 0.5 * (a + b);
        [from, to, inner].into_iter().min_by(|x, y| self.speed(*x).0.total_cmp(&self.speed(*y).0)).unwrap_or(inner)
    }
}

/// Cusps, vanishing derivatives, inflections and straight stretches of a curve. `creases` are the parameters at which the
/// tangent turns.
pub(super) fn irregular(source: &Source, size: f64, creases: &[f64], options: &AcquireOptions) -> Vec<Found> {
    let (first, last) = source.knots().domain();
    let count = source.knots().spans().count();
    let p = source.degree().0;
    let parts = (options.work as f64 / (count as f64 * (4.0 * p as f64).powi(2))).clamp(8.0, 4096.0) as usize;
    let slow = options.vanishing * size / (last - first);
    let pieces: Vec<Traced> = source.pieces().map(|piece| Traced::of(&piece, source)).collect();
    let mut found = Vec::new();
    let mut stops: Vec<f64> = Vec::new();
    for (k, piece) in pieces.iter().enumerate() {
        let least = slow * (piece.to - piece.from) + piece.n.error;
        for stretch in zeros(&piece.n, least, parts).unwrap_or_default() {
            let t = piece.slowest(stretch);
            let ((speed, gap), u) = (piece.speed(t), piece.place(t));
            let is_new = stops.last().is_none_or(|stop| u - stop > SAME * (last - first));
            if speed > slow + gap || !is_new {
                continue;
            }
            stops.push(u);
            let at = ParameterPoint::Curve(u);
            let value = Irregularity::VanishingDerivative { direction: Direction::U, at, speed };
            found.push(proved(value, gap, slow));
            if let Some((angle, error)) = turn(&pieces, k, u)
                && angle > options.continuity + 2.0 * error
            {
                found.push(measured(Irregularity::Cusp { at, angle }, error, options.continuity));
            }
        }
    }
    found.extend(bends(&pieces, &stops, creases, parts, source.is_planar()));
    found
}

/// The angle by which the tangent turns at a stop in piece `k`, and an estimate of its error; none at an end.
fn turn(pieces: &[Traced], k: usize, u: f64) -> Option<(f64, f64)> {
    let near = |piece: &Traced| 1e-6 * (piece.to - piece.from);
    let piece = &pieces[k];
    let before = if u - piece.from > near(piece) { piece } else { pieces.get(k.checked_sub(1)?)? };
    let after = if piece.to - u > near(piece) { piece } else { pieces.get(k + 1)? };
    let at = |beside: f64| {
        let a = before.n.form.at((before.share(u) - beside).max(0.0));
        let b = after.n.form.at((after.share(u) + beside).min(1.0));
        angle(a, b)
    };
    let (coarse, fine) = (at(BESIDE), at(0.1 * BESIDE));
    Some((fine, (fine - coarse).abs()))
}

/// A stretch on which `C' × C''` may vanish, between two on which it does not.
#[derive(Debug, Clone, Copy)]
struct Flat {
    from: f64,
    to: f64,
    /// The greatest curvature that was met.
    curvature: f64,
    /// A bound of it, where there is one.
    bound: Option<f64>,
}

/// Inflections and zero curvature: the curvature before and after each flat stretch decides.
fn bends(pieces: &[Traced], stops: &[f64], creases: &[f64], parts: usize, planar: bool) -> Vec<Found> {
    let (first, last) = (pieces[0].from, pieces[pieces.len() - 1].to);
    let near = SAME * (last - first);
    let mut walk = Walk { stops, near, planar, found: Vec::new(), before: None, flat: None };
    for piece in pieces {
        if creases.binary_search_by(|at| at.total_cmp(&piece.from)).is_ok() {
            walk.end();
        }
        let flats = flats(piece, parts);
        let mut at = 0.0;
        for (from, to) in &flats {
            if from - at > SAME {
                walk.bent(piece, at, *from);
            }
            walk.flat(piece, *from, *to);
            at = *to;
        }
        if 1.0 - at > SAME {
            walk.bent(piece, at, 1.0);
        }
    }
    walk.end();
    walk.found
}

/// The stretches of a piece on which `C' × C''` may vanish.
fn flats(piece: &Traced, parts: usize) -> Vec<(f64, f64)> {
    let Some(slope) = &piece.slope else { return vec![(0.0, 1.0)] };
    let bend = piece.n.cross(slope);
    if bend.longest() <= STRAIGHT * piece.n.longest() * slope.longest() + bend.error {
        return vec![(0.0, 1.0)];
    }
    // what is not settled is not listed
    zeros(&bend, bend.error, parts).unwrap_or_default()
}

/// A walk along the curve, from bent stretch to bent stretch.
struct Walk<'a> {
    stops: &'a [f64],
    near: f64,
    planar: bool,
    found: Vec<Found>,
    /// The end of the last bent stretch: `C' × C''` and the curvature there.
    before: Option<(DVec3, f64)>,
    /// What is flat since.
    flat: Option<Flat>,
}

impl Walk<'_> {
    fn flat(&mut self, piece: &Traced, from: f64, to: f64) {
        let met = (0..=4).map(|k| piece.bend(from + (to - from) * f64::from(k) / 4.0).1).fold(0.0, f64::max);
        let bound = if to - from == 1.0 { piece.curvature_bound() } else { None };
        let (from, to) = (piece.place(from), piece.place(to));
        let old = self.flat.unwrap_or(Flat { from, to, curvature: 0.0, bound: Some(0.0) });
        let bound = old.bound.zip(bound).map(|(old, new)| old.max(new));
        self.flat = Some(Flat { to, curvature: old.curvature.max(met), bound, ..old });
    }

    fn bent(&mut self, piece: &Traced, from: f64, to: f64) {
        let inside = BESIDE.min(0.5 * (to - from));
        let (start, end) = (from + inside, to - inside);
        // at the ends themselves where there is nothing flat: the curvature may jump
        let entry = piece.bend(if from > 0.0 || self.flat.is_some() { start } else { 0.0 });
        self.settle(piece.place(from), Some(entry));
        self.before = Some(piece.bend(if to < 1.0 { end } else { 1.0 }));
    }

    /// The curve has an end or a corner.
    fn end(&mut self) {
        self.settle(f64::NAN, None);
        self.before = None;
    }

    /// Says what lies between two bent stretches, the second of which starts at `at`.
    fn settle(&mut self, at: f64, after: Option<(DVec3, f64)>) {
        let flat = self.flat.take();
        let turns = match (self.before, after) {
            (Some((a, _)), Some((b, _))) if self.planar => a.dot(b) < 0.0,
            (Some((a, _)), Some((b, _))) => angle(a, -b) < if flat.is_some() { 1.0 } else { 1e-6 },
            _ => false,
        };
        let inflection = |u: f64, curvature: f64| Irregularity::Inflection { at: ParameterPoint::Curve(u), curvature };
        let Some(flat) = flat else {
            if let (true, Some((_, a)), Some((_, b))) = (turns, self.before, after) {
                // the knot is exact, and the signs on both sides are those of the coefficients
                let value = inflection(at, a.max(b));
                self.found.push(if self.planar { proved(value, 0.0, 0.0) } else { measured(value, 0.0, 0.0) });
            }
            return;
        };
        let (width, middle) = (flat.to - flat.from, 0.5 * flat.from + 0.5 * flat.to);
        let is_point = width <= 1e3 * self.near;
        let stops = |stop: &&f64| flat.from - 1e3 * self.near <= **stop && **stop <= flat.to + 1e3 * self.near;
        if is_point && self.stops.iter().any(|stop| stops(&stop)) {
            return; // there is no curvature where the curve stops
        }
        if !is_point || !turns {
            let (from, to) = if is_point { (middle, middle) } else { (flat.from, flat.to) };
            let value = Irregularity::ZeroCurvature { from, to, curvature: flat.curvature };
            self.found.push(match flat.bound {
                Some(bound) if !is_point => proved(value, (bound - flat.curvature).max(0.0), STRAIGHT),
                _ => measured(value, 0.5 * self.near.max(if is_point { width } else { 0.0 }), STRAIGHT),
            });
        }
        if turns {
            // in a plane a change of sign has a zero between
            let value = inflection(middle, 0.0);
            let basis = if self.planar { proved } else { measured };
            self.found.push(basis(value, 0.5 * width, self.near));
        }
    }
}
