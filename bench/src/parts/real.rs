//! Parts that nobody here wrote: the STEP files of the models from outside, imported, with a scan of each.

use std::path::{Path, PathBuf};

use glam::DVec3;
use perpend::Model;
use perpend_bench::{Failure, points, real_models};
use perpend_step::{ReadOptions, import_file};

/// A part that was imported.
pub(crate) struct RealPart {
    pub name: String,
    /// Its STEP file.
    pub file: PathBuf,
    pub model: Model,
    pub faces: usize,
    pub known_faces: usize,
    pub bodies: usize,
    /// How much of the file was not understood.
    pub left_out: usize,
    /// Points about it, in their order.
    pub points: Vec<DVec3>,
}

/// The parts whose name holds `wanted`, in the order of their names.
pub(crate) fn parts(wanted: &str) -> Result<Vec<RealPart>, Failure> {
    let entries = std::fs::read_dir(real_models()).into_iter().flatten().flatten();
    let mut folders: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    folders.sort();
    let mut parts = Vec::new();
    for folder in folders {
        let name = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if let Some(file) = step_file(&folder).filter(|_| name.contains(wanted)) {
            parts.push(part(name, file, &folder.join("scan.csv"))?);
        }
    }
    Ok(parts)
}

/// What to do where there are none.
pub(crate) fn remedy() -> String {
    format!("{} holds none; the environment variable PERPEND_REAL names their folder", real_models().display())
}

fn step_file(folder: &Path) -> Option<PathBuf> {
    ["original.step", "original.stp"].map(|name| folder.join(name)).into_iter().find(|file| file.is_file())
}

fn part(name: String, file: PathBuf, scan: &Path) -> Result<RealPart, Failure> {
    let import = import_file(&file, &ReadOptions::default()).map_err(|error| format!("{name}: {error}"))?;
    let points = points(scan)?.into_iter().map(|(_, point)| point).collect();
    Ok(RealPart {
        name,
        file,
        faces: import.faces,
        known_faces: import.known_faces,
        bodies: import.bodies,
        left_out: import.not_understood.len(),
        model: import.model,
        points,
    })
}
