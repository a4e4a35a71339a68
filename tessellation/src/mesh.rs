//! Triangles in space.

use glam::{DVec2, DVec3};

/// Triangles of a surface or a trimmed face, with the parameters and normals of their corners.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Mesh {
    /// The corners: the surface evaluated at `parameters`.
    pub vertices: Vec<DVec3>,
    /// The outward unit normal at each vertex; where the surface has none, the mean of the triangles there.
    pub normals: Vec<DVec3>,
    /// The parameters of each vertex.
    pub parameters: Vec<DVec2>,
    /// The corners of each triangle, counter-clockwise seen from the side of the outward normal.
    pub triangles: Vec<[u32; 3]>,
    /// The proven chord error.
    ///
    /// Every point of the mesh is within it of the face. Every point of the face is within it of the mesh, except where parts of the
    /// face are thinner than it and whole parts may have no triangle.
    pub error: f64,
}

impl Mesh {
    /// The corners of each triangle.
    pub fn corners(&self) -> impl ExactSizeIterator<Item = [DVec3; 3]> + '_ {
        self.triangles.iter().map(|triangle| triangle.map(|i| self.vertices[i as usize]))
    }

    /// The area of the triangles.
    #[must_use]
    pub fn area(&self) -> f64 {
        self.corners().map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length()).sum()
    }

    /// The volume that the triangles enclose with the origin; of a closed mesh its volume, positive where normals point outward.
    #[must_use]
    pub fn volume(&self) -> f64 {
        self.corners().map(|[a, b, c]| a.dot(b.cross(c)) / 6.0).sum()
    }
}
