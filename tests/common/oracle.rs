//! The oracle: the nearest point by branch and bound on Bézier nets, without any of the solver's ideas.
//!
//! A region of the entity is a Bézier net seen from the query point. It lies in the convex hull of its control points, so for
//! every unit vector `n` no point of it is nearer than the least `P_ij · n`: a plane that separates the hull from the query
//! point. The vector is taken from the region's own nearest point (projected Newton), then bettered by Gilbert's iteration
//! (1966). Regions are split in halves, the most promising first, until none can better the best point by more than 1e-13 of
//! the size; so two rivals are told apart unless they are nearer to a tie than that. Nothing is
//! squared, no form is subtracted, no proof of convexity is tried.
//!
//! What is reported is the distance of a real point of the entity, evaluated to 30 digits: an upper bound of the true
//! distance, whatever went wrong before. That convicts a false lower bound without trust in the search.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use glam::{DVec3, DVec4};

use super::double_double::Dd;
use super::shape::{Form, Quotients, Shape};

pub struct Oracle {
    pub shape: Shape,
    pub size: f64,
    centre: DVec3,
    pieces: Vec<Piece>,
}

/// A Bézier piece about the entity's centre.
struct Piece {
    net: Vec<DVec4>,
    low: DVec3,
    high: DVec3,
    /// First and last parameter, in u and v.
    from: [f64; 2],
    to: [f64; 2],
}

/// The oracle's answer.
#[derive(Debug, Clone, Copy)]
pub struct Nearest {
    /// The distance of the point at `parameter`, to the last digit.
    pub distance: f64,
    pub parameter: [Dd; 2],
    /// How many regions were split.
    pub splits: usize,
    /// Whether the search ended by its rule and not by its bound on the work.
    pub settled: bool,
}

/// The share of the size to which the search goes.
pub const TOLERANCE: f64 = 1e-13;

/// The most regions that one search splits: at the centre of a sphere every region is as good as any other.
const MOST_SPLITS: usize = 6_000;

/// So many splits without any gain end a search too.
const MOST_SPLITS_IN_VAIN: usize = 1_500;

impl Oracle {
    pub fn new(shape: Shape) -> Self {
        let [low, high] = shape.bounds();
        let centre = (low + high) / 2.0;
        let pieces = pieces(&shape, centre);
        Self { size: shape.size(), shape, centre, pieces }
    }

    /// The nearest point of the entity to `p`.
    pub fn nearest(&self, p: DVec3) -> Nearest {
        Search::new(self, p).run(p)
    }
}

/// The Bézier pieces of `shape` (knot insertion as a blossom, to 30 digits, then rounded).
fn pieces(shape: &Shape, centre: DVec3) -> Vec<Piece> {
    let [p, q] = shape.degree;
    let form = shape.form(centre);
    let heaviest = (0..shape.points.len()).map(|i| shape.weight(i)).fold(0.0, f64::max);
    let mut pieces = Vec::new();
    for i in shape.spans(0) {
        let across = corners(&shape.knots[0], p, i);
        for j in shape.spans(1) {
            let along = corners(&shape.knots[1], q, j);
            // rows first: (p + 1) old rows by (q + 1) new columns
            let row = |r: usize| -> Vec<Form> {
                let old: Vec<Form> = (j - q..=j).map(|c| form[(i - p + r) * shape.columns + c]).collect();
                along.iter().map(|quotients| quotients.blossom(&mut old.clone())).collect()
            };
            let rows: Vec<Vec<Form>> = (0..=p).map(row).collect();
            let mut net = Vec::with_capacity((p + 1) * (q + 1));
            for quotients in &across {
                for c in 0..=q {
                    let mut column: Vec<Form> = rows.iter().map(|row| row[c]).collect();
                    let h = quotients.blossom(&mut column).map(|x| (x / Dd::from(heaviest)).value());
                    net.push(DVec4::from_array(h));
                }
            }
            let (low, high) = bounds(&net);
            let [u, v] = [&shape.knots[0][i..], &shape.knots[1][j..]];
            pieces.push(Piece { net, low, high, from: [u[0], v[0]], to: [u[1], v[1]] });
        }
    }
    pieces
}

/// The blossoms that give the Bézier points of the span at `knots[span]`: `degree - m` times its start, `m` times its end.
fn corners(knots: &[f64], degree: usize, span: usize) -> Vec<Quotients> {
    let [start, end] = [knots[span], knots[span + 1]].map(Dd::from);
    (0..=degree)
        .map(|m| {
            let mut arguments = vec![start; degree - m];
            arguments.extend(vec![end; m]);
            Quotients::new(knots, degree, span, &arguments)
        })
        .collect()
}

