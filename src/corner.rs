//! The corners of a face: where its boundary turns, and where an edge of it is one point.
//!
//! A corner's share of a pseudo-normal is the outward normal times the angle of the face there (Bærentzen and Aanæs 2005, §3); at a pole,
//! whose normal depends on the direction of approach, the integral of that over the angle.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};
use perpend_kernel::{Definition, Direction, NurbsSurface, PlaneCurve, Side, Trimming};

use crate::entity::Entity;

/// A corner of a face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Corner {
    /// Where it is.
    pub(crate) point: DVec3,
    /// The outward normal times the angle of the face at the corner.
    pub(crate) weighted: DVec3,
    /// The angle.
    pub(crate) angle: f64,
}

/// A boundary that turns by less than this goes straight on: an edge's point, whose angle is π.
const STRAIGHT: f64 = 1e-6;

/// An edge shorter than this share of the face is one point.
const POINT: f64 = 1e-9;

/// How many directions stand for those around a pole.
const DIRECTIONS: usize = 64;

/// How far from a corner or a pole the face is looked at, as a share of its parameters.
const BESIDE: f64 = 1e-4;

/// The corners of a face.
pub(crate) fn corners(entity: &Entity) -> Vec<Corner> {
    let Definition::NurbsSurface(surface) = entity.definition.as_ref() else { return Vec::new() };
    let trimming = entity.trimming().map(AsRef::as_ref);
    let face = Face { surface, trimming, size: entity.definition.size() };
    face.loops().iter().flat_map(|pieces| face.along(pieces)).collect()
}

/// A face, trimmed or not.
struct Face<'a> {
    surface: &'a NurbsSurface,
    trimming: Option<&'a Trimming>,
    size: f64,
}

/// A smooth piece of the boundary, with its directions in the parameters at both ends.
struct Piece {
    curve: PlaneCurve,
    span: (f64, f64),
}

impl Piece {
    fn at(&self, share: f64) -> DVec2 {
        self.curve.point(self.span.0 + share * (self.span.1 - self.span.0))
    }

    /// The direction at the start and at the end, as seen from inside the piece.
    fn directions(&self) -> [DVec2; 2] {
        [self.at(BESIDE) - self.at(0.0), self.at(1.0) - self.at(1.0 - BESIDE)]
    }
}

