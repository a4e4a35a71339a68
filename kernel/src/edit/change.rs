//! A change of basis along one parameter, applied to every line of a net.

use glam::DVec3;

use super::blend::Blend;
use super::invalid::InvalidEdit;
use crate::curve::{NurbsCurve, POINT_LIMIT};
use crate::invalid::Direction;
use crate::knots::KnotVector;
use crate::surface::NurbsSurface;

/// A new knot vector, and each of its control points as a blend of the old ones.
#[derive(Debug, Clone)]
pub(crate) struct Change {
    pub(crate) knots: KnotVector,
    pub(crate) blends: Vec<Blend>,
}

impl Change {
    /// The same entity with more knots: `added` ascend, lie inside the domain, and leave no knot above the degree.
    ///
    /// The result of The NURBS Book, algorithm A5.4.
    pub(crate) fn refinement(old: &KnotVector, added: &[f64]) -> Self {
        let p = old.degree();
        let mut knots = Vec::with_capacity(old.as_slice().len() + added.len());
        let mut added = added.iter().copied().peekable();
        for knot in old.as_slice() {
            while let Some(next) = added.next_if(|next| next < knot) {
                knots.push(next);
            }
            knots.push(*knot);
        }
        let blends = (0..knots.len() - p - 1).map(|i| Blend::blossom(p, old.as_slice(), &knots[i + 1..=i + p]));
        Self { blends: blends.collect(), knots: KnotVector::trusted(p, knots) }
    }

    /// The same entity, of a degree one higher.
    ///
    /// With `f` the blossom of degree `p`, the point of the knots `t_1 … t_(p+1)` is the mean of `f` over the `p + 1` ways to
    /// leave one of them out (Ramshaw; The NURBS Book, equation 5.36, is its case of one span). Each of these is a control point
    /// of some refinement, so that the mean is a convex combination.
    pub(crate) fn elevation(old: &KnotVector) -> Self {
        let p = old.degree();
        let mut knots = Vec::new();
        for (knot, multiplicity) in old.distinct() {
            knots.extend(std::iter::repeat_n(knot, multiplicity + 1));
        }
        let blend = |i: usize| {
            let all = &knots[i + 1..=i + p + 1];
            let mut parts = Vec::new();
            let mut at = 0;
            for run in all.chunk_by(|a, b| a == b) {
                let mut arguments = all.to_vec();
                arguments.remove(at);
                parts.push((Blend::blossom(p, old.as_slice(), &arguments), run.len()));
                at += run.len();
            }
            Blend::mean(&parts, p + 1)
        };
        let blends = (0..knots.len() - p - 2).map(blend).collect();
        Self { blends, knots: KnotVector::trusted(p + 1, knots) }
    }

    /// Refuses a result beyond what a definition may have; `lines` is how many lines of points the change is applied to.
    pub(crate) fn check_count(points: usize, lines: usize) -> Result<(), InvalidEdit> {
        let points = points.saturating_mul(lines);
        if points > POINT_LIMIT { Err(InvalidEdit::TooManyPoints { points }) } else { Ok(()) }
    }
}

impl NurbsCurve {
    pub(crate) fn changed(&self, change: Change) -> Self {
        let blend = |blend: &Blend| blend.of(&self.control_points, self.weights(), |i| i);
        let (control_points, weights): (Vec<DVec3>, Vec<f64>) = change.blends.iter().map(blend).unzip();
        Self { knots: change.knots, control_points, weights: self.weights.is_some().then_some(weights) }
    }
}

impl NurbsSurface {
    pub(crate) fn changed(&self, direction: Direction, change: Change) -> Self {
        let (rows, columns) = (self.rows(), self.columns());
        let mut net = Vec::with_capacity(change.blends.len() * if direction == Direction::U { columns } else { rows });
        let (points, weights) = (&self.control_points, self.weights());
        let (mut u, mut v) = (self.u.clone(), self.v.clone());
        match direction {
            Direction::U => {
                for blend in &change.blends {
                    net.extend((0..columns).map(|j| blend.of(points, weights, |i| i * columns + j)));
                }
                u = change.knots;
            }
            Direction::V => {
                for i in 0..rows {
                    net.extend(change.blends.iter().map(|blend| blend.of(points, weights, |j| i * columns + j)));
                }
                v = change.knots;
            }
        }
        let (control_points, weights): (Vec<DVec3>, Vec<f64>) = net.into_iter().unzip();
        Self { u, v, control_points, weights: self.weights.is_some().then_some(weights) }
    }

    /// How many lines of control points run in a direction.
    pub(crate) fn lines(&self, direction: Direction) -> usize {
        match direction {
            Direction::U => self.columns(),
            Direction::V => self.rows(),
        }
    }
}
