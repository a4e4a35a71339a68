//! Rivals written in C++: a program of this folder, compiled where its library is installed, and spoken to as a child process.
//!
//! `native/serve.hpp` says what is spoken.

use std::fmt::Write as _;
use std::io::{BufRead, BufReader, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use perpend::{DVec3, Definition, Direction, Parameter};

use crate::Failure;
use crate::case::Case;
use crate::contender::{Answer, Entrant, Own};

/// A library of the system.
pub(super) struct Library {
    /// The program's source, in `native`.
    pub(super) source: &'static str,
    /// A header that is there where the library is, and the folders in which to look for it.
    pub(super) header: &'static str,
    pub(super) folders: &'static [&'static str],
    /// What is linked.
    pub(super) links: &'static [&'static str],
    /// The package that brings it.
    pub(super) package: &'static str,
}

impl Library {
    /// Compiles the program; gives the path of what can be run.
    ///
    /// # Errors
    ///
    /// What is missing and how to get it, or what the compiler says.
    pub(super) fn compile(&self) -> Result<PathBuf, String> {
        let is_here = |folder: &&&str| Path::new(folder).join(self.header).exists();
        let remedy = format!("apt-get install {} g++", self.package);
        let folder = self.folders.iter().find(is_here).ok_or_else(|| format!("not installed: {remedy}"))?;
        let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("native").join(self.source);
        let program = work_folder().map_err(|error| error.to_string())?.join(self.source).with_extension("run");
        let mut compiler = Command::new("c++");
        compiler.args(["-std=c++17", "-O2", "-w", "-I", folder]).arg("-o").args([&program, &source]);
        let said = compiler.args(self.links).output().map_err(|error| format!("no c++ ({error}): {remedy}"))?;
        if said.status.success() {
            return Ok(program);
        }
        let text = String::from_utf8_lossy(&said.stderr);
        let error = text.lines().find(|line| line.contains("error")).unwrap_or("no reason given");
        Err(format!("{} was not compiled: {error}", source.display()))
    }
}

/// Where compiled programs and the entities' files are put: beside this program.
fn work_folder() -> std::io::Result<PathBuf> {
    let mut folder = std::env::current_exe()?;
    folder.set_file_name("perpend-compare-native");
    std::fs::create_dir_all(&folder)?;
    Ok(folder)
}

/// A child that was given one entity.
pub(super) struct Native {
    program: PathBuf,
    method: &'static str,
    /// Whether its parameters are those of the definition.
    has_own_parameters: bool,
    is_surface: bool,
    file: PathBuf,
    process: Option<Process>,
    /// Rows at which it died.
    skipped: Vec<usize>,
    setup: Duration,
    heap: u64,
}

struct Process {
    child: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
}

impl Process {
    /// The next line without its end; none where the child has gone.
    fn line(&mut self) -> Result<Option<String>, Failure> {
        let mut line = String::new();
        // a last line without an end was cut short
        let is_whole = self.output.read_line(&mut line)? > 0 && line.ends_with('\n');
        Ok(is_whole.then(|| line.trim_end().to_owned()))
    }
}

impl Native {
    /// A child for an entity and its points; it is started when it is judged.
    ///
    /// # Errors
    ///
    /// A file that cannot be written.
    pub(super) fn new(
        program: &Path,
        method: &'static str,
        has_own_parameters: bool,
        case: &Case,
        points: &[DVec3],
    ) -> Result<Self, Failure> {
        static FILES: AtomicUsize = AtomicUsize::new(0);
        let number = FILES.fetch_add(1, Ordering::Relaxed);
        let file = work_folder()?.join(format!("{}-{number}.txt", std::process::id()));
        std::fs::write(&file, written(case, points))?;
        Ok(Self {
            program: program.to_owned(),
            method,
            has_own_parameters,
            is_surface: matches!(*case.definition, Definition::NurbsSurface(_)),
            file,
            process: None,
            skipped: Vec::new(),
            setup: Duration::ZERO,
            heap: 0,
        })
    }

