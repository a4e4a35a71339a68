//! What a STEP file says of a part, as plain data: lengths in one unit, placed where the assembly puts them.

use glam::DVec3;
use perpend::kernel::PlaneCurve;
use perpend::{Frame, NurbsCurve, NurbsSurface, Units};

/// The surface that carries a face, unbounded where STEP's is.
#[derive(Debug, Clone)]
pub(crate) enum SourceSurface {
    Plane(Frame),
    Cylinder {
        frame: Frame,
        radius: f64,
    },
    /// The radius is that at the frame's centre.
    Cone {
        frame: Frame,
        radius: f64,
        half_angle: f64,
    },
    Sphere {
        frame: Frame,
        radius: f64,
    },
    Torus {
        frame: Frame,
        major: f64,
        minor: f64,
    },
    Revolution {
        profile: SourceCurve,
        point: DVec3,
        axis: DVec3,
    },
    Extrusion {
        profile: SourceCurve,
        direction: DVec3,
    },
    /// Whole, as in the file; periodic ones clamped.
    Nurbs(NurbsSurface),
}

/// A curve, unbounded where STEP's is; polylines and trimmed curves are NURBS.
#[derive(Debug, Clone)]
pub(crate) enum SourceCurve {
    Line { point: DVec3, direction: DVec3 },
    Circle { frame: Frame, radius: f64 },
    Ellipse { frame: Frame, radii: (f64, f64) },
    Hyperbola { frame: Frame, radii: (f64, f64) },
    Parabola { frame: Frame, focal: f64 },
    Nurbs(NurbsCurve),
}

/// An edge: a curve between two vertices.
#[derive(Debug, Clone)]
pub(crate) struct SourceEdge {
    /// Its number in the file.
    pub(crate) entity: u64,
    pub(crate) curve: SourceCurve,
    pub(crate) start: DVec3,
    pub(crate) end: DVec3,
    /// Both ends are one vertex.
    pub(crate) closed: bool,
    /// The curve runs from `start` to `end`.
    pub(crate) same_sense: bool,
}

/// An edge as a loop runs along it.
#[derive(Debug, Clone)]
pub(crate) struct SourceUse {
    /// Index into the part's edges.
    pub(crate) edge: usize,
    /// The loop runs from the edge's start to its end.
    pub(crate) forward: bool,
    /// The file's own p-curve, in the parameters of its surface: a hint.
    pub(crate) pcurve: Option<PlaneCurve>,
}

/// A loop of a face.
#[derive(Debug, Clone)]
pub(crate) enum SourceLoop {
    Edges { outer: bool, uses: Vec<SourceUse> },
    Vertex(DVec3),
}

/// A face.
#[derive(Debug, Clone)]
pub(crate) struct SourceFace {
    /// Its number in the file.
    pub(crate) entity: u64,
    pub(crate) name: String,
    pub(crate) surface: SourceSurface,
    /// The face's outward normal is the surface's.
    pub(crate) same_sense: bool,
    pub(crate) loops: Vec<SourceLoop>,
    pub(crate) colour: Option<[f64; 3]>,
}

/// Faces that hang together.
#[derive(Debug, Clone)]
pub(crate) struct SourceShell {
    pub(crate) entity: u64,
    pub(crate) faces: Vec<usize>,
    pub(crate) closed: bool,
    pub(crate) reversed: bool,
}

/// A body.
#[derive(Debug, Clone)]
pub(crate) struct SourceBody {
    pub(crate) entity: u64,
    pub(crate) name: String,
    pub(crate) shells: Vec<SourceShell>,
    pub(crate) colour: Option<[f64; 3]>,
}

/// What was read.
#[derive(Debug, Clone)]
pub(crate) struct SourcePart {
    pub(crate) units: Units,
    /// The file's uncertainty, in the model's unit.
    pub(crate) tolerance: f64,
    pub(crate) edges: Vec<SourceEdge>,
    pub(crate) faces: Vec<SourceFace>,
    pub(crate) bodies: Vec<SourceBody>,
    pub(crate) not_understood: Vec<NotUnderstood>,
}

/// An entity of the file that was not understood.
#[derive(Debug, Clone, PartialEq)]
pub struct NotUnderstood {
    /// Its number.
    pub entity: u64,
    /// Its keyword.
    pub keyword: String,
    /// Why not.
    pub reason: String,
}
