//! The control net of a surface, one direction first.

use glam::{DVec2, DVec3};
use perpend_kernel::{Direction, KnotVector, NurbsSurface};

/// A surface with one of its directions named the first.
#[derive(Debug, Clone, Copy)]
pub(super) struct Grid<'a> {
    surface: &'a NurbsSurface,
    first: Direction,
}

impl<'a> Grid<'a> {
    pub(super) fn new(surface: &'a NurbsSurface, first: Direction) -> Self {
        Self { surface, first }
    }

    /// Control points along the first and along the other direction.
    pub(super) fn count(&self) -> (usize, usize) {
        let (rows, columns) = (self.surface.rows(), self.surface.columns());
        if self.first == Direction::U { (rows, columns) } else { (columns, rows) }
    }

    fn index(&self, i: usize, j: usize) -> usize {
        let (row, column) = if self.first == Direction::U { (i, j) } else { (j, i) };
        row * self.surface.columns() + column
    }

    pub(super) fn point(&self, i: usize, j: usize) -> DVec3 {
        self.surface.control_points()[self.index(i, j)]
    }

    pub(super) fn weight(&self, i: usize, j: usize) -> f64 {
        self.surface.weights().map_or(1.0, |w| w[self.index(i, j)])
    }

    /// The knots of the first direction.
    pub(super) fn along(&self) -> &'a KnotVector {
        self.surface.knots(self.first)
    }

    /// The knots of the other direction.
    pub(super) fn across(&self) -> &'a KnotVector {
        let other = if self.first == Direction::U { Direction::V } else { Direction::U };
        self.surface.knots(other)
    }

    /// A pair of parameters, that of the first direction first, as `(u, v)`.
    pub(super) fn parameters(first: Direction, pair: (f64, f64)) -> DVec2 {
        if first == Direction::U { DVec2::new(pair.0, pair.1) } else { DVec2::new(pair.1, pair.0) }
    }
}
