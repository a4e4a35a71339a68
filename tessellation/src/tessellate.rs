//! From a surface to its mesh.

use glam::{DVec2, DVec3};
use perpend_kernel::bezier::surface_pieces;
use perpend_kernel::{Direction, NurbsSurface};

use crate::cells::Cutting;
use crate::fill::Fill;
use crate::grid::Grid;
use crate::mesh::Mesh;
use crate::normal::normal;
use crate::outline::{Chain, Polygons, Speeds, polygons};
use crate::parity::Parity;
use crate::patch::Patch;

/// How large an answer may become. Where a limit is reached the worst parts have been refined first, and the answer says its error.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// Triangles of one face; two for each Bézier piece there always are.
    pub triangles: usize,
    /// Segments of one curve, and of all trims of one face; one for each Bézier piece there always is.
    pub segments: usize,
}

/// Two million triangles, a quarter of a million segments: more than a viewer shows at once, and seconds of work.
impl Default for Limits {
    fn default() -> Self {
        Self { triangles: 2_000_000, segments: 250_000 }
    }
}

/// The chord error is no positive length.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("the chord error is {chord}: it must be a finite length above 0")]
pub struct InvalidChord {
    /// The chord error.
    pub chord: f64,
}

impl InvalidChord {
    pub(crate) fn check(chord: f64) -> Result<(), Self> {
        if chord > 0.0 && chord.is_finite() { Ok(()) } else { Err(Self { chord }) }
    }
}
