//! The true shapes of circles and quadrics: their kinds, and the points that are equally far from many of their points.

use std::collections::HashMap;

use glam::DVec3;
use perpend_bench::{Failure, corpora};
use serde::Deserialize;

/// Query points have seven decimals.
const COORDINATE: f64 = 1e-6;

/// The shapes of a set, by the ids of its entities.
pub(crate) struct Shapes(HashMap<u64, Shape>);

/// What an entity is in truth.
#[derive(Debug, Deserialize)]
pub(crate) struct Shape {
    /// What kind of shape it is.
    #[serde(rename = "type")]
    pub kind: String,
    #[serde(alias = "centre")]
    origin: DVec3,
    axis: DVec3,
    /// The radius of a torus' spine.
    major: Option<f64>,
}

impl Shapes {
    /// The shapes of the set with this name.
    pub(crate) fn read(set: &str) -> Result<Self, Failure> {
        let file = corpora().join(format!("{set}.analytic.json"));
        let text = std::fs::read_to_string(&file).map_err(|error| format!("{}: {error}", file.display()))?;
        Ok(Self(serde_json::from_str(&text).map_err(|error| format!("{}: {error}", file.display()))?))
    }

    /// The shape of an entity.
    pub(crate) fn of(&self, entity: u64) -> Result<&Shape, Failure> {
        Ok(self.0.get(&entity).ok_or_else(|| format!("no shape of entity {entity}"))?)
    }
}

impl Shape {
    /// Whether a point is a centre, or on the axis or the spine.
    pub(crate) fn is_equidistant(&self, p: DVec3) -> bool {
        let height = (p - self.origin).dot(self.axis);
        let radius = (p - self.origin - height * self.axis).length();
        let is_on_spine = self.major.is_some_and(|major| height.hypot(radius - major) <= COORDINATE);
        self.kind != "plane" && (radius <= COORDINATE || is_on_spine)
    }
}
