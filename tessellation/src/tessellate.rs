//! From a surface to its mesh.

use glam::{DVec2, DVec3};
use perpend_kernel::bezier::surface_pieces;
use perpend_kernel::{Direction, NurbsSurface, TrimLoop, Trimming};

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

/// How often a face whose triangles vanish is tried again with a quarter of the chord error.
const RETRIES: usize = 6;

/// Triangles of a surface, or of the part of it that a trimming leaves, within a chord error, a length.
///
/// Triangles lie in the cells that the crate's page describes, with their corners on the surface and, along trims, on the trims. Corners on
/// the sides of cells and on both sides of a closed surface's seam are shared, so the mesh has no gaps; two faces that share an edge are
/// each within the chord error of it. What is thinner than the chord error may have no triangle; a face that would have none at all is made
/// again with a quarter of the chord error. The same face gives the same mesh, bit for bit.
///
/// Where [`Limits`] are reached the mesh is coarser than asked for: [`Mesh::error`] is above `chord` then, and is the chord error for which
/// the limits suffice.
///
/// # Errors
///
/// The chord error is not positive.
pub fn tessellate(
    surface: &NurbsSurface,
    trimming: Option<&Trimming>,
    chord: f64,
    limits: Limits,
) -> Result<Mesh, InvalidChord> {
    InvalidChord::check(chord)?;
    let face = Face::new(surface, trimming);
    let mut mesh = face.mesh(chord, limits);
    for retry in 1..=RETRIES {
        if !mesh.triangles.is_empty() || trimming.is_none() {
            break;
        }
        mesh = face.mesh(chord * 0.25_f64.powi(retry as i32), limits);
    }
    Ok(mesh)
}

/// A face, its pieces and its trims.
struct Face<'a> {
    surface: &'a NurbsSurface,
    pieces: Vec<Patch>,
    columns: usize,
    trims: Option<(Vec<Chain>, Speeds)>,
    reversed: bool,
}

impl<'a> Face<'a> {
    fn new(surface: &'a NurbsSurface, trimming: Option<&Trimming>) -> Self {
        let (u, v) = (surface.knots(Direction::U), surface.knots(Direction::V));
        let pieces =
            surface_pieces(u, v, &surface.homogeneous_points()).into_iter().map(Patch::new).collect::<Vec<_>>();
        let columns = v.spans().count();
        let chain = |one: &TrimLoop| {
            let pieces = one.curves.iter().flat_map(|trim| trim.curve.pieces());
            pieces.map(|piece| piece.points).collect()
        };
        let trims =
            trimming.map(|trimming| (trimming.loops().iter().map(chain).collect(), Speeds::new(&pieces, columns)));
        Self { surface, pieces, columns, trims, reversed: trimming.is_some_and(Trimming::reversed) }
    }

    fn mesh(&self, chord: f64, limits: Limits) -> Mesh {
        let surface = self.surface;
        let [(u0, u1), (v0, v1)] = [Direction::U, Direction::V].map(|direction| surface.domain(direction));
        let domain = [DVec2::new(u0, v0), DVec2::new(u1, v1)];
        // finer than this, cells would follow the rounding of their control points
        let chord = chord.max(64.0 * f64::EPSILON * surface.control_box().reach());
        let polygons =
            self.trims.as_ref().map(|(chains, speeds)| polygons(chains, speeds, domain, 0.5 * chord, limits.segments));
        let cells_chord = if polygons.is_some() { 0.5 * chord } else { chord };
        let parity = polygons.as_ref().map(|polygons| Parity::new(&polygons.segments()));
        let mut grid = Grid::default();
        let segments = polygons.as_ref().map_or_else(Vec::new, |polygons| enter(polygons, &mut grid, domain));
        let cutting = Cutting { pieces: &self.pieces, columns: self.columns, trims: parity.as_ref(), grid: &mut grid };
        let cells = cutting.cells(segments, cells_chord, limits.triangles);
        for cell in &cells.cells {
            let (u, v) = (cell.over.u, cell.over.v);
            for (u, v) in [(u.0, v.0), (u.1, v.0), (u.1, v.1), (u.0, v.1)] {
                grid.corner(u, v);
            }
        }
        for (direction, (from, to)) in [(Direction::U, (u0, u1)), (Direction::V, (v0, v1))] {
            if closes(surface, direction) {
                grid.mirror(direction, from, to);
                grid.mirror(direction, to, from);
            }
        }
        grid.sort();
        let mut fill =
            Fill { surface, trims: parity.as_ref(), grid: &mut grid, points: Vec::new(), triangles: Vec::new() };
        for cell in &cells.cells {
            fill.cell(cell);
        }
        let Fill { points, triangles, .. } = fill;
        let error = cells.error + polygons.map_or(0.0, |polygons| polygons.error);
        self.gather(&grid, &points, &triangles, error)
    }

