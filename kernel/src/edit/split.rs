//! Splitting at a parameter.

use super::insert::inside;
use super::invalid::InvalidEdit;
use crate::curve::NurbsCurve;
use crate::invalid::{Along, Direction};
use crate::knots::KnotVector;
use crate::surface::NurbsSurface;

impl NurbsCurve {
    /// The parts before and after `u`, over `[first, u]` and `[u, last]`; they meet in the same bits.
    ///
    /// The knot is inserted up to the degree (The NURBS Book, §5.2), then the control points are dealt out.
    ///
    /// # Errors
    ///
    /// `u` is not strictly inside the domain; one part would be a single point.
    pub fn split(&self, u: f64) -> Result<(Self, Self), InvalidEdit> {
        inside(&self.knots, u, Along::Curve)?;
        let whole = self.refine(&vec![u; self.degree() - self.knots.multiplicity(u)])?;
        let (before, after) = parts(&whole.knots, u, Along::Curve)?;
        let meet = before.point_count() - 1;
        let part = |knots: KnotVector, start: usize| {
            let range = start..start + knots.point_count();
            let weights = whole.weights().map(|w| w[range.clone()].to_vec());
            Self::checked(knots, whole.control_points[range].to_vec(), weights)
        };
        Ok((part(before, 0)?, part(after, meet)?))
    }
}

impl NurbsSurface {
    /// The parts before and after the parameter `at` of a direction; they meet in the same bits.
    ///
    /// # Errors
    ///
    /// `at` is not strictly inside the domain; one part would be a single point; too many control points.
    pub fn split(&self, direction: Direction, at: f64) -> Result<(Self, Self), InvalidEdit> {
        let (along, knots) = (Along::Surface(direction), self.knots(direction));
        inside(knots, at, along)?;
        let whole = self.refine(direction, &vec![at; knots.degree() - knots.multiplicity(at)])?;
        let (before, after) = parts(whole.knots(direction), at, along)?;
        let meet = before.point_count() - 1;
        let part = |knots: KnotVector, start: usize| {
            let (rows, columns) = (whole.rows(), whole.columns());
            let end = start + knots.point_count();
            let ((i, j), u, v) = match direction {
                Direction::U => ((start..end, 0..columns), knots, whole.v.clone()),
                Direction::V => ((0..rows, start..end), whole.u.clone(), knots),
            };
            let places = i.flat_map(|i| j.clone().map(move |j| i * columns + j));
            let points = places.clone().map(|k| whole.control_points[k]).collect();
            let weights = whole.weights().map(|w| places.map(|k| w[k]).collect());
            Self::checked(u, v, points, weights)
        };
        Ok((part(before, 0)?, part(after, meet)?))
    }
}

/// The knots before and after `at`, which occurs as often as the degree.
fn parts(knots: &KnotVector, at: f64, along: Along) -> Result<(KnotVector, KnotVector), InvalidEdit> {
    let (p, t) = (knots.degree(), knots.as_slice());
    let end = t.partition_point(|knot| *knot <= at);
    let mut before = t[..end].to_vec();
    before.push(at);
    let mut after = vec![at];
    after.extend_from_slice(&t[end - p..]);
    let vector = |knots: Vec<f64>| {
        let points = knots.len() - p - 1;
        KnotVector::new(p, knots, points, along)
    };
    Ok((vector(before)?, vector(after)?))
}
