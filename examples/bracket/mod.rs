//! A bracket, and a scan of one that was made not quite like it. Millimetres.

mod builder;
mod part;
#[path = "../workshop/random.rs"]
mod random;
mod scan;

use std::error::Error;
use std::fs;
use std::path::Path;

use perpend::Model;

pub(crate) use part::model;
pub(crate) use scan::scan;

/// What is made, or why it was not.
pub(crate) type Outcome<T> = Result<T, Box<dyn Error>>;

/// Writes `bracket.ron` and `bracket.csv` into a folder, and returns the model. Every run writes the same bytes.
pub(crate) fn make(folder: &Path) -> Outcome<Model> {
    let model = model()?;
    model.write(folder.join("bracket.ron"))?;
    fs::write(folder.join("bracket.csv"), scan(&model))?;
    Ok(model)
}
