//! Where the normal of a surface vanishes.
//!
//! The cross product of both derivatives is a vector-valued polynomial over a piece, up to a power of the weight. Known lines
//! on which it vanishes, such as edges that are one point, are divided out; parts on which one direction makes a positive
//! product with all coefficients are regular, and so proven to be. What is left is polished.

use glam::DVec3;
use perpend_kernel::{Direction, NurbsSurface};

use super::bernstein::{Form, Side, hodograph, rational_hodograph};
use super::continuity::angle;
use super::ends::Pole;
use super::found::{Found, measured, proved};
use super::near::Near;
use super::options::AcquireOptions;
use super::source::{Piece, Source};
use crate::representation::{Irregularity, ParameterPoint};

/// Halvings of a part, both parameters together, until it is polished.
const DEEPEST: u32 = 16;

/// Places that are listed.
const LISTED: usize = 32;

/// Directions around a place in which normals are compared.
const AROUND: usize = 16;

/// The distance from a place at which normals are compared, as a share of the spans there; a tenth of it tells the error.
const BESIDE: f64 = 1e-3;

/// The sides of a piece, as the direction that is constant there and whether it is at its end.
const EDGES: [(Side, bool); 4] =
    [(Side::First, false), (Side::First, true), (Side::Second, false), (Side::Second, true)];

/// Vanishing normals and cusps of a surface; those of edges that are one point are left out.
pub(super) fn irregular(
    surface: &NurbsSurface,
    source: &Source,
    poles: &[Pole],
    options: &AcquireOptions,
) -> Vec<Found> {
    let ((u0, u1), (v0, v1)) = (surface.domain(Direction::U), surface.domain(Direction::V));
    let size = 2.0 * source.reach;
    let mut search = Search {
        surface,
        source,
        tolerance: options.vanishing * size / (u1 - u0) * (size / (v1 - v0)),
        options,
        places: Vec::new(),
        lines: Vec::new(),
    };
    let (p, q) = source.degree();
    let columns = source.columns();
    let count = source.knots().spans().count() * columns.len();
    let cost = if source.rational { 16.0 } else { 4.0 } * ((p * q) as f64).powi(2);
    let parts = (options.work as f64 / (cost * count as f64)) as usize;
    if parts == 0 {
        return Vec::new();
    }
    for span in source.knots().spans() {
        for piece in source.strip(span, &columns) {
            search.look(&piece, parts.min(2048));
        }
    }
    search.found(poles, columns.len())
}

struct Search<'a> {
    surface: &'a NurbsSurface,
    source: &'a Source,
    /// The length of a cross product that counts as none.
    tolerance: f64,
    options: &'a AcquireOptions,
    places: Vec<(f64, f64)>,
    /// Edges of pieces along which the normal vanishes: constant direction, its value, the middle of the edge.
    lines: Vec<(Direction, f64, f64)>,
}