fn bounds(net: &[DVec4]) -> (DVec3, DVec3) {
    let start = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    net.iter().map(|h| h.truncate() / h.w).fold(start, |(low, high), p| (low.min(p), high.max(p)))
}

/// A part of a piece, with its net seen from the query point.
struct Region {
    /// No point of it is nearer.
    bound: f64,
    piece: usize,
    /// Where its net begins in the arena; none: the whole piece, not yet opened.
    net: Option<usize>,
    /// Its part of the piece, as shares of the spans.
    from: [f64; 2],
    width: [f64; 2],
}

impl PartialEq for Region {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Region {}

impl PartialOrd for Region {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Region {
    /// The heap's greatest is the region with the least bound.
    fn cmp(&self, other: &Self) -> Ordering {
        other.bound.total_cmp(&self.bound)
    }
}

#[derive(Clone, Copy)]
struct Best {
    distance: f64,
    piece: usize,
    /// Shares of the piece's spans.
    at: [f64; 2],
}

struct Search<'a> {
    oracle: &'a Oracle,
    /// The query point from the entity's centre.
    point: DVec3,
    best: Best,
    /// Regions that cannot better the best by this much are dropped.
    tolerance: f64,
    arena: Vec<DVec4>,
    heap: BinaryHeap<Region>,
    hull: Vec<DVec3>,
    splits: usize,
    last_gain: usize,
}

impl<'a> Search<'a> {
    fn new(oracle: &'a Oracle, p: DVec3) -> Self {
        let best = Best { distance: f64::INFINITY, piece: 0, at: [0.0; 2] };
        let point = p - oracle.centre;
        let tolerance = TOLERANCE * oracle.size + 1e-15 * point.length();
        let (arena, heap, hull) = (Vec::new(), BinaryHeap::new(), Vec::new());
        Self { oracle, point, best, tolerance, arena, heap, hull, splits: 0, last_gain: 0 }
    }

    fn run(mut self, p: DVec3) -> Nearest {
        self.start();
        let mut settled = true;
        while let Some(region) = self.heap.pop() {
            if region.bound >= self.best.distance - self.tolerance {
                break;
            }
            if self.splits >= MOST_SPLITS.min(self.last_gain + MOST_SPLITS_IN_VAIN) {
                settled = false;
                break;
            }
            match region.net {
                None => self.open(region),
                Some(net) => self.split(&region, net),
            }
        }
        let parameter = self.parameter();
        let distance = self.oracle.shape.distance_at(p, parameter[0], parameter[1]);
        Nearest { distance, parameter, splits: self.splits, settled }
    }

    /// The best parameter, to 30 digits: a narrow span far from 0 has few f64 of its own.
    fn parameter(&self) -> [Dd; 2] {
        let piece = &self.oracle.pieces[self.best.piece];
        [0, 1].map(|k| {
            let (from, width) = (Dd::from(piece.from[k]), Dd::difference(piece.to[k], piece.from[k]));
            from + width * Dd::from(self.best.at[k])
        })
    }

    /// Every piece by its box, and the nearest of their corners for a first guess.
    fn start(&mut self) {
        let q = self.oracle.shape.degree[1];
        for (index, piece) in self.oracle.pieces.iter().enumerate() {
            let last = piece.net.len() - 1;
            for (corner, at) in [(0, [0.0, 0.0]), (q, [0.0, 1.0]), (last - q, [1.0, 0.0]), (last, [1.0, 1.0])] {
                let h = piece.net[corner];
                let distance = (h.truncate() / h.w - self.point).length();
                if distance < self.best.distance {
                    self.best = Best { distance, piece: index, at };
                }
            }
        }
        for (index, piece) in self.oracle.pieces.iter().enumerate() {
            let outside = (piece.low - self.point).max(self.point - piece.high).max(DVec3::ZERO);
            let bound = outside.length();
            if bound < self.best.distance {
                self.heap.push(Region { bound, piece: index, net: None, from: [0.0; 2], width: [1.0; 2] });
            }
        }
    }

    fn open(&mut self, region: Region) {
        let net = self.arena.len();
        for h in &self.oracle.pieces[region.piece].net {
            self.arena.push((h.truncate() - h.w * self.point).extend(h.w));
        }
        self.look(Region { net: Some(net), ..region }, net);
    }

