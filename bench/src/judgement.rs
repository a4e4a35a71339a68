//! What makes an answer wrong, its bound false, or its proof incomplete.

use glam::DVec3;
use perpend_kernel::Definition;
use perpend_projection::FootPoint;

use crate::corpus::Row;

/// The default gap, and the largest error of a right distance, as shares of the size.
const GAP: f64 = 1e-9;

/// How finely the sets' distances are known, as a share of the size.
const TRUTH: f64 = 1e-10;

/// Judges the answers of one entity.
#[derive(Debug, Clone, Copy)]
pub struct Judge {
    size: f64,
    reach: f64,
    gap: f64,
    exact: bool,
}

/// What answers were found guilty of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Faults {
    /// Distances that are off by more than 1e-9 of the size.
    pub wrong: u64,
    /// Lower bounds above the true distance.
    pub false_bounds: u64,
    /// Answers that are not proven to within the gap.
    pub open: u64,
}

impl Judge {
    /// A judge of answers to queries with the default gap, by rows with true distances.
    #[must_use]
    pub fn new(definition: &Definition) -> Self {
        let size = definition.size();
        Self { size, reach: definition.reach(), gap: GAP * size, exact: true }
    }

    /// The same for queries with this gap, in the model's unit.
    #[must_use]
    pub fn with_gap(self, gap: f64) -> Self {
        Self { gap, ..self }
    }

    /// The same where the rows hold the best distances that are known, each of a real point: a nearer answer is right.
    #[must_use]
    pub fn by_best_known(self) -> Self {
        Self { exact: false, ..self }
    }

    /// The faults of an answer to a row.
    #[must_use]
    pub fn faults(&self, row: &Row, foot: &FootPoint) -> Faults {
        // points of the world: 16 ulps of the largest coordinate, and what the square root leaves of the distance
        let noise = 16.0 * f64::EPSILON * self.reach.max(row.point.abs().max_element()) + 1e-13 * row.distance;
        let excess = foot.distance - row.distance;
        let error = if self.exact { excess.abs() } else { excess };
        Faults {
            wrong: u64::from(error > GAP * self.size + noise),
            false_bounds: u64::from(foot.lower_bound > row.distance + TRUTH * self.size + noise),
            open: u64::from(self.is_open(row.point, foot)),
        }
    }

    /// Whether an answer to a query at `p` is not proven to within the gap, rounding aside.
    #[must_use]
    pub fn is_open(&self, p: DVec3, foot: &FootPoint) -> bool {
        foot.gap() > self.gap + 32.0 * f64::EPSILON * (self.reach + p.abs().max_element())
    }
}

impl Faults {
    /// Whether there are none.
    #[must_use]
    pub fn none(&self) -> bool {
        *self == Self::default()
    }
}

impl std::ops::AddAssign for Faults {
    fn add_assign(&mut self, other: Self) {
        self.wrong += other.wrong;
        self.false_bounds += other.false_bounds;
        self.open += other.open;
    }
}

impl std::iter::Sum for Faults {
    fn sum<I: Iterator<Item = Self>>(all: I) -> Self {
        all.fold(Self::default(), |mut sum, faults| {
            sum += faults;
            sum
        })
    }
}

impl std::fmt::Display for Faults {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { wrong, false_bounds, open } = self;
        write!(f, "{wrong} / {false_bounds} / {open}")
    }
}
