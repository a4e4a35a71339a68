//! Knot insertion and refinement.

use super::change::Change;
use super::invalid::InvalidEdit;
use crate::curve::NurbsCurve;
use crate::invalid::{Along, Direction};
use crate::knots::KnotVector;
use crate::surface::NurbsSurface;

impl NurbsCurve {
    /// The same curve with the knot `u` inserted `times` times.
    ///
    /// The NURBS Book, §5.2 (the result of algorithm A5.1). The shape moves by rounding alone, a few `degree * ε` of the
    /// largest coordinate.
    ///
    /// # Errors
    ///
    /// `u` is not strictly inside the domain, or would occur more often than the degree.
    pub fn insert_knot(&self, u: f64, times: usize) -> Result<Self, InvalidEdit> {
        self.refine(&repeated(&self.knots, u, times, Along::Curve)?)
    }

    /// The same curve with all of `knots` inserted, in any order; one that stands there twice is inserted twice.
    ///
    /// The NURBS Book, §5.3. Accuracy as of [`insert_knot`](Self::insert_knot).
    ///
    /// # Errors
    ///
    /// One of them is not strictly inside the domain, or would occur more often than the degree; too many control points.
    pub fn refine(&self, knots: &[f64]) -> Result<Self, InvalidEdit> {
        let added = checked(&self.knots, knots, Along::Curve)?;
        Change::check_count(self.control_points.len() + added.len(), 1)?;
        Ok(self.changed(Change::refinement(&self.knots, &added)))
    }
}

impl NurbsSurface {
    /// The same surface with the knot `at` of a direction inserted `times` times.
    ///
    /// The NURBS Book, §5.2 (the result of algorithm A5.3). Accuracy as for curves.
    ///
    /// # Errors
    ///
    /// `at` is not strictly inside the domain, or would occur more often than the degree; too many control points.
    pub fn insert_knot(&self, direction: Direction, at: f64, times: usize) -> Result<Self, InvalidEdit> {
        self.refine(direction, &repeated(self.knots(direction), at, times, Along::Surface(direction))?)
    }

    /// The same surface with all of `knots` inserted in a direction, in any order.
    ///
    /// The NURBS Book, §5.3. Accuracy as for curves.
    ///
    /// # Errors
    ///
    /// As [`insert_knot`](Self::insert_knot).
    pub fn refine(&self, direction: Direction, knots: &[f64]) -> Result<Self, InvalidEdit> {
        let old = self.knots(direction);
        let added = checked(old, knots, Along::Surface(direction))?;
        Change::check_count(old.point_count() + added.len(), self.lines(direction))?;
        Ok(self.changed(direction, Change::refinement(old, &added)))
    }
}

/// The list of one knot, `times` times: checked before it is made, since a caller may ask for any number.
fn repeated(old: &KnotVector, at: f64, times: usize, along: Along) -> Result<Vec<f64>, InvalidEdit> {
    let multiplicity = old.multiplicity(at).saturating_add(times);
    inside(old, at, along)?;
    if multiplicity > old.degree() {
        return Err(InvalidEdit::Multiplicity { along, knot: at, multiplicity, degree: old.degree() });
    }
    Ok(vec![at; times])
}

/// The knots in ascending order, where all of them may be inserted.
fn checked(old: &KnotVector, knots: &[f64], along: Along) -> Result<Vec<f64>, InvalidEdit> {
    for at in knots {
        inside(old, *at, along)?;
    }
    let mut added = knots.to_vec();
    added.sort_by(f64::total_cmp);
    for run in added.chunk_by(|a, b| a == b) {
        let (knot, multiplicity) = (run[0], old.multiplicity(run[0]) + run.len());
        if multiplicity > old.degree() {
            return Err(InvalidEdit::Multiplicity { along, knot, multiplicity, degree: old.degree() });
        }
    }
    Ok(added)
}

/// Refuses parameters that are not strictly inside the domain.
pub(super) fn inside(knots: &KnotVector, at: f64, along: Along) -> Result<(), InvalidEdit> {
    let (first, last) = knots.domain();
    if first < at && at < last { Ok(()) } else { Err(InvalidEdit::Parameter { along, at, first, last, inside: true }) }
}
