//! Why a file cannot be read at all.

use std::time::Duration;

/// Why a file cannot be read at all: what, where, and how to mend it.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The file could not be opened or read.
    #[error("the file cannot be read: {0}")]
    Io(#[from] std::io::Error),
    /// The file is larger than [`ReadOptions::max_bytes`](crate::ReadOptions::max_bytes).
    #[error(
        "the file has {bytes} bytes, more than the {limit} that are allowed: raise the limit, or export fewer parts"
    )]
    TooLarge {
        /// Bytes of the file.
        bytes: u64,
        /// Bytes that are allowed.
        limit: u64,
    },
    /// The file holds more values than a file of the largest allowed size has.
    #[error(
        "the file holds {values} values, more than the {limit} that are allowed: raise the limit of its size, which they follow"
    )]
    TooManyValues {
        /// Values in the file.
        values: u64,
        /// Values that are allowed.
        limit: u64,
    },
    /// The file does not begin as a STEP file does.
    #[error(
        "this is no STEP file: it begins with {start:?} and not with \"ISO-10303-21;\"; unpack it if it is compressed"
    )]
    NotStep {
        /// Its first characters.
        start: String,
    },
    /// The file ends within its data.
    #[error("the file ends in line {line}, before its data do: it was cut short; get a whole copy")]
    CutShort {
        /// The number of its last line.
        line: usize,
    },
    /// The text breaks the rules of ISO 10303-21.
    #[error("{message}; mend the file there, or have it written anew")]
    Syntax {
        /// What was found where, by line and column.
        message: String,
    },
    /// Reading took longer than [`ReadOptions::max_time`](crate::ReadOptions::max_time).
    #[error("reading was given up after {limit:?}: raise the limit of time, or export fewer parts")]
    TooSlow {
        /// The time that is allowed.
        limit: Duration,
    },
    /// References multiply the content of the file beyond measure.
    #[error(
        "#{entity}: the file uses its own entities so often that it grows beyond {limit} pieces: it is damaged, or export fewer parts"
    )]
    TooManyCopies {
        /// The entity at which the limit was passed.
        entity: u64,
        /// Pieces that are allowed.
        limit: u64,
    },
    /// The reader failed on this file.
    #[error(
        "the STEP reader failed on this file ({message}): report the file, and have it written anew by another program"
    )]
    Failed {
        /// What it said.
        message: String,
    },
}
