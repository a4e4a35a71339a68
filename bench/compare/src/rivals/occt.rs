//! OpenCASCADE, by `native/occt.cpp`.

use std::path::PathBuf;

use perpend::DVec3;

use super::native::{Library, Native};
use crate::Failure;
use crate::case::{Case, Set};
use crate::contender::{Contender, Entrant, Pace};

/// The name of the row on its own surface of the shape, with the edges.
pub(crate) const ELEMENTARY: &str = "OCCT's own shape, GeomAPI, edges";
/// The same without edges.
pub(crate) const ELEMENTARY_BARE: &str = "OCCT's own shape, GeomAPI alone";

const LIBRARY: Library = Library {
    source: "occt.cpp",
    header: "GeomAPI_ProjectPointOnSurf.hxx",
    folders: &["/usr/include/opencascade", "/usr/local/include/opencascade", "/usr/include/oce"],
    links: &["-lTKShHealing", "-lTKTopAlgo", "-lTKGeomAlgo", "-lTKGeomBase", "-lTKG3d", "-lTKMath", "-lTKernel"],
    package: "libocct-modeling-algorithms-dev",
};

/// A way of asking it.
struct Occt {
    program: PathBuf,
    name: &'static str,
    method: &'static str,
    /// On its own surface or curve of the entity's shape; only entities that have one.
    is_elementary: bool,
    pace: Pace,
}

pub(super) fn contenders() -> Result<Vec<Box<dyn Contender>>, String> {
    let program = LIBRARY.compile()?;
    let rows = [
        ("OCCT GeomAPI (Tree), edges by hand", "extrema", false, Pace::Thinned),
        ("OCCT ShapeAnalysis", "shape-analysis", false, Pace::Thinned),
        ("OCCT GeomAPI, Init + Perform, cold", "cold", false, Pace::Few),
        (ELEMENTARY, "elementary", true, Pace::All),
        (ELEMENTARY_BARE, "elementary-bare", true, Pace::All),
    ];
    let contender = |(name, method, is_elementary, pace)| {
        Box::new(Occt { program: program.clone(), name, method, is_elementary, pace }) as Box<dyn Contender>
    };
    Ok(rows.map(contender).into())
}

impl Contender for Occt {
    fn name(&self) -> String {
        self.name.to_owned()
    }

    fn pace(&self, _: Set) -> Pace {
        self.pace
    }

    fn enter(&self, case: &Case, points: &[DVec3]) -> Result<Option<Box<dyn Entrant>>, Failure> {
        if self.is_elementary && case.shape.is_none() {
            return Ok(None);
        }
        Ok(Some(Box::new(Native::new(&self.program, self.method, self.is_elementary, case, points)?)))
    }
}
