//! Faces: from what a file says to a carrier and its trim.
//!
//! The edges of a face are followed in coordinates of its surface ([`carrier`], [`trace`]) and joined to rings over seams and poles
//! ([`chain`]); closed surfaces are cut open where the rings ask for it ([`open`]); as much of the surface as the rings need becomes a NURBS
//! ([`window`]), and the rings p-curves in its parameters ([`fit`]).

mod carrier;
mod chain;
mod edge;
mod fit;
mod numeric;
mod open;
#[cfg(test)]
mod tests;
mod trace;
mod turn;
mod window;

use glam::{DVec2, DVec3};
use perpend::kernel::{InvalidEdit, TrimCurveData};
use perpend::{Aabb, InvalidDefinition, NurbsCurve, NurbsSurface, Shape};

use carrier::Carrier;
use chain::Ring;
use fit::{Fit, Flat};
use window::Window;

pub(crate) use edge::edge_curve;

use crate::source::{SourceCurve, SourceEdge, SourceFace, SourceLoop, SourceSurface};

/// What can be told apart in a file, as a share of a face's size, where the file does not say more.
const RESOLUTION: f64 = 1e-6;

/// A tolerance of the file beyond this share of a face's size is not believed.
const COARSEST: f64 = 1e-4;

/// The largest gap between two edges of a loop that is closed by a straight join, as a share of the face's size.
const WIDEST_GAP: f64 = 1e-2;

/// Edges may lie off their surface by this share of a face's size, and vertices off their edge's curve by this share of its extent.
const WIDEST_OFF: f64 = 1e-2;

/// Both may be off by this many times the file's tolerance.
const TOLERANCES_OFF: f64 = 10.0;

/// Coordinates of control points, and quotients of weights, beyond this leave no digits for a face: nothing real needs them.
const LARGEST: f64 = 1e12;

/// A face as a model takes it.
#[derive(Debug, Clone)]
pub(crate) struct BuiltFace {
    /// The carrier.
    pub(crate) surface: NurbsSurface,
    /// The analytic shape whose exact form the carrier is.
    pub(crate) shape: Option<Shape>,
    /// The outward normal is `-(S_u × S_v)`.
    pub(crate) reversed: bool,
    /// How far the edges lie from the images of their p-curves at most, and at least the file's tolerance.
    pub(crate) tolerance: f64,
    /// The loops, with the material on the left.
    pub(crate) loops: Vec<BuiltLoop>,
}

/// A loop of p-curves, each beginning in the bits in which the one before it ends.
#[derive(Debug, Clone)]
pub(crate) struct BuiltLoop {
    pub(crate) outer: bool,
    /// Each with the index of its edge; none where it closes the loop along a seam or a pole.
    pub(crate) curves: Vec<(TrimCurveData, Option<usize>)>,
}

