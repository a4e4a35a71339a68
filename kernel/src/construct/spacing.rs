//! Parameters for points that a curve shall pass.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::invalid::{Along, InvalidDefinition};
use crate::knots::KnotVector;

/// How the parameters of interpolated points are spread over `[0, 1]`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Spacing {
    /// Evenly. For points that are spread evenly themselves. The NURBS Book, equation 9.3.
    Uniform,
    /// By the lengths of the chords: speed is near constant. The NURBS Book, equation 9.5.
    #[default]
    ChordLength,
    /// By the square roots of the chords: calmer round sharp turns. The NURBS Book, equation 9.6.
    Centripetal,
}

impl Spacing {
    /// The parameters of a line of points, from 0 to 1; none where all points are equal (unless uniform).
    pub(super) fn parameters(self, points: &[DVec3]) -> Option<Vec<f64>> {
        let step = |pair: &[DVec3]| match self {
            Self::Uniform => 1.0,
            Self::ChordLength => pair[0].distance(pair[1]),
            Self::Centripetal => pair[0].distance(pair[1]).sqrt(),
        };
        let mut sum = 0.0;
        let mut sums = vec![0.0];
        sums.extend(points.windows(2).map(|pair| {
            sum += step(pair);
            sum
        }));
        (sum > 0.0).then(|| sums.into_iter().map(|s| s / sum).collect())
    }
}

/// The knots of a curve of a degree through points at these parameters: inner knots are averages of `degree` parameters.
///
/// The NURBS Book, equation 9.8; the system of interpolation is then banded and totally positive.
///
/// # Errors
///
/// Parameters so near each other that their averages fall together.
pub(super) fn averaged_knots(degree: usize, parameters: &[f64]) -> Result<KnotVector, InvalidDefinition> {
    let mut knots = vec![0.0; degree + 1];
    let inner = 1..parameters.len() - degree;
    knots.extend(inner.map(|j| parameters[j..j + degree].iter().sum::<f64>() / degree as f64));
    knots.extend(vec![1.0; degree + 1]);
    KnotVector::new(degree, knots, parameters.len(), Along::Curve)
}
