//! Uniform cells, and the segments that are registered with each (Piegl et al. 2008, §6).

use glam::DVec3;
use perpend_kernel::Aabb;

/// The most cells: 16 MB of starts.
const MOST_CELLS: usize = 1 << 22;

/// The most registrations of segments with cells: 64 MB.
const MOST_REGISTRATIONS: usize = 1 << 24;

/// A uniform grid of cubes over an entity's box, with the segments whose boxes meet each.
///
/// The grid is thought to go on beyond the box for as far as any query lies: cells out there are empty, and none is stored.
#[derive(Debug)]
pub(super) struct Cells {
    pub origin: DVec3,
    /// The side of a cell, in the model's unit.
    pub side: f64,
    /// How many there are along x, y and z.
    pub counts: [usize; 3],
    /// Where each cell's segments begin among `items`, x innermost, and the end of the last.
    starts: Vec<u32>,
    items: Vec<u32>,
}

impl Cells {
    /// Cells of the size that the entity gives: its box's largest extent divided by the number of points along it. Where that makes
    /// more cells or registrations than there is room for, the size is doubled until it does not.
    pub(super) fn new(boxes: &[Aabb], points: usize) -> Self {
        let bounds = boxes.iter().fold(Aabb::EMPTY, |all, one| all.join(*one));
        let extent = bounds.max - bounds.min;
        let mut side = (extent.max_element() / points.max(1) as f64).max(f64::MIN_POSITIVE);
        loop {
            let counts = extent.to_array().map(|e| ((e / side).ceil() as usize).max(1));
            let mut cells = Self { origin: bounds.min, side, counts, starts: Vec::new(), items: Vec::new() };
            let room = counts.iter().try_fold(1_usize, |all, n| all.checked_mul(*n).filter(|all| *all <= MOST_CELLS));
            let registrations = room.map(|_| boxes.iter().map(|one| size(cells.range(one))).sum::<usize>());
            if registrations.is_some_and(|count| count <= MOST_REGISTRATIONS.max(boxes.len())) {
                cells.register(boxes);
                return cells;
            }
            side *= 2.0;
        }
    }

    /// Registers every segment with all cells that its box meets, with each once: the counts first, so that every list has its place.
    fn register(&mut self, boxes: &[Aabb]) {
        let mut starts = vec![0_u32; self.counts.iter().product::<usize>() + 1];
        for one in boxes {
            self.visit(self.range(one), |cell| starts[cell + 1] += 1);
        }
        for cell in 1..starts.len() {
            starts[cell] += starts[cell - 1];
        }
        let mut next = starts.clone();
        let mut items = vec![0; starts[starts.len() - 1] as usize];
        for (segment, one) in boxes.iter().enumerate() {
            self.visit(self.range(one), |cell| {
                items[next[cell] as usize] = segment as u32;
                next[cell] += 1;
            });
        }
        (self.starts, self.items) = (starts, items);
    }

    fn visit(&self, range: [(usize, usize); 3], mut cell: impl FnMut(usize)) {
        for z in range[2].0..=range[2].1 {
            for y in range[1].0..=range[1].1 {
                for x in range[0].0..=range[0].1 {
                    cell(self.index(x, y, z));
                }
            }
        }
    }

    /// The first and the last cell along x, y and z that a box inside the grid meets.
    fn range(&self, bounds: &Aabb) -> [(usize, usize); 3] {
        let (low, high) = (self.place(bounds.min), self.place(bounds.max));
        [0, 1, 2].map(|k| {
            let inside = |c: f64| (c.floor().max(0.0) as usize).min(self.counts[k] - 1);
            (inside(low[k]), inside(high[k]))
        })
    }

    /// A point in units of cells from the grid's origin.
    pub(super) fn place(&self, p: DVec3) -> DVec3 {
        (p - self.origin) / self.side
    }

    /// The place of a cell among the cells.
    pub(super) fn index(&self, x: usize, y: usize, z: usize) -> usize {
        (z * self.counts[1] + y) * self.counts[0] + x
    }

    /// The segments registered with a run of cells that follow one another along x, those of each in turn.
    pub(super) fn registered(&self, from: usize, to: usize) -> &[u32] {
        &self.items[self.starts[from] as usize..self.starts[to + 1] as usize]
    }

    /// The box of the cells from one to another, both included, given along x, y and z.
    pub(super) fn bounds(&self, from: [usize; 3], to: [usize; 3]) -> Aabb {
        let corner = |c: [usize; 3]| self.origin + self.side * DVec3::from_array(c.map(|c| c as f64));
        Aabb { min: corner(from), max: corner(to.map(|c| c + 1)) }
    }

    /// Bytes on the heap.
    pub(super) fn memory(&self) -> usize {
        4 * (self.starts.capacity() + self.items.capacity())
    }
}

/// The number of cells in a range.
fn size(range: [(usize, usize); 3]) -> usize {
    range.iter().map(|(from, to)| to - from + 1).product()
}