/// Why an edge or a face cannot be built.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub(crate) enum FaceError {
    #[error("edge #{entity}: {reason}")]
    Edge { entity: u64, reason: String },
    #[error("its {what} is {value}; it must be positive and finite")]
    Length { what: &'static str, value: f64 },
    #[error(
        "a control point has the coordinate {0:e}; more than {LARGEST:e} cannot be computed with: have the file written anew"
    )]
    TooFar(f64),
    #[error(
        "its weights differ by a factor of {0:e}; more than {LARGEST:e} cannot be computed with: have the file written anew"
    )]
    Weights(f64),
    #[error(
        "edge #{edge} lies {off:e} off its surface; at most {allowed:e} is taken for it: have the file written anew, or state the file's tolerance"
    )]
    Off { edge: u64, off: f64, allowed: f64 },
    #[error(
        "following its edges on its surface was given up: it took too much work; have the surface written with fewer or better control points"
    )]
    TooHard,
    #[error("an edge has no place on its surface")]
    Nowhere,
    #[error("the cone's half-angle is {0}; it must lie strictly between 0 and a right angle")]
    HalfAngle(f64),
    #[error("the profile is a hyperbola or a parabola without ends")]
    UnboundedProfile,
    #[error("its loops bound no part of its surface")]
    Unbounded,
    #[error("it has no extent along one of its surface's parameters")]
    Empty,
    #[error("the loop of edges {edges:?} is open by {gap:e}")]
    Open { edges: Vec<u64>, gap: f64 },
    #[error("it was given up: the time was over")]
    GivenUp,
    #[error("building it failed within perpend: report the file")]
    Failed,
    #[error(transparent)]
    Definition(#[from] InvalidDefinition),
    #[error(transparent)]
    Edit(#[from] InvalidEdit),
}

/// Builds a face of a part from the part's edges and their curves ([`edge_curve`], in their order); `tolerance` is the file's uncertainty, a
/// length.
///
/// # Errors
///
/// An edge that it uses has no curve; its surface is none; its loops are open or bound nothing.
pub(crate) fn build(
    face: &SourceFace,
    edges: &[SourceEdge],
    curves: &[Result<NurbsCurve, FaceError>],
    tolerance: f64,
) -> Result<BuiltFace, FaceError> {
    let mut used: Vec<usize> = Vec::new();
    let mut vertices = Vec::new();
    for one in &face.loops {
        match one {
            SourceLoop::Edges { uses, .. } => used.extend(uses.iter().map(|one| one.edge)),
            SourceLoop::Vertex(vertex) => vertices.push(*vertex),
        }
    }
    used.sort_unstable();
    used.dedup();
    // the face's own edges, numbered from 0
    let own = used.iter().map(|edge| curves[*edge].clone()).collect::<Result<Vec<_>, _>>()?;
    let index = |edge: usize| used.binary_search(&edge).expect("an edge of the face");
    let samples: Vec<DVec3> = own
        .iter()
        .flat_map(|curve| {
            let (a, b) = curve.domain();
            (0..=32).map(move |k| curve.point(a + (b - a) * f64::from(k) / 32.0))
        })
        .chain(vertices)
        .collect();
    let mut size = Aabb::around(samples.iter().copied()).diagonal();
    if own.is_empty() {
        size = size_alone(&face.surface);
    }
    let apart = tolerance.min(COARSEST * size).max(RESOLUTION * size);
    let mut carrier = Carrier::new(&face.surface, &samples, size, apart)?;
    if !carrier.poles.is_empty() {
        let off = |p: &DVec3| carrier.point(carrier.inverse(*p, None)).distance(*p);
        let off = samples.iter().step_by(4).map(off).fold(0.0, f64::max);
        carrier.pole_tolerance = (2.0 * off).min(COARSEST * size).max(apart);
    }
    let left = if carrier.normal_kept == face.same_sense { 1.0 } else { -1.0 };
    let allowed = (TOLERANCES_OFF * tolerance).max(WIDEST_OFF * size);
    let mut rings: Vec<Ring> = Vec::new();
    for one in &face.loops {
        let SourceLoop::Edges { uses, .. } = one else { continue };
        let pieces: Vec<_> =
            uses.iter().flat_map(|one| trace::trace(&carrier, &own, index(one.edge), one.forward)).collect();
        if carrier.is_exhausted() {
            return Err(FaceError::TooHard);
        }
        if pieces.is_empty() {
            continue;
        }
        if !pieces.iter().flat_map(|piece| &piece.at).all(|at| at.is_finite()) {
            return Err(FaceError::Nowhere);
        }
        if let Some(piece) = pieces.iter().find(|piece| piece.off > allowed)
            && let Some(edge) = piece.edge
        {
            return Err(FaceError::Off { edge: edges[used[edge]].entity, off: piece.off, allowed });
        }
        let ring = chain::ring(&carrier, pieces, left);
        rings.push(if left > 0.0 { ring } else { ring.reversed() });
    }
    if carrier.periods == [None; 2] && !rings.is_empty() {
        rings = nested(rings).into_iter().map(|(ring, _)| ring).collect();
    }
    // a vertex or nothing bounds all of a closed surface, and no part of another
    if rings.is_empty() && !(0..2).all(|k| carrier.is_closed(k)) {
        return Err(FaceError::Unbounded);
    }
    let off = rings.iter().flat_map(|ring| &ring.pieces).fold(0.0_f64, |most, piece| most.max(piece.off));
    let opened = match open::open(&carrier, &own, rings.clone()) {
        // a file with its loops the wrong way round
        Err(FaceError::Unbounded) => open::open(&carrier, &own, rings.into_iter().map(Ring::reversed).collect())?,
        opened => opened?,
    };
    let mut rings = opened.rings;
    if rings.is_empty() {
        rings.push(open::frame(carrier.limits));
    }
    let window = Window::new(&carrier, &rings, opened.full)?;
    let fit_tolerance = (0.1 * tolerance).min(1e-7 * size).max(1e-12 * size);
    let fit = Fit { carrier: &carrier, window: &window, curves: &own, tolerance: fit_tolerance };
    // ends nearer than this are one vertex
    let one_vertex = (4.0 * off).max(10.0 * apart);
    let (mut loops, mut widest) = (Vec::new(), 0.0_f64);
    for (ring, outer) in nested(rings) {
        let flats: Vec<Flat> = ring.pieces.iter().map(|piece| fit.curve(piece)).collect();
        if carrier.is_exhausted() {
            return Err(FaceError::TooHard);
        }
        let (flats, gap) = closed(&window, flats, one_vertex);
        if gap > WIDEST_GAP * size {
            let entities = ring.pieces.iter().filter_map(|piece| piece.edge).map(|edge| edges[used[edge]].entity);
            return Err(FaceError::Open { edges: entities.collect(), gap });
        }
        widest = widest.max(gap.min(one_vertex));
        let curves = flats.into_iter().map(|flat| {
            let edge = flat.edge.map(|edge| used[edge]);
            (flat.data(), edge)
        });
        loops.push(BuiltLoop { outer, curves: curves.collect() });
    }
    let reversed = left < 0.0;
    let tolerance = tolerance.max(1.5 * off + fit_tolerance).max(widest);
    Ok(BuiltFace { surface: window.surface, shape: window.shape, reversed, tolerance, loops })
}

/// Refuses control points and weights that leave no digits.
fn computable(points: &[DVec3], weights: Option<&[f64]>) -> Result<(), FaceError> {
    let largest = points.iter().map(|point| point.abs().max_element()).fold(0.0, f64::max);
    if largest > LARGEST {
        return Err(FaceError::TooFar(largest));
    }
    let (low, high) =
        weights.into_iter().flatten().fold((f64::INFINITY, 0.0_f64), |(low, high), w| (low.min(*w), high.max(*w)));
    if high / low > LARGEST { Err(FaceError::Weights(high / low)) } else { Ok(()) }
}

/// The size of a surface that is a whole face.
fn size_alone(surface: &SourceSurface) -> f64 {
    match surface {
        SourceSurface::Sphere { radius, .. } => 2.0 * radius,
        SourceSurface::Torus { major, minor, .. } => 2.0 * (major + minor),
        SourceSurface::Nurbs(surface) => surface.control_box().diagonal(),
        SourceSurface::Revolution { profile: SourceCurve::Nurbs(profile), .. } => profile.control_box().diagonal(),
        _ => 1.0,
    }
}

/// Rings with the material on their left, and whether they bound it from outside: those inside an odd number of others do not.
fn nested(rings: Vec<Ring>) -> Vec<(Ring, bool)> {
    let polygons: Vec<Vec<DVec2>> =
        rings.iter().map(|ring| ring.pieces.iter().flat_map(|piece| piece.at.iter().copied()).collect()).collect();
    let boxes: Vec<[(f64, f64); 2]> = rings.iter().map(|ring| [0, 1].map(|k| ring.extent(k))).collect();
    let meets = |i: usize, j: usize| (0..2).all(|k| boxes[i][k].0 <= boxes[j][k].1 && boxes[j][k].0 <= boxes[i][k].1);
    let is_outer: Vec<bool> = (0..rings.len())
        .map(|i| {
            let around = (0..rings.len()).filter(|j| *j != i && meets(i, *j) && is_within(&polygons[i], &polygons[*j]));
            around.count() % 2 == 0
        })
        .collect();
    let turned = |(ring, outer): (Ring, bool)| {
        let is_left = (ring.area() > 0.0) == outer;
        (if is_left { ring } else { ring.reversed() }, outer)
    };
    rings.into_iter().zip(is_outer).map(turned).collect()
}

/// Whether most corners of a polygon lie inside another.
fn is_within(inner: &[DVec2], outer: &[DVec2]) -> bool {
    let inside = inner.iter().filter(|at| {
        let mut odd = false;
        for (a, b) in outer.iter().zip(outer.iter().cycle().skip(1)) {
            if (a.y > at.y) != (b.y > at.y) && at.x < a.x + (at.y - a.y) / (b.y - a.y) * (b.x - a.x) {
                odd = !odd;
            }
        }
        odd
    });
    2 * inside.count() > inner.len()
}

/// P-curves with common ends, and the widest gap between two of them. Where one keeps a parameter constant, their common end does too; what
/// is farther apart than `one_vertex` is joined by a straight line.
fn closed(window: &Window, flats: Vec<Flat>, one_vertex: f64) -> (Vec<Flat>, f64) {
    let count = flats.len();
    let mut widest = 0.0_f64;
    // where each ends, and where the next begins
    let mut joints: Vec<(DVec2, DVec2)> = Vec::with_capacity(count);
    for i in 0..count {
        let (a, b) = (&flats[i], &flats[(i + 1) % count]);
        let (end, start) = (a.end(), b.start());
        let at = |place: DVec2| window.surface.point(place.x, place.y);
        let gap = at(end).distance(at(start));
        widest = widest.max(gap);
        if gap > one_vertex {
            joints.push((end, start));
            continue;
        }
        let mut joint = 0.5 * (end + start);
        for k in 0..2 {
            match (a.constant[k], b.constant[k]) {
                (true, false) => joint[k] = end[k],
                (false, true) => joint[k] = start[k],
                _ => {}
            }
        }
        joints.push((joint, joint));
    }
    let mut all = Vec::with_capacity(count);
    for (i, flat) in flats.into_iter().enumerate() {
        let flat = flat.with_ends(joints[(i + count - 1) % count].1, joints[i].0);
        // what shrank to nothing is gone
        if flat.degree > 1 || flat.start() != flat.end() {
            all.push(flat);
        }
        let (end, start) = joints[i];
        if end != start {
            all.push(Flat::line(end, start, [false; 2], None));
        }
    }
    (all, widest)
}
