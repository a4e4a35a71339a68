//! Where answers go.

use std::io::{self, StdoutLock, Write};
use std::path::Path;

use perpend::AtomicFile;

use crate::error::CommandError;

/// Where answers go.
pub(crate) enum Output {
    StandardOutput(StdoutLock<'static>),
    /// A file that appears when it is whole.
    File(AtomicFile),
}

impl Output {
    /// Standard output, or a file: that it can be written is known before the work starts.
    pub(crate) fn open(path: Option<&Path>) -> Result<Self, CommandError> {
        Ok(match path {
            None => Self::StandardOutput(io::stdout().lock()),
            Some(path) => Self::File(AtomicFile::create(path)?),
        })
    }

    /// Writes; on an error nothing more can be written, and the file is given up.
    pub(crate) fn write(self, text: &[u8]) -> Result<Self, CommandError> {
        match self {
            Self::StandardOutput(mut out) => match out.write_all(text) {
                Ok(()) => Ok(Self::StandardOutput(out)),
                Err(error) => Err(CommandError::StandardOutput(error)),
            },
            Self::File(mut file) => match file.write_all(text) {
                Ok(()) => Ok(Self::File(file)),
                Err(error) => Err(file.failed(error).into()),
            },
        }
    }

    /// Ends the output; a file takes its place.
    pub(crate) fn finish(self) -> Result<(), CommandError> {
        match self {
            Self::StandardOutput(mut out) => out.flush().map_err(CommandError::StandardOutput),
            Self::File(file) => Ok(file.commit()?),
        }
    }
}
