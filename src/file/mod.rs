//! Models as RON files.

mod atomic;
mod data;
mod error;
mod layout;
mod outline;
mod syntax;

use std::fs;
use std::io::{self, Write};
use std::path::Path;

pub use atomic::{AtomicFile, WriteError};
pub use error::{InvalidModel, ModelError, ReadError};

use crate::model::Model;
use crate::trust::Trust;

impl Model {
    /// Reads a model from a file.
    ///
    /// # Errors
    ///
    /// What is wrong, with the file, the line, and the entity where there is one: see [`ReadError`].
    pub fn read(path: impl AsRef<Path>) -> Result<Self, ReadError> {
        Self::read_with(path, Trust::Refuse)
    }

    /// As [`read`](Self::read), and says what happens to knowledge that is false.
    ///
    /// # Errors
    ///
    /// As [`read`](Self::read).
    pub fn read_with(path: impl AsRef<Path>, trust: Trust) -> Result<Self, ReadError> {
        let path = path.as_ref();
        let failed = |source| ReadError::Io { path: path.to_owned(), source };
        if fs::metadata(path).map_err(failed)?.is_dir() {
            return Err(ReadError::Directory { path: path.to_owned() });
        }
        let bytes = fs::read(path).map_err(failed)?;
        let text = String::from_utf8(bytes).map_err(|error| {
            let at = error.utf8_error().valid_up_to();
            let line = 1 + error.as_bytes()[..at].iter().filter(|byte| **byte == b'\n').count();
            ReadError::NotText { path: path.to_owned(), line }
        })?;
        Self::from_ron_with(&text, trust)
            .map_err(|source| ReadError::Model { path: path.to_owned(), source: source.into() })
    }

    /// Reads a model from the text of a file.
    ///
    /// # Errors
    ///
    /// What is wrong, with the line, and the entity where there is one: see [`ModelError`].
    pub fn from_ron(text: &str) -> Result<Self, ModelError> {
        Self::from_ron_with(text, Trust::Refuse)
    }

    /// As [`from_ron`](Self::from_ron), and says what happens to knowledge that is false.
    ///
    /// # Errors
    ///
    /// As [`from_ron`](Self::from_ron).
    pub fn from_ron_with(text: &str, trust: Trust) -> Result<Self, ModelError> {
        data::read(text, trust)
    }

    /// Writes the model to a file, whole or not at all: whatever happens, the path holds the old file or the new one.
    ///
    /// Floats are written so that they read back bit for bit; one model always gives the same bytes.
    ///
    /// # Errors
    ///
    /// What failed; the old file is as it was.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), WriteError> {
        let mut file = AtomicFile::create(path)?;
        match self.write_ron(&mut file) {
            Ok(()) => file.commit(),
            Err(source) => Err(file.failed(source)),
        }
    }

    /// The text of the model's file.
    #[must_use]
    pub fn to_ron(&self) -> String {
        let mut text = Vec::new();
        self.write_ron(&mut text).expect("memory takes all that is written to it");
        String::from_utf8(text).expect("RON is text")
    }

    /// Writes the text of the model's file.
    ///
    /// # Errors
    ///
    /// Those of the writer.
    pub fn write_ron(&self, out: impl Write) -> io::Result<()> {
        layout::write(self, out)
    }
}
