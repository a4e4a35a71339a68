//! Many queries at once: on all cores where the feature `rayon` is on, in order, with the bits of one query alone.

/// How many queries a thread takes at least: enough that handing them out costs nothing beside them.
#[cfg(feature = "rayon")]
const CHUNK: usize = 64;

/// `answer` of every item with its index, in order; `memory` is a thread's own and never changes an answer.
#[cfg(feature = "rayon")]
pub(crate) fn answers<T: Sync, A: Send, M>(
    items: &[T],
    memory: impl Fn() -> M + Sync + Send,
    answer: impl Fn(&mut M, usize, &T) -> A + Sync + Send,
) -> Vec<A> {
    use rayon::prelude::*;
    items
        .par_iter()
        .enumerate()
        .with_min_len(CHUNK)
        .map_init(memory, |memory, (index, item)| answer(memory, index, item))
        .collect()
}

/// `answer` of every item with its index, in order; `memory` never changes an answer.
#[cfg(not(feature = "rayon"))]
pub(crate) fn answers<T: Sync, A: Send, M>(
    items: &[T],
    memory: impl Fn() -> M + Sync + Send,
    answer: impl Fn(&mut M, usize, &T) -> A + Sync + Send,
) -> Vec<A> {
    let mut memory = memory();
    items.iter().enumerate().map(|(index, item)| answer(&mut memory, index, item)).collect()
}
