//! A leaf of the hierarchy: a Bézier piece about its own origin, with its boxes.
//!
//! Its ranges and the tables of its form are made when a query first asks for each: most leaves of a large entity are never looked at, and the ranges
//! prove most of the others.

use std::sync::OnceLock;

use fearless_simd::Level;
use glam::{DVec3, DVec4};
use perpend_kernel::{Aabb, Direction, cartesian};

use super::form::{self, Shape};
use super::frame::power_of_two_below;
use super::jet::Jet;
use super::oriented_box::OrientedBox;
use super::piece::Piece;
use super::ranges::{Ranges, Slopes};

/// A piece ready for queries. All coordinates are the entity's own, and `net` is relative to `origin`.
#[derive(Debug)]
pub(super) struct Leaf {
    pub degree: (usize, usize),
    pub rational: bool,
    /// What the processor can do: changes times, and no bit.
    pub level: Level,
    /// Homogeneous control points about `origin`, weights scaled so that the largest lies in `[1, 2)`.
    pub net: Vec<DVec4>,
    /// Middle of the box.
    pub origin: DVec3,
    /// Largest distance of a control point from `origin`.
    pub radius: f64,
    /// Largest and smallest weight.
    pub heaviest: f64,
    pub lightest: f64,
    /// The definition's parameters that the leaf covers.
    pub u: (f64, f64),
    pub v: (f64, f64),
    pub bounds: Aabb,
    oriented: OrientedBox,
    /// Made by the first glance at the leaf.
    ranges: OnceLock<Box<Ranges>>,
    /// Made by the first proof that needs the form.
    tables: OnceLock<Box<[f64]>>,
    /// The middle point and the pseudo-inverse of the derivatives there: a linear guess of the foot.
    middle: DVec3,
    inverse: [DVec3; 2],
}

impl Leaf {
    /// `points` is working memory.
    pub(super) fn new(piece: Piece, level: Level, points: &mut Vec<DVec3>) -> Self {
        piece.write_points(points);
        let Piece { degree, mut net, rational, u, v } = piece;
        let (p, q) = degree;
        let bounds = Aabb::around(points.iter().copied());
        let origin = bounds.centre();
        let (mut lightest, mut heaviest) = (1.0, 1.0);
        if rational {
            (lightest, heaviest) = net.iter().fold((f64::MAX, 0.0_f64), |(a, b), h| (a.min(h.w), b.max(h.w)));
            let scale = power_of_two_below(heaviest).recip();
            (lightest, heaviest) = (lightest * scale, heaviest * scale);
            for (h, x) in net.iter_mut().zip(points.iter_mut()) {
                let weight = h.w * scale;
                *h = ((*x - origin) * weight).extend(weight);
                *x = cartesian(*h);
            }
        } else {
            for (h, x) in net.iter_mut().zip(points.iter_mut()) {
                *x -= origin;
                *h = x.extend(1.0);
            }
        }
        let farthest = points.iter().map(|x| x.length_squared()).fold(0.0, |a, b| if b > a { b } else { a });
        let radius = farthest.sqrt();
        let (along, across) = directions(points, degree);
        let middle = Jet::at(level, &net, (p, q), rational, 0.5, 0.5);
        Self {
            degree,
            rational,
            level,
            net,
            origin,
            radius,
            heaviest,
            lightest,
            u,
            v,
            bounds,
            oriented: OrientedBox::around(points, radius, along, across),
            ranges: OnceLock::new(),
            tables: OnceLock::new(),
            middle: middle.point(),
            inverse: pseudo_inverse(middle.ps.truncate(), middle.pt.truncate()),
        }
    }

    pub(super) fn jet(&self, s: f64, t: f64) -> Jet {
        Jet::at(self.level, &self.net, self.degree, self.rational, s, t)
    }

