//! Projection onto trimmed faces, judged by an oracle that shares neither the solver's code nor the kernel's regions.

mod common;

#[path = "trimmed/faces.rs"]
mod faces;
#[path = "trimmed/oracle_itself.rs"]
mod oracle_itself;
