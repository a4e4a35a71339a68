//! The region that loops of p-curves bound.

use glam::{DVec2, DVec3};

use crate::trim::crossing::{Crossing, crossing};
use crate::trim::trimming::{TrimCurve, TrimLoop};

/// Where parameters lie, seen from a region.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// Within.
    Inside,
    /// On the boundary, as far as doubles tell.
    Boundary,
    /// Without.
    Outside,
}

/// A region of the parameter plane, closed: what loops of p-curves bound, by the even-odd rule.
///
/// Where a curve does not begin in the bits in which the one before it ends, the straight way between them is part of the boundary. So every loop is
/// closed to the last bit, and no ray slips through.
#[derive(Debug, Clone)]
pub struct Region {
    pub(super) pieces: Vec<BoundaryPiece>,
    min: DVec2,
    max: DVec2,
}

/// A Bézier piece of a region's boundary.
#[derive(Debug, Clone)]
pub struct BoundaryPiece {
    /// The control points, homogeneous: `(w u, w v, w)`.
    pub points: Vec<DVec3>,
    /// Where it begins, in the bits in which the piece before it ends.
    pub start: DVec2,
    /// Where it ends, in the bits in which the piece after it begins.
    pub end: DVec2,
    /// Whether a p-curve of the loop begins where it does; so a straight join over a gap never does.
    pub begins_curve: bool,
    /// Whether a p-curve of the loop ends where it does.
    pub ends_curve: bool,
    /// The box of the control points.
    pub(super) min: DVec2,
    pub(super) max: DVec2,
}

impl BoundaryPiece {
    pub(super) fn new(points: Vec<DVec3>, start: DVec2, end: DVec2) -> Self {
        let (min, max) = hull(&points, start, end);
        Self { points, start, end, begins_curve: false, ends_curve: false, min, max }
    }

    fn straight(start: DVec2, end: DVec2) -> Self {
        Self::new(vec![start.extend(1.0), end.extend(1.0)], start, end)
    }

    pub(super) fn is_straight(&self) -> bool {
        self.points.len() == 2
    }
}

/// The box of control points, and of the ends that stand for the first and the last.
pub(super) fn hull(points: &[DVec3], start: DVec2, end: DVec2) -> (DVec2, DVec2) {
    let ends = (start.min(end), start.max(end));
    let inner = points.get(1..points.len() - 1).unwrap_or_default();
    inner.iter().fold(ends, |(min, max), point| {
        let point = point.truncate() / point.z;
        (min.min(point), max.max(point))
    })
}

impl Region {
    pub(super) fn new(loops: &[TrimLoop]) -> Self {
        let mut pieces: Vec<BoundaryPiece> = Vec::new();
        for one in loops {
            let mut at = one.curves[one.curves.len() - 1].curve.end();
            for TrimCurve { curve, .. } in &one.curves {
                if at != curve.start() {
                    pieces.push(BoundaryPiece::straight(at, curve.start()));
                }
                at = curve.start();
                let parts = curve.pieces();
                let last = parts.len() - 1;
                for (k, part) in parts.into_iter().enumerate() {
                    let points: Vec<DVec3> = part.points.iter().map(|h| DVec3::new(h.x, h.y, h.w)).collect();
                    let tip = points[points.len() - 1];
                    let end = if k == last { curve.end() } else { tip.truncate() / tip.z };
                    pieces.push(BoundaryPiece {
                        begins_curve: k == 0,
                        ends_curve: k == last,
                        ..BoundaryPiece::new(points, at, end)
                    });
                    at = end;
                }
            }
        }
        let none = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        let (min, max) = pieces.iter().fold(none, |(min, max), piece| (min.min(piece.min), max.max(piece.max)));
        Self { pieces, min, max }
    }

    /// A box that holds the region: least and largest `(u, v)`.
    #[must_use]
    pub fn bounds(&self) -> (DVec2, DVec2) {
        (self.min, self.max)
    }

    /// The boundary, loop after loop; within a loop every piece begins where the one before it ends.
    #[must_use]
    pub fn pieces(&self) -> &[BoundaryPiece] {
        &self.pieces
    }

    /// Where parameters lie.
    ///
    /// # Accuracy
    ///
    /// Exact for straight p-curves (adaptive predicates); for curved ones up to the rounding of their subdivision, a few ulps of the largest coordinate:
    /// within that of a curve the answer is [`Side::Boundary`].
    #[must_use]
    pub fn side(&self, at: DVec2) -> Side {
        if at.cmplt(self.min).any() || at.cmpgt(self.max).any() || at.is_nan() {
            return Side::Outside;
        }
        let mut is_inside = false;
        for piece in &self.pieces {
            match crossing(piece, at) {
                Crossing::On => return Side::Boundary,
                Crossing::Odd => is_inside = !is_inside,
                Crossing::Even => {}
            }
        }
        if is_inside { Side::Inside } else { Side::Outside }
    }

    /// Whether no point is inside, as far as a grid of its box and points beside the boundary tell.
    pub(super) fn is_empty(&self) -> bool {
        let (min, max) = (self.min, self.max);
        let beside = |piece: &BoundaryPiece| {
            let step = 1e-7 * (max - min);
            let middle = piece.points.iter().fold(DVec3::ZERO, |sum, point| sum + *point);
            let middle =
                if piece.is_straight() { 0.5 * (piece.start + piece.end) } else { middle.truncate() / middle.z };
            let across = (piece.end - piece.start).perp().normalize_or(DVec2::X) * step;
            [middle, middle + across, middle - across]
        };
        let grid = (1..16).flat_map(|i| (1..16).map(move |j| DVec2::new(f64::from(i), f64::from(j)) / 16.0));
        let mut seen = grid.map(|share| min + share * (max - min)).chain(self.pieces.iter().flat_map(beside));
        !seen.any(|at| self.side(at) == Side::Inside)
    }
}
