//! Places in the domain, and which of them lie on the lines between cells.

use std::collections::HashMap;

use glam::DVec2;
use perpend_kernel::Direction;

use crate::patch::Rectangle;

/// Parameters that are or may become vertices, each once, and the lines `u = c` and `v = c` with the places on them.
///
/// Cells share their sides by the bits of `c`: halving gives the same numbers in every cell beside a line.
#[derive(Debug, Default)]
pub(crate) struct Grid {
    places: Vec<DVec2>,
    index: HashMap<[u64; 2], u32>,
    /// Of each line `u = c`, by the bits of `c`: `v` and index of the places on it.
    across: HashMap<u64, Vec<(f64, u32)>>,
    /// Of each line `v = c`: `u` and index.
    along: HashMap<u64, Vec<(f64, u32)>>,
}

/// The bits of a number, of both zeros the same.
fn bits(x: f64) -> u64 {
    (x + 0.0).to_bits()
}

impl Grid {
    pub(crate) fn len(&self) -> usize {
        self.places.len()
    }

    pub(crate) fn place(&self, index: u32) -> DVec2 {
        self.places[index as usize]
    }

    /// The index of a place, which is added where it is new.
    pub(crate) fn add(&mut self, place: DVec2) -> u32 {
        let next = u32::try_from(self.places.len()).expect("limits keep meshes below 2^32 vertices");
        let index = *self.index.entry([bits(place.x), bits(place.y)]).or_insert(next);
        if index == next {
            self.places.push(place);
        }
        index
    }

    /// Notes that a place lies on the line across `direction` through it: `u` is constant on a line across u.
    pub(crate) fn note(&mut self, direction: Direction, index: u32) {
        let place = self.place(index);
        match direction {
            Direction::U => self.across.entry(bits(place.x)).or_default().push((place.y, index)),
            Direction::V => self.along.entry(bits(place.y)).or_default().push((place.x, index)),
        }
    }

    /// Adds a corner of a cell to both lines through it.
    pub(crate) fn corner(&mut self, u: f64, v: f64) {
        let index = self.add(DVec2::new(u, v));
        self.note(Direction::U, index);
        self.note(Direction::V, index);
    }

    /// Repeats the places of one line on another, as where a surface closes.
    pub(crate) fn mirror(&mut self, direction: Direction, from: f64, to: f64) {
        let line = match direction {
            Direction::U => self.across.get(&bits(from)),
            Direction::V => self.along.get(&bits(from)),
        };
        for (at, _) in line.cloned().unwrap_or_default() {
            let index = self.add(match direction {
                Direction::U => DVec2::new(to, at),
                Direction::V => DVec2::new(at, to),
            });
            self.note(direction, index);
        }
    }

    /// Puts the places of every line in order, each once. To be called before [`outline`](Self::outline).
    pub(crate) fn sort(&mut self) {
        for line in self.across.values_mut().chain(self.along.values_mut()) {
            line.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            line.dedup_by_key(|(_, index)| *index);
        }
    }

    /// The places on the sides of a cell whose corners were added, counter-clockwise from the lowest parameters.
    pub(crate) fn outline(&self, cell: Rectangle) -> Vec<u32> {
        let side = |lines: &HashMap<u64, Vec<(f64, u32)>>, at: f64, (from, to): (f64, f64)| -> Vec<u32> {
            let line = lines.get(&bits(at)).expect("the corners of a cell lie on its lines");
            let first = line.partition_point(|(x, _)| *x < from);
            let end = line.partition_point(|(x, _)| *x <= to);
            line[first..end].iter().map(|(_, index)| *index).collect()
        };
        let mut outline = side(&self.along, cell.v.0, cell.u);
        outline.pop();
        outline.extend(side(&self.across, cell.u.1, cell.v));
        outline.pop();
        outline.extend(side(&self.along, cell.v.1, cell.u).iter().rev());
        outline.pop();
        outline.extend(side(&self.across, cell.u.0, cell.v).iter().rev());
        outline.pop();
        outline
    }
}
