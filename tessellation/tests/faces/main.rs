//! Meshes against what is known of their faces: errors at dense samples, areas and volumes in closed form, gaps.

mod closed_forms;
mod curves;
mod errors;
mod gaps;
mod limits;
mod oracle;
mod trims;
