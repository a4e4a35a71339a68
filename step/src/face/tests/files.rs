//! Every face of the real STEP files is built from what the file says, and the areas are those of another kernel.
//!
//! The models lie outside the repository, as for the comparison face by face.

#![allow(clippy::print_stderr, reason = "a test that skips says so aloud; the counts are wanted by readers")]

use perpend::kernel::{PlaneCurve, TrimLoopData, Trimming, TrimmingData};

use super::area::area;
use super::corpus::real;
use crate::face::{BuiltFace, build, edge_curve};
use crate::{ReadOptions, read_file};

/// Names and files.
fn models() -> Vec<(String, std::path::PathBuf)> {
    let Ok(folders) = std::fs::read_dir(real()) else { return Vec::new() };
    let mut models: Vec<_> = folders
        .filter_map(|folder| {
            let folder = folder.ok()?.path();
            let file = ["original.step", "original.stp"]
                .map(|name| folder.join(name))
                .into_iter()
                .find(|file| file.is_file())?;
            Some((folder.file_name()?.to_string_lossy().into_owned(), file))
        })
        .collect();
    models.sort();
    models
}

/// The area of a face whose trim a model accepts.
fn area_of(built: &BuiltFace) -> Result<f64, String> {
    let loops = built
        .loops
        .iter()
        .map(|one| TrimLoopData {
            outer: one.outer,
            curves: one.curves.iter().map(|(curve, _)| curve.clone()).collect(),
        })
        .collect();
    let data = TrimmingData { reversed: built.reversed, tolerance: built.tolerance, loops };
    let (trimming, _) = Trimming::enter(data, &built.surface).map_err(|error| error.to_string())?;
    let curves: Vec<Vec<PlaneCurve>> =
        trimming.loops().iter().map(|one| one.curves.iter().map(|curve| curve.curve.clone()).collect()).collect();
    Ok(area(&built.surface, &curves))
}

#[test]
fn every_face_of_the_real_files_is_built() {
    let models = models();
    if models.is_empty() {
        eprintln!("skipped: {} is absent", real().display());
        return;
    }
    let mut lost = Vec::new();
    for (name, file) in models {
        let part = read_file(&file, &ReadOptions::default()).expect("the file is read");
        let start = std::time::Instant::now();
        let curves: Vec<_> = part.edges.iter().map(|edge| edge_curve(edge, part.tolerance)).collect();
        let built: Vec<_> = part.faces.iter().map(|face| build(face, &part.edges, &curves, part.tolerance)).collect();
        let time = start.elapsed();
        let before = lost.len();
        let mut areas = Vec::new();
        let mut worst = 0.0_f64;
        for (built, face) in built.iter().zip(&part.faces) {
            match built.as_ref().map_err(ToString::to_string).and_then(area_of) {
                Ok(area) => areas.push(area),
                Err(error) => lost.push(format!("{name} #{}: {error}", face.entity)),
            }
            worst = built.as_ref().map_or(worst, |built| worst.max(built.tolerance));
        }
        eprintln!(
            "{name}: {} of {} faces in {time:?}, tolerance {:e} stated, {worst:e} at most",
            part.faces.len() - (lost.len() - before),
            part.faces.len(),
            part.tolerance
        );
        let expected = super::corpus::areas(&file.with_file_name("corpus.json"));
        let (found, wanted): (f64, f64) = (areas.iter().sum(), expected.iter().sum());
        // the other kernel's integrals are off by up to 2e-3 on splines
        if (found - wanted).abs() > 2e-3 * wanted {
            lost.push(format!("{name}: {found} in all, {wanted} expected"));
        }
    }
    assert!(lost.is_empty(), "{}", lost.join("\n"));
}
