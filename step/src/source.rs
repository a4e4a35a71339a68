//! What a STEP file says of a part, as plain data: lengths in one unit, placed where the assembly puts them, angles in radians.

use glam::{DVec2, DVec3};
use perpend::{Frame, NurbsCurve, NurbsSurface, Units};

/// The surface of a face, without its trims.
#[derive(Debug, Clone, PartialEq)]
pub enum SourceSurface {
    /// The plane through the frame's centre, across its axis.
    Plane(Frame),
    /// A cylinder about the frame's axis.
    Cylinder {
        /// Its axis, and where angles count from.
        frame: Frame,
        /// Its radius.
        radius: f64,
    },
    /// A cone about the frame's axis.
    Cone {
        /// Its axis, and where angles count from.
        frame: Frame,
        /// The radius in the plane of the frame's centre; it grows along the axis.
        radius: f64,
        /// The angle between the axis and the rulings.
        half_angle: f64,
    },
    /// A sphere about the frame's centre.
    Sphere {
        /// Centre, polar axis, and where longitudes count from.
        frame: Frame,
        /// Its radius.
        radius: f64,
    },
    /// A torus whose tube does not cross the axis: `minor <= major`.
    Torus {
        /// Centre, axis, and where angles count from.
        frame: Frame,
        /// The radius of the spine.
        major: f64,
        /// The radius of the tube.
        minor: f64,
    },
    /// What a curve sweeps in a full turn about an axis; STEP's u is the angle, its v the parameter of the curve.
    Revolution {
        /// The curve.
        profile: SourceCurve,
        /// A point of the axis.
        point: DVec3,
        /// The direction of the axis, of unit length.
        axis: DVec3,
    },
    /// What a curve sweeps along a direction, without end: STEP's `profile(u) + v · direction`.
    Extrusion {
        /// The curve.
        profile: SourceCurve,
        /// The direction, as long as the file's vector.
        direction: DVec3,
    },
    /// A B-spline surface, whole, as in the file; periodic ones are clamped.
    Nurbs(NurbsSurface),
}

/// A curve of an edge or of a swept surface, without its ends unless it is a NURBS curve.
#[derive(Debug, Clone, PartialEq)]
pub enum SourceCurve {
    /// `point + t · direction`.
    Line {
        /// A point of the line.
        point: DVec3,
        /// Its direction, as long as the file's vector.
        direction: DVec3,
    },
    /// A circle about the frame's centre, across its axis, counter-clockwise from `xdir`.
    Circle {
        /// Centre, axis, and where angles count from.
        frame: Frame,
        /// Its radius.
        radius: f64,
    },
    /// An ellipse about the frame's centre, across its axis.
    Ellipse {
        /// Centre, axis, and the first of its axes.
        frame: Frame,
        /// The radii along `xdir` and `ydir`.
        radii: (f64, f64),
    },
    /// The branch `centre + radii.0 · cosh t · xdir + radii.1 · sinh t · ydir`.
    Hyperbola {
        /// Centre and axes.
        frame: Frame,
        /// The real and the imaginary radius.
        radii: (f64, f64),
    },
    /// `centre + focal · t² · xdir + 2 focal · t · ydir`.
    Parabola {
        /// Vertex and axes.
        frame: Frame,
        /// The distance between vertex and focus.
        focal: f64,
    },
    /// A B-spline curve, or what has no simpler form: polylines, composite curves, trimmed profiles.
    Nurbs(NurbsCurve),
}

/// A curve in the parameters of a STEP surface, as the file has it but for the units: angles in radians, lengths in the part's unit.
///
/// It runs as the curve of its edge does, whether or not the edge agrees with that. A hint: files let it lie beside the edge by far more than
/// their own tolerance.
#[derive(Debug, Clone, PartialEq)]
pub struct RawPcurve {
    /// The degree.
    pub degree: usize,
    /// The knots, as in the file: not validated.
    pub knots: Vec<f64>,
    /// The control points, (u, v).
    pub points: Vec<DVec2>,
    /// One weight a control point; none: all 1.
    pub weights: Option<Vec<f64>>,
}