impl Search<'_> {
    fn look(&mut self, piece: &Piece, parts: usize) {
        let mut normal = normal(piece, self.source);
        for (side, at_end) in EDGES {
            // a line of higher order is divided out as often
            for times in 0..4 {
                let Some(rest) = divided(&normal, side, at_end) else { break };
                normal = rest;
                if times == 0 {
                    let (low, high) = (piece.from, piece.to);
                    self.lines.push(match side {
                        Side::First => (Direction::U, if at_end { high.0 } else { low.0 }, 0.5 * low.1 + 0.5 * high.1),
                        Side::Second => (Direction::V, if at_end { high.1 } else { low.1 }, 0.5 * low.0 + 0.5 * high.0),
                    });
                }
            }
        }
        let mut open = vec![(normal, (0.0, 0.0), (1.0, 1.0), 0)];
        let mut looked = 0;
        while let Some((part, from, to, depth)) = open.pop() {
            looked += 1;
            if part.least() > 0.0 {
                continue;
            }
            if looked > parts || self.places.len() >= LISTED {
                return;
            }
            if depth >= DEEPEST || part.longest() <= 4.0 * part.error {
                let at = |a: f64, b: f64, share: f64| a + (b - a) * share;
                let place = (
                    at(piece.from.0, piece.to.0, 0.5 * (from.0 + to.0)),
                    at(piece.from.1, piece.to.1, 0.5 * (from.1 + to.1)),
                );
                self.polish(place);
                continue;
            }
            let is_first = (to.0 - from.0) >= (to.1 - from.1);
            let (side, mut low, mut high) = if is_first { (Side::First, to, from) } else { (Side::Second, to, from) };
            if is_first {
                (low.0, high.0) = (0.5 * (from.0 + to.0), 0.5 * (from.0 + to.0));
            } else {
                (low.1, high.1) = (0.5 * (from.1 + to.1), 0.5 * (from.1 + to.1));
            }
            let (lower, upper) = part.halves(side);
            open.push((upper, high, to, depth + 1));
            open.push((lower, from, low, depth + 1));
        }
    }

    /// Gauss-Newton for a zero of the normal.
    fn polish(&mut self, (mut u, mut v): (f64, f64)) {
        let ((u0, u1), (v0, v1)) = (self.surface.domain(Direction::U), self.surface.domain(Direction::V));
        for _ in 0..40 {
            let mut d = [DVec3::ZERO; 9];
            self.surface.derivatives(u, v, 2, &mut d);
            let (su, sv, suu, suv, svv) = (d[3], d[1], d[6], d[4], d[2]);
            let n = su.cross(sv);
            let (a, b) = (suu.cross(sv) + su.cross(suv), suv.cross(sv) + su.cross(svv));
            let (aa, bb, ab) = (a.length_squared(), b.length_squared(), a.dot(b));
            let determinant = aa * bb - ab * ab;
            let (x, y) = if determinant > 1e-12 * aa * bb {
                ((n.dot(a) * bb - n.dot(b) * ab) / determinant, (n.dot(b) * aa - n.dot(a) * ab) / determinant)
            } else if aa.max(bb) > 0.0 {
                // one direction tells no more than the other: a step across the line
                (n.dot(a) / (aa + bb), n.dot(b) / (aa + bb))
            } else {
                break;
            };
            if !(x.is_finite() && y.is_finite()) {
                break; // derivatives of extreme weights overflow
            }
            (u, v) = ((u - x).clamp(u0, u1), (v - y).clamp(v0, v1));
        }
        let near =
            |place: &(f64, f64)| (place.0 - u).abs() <= 1e-4 * (u1 - u0) && (place.1 - v).abs() <= 1e-4 * (v1 - v0);
        if self.surface.normal(u, v).length() <= self.tolerance && !self.places.iter().any(near) {
            self.places.push((u, v));
        }
    }

    fn found(mut self, poles: &[Pole], across: usize) -> Vec<Found> {
        let mut found = Vec::new();
        self.lines.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let spans = |direction| match direction {
            Direction::U => across,
            Direction::V => self.source.knots().spans().count(),
        };
        let is_pole = |direction, at: f64| poles.iter().any(|pole| pole.direction == direction && pole.at == at);
        for line in self.lines.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
            let (direction, at, _) = line[0];
            if is_pole(direction, at) {
                continue;
            }
            let iso = ParameterPoint::Iso(direction, at);
            if line.len() >= spans(direction) {
                self.tell(&mut found, iso, (direction, at, line[line.len() / 2].2));
            } else {
                for (direction, at, middle) in line.iter().take(LISTED) {
                    let place = match direction {
                        Direction::U => ParameterPoint::Surface(*at, *middle),
                        Direction::V => ParameterPoint::Surface(*middle, *at),
                    };
                    self.tell(&mut found, place, (*direction, *at, *middle));
                }
            }
        }
        let on_line = |u: f64, v: f64| {
            self.lines.iter().any(|(direction, at, _)| {
                let (first, last) = self.surface.domain(*direction);
                let along = if *direction == Direction::U { u } else { v };
                (along - at).abs() <= 1e-6 * (last - first)
            })
        };
        for (u, v) in self.places.iter().copied().filter(|(u, v)| !on_line(*u, *v)) {
            self.tell(&mut found, ParameterPoint::Surface(u, v), (Direction::U, u, v));
        }
        found
    }

    /// Lists a place, and the cusp that it may be.
    fn tell(&self, found: &mut Vec<Found>, at: ParameterPoint, (direction, constant, other): (Direction, f64, f64)) {
        let (u, v) = if direction == Direction::U { (constant, other) } else { (other, constant) };
        let mut d = [DVec3::ZERO; 4];
        self.surface.derivatives(u, v, 1, &mut d);
        let area = d[2].cross(d[1]).length();
        let width = |direction| {
            let widths = self.surface.knots(direction).spans().map(|s| s.end - s.start);
            widths.fold(f64::INFINITY, f64::min)
        };
        let (p, q) = self.surface.degree();
        // derivatives lose a few `p ε` of the largest coordinate, times the degree, per span
        let loss = |p: usize, direction| {
            64.0 * f64::EPSILON * (p * p + 4) as f64 * self.source.reach / (self.source.lightest * width(direction))
        };
        let gap = loss(p, Direction::U) * d[1].length()
            + loss(q, Direction::V) * d[2].length()
            + loss(p, Direction::U) * loss(q, Direction::V);
        found.push(proved(Irregularity::VanishingNormal { at, area }, gap, self.tolerance.max(area)));
        let (coarse, fine) = (self.spread(u, v, BESIDE), self.spread(u, v, 0.1 * BESIDE));
        let error = (coarse - fine).abs();
        if fine > self.options.continuity + 2.0 * error {
            found.push(measured(Irregularity::Cusp { at, angle: fine }, error, self.options.continuity));
        }
    }

    /// The largest angle between normals around a place.
    fn spread(&self, u: f64, v: f64, share: f64) -> f64 {
        let ((u0, u1), (v0, v1)) = (self.surface.domain(Direction::U), self.surface.domain(Direction::V));
        let width = |direction, at: f64| {
            let knots = self.surface.knots(direction);
            let index = knots.find_span(at);
            knots.as_slice()[index + 1] - knots.as_slice()[index]
        };
        let (wide, high) = (share * width(Direction::U, u), share * width(Direction::V, v));
        let turn = std::f64::consts::TAU / AROUND as f64;
        let normals: Vec<DVec3> = (0..AROUND)
            // not along the parameters themselves, where a line of vanishing normals may run
            .map(|k| ((k as f64 + 0.5) * turn).sin_cos())
            .map(|(sin, cos)| (u + cos * wide, v + sin * high))
            .filter(|(u, v)| (u0..=u1).contains(u) && (v0..=v1).contains(v))
            .filter_map(|(u, v)| self.surface.normal(u, v).try_normalize())
            .collect();
        let pairs = normals.iter().enumerate().flat_map(|(k, a)| normals[k + 1..].iter().map(move |b| angle(*a, *b)));
        pairs.fold(0.0, f64::max)
    }
}

