//! The least and the greatest speed, proven.
//!
//! Over a Bézier piece the derivative is `n / w²` with `n = x' w - x w'` (Piegl and Tiller 1997, "Symbolic operators for
//! NURBS"). `|n|²` and `w⁴` are raised to one degree; their quotient then lies between the least and the greatest quotient of
//! their coefficients, and at the corners it equals that of the corner's. The piece that holds the extreme bound is halved
//! until bound and attained value agree: bounds converge with the square of the width, so few pieces are live at a time.
//! Where the least speed is attained along a whole line, that would take very many: there `n · d / w²` with the direction `d`
//! of the slowest derivative found is a lower bound too, and often the better one.
//! The vector `n` is halved, not its square, so that a derivative that vanishes is resolved to rounding and not to its root.

use std::collections::BinaryHeap;

use glam::DVec3;

use super::bernstein::{Form, Side, hodograph, rational_hodograph};
use super::open::Open;
use super::source::{Piece, Source, halfway};

/// How far apart bound and attained value may stay, as a share of the greatest speed.
const TIGHT: f64 = 1e-9;

/// Weights that differ by more leave nothing of `w⁴`.
const LIGHTEST: f64 = 1e-50;

/// Halvings of a piece: beyond, parameters are no longer told apart.
const DEEPEST: u32 = 44;

/// An extreme speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Extreme {
    /// Proven: no speed is beyond it.
    pub bound: f64,
    /// A speed that is attained, up to rounding.
    pub attained: f64,
    /// Where.
    pub at: (f64, f64),
}

/// The extreme speeds over one span of the first parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Range {
    pub from: f64,
    pub to: f64,
    pub least: Extreme,
    pub greatest: Extreme,
}

/// The extreme speeds in the first parameter, span by span, with at most `work` products of coefficients.
pub(crate) fn ranges(source: &Source, work: f64) -> Vec<Range> {
    let spans = source.knots().spans().count();
    let share = work / spans as f64;
    let columns = source.columns();
    source
        .knots()
        .spans()
        .map(|span| {
            let cost = cost(source);
            let pieces = source.strip(span, &columns);
            if source.lightest < LIGHTEST || cost * source.strip_length() as f64 > share.max(cost) {
                return rough(source, pieces);
            }
            let leaves: Vec<Leaf> = pieces.iter().map(|piece| Leaf::of(piece, source)).collect();
            let budget = 0.5 * share / cost;
            let greatest = search(leaves.iter().cloned(), Goal::Greatest, budget, 0.0);
            let least = search(leaves.into_iter(), Goal::Least, budget, greatest.attained);
            Range { from: span.start, to: span.end, least, greatest }
        })
        .collect()
}

