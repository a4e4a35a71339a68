//! Preparation of defining data (Piegl et al. 2008, §2): cleaning, purging, and where to cut a curve.
//!
//! *Cleaning* removes what says nothing: knots, degrees and weights without which the entity is the same, to proven rounding.
//! *Purging* removes what says little: it changes the entity within a tolerance that somebody has to name. Both keep the parameters
//! of every point, and both prove how far points move, by control points, from what they were given to what they give.
//! Validation is not here: a [`Definition`] is valid by construction.

mod along;
mod clean;
mod cuts;
mod purge;

use perpend_kernel::Definition;

use crate::representation::Cleaning;

pub use along::displacement;
pub use clean::clean;
pub use cuts::{cuts, cuts_at, parted};
pub use purge::{InvalidTolerance, purge};

/// A definition that was cleaned or purged.
#[derive(Debug, Clone, PartialEq)]
pub struct PreparedDefinition {
    /// The definition now; with the bits that it had where there are no steps.
    pub definition: Definition,
    /// What was done, in order.
    pub steps: Vec<Cleaning>,
    /// No point moved farther than this by all steps together: proven, rounding included; 0 where there are none.
    pub deviation: f64,
}
