//! Instructions of single calls, counted by valgrind's tool callgrind: the same on a busy machine as on an idle one.
//!
//! A program runs itself under callgrind with arguments by which it makes the calls that it wants counted through [`counted`]; callgrind
//! counts inside that function alone.

use std::ffi::OsStr;
use std::path::Path;
use std::process::{Command, Stdio};

use crate::Failure;
use crate::corpus::{corpora, real_models};

/// [`counted`], as callgrind knows it. One function for all that is counted, by its whole path: of several, or of a pattern, callgrind counts
/// some and does not tell the calls apart.
const COUNTED: &str = "perpend_bench::callgrind::counted";

/// Makes a call whose instructions are counted.
#[inline(never)]
pub fn counted(call: &mut dyn FnMut()) {
    call();
}

/// The instructions of every counted call that this program makes when it is run with these arguments, in order.
///
/// # Errors
///
/// Where valgrind is absent or fails, or the program does.
pub fn instructions(arguments: &[&OsStr]) -> Result<Vec<u64>, Failure> {
    let folder = tempfile::tempdir()?;
    let out = folder.path().join("calls");
    let program = std::env::current_exe()?;
    let mut command = Command::new("valgrind");
    command
        .arg("--tool=callgrind")
        .arg(format!("--toggle-collect={COUNTED}"))
        .arg(format!("--dump-after={COUNTED}"))
        .arg(format!("--callgrind-out-file={}", out.display()))
        .arg(program)
        .args(arguments)
        .stdin(Stdio::null());
    // the environment lies on the stack, where its length moves what is measured
    let path = std::env::var_os("PATH").unwrap_or_default();
    command.env_clear().env("PATH", path).env("PERPEND_CORPUS", corpora()).env("PERPEND_REAL", real_models());
    let done = command.output().map_err(|error| format!("valgrind: {error}; it is a package of its own name"))?;
    if !done.status.success() {
        return Err(format!("valgrind: {}\n{}", done.status, String::from_utf8_lossy(&done.stderr)).into());
    }
    let parts = 1..;
    let counts = parts.map(|part| out.with_extension(part.to_string())).take_while(|file| file.is_file());
    counts.map(|file| total(&file)).collect()
}

/// The instructions that a file of callgrind sums up.
fn total(file: &Path) -> Result<u64, Failure> {
    let text = std::fs::read_to_string(file)?;
    let totals = text.lines().find_map(|line| line.strip_prefix("totals: "));
    Ok(totals.ok_or_else(|| format!("{}: no totals", file.display()))?.trim().parse()?)
}
