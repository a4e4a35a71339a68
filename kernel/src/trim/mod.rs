//! Trims: what part of a surface counts.
//!
//! A trimmed surface is a surface (its *carrier*) with a [`Trimming`]: loops of p-curves, which are NURBS curves in the parameters of
//! the carrier. What the loops bound is a [`Region`]; a point of the carrier belongs to the trimmed surface if its parameters lie in it.

mod cover;
mod crossing;
mod invalid;
mod plane_curve;
mod region;
mod trimming;

pub use cover::Cover;
pub use invalid::InvalidTrim;
pub use plane_curve::PlaneCurve;
pub use region::{BoundaryPiece, Region, Side};
pub use trimming::{TrimCurve, TrimCurveData, TrimEntry, TrimLoop, TrimLoopData, Trimming, TrimmingData};
