//! From the bytes of a STEP file to plain data.
//!
//! In the order of one file: `guard` (size, time, a thread that may fail), `parse` (the syntax, by the crate `step-io`), `entities` (typed access to
//! what it found), `context` (units), `structure` (products, representations, occurrences), `style` (colours), `part` (the walk over the assembly),
//! `body` (shells, faces, loops, edges), `surface`, `curve`, `spline`, `composite`, `pcurve`, `placement` (geometry), `placed` (copies of a body).

mod body;
mod composite;
mod context;
mod curve;
mod entities;
mod error;
mod guard;
mod parse;
mod part;
mod pcurve;
mod placed;
mod placement;
mod spline;
mod structure;
mod style;
mod surface;
#[cfg(test)]
mod tests;

pub use error::ReadError;
pub(crate) use guard::read_bytes;
pub use guard::{ReadOptions, read, read_file};
