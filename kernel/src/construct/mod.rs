//! Constructions: surfaces from curves, and curves and surfaces through points.

mod compatible;
mod extrusion;
mod interpolate;
mod loft;
mod revolution;
mod ruled;
mod spacing;
mod through_grid;
mod through_points;

pub use extrusion::extrusion;
pub use interpolate::InvalidInterpolation;
pub use loft::loft;
pub use revolution::revolution;
pub use ruled::ruled;
pub use spacing::Spacing;
pub use through_grid::surface_through;
pub use through_points::curve_through;
