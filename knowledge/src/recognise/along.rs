//! How far a coordinate runs along a curve: enclosed by control points, closed in on by halving.

use glam::{DVec3, DVec4};
use perpend_kernel::NurbsCurve;
use perpend_kernel::bezier::curve_pieces;

use super::proof::rounding;

/// Homogeneous Bézier points of one piece.
pub(super) type Piece = Vec<DVec4>;

/// The Bézier pieces of the image of a curve under an affine map of its points.
pub(super) fn pieces(curve: &NurbsCurve, map: impl Fn(DVec3) -> DVec3) -> Vec<Piece> {
    let weight = |i: usize| curve.weights().map_or(1.0, |w| w[i]);
    let mapped: Vec<DVec4> =
        curve.control_points().iter().enumerate().map(|(i, p)| (map(*p) * weight(i)).extend(weight(i))).collect();
    curve_pieces(curve.knots(), &mapped).into_iter().map(|piece| piece.points).collect()
}

/// The hull of a coordinate over a piece: least, greatest, at the start and at the end.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hull {
    pub(super) least: f64,
    pub(super) greatest: f64,
    pub(super) start: f64,
    pub(super) end: f64,
}

/// Where a coordinate runs: at the ends of the parameter, its extremes as they are attained, and bounds of them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Extent {
    pub(super) start: f64,
    pub(super) end: f64,
    pub(super) least: f64,
    pub(super) greatest: f64,
    pub(super) below: f64,
    pub(super) above: f64,
    /// How often pieces were halved at most.
    halvings: usize,
}

/// Halvings of a piece before its hull is taken as it is.
const DEPTH: usize = 40;
/// Pieces before hulls are taken as they are.
const PIECES: usize = 20_000;

/// The extent of a coordinate over pieces in order; `hull` gets a piece and the coordinate at its start as the piece before it
/// ended, and gives nothing where the piece is too long to tell.
pub(super) fn extent(pieces: &[Piece], hull: impl Fn(&[DVec4], Option<f64>) -> Option<Hull>) -> Option<Extent> {
    let mut leaves: Vec<(Piece, Hull)> = Vec::new();
    let mut halvings = 0;
    for piece in pieces {
        let mut open = vec![(piece.clone(), 0)];
        while let Some((piece, depth)) = open.pop() {
            match hull(&piece, leaves.last().map(|(_, hull)| hull.end)) {
                Some(hull) => leaves.push((piece, hull)),
                None if depth < DEPTH && leaves.len() < PIECES => {
                    halvings = halvings.max(depth + 1);
                    let (first, second) = halves(&piece);
                    open.push((second, depth + 1));
                    open.push((first, depth + 1));
                }
                None => return None,
            }
        }
    }
    let (start, end) = (leaves.first()?.1.start, leaves.last()?.1.end);
    let attained = |leaves: &[(Piece, Hull)]| {
        leaves
            .iter()
            .fold((start, start), |(low, high), (_, h)| (low.min(h.start).min(h.end), high.max(h.start).max(h.end)))
    };
    let mut seen = 0;
    for _ in 0..DEPTH {
        let (low, high) = attained(&leaves);
        let slack = 0.25 * f64::EPSILON * (high - low).max(high.abs()).max(low.abs());
        let loose = |h: &Hull| h.least < low - slack || h.greatest > high + slack;
        seen += leaves.len();
        if seen > PIECES || !leaves.iter().any(|(_, h)| loose(h)) {
            break;
        }
        halvings += 1;
        let mut finer = Vec::with_capacity(leaves.len() + 8);
        for (piece, h) in leaves {
            let parts = loose(&h).then(|| halves(&piece)).and_then(|(first, second)| {
                let a = hull(&first, Some(h.start))?;
                let b = hull(&second, Some(a.end))?;
                Some([(first, a), (second, b)])
            });
            match parts {
                Some(parts) => finer.extend(parts),
                None => finer.push((piece, h)),
            }
        }
        leaves = finer;
    }
    let (least, greatest) = attained(&leaves);
    let below = leaves.iter().fold(least, |low, (_, h)| low.min(h.least));
    let above = leaves.iter().fold(greatest, |high, (_, h)| high.max(h.greatest));
    Some(Extent { start, end, least, greatest, below, above, halvings })
}

/// De Casteljau's algorithm at one half.
fn halves(piece: &[DVec4]) -> (Piece, Piece) {
    let (mut first, mut second) = (Vec::with_capacity(piece.len()), piece.to_vec());
    for k in (0..piece.len()).rev() {
        first.push(second[0]);
        for i in 0..k {
            second[i] = 0.5 * (second[i] + second[i + 1]);
        }
        // the last of a shortened row is a point of the second half and stays
    }
    (first, second)
}

impl Extent {
    /// Bound of the relative rounding of the extent: that of the pieces, and half an ulp a degree and halving.
    pub(super) fn rounding(&self, degree: usize) -> f64 {
        rounding(degree) + (self.halvings * degree) as f64 * f64::EPSILON
    }

    /// The range in the order of the parameter; ascending where the curve runs back on itself.
    pub(super) fn range(&self) -> (f64, f64) {
        if self.runs_back() || self.end >= self.start {
            (self.least, self.greatest)
        } else {
            (self.greatest, self.least)
        }
    }

    /// Whether the ends are not the extremes.
    fn runs_back(&self) -> bool {
        (self.end - self.start).abs() < (self.greatest - self.least) * (1.0 - 1e-6)
    }

    /// How far a stated range is off, as sets and in its order.
    pub(super) fn off(&self, stated: (f64, f64)) -> f64 {
        let (low, high) = (stated.0.min(stated.1), stated.0.max(stated.1));
        let outside = (self.above - high).max(low - self.below);
        let missed = (high - self.greatest).max(self.least - low);
        let ascends = self.end >= self.start;
        let ordered = if stated.0 <= stated.1 { ascends || self.runs_back() } else { !ascends && !self.runs_back() };
        let order = if ordered { 0.0 } else { high - low };
        outside.max(missed).max(order).max(0.0)
    }
}
