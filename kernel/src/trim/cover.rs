//! What a region does in a box of parameters.

use glam::DVec2;

use crate::trim::crossing::{Part, orientation};
use crate::trim::region::{BoundaryPiece, Region, Side};

/// A part of a piece whose hull meets a box and is this share of it meets the box, as far as need be told.
const FINE: f64 = 0.125;

/// How often a piece is halved at most.
const DEPTH: u32 = 60;

/// What a region does in a box of parameters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cover {
    /// The whole box belongs to it.
    Inside,
    /// No point of the box does.
    Outside,
    /// The boundary may meet the box.
    Crossed,
}

impl Region {
    /// What the region does in the closed box from `min` to `max`. `Inside` and `Outside` are certain; `Crossed` may be said of a box that the boundary passes by
    /// an eighth of its size.
    #[must_use]
    pub fn cover(&self, min: DVec2, max: DVec2) -> Cover {
        if self.pieces.iter().any(|piece| meets(piece, min, max)) {
            return Cover::Crossed;
        }
        match self.side(0.5 * (min + max)) {
            Side::Inside => Cover::Inside,
            Side::Outside => Cover::Outside,
            Side::Boundary => Cover::Crossed,
        }
    }
}

/// Whether a piece may meet a box.
fn meets(piece: &BoundaryPiece, min: DVec2, max: DVec2) -> bool {
    if apart((piece.min, piece.max), (min, max)) {
        return false;
    }
    if piece.is_straight() {
        return segment_meets(piece.start, piece.end, min, max);
    }
    let mut open = vec![(Part::whole(piece), 0)];
    while let Some((part, depth)) = open.pop() {
        let (low, high) = part.hull();
        if apart((low, high), (min, max)) {
            continue;
        }
        let is_fine = (high - low).cmple(FINE * (max - min)).all();
        if is_fine || depth == DEPTH || is_within(part.start, min, max) || is_within(part.end, min, max) {
            return true;
        }
        open.extend(part.halves().map(|half| (half, depth + 1)));
    }
    false
}

fn apart((a_min, a_max): (DVec2, DVec2), (b_min, b_max): (DVec2, DVec2)) -> bool {
    a_max.cmplt(b_min).any() || b_max.cmplt(a_min).any()
}

fn is_within(at: DVec2, min: DVec2, max: DVec2) -> bool {
    at.cmpge(min).all() && at.cmple(max).all()
}

/// Whether a segment whose box meets another box meets that box: not where all its corners lie on one side of the line.
fn segment_meets(start: DVec2, end: DVec2, min: DVec2, max: DVec2) -> bool {
    let corners = [min, DVec2::new(max.x, min.y), max, DVec2::new(min.x, max.y)];
    let sides = corners.map(|corner| orientation(start, end, corner));
    !(sides.iter().all(|side| *side > 0.0) || sides.iter().all(|side| *side < 0.0))
}
