//! Degree reduction, with a proven bound of what it changes.
//!
//! The curve of the lower degree is the one whose elevation is nearest: the equations `E Q = P`, with `E` the matrix of
//! elevation, are solved by least squares in homogeneous form, about the box's centre. The proof elevates the result and
//! compares control points ([`NurbsCurve::deviation_from`]).

use glam::DVec3;

use super::blend::Blend;
use super::change::Change;
use super::fit::{Fitted, fit};
use super::invalid::InvalidEdit;
use crate::curve::NurbsCurve;
use crate::invalid::Direction;
use crate::knots::KnotVector;
use crate::surface::NurbsSurface;

/// What degree reduction made of an entity.
#[derive(Debug, Clone, PartialEq)]
pub struct DegreeReduction<T> {
    /// The entity, its degree lower by 1.
    pub entity: T,
    /// No point of the entity moved farther than this, rounding included.
    pub deviation: f64,
}

impl NurbsCurve {
    /// The curve with its degree lower by 1, where no point moves farther than `tolerance`; none where one does, where the degree
    /// is 1, or where a knot is simple (a curve of the lower degree cannot be as smooth there: see whether the knot can go).
    ///
    /// The ends keep their bits.
    ///
    /// # Errors
    ///
    /// The tolerance is negative or not a number.
    pub fn reduce_degree(&self, tolerance: f64) -> Result<Option<DegreeReduction<Self>>, InvalidEdit> {
        check(tolerance)?;
        let reduced = || {
            let knots = lowered(&self.knots)?;
            let (points, weights) = solve(&knots, &self.control_points, self.weights(), 1)?;
            let entity = Self::checked(knots, points, weights).ok()?;
            let deviation = self.deviation_from(&entity)?;
            (deviation <= tolerance).then_some(DegreeReduction { entity, deviation })
        };
        Ok(reduced())
    }
}

impl NurbsSurface {
    /// The surface with its degree in a direction lower by 1; see [`NurbsCurve::reduce_degree`]. The edges at both ends of the
    /// direction keep their bits.
    ///
    /// # Errors
    ///
    /// The tolerance is negative or not a number.
    pub fn reduce_degree(
        &self,
        direction: Direction,
        tolerance: f64,
    ) -> Result<Option<DegreeReduction<Self>>, InvalidEdit> {
        check(tolerance)?;
        if direction == Direction::V {
            let swapped = self.swapped().reduce_degree(Direction::U, tolerance)?;
            return Ok(swapped.map(|reduced| DegreeReduction { entity: reduced.entity.swapped(), ..reduced }));
        }
        let reduced = || {
            let knots = lowered(&self.u)?;
            let (points, weights) = solve(&knots, &self.control_points, self.weights(), self.columns())?;
            let entity = Self::checked(knots, self.v.clone(), points, weights).ok()?;
            let deviation = self.deviation_from(&entity)?;
            (deviation <= tolerance).then_some(DegreeReduction { entity, deviation })
        };
        Ok(reduced())
    }
}

fn check(tolerance: f64) -> Result<(), InvalidEdit> {
    if tolerance.is_nan() || tolerance < 0.0 { Err(InvalidEdit::Tolerance { tolerance }) } else { Ok(()) }
}

/// The knots whose elevation these are.
fn lowered(knots: &KnotVector) -> Option<KnotVector> {
    if knots.degree() == 1 || knots.breaks().any(|b| b.multiplicity == 1) {
        return None;
    }
    let all = knots.distinct().flat_map(|(knot, multiplicity)| std::iter::repeat_n(knot, multiplicity - 1));
    Some(KnotVector::trusted(knots.degree() - 1, all.collect()))
}

/// The points of `width` lines over the knots whose elevation is nearest to the given ones, and their weights.
fn solve(knots: &KnotVector, points: &[DVec3], weights: Option<&[f64]>, width: usize) -> Option<Fitted> {
    let rows: Vec<_> = Change::elevation(knots).blends.iter().map(Blend::row).collect();
    fit(&rows, points, weights, width, knots.point_count())
}
