//! Working memory of a query.

/// Working memory that the caller may hold and reuse, so that queries do not allocate. Its contents never change an answer.
#[derive(Debug, Default)]
pub struct Scratch {}
