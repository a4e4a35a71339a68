//! Splitting the worst part first.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use glam::DVec4;

/// A part of a curve that can be split.
pub(crate) trait Part: Sized {
    /// The proven error of standing for it by its chord.
    fn error(&self) -> f64;
    /// Both halves; none where it is too short to have some.
    fn split(&self) -> Option<[Self; 2]>;
}

/// The largest share that the inner control points of a rational Bézier curve have in a point of it.
///
/// With `b` the sum of the first and the last Bernstein polynomial, at least `2^(1 - degree)`, it is at most
/// `inner (1 - b) / (inner (1 - b) + outer b)` for the largest inner and the smallest outer weight.
pub(crate) fn inner_share(points: &[DVec4]) -> f64 {
    let degree = points.len() - 1;
    let outer = points[0].w.min(points[degree].w);
    let inner = points[1..degree].iter().map(|point| point.w).fold(0.0, f64::max);
    let b = 0.5_f64.powi(degree as i32 - 1);
    inner * (1.0 - b) / (inner * (1.0 - b) + outer * b)
}

/// Parts that are fine enough, in no order, and the largest error of one.
pub(crate) struct Refined<P> {
    pub(crate) parts: Vec<P>,
    pub(crate) error: f64,
}

/// Splits the worst part until all are within `chord`, or there are `limit` of them.
pub(crate) fn refine<P: Part>(first: Vec<P>, chord: f64, limit: usize) -> Refined<P> {
    let (mut done, mut error) = (Vec::new(), 0.0_f64);
    let mut open: BinaryHeap<Ranked> = BinaryHeap::new();
    let mut parts: Vec<Option<P>> = Vec::new();
    let mut count = first.len();
    for part in first {
        open.push(Ranked { error: part.error(), index: parts.len() });
        parts.push(Some(part));
    }
    while let Some(Ranked { error: worst, index }) = open.pop() {
        let part = parts[index].take().expect("each part is listed once");
        let halves = if worst <= chord || count >= limit { None } else { part.split() };
        match halves {
            Some(halves) => {
                count += 1;
                for half in halves {
                    open.push(Ranked { error: half.error(), index: parts.len() });
                    parts.push(Some(half));
                }
            }
            None => {
                error = error.max(worst);
                done.push(part);
            }
        }
    }
    Refined { parts: done, error }
}

/// A part's place in a list, ordered by its error, then by the place, so that the order does not depend on anything else.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Ranked {
    pub(crate) error: f64,
    pub(crate) index: usize,
}

impl Eq for Ranked {}

impl Ord for Ranked {
    fn cmp(&self, other: &Self) -> Ordering {
        self.error.total_cmp(&other.error).then(other.index.cmp(&self.index))
    }
}

impl PartialOrd for Ranked {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
