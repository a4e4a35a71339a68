//! What an application may see of a wave: for pictures, tables and tests.

use glam::DVec3;
use perpend_kernel::{Aabb, Definition, Direction};

use super::decompose::Decomposition;
use super::{Marks, Wave, WaveSettings};
use crate::query::Query;
use crate::statistics::Work;

/// What the first decomposition of an entity took; of a surface, that of both its longest iso-curves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct DecompositionCost {
    /// Points along the curve or curves.
    pub points: u64,
    /// Evaluations of the steps from point to point.
    pub evaluations: u64,
    /// Evaluations for the arc length, before the first step.
    pub length_evaluations: u64,
}

impl DecompositionCost {
    pub(super) fn of(done: &Decomposition) -> Self {
        Self {
            points: done.points.len() as u64,
            evaluations: done.evaluations,
            length_evaluations: done.length_evaluations,
        }
    }

    pub(super) fn and(self, other: Self) -> Self {
        Self {
            points: self.points + other.points,
            evaluations: self.evaluations + other.evaluations,
            length_evaluations: self.length_evaluations + other.length_evaluations,
        }
    }
}

/// What one wave met on its way, and what came of it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct WaveTrace {
    /// The cells that it visited, in order, along x, y and z: empty ones included, those outside the entity's box not.
    pub cells: Vec<[usize; 3]>,
    /// The segments whose samples were compared, in order.
    pub segments: Vec<usize>,
    /// The parameters of the nearest sample, at which Newton's method started; `v` is 0 on a curve.
    pub start: (f64, f64),
    /// That sample.
    pub start_point: DVec3,
    /// The parameters of the foot that is proposed.
    pub foot: (f64, f64),
    /// The definition there.
    pub point: DVec3,
    /// Its distance from the query, in the model's unit; nothing proves that no point is nearer.
    pub distance: f64,
    /// What it took.
    pub work: Work,
}

impl Wave {
    /// What it was made with, within what has a meaning.
    #[must_use]
    pub fn settings(&self) -> &WaveSettings {
        &self.settings
    }

    /// The parameters of the decomposition along a direction, ascending; a single 0 along v on a curve.
    #[must_use]
    pub fn parameters(&self, direction: Direction) -> &[f64] {
        match direction {
            Direction::U => &self.parameters[0],
            Direction::V => &self.parameters[1],
        }
    }

    /// The points of the decomposition, those along v innermost.
    #[must_use]
    pub fn points(&self) -> Vec<DVec3> {
        let [u, v] = &self.parameters;
        u.iter().flat_map(|u| v.iter().map(|v| self.at(*u, *v))).collect()
    }

    /// What the decomposition took.
    #[must_use]
    pub fn cost(&self) -> DecompositionCost {
        self.cost
    }

    /// The boxes of the segments between neighbouring points, those along v innermost; each holds its segment.
    #[must_use]
    pub fn segment_boxes(&self) -> &[Aabb] {
        &self.boxes
    }

    /// The side of a cell, in the model's unit.
    #[must_use]
    pub fn cell_side(&self) -> f64 {
        self.cells.side
    }

    /// How many cells there are along x, y and z.
    #[must_use]
    pub fn cell_counts(&self) -> [usize; 3] {
        self.cells.counts
    }

    /// The box of a cell.
    ///
    /// # Panics
    ///
    /// Where there is no such cell.
    #[must_use]
    pub fn cell_box(&self, cell: [usize; 3]) -> Aabb {
        assert!((0..3).all(|k| cell[k] < self.cells.counts[k]), "there is no cell {cell:?}");
        self.cells.bounds(cell, cell)
    }

    /// The segments registered with a cell, ascending, each once.
    ///
    /// # Panics
    ///
    /// Where there is no such cell.
    #[must_use]
    pub fn registered(&self, cell: [usize; 3]) -> &[u32] {
        assert!((0..3).all(|k| cell[k] < self.cells.counts[k]), "there is no cell {cell:?}");
        let index = self.cells.index(cell[0], cell[1], cell[2]);
        self.cells.registered(index, index)
    }

    /// The samples of a segment, from which starts are taken; made now if no wave has met it yet.
    ///
    /// # Panics
    ///
    /// Where there is no such segment.
    #[must_use]
    pub fn samples(&self, segment: usize) -> &[DVec3] {
        &self.samples[segment].get_or_init(|| Box::new(self.sample(segment))).points
    }

    /// Sends one wave, and tells what it met.
    #[must_use]
    pub fn trace(&self, query: &Query) -> WaveTrace {
        let mut trace = WaveTrace::default();
        let mut work = Work::default();
        let ([u, v], distance) = self.foot(query, &mut Marks::default(), &mut work, Some(&mut trace));
        WaveTrace { foot: (u, v), point: self.at(u, v), distance, work, ..trace }
    }

    /// Bytes on the heap: boxes, cells, and the samples made so far; the definition is not counted.
    #[must_use]
    pub fn memory(&self) -> usize {
        let samples = self.samples.iter().filter_map(|samples| samples.get()).map(|samples| samples.memory());
        let edges = self.boundary.iter().filter_map(|edge| edge.get()?.as_deref()).map(Self::memory);
        let own = size_of::<Aabb>() * self.boxes.capacity() + 16 * self.samples.capacity() + self.cells.memory();
        own + samples.sum::<usize>() + edges.sum::<usize>()
    }

    fn at(&self, u: f64, v: f64) -> DVec3 {
        match &*self.definition {
            Definition::NurbsCurve(curve) => curve.point(u),
            Definition::NurbsSurface(surface) => surface.point(u, v),
        }
    }
}
