//! Makes a part and a scan of it: `bracket.ron` and `bracket.csv` beside this file.
//!
//! `cargo run --example make_bracket`, or with a folder of your own: `cargo run --example make_bracket -- FOLDER`.
#![allow(clippy::print_stdout, reason = "an example reports to its reader")]

mod bracket;

use std::path::{Path, PathBuf};

fn main() -> bracket::Outcome<()> {
    let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let folder = std::env::args_os().nth(1).map_or_else(beside, PathBuf::from);
    let model = bracket::make(&folder)?;
    for body in model.bodies() {
        println!("{}: body {} {:?}, {} faces", folder.display(), body.id(), body.name(), body.faces().count());
    }
    Ok(())
}
