//! The points that were measured: all of them as numbers, some of them to be drawn.

use std::collections::BTreeMap;

use perpend::{DVec3, EntityId};

/// A point and the nearest point of the model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Measured {
    /// The line of the file on which it stands.
    pub(super) line: u64,
    pub(super) point: DVec3,
    /// The face, or the curve, on which the nearest point lies.
    pub(super) entity: EntityId,
    /// The distance, with a sign where there is one.
    pub(super) deviation: f64,
    pub(super) lower_bound: f64,
    /// Whether the deviation has a sign: curves have no sides, and surfaces none at poles and cusps.
    pub(super) has_side: bool,
    pub(super) is_certified: bool,
}

/// Points, evenly thinned to a number that fits.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Thinned {
    most: usize,
    /// One of so many is kept.
    pub(super) every: u64,
    seen: u64,
    pub(super) points: Vec<Measured>,
}

/// What has been measured.
#[derive(Debug)]
pub(super) struct Survey {
    /// The deviations of the points of each entity, in their order.
    pub(super) of_entity: BTreeMap<EntityId, Vec<f64>>,
    pub(super) drawn: Thinned,
    pub(super) without_side: u64,
    pub(super) uncertified: u64,
    pub(super) largest_gap: f64,
}

impl Thinned {
    fn new(most: usize) -> Self {
        Self { most, every: 1, seen: 0, points: Vec::new() }
    }

    /// Keeps the first of each `every` points; doubles that where there are too many.
    fn take(&mut self, measured: Measured) {
        if self.seen.is_multiple_of(self.every) {
            self.points.push(measured);
        }
        self.seen += 1;
        if self.points.len() > self.most {
            let mut index = 0_usize;
            self.points.retain(|_| {
                index += 1;
                index % 2 == 1
            });
            self.every *= 2;
        }
    }
}

impl Survey {
    /// At most `most` points are to be drawn.
    pub(super) fn new(most: usize) -> Self {
        let drawn = Thinned::new(most);
        Self { of_entity: BTreeMap::new(), drawn, without_side: 0, uncertified: 0, largest_gap: 0.0 }
    }

    pub(super) fn take(&mut self, measured: Measured) {
        self.of_entity.entry(measured.entity).or_default().push(measured.deviation);
        self.without_side += u64::from(!measured.has_side);
        self.uncertified += u64::from(!measured.is_certified);
        self.largest_gap = self.largest_gap.max(measured.deviation.abs() - measured.lower_bound);
        self.drawn.take(measured);
    }

    /// All deviations.
    pub(super) fn deviations(&self) -> Vec<f64> {
        self.of_entity.values().flatten().copied().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinned_points_are_evenly_apart_and_no_more_than_fit() {
        for (count, every, kept) in [(10, 1, 10), (11, 2, 6), (21, 4, 6), (40, 4, 10), (41, 8, 6)] {
            let mut thinned = Thinned::new(10);
            for line in 0..count {
                let (point, entity) = (DVec3::ZERO, EntityId::new(1));
                let (deviation, lower_bound) = (1.0, 1.0);
                thinned.take(Measured {
                    line,
                    point,
                    entity,
                    deviation,
                    lower_bound,
                    has_side: true,
                    is_certified: true,
                });
            }
            let lines: Vec<u64> = thinned.points.iter().map(|measured| measured.line).collect();
            assert_eq!(lines, (0..count).step_by(every).collect::<Vec<u64>>());
            assert_eq!((thinned.every, thinned.points.len()), (every as u64, kept));
        }
    }
}
