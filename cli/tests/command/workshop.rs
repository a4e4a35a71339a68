//! A folder to work in, and the command run in it.

use std::fs;
use std::io::Write as _;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

use tempfile::TempDir;

/// An edge along x from 0 to 4; a table of 4 by 4 at the height 10, its normal upwards; a rim of radius 1 in the plane z = 0
/// about (0, 20, 0).
pub(crate) const MODEL: &str = "\
Model(
    format: 1,
    entities: [
        (id: 1, name: \"edge\", definition: NurbsCurve(
            degree: 1, knots: [0.0, 0.0, 1.0, 1.0], control_points: [(0.0, 0.0, 0.0), (4.0, 0.0, 0.0)],
        )),
        (id: 2, name: \"table\", definition: NurbsSurface(
            degree: (1, 1), knots: ([0.0, 0.0, 1.0, 1.0], [0.0, 0.0, 1.0, 1.0]),
            control_points: [[(0.0, 0.0, 10.0), (0.0, 4.0, 10.0)], [(4.0, 0.0, 10.0), (4.0, 4.0, 10.0)]],
        )),
        (id: 7, name: \"rim\", definition: NurbsCurve(
            degree: 2, knots: [0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 2.0],
            control_points: [(1.0, 20.0, 0.0), (1.0, 22.0, 0.0), (-1.0, 20.0, 0.0), (-1.0, 18.0, 0.0), (1.0, 20.0, 0.0)],
            weights: Some([1.0, 0.0001, 1.0, 0.0001, 1.0]),
        )),
    ],
)
";

pub(crate) const ANSWER: &str = "entity,x,y,z,u,v,fx,fy,fz,distance,lower_bound,place,multiplicity,method";

/// A folder with a model, `model.ron`.
pub(crate) struct Workshop {
    folder: TempDir,
}

/// What a run gave.
pub(crate) struct Run {
    pub(crate) code: Option<i32>,
    pub(crate) out: String,
    pub(crate) err: String,
}

impl Workshop {
    pub(crate) fn new() -> Self {
        let workshop = Self { folder: tempfile::tempdir().unwrap() };
        workshop.write("model.ron", MODEL);
        workshop
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub(crate) fn write(&self, name: &str, text: impl AsRef<[u8]>) {
        fs::write(self.path(name), text).unwrap();
    }

    pub(crate) fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap()
    }

    /// The names of all files, hidden ones too.
    pub(crate) fn files(&self) -> Vec<String> {
        let entries = fs::read_dir(self.folder.path()).unwrap();
        let mut names: Vec<String> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    /// The command in this folder, not started.
    pub(crate) fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_perpend"));
        command.args(arguments).current_dir(self.folder.path()).stdin(Stdio::null());
        command
    }

    pub(crate) fn run(&self, arguments: &[&str]) -> Run {
        Run::of(&self.command(arguments).output().unwrap())
    }

    /// As `run`, with this on standard input.
    pub(crate) fn run_with(&self, arguments: &[&str], input: &[u8]) -> Run {
        let mut command = self.command(arguments);
        let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        child.stdin.take().unwrap().write_all(input).unwrap();
        Run::of(&child.wait_with_output().unwrap())
    }

    /// Projects these points, with these options.
    pub(crate) fn project(&self, points: impl AsRef<[u8]>, options: &[&str]) -> Run {
        self.write("points.csv", points);
        self.run(&[&["project", "model.ron", "points.csv"], options].concat())
    }
}

impl Run {
    pub(crate) fn of(output: &Output) -> Self {
        let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).expect("output is UTF-8");
        Self { code: output.status.code(), out: text(&output.stdout), err: text(&output.stderr) }
    }

    /// The fields of each row; none of these has quotes.
    pub(crate) fn rows(&self) -> Vec<Vec<&str>> {
        self.out.lines().map(|line| line.split(',').collect()).collect()
    }

    /// The field of a column in a row of answers, the first being 1.
    pub(crate) fn field(&self, row: usize, column: &str) -> &str {
        let rows = self.rows();
        let at = rows[0].iter().position(|name| *name == column).expect("a known column");
        rows[row][at]
    }

    pub(crate) fn number(&self, row: usize, column: &str) -> f64 {
        self.field(row, column).parse().expect("a number")
    }

    /// Fails unless the run ended with this code and said this on standard error.
    #[track_caller]
    pub(crate) fn ends(&self, code: i32, said: &str) -> &Self {
        assert_eq!(self.code, Some(code), "standard error:\n{}", self.err);
        assert!(self.err.contains(said), "expected on standard error:\n{said}\nfound:\n{}", self.err);
        self
    }
}
