//! How often a piece of the boundary crosses the ray from a point towards larger u: once or evenly.

use glam::{DVec2, DVec3};
use robust::{Coord, orient2d};
use smallvec::SmallVec;

use crate::bezier::halve;
use crate::trim::region::{BoundaryPiece, hull};

/// What a piece does to the ray from a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Crossing {
    /// The point lies on the piece, as far as doubles tell.
    On,
    /// An odd number of times.
    Odd,
    /// An even number of times.
    Even,
}

/// Room for a piece of usual degree.
type Net = SmallVec<[DVec3; 8]>;

/// The part of a piece that is looked at.
pub(super) struct Part {
    points: Net,
    pub(super) start: DVec2,
    pub(super) end: DVec2,
}

impl Part {
    pub(super) fn whole(piece: &BoundaryPiece) -> Self {
        Self { points: piece.points.iter().copied().collect(), start: piece.start, end: piece.end }
    }

    /// The box of its control points.
    pub(super) fn hull(&self) -> (DVec2, DVec2) {
        hull(&self.points, self.start, self.end)
    }

    /// Both halves.
    pub(super) fn halves(self) -> [Self; 2] {
        let Self { points: mut low, start, end } = self;
        let mut high = low.clone();
        halve(&mut low, &mut high);
        let middle = high[0].truncate() / high[0].z;
        [Self { points: low, start, end: middle }, Self { points: high, start: middle, end }]
    }
}

/// What a piece does to the ray from `at`.
///
/// A part whose hull lies wholly above, below or left of the ray does not cross it, or not so that it counts; one that lies wholly right of the point crosses it as
/// often as its ends say. What holds the point in its hull is halved, down to the size of rounding. Ends belong to the ray by one rule (above it,
/// or not), so that of two pieces that meet in a point just one counts.
pub(super) fn crossing(piece: &BoundaryPiece, at: DVec2) -> Crossing {
    if let Some(known) = outside_hull((piece.min, piece.max), piece.start, piece.end, at) {
        return known;
    }
    if piece.is_straight() {
        return straight(piece.start, piece.end, at);
    }
    let mut odd = false;
    let smallest = 4.0 * f64::EPSILON * piece.min.abs().max(piece.max.abs());
    let mut open: SmallVec<[Part; 16]> = SmallVec::new();
    open.push(Part::whole(piece));
    while let Some(part) = open.pop() {
        let (min, max) = part.hull();
        match outside_hull((min, max), part.start, part.end, at) {
            Some(Crossing::Odd) => odd = !odd,
            Some(_) => {}
            None => {
                if (max - min).cmple(smallest).all() {
                    return Crossing::On;
                }
                open.extend(part.halves());
            }
        }
    }
    if odd { Crossing::Odd } else { Crossing::Even }
}

/// The answer where the point lies outside the hull.
fn outside_hull((min, max): (DVec2, DVec2), start: DVec2, end: DVec2, at: DVec2) -> Option<Crossing> {
    if at.y < min.y || at.y > max.y || at.x > max.x {
        return Some(Crossing::Even);
    }
    (at.x < min.x).then(|| by_ends(start, end, at))
}

fn by_ends(start: DVec2, end: DVec2, at: DVec2) -> Crossing {
    if (start.y > at.y) == (end.y > at.y) { Crossing::Even } else { Crossing::Odd }
}

/// The point lies in the box of the segment.
fn straight(start: DVec2, end: DVec2, at: DVec2) -> Crossing {
    let side = orientation(start, end, at);
    if side == 0.0 {
        return Crossing::On;
    }
    // upwards, the point is left of the segment where the ray meets it
    let meets = (side > 0.0) == (end.y > start.y);
    if meets { by_ends(start, end, at) } else { Crossing::Even }
}

/// Positive where `at` lies left of the way from `start` to `end`; exact in its sign.
pub(super) fn orientation(start: DVec2, end: DVec2, at: DVec2) -> f64 {
    let coord = |p: DVec2| Coord { x: p.x, y: p.y };
    orient2d(coord(start), coord(end), coord(at))
}
