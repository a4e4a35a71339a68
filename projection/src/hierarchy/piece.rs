//! Bézier pieces in an entity's own coordinates, and when to split them before any query.

use glam::{DVec2, DVec3, DVec4};
use perpend_kernel::bezier::{curve_pieces, surface_pieces};
use perpend_kernel::{Definition, Direction, cartesian};

/// A homogeneous Bézier piece of degree `(p, q)` over a box of the definition's parameters; a curve has `q = 0`.
#[derive(Debug, Clone)]
pub(super) struct Piece {
    pub degree: (usize, usize),
    /// `(p + 1)(q + 1)` points in row order.
    pub net: Vec<DVec4>,
    /// Whether its weights count; else they are 1, but for rounding.
    pub rational: bool,
    pub u: (f64, f64),
    pub v: (f64, f64),
}

/// The lines of a net in one direction: point `k` of line `l` is the net's `l across + k step`.
struct Lines {
    lines: usize,
    degree: usize,
    step: usize,
    across: usize,
}

impl Piece {
    /// The pieces of a definition whose homogeneous net in some coordinates is `net`, split at every knot.
    pub(super) fn all(definition: &Definition, net: &[DVec4], rational: bool) -> Vec<Self> {
        match definition {
            Definition::NurbsCurve(curve) => curve_pieces(curve.knots(), net)
                .into_iter()
                .map(|piece| Self {
                    degree: (curve.degree(), 0),
                    net: piece.points,
                    rational,
                    u: (piece.span.start, piece.span.end),
                    v: (0.0, 0.0),
                })
                .collect(),
            Definition::NurbsSurface(surface) => {
                surface_pieces(surface.knots(Direction::U), surface.knots(Direction::V), net)
                    .into_iter()
                    .map(|piece| Self {
                        degree: piece.degree,
                        net: piece.points,
                        rational,
                        u: (piece.spans.0.start, piece.spans.0.end),
                        v: (piece.spans.1.start, piece.spans.1.end),
                    })
                    .collect()
            }
        }
    }

    /// A curve over a range of parameters. Where its weights are one but for rounding they are taken as such.
    pub(super) fn curve(mut net: Vec<DVec4>, u: (f64, f64)) -> Self {
        let weight = net[0].w;
        let rational = net.iter().any(|h| (h.w - weight).abs() > 1e-13 * weight);
        if !rational {
            net.iter_mut().for_each(|h| *h = (h.truncate() / h.w).extend(1.0));
        }
        Self { degree: (net.len() - 1, 0), net, rational, u, v: (0.0, 0.0) }
    }

    /// Its control points, in place of what `points` held.
    pub(super) fn write_points(&self, points: &mut Vec<DVec3>) {
        points.clear();
        if self.rational {
            points.extend(self.net.iter().map(|h| cartesian(*h)));
        } else {
            points.extend(self.net.iter().map(|h| h.truncate()));
        }
    }

    /// Both halves in a direction, by de Casteljau: halving is exact, one rounding a level.
    pub(super) fn halves(self, direction: Direction) -> [Self; 2] {
        let Lines { lines, degree, step, across } = self.lines(direction);
        let (mut low, mut high) = (self.clone(), self);
        for line in 0..lines {
            let at = |k: usize| line * across + k * step;
            let work = &mut low.net;
            high.net[at(degree)] = work[at(degree)];
            for k in 1..=degree {
                for i in (k..=degree).rev() {
                    work[at(i)] = 0.5 * (work[at(i - 1)] + work[at(i)]);
                }
                high.net[at(degree - k)] = work[at(degree)];
            }
        }
        let at = middle(low.range(direction));
        (low.range_mut(direction).1, high.range_mut(direction).0) = (at, at);
        [low, high]
    }

    /// The two parts before and after a parameter in a direction; the piece itself where it does not hold the parameter inside.
    pub(super) fn cut(self, direction: Direction, at: f64) -> Vec<Self> {
        let (from, to) = self.range(direction);
        if at <= from || at >= to {
            return vec![self];
        }
        // two quotients: the ratio of weights keeps its relative accuracy
        let (after, before) = ((at - from) / (to - from), (to - at) / (to - from));
        let Lines { lines, degree, step, across } = self.lines(direction);
        let (mut low, mut high) = (self.clone(), self);
        for line in 0..lines {
            let index = |k: usize| line * across + k * step;
            for k in 1..=degree {
                for i in (k..=degree).rev() {
                    low.net[index(i)] = before * low.net[index(i - 1)] + after * low.net[index(i)];
                }
                high.net[index(degree - k)] = low.net[index(degree)];
            }
        }
        (low.range_mut(direction).1, high.range_mut(direction).0) = (at, at);
        vec![low, high]
    }

    fn lines(&self, direction: Direction) -> Lines {
        let (p, q) = self.degree;
        match direction {
            Direction::U => Lines { lines: q + 1, degree: p, step: q + 1, across: 1 },
            Direction::V => Lines { lines: p + 1, degree: q, step: 1, across: q + 1 },
        }
    }

