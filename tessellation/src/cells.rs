//! Cells of the domain that are fine enough, with the trims that cross them.

use std::collections::BinaryHeap;

use glam::DVec2;
use perpend_kernel::Direction;

use crate::bound::Derivatives;
use crate::grid::Grid;
use crate::parity::Parity;
use crate::patch::{Patch, Rectangle};
use crate::refine::Ranked;

/// A cell that has a part in the face.
#[derive(Debug)]
pub(crate) struct Cell {
    pub(crate) over: Rectangle,
    /// Bounds of how far the surface moves from side to side, in u and v.
    pub(crate) extent: DVec2,
    /// The parts of trims that cross it, between places of the grid; none: all of it is in the face.
    pub(crate) segments: Vec<[u32; 2]>,
}

/// Cells, and the largest proven error of one.
#[derive(Debug)]
pub(crate) struct Cells {
    pub(crate) cells: Vec<Cell>,
    pub(crate) error: f64,
}

/// What cells are made of: the pieces of a surface in row order, and the trims, which are none where all of the surface counts.
pub(crate) struct Cutting<'a> {
    pub(crate) pieces: &'a [Patch],
    pub(crate) columns: usize,
    pub(crate) trims: Option<&'a Parity>,
    pub(crate) grid: &'a mut Grid,
}

/// A piece or a part of one that may have to be split.
struct Open {
    patch: Patch,
    bounds: Derivatives,
    segments: Vec<[u32; 2]>,
}

impl Cutting<'_> {
    /// Splits the worst cell until all are within `chord`, or the mesh could have more than `limit` triangles. `segments` are the
    /// trims, between places of the grid.
    pub(crate) fn cells(mut self, segments: Vec<[u32; 2]>, chord: f64, limit: usize) -> Cells {
        let mut open = Vec::new();
        let rows = self.pieces.len() / self.columns;
        self.distribute((0, rows), (0, self.columns), segments, &mut open);
        // each is emptied when it is split or done
        let mut open: Vec<Option<Open>> = open.into_iter().map(Some).collect();
        let rank = |index: usize, open: &[Option<Open>]| Ranked {
            error: open[index].as_ref().map_or(0.0, |open| open.bounds.chord_error()),
            index,
        };
        let mut heap: BinaryHeap<Ranked> = (0..open.len()).map(|index| rank(index, &open)).collect();
        let (mut cells, mut error) = (Vec::new(), 0.0_f64);
        // corners and middles of the cells; every triangulation has at most twice as many triangles as vertices
        let mut vertices = 2 * (rows + 1) * (self.columns + 1);
        while let Some(Ranked { error: worst, index }) = heap.pop() {
            let part = open[index].take().expect("each part is listed once");
            let may_split = worst > chord && 2 * (vertices + self.grid.len()) < limit;
            match if may_split { part.halves() } else { None } {
                Some((along, at, low, high)) => {
                    vertices += 3;
                    let (below, above) = self.cut(part.segments, along, at);
                    for (patch, segments) in [(low, below), (high, above)] {
                        if self.may_count(&segments, patch.over) {
                            open.push(Some(Open { bounds: Derivatives::of(&patch), patch, segments }));
                            heap.push(rank(open.len() - 1, &open));
                        }
                    }
                }
                None => {
                    error = error.max(worst);
                    let extent = DVec2::new(part.bounds.u, part.bounds.v);
                    cells.push(Cell { over: part.patch.over, extent, segments: part.segments });
                }
            }
        }
        Cells { cells, error }
    }

    /// Brings the trims to the pieces of a range of rows and columns, and lists those that have a part in the face.
    fn distribute(
        &mut self,
        rows: (usize, usize),
        columns: (usize, usize),
        segments: Vec<[u32; 2]>,
        open: &mut Vec<Open>,
    ) {
        let at = |i: usize, j: usize| &self.pieces[i * self.columns + j];
        let over = at(rows.0, columns.0).over;
        let last = at(rows.1 - 1, columns.1 - 1).over;
        let over = Rectangle { u: (over.u.0, last.u.1), v: (over.v.0, last.v.1) };
        if !self.may_count(&segments, over) {
            return;
        }
        if rows.1 - rows.0 == 1 && columns.1 - columns.0 == 1 {
            let patch = at(rows.0, columns.0).clone();
            open.push(Open { bounds: Derivatives::of(&patch), patch, segments });
            return;
        }
        if rows.1 - rows.0 >= columns.1 - columns.0 {
            let middle = usize::midpoint(rows.0, rows.1);
            let line = at(middle, columns.0).over.u.0;
            let (below, above) = self.cut(segments, Direction::U, line);
            self.distribute((rows.0, middle), columns, below, open);
            self.distribute((middle, rows.1), columns, above, open);
        } else {
            let middle = usize::midpoint(columns.0, columns.1);
            let line = at(rows.0, middle).over.v.0;
            let (below, above) = self.cut(segments, Direction::V, line);
            self.distribute(rows, (columns.0, middle), below, open);
            self.distribute(rows, (middle, columns.1), above, open);
        }
    }

    /// Whether a part of the face may lie in a rectangle that these trims cross.
    fn may_count(&self, segments: &[[u32; 2]], over: Rectangle) -> bool {
        let middle = || DVec2::new(0.5 * over.u.0 + 0.5 * over.u.1, 0.5 * over.v.0 + 0.5 * over.v.1);
        !segments.is_empty() || self.trims.is_none_or(|trims| trims.inside(middle()))
    }

    /// The parts of segments on both sides of a line across `along`; what lies on the line bounds cells, and crosses none.
    fn cut(&mut self, segments: Vec<[u32; 2]>, along: Direction, at: f64) -> (Vec<[u32; 2]>, Vec<[u32; 2]>) {
        let (mut below, mut above) = (Vec::new(), Vec::new());
        for segment in segments {
            let places = segment.map(|index| self.grid.place(index));
            let [x, y] = places.map(|place| match along {
                Direction::U => place.x,
                Direction::V => place.y,
            });
            for (x, index) in [x, y].into_iter().zip(segment) {
                if x == at {
                    self.grid.note(along, index);
                }
            }
            if x == at && y == at {
                continue;
            }
            if x <= at && y <= at {
                below.push(segment);
            } else if x >= at && y >= at {
                above.push(segment);
            } else {
                let [a, b] = places;
                let crossing = (a + (at - x) / (y - x) * (b - a)).clamp(a.min(b), a.max(b));
                let crossing = self.grid.add(match along {
                    Direction::U => DVec2::new(at, crossing.y),
                    Direction::V => DVec2::new(crossing.x, at),
                });
                self.grid.note(along, crossing);
                let [a, b] = segment;
                let (first, second) = if x < y { (&mut below, &mut above) } else { (&mut above, &mut below) };
                first.push([a, crossing]);
                second.push([crossing, b]);
            }
        }
        (below, above)
    }
}

impl Open {
    /// Halves along the direction that bends more; where twist matters most, along the longer one. Either halves the twist, but ever narrower
    /// strips would have triangles that stand askew, and whose area does not approach that of the surface.
    fn halves(&self) -> Option<(Direction, f64, Patch, Patch)> {
        let Derivatives { u, v, uu, uv, vv } = self.bounds;
        let by_u = if uu == vv || 2.0 * uv > uu.max(vv) { u >= v } else { uu > vv };
        let order = if by_u { [Direction::U, Direction::V] } else { [Direction::V, Direction::U] };
        order.into_iter().find_map(|along| self.patch.halves(along).map(|(at, low, high)| (along, at, low, high)))
    }
}