    fn split(&mut self, region: &Region, net: usize) {
        self.splits += 1;
        let [rows, columns] = self.oracle.shape.degree.map(|d| d + 1);
        let along = usize::from(self.is_longer_along_v(net));
        let (first, second) = (self.arena.len(), self.arena.len() + rows * columns);
        self.arena.extend_from_within(net..net + rows * columns);
        self.arena.extend_from_within(net..net + rows * columns);
        // the line of the net that starts at `start` with the given stride: halves by de Casteljau, in place in the second
        let (lines, length, line_step, step) =
            if along == 0 { (columns, rows, 1, columns) } else { (rows, columns, columns, 1) };
        for line in 0..lines {
            let start = line * line_step;
            for level in 0..length {
                self.arena[first + start + level * step] = self.arena[second + start];
                for k in 0..length - 1 - level {
                    let (a, b) = (second + start + k * step, second + start + (k + 1) * step);
                    self.arena[a] = 0.5 * (self.arena[a] + self.arena[b]);
                }
            }
        }
        let mut width = region.width;
        width[along] *= 0.5;
        for (net, offset) in [(first, 0.0), (second, width[along])] {
            let mut from = region.from;
            from[along] += offset;
            self.look(Region { bound: region.bound, piece: region.piece, net: Some(net), from, width }, net);
        }
    }

    /// Whether the net's columns are longer than its rows, by control polygon.
    fn is_longer_along_v(&self, net: usize) -> bool {
        let [rows, columns] = self.oracle.shape.degree.map(|d| d + 1);
        let at = |i: usize, j: usize| {
            let h = self.arena[net + i * columns + j];
            h.truncate() / h.w
        };
        let mut longest = [0.0_f64; 2];
        for i in 0..rows {
            longest[1] = longest[1].max((1..columns).map(|j| (at(i, j) - at(i, j - 1)).length()).sum());
        }
        for j in 0..columns {
            longest[0] = longest[0].max((1..rows).map(|i| (at(i, j) - at(i - 1, j)).length()).sum());
        }
        longest[1] > longest[0]
    }

    /// Looks for a better point in a region, bounds it, and keeps it where it may hold a better one still.
    fn look(&mut self, mut region: Region, net: usize) {
        let towards = self.polish(&region, net);
        let enough = self.best.distance - self.tolerance;
        region.bound = region.bound.max(self.hull_bound(net, towards, enough));
        if region.bound < enough {
            self.heap.push(region);
        }
    }

    /// A lower bound of the distance from the origin to the hull of a net; `towards` is a first guess of its nearest point.
    fn hull_bound(&mut self, net: usize, towards: DVec3, enough: f64) -> f64 {
        let count = self.oracle.pieces[0].net.len();
        self.hull.clear();
        self.hull.extend(self.arena[net..net + count].iter().map(|h| h.truncate() / h.w));
        let (mut x, mut bound) = (towards, 0.0_f64);
        for _ in 0..6 {
            let length = x.length();
            if length == 0.0 {
                return bound;
            }
            let (mut least, mut support) = (f64::INFINITY, DVec3::ZERO);
            for p in &self.hull {
                let along = p.dot(x);
                if along < least {
                    (least, support) = (along, *p);
                }
            }
            bound = bound.max(least / length);
            if bound >= enough || length - bound <= 0.1 * self.tolerance {
                return bound;
            }
            // the point of the segment from x to the support that is nearest to the origin
            let step = support - x;
            let towards = -x.dot(step);
            if towards <= 0.0 {
                return bound;
            }
            x += (towards / step.length_squared()).min(1.0) * step;
        }
        bound
    }

    /// Projected Newton in a region from its nearest control point; goes on only while it promises a new best point. Returns the
    /// nearest point met, seen from the query point.
    fn polish(&mut self, region: &Region, net: usize) -> DVec3 {
        let degree = self.oracle.shape.degree;
        let count = self.oracle.pieces[0].net.len();
        let net = net..net + count;
        let nearest = self.arena[net.clone()].iter().map(|h| h.truncate().length_squared() / (h.w * h.w));
        let start = nearest.enumerate().min_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(index, _)| index);
        let share = |i: usize, degree: usize| if degree == 0 { 0.0 } else { i as f64 / degree as f64 };
        let mut at = [share(start / (degree[1] + 1), degree[0]), share(start % (degree[1] + 1), degree[1])];
        let mut jet = Jet::new(&self.arena[net.clone()], degree, at);
        for step in 0..60 {
            let value = jet.r.length_squared();
            if value.sqrt() < self.best.distance {
                if value.sqrt() < self.best.distance - 0.01 * self.tolerance {
                    self.last_gain = self.splits;
                }
                let inside = [0, 1].map(|k| region.from[k] + region.width[k] * at[k]);
                self.best = Best { distance: value.sqrt(), piece: region.piece, at: inside };
            }
            let (mut direction, promise) = jet.step(at);
            let hopeless = step >= 2 && value - 4.0 * promise > self.best.distance * self.best.distance;
            if promise <= 1e-17 * self.oracle.size * value.sqrt() || hopeless {
                break;
            }
            // halve until it is better
            let mut moved = None;
            for _ in 0..12 {
                let next = [0, 1].map(|k| (at[k] + direction[k]).clamp(0.0, 1.0));
                let there = Jet::new(&self.arena[net.clone()], degree, next);
                if there.r.length_squared() < value {
                    moved = Some((next, there));
                    break;
                }
                direction = direction.map(|d| 0.5 * d);
            }
            match moved {
                Some((next, there)) => (at, jet) = (next, there),
                None => break,
            }
        }
        jet.r
    }
}