    /// The vertices that triangles have, in the order in which these name them.
    fn gather(&self, grid: &Grid, points: &[Option<DVec3>], triangles: &[[u32; 3]], error: f64) -> Mesh {
        let mut mesh = Mesh { error, ..Mesh::default() };
        let mut entered: Vec<Option<u32>> = vec![None; points.len()];
        for triangle in triangles {
            let mut triangle = triangle.map(|index| {
                *entered[index as usize].get_or_insert_with(|| {
                    mesh.vertices.push(points[index as usize].expect("triangles were judged by their points"));
                    mesh.parameters.push(grid.place(index));
                    mesh.vertices.len() as u32 - 1
                })
            });
            if self.reversed {
                triangle.swap(1, 2);
            }
            mesh.triangles.push(triangle);
        }
        let sign = if self.reversed { -1.0 } else { 1.0 };
        let normals: Vec<Option<DVec3>> =
            mesh.parameters.iter().map(|at| normal(self.surface, *at).map(|normal| sign * normal)).collect();
        let mut means = vec![DVec3::ZERO; mesh.vertices.len()];
        if normals.contains(&None) {
            for triangle in &mesh.triangles {
                let [a, b, c] = triangle.map(|i| mesh.vertices[i as usize]);
                triangle.iter().for_each(|i| means[*i as usize] += (b - a).cross(c - a));
            }
        }
        let or_mean = |(normal, mean): (&Option<DVec3>, &DVec3)| normal.unwrap_or_else(|| mean.normalize_or_zero());
        mesh.normals = normals.iter().zip(&means).map(or_mean).collect();
        mesh
    }
}

/// The segments of polygons, between places of the grid; those on the border of the domain bound cells already.
fn enter(polygons: &Polygons, grid: &mut Grid, [low, high]: [DVec2; 2]) -> Vec<[u32; 2]> {
    let mut segments = Vec::new();
    for points in &polygons.loops {
        let indices: Vec<u32> = points.iter().map(|point| grid.add(*point)).collect();
        for (i, (point, index)) in points.iter().zip(&indices).enumerate() {
            if point.x == low.x || point.x == high.x {
                grid.note(Direction::U, *index);
            }
            if point.y == low.y || point.y == high.y {
                grid.note(Direction::V, *index);
            }
            let next = points[(i + 1) % points.len()];
            let on_border = (point.x == next.x && (point.x == low.x || point.x == high.x))
                || (point.y == next.y && (point.y == low.y || point.y == high.y));
            if !on_border && next != *point {
                segments.push([*index, indices[(i + 1) % points.len()]]);
            }
        }
    }
    segments
}

/// Whether both ends of a direction are one curve, in the same bits.
fn closes(surface: &NurbsSurface, direction: Direction) -> bool {
    let (rows, columns) = (surface.rows(), surface.columns());
    let ends: Vec<(usize, usize)> = match direction {
        Direction::U => (0..columns).map(|j| (j, (rows - 1) * columns + j)).collect(),
        Direction::V => (0..rows).map(|i| (i * columns, i * columns + columns - 1)).collect(),
    };
    let points = surface.control_points();
    let same_weight = |a: usize, b: usize| surface.weights().is_none_or(|weights| weights[a] == weights[b]);
    ends.into_iter().all(|(a, b)| points[a] == points[b] && same_weight(a, b))
}
