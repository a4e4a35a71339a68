//! Instructions of single calls, counted by valgrind's tool callgrind: the same on a busy machine as on an idle one.
//!
//! A program runs itself under callgrind with arguments by which it makes the calls that it wants counted through [`counted`]; callgrind
//! counts inside that function alone.

use std::ffi::OsStr;
use std::path::Path;
use std::process::{Command, Stdio};

use crate::Failure;
use crate::corpus::corpora;

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
        .args(["--compress-strings=no", "--compress-pos=no"])
        .arg(format!("--toggle-collect={COUNTED}"))
        .arg(format!("--dump-after={COUNTED}"))
        .arg(format!("--callgrind-out-file={}", out.display()))
        .arg(program)
        .args(arguments)
        .stdin(Stdio::null());
    // a name is memory: its length moves what is asked for later, and that costs more or less. The program sees none that is another in
    // another folder.
    let path = std::env::var_os("PATH").unwrap_or_default();
    command.env_clear().env("PATH", path).env("PERPEND_CORPUS", ".").current_dir(corpora());
    let done = command.output().map_err(|error| format!("valgrind: {error}; it is a package of its own name"))?;
    if !done.status.success() {
        return Err(format!("valgrind: {}\n{}", done.status, String::from_utf8_lossy(&done.stderr)).into());
    }
    let parts = 1..;
    let counts = parts.map(|part| out.with_extension(part.to_string())).take_while(|file| file.is_file());
    counts.map(|file| total(&file)).collect()
}

/// The self costs of a file of callgrind, without those of the allocator: what asking for memory costs depends on all that was asked for before,
/// in the program's setup, too. Copying and clearing count.
fn total(file: &Path) -> Result<u64, Failure> {
    let text = std::fs::read_to_string(file)?;
    let mut sum = 0;
    let (mut is_library, mut is_memory, mut is_call) = (false, false, false);
    for line in text.lines() {
        if let Some(object) = line.strip_prefix("ob=") {
            is_library = object.contains("/libc.so");
        } else if let Some(function) = line.strip_prefix("fn=") {
            is_memory = function.starts_with("__mem");
        } else if line.starts_with("calls=") {
            is_call = true;
        } else if line.starts_with(|c: char| c.is_ascii_digit()) {
            // a line number and its cost; after a call, that of the callee
            let cost = line.split(' ').nth(1).ok_or_else(|| format!("{}: no cost: {line}", file.display()))?;
            if !is_call && (!is_library || is_memory) {
                sum += cost.parse::<u64>()?;
            }
            is_call = false;
        }
    }
    Ok(sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn self_costs_are_summed_without_callees_and_the_allocator() {
        let text = "totals: 99\n\nob=/bin/own\nfl=a.rs\nfn=own\n5 10\ncob=/lib/libc.so.6\ncfn=malloc\ncalls=1 0\n5 40\n6 3\n\n\
            ob=/lib/libc.so.6\nfl=???\nfn=malloc\n0 40\n\nfn=__memcpy_avx\n0 7\n";
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("calls.1");
        std::fs::write(&file, text).expect("written");
        assert_eq!(total(&file).expect("read"), 20);
    }
}
