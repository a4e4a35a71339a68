//! The syntax of a file, read by the crate `step-io`.
//!
//! Its parser is one pass without look-ahead beyond one token; it bounds the nesting of lists and makes no room for counts that a file declares.

use std::collections::BTreeMap;
use std::io::{self, Read};
use std::sync::atomic::{AtomicBool, Ordering};

use step_io::parser::{self, RawEntity};

use super::error::ReadError;

/// Bytes that end where the reading is told to stop.
struct Stoppable<'a> {
    bytes: &'a [u8],
    stop: &'a AtomicBool,
}

impl Read for Stoppable<'_> {
    fn read(&mut self, room: &mut [u8]) -> io::Result<usize> {
        if self.stop.load(Ordering::Relaxed) {
            return Err(io::Error::other("the time is over"));
        }
        self.bytes.read(room)
    }
}

/// The entities of a file by their numbers.
pub(super) fn parse(bytes: &[u8], stop: &AtomicBool) -> Result<BTreeMap<u64, RawEntity>, ReadError> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let text = bytes.trim_ascii_start();
    // comments may stand before the first words
    if !text.starts_with(b"ISO-10303-21") && !text.starts_with(b"/*") {
        let start = String::from_utf8_lossy(&text[..text.len().min(16)]).into_owned();
        return Err(ReadError::NotStep { start });
    }
    match parser::parse(Stoppable { bytes, stop }) {
        Ok(graph) => Ok(graph.entities),
        Err(step_io::Error::UnexpectedEof { .. }) => {
            let line = bytes.iter().filter(|byte| **byte == b'\n').count() + 1;
            Err(ReadError::CutShort { line })
        }
        Err(step_io::Error::Io(error)) => Err(ReadError::Io(error)),
        Err(error) => Err(ReadError::Syntax { message: error.to_string() }),
    }
}
