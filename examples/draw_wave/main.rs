//! Draws what the wave solver prepares and does, from its own data: `wave-surfaces.svg`, `wave-cells.svg` and `wave-search.svg`, after Figs. 4 to 6
//! of Piegl et al. 2008.
//!
//! `cargo run --example draw_wave` writes them into `docs/`; `cargo run --example draw_wave -- FOLDER` elsewhere.
#![allow(clippy::print_stdout, reason = "an example reports to its reader")]

mod picture;
mod svg;

use std::error::Error;
use std::path::{Path, PathBuf};

use perpend::Model;

fn main() -> Result<(), Box<dyn Error>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = std::env::args_os().nth(1).map_or_else(|| root.join("docs"), PathBuf::from);
    let model = Model::read(root.join("examples/workshop.ron"))?;
    for (name, picture) in picture::all(&model)? {
        let file = folder.join(name);
        std::fs::write(&file, picture)?;
        println!("{}", file.display());
    }
    Ok(())
}
