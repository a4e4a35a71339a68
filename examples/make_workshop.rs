//! Makes the model and the points of the other examples: `workshop.ron`, `scan.csv` and `cloud.csv` beside this file.
//!
//! `cargo run --example make_workshop`, or with a folder of your own: `cargo run --example make_workshop -- FOLDER`.
#![allow(clippy::print_stdout, reason = "an example reports to its reader")]

mod workshop;

use std::path::{Path, PathBuf};

fn main() -> workshop::Outcome<()> {
    let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let folder = std::env::args_os().nth(1).map_or_else(beside, PathBuf::from);
    let model = workshop::make(&folder)?;
    println!("{}: {} entities, {:.0} mm across", folder.display(), model.len(), model.size());
    for entity in model.entities() {
        println!("{:>4}  {:<17} {}", entity.id(), entity.name(), entity.definition().kind());
    }
    Ok(())
}
