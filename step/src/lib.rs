//! Parts as CAD systems write them: STEP files (ISO 10303-21; AP203, AP214, AP242) for perpend.
//!
//! [`import`] makes a model of a file: faces as trimmed surfaces, edges as curves, bodies. [`write`](write()) makes a file of a model.
//!
//! [`read`] gives what a file says of its part as plain data, a [`SourcePart`]: faces with their surfaces, loops and edges, placed
//! where the assembly puts them, all lengths in one unit. What it did not understand is listed in [`SourcePart::not_understood`].

mod face;
mod import;
mod read;
mod source;
mod write;

pub use import::{Import, import, import_file};
pub use read::{ReadError, ReadOptions, read, read_file};
pub use source::{
    NotUnderstood, RawPcurve, SourceBody, SourceCurve, SourceEdge, SourceFace, SourceLoop, SourcePart, SourceShell,
    SourceSurface, SourceUse,
};
pub use write::{Fitted, WriteOptions, Written, write};
