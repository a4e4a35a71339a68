//! The linear system of interpolation.

use glam::DVec3;

use super::spacing::averaged_knots;
use crate::basis;
use crate::curve::COORDINATE_LIMIT;
use crate::edit::InvalidEdit;
use crate::invalid::InvalidDefinition;
use crate::knots::{KnotVector, MAX_DEGREE};

/// Why no curve or surface was laid through points.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum InvalidInterpolation {
    /// The degree is outside 1 to [`MAX_DEGREE`], or there are too few points for it.
    #[error("{points} points and degree {degree}; give a degree from 1 to 25 and at least degree + 1 points")]
    Degree {
        /// How many points there are, along the direction concerned.
        points: usize,
        /// The degree.
        degree: usize,
    },
    /// A coordinate is infinite, not a number, or beyond 1e70.
    #[error("point {index} is {point}; coordinates are finite and within ±1e70")]
    BadPoint {
        /// Which point, in row order.
        index: usize,
        /// The point.
        point: DVec3,
    },
    /// Two neighbouring points (in a grid: rows or columns) have the same parameter, being equal or too near each other.
    #[error(
        "point {index} and the one before it get the same parameter: drop one of them, or space the parameters uniformly"
    )]
    Repeated {
        /// The second of them.
        index: usize,
    },
    /// A row of the grid is not as long as the first.
    #[error("row {row} has {found} points, row 0 has {expected}; all rows of the grid are equally long")]
    RaggedRow {
        /// Index of the row.
        row: usize,
        /// Its length.
        found: usize,
        /// The first row's length.
        expected: usize,
    },
    /// The sections of a loft cannot be given one degree and one knot vector.
    #[error("the sections cannot be given one degree and one knot vector: {0}")]
    Sections(InvalidEdit),
    /// The result is not a valid definition.
    #[error("the result is not valid: {0}")]
    Result(#[from] InvalidDefinition),
}

/// Checks degree and points before anything is computed with them.
pub(super) fn check(count: usize, degree: usize) -> Result<(), InvalidInterpolation> {
    if (1..=MAX_DEGREE).contains(&degree) && count > degree {
        Ok(())
    } else {
        Err(InvalidInterpolation::Degree { points: count, degree })
    }
}

pub(super) fn check_finite(points: impl Iterator<Item = DVec3>) -> Result<(), InvalidInterpolation> {
    for (index, point) in points.enumerate() {
        // not `>`: a NaN must fail too
        if !point.abs().cmple(DVec3::splat(COORDINATE_LIMIT)).all() {
            return Err(InvalidInterpolation::BadPoint { index, point });
        }
    }
    Ok(())
}

/// The matrix `N_j(u_i)` of interpolation, factored: lines of points are solved with it.
///
/// It is banded and totally positive, so that elimination without exchanges is stable (de Boor, *A Practical Guide to Splines*,
/// chapter XIII).
pub(super) struct System {
    pub(super) knots: KnotVector,
    /// Row `i` holds the entries of columns `i - degree ..= i + degree`; below the diagonal, the multipliers.
    rows: Vec<Vec<f64>>,
}

impl System {
    /// The system of a degree at ascending parameters from 0 to 1.
    pub(super) fn new(degree: usize, parameters: &[f64]) -> Result<Self, InvalidInterpolation> {
        if let Some(before) = parameters.windows(2).position(|pair| pair[0] >= pair[1]) {
            return Err(InvalidInterpolation::Repeated { index: before + 1 });
        }
        let (p, count) = (degree, parameters.len());
        let knots = averaged_knots(p, parameters)?;
        let mut rows = vec![vec![0.0; 2 * p + 1]; count];
        for (i, u) in parameters.iter().enumerate() {
            let span = knots.find_span(*u);
            let values = basis::functions::<{ basis::ROOM }>(&knots, span, *u);
            for (k, value) in values[..=p].iter().enumerate().filter(|(_, value)| **value != 0.0) {
                // column j of row i stands at j - i + p; it lies within, by Schoenberg and Whitney's condition
                match (span + k).checked_sub(i).filter(|place| *place <= 2 * p) {
                    Some(place) => rows[i][place] = *value,
                    None => return Err(InvalidInterpolation::Repeated { index: i }),
                }
            }
        }
        for i in 0..count {
            let (done, below) = rows.split_at_mut(i + 1);
            let pivot = &done[i];
            if pivot[p] <= 0.0 {
                return Err(InvalidInterpolation::Repeated { index: i });
            }
            for (step, row) in below.iter_mut().take(p).enumerate().map(|(k, row)| (k + 1, row)) {
                let factor = row[p - step] / pivot[p];
                row[p - step] = factor;
                for k in 1..=p {
                    row[p - step + k] -= factor * pivot[p + k];
                }
            }
        }
        Ok(Self { knots, rows })
    }

    /// The control points of the curve through `points`.
    pub(super) fn solve(&self, points: &[DVec3]) -> Vec<DVec3> {
        let (p, count) = (self.knots.degree(), points.len());
        let mut x = points.to_vec();
        for i in 0..count {
            for step in 1..=p.min(i) {
                let known = x[i - step];
                x[i] -= self.rows[i][p - step] * known;
            }
        }
        for i in (0..count).rev() {
            for step in 1..=p.min(count - 1 - i) {
                let known = x[i + step];
                x[i] -= self.rows[i][p + step] * known;
            }
            x[i] /= self.rows[i][p];
        }
        x
    }
}