/// The vector from the query point to a point of a region, with its derivatives.
struct Jet {
    r: DVec3,
    u: DVec3,
    v: DVec3,
    uu: DVec3,
    uv: DVec3,
    vv: DVec3,
}

/// Room for the points of one line of a net.
type Line = [DVec4; 26];

impl Jet {
    fn new(net: &[DVec4], [p, q]: [usize; 2], at: [f64; 2]) -> Self {
        let mut across = [[DVec4::ZERO; 26]; 3];
        let mut line: Line = [DVec4::ZERO; 26];
        for (i, row) in net.chunks(q + 1).enumerate() {
            line[..=q].copy_from_slice(row);
            let [value, first, second] = line_jet(&mut line, q, at[1]);
            (across[0][i], across[1][i], across[2][i]) = (value, first, second);
        }
        let [[s, su, suu], [sv, suv, _], [svv, _, _]] = across.each_mut().map(|line| line_jet(line, p, at[0]));
        let [w, wu, wv] = [s.w, su.w, sv.w];
        let r = s.truncate() / w;
        let u = (su.truncate() - wu * r) / w;
        let v = (sv.truncate() - wv * r) / w;
        let uu = (suu.truncate() - 2.0 * wu * u - suu.w * r) / w;
        let uv = (suv.truncate() - wu * v - wv * u - suv.w * r) / w;
        let vv = (svv.truncate() - 2.0 * wv * v - svv.w * r) / w;
        Self { r, u, v, uu, uv, vv }
    }

    /// A step that lessens |r|² inside the unit box, and the decrease that it promises.
    fn step(&self, at: [f64; 2]) -> ([f64; 2], f64) {
        let gradient = [self.r.dot(self.u), self.r.dot(self.v)];
        let free = [0, 1].map(|k| {
            let outward = (at[k] <= 0.0 && gradient[k] >= 0.0) || (at[k] >= 1.0 && gradient[k] <= 0.0);
            gradient[k] != 0.0 && !outward
        });
        let [a, b, c] = [
            self.u.length_squared() + self.r.dot(self.uu),
            self.u.dot(self.v) + self.r.dot(self.uv),
            self.v.length_squared() + self.r.dot(self.vv),
        ];
        let alone = |k: usize| {
            let (newton, squared) = if k == 0 { (a, self.u.length_squared()) } else { (c, self.v.length_squared()) };
            if newton > 0.0 {
                -gradient[k] / newton
            } else if squared > 0.0 {
                -gradient[k] / squared
            } else {
                -gradient[k].signum()
            }
        };
        let determinant = a * c - b * b;
        let step = match free {
            [true, true] if a > 0.0 && determinant > 1e-14 * a * c => {
                [(b * gradient[1] - c * gradient[0]) / determinant, (b * gradient[0] - a * gradient[1]) / determinant]
            }
            [u, v] => [if u { alone(0) } else { 0.0 }, if v { alone(1) } else { 0.0 }],
        };
        let limited = [0, 1].map(|k| (at[k] + step[k]).clamp(0.0, 1.0) - at[k]);
        // |r|² falls by about half the product of its gradient and a Newton step
        (step, -(gradient[0] * limited[0] + gradient[1] * limited[1]))
    }
}

/// Value, first and second derivative of a Bézier line at `t`, by de Casteljau's algorithm; the line is overwritten.
fn line_jet(line: &mut Line, degree: usize, t: f64) -> [DVec4; 3] {
    let level = |line: &mut Line, top: usize| {
        for k in 0..top {
            line[k] = (1.0 - t) * line[k] + t * line[k + 1];
        }
    };
    let n = degree as f64;
    for top in (3..=degree).rev() {
        level(line, top);
    }
    let second = if degree >= 2 { n * (n - 1.0) * (line[2] - 2.0 * line[1] + line[0]) } else { DVec4::ZERO };
    if degree >= 2 {
        level(line, 2);
    }
    let first = if degree >= 1 { n * (line[1] - line[0]) } else { DVec4::ZERO };
    if degree >= 1 {
        level(line, 1);
    }
    [line[0], first, second]
}
