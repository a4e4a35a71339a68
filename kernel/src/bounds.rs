//! Boxes.

use glam::DVec3;
use serde::{Deserialize, Serialize};

/// An axis-aligned box, closed: all points with `min <= x <= max` in every coordinate.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Aabb {
    /// The least coordinates.
    pub min: DVec3,
    /// The greatest coordinates.
    pub max: DVec3,
}

impl Aabb {
    /// The box that holds nothing; joining it changes nothing.
    pub const EMPTY: Self = Self { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

    /// The smallest box around `points`.
    #[must_use]
    pub fn around(points: impl IntoIterator<Item = DVec3>) -> Self {
        points
            .into_iter()
            .fold(Self::EMPTY, |bounds, p| Self { min: least(p, bounds.min), max: greatest(p, bounds.max) })
    }

    /// The smallest box around both.
    #[must_use]
    pub fn join(self, other: Self) -> Self {
        Self { min: least(self.min, other.min), max: greatest(self.max, other.max) }
    }

    /// The middle.
    #[must_use]
    pub fn centre(&self) -> DVec3 {
        // halves first: the sum of two huge coordinates may overflow
        0.5 * self.min + 0.5 * self.max
    }

    /// Length of the diagonal.
    #[must_use]
    pub fn diagonal(&self) -> f64 {
        let extent = self.max - self.min;
        let largest = extent.max_element();
        if largest > 0.0 { largest * (extent / largest).length() } else { 0.0 }
    }

    /// The largest |coordinate| of its corners.
    #[must_use]
    pub fn reach(&self) -> f64 {
        self.min.abs().max(self.max.abs()).max_element()
    }

    /// Square of the distance from `p` to the box; 0 inside.
    #[must_use]
    pub fn distance_squared(&self, p: DVec3) -> f64 {
        (self.min - p).max(p - self.max).max(DVec3::ZERO).length_squared()
    }

    /// Whether `p` lies in the box.
    #[must_use]
    pub fn contains(&self, p: DVec3) -> bool {
        p.cmpge(self.min).all() && p.cmple(self.max).all()
    }
}

/// The lesser coordinates of two points that are numbers: one comparison each, where `f64::min` looks for others.
fn least(a: DVec3, b: DVec3) -> DVec3 {
    let least = |a: f64, b: f64| if a < b { a } else { b };
    DVec3::new(least(a.x, b.x), least(a.y, b.y), least(a.z, b.z))
}

/// The greater coordinates.
fn greatest(a: DVec3, b: DVec3) -> DVec3 {
    let greatest = |a: f64, b: f64| if a > b { a } else { b };
    DVec3::new(greatest(a.x, b.x), greatest(a.y, b.y), greatest(a.z, b.z))
}