    fn range(&self, direction: Direction) -> (f64, f64) {
        match direction {
            Direction::U => self.u,
            Direction::V => self.v,
        }
    }

    fn range_mut(&mut self, direction: Direction) -> &mut (f64, f64) {
        match direction {
            Direction::U => &mut self.u,
            Direction::V => &mut self.v,
        }
    }

    /// The part of a surface's piece within a box of parameters; none where they have no area in common.
    pub(super) fn within(mut self, min: DVec2, max: DVec2) -> Option<Self> {
        for (axis, direction) in [Direction::U, Direction::V].into_iter().enumerate() {
            let (from, to) = self.range(direction);
            if to <= min[axis] || from >= max[axis] {
                return None;
            }
            self = self.cut(direction, max[axis]).swap_remove(0);
            self = self.cut(direction, min[axis]).pop()?;
        }
        Some(self)
    }

    /// The direction in which the control net is longer.
    pub(super) fn longer(&self) -> Direction {
        let (p, q) = self.degree;
        let mut points = Vec::with_capacity(self.net.len());
        self.write_points(&mut points);
        let point = |i: usize, j: usize| points[i * (q + 1) + j];
        let along_u = |j: usize| (1..=p).map(|i| point(i, j).distance(point(i - 1, j))).sum::<f64>();
        let along_v = |i: usize| (1..=q).map(|j| point(i, j).distance(point(i, j - 1))).sum::<f64>();
        let longest = |lengths: &mut dyn Iterator<Item = f64>| lengths.fold(0.0, f64::max);
        let u = longest(&mut (0..=q).map(along_u));
        let v = longest(&mut (0..=p).map(along_v));
        if q == 0 || u >= v { Direction::U } else { Direction::V }
    }

    /// The direction to split in before queries, if any.
    ///
    /// A piece is split while it departs too far from an affine map: while `(n - 1) max|second difference| / max|first
    /// difference|` of the net exceeds 0.7 on a curve and 0.8 times the sine of the angle between the directions on a surface, or while its weights
    /// are more than 16 apart. Measured: a query to the curves of the test sets takes 0.431 µs with 0.7 and 0.453 µs with 1; on surfaces half and
    /// twice cost 5 to 25 % more when every leaf was proved by its form, and skew hurt most. `points` is working memory.
    pub(super) fn wants_split(&self, points: &mut Vec<DVec3>) -> Option<Direction> {
        let (p, q) = self.degree;
        self.write_points(points);
        let [mut bend_u, mut bend_v] = bends(points, self.degree);
        if let Some(direction) = self.uneven() {
            *(if direction == Direction::U { &mut bend_u } else { &mut bend_v }) += 1.0;
        }
        let corner = |i: usize, j: usize| points[i * (q + 1) + j];
        let threshold =
            if q == 0 { 0.7 } else { 0.8 * sine_of_skew([corner(0, 0), corner(p, 0), corner(0, q), corner(p, q)]) };
        let largest = bend_u.max(bend_v);
        (largest > threshold).then_some(if bend_u >= bend_v { Direction::U } else { Direction::V })
    }

    /// The direction in which neighbouring weights differ most, where they are more than 16 apart in all.
    fn uneven(&self) -> Option<Direction> {
        let (p, q) = self.degree;
        let (lightest, heaviest) = self.net.iter().fold((f64::MAX, 0.0_f64), |(a, b), h| (a.min(h.w), b.max(h.w)));
        if !self.rational || heaviest <= 16.0 * lightest {
            return None;
        }
        let weight = |i: usize, j: usize| self.net[i * (q + 1) + j].w;
        let ratio = |a: f64, b: f64| (a / b).max(b / a);
        let (mut u, mut v) = (0.0_f64, 0.0_f64);
        for i in 0..=p {
            for j in 0..=q {
                if i < p {
                    u = u.max(ratio(weight(i, j), weight(i + 1, j)));
                }
                if j < q {
                    v = v.max(ratio(weight(i, j), weight(i, j + 1)));
                }
            }
        }
        Some(if u >= v { Direction::U } else { Direction::V })
    }
}

/// How much control points in row order depart from an affine map in u and in v: `(n - 1) max|second difference| / max|first difference|`.
fn bends(points: &[DVec3], (p, q): (usize, usize)) -> [f64; 2] {
    let width = q + 1;
    let (mut u, mut v) = (Bend::default(), Bend::default());
    for i in 0..=p {
        let row = &points[i * width..(i + 1) * width];
        v.add(row, &row[1..], row.get(2..).unwrap_or_default());
        if i < p {
            let below = |k: usize| points.get((i + k) * width..(i + k + 1) * width).unwrap_or_default();
            u.add(row, below(1), below(2));
        }
    }
    let (length_u, length_v) = (u.first.sqrt() * p as f64, v.first.sqrt() * q as f64);
    // a direction that is a thousand times shorter than the other cannot bend the piece
    let shortest = 1e-3 * length_u.max(length_v);
    [if length_u < shortest { 0.0 } else { u.measure(p) }, if length_v < shortest { 0.0 } else { v.measure(q) }]
}

