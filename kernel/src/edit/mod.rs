//! Editing: changes of the description that keep the shape, or move it as a whole.
//!
//! All but removal and reduction are affine combinations of control points with non-negative coefficients, formed in homogeneous
//! form: nothing is extrapolated, so that the ratio of weights keeps its relative accuracy. Points that an edit does not touch
//! keep their bits.

mod banded;
mod blend;
mod boundary;
mod change;
mod deviation;
mod domain;
mod elevate;
mod fit;
mod insert;
mod invalid;
mod iso;
mod reduce;
mod remove;
mod reverse;
mod split;
mod swap;
mod thin;
mod tight_box;
mod transform;

pub(crate) use blend::Blend;
pub(crate) use domain::mapped;
pub use invalid::InvalidEdit;
pub use reduce::DegreeReduction;
pub use remove::KnotRemoval;
pub use thin::Thinned;
