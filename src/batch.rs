//! Many queries at once: on all cores where the feature `rayon` is on, in order, with the bits of one query alone.

use perpend_projection::Scratch;

/// How many queries a thread takes at least: enough that handing them out costs nothing beside them.
#[cfg(feature = "rayon")]
const CHUNK: usize = 64;

/// `answer` of every item with its index, in order.
#[cfg(feature = "rayon")]
pub(crate) fn answers<T: Sync, A: Send>(
    items: &[T],
    answer: impl Fn(usize, &T, &mut Scratch) -> A + Sync + Send,
) -> Vec<A> {
    use rayon::prelude::*;
    items
        .par_iter()
        .enumerate()
        .with_min_len(CHUNK)
        .map_init(Scratch::default, |scratch, (index, item)| answer(index, item, scratch))
        .collect()
}

/// `answer` of every item with its index, in order.
#[cfg(not(feature = "rayon"))]
pub(crate) fn answers<T: Sync, A: Send>(
    items: &[T],
    answer: impl Fn(usize, &T, &mut Scratch) -> A + Sync + Send,
) -> Vec<A> {
    let mut scratch = Scratch::default();
    items.iter().enumerate().map(|(index, item)| answer(index, item, &mut scratch)).collect()
}
