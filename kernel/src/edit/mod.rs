//! Editing: changes of the description that keep the shape, or move it as a whole.
//!
//! All but removal are affine combinations of control points with non-negative coefficients, formed in homogeneous form:
//! nothing is extrapolated, so that the ratio of weights keeps its relative accuracy. Points that an edit does not touch
//! keep their bits.

mod blend;
mod boundary;
mod change;
mod domain;
mod elevate;
mod insert;
mod invalid;
mod iso;
mod remove;
mod reverse;
mod split;
mod swap;
mod tight_box;
mod transform;

pub(crate) use blend::Blend;
pub(crate) use domain::mapped;
pub use invalid::InvalidEdit;
pub use remove::KnotRemoval;
