//! How densely points are spread.

use perpend_kernel::{Definition, Direction};
use perpend_knowledge::Categories;
use serde::{Deserialize, Serialize};

use super::speed;
use crate::plan::Settings;

/// How densely points are spread along a curve or along a direction of a surface (Piegl et al. 2008, §5).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Steps {
    /// The largest distance between neighbours, as a share of the arc length; above 0, at most 1.
    pub tolerance: f64,
    /// The least distance between neighbours, as a share of the largest; above 0, at most 1.
    pub jitter: f64,
}

/// What a [`Wave`](super::Wave) is made with.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct WaveSettings {
    /// The first decomposition, of the whole entity, in u and in v.
    pub decomposition: [Steps; 2],
    /// The second decomposition, of each segment that a wave meets.
    pub sampling: Steps,
}

/// The finest tolerance: below it, more points are asked for than any entity is given.
const FINEST: f64 = 1e-4;

/// The least jitter: below it a step may be anything.
const LOOSEST: f64 = 0.05;

/// The jitter of the paper's tests.
const JITTER: f64 = 0.8;

impl Steps {
    /// Steps of at most this share of the arc length, with the jitter of the paper's tests: 80 %.
    #[must_use]
    pub fn of(tolerance: f64) -> Self {
        Self { tolerance, jitter: JITTER }
    }

    /// The same within what has a meaning: a share that is no number is 1.
    pub(super) fn bounded(self) -> Self {
        Self { tolerance: self.tolerance.clamp(FINEST, 1.0).min(1.0), jitter: self.jitter.clamp(LOOSEST, 1.0).min(1.0) }
    }
}

impl WaveSettings {
    /// What the paper recommends (§7): a decomposition at 5 % for curves and 10 % for surfaces, and a sampling at 1 %.
    #[must_use]
    pub fn recommended(definition: &Definition) -> Self {
        let tolerance = match definition {
            Definition::NurbsCurve(_) => 0.05,
            Definition::NurbsSurface(_) => 0.1,
        };
        Self { decomposition: [Steps::of(tolerance); 2], sampling: Steps::of(0.01) }
    }

    /// The decomposition by the parametrisation factor, with the paper's sampling: from a plan's settings where they name it, else from
    /// the speeds of the definition, sampled, by the default table of [`Categories`].
    #[must_use]
    pub fn of(definition: &Definition, settings: &Settings) -> Self {
        let categories = Categories::default();
        let steps = |direction: Direction| {
            let known = settings.decomposition.iter().find(|d| d.direction == direction);
            known.map_or_else(
                || {
                    let category = categories.of(speed::factor(definition, direction));
                    Steps { tolerance: category.tolerance, jitter: category.jitter }
                },
                |known| Steps { tolerance: known.tolerance, jitter: known.jitter },
            )
        };
        Self { decomposition: [steps(Direction::U), steps(Direction::V)], sampling: Steps::of(0.01) }
    }
}