    fn start(&self, from: usize) -> Result<Process, Failure> {
        let mut command = Command::new(&self.program);
        command.arg(self.method).arg(&self.file).args(["--from", &from.to_string()]);
        for row in &self.skipped {
            command.args(["--skip", &row.to_string()]);
        }
        // what a library says before it aborts would stand between the tables
        let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null()).spawn()?;
        let (input, output) = (child.stdin.take(), child.stdout.take());
        let (Some(input), Some(output)) = (input, output) else { return Err("a child without its pipes".into()) };
        Ok(Process { child, input, output: BufReader::new(output) })
    }

    /// Reads answers from row `from` on until the child is done, or dies: then at which row.
    fn listen(
        &mut self,
        process: &mut Process,
        from: usize,
        answers: &mut [Option<Answer>],
    ) -> Result<Option<usize>, Failure> {
        let mut row = from;
        while let Some(line) = process.line()? {
            let words: Vec<&str> = line.split(' ').collect();
            match words.as_slice() {
                ["setup", time, heap] => {
                    self.setup = Duration::from_nanos(time.parse()?);
                    self.heap = heap.parse()?;
                }
                ["answer", distance, u, v] => {
                    let (u, v) = (u.parse()?, v.parse()?);
                    let at = if self.is_surface { Parameter::Surface(u, v) } else { Parameter::Curve(u) };
                    let parameter = (!self.has_own_parameters).then_some(at);
                    answers[row] = Some(Answer { distance: distance.parse()?, parameter, lower_bound: None });
                    row += 1;
                }
                ["none"] => row += 1,
                ["done"] => return Ok(None),
                _ => return Err(format!("{} says {line:?}", self.program.display()).into()),
            }
        }
        Ok(Some(row))
    }
}

impl Entrant for Native {
    fn judge(&mut self, points: &[DVec3], answers: &mut [Option<Answer>]) -> Result<(), Failure> {
        let mut from = 0;
        loop {
            let mut process = self.start(from)?;
            let died_at = self.listen(&mut process, from, answers)?;
            let Some(row) = died_at else {
                self.process = Some(process);
                return Ok(());
            };
            let status = process.child.wait()?;
            let method = self.method;
            if status.code().is_some() || row >= points.len() {
                return Err(format!("{} {method} ended at row {row}: {status}", self.program.display()).into());
            }
            self.skipped.push(row);
            from = row + 1;
        }
    }

    fn pass(&mut self, _: &[DVec3], stride: usize) -> Result<Duration, Failure> {
        let process = self.process.as_mut().ok_or("a child is judged before it is timed")?;
        writeln!(process.input, "pass {stride}")?;
        let line = process.line()?;
        let time = line.as_deref().and_then(|line| line.strip_prefix("pass "));
        let time = time.ok_or_else(|| format!("{} died while it was timed", self.program.display()))?;
        Ok(Duration::from_nanos(time.parse()?))
    }

    fn own(&self) -> Own {
        Own { setup: Some(self.setup), heap: Some(self.heap), aborted: self.skipped.len(), ..Own::default() }
    }
}

impl Drop for Native {
    fn drop(&mut self) {
        if let Some(Process { mut child, input, .. }) = self.process.take() {
            // the end of its input ends it
            drop(input);
            let _status = child.wait();
        }
        let _removed = std::fs::remove_file(&self.file);
    }
}

/// The entity and its points as `native/serve.hpp` reads them.
fn written(case: &Case, points: &[DVec3]) -> String {
    let (definition, mut text) = (&*case.definition, String::new());
    let (degree, knots, shape) = match definition {
        Definition::NurbsCurve(curve) => {
            ((curve.degree(), 0), [curve.knots().as_slice(), &[]], (curve.control_points().len(), 1))
        }
        Definition::NurbsSurface(surface) => {
            let knots = [Direction::U, Direction::V].map(|d| surface.knots(d).as_slice());
            (surface.degree(), knots, (surface.rows(), surface.columns()))
        }
    };
    let mut say = |line: std::fmt::Arguments| {
        let _always_succeeds = text.write_fmt(line);
    };
    let kind = if matches!(definition, Definition::NurbsSurface(_)) { "surface" } else { "curve" };
    say(format_args!("{kind} {} {:?}\n", u8::from(definition.weights().is_some()), definition.size()));
    say(format_args!("{} {} {} {}\n", degree.0, degree.1, shape.0, shape.1));
    for knots in knots {
        say(format_args!("{}{}\n", knots.len(), list(knots)));
    }
    for (i, p) in definition.control_points().iter().enumerate() {
        let weight = definition.weights().map_or(1.0, |weights| weights[i]);
        say(format_args!("{:?} {:?} {:?} {weight:?}\n", p.x, p.y, p.z));
    }
    match &case.shape {
        None => say(format_args!("none{}\n0\n", list(&[0.0; 9]))),
        Some(shape) => {
            let frame = [shape.origin, shape.axis, shape.x_direction].map(|p| p.to_array()).concat();
            say(format_args!("{}{}\n{}{}\n", shape.kind, list(&frame), shape.numbers.len(), list(&shape.numbers)));
        }
    }
    say(format_args!("{}\n", points.len()));
    for p in points {
        say(format_args!("{:?} {:?} {:?}\n", p.x, p.y, p.z));
    }
    text
}

/// Numbers with a blank before each; they are read as the same bits.
fn list(numbers: &[f64]) -> String {
    numbers.iter().map(|number| format!(" {number:?}")).collect()
}
