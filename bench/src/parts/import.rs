//! What the import of a STEP file costs.

use std::path::Path;
use std::process::Command;

use perpend_bench::Failure;
use perpend_step::{ReadOptions, import};

use crate::Run;
use crate::table::{Goal, Table};
use crate::timing::least_seconds;

/// Seconds that an import may take, a face.
const SECONDS_A_FACE: f64 = 2.0 / 500.0;

/// Bytes of a mebibyte.
const MEBI: f64 = 1_048_576.0;

pub(crate) fn measure(run: &Run, table: &mut Table) -> Result<(), Failure> {
    table.heading(
        "import of STEP files, all cores; memory of a process that does nothing else, the file itself included",
    );
    for part in &run.parts {
        let bytes = std::fs::read(&part.file)?;
        let [seconds] = least_seconds(
            run.passes,
            [&mut || {
                std::hint::black_box(import(bytes.clone(), &ReadOptions::default()).is_ok());
            }],
        );
        let (name, faces) = (&part.name, part.faces as f64);
        let size = bytes.len() as f64 / MEBI;
        let counts = format!("{} faces, {} known, {} bodies", part.faces, part.known_faces, part.bodies);
        // a file of few faces is not asked to be quicker than one of fifty
        let goal = Goal::Time(SECONDS_A_FACE * faces.max(50.0));
        table.line(format!("{name}, {size:.2} MiB, {counts}"), goal, "s", seconds);
        table.line("  a face", Goal::None, "ms", seconds * 1e3 / faces);
        table.line("  not understood", Goal::AtMost(0.0), "", part.left_out as f64);
        let memory = grown(&part.file)?;
        table.line("  memory at its peak", Goal::None, "MiB", memory);
        table.line("  memory at its peak, a byte of the file", Goal::None, "bytes", memory / size);
    }
    Ok(())
}

/// By how many mebibytes the memory of a process grows that imports a file and does nothing else.
fn grown(file: &Path) -> Result<f64, Failure> {
    let output = Command::new(std::env::current_exe()?).arg("--import-alone").arg(file).output()?;
    let printed = String::from_utf8(output.stdout)?;
    Ok(printed.trim().parse().map_err(|_| format!("memory cannot be measured here: {printed}"))?)
}

/// Imports a file and prints by how many mebibytes the largest memory so far grew.
pub(crate) fn alone(file: &Path) -> Result<(), Failure> {
    let before = peak()?;
    let import = import(std::fs::read(file)?, &ReadOptions::default())?;
    println!("{}", (peak()? - before) / 1024.0);
    drop(import);
    Ok(())
}

/// The largest memory of this process so far, in kibibytes.
fn peak() -> Result<f64, Failure> {
    let status = std::fs::read_to_string("/proc/self/status")?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).ok_or("no VmHWM in /proc/self/status")?;
    Ok(line.trim().trim_end_matches("kB").trim().parse()?)
}
