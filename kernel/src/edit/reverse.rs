//! Reversal.

use crate::curve::NurbsCurve;
use crate::invalid::Direction;
use crate::knots::KnotVector;
use crate::surface::NurbsSurface;

impl NurbsCurve {
    /// The same points run through backwards: the result at `-u` is this curve at `u`.
    ///
    /// Exact, and its own inverse. (`first + last - u`, which would keep the domain, rounds: short spans would change
    /// their shape or vanish. [`with_domain`](Self::with_domain) does that where it is wanted.)
    #[must_use]
    pub fn reversed(&self) -> Self {
        Self {
            knots: negated(&self.knots),
            control_points: self.control_points.iter().rev().copied().collect(),
            weights: self.weights().map(|w| w.iter().rev().copied().collect()),
        }
    }
}

impl NurbsSurface {
    /// The same points with one direction run through backwards: the parameter changes its sign there. Exact, as for curves.
    ///
    /// The normal changes its side.
    #[must_use]
    pub fn reversed(&self, direction: Direction) -> Self {
        let (rows, columns) = (self.rows(), self.columns());
        let from = |k: usize| match direction {
            Direction::U => (rows - 1 - k / columns) * columns + k % columns,
            Direction::V => (k / columns) * columns + columns - 1 - k % columns,
        };
        let (mut u, mut v) = (self.u.clone(), self.v.clone());
        match direction {
            Direction::U => u = negated(&u),
            Direction::V => v = negated(&v),
        }
        Self {
            u,
            v,
            control_points: (0..rows * columns).map(|k| self.control_points[from(k)]).collect(),
            weights: self.weights().map(|w| (0..rows * columns).map(|k| w[from(k)]).collect()),
        }
    }
}

fn negated(knots: &KnotVector) -> KnotVector {
    // 0 - knot: no negative zeros, which files would show
    KnotVector::trusted(knots.degree(), knots.as_slice().iter().rev().map(|knot| 0.0 - knot).collect())
}
