//! Plane parallelograms.

use glam::{DVec2, DVec3};
use perpend_kernel::{Direction, NurbsSurface};

use super::axes::{Axes, ROUNDING};
use super::extruded::Extruded;
use super::net::Grid;
use super::range::Range;
use super::sector::Asked;
use super::{Built, Pair, Shape};
use crate::hierarchy::Frame;
use crate::solver::Tie;

/// A parallelogram about the origin, in the plane of the first two axes; the first side runs along the first axis.
#[derive(Debug)]
pub(super) struct Parallelogram {
    sides: [DVec2; 2],
    /// How far a point lies along each side, as a length along it, is its scalar product with these.
    duals: [DVec2; 2],
    ranges: [Range; 2],
}

/// The closed form of a parallelogram whose parameters run evenly across it: on straight lines along both sides.
pub(super) fn parallelogram(
    surface: &NurbsSurface,
    frame: &Frame,
    (origin, normal): (DVec3, DVec3),
    sides: (DVec3, DVec3),
    gap: f64,
) -> Option<Built<Shape>> {
    let grid = Grid::new(surface, Direction::U);
    let (n, m) = grid.count();
    let x = sides.0.try_normalize()?;
    let z = (normal - normal.dot(x) * x).try_normalize()?;
    let axes = Axes::new(frame, origin + 0.5 * sides.0 + 0.5 * sides.1, x, z.cross(x), z);
    let flat = |v: DVec3| DVec2::new(v.dot(x), v.dot(z.cross(x))) * frame.scale;
    let (a, b) = (flat(sides.0), flat(sides.1));
    let area = a.perp_dot(b);
    let duals = [-b.perp() / area * a.length(), a.perp() / area * b.length()];
    let lengths = |i, j| {
        let p = axes.enter(grid.point(i, j)).truncate();
        duals.map(|dual| dual.dot(p))
    };
    // the parametrisation is a product: each length depends on one index, and weights are products
    let slack = 4.0 * gap * frame.scale + 256.0 * ROUNDING;
    for i in 0..n {
        for j in 0..m {
            let [u, v] = lengths(i, j);
            let off = (u - lengths(i, 0)[0]).abs().max((v - lengths(0, j)[1]).abs());
            let product = grid.weight(i, 0) / grid.weight(0, 0) * grid.weight(0, j);
            let holds = off <= slack && (grid.weight(i, j) / product - 1.0).abs() <= slack;
            if !holds {
                return None;
            }
        }
    }
    if sides.0.dot(sides.1).abs() <= (gap + 8.0 * ROUNDING * sides.0.length()) * sides.1.length() {
        return Extruded::rectangle(surface, frame, origin, sides).map(|built| built.map(Shape::Extruded));
    }
    let ranges = [
        Range::new(0.5 * a.length(), grid.along(), (0..n).map(|i| (lengths(i, 0)[0], grid.weight(i, 0))))?,
        Range::new(0.5 * b.length(), grid.across(), (0..m).map(|j| (lengths(0, j)[1], grid.weight(0, j))))?,
    ];
    let sharp = area.abs() / (a.length() * b.length());
    let shape = Parallelogram { sides: [a.normalize(), b.normalize()], duals, ranges };
    // lengths along a side err by the inverse of the angle between both
    Some(Built { shape: Shape::Parallelogram(shape), axes, deviation: 0.0, radius: 1.0 / sharp })
}

impl Parallelogram {
    pub(super) fn foot(&self, q: DVec3, asked: &Asked) -> Pair {
        let p = q.truncate();
        let along = self.duals.map(|dual| dual.dot(p));
        let half = [self.ranges[0].half(), self.ranges[1].half()];
        let inside = (0..2).all(|k| along[k].abs() <= half[k]);
        let mut nearest = (0.0, along);
        if !inside {
            nearest.0 = f64::INFINITY;
            for k in 0..2 {
                for side in [-half[1 - k], half[1 - k]] {
                    let arm = p - side * self.sides[1 - k];
                    let at = arm.dot(self.sides[k]).clamp(-half[k], half[k]);
                    let square = (arm - at * self.sides[k]).length_squared();
                    if square < nearest.0 {
                        nearest = (square, if k == 0 { [at, side] } else { [side, at] });
                    }
                }
            }
        }
        let [u, v] = [0, 1].map(|k| self.ranges[k].clamp(nearest.1[k], asked.tolerance()).parameter);
        Pair { at: DVec2::new(u, v), distance: (nearest.0 + q.z * q.z).sqrt(), unproven: 0.0, tie: Tie::None }
    }
}
