//! Degree elevation.

use super::change::Change;
use super::invalid::InvalidEdit;
use crate::curve::NurbsCurve;
use crate::invalid::{Along, Direction};
use crate::knots::{KnotVector, MAX_DEGREE};
use crate::surface::NurbsSurface;

impl NurbsCurve {
    /// The same curve, its degree higher by `by`; the continuity at every knot stays as it is.
    ///
    /// The NURBS Book, §5.5 (the result of algorithm A5.9). The shape moves by rounding alone, a few `by * degree * ε` of
    /// the largest coordinate.
    ///
    /// # Errors
    ///
    /// The degree would pass [`MAX_DEGREE`]; too many control points.
    pub fn elevate_degree(&self, by: usize) -> Result<Self, InvalidEdit> {
        check(&self.knots, by, 1, Along::Curve)?;
        Ok((0..by).fold(self.clone(), |curve, _| curve.changed(Change::elevation(&curve.knots))))
    }
}

impl NurbsSurface {
    /// The same surface, its degree in a direction higher by `by`. The NURBS Book, §5.5; accuracy as for curves.
    ///
    /// # Errors
    ///
    /// The degree would pass [`MAX_DEGREE`]; too many control points.
    pub fn elevate_degree(&self, direction: Direction, by: usize) -> Result<Self, InvalidEdit> {
        check(self.knots(direction), by, self.lines(direction), Along::Surface(direction))?;
        let raise = |surface: Self, _| surface.changed(direction, Change::elevation(surface.knots(direction)));
        Ok((0..by).fold(self.clone(), raise))
    }
}

fn check(knots: &KnotVector, by: usize, lines: usize, along: Along) -> Result<(), InvalidEdit> {
    let degree = knots.degree().saturating_add(by);
    if degree > MAX_DEGREE {
        return Err(InvalidEdit::Degree { along, degree });
    }
    // every span gains a point a step
    Change::check_count(knots.point_count() + by * knots.spans().count(), lines)
}