/// Products of coefficients that one leaf takes.
fn cost(source: &Source) -> f64 {
    let (p, q) = source.degree();
    let size = |m: usize, n: usize| ((m + 1) * (n + 1)) as f64;
    if source.rational {
        2.0 * size(2 * p - 2, 2 * q).powi(2) + size(2 * p, 2 * q).powi(2)
    } else {
        2.0 * size(p - 1, q).powi(2)
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Goal {
    Least,
    Greatest,
}

/// A part of a piece.
#[derive(Debug, Clone)]
struct Leaf {
    /// The derivative times `w²`, per width of the piece.
    n: Form<DVec3>,
    /// `w²`; none where all weights are 1.
    w2: Option<Form<f64>>,
    from: (f64, f64),
    to: (f64, f64),
    depth: u32,
    /// The width of the whole piece in the first parameter.
    width: f64,
    /// What rounding moved `n` by at most.
    error: f64,
    /// What one more halving adds to that.
    step: f64,
    /// The least and the greatest speed: bounds, and the corner that comes nearest to them.
    least: Extreme,
    greatest: Extreme,
    /// The direction of the derivative where it is least.
    slowest: DVec3,
    /// The part of the bounds that rounding makes up.
    reserve: f64,
    /// The parameter in which the quotients vary more.
    side: Side,
}

impl Leaf {
    fn of(piece: &Piece, source: &Source) -> Self {
        let (p, q) = piece.form.degree;
        let (n, w2) = if source.rational {
            let w = piece.form.map(|c| c.w);
            (rational_hodograph(&piece.form), Some(w.product(&w, |a, b| a * b)))
        } else {
            (hodograph(&piece.form.map(|c| c.truncate())), None)
        };
        let heaviest = piece.form.coefficients.iter().map(|c| c.w).fold(0.0, f64::max);
        let degrees = (p + q) as f64;
        let largest = longest(&n);
        // extraction leaves 5p u of every coefficient, each product and sum a few more; the subtraction of the middle u of
        // the reach
        let error = f64::EPSILON * 16.0 * (degrees + 4.0) * 2.0 * p as f64 * heaviest * heaviest * source.reach;
        let step = f64::EPSILON * (n.degree.0 + n.degree.1) as f64 * largest;
        let mut leaf = Self {
            n,
            w2,
            from: piece.from,
            to: piece.to,
            depth: 0,
            width: piece.to.0 - piece.from.0,
            error,
            step,
            least: Extreme { bound: 0.0, attained: 0.0, at: piece.from },
            greatest: Extreme { bound: 0.0, attained: 0.0, at: piece.from },
            slowest: DVec3::ZERO,
            reserve: 0.0,
            side: Side::First,
        };
        leaf.measure();
        leaf
    }

    fn measure(&mut self) {
        let square = self.n.product(&self.n, |a, b| a.dot(b));
        let degrees = (self.n.degree.0 + self.n.degree.1 + 4) as f64;
        let largest = longest(&self.n);
        let absolute =
            2.0 * self.error * largest + self.error * self.error + 4.0 * degrees * f64::EPSILON * largest * largest;
        let (quotients, loss, relative) = match &self.w2 {
            None => (square, absolute, 0.0),
            Some(w2) => {
                let w4 = w2.product(w2, |a, b| a * b);
                let raised = square.raised(w4.degree.0 - square.degree.0);
                let smallest = w4.coefficients.iter().copied().fold(f64::INFINITY, f64::min);
                let relative = f64::EPSILON * degrees * (8.0 + f64::from(self.depth));
                let c = raised.coefficients.iter().zip(&w4.coefficients).map(|(a, b)| a / b).collect();
                (Form { degree: w4.degree, coefficients: c }, absolute / smallest, relative)
            }
        };
        let (mut low, mut high) = (f64::INFINITY, 0.0_f64);
        for c in &quotients.coefficients {
            (low, high) = (low.min(*c), high.max(*c));
        }
        let speed = |square: f64| square.max(0.0).sqrt() / self.width;
        let bound = (speed((low - loss) * (1.0 - relative)), speed((high + loss) * (1.0 + relative)));
        self.reserve = (speed(low) - bound.0).max(bound.1 - speed(high));
        (self.least.bound, self.greatest.bound) = bound;
        let places = quotients.corners().map(|(k, (s, t))| {
            let at = (if s == 0.0 { self.from.0 } else { self.to.0 }, if t == 0.0 { self.from.1 } else { self.to.1 });
            (speed(quotients.coefficients[k]), at)
        });
        let (mut least, mut greatest) = ((f64::INFINITY, self.from), (-1.0, self.from));
        for (speed, at) in places {
            if speed < least.0 {
                least = (speed, at);
            }
            if speed > greatest.0 {
                greatest = (speed, at);
            }
        }
        (self.least.attained, self.least.at) = least;
        let ends = self.n.corners().map(|(k, _)| self.n.coefficients[k]);
        let slowest = ends.zip(quotients.corners()).min_by(|a, b| {
            let [a, b] = [a.1.0, b.1.0].map(|k| quotients.coefficients[k]);
            a.total_cmp(&b)
        });
        self.slowest = slowest.map_or(DVec3::ZERO, |(n, _)| n.normalize_or_zero());
        (self.greatest.attained, self.greatest.at) = greatest;
        self.side = wider(&quotients);
    }

    /// A lower bound of the speed: that of the shadow on the unit vector `d`.
    fn shadow(&self, d: DVec3) -> f64 {
        let degrees = (self.n.degree.0 + self.n.degree.1 + 4) as f64;
        let loss = self.error + 4.0 * degrees * f64::EPSILON * longest(&self.n);
        let shadow = self.n.map(|c| c.dot(d) - loss);
        let (least, relative) = match &self.w2 {
            None => (shadow.coefficients.iter().copied().fold(f64::INFINITY, f64::min), 8.0),
            Some(w2) => {
                let raised = shadow.raised(w2.degree.0 - shadow.degree.0);
                let quotients = raised.coefficients.iter().zip(&w2.coefficients).map(|(a, b)| a / b);
                (quotients.fold(f64::INFINITY, f64::min), degrees * (8.0 + f64::from(self.depth)))
            }
        };
        // not sooner: a coefficient below 0 counts as it is
        least.max(0.0) * (1.0 - relative * f64::EPSILON) / self.width
    }

    fn halves(self) -> [Self; 2] {
        let side = self.side;
        let (mut to, mut from) = (self.to, self.from);
        match side {
            Side::First => (to.0, from.0) = halfway(self.from.0, self.to.0),
            Side::Second => (to.1, from.1) = halfway(self.from.1, self.to.1),
        }
        let rest = Self { n: empty(), w2: None, depth: self.depth + 1, error: self.error + self.step, ..self };
        let (n, w2) = (self.n.halves(side), self.w2.map(|w2| w2.halves(side)));
        let (low, high) = w2.map_or((None, None), |(low, high)| (Some(low), Some(high)));
        let mut lower = Self { n: n.0, w2: low, to, ..rest.clone() };
        let mut upper = Self { n: n.1, w2: high, from, ..rest };
        lower.measure();
        upper.measure();
        [lower, upper]
    }
}

fn empty() -> Form<DVec3> {
    Form { degree: (0, 0), coefficients: Vec::new() }
}

fn longest(n: &Form<DVec3>) -> f64 {
    n.coefficients.iter().map(|c| c.length_squared()).fold(0.0, f64::max).sqrt()
}

/// The parameter in which neighbouring coefficients differ more.
fn wider(form: &Form<f64>) -> Side {
    let (m, n) = form.degree;
    let (c, columns) = (&form.coefficients, n + 1);
    let down = (0..m * columns).map(|k| (c[k + columns] - c[k]).abs()).fold(0.0, f64::max) * m as f64;
    let along = c.chunks(columns).flat_map(|row| row.windows(2)).map(|w| (w[1] - w[0]).abs()).fold(0.0, f64::max);
    if along * n as f64 > down { Side::Second } else { Side::First }
}

/// The extreme over all leaves. `scale` is a speed that the strip has, where one is known.
fn search(leaves: impl Iterator<Item = Leaf>, goal: Goal, budget: f64, scale: f64) -> Extreme {
    let sign = if goal == Goal::Greatest { 1.0 } else { -1.0 };
    let view = |leaf: &Leaf| if goal == Goal::Greatest { leaf.greatest } else { leaf.least };
    let mut best: Option<Extreme> = None;
    let mut slowest = DVec3::ZERO;
    let note = |best: &mut Option<Extreme>, slowest: &mut DVec3, leaf: &Leaf| {
        let extreme = view(leaf);
        if best.is_none_or(|old| sign * extreme.attained > sign * old.attained) {
            (*best, *slowest) = (Some(extreme), leaf.slowest);
        }
    };
    let mut open = BinaryHeap::new();
    for leaf in leaves {
        note(&mut best, &mut slowest, &leaf);
        open.push(Open { key: sign * view(&leaf).bound, item: leaf });
    }
    let mut splits = 0.0;
    loop {
        let best_now = best.unwrap_or(Extreme { bound: 0.0, attained: 0.0, at: (0.0, 0.0) });
        let Some(Open { item: mut leaf, .. }) = open.pop() else { return best_now };
        if goal == Goal::Least {
            let shadow = leaf.shadow(slowest);
            if shadow > leaf.least.bound {
                leaf.least.bound = shadow;
                if open.peek().is_some_and(|next| next.key > -shadow) {
                    open.push(Open { key: -shadow, item: leaf });
                    continue;
                }
            }
        }
        let bound = view(&leaf).bound;
        let gap = sign * (bound - best_now.attained);
        let scale = scale.max(best_now.attained);
        let done = gap <= TIGHT * scale || leaf.depth >= DEEPEST || leaf.reserve > 0.5 * gap || splits > budget;
        if done {
            // rounding may put the attained value beyond the bound by less than the reserve
            let bound = if gap < 0.0 { best_now.attained - sign * leaf.reserve } else { bound };
            return Extreme { bound, ..best_now };
        }
        splits += 1.0;
        for half in leaf.halves() {
            note(&mut best, &mut slowest, &half);
            open.push(Open { key: sign * view(&half).bound, item: half });
        }
    }
}

/// Where halving would cost too much: `|n| <= 2 p w_max² r` about a point with all others within `r`, and a speed at a corner.
fn rough(source: &Source, pieces: Vec<Piece>) -> Range {
    let (from, to) = pieces.first().map_or((0.0, 0.0), |piece| (piece.from.0, piece.to.0));
    let p = source.degree().0 as f64;
    let mut range = Range {
        from,
        to,
        least: Extreme { bound: 0.0, attained: f64::INFINITY, at: (from, 0.0) },
        greatest: Extreme { bound: 0.0, attained: -1.0, at: (from, 0.0) },
    };
    for piece in pieces {
        let points: Vec<DVec3> = piece.points().collect();
        let weights = || piece.form.coefficients.iter().map(|c| c.w);
        let ratio = weights().fold(0.0, f64::max) / weights().fold(f64::INFINITY, f64::min);
        let radius = points.iter().map(|x| x.distance(points[0])).fold(0.0, f64::max);
        let width = piece.to.0 - piece.from.0;
        let reserve = 64.0 * (p + 4.0) * f64::EPSILON * source.reach;
        range.greatest.bound = range.greatest.bound.max(2.0 * p * ratio * ratio * (radius + reserve) / width);
        let below = piece.form.degree.1 + 1;
        let ends = piece.form.coefficients[below].w / piece.form.coefficients[0].w;
        let speed = p * ends * points[below].distance(points[0]) / width;
        if speed < range.least.attained {
            (range.least.attained, range.least.at) = (speed, piece.from);
        }
        if speed > range.greatest.attained {
            (range.greatest.attained, range.greatest.at) = (speed, piece.from);
        }
    }
    range
}

#[cfg(test)]
mod tests {
    use super::*;
    use perpend_kernel::{Definition, NurbsCurve};

    fn curve(degree: usize, points: &[[f64; 3]]) -> Definition {
        let mut knots = vec![0.0; degree + 1];
        knots.extend(vec![1.0; degree + 1]);
        let points = points.iter().map(|p| DVec3::from_array(*p)).collect();
        NurbsCurve::new(degree, knots, points, None).expect("valid").into()
    }

    #[test]
    fn a_parabola_has_its_least_speed_at_its_top() {
        let range = ranges(&Source::of(&curve(2, &[[0.0, 0.0, 0.0], [1.0, 2.0, 0.0], [2.0, 0.0, 0.0]])), 1e9)[0];
        assert!((range.least.bound - 2.0).abs() < 1e-8 && range.least.bound <= 2.0, "{range:?}");
        assert!((range.least.at.0 - 0.5).abs() < 1e-4);
        assert!((range.greatest.bound - 20.0_f64.sqrt()).abs() < 1e-8 && range.greatest.bound >= 20.0_f64.sqrt());
    }

    #[test]
    fn a_cusp_is_slow_to_rounding() {
        let points = [[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]];
        let range = ranges(&Source::of(&curve(3, &points)), 1e9)[0];
        assert!(range.least.attained < 1e-9 && range.least.bound == 0.0, "{range:?}");
        assert!((range.least.at.0 - 0.5).abs() < 1e-9);
    }
}
