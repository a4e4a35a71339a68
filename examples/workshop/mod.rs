//! A workshop: the model and the points that the examples read, made by code.
//!
//! Coordinates that are computed by formula are rounded to 1e-4 mm: the file is then short, and the same on machines whose
//! sines differ in the last bit.

mod brush_handle;
mod curves;
mod dust_pan;
mod known;
mod made;
mod points;
mod quadrics;
mod random;

use std::error::Error;
use std::fs;
use std::path::Path;

use perpend::{DVec3, Model};

/// What is made, or why it was not.
pub(crate) type Outcome<T> = Result<T, Box<dyn Error>>;

/// Writes `workshop.ron`, `scan.csv` and `cloud.csv` into a folder, and returns the model.
///
/// The scan's rows name the entity that they are asked of; the cloud is asked of the whole model. Every run writes the same
/// bytes.
pub(crate) fn make(folder: &Path) -> Outcome<Model> {
    let model = model()?;
    model.write(folder.join("workshop.ron"))?;
    fs::write(folder.join("scan.csv"), points::scan(&model))?;
    fs::write(folder.join("cloud.csv"), points::cloud(&model))?;
    Ok(model)
}

/// The workshop: a bench 1200 mm by 700 mm with things on it and over it. Millimetres.
pub(crate) fn model() -> Outcome<Model> {
    let mut model = Model::new();
    quadrics::bench(&mut model)?;
    dust_pan::add(&mut model)?;
    brush_handle::add(&mut model)?;
    curves::add(&mut model)?;
    quadrics::add(&mut model)?;
    made::add(&mut model)?;
    Ok(model)
}

/// Rounds to 1e-4 mm.
fn rounded(p: DVec3) -> DVec3 {
    (p * 1e4).round() / 1e4
}
