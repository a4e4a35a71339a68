//! Approximate arc lengths.

use glam::DVec3;

/// The lengths of the polyline through some points of a curve, by parameter.
#[derive(Debug, Clone)]
pub(super) struct ArcLength {
    parameters: Vec<f64>,
    /// From the first point to each.
    lengths: Vec<f64>,
}

impl ArcLength {
    /// Through the points at `nodes`, which ascend: one evaluation each.
    pub(super) fn through(nodes: &[f64], point: &impl Fn(f64) -> DVec3) -> Self {
        let (mut lengths, mut before, mut length) = (Vec::with_capacity(nodes.len()), None, 0.0);
        for node in nodes {
            let here = point(*node);
            length += before.map_or(0.0, |before: DVec3| before.distance(here));
            before = Some(here);
            lengths.push(length);
        }
        Self { parameters: nodes.to_vec(), lengths }
    }

    /// Of the whole.
    pub(super) fn total(&self) -> f64 {
        self.lengths.last().copied().unwrap_or(0.0)
    }

    /// From the first point to the one at `u`.
    pub(super) fn to(&self, u: f64) -> f64 {
        let (at, lengths) = (&self.parameters, &self.lengths);
        let next = at.partition_point(|node| *node <= u).clamp(1, at.len() - 1);
        let share = (u - at[next - 1]) / (at[next] - at[next - 1]);
        lengths[next - 1] + (lengths[next] - lengths[next - 1]) * share.clamp(0.0, 1.0)
    }

    /// The parameter at which a length from the first point is reached.
    pub(super) fn at(&self, length: f64) -> f64 {
        let (at, lengths) = (&self.parameters, &self.lengths);
        let next = lengths.partition_point(|l| *l <= length).clamp(1, at.len() - 1);
        let share = (length - lengths[next - 1]) / (lengths[next] - lengths[next - 1]);
        at[next - 1] + (at[next] - at[next - 1]) * share.clamp(0.0, 1.0)
    }

    /// What is measured between two parameters: the part between the first node after the one and the last before the other, which no arc
    /// between them falls short of.
    pub(super) fn at_least(&self, from: f64, to: f64) -> f64 {
        let (first, next) =
            (self.parameters.partition_point(|u| *u < from), self.parameters.partition_point(|u| *u <= to));
        if next > first { self.lengths[next - 1] - self.lengths[first] } else { 0.0 }
    }
}
