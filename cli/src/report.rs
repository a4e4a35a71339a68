//! Words to the user.

use std::fmt::Arguments;
use std::io::{self, Write};

use crate::error::CommandError;

/// Writes a line to standard error. Where nobody listens, there is nobody to tell.
pub(crate) fn say(line: Arguments<'_>) {
    let _ = writeln!(io::stderr().lock(), "{line}");
}

/// A number for people: six significant digits.
pub(crate) fn rounded(x: f64) -> String {
    format!("{x:.5e}").parse().map_or_else(|_| x.to_string(), |x: f64| format!("{x:?}"))
}

/// `1 point`, `2 points`.
pub(crate) fn counted(count: u64, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

/// Writes an answer to standard output.
pub(crate) fn answer(text: &[u8]) -> Result<(), CommandError> {
    let mut out = io::stdout().lock();
    out.write_all(text).and_then(|()| out.flush()).map_err(CommandError::StandardOutput)
}

/// Text of an input in a message: its beginning, on one line.
pub(crate) fn shown(field: &[u8]) -> String {
    const SHOWN: usize = 40;
    let text = String::from_utf8_lossy(field);
    let mut letters = text.chars().flat_map(|letter| {
        let is_plain = !letter.is_control();
        is_plain.then_some(letter).into_iter().chain(letter.escape_default().filter(move |_| !is_plain))
    });
    let start: String = letters.by_ref().take(SHOWN).collect();
    if letters.next().is_some() { start + "…" } else { start }
}
