//! Tangent cones: a cone that holds every partial derivative of a segment (Selimovic 2006, §4.3).

use glam::DVec3;
use perpend_kernel::binomial;

use super::segment::Segment;

/// Vectors of which every partial derivative of a segment in one direction is a combination with non-negative factors.
#[derive(Debug)]
pub(super) struct Hodograph {
    vectors: Vec<DVec3>,
    columns: usize,
}

impl Hodograph {
    /// The vectors of a segment in a direction; none where it is rational and has interior knots.
    ///
    /// Polynomial: first differences of the net. Rational (Saito, Wang and Sederberg 1995): the Bernstein coefficients of `A' w - A w'`,
    /// which has the derivative's direction; the degree is `2 p - 2` in the direction and `2 q` in the other one, and a
    /// coefficient is a sum of `w w' (P' - P)` over pairs of control points, the one with the higher index first.
    pub(super) fn of(segment: &Segment, direction: usize) -> Option<Self> {
        let [rows, columns] = segment.count;
        if !segment.rational {
            let step = if direction == 0 { [1, 0] } else { [0, 1] };
            let columns = columns - step[1];
            let vectors = (0..(rows - step[0]) * columns).map(|k| {
                let (i, j) = (k / columns, k % columns);
                segment.at(i + step[0], j + step[1]) - segment.at(i, j)
            });
            return Some(Self { vectors: vectors.collect(), columns });
        }
        if !segment.is_bezier() {
            return None;
        }
        let [p, q] = segment.degree;
        let lowered = if direction == 0 { [1, 0] } else { [0, 1] };
        let columns = 2 * q + 1 - 2 * lowered[1];
        let mut vectors = vec![DVec3::ZERO; (2 * p + 1 - 2 * lowered[0]) * columns];
        let pieces: Vec<(usize, usize, f64)> = (0..=p)
            .flat_map(|i| (0..=q).map(move |j| (i, j)))
            .map(|(i, j)| (i, j, binomial(p, i) * binomial(q, j) * segment.weight(i, j)))
            .collect();
        for (i, j, factor) in &pieces {
            for (k, l, other) in &pieces {
                let steps = if direction == 0 { (*k).saturating_sub(*i) } else { (*l).saturating_sub(*j) };
                if steps > 0 {
                    let at = (i + k - lowered[0]) * columns + j + l - lowered[1];
                    vectors[at] += steps as f64 * factor * other * (segment.at(*k, *l) - segment.at(*i, *j));
                }
            }
        }
        Some(Self { vectors, columns })
    }

    /// The smallest cone about the middle of the vectors' directions; none where it is not narrower than a half space.
    pub(super) fn cone(&self) -> Option<Cone> {
        let units = self.vectors.iter().filter_map(|vector| unit(*vector));
        let (low, high) = units
            .clone()
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), unit| (low.min(unit), high.max(unit)));
        let axis = unit(0.5 * (low + high)).filter(|axis| axis.is_finite())?;
        let mut sine = 0.0_f64;
        for unit in units {
            if unit.dot(axis) <= 0.0 {
                return None;
            }
            // not from the cosine: that loses half the digits of a small angle
            sine = sine.max(unit.cross(axis).length());
        }
        Some(Cone { axis, sine: sine.min(1.0) })
    }

    /// Whether the derivative vanishes nowhere on the border at an end of its direction, if its cone is narrower than a half space.
    pub(super) fn is_regular(&self, direction: usize, end: usize) -> bool {
        let rows = self.vectors.len() / self.columns;
        let nonzero = |i: usize, j: usize| self.vectors[i * self.columns + j] != DVec3::ZERO;
        match (direction, end) {
            (0, 0) => (0..self.columns).all(|j| nonzero(0, j)),
            (0, _) => (0..self.columns).all(|j| nonzero(rows - 1, j)),
            (_, 0) => (0..rows).all(|i| nonzero(i, 0)),
            (_, _) => (0..rows).all(|i| nonzero(i, self.columns - 1)),
        }
    }
}

/// A closed cone of directions around an axis, narrower than a half space.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cone {
    axis: DVec3,
    /// Sine of the angle between the axis and the border.
    sine: f64,
}

impl Cone {
    /// Whether `<d, w> > 0` for every `w` of the cone but 0: the angle between `d` and the axis is smaller than a right angle less
    /// the cone's.
    pub(super) fn is_ahead(&self, d: DVec3) -> bool {
        d.dot(self.axis) > d.length() * self.sine
    }
}

/// The direction of a vector; none of 0. Scaled first: products of weights may be tiny.
fn unit(vector: DVec3) -> Option<DVec3> {
    let largest = vector.abs().max_element();
    (largest > 0.0).then(|| (vector / largest).normalize())
}
