//! Projection onto trimmed faces, judged by an oracle that shares neither the solver's code nor the kernel's regions.

mod common;

#[path = "trimmed/case.rs"]
mod case;
#[path = "trimmed/faces.rs"]
mod faces;
#[path = "trimmed/hard_points.rs"]
mod hard_points;
#[path = "trimmed/oracle_itself.rs"]
mod oracle_itself;
#[path = "trimmed/random.rs"]
mod random;
#[path = "trimmed/stories.rs"]
mod stories;
#[path = "trimmed/sweeps.rs"]
mod sweeps;
