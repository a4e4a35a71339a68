//! The triangles of one cell.

use glam::{DVec2, DVec3};
use perpend_kernel::NurbsSurface;
use spade::{ConstrainedDelaunayTriangulation, HasPosition, Point2, Triangulation};

use crate::apart::apart;
use crate::cells::Cell;
use crate::grid::Grid;
use crate::parity::Parity;

/// Triangles between places of the grid, counter-clockwise in `(u, v)`, and the points of the surface there.
pub(crate) struct Fill<'a> {
    pub(crate) surface: &'a NurbsSurface,
    pub(crate) trims: Option<&'a Parity>,
    pub(crate) grid: &'a mut Grid,
    /// The points of the places that were needed so far.
    pub(crate) points: Vec<Option<DVec3>>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

impl Fill<'_> {
    fn point(&mut self, index: u32) -> DVec3 {
        let at = index as usize;
        if self.points.len() <= at {
            self.points.resize(at + 1, None);
        }
        let place = self.grid.place(index);
        *self.points[at].get_or_insert_with(|| self.surface.point(place.x, place.y))
    }

    /// Adds a triangle, unless two of its corners are one point, as at a pole.
    fn add(&mut self, triangle: [u32; 3]) {
        let [a, b, c] = triangle.map(|index| self.point(index));
        if a != b && b != c && c != a {
            self.triangles.push(triangle);
        }
    }

    /// Adds the triangles of a cell.
    pub(crate) fn cell(&mut self, cell: &Cell) {
        let outline = self.grid.outline(cell.over);
        if !cell.segments.is_empty() {
            self.trimmed(cell, &outline);
        } else if let [a, b, c, d] = outline[..] {
            let [pa, pb, pc, pd] = [a, b, c, d].map(|index| self.point(index));
            let halves = if pa.distance_squared(pc) <= pb.distance_squared(pd) {
                [[a, b, c], [a, c, d]]
            } else {
                [[a, b, d], [b, c, d]]
            };
            halves.into_iter().for_each(|triangle| self.add(triangle));
        } else {
            // corners of smaller cells lie on the sides: a fan about the middle reaches all of them
            let (u, v) = (cell.over.u, cell.over.v);
            let middle = self.grid.add(DVec2::new(0.5 * u.0 + 0.5 * u.1, 0.5 * v.0 + 0.5 * v.1));
            for (i, from) in outline.iter().enumerate() {
                self.add([middle, *from, outline[(i + 1) % outline.len()]]);
            }
        }
    }

    /// A constrained triangulation of the cell's places; the triangles that count are on the inner side of the trims.
    fn trimmed(&mut self, cell: &Cell, outline: &[u32]) {
        let frame = CellFrame::new(cell);
        let corner = |index: u32| Corner { at: frame.enter(self.grid.place(index)), index: Some(index) };
        let segments = cell.segments.iter().map(|segment| segment.map(corner)).collect();
        let segments = apart(segments);
        let mut mesh = ConstrainedDelaunayTriangulation::<Corner>::new();
        let mut enter = |corner: Corner| mesh.insert(corner).expect("coordinates in a cell are of moderate size");
        // the sides last: where two places are one in the frame, the one that the cell beside knows stays
        let segments: Vec<_> = segments.into_iter().map(|segment| segment.map(&mut enter)).collect();
        let sides: Vec<_> = outline.iter().map(|index| enter(corner(*index))).collect();
        for (i, from) in sides.iter().enumerate() {
            mesh.try_add_constraint(*from, sides[(i + 1) % sides.len()]);
        }
        for [from, to] in segments {
            mesh.try_add_constraint(from, to);
        }
        let indices: Vec<u32> = mesh
            .vertices()
            .map(|vertex| {
                let corner = vertex.data();
                corner.index.unwrap_or_else(|| self.grid.add(frame.leave(corner.at)))
            })
            .collect();
        for face in mesh.inner_faces() {
            let triangle = face.vertices().map(|vertex| indices[vertex.index()]);
            let [a, b, c] = triangle.map(|index| self.grid.place(index));
            if self.trims.is_none_or(|trims| trims.inside((a + b + c) / 3.0)) {
                self.add(triangle);
            }
        }
    }
}

/// A place in the frame of a cell; those that splitting made have no index yet.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Corner {
    pub(crate) at: Point2<f64>,
    pub(crate) index: Option<u32>,
}

impl HasPosition for Corner {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        self.at
    }
}

/// Coordinates in which a cell's sides have about the proportions that they have in space, from 0 at its lowest parameters.
struct CellFrame {
    low: DVec2,
    high: DVec2,
    sides: DVec2,
}

impl CellFrame {
    fn new(cell: &Cell) -> Self {
        let (u, v) = (cell.over.u, cell.over.v);
        // only how good the triangles look depends on it
        let longest = cell.extent.max_element();
        let sides = if longest > 0.0 { (cell.extent / longest).max(DVec2::splat(1e-3)) } else { DVec2::ONE };
        Self { low: DVec2::new(u.0, v.0), high: DVec2::new(u.1, v.1), sides }
    }

    fn enter(&self, place: DVec2) -> Point2<f64> {
        let at = (place - self.low) / (self.high - self.low) * self.sides;
        // the library refuses numbers below 1e-43, which mean nothing beside a side of length 1
        let at = DVec2::select(at.cmplt(DVec2::splat(1e-40)), DVec2::ZERO, at);
        Point2::new(at.x, at.y)
    }

    fn leave(&self, at: Point2<f64>) -> DVec2 {
        let place = self.low + DVec2::new(at.x, at.y) / self.sides * (self.high - self.low);
        place.clamp(self.low, self.high)
    }
}