    pub(super) fn shape(&self) -> Shape<'_> {
        Shape { degree: self.degree, rational: self.rational, net: &self.net }
    }

    /// The ranges; made when first asked for, as most leaves of a large entity never are.
    #[inline]
    pub(super) fn ranges(&self) -> &Ranges {
        self.ranges.get_or_init(|| {
            let weights = (self.lightest, self.heaviest);
            Box::new(Ranges::new(self.shape(), self.oriented.axes(), self.radius, weights))
        })
    }

    /// The ranges of the slopes of the squared distance.
    pub(super) fn slopes(&self) -> Slopes {
        Slopes::new(self.shape(), self.oriented.axes(), self.radius, (self.lightest, self.heaviest))
    }

    /// The tables of the form; made when first asked for, as the ranges prove most leaves.
    pub(super) fn tables(&self) -> &[f64] {
        self.tables.get_or_init(|| form::tables(self.shape()))
    }

    /// A vector along the axes of the oriented box.
    pub(super) fn along_axes(&self, x: DVec3) -> DVec3 {
        *self.oriented.axes() * x
    }

    /// The corner point at `(s, t)`, both 0 or 1, about the origin.
    pub(super) fn corner(&self, s: f64, t: f64) -> DVec3 {
        let (p, q) = self.degree;
        let at = |x: f64, degree: usize| if x > 0.0 { degree } else { 0 };
        cartesian(self.net[at(s, p) * (q + 1) + at(t, q)])
    }

    /// The foot if the leaf were the affine map that it is in its middle, not yet inside the leaf.
    pub(super) fn linear_guess(&self, x: DVec3) -> (f64, f64) {
        let y = x - self.middle;
        (0.5 + self.inverse[0].dot(y), 0.5 + self.inverse[1].dot(y))
    }

    /// The point in the middle of the parameters, about the origin.
    pub(super) fn middle(&self) -> DVec3 {
        self.middle
    }

    /// A lower bound of the squared distance from `p` to the leaf, from its boxes.
    pub(super) fn box_distance_squared(&self, p: DVec3) -> f64 {
        self.bounds.distance_squared(p).max(self.oriented_distance_squared(p))
    }

    /// The same from its oriented box alone.
    pub(super) fn oriented_distance_squared(&self, p: DVec3) -> f64 {
        self.oriented.distance_squared(p - self.origin)
    }

    /// The leaf as a piece again, about the entity's origin.
    fn piece(&self) -> Piece {
        let net = self.net.iter().map(|h| (h.truncate() + self.origin * h.w).extend(h.w)).collect();
        Piece { degree: self.degree, net, rational: self.rational, u: self.u, v: self.v }
    }

    /// Both halves in the longer direction, each about its own origin.
    pub(super) fn refine(&self) -> (Direction, [Self; 2]) {
        let piece = self.piece();
        let direction = piece.longer();
        let mut points = Vec::with_capacity(piece.net.len());
        (direction, piece.halves(direction).map(|half| Self::new(half, self.level, &mut points)))
    }

    /// The definition's parameters at `(s, t)`; the ends of the leaf exactly.
    pub(super) fn parameters(&self, s: f64, t: f64) -> (f64, f64) {
        (between(self.u, s), between(self.v, t))
    }

    /// The leaf's own parameters of the definition's `(u, v)`.
    pub(super) fn own_parameters(&self, u: f64, v: f64) -> (f64, f64) {
        (share(self.u, u), share(self.v, v))
    }
}

fn between((from, to): (f64, f64), s: f64) -> f64 {
    if s >= 1.0 { to } else { (from + s * (to - from)).min(to) }
}

fn share((from, to): (f64, f64), u: f64) -> f64 {
    if to > from { ((u - from) / (to - from)).clamp(0.0, 1.0) } else { 0.0 }
}

/// The mean directions of the net in s and in t; for a curve, the chord and the way to the point farthest from it.
fn directions(points: &[DVec3], (p, q): (usize, usize)) -> (DVec3, DVec3) {
    let at = |i: usize, j: usize| points[i * (q + 1) + j];
    let (a, b, c, d) = (at(0, 0), at(p, 0), at(0, q), at(p, q));
    let along = b - a + d - c;
    if q > 0 {
        return (along, c - a + d - b);
    }
    let chord = along.normalize_or_zero();
    let (mut across, mut farthest) = (DVec3::ZERO, 0.0);
    for x in points {
        let rejected = (*x - a) - (*x - a).dot(chord) * chord;
        let length = rejected.length_squared();
        if length > farthest {
            (across, farthest) = (rejected, length);
        }
    }
    (along, across)
}

/// The rows of `J⁺` for `J = (a b)`; of each column by itself where they are parallel.
fn pseudo_inverse(a: DVec3, b: DVec3) -> [DVec3; 2] {
    let (aa, ab, bb) = (a.length_squared(), a.dot(b), b.length_squared());
    let determinant = aa * bb - ab * ab;
    if determinant > 1e-12 * aa * bb {
        [(bb * a - ab * b) / determinant, (aa * b - ab * a) / determinant]
    } else {
        [a, b].map(|x| if x.length_squared() > 0.0 { x / x.length_squared() } else { DVec3::ZERO })
    }
}
