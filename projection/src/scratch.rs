//! Working memory of a query.

use crate::hierarchy::Workspace;
use crate::statistics::Statistics;
use crate::wave::Marks;

/// Working memory that the caller may hold and reuse, so that queries do not allocate. Its contents never change an answer.
#[derive(Debug, Default)]
pub struct Scratch {
    pub(crate) hierarchy: Workspace,
    /// For the boundary of a trimmed surface, which is projected onto while the surface is.
    pub(crate) boundary: Workspace,
    pub(crate) marks: Marks,
    /// What the queries answered with this memory have cost so far.
    pub statistics: Statistics,
}