impl Face<'_> {
    /// The boundary: of the trim, or of the domain.
    fn loops(&self) -> Vec<Vec<Piece>> {
        let pieces = |curve: &PlaneCurve| -> Vec<Piece> {
            let spans = curve.knots().spans();
            spans.map(|span| Piece { curve: curve.clone(), span: (span.start, span.end) }).collect()
        };
        match self.trimming {
            Some(trimming) => {
                let loops = trimming.loops().iter();
                loops.map(|one| one.curves.iter().flat_map(|trim| pieces(&trim.curve)).collect()).collect()
            }
            None => {
                let (min, max) = self.domain();
                let ring = [min, DVec2::new(max.x, min.y), max, DVec2::new(min.x, max.y)];
                let sides = (0..4).filter_map(|k| PlaneCurve::line(ring[k], ring[(k + 1) % 4]).ok());
                vec![sides.flat_map(|side| pieces(&side)).collect()]
            }
        }
    }

    fn domain(&self) -> (DVec2, DVec2) {
        let [(u0, u1), (v0, v1)] = [Direction::U, Direction::V].map(|direction| self.surface.domain(direction));
        (DVec2::new(u0, v0), DVec2::new(u1, v1))
    }

    /// The corners of a loop.
    fn along(&self, pieces: &[Piece]) -> Vec<Corner> {
        let poles: Vec<bool> = pieces.iter().map(|piece| self.is_point(piece)).collect();
        let mut corners = Vec::new();
        for (k, piece) in pieces.iter().enumerate() {
            let before = (k + pieces.len() - 1) % pieces.len();
            if poles[k] {
                corners.extend(self.pole(piece));
            } else if !poles[before] {
                corners.extend(self.corner(&pieces[before], piece));
            }
        }
        corners
    }

    /// Whether a piece of the boundary is one point in space.
    fn is_point(&self, piece: &Piece) -> bool {
        let start = self.point(piece.at(0.0));
        (1..=4).all(|k| self.point(piece.at(f64::from(k) / 4.0)).distance(start) <= POINT * self.size)
    }

    fn point(&self, at: DVec2) -> DVec3 {
        self.surface.point(at.x, at.y)
    }

    /// The corner between two pieces; none where the boundary goes straight on, or the surface has no tangent plane.
    fn corner(&self, before: &Piece, after: &Piece) -> Option<Corner> {
        let at = after.at(0.0);
        let mut d = [DVec3::ZERO; 4];
        self.surface.derivatives(at.x, at.y, 1, &mut d);
        let (su, sv) = (d[2], d[1]);
        let normal = su.cross(sv).try_normalize()?;
        let in_space = |direction: DVec2| direction.x * su + direction.y * sv;
        let (x, y) = {
            let x = in_space(after.directions()[0]).try_normalize()?;
            (x, normal.cross(x))
        };
        let back = -in_space(before.directions()[1]);
        // counter-clockwise from the way on to the way back: what lies on the left of the boundary
        let left = back.dot(y).atan2(back.dot(x)).rem_euclid(TAU);
        let inside = if self.is_left_inside(at, (su, sv), (x, y), 0.5 * left, after) { left } else { TAU - left };
        let angle = if (inside - PI).abs() < STRAIGHT { return None } else { inside };
        Some(Corner { point: d[0], weighted: angle * self.outward(normal), angle })
    }

    /// Whether the region lies in a direction of the tangent plane from a corner.
    fn is_left_inside(
        &self,
        at: DVec2,
        (su, sv): (DVec3, DVec3),
        (x, y): (DVec3, DVec3),
        turn: f64,
        after: &Piece,
    ) -> bool {
        let Some(trimming) = self.trimming else { return true };
        let direction = turn.cos() * x + turn.sin() * y;
        // the parameters of that direction: the normal equations
        let (e, f, g) = (su.dot(su), su.dot(sv), sv.dot(sv));
        let (a, b) = (direction.dot(su), direction.dot(sv));
        let uv = DVec2::new(a * g - b * f, b * e - a * f).normalize_or_zero();
        let step = BESIDE * after.at(0.5).distance(at);
        trimming.region().side(at + step * uv) == Side::Inside
    }

    /// The corner that a piece is which is one point: the face fans out from it.
    fn pole(&self, piece: &Piece) -> Option<Corner> {
        let (min, max) = self.domain();
        let step = (max - min) * BESIDE;
        let (from, to) = (piece.at(0.0), piece.at(1.0));
        let along = (to - from).try_normalize()?;
        // into the face, across the piece
        let across = [along.perp(), -along.perp()].into_iter().find(|across| {
            let beside = from.lerp(to, 0.5) + *across * step;
            let in_domain = beside.cmpge(min).all() && beside.cmple(max).all();
            in_domain && self.trimming.is_none_or(|trimming| trimming.region().side(beside) == Side::Inside)
        })?;
        let point = self.point(from);
        let rays: Vec<(DVec3, DVec3)> = (0..=DIRECTIONS)
            .filter_map(|k| {
                let at = from.lerp(to, k as f64 / DIRECTIONS as f64) + across * step;
                let ray = (self.point(at) - point).try_normalize()?;
                let normal = self.surface.normal(at.x, at.y).try_normalize()?;
                Some((ray, self.outward(normal)))
            })
            .collect();
        let (mut weighted, mut angle) = (DVec3::ZERO, 0.0);
        for pair in rays.windows(2) {
            let turn = pair[0].0.angle_between(pair[1].0);
            weighted += 0.5 * turn * (pair[0].1 + pair[1].1);
            angle += turn;
        }
        (angle > 0.0).then_some(Corner { point, weighted, angle })
    }

    fn outward(&self, normal: DVec3) -> DVec3 {
        if self.trimming.is_some_and(Trimming::reversed) { -normal } else { normal }
    }
}
