//! What a search has still to look at, the most promising first.

use std::cmp::Ordering;

/// Something to look at, ordered by its key alone: what a heap of them gives first has the largest.
pub(super) struct Open<T> {
    pub(super) key: f64,
    pub(super) item: T,
}

impl<T> PartialEq for Open<T> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl<T> Eq for Open<T> {}

impl<T> PartialOrd for Open<T> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<T> Ord for Open<T> {
    fn cmp(&self, other: &Self) -> Ordering {
        self.key.total_cmp(&other.key)
    }
}