/// The cross product of the derivatives over a piece, up to a power of the weight.
fn normal(piece: &Piece, source: &Source) -> Near<DVec3> {
    let (p, q) = piece.form.degree;
    let exchanged = exchanged(&piece.form);
    let along = |form: &Form<glam::DVec4>, degree: usize| {
        let n = if source.rational { rational_hodograph(form) } else { hodograph(&form.map(|c| c.truncate())) };
        let error = f64::EPSILON * 32.0 * (p + q + 4) as f64 * degree as f64 * source.reach;
        Near { form: n, error }
    };
    let over = along(&exchanged, q);
    let over = Near { form: self::exchanged(&over.form), error: over.error };
    along(&piece.form, p).cross(&over)
}

/// The form with its parameters exchanged.
fn exchanged<T: super::bernstein::Coefficient>(form: &Form<T>) -> Form<T> {
    let (m, n) = form.degree;
    let coefficients = (0..=n).flat_map(|j| (0..=m).map(move |i| form.coefficients[i * (n + 1) + j])).collect();
    Form { degree: (n, m), coefficients }
}

/// The form divided by the parameter, or by one less it, where it vanishes at that end up to rounding.
fn divided(normal: &Near<DVec3>, side: Side, at_end: bool) -> Option<Near<DVec3>> {
    let turned = matches!(side, Side::Second);
    let form = if turned { exchanged(&normal.form) } else { normal.form.clone() };
    let (m, n) = form.degree;
    if m == 0 {
        return None;
    }
    let row = |i: usize| &form.coefficients[i * (n + 1)..(i + 1) * (n + 1)];
    let gone = |c: &DVec3| c.length() <= normal.error;
    let is_all = form.coefficients.iter().all(gone);
    if is_all || !row(if at_end { m } else { 0 }).iter().all(gone) {
        return None;
    }
    let mut coefficients = Vec::with_capacity(m * (n + 1));
    for i in 0..m {
        let (from, factor) = if at_end { (i, m as f64 / (m - i) as f64) } else { (i + 1, m as f64 / (i + 1) as f64) };
        coefficients.extend(row(from).iter().map(|c| *c * factor));
    }
    let form = Form { degree: (m - 1, n), coefficients };
    let form = if turned { exchanged(&form) } else { form };
    Some(Near { form, error: normal.error * m as f64 })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_on_which_a_polynomial_vanishes_is_divided_out() {
        // s (1 + t) z, over s² at the end of s
        let c = [0.0, 0.0, 0.5, 1.0, 1.0, 2.0].map(|z| DVec3::Z * z).to_vec();
        let form = Near { form: Form { degree: (2, 1), coefficients: c }, error: 1e-15 };
        let rest = divided(&form, Side::First, false).expect("it vanishes at s = 0");
        assert_eq!(rest.form.degree, (1, 1));
        assert_eq!(rest.form.coefficients.iter().map(|c| c.z).collect::<Vec<_>>(), [1.0, 2.0, 1.0, 2.0]);
        assert!(divided(&form, Side::First, true).is_none() && divided(&form, Side::Second, false).is_none());
    }
}
