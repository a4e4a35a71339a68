//! Where points come from.

use std::fmt;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use crate::error::CommandError;
use crate::project::points::PointsError;

/// Where points come from. Shown as it is called in messages.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Source<'a> {
    StandardInput,
    File(&'a Path),
}

impl<'a> Source<'a> {
    pub(crate) fn of(path: &'a Path) -> Self {
        if path.as_os_str() == "-" { Self::StandardInput } else { Self::File(path) }
    }

    /// The bytes, and how many there are where that is known.
    pub(crate) fn open(self) -> Result<(Box<dyn Read>, Option<u64>), CommandError> {
        let path = match self {
            Self::StandardInput => return Ok((Box::new(io::stdin().lock()), None)),
            Self::File(path) => path,
        };
        let opened = File::open(path).and_then(|file| file.metadata().map(|metadata| (file, metadata)));
        let (file, metadata) = opened.map_err(|error| self.wrong(error.into()))?;
        if metadata.is_dir() {
            return Err(self.wrong(PointsError::Directory));
        }
        Ok((Box::new(file), metadata.is_file().then_some(metadata.len())))
    }

    pub(crate) fn wrong(self, problem: PointsError) -> CommandError {
        CommandError::Points { name: self.to_string(), problem }
    }
}

impl fmt::Display for Source<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::StandardInput => f.write_str("standard input"),
            Self::File(path) => path.display().fmt(f),
        }
    }
}