/// An edge: a piece of a curve between two vertices.
#[derive(Debug, Clone, PartialEq)]
pub struct SourceEdge {
    /// The number of the file's entity; of a polygon's side, that of the loop that first had it.
    pub entity: u64,
    /// Its curve, which goes on beyond the vertices.
    pub curve: SourceCurve,
    /// Where it starts.
    pub start: DVec3,
    /// Where it ends.
    pub end: DVec3,
    /// Whether it starts and ends in one vertex.
    pub closed: bool,
    /// Whether it runs as its curve does.
    pub same_sense: bool,
}

/// An edge as a loop uses it.
#[derive(Debug, Clone, PartialEq)]
pub struct SourceUse {
    /// Its index in [`SourcePart::edges`].
    pub edge: usize,
    /// Whether the loop runs from the edge's start to its end.
    pub forward: bool,
    /// The file's own p-curve on this face's surface.
    pub pcurve: Option<RawPcurve>,
}

/// A boundary of a face.
#[derive(Debug, Clone, PartialEq)]
pub enum SourceLoop {
    /// Edges, end to start, counter-clockwise as seen from outside.
    Edges {
        /// Whether the file calls it the outer boundary. Files may leave that open.
        outer: bool,
        /// The edges in their order.
        uses: Vec<SourceUse>,
    },
    /// A single vertex: the apex of a cone, the pole of a sphere.
    Vertex(DVec3),
}

/// A face: the part of a surface within its loops.
#[derive(Debug, Clone, PartialEq)]
pub struct SourceFace {
    /// The number of the file's entity.
    pub entity: u64,
    /// Its name; most files give none.
    pub name: String,
    /// The surface.
    pub surface: SourceSurface,
    /// Whether the outward normal is that of the surface in STEP's own parametrisation (ISO 10303-42: away from the axis, centre or spine on
    /// cylinders, cones, spheres and tori; the frame's axis on planes; else `S_u × S_v`).
    pub same_sense: bool,
    /// The boundaries; none: the face is its whole, closed surface.
    pub loops: Vec<SourceLoop>,
    /// Its own colour; none: that of its body.
    pub colour: Option<[f64; 3]>,
}

/// Faces that hang together.
#[derive(Debug, Clone, PartialEq)]
pub struct SourceShell {
    /// The number of the file's entity.
    pub entity: u64,
    /// Indices in [`SourcePart::faces`].
    pub faces: Vec<usize>,
    /// Whether the file calls it closed, every face of it was understood, and they use each of their edges once in either direction.
    pub closed: bool,
    /// Whether its faces' outward normals point into the material: their shell is used the other way round.
    pub reversed: bool,
}

/// A solid, a sheet of faces, or faces that belong to neither; one for each time that the assembly uses it.
#[derive(Debug, Clone, PartialEq)]
pub struct SourceBody {
    /// The number of the file's entity.
    pub entity: u64,
    /// Its name: of the occurrences that lead to it and of its product.
    pub name: String,
    /// Its shells; of a solid the outer one is the first.
    pub shells: Vec<SourceShell>,
    /// Its colour.
    pub colour: Option<[f64; 3]>,
}

/// A part, or an assembly with every occurrence placed.
#[derive(Debug, Clone, PartialEq)]
pub struct SourcePart {
    /// The unit of all lengths.
    pub units: Units,
    /// The largest uncertainty that the file states for its lengths; where it states none, 1e-3 mm.
    pub tolerance: f64,
    /// The edges of all faces.
    pub edges: Vec<SourceEdge>,
    /// The faces of all bodies.
    pub faces: Vec<SourceFace>,
    /// The bodies.
    pub bodies: Vec<SourceBody>,
    /// What was left out, and why.
    pub not_understood: Vec<NotUnderstood>,
}

/// Something in a file that was left out, and why.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NotUnderstood {
    /// The number of the entity.
    pub entity: u64,
    /// What it is, in the file's terms.
    pub keyword: String,
    /// Why it was left out.
    pub reason: String,
}

impl std::fmt::Display for NotUnderstood {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "#{} {}: {}", self.entity, self.keyword, self.reason)
    }
}
