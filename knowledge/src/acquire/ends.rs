//! Ends that meet and edges that are one point.

use glam::DVec3;
use perpend_kernel::{Aabb, Definition, Direction, NurbsSurface};

/// An edge that is one point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pole {
    /// The direction that is constant along the edge.
    pub direction: Direction,
    /// Its value there.
    pub at: f64,
    /// The diagonal of the control points' box: no two points of the edge are farther apart.
    pub extent: f64,
}

/// The edges whose control points are one within `same`.
pub(super) fn poles(definition: &Definition, same: f64) -> Vec<Pole> {
    let Definition::NurbsSurface(surface) = definition else { return Vec::new() };
    let mut poles = Vec::new();
    for direction in [Direction::U, Direction::V] {
        let (first, last) = surface.domain(direction);
        for (at, is_end) in [(first, false), (last, true)] {
            let extent = Aabb::around(edge(surface, direction, is_end).into_iter().map(|(point, _)| point)).diagonal();
            if extent <= same {
                poles.push(Pole { direction, at, extent });
            }
        }
    }
    poles
}

/// The largest distance between the points at the start and at the end of a direction, where their control points tell it
/// exactly: those of edges whose weights are alike to the bit.
pub(super) fn gap(definition: &Definition, direction: Direction) -> Option<f64> {
    match (definition, direction) {
        (Definition::NurbsCurve(curve), Direction::U) => {
            let points = curve.control_points();
            Some(points[0].distance(points[points.len() - 1]))
        }
        (Definition::NurbsCurve(_), Direction::V) => None,
        (Definition::NurbsSurface(surface), _) => {
            let (start, end) = (edge(surface, direction, false), edge(surface, direction, true));
            let is_alike = start.iter().zip(&end).all(|(a, b)| a.1 == b.1);
            is_alike.then(|| start.iter().zip(&end).map(|(a, b)| a.0.distance(b.0)).fold(0.0, f64::max))
        }
    }
}

/// The control points with their weights at the start or at the end of a direction.
fn edge(surface: &NurbsSurface, direction: Direction, end: bool) -> Vec<(DVec3, f64)> {
    let (rows, columns) = (surface.rows(), surface.columns());
    let at = |k: usize| (surface.control_points()[k], surface.weights().map_or(1.0, |w| w[k]));
    match direction {
        Direction::U => (0..columns).map(|j| at(if end { (rows - 1) * columns + j } else { j })).collect(),
        Direction::V => (0..rows).map(|i| at(i * columns + if end { columns - 1 } else { 0 })).collect(),
    }
}
