//! SISL, by `native/sisl.cpp`.

use std::path::PathBuf;

use perpend::DVec3;

use super::native::{Library, Native};
use crate::Failure;
use crate::case::{Case, Set};
use crate::contender::{Contender, Entrant, Pace};

const LIBRARY: Library = Library {
    source: "sisl.cpp",
    header: "sisl.h",
    folders: &["/usr/include", "/usr/local/include"],
    links: &["-lsisl"],
    package: "libsisl-dev",
};

/// A way of asking it.
struct Sisl {
    program: PathBuf,
    name: &'static str,
    method: &'static str,
    pace: Pace,
}

pub(super) fn contenders() -> Result<Vec<Box<dyn Contender>>, String> {
    let program = LIBRARY.compile()?;
    let rows =
        [("SISL s1953/s1954 (global)", "global", Pace::Thinned), ("SISL s1957/s1958 (local)", "local", Pace::All)];
    let contender =
        |(name, method, pace)| Box::new(Sisl { program: program.clone(), name, method, pace }) as Box<dyn Contender>;
    Ok(rows.map(contender).into())
}

impl Contender for Sisl {
    fn name(&self) -> String {
        self.name.to_owned()
    }

    fn pace(&self, _: Set) -> Pace {
        self.pace
    }

    fn enter(&self, case: &Case, points: &[DVec3]) -> Result<Option<Box<dyn Entrant>>, Failure> {
        Ok(Some(Box::new(Native::new(&self.program, self.method, false, case, points)?)))
    }
}
