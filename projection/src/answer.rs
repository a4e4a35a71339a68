//! What an answer is: plain data, with its proof.

use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Where on its entity a foot point lies, in the entity's own parameters.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Parameter {
    /// The parameter `u` of a curve.
    Curve(f64),
    /// The parameters `u` and `v` of a surface.
    Surface(f64, f64),
}

impl Parameter {
    /// The parameter in u.
    #[must_use]
    pub fn u(self) -> f64 {
        match self {
            Self::Curve(u) | Self::Surface(u, _) => u,
        }
    }

    /// The parameter in v; none on a curve.
    #[must_use]
    pub fn v(self) -> Option<f64> {
        match self {
            Self::Curve(_) => None,
            Self::Surface(_, v) => Some(v),
        }
    }
}

/// What is particular about the place of a foot point. Where several hold, the one named first here is given.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Place {
    /// A whole edge of the surface's domain is this one point.
    Pole,
    /// The first derivative (of a surface: the normal) vanishes.
    Cusp,
    /// An end of a p-curve of a trimmed surface's boundary.
    Vertex,
    /// The boundary of a trimmed surface.
    TrimEdge,
    /// A corner of the surface's domain.
    Corner,
    /// The tangent (of a surface: the tangent plane) turns abruptly at a knot.
    Crease,
    /// The closed entity begins and ends here; the lower parameter is given.
    Seam,
    /// The end of an open curve.
    End,
    /// An edge of the surface's domain.
    Edge,
    /// None of these.
    Interior,
}

/// Whether another point of the entity is as near as the foot point, within the gap.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Multiplicity {
    /// No other foot was met. This is an observation, not a proof.
    Unique,
    /// Another foot, farther than `coincidence` from this one, is as near within the gap.
    Tied,
    /// A whole curve or region is as near within the gap: the centre of a circle, the axis of a cylinder.
    Continuum,
}

/// The solver that proposed an answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Method {
    /// The closed form of a shape that is known and proved.
    Analytic,
    /// The prepared tree of Bézier pieces and its certificate.
    Hierarchy,
    /// A cubical wave through uniform cells, then Newton's method (Piegl et al. 2008).
    Wave,
    /// Subdivision with the exclusion criteria of Selimovic 2006.
    Exclusion,
    /// The same subdivision with the control-polygon test of Ma and Hewitt 2003, the comparator of Selimovic's tables.
    ControlPolygon,
    /// All stationary points by a quadtree over the squared gradient in Bernstein form (Xu et al. 2014).
    Bernstein,
    /// The boundary of a trimmed surface as curves, and the hierarchy of what lies inside.
    Trimmed,
}

/// The nearest point of an entity to a query point, with its proof.
///
/// The true distance lies in `[lower_bound, distance]`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct FootPoint {
    /// The foot point's parameter, inside the domain.
    pub parameter: Parameter,
    /// The definition evaluated at `parameter`.
    pub point: DVec3,
    /// The distance from the query point to the foot point, in the model's unit: an upper bound of the true distance.
    ///
    /// Computed in coordinates relative to the entity; `|query - point|` may differ by a few ulps of the coordinates.
    pub distance: f64,
    /// Proven: no point of the entity is nearer.
    pub lower_bound: f64,
    /// What is particular about the foot point's place.
    pub place: Place,
    /// Whether other points are as near.
    pub multiplicity: Multiplicity,
    /// The unit normal `S_u × S_v` of a surface; at a crease the mean of the normals around it. None on a curve, and where the
    /// surface has no normal (pole, cusp).
    pub normal: Option<DVec3>,
    /// The distance, positive on the normal's side and negative behind; none where `normal` is.
    pub signed_distance: Option<f64>,
    /// The solver that proposed the answer.
    pub method: Method,
}

impl FootPoint {
    /// How far apart the bounds of the true distance are.
    #[must_use]
    pub fn gap(&self) -> f64 {
        self.distance - self.lower_bound
    }
}

/// All nearest points of an entity to a query point.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Ties {
    /// The nearest foot point.
    pub nearest: FootPoint,
    /// The isolated feet within the gap of it, the nearest among them unless it lies in a continuum; in ascending order of
    /// parameters. No two are closer than `coincidence`.
    pub points: Vec<FootPoint>,
    /// The connected sets of parameters that hold all other points within the gap, each covered by boxes.
    pub continua: Vec<Continuum>,
    /// Every leaf that could hold a point within the gap of the nearest was searched to the end: each of its boxes is proven to
    /// hold none, or belongs to a foot or a continuum that was found. That two feet of one valley are one is told by samples between
    /// them, so feet parted by a low ridge may be given as one. False where the work bound was met, or the nearest foot was lost.
    pub complete: bool,
}

/// A connected set of parameters whose points are all nearest within the gap, as far as boxes of the stated width tell.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Continuum {
    /// Boxes that cover the set, each with a point of the set in or near it.
    pub boxes: Vec<ParameterBox>,
}

/// A box in the parameters of an entity.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ParameterBox {
    /// From and to, in u.
    pub u: (f64, f64),
    /// From and to, in v; on a curve `(0, 0)`.
    pub v: (f64, f64),
}
