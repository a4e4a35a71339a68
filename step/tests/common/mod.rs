//! The parts that nobody here wrote. They lie outside the repository: in `real` of the folder that the environment variable `PERPEND_SHARED` names, by
//! default `../shared` beside the workspace.

use std::path::{Path, PathBuf};

/// Their folder; where it is absent, says so.
#[expect(clippy::print_stderr, reason = "a test that skips says so aloud")]
pub(crate) fn real() -> Option<PathBuf> {
    let folder = std::env::var_os("PERPEND_SHARED")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared"), PathBuf::from)
        .join("real");
    if folder.is_dir() {
        return Some(folder);
    }
    eprintln!("skipped: {} is absent; PERPEND_SHARED names the folder that holds real/", folder.display());
    None
}
