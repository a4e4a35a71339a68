//! On what the figures were measured, and how fast it is.

use std::hint::black_box;
use std::process::Command;
use std::time::Instant;

use perpend::{DVec3, NurbsSurface};

use crate::Failure;

/// Points of the calibration's net in each direction.
const NET: usize = 40;
/// Evaluations in one of its passes, and its passes; the median counts.
const EVALUATIONS: u32 = 20_000;
const PASSES: usize = 9;

/// The processor's model, as the system names it.
pub(crate) fn processor() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = text.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let model = model.map_or("unknown processor", |(_, name)| name.trim());
    format!("{model}, {threads} threads")
}

/// What a program prints, on one line; none where it cannot be run.
fn said(program: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).current_dir(env!("CARGO_MANIFEST_DIR")).output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().replace('\n', " "))
}

/// Today.
pub(crate) fn date() -> String {
    said("date", &["+%Y-%m-%d"]).unwrap_or_else(|| "unknown date".to_owned())
}

/// The commit of the sources, and whether they were changed since.
pub(crate) fn commit() -> String {
    let commit = said("git", &["rev-parse", "--short", "HEAD"]);
    let changed = said("git", &["status", "--porcelain", "--untracked-files=no"]);
    let mark = if changed.is_none_or(|changed| changed.is_empty()) { "" } else { ", changed since" };
    commit.map_or_else(|| "unknown commit".to_owned(), |commit| format!("commit {commit}{mark}"))
}

/// Microseconds of one evaluation of a bicubic surface of 40×40 control points with all first and second derivatives, at scattered parameters.
pub(crate) fn evaluation() -> Result<f64, Failure> {
    let knots = || {
        let inner = (1..NET - 3).map(|i| i as f64 / (NET - 3) as f64);
        [0.0; 4].into_iter().chain(inner).chain([1.0; 4]).collect::<Vec<f64>>()
    };
    let height = |i: usize, j: usize| 0.3 * (0.7 * i as f64).sin() * (0.5 * j as f64).cos();
    let row = |i| (0..NET).map(|j| DVec3::new(i as f64, j as f64, height(i, j))).collect();
    let surface = NurbsSurface::new((3, 3), (knots(), knots()), (0..NET).map(row).collect(), None)?;
    // multiples of the inverse powers of the plastic number fill the square evenly
    let at = |k: u32| [0.754_877_666_246_692_8, 0.569_840_290_998_053_3].map(|step: f64| (f64::from(k) * step).fract());
    let parameters: Vec<[f64; 2]> = (0..EVALUATIONS).map(at).collect();
    let mut out = [DVec3::ZERO; 9];
    let mut pass = || {
        let start = Instant::now();
        for [u, v] in &parameters {
            surface.derivatives(black_box(*u), black_box(*v), 2, &mut out);
            black_box(&out);
        }
        start.elapsed().as_secs_f64() * 1e6 / f64::from(EVALUATIONS)
    };
    let mut times: Vec<f64> = (0..PASSES).map(|_| pass()).collect();
    times.sort_by(f64::total_cmp);
    Ok(times[PASSES / 2])
}