/// Sine of the angle between the mean u and the mean v direction of a net with these corners, at least 0.14.
fn sine_of_skew([a, b, c, d]: [DVec3; 4]) -> f64 {
    let (du, dv) = (b - a + d - c, c - a + d - b);
    let lengths = du.length_squared() * dv.length_squared();
    if lengths > 0.0 { (1.0 - du.dot(dv).powi(2) / lengths).max(0.02).sqrt() } else { 1.0 }
}

/// How much a net bends in one direction: squares of its largest first and second differences.
#[derive(Default)]
struct Bend {
    first: f64,
    second: f64,
}

impl Bend {
    /// Takes points, the ones after each and the ones after these, where there are any.
    #[inline(always)]
    fn add(&mut self, here: &[DVec3], next: &[DVec3], second: &[DVec3]) {
        let greater = |a: f64, b: f64| if a > b { a } else { b };
        for (a, b) in here.iter().zip(next) {
            self.first = greater((*b - *a).length_squared(), self.first);
        }
        for ((a, b), c) in here.iter().zip(next).zip(second) {
            self.second = greater((*c - 2.0 * *b + *a).length_squared(), self.second);
        }
    }

    fn measure(&self, degree: usize) -> f64 {
        if degree < 2 || self.first == 0.0 { 0.0 } else { (degree - 1) as f64 * (self.second / self.first).sqrt() }
    }
}

pub(super) fn middle((a, b): (f64, f64)) -> f64 {
    // halves first would underflow for tiny parameters, the sum cannot overflow: knots stay within 1e100 of one another
    a + 0.5 * (b - a)
}

#[cfg(test)]
mod tests {
    use super::super::double_double::{DoubleDouble, Random};
    use super::super::frame::Frame;
    use super::*;
    use perpend_kernel::NurbsCurve;

    type Exact = [DoubleDouble; 4];

    /// Bézier point `m` of a span by de Boor's algorithm in double-double, from the definition's own numbers.
    fn exact_point(curve: &NurbsCurve, frame: &Frame, span: usize, m: usize) -> [f64; 3] {
        let (p, t) = (curve.degree(), curve.knots().as_slice());
        let number = DoubleDouble::from;
        let mut d: Vec<Exact> = (span - p..=span)
            .map(|i| {
                let w = number(curve.weights().map_or(1.0, |w| w[i]));
                let local =
                    |k: usize| (number(curve.control_points()[i][k]) - number(frame.origin[k])) * number(frame.scale);
                [local(0) * w, local(1) * w, local(2) * w, w]
            })
            .collect();
        for r in 1..=p {
            let argument = number(if r <= p - m { t[span] } else { t[span + 1] });
            for j in (r..=p).rev() {
                let (a, b) = (number(t[span - p + j]), number(t[span + 1 + j - r]));
                let (after, before) = ((argument - a) / (b - a), (b - argument) / (b - a));
                let below = d[j - 1];
                for (x, y) in d[j].iter_mut().zip(below) {
                    *x = before * y + after * *x;
                }
            }
        }
        [0, 1, 2].map(|k| (d[p][k] / d[p][3]).to_f64())
    }

    /// The pieces lie within the reserve of the definition, also where weights are 1e6 apart and knots crowd: a tenth of a
    /// billionth of the domain from an end, or from one another.
    #[test]
    fn pieces_lie_within_the_reserve_of_the_definition() {
        let mut random = Random(5);
        let mut worst = 0.0_f64;
        for round in 0..300 {
            let degree = [1, 2, 3, 5, 9, 25][round % 6];
            let n = degree + 4;
            let crowd = 10.0_f64.powf(random.between(-10.0, -1.0));
            let inner = [vec![crowd, 0.5, 0.5 + crowd], vec![0.3, 1.0 - crowd, 1.0 - 0.5 * crowd]][round % 2].clone();
            let mut knots = vec![0.0; degree + 1];
            knots.extend(inner);
            knots.extend(std::iter::repeat_n(1.0, degree + 1));
            let far = if round % 5 == 0 { 1e7 } else { 0.0 };
            let points = (0..n).map(|_| DVec3::splat(far) + random.point()).collect();
            let weights = (0..n).map(|_| 10.0_f64.powf(random.between(-3.0, 3.0))).collect();
            let curve = NurbsCurve::new(degree, knots, points, Some(weights)).expect("valid");
            let definition = Definition::from(curve.clone());
            let frame = Frame::of(&definition);
            let (net, _) = frame.net(&definition);
            let reach = net.iter().fold(0.0_f64, |r, h| r.max(cartesian(*h).length()));
            let reserve = Frame::reserve((degree, 0), reach);
            for (piece, span) in Piece::all(&definition, &net, true).iter().zip(curve.knots().spans()) {
                for (m, point) in piece.net.iter().enumerate() {
                    let exact = DVec3::from_array(exact_point(&curve, &frame, span.index, m));
                    worst = worst.max(cartesian(*point).distance(exact) / reserve);
                }
            }
        }
        assert!(worst < 0.2, "pieces moved by {worst} of the reserve; halvings and new origins need their share too");
        assert!(worst > 1e-3, "the reserve could be a thousand times smaller: {worst}");
    }
}
