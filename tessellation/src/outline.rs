//! The trims of a face as polylines in its domain.

use glam::{DVec2, DVec4};
use perpend_kernel::cartesian;

use crate::bound::Derivatives;
use crate::patch::{Patch, halves};
use crate::refine::{Part, inner_share, refine};

/// Bounds of the lengths of the first derivatives of a surface, piece by piece.
#[derive(Debug)]
pub(crate) struct Speeds {
    /// Where the pieces end in u and in v, ascending, without the end of the domain.
    ends: (Vec<f64>, Vec<f64>),
    /// Bounds in u and v of piece `(i, j)` at `i * columns + j`.
    bounds: Vec<DVec2>,
}

impl Speeds {
    /// The bounds of pieces in row order, `columns` of them along v.
    pub(crate) fn new(pieces: &[Patch], columns: usize) -> Self {
        let inner = |mut ends: Vec<f64>| {
            ends.pop();
            ends
        };
        let bounds = pieces.iter().map(|patch| {
            let bounds = Derivatives::of(patch);
            let ((u0, u1), (v0, v1)) = (patch.over.u, patch.over.v);
            DVec2::new(bounds.u / (u1 - u0), bounds.v / (v1 - v0))
        });
        Self {
            bounds: bounds.collect(),
            ends: (
                inner(pieces.iter().step_by(columns).map(|patch| patch.over.u.1).collect()),
                inner(pieces[..columns].iter().map(|patch| patch.over.v.1).collect()),
            ),
        }
    }

    /// Bounds over all pieces that meet a box.
    fn over(&self, low: DVec2, high: DVec2) -> DVec2 {
        let range = |ends: &[f64], low: f64, high: f64| {
            let first = ends.partition_point(|end| *end < low);
            first..=ends.partition_point(|end| *end <= high).max(first)
        };
        let columns = self.ends.1.len() + 1;
        let mut most = DVec2::ZERO;
        for i in range(&self.ends.0, low.x, high.x) {
            for j in range(&self.ends.1, low.y, high.y) {
                most = most.max(self.bounds[i * columns + j]);
            }
        }
        most
    }
}

/// A closed chain of Bézier pieces in the domain, as homogeneous points `(w u, w v, 0, w)`, end to start.
pub(crate) type Chain = Vec<Vec<DVec4>>;

/// Closed polylines, and the proven bound of how far in space they are from the trims.
#[derive(Debug)]
pub(crate) struct Polygons {
    pub(crate) loops: Vec<Vec<DVec2>>,
    pub(crate) error: f64,
}

impl Polygons {
    pub(crate) fn segments(&self) -> Vec<[DVec2; 2]> {
        let around =
            |points: &Vec<DVec2>| (0..points.len()).map(|i| [points[i], points[(i + 1) % points.len()]]).collect();
        self.loops.iter().flat_map::<Vec<_>, _>(around).collect()
    }
}

/// Polylines of trims within `chord` in space, of at most about `limit` segments.
pub(crate) fn polygons(chains: &[Chain], speeds: &Speeds, domain: [DVec2; 2], chord: f64, limit: usize) -> Polygons {
    // ends that are nearer than this are made one, which moves a segment by no more
    let joint = chord / 8.0;
    let mut first = Vec::new();
    for (chain_index, chain) in chains.iter().enumerate() {
        for (piece, points) in chain.iter().enumerate() {
            first.push(TrimPart { points: points.clone(), speeds, at: (chain_index, piece, 0.0), length: 1.0 });
        }
    }
    let mut refined = refine(first, chord - joint, limit);
    refined.parts.sort_by(|a, b| (a.at.0, a.at.1).cmp(&(b.at.0, b.at.1)).then(a.at.2.total_cmp(&b.at.2)));
    let [low, high] = domain;
    let mut error = refined.error;
    let mut loops = vec![Vec::new(); chains.len()];
    for (chain, points) in loops.iter_mut().enumerate() {
        let from = refined.parts.partition_point(|part| part.at.0 < chain);
        let to = refined.parts.partition_point(|part| part.at.0 <= chain);
        let parts = &refined.parts[from..to];
        for (k, part) in parts.iter().enumerate() {
            let (start, end) = (part.place(0).clamp(low, high), part.place(part.points.len() - 1).clamp(low, high));
            let next = parts[(k + 1) % parts.len()].place(0).clamp(low, high);
            points.push(start);
            let gap = speeds.over(end.min(next), end.max(next)).dot((next - end).abs());
            if gap > joint {
                points.push(end);
            } else {
                error = error.max(refined.error + gap);
            }
        }
        points.dedup();
        if points.first() == points.last() {
            points.pop();
        }
    }
    Polygons { loops, error }
}

struct TrimPart<'a> {
    points: Vec<DVec4>,
    speeds: &'a Speeds,
    /// Chain, piece of it, and where on the piece it starts.
    at: (usize, usize, f64),
    length: f64,
}

impl TrimPart<'_> {
    fn place(&self, index: usize) -> DVec2 {
        cartesian(self.points[index]).truncate()
    }
}

impl Part for TrimPart<'_> {
    fn error(&self) -> f64 {
        let places: Vec<DVec2> = (0..self.points.len()).map(|i| self.place(i)).collect();
        let (from, to) = (places[0], places[places.len() - 1]);
        let low = places.iter().fold(from, |low, place| low.min(*place));
        let high = places.iter().fold(from, |high, place| high.max(*place));
        let speed = self.speeds.over(low, high);
        let along = speed * (to - from);
        let length_squared = along.length_squared();
        let error = places.iter().map(|place| {
            let share = (speed * (*place - from)).dot(along) / length_squared;
            let share = if length_squared > 0.0 { share.clamp(0.0, 1.0) } else { 0.0 };
            speed.dot((*place - (from + share * (to - from))).abs())
        });
        inner_share(&self.points) * error.fold(0.0, f64::max)
    }

    fn split(&self) -> Option<[Self; 2]> {
        let (low, high) = halves(&self.points);
        let length = 0.5 * self.length;
        let (chain, piece, start) = self.at;
        let half = |points, start| Self { points, speeds: self.speeds, at: (chain, piece, start), length };
        // 50 halvings leave nothing but rounding
        (length > f64::EPSILON).then(|| [half(low, start), half(high, start + length)])
    }
}
