//! Files that are written whole or not at all.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

/// Why a file was not written. What the path held before is as it was.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WriteError {
    /// The path is a directory.
    #[error("cannot write {}: it is a directory; name a file in it", path.display())]
    Directory {
        /// The path.
        path: PathBuf,
    },
    /// The folder that is to hold the file does not exist.
    #[error("cannot write {}: there is no folder {}; create it first", path.display(), folder.display())]
    NoFolder {
        /// The file.
        path: PathBuf,
        /// The folder.
        folder: PathBuf,
    },
    /// The file may not be changed.
    #[error("cannot write {}: it is read-only; make it writable or name another file", path.display())]
    ReadOnly {
        /// The file.
        path: PathBuf,
    },
    /// The system refused.
    #[error("cannot write {}: {source}; what it held before is as it was", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
}

/// A file under way. Until [`commit`](Self::commit), what its path held before is as it was; dropped without it, nothing
/// remains.
///
/// It is written to a temporary file in the same folder, `.NAME.PID-N.tmp`, which takes the place of the old one when all of
/// it is on the disk. Where the path is a symbolic link, the file that it points to is replaced and the link stays; an
/// existing file's permissions are kept. What is no file (a terminal, a pipe) cannot be replaced and is written directly.
#[derive(Debug)]
pub struct AtomicFile {
    /// What the caller named, for messages.
    path: PathBuf,
    /// The file behind links.
    target: PathBuf,
    /// None: the target is written directly, or the temporary file has taken its place.
    temporary: Option<PathBuf>,
    out: BufWriter<File>,
}

impl AtomicFile {
    /// Begins a file.
    ///
    /// # Errors
    ///
    /// A directory, a folder that does not exist, a read-only file, or what the system refuses.
    pub fn create(path: impl AsRef<Path>) -> Result<Self, WriteError> {
        let path = path.as_ref().to_owned();
        let failed = |source| WriteError::Io { path: path.clone(), source };
        let target = behind_links(&path).map_err(failed)?;
        let old = match fs::metadata(&target) {
            Ok(metadata) => Some(metadata),
            Err(error) if error.kind() == io::ErrorKind::NotFound => None,
            Err(error) => return Err(failed(error)),
        };
        if let Some(old) = &old {
            if old.is_dir() {
                return Err(WriteError::Directory { path });
            }
            if old.permissions().readonly() {
                return Err(WriteError::ReadOnly { path });
            }
            if !old.is_file() {
                let out = BufWriter::new(OpenOptions::new().write(true).open(&target).map_err(failed)?);
                return Ok(Self { path, target, temporary: None, out });
            }
        }
        let folder = folder(&target);
        if !folder.is_dir() {
            let folder = folder.to_owned();
            return Err(WriteError::NoFolder { path, folder });
        }
        let (temporary, file) = temporary(&target).map_err(failed)?;
        let file = Self { path: path.clone(), target, temporary: Some(temporary), out: BufWriter::new(file) };
        if let Some(old) = old {
            file.out.get_ref().set_permissions(old.permissions()).map_err(failed)?;
        }
        Ok(file)
    }

    /// Puts the file in its place, when all of it is on the disk.
    ///
    /// # Errors
    ///
    /// What the system refuses; what the path held before is as it was.
    pub fn commit(mut self) -> Result<(), WriteError> {
        let result = self.finish();
        result.map_err(|source| self.failed(source))
    }

    /// The error of this file for one of its writer; the file is given up.
    #[must_use]
    pub fn failed(self, source: io::Error) -> WriteError {
        WriteError::Io { path: self.path.clone(), source }
    }

    fn finish(&mut self) -> io::Result<()> {
        self.out.flush()?;
        let Some(temporary) = &self.temporary else {
            return Ok(());
        };
        self.out.get_ref().sync_all()?;
        fs::rename(temporary, &self.target)?;
        self.temporary = None;
        sync_folder(folder(&self.target))
    }
}

impl Write for AtomicFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.out.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

impl Drop for AtomicFile {
    fn drop(&mut self) {
        if let Some(temporary) = &self.temporary {
            // Nobody is left to tell if even that fails.
            let _ = fs::remove_file(temporary);
        }
    }
}

/// The folder that holds a file.
fn folder(file: &Path) -> &Path {
    match file.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// The path behind symbolic links, also where nothing exists there.
fn behind_links(path: &Path) -> io::Result<PathBuf> {
    let mut target = path.to_owned();
    // as many links as Linux follows
    for _ in 0..40 {
        match fs::read_link(&target) {
            Ok(link) => target = folder(&target).join(link),
            // no link, or nothing there
            Err(_) => return Ok(target),
        }
    }
    Err(io::Error::other("too many symbolic links follow each other"))
}

/// A new file beside `target`.
fn temporary(target: &Path) -> io::Result<(PathBuf, File)> {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    let name = target.file_name().ok_or_else(|| io::Error::other("the path names no file"))?;
    loop {
        let mut hidden = std::ffi::OsString::from(".");
        hidden.push(name);
        hidden.push(format!(".{}-{}.tmp", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed)));
        let path = target.with_file_name(hidden);
        match OpenOptions::new().write(true).create_new(true).open(&path) {
            // left by a process that died and had the same number
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            result => return result.map(|file| (path, file)),
        }
    }
}

/// A rename lasts when its folder is on the disk.
#[cfg(unix)]
fn sync_folder(folder: &Path) -> io::Result<()> {
    File::open(folder)?.sync_all()
}

#[cfg(not(unix))]
fn sync_folder(_: &Path) -> io::Result<()> {
    Ok(())
}
