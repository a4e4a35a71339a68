//! Properties of evaluation, editing, shapes and constructions, against oracles that share no code with the library.

mod constructions;
mod curve_edits;
mod entities;
mod evaluation;
mod oracle;
mod refused;
mod removal;
mod shapes;
mod surface_edits;
