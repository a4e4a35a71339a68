//! The guard around the reading: a cap on the size, a limit of time, and failures of the reader as errors.

use std::fs::File;
use std::io::Read;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use super::error::ReadError;
use super::part;
use crate::source::SourcePart;

/// What reading a file may cost.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ReadOptions {
    /// The largest file that is read, in bytes. What is held of its text follows it: about ten times the file, and never more values than a
    /// quarter of this number. What is made of the text follows `max_pieces`.
    pub max_bytes: u64,
    /// How long reading may take.
    pub max_time: Duration,
    /// The most faces, loops, edges, uses of edges and control points that are kept of the file, and of all placed copies.
    pub max_pieces: u64,
}

impl Default for ReadOptions {
    /// 512 MiB, 60 seconds, 1.5 million pieces, which take about 1.7 GB as a model.
    fn default() -> Self {
        Self { max_bytes: 512 << 20, max_time: Duration::from_secs(60), max_pieces: 1_500_000 }
    }
}

/// The stack of the reading thread. References are followed at most [`MAX_DEPTH`](super::entities::MAX_DEPTH) deep, which needs a small part of it,
/// whatever the build.
const STACK: usize = 64 << 20;

/// Reads a STEP file of this name.
///
/// # Errors
///
/// As [`read`], or the file cannot be opened.
pub fn read_file(path: &Path, options: &ReadOptions) -> Result<SourcePart, ReadError> {
    read(read_bytes(path, options)?, options)
}

/// The bytes of a file, if it is not larger than allowed.
pub(crate) fn read_bytes(path: &Path, options: &ReadOptions) -> Result<Vec<u8>, ReadError> {
    let file = File::open(path)?;
    check_size(file.metadata()?.len(), options)?;
    let mut bytes = Vec::new();
    // one byte more than allowed, so that a file without a known length is refused too
    file.take(options.max_bytes.saturating_add(1)).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Reads the bytes of a STEP file.
///
/// What is not understood does not fail the reading: it is listed in [`SourcePart::not_understood`]. The work is done on a thread of its own;
/// where the time is over, that thread is told to stop and not waited for.
///
/// # Errors
///
/// The bytes are not a STEP file, break its syntax, or pass a limit of the options.
pub fn read(bytes: Vec<u8>, options: &ReadOptions) -> Result<SourcePart, ReadError> {
    check_size(bytes.len() as u64, options)?;
    check_values(&bytes, options)?;
    let stop = Arc::new(AtomicBool::new(false));
    let (sender, receiver) = channel();
    let (seen, max_pieces) = (Arc::clone(&stop), options.max_pieces);
    let reader = thread::Builder::new().name("perpend-step".to_owned()).stack_size(STACK).spawn(move || {
        // nobody listens any more where the time is over
        let _ = sender.send(part::read(&bytes, max_pieces, seen));
    })?;
    match receiver.recv_timeout(options.max_time) {
        Ok(read) => read,
        Err(RecvTimeoutError::Timeout) => {
            stop.store(true, Ordering::Relaxed);
            Err(ReadError::TooSlow { limit: options.max_time })
        }
        Err(RecvTimeoutError::Disconnected) => Err(ReadError::Failed { message: failure(reader.join().err()) }),
    }
}

fn check_size(bytes: u64, options: &ReadOptions) -> Result<(), ReadError> {
    if bytes > options.max_bytes {
        return Err(ReadError::TooLarge { bytes, limit: options.max_bytes });
    }
    Ok(())
}

/// Every value but the first of a list follows a comma, and takes far more memory than the comma does.
fn check_values(bytes: &[u8], options: &ReadOptions) -> Result<(), ReadError> {
    let values = bytes.iter().filter(|byte| **byte == b',').count() as u64;
    let limit = options.max_bytes / 4;
    if values > limit {
        return Err(ReadError::TooManyValues { values, limit });
    }
    Ok(())
}

/// What a panic said.
fn failure(panic: Option<Box<dyn std::any::Any + Send>>) -> String {
    let Some(panic) = panic else { return "it gave no answer".to_owned() };
    match panic.downcast::<String>() {
        Ok(message) => *message,
        Err(panic) => panic.downcast_ref::<&str>().map_or_else(|| "it gave no reason".to_owned(), ToString::to_string),
    }
}
