//! How often a piece of the boundary crosses the ray from a point towards larger u: once or evenly.

use glam::{DVec2, DVec3};
use robust::{Coord, orient2d};
use smallvec::SmallVec;

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
pub(super) type Net = SmallVec<[DVec3; 8]>;

/// The part of a piece that is looked at.
struct Part {
    points: Net,
    start: DVec2,
    end: DVec2,
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
    let first = Part { points: piece.points.iter().copied().collect(), start: piece.start, end: piece.end };
    let mut open: SmallVec<[Part; 16]> = SmallVec::new();
    open.push(first);
    while let Some(part) = open.pop() {
        let (min, max) = hull(&part.points, part.start, part.end);
        match outside_hull((min, max), part.start, part.end, at) {
            Some(Crossing::Odd) => odd = !odd,
            Some(_) => {}
            None => {
                if (max - min).cmple(smallest).all() {
                    return Crossing::On;
                }
                open.extend(halves(part));
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

/// Both halves, by de Casteljau's algorithm.
fn halves(part: Part) -> [Part; 2] {
    let Part { points, start, end } = part;
    let (low, high) = halved(&points);
    let tip = low[low.len() - 1];
    let middle = tip.truncate() / tip.z;
    [Part { points: low, start, end: middle }, Part { points: high, start: middle, end }]
}

/// Both halves of a homogeneous Bézier net.
pub(super) fn halved(points: &[DVec3]) -> (Net, Net) {
    let mut work: Net = points.iter().copied().collect();
    let n = work.len();
    let (mut low, mut high) = (Net::with_capacity(n), Net::with_capacity(n));
    for k in 0..n {
        low.push(work[0]);
        high.push(work[n - 1 - k]);
        for i in 0..n - 1 - k {
            work[i] = 0.5 * (work[i] + work[i + 1]);
        }
    }
    high.reverse();
    (low, high)
}
