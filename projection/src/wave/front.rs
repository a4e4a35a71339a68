//! The wave: cubes of cells around a query, one shell after another (Piegl et al. 2008, §4 and §6).

use glam::DVec3;
use perpend_kernel::Aabb;

use super::cells::Cells;

/// A query farther than this many cells starts its wave at that distance on the line to the middle of the grid: its fronts are flat
/// there as they are farther out, and cells can still be counted.
const FARTHEST: f64 = (1_u64 << 40) as f64;

/// A run of cells that follow one another along x.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Run {
    pub x: (usize, usize),
    pub y: usize,
    pub z: usize,
}

/// A cubical wave over the cells of a grid.
#[derive(Debug)]
pub(super) struct Front<'a> {
    cells: &'a Cells,
    query: DVec3,
    /// The cell from which the wave goes out, perhaps outside the grid.
    centre: [i64; 3],
    /// How many cells around it are reached: -1 before the first shell.
    radius: i64,
}

impl<'a> Front<'a> {
    /// A wave that is about to enter the grid: what lies between a query and the box is passed over at once.
    pub(super) fn new(cells: &'a Cells, query: DVec3) -> Self {
        let place = cells.place(query);
        let middle = 0.5 * DVec3::from_array(cells.counts.map(|n| n as f64));
        let far = (place - middle).abs().max_element();
        let start = if far > FARTHEST { middle + (place - middle) * (FARTHEST / far) } else { place };
        let centre = start.to_array().map(|c| c.floor() as i64);
        let outside = |k: usize| (-centre[k]).max(centre[k] - (cells.counts[k] as i64 - 1)).max(0);
        Self { cells, query, centre, radius: (0..3).map(outside).max().unwrap_or(0) - 1 }
    }

    /// The cells along one axis that a cube of this radius covers, of those of the grid; none where it covers none.
    fn covered(&self, axis: usize, radius: i64) -> Option<(usize, usize)> {
        let (low, high) = (self.centre[axis] - radius, self.centre[axis] + radius);
        let last = self.cells.counts[axis] as i64 - 1;
        (radius >= 0 && low <= last && high >= 0).then(|| (low.max(0) as usize, high.min(last) as usize))
    }

    /// Goes one shell farther, and shows its cells in runs, each cell once in the life of the wave.
    pub(super) fn advance(&mut self, mut show: impl FnMut(Run)) {
        self.radius += 1;
        let outer = [0, 1, 2].map(|axis| self.covered(axis, self.radius));
        let inner = [0, 1, 2].map(|axis| self.covered(axis, self.radius - 1));
        let [Some(x), Some(y), Some(z)] = outer else { return };
        let is_inside = |axis: usize, c: usize| inner[axis].is_some_and(|(from, to)| from <= c && c <= to);
        // where y and z were covered before, the cells on both ends along x are new
        let sides: [Option<(usize, usize)>; 2] = match inner[0] {
            None => [Some(x), None],
            Some((from, to)) => [(x.0 < from).then(|| (x.0, from - 1)), (x.1 > to).then_some((to + 1, x.1))],
        };
        for z in z.0..=z.1 {
            for y in y.0..=y.1 {
                if !(is_inside(1, y) && is_inside(2, z)) {
                    show(Run { x, y, z });
                } else {
                    sides.into_iter().flatten().for_each(|x| show(Run { x, y, z }));
                }
            }
        }
    }

    /// Square of the distance from the query to what the wave has not reached of the grid; infinite when it has covered all.
    ///
    /// The paper takes the distance to the nearest side of the cube. A side beyond which the grid ends holds nothing back, and a slab of
    /// the grid beyond another side may begin farther away than the side itself: so far queries stop early, too.
    pub(super) fn search_distance_squared(&self) -> f64 {
        let last = self.cells.counts.map(|n| n - 1);
        let mut least = f64::INFINITY;
        let mut beyond = |slab: Aabb| least = least.min(slab.distance_squared(self.query));
        for axis in 0..3 {
            let Some((from, to)) = self.covered(axis, self.radius) else {
                return self.cells.bounds([0; 3], last).distance_squared(self.query);
            };
            if from > 0 {
                let mut high = last;
                high[axis] = from - 1;
                beyond(self.cells.bounds([0; 3], high));
            }
            if to < last[axis] {
                let mut low = [0; 3];
                low[axis] = to + 1;
                beyond(self.cells.bounds(low, last));
            }
        }
        least
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grid of 5 by 4 by 3 cells of side 1 from (-2, 0, 0).
    fn grid() -> Cells {
        let unit = |x: f64, y: f64, z: f64| Aabb { min: DVec3::new(x, y, z), max: DVec3::new(x, y, z) };
        Cells::new(&[unit(-2.0, 0.0, 0.0), unit(3.0, 4.0, 3.0)], 5)
    }

    fn queries() -> Vec<DVec3> {
        let at = [-1e60, -70.0, -2.5, -2.0, 0.3, 2.9, 3.0, 1e9, 1e75];
        let mut queries = Vec::new();
        for x in at {
            for y in at {
                queries.extend(at.map(|z| DVec3::new(x, y, z)));
            }
        }
        queries
    }

    #[test]
    fn a_wave_shows_every_cell_once_however_far_it_comes_from() {
        let cells = grid();
        assert_eq!(cells.counts, [5, 4, 3]);
        for query in queries() {
            let mut front = Front::new(&cells, query);
            let mut seen = vec![0; 60];
            let mut shells = 0;
            while front.search_distance_squared() < f64::INFINITY {
                front.advance(|run| {
                    (run.x.0..=run.x.1).for_each(|x| seen[cells.index(x, run.y, run.z)] += 1);
                });
                shells += 1;
                assert!(shells <= 6, "{query}");
            }
            assert!(seen.iter().all(|n| *n == 1), "{query}: {seen:?}");
        }
    }

    #[test]
    fn no_cell_that_is_left_is_nearer_than_the_search_distance() {
        let cells = grid();
        for query in queries() {
            let mut front = Front::new(&cells, query);
            let mut left: Vec<[usize; 3]> = (0..60).map(|c| [c % 5, c / 5 % 4, c / 20]).filter(|c| c[2] < 3).collect();
            while !left.is_empty() {
                let nearest =
                    left.iter().map(|c| cells.bounds(*c, *c).distance_squared(query)).fold(f64::MAX, f64::min);
                let search = front.search_distance_squared();
                assert!(search <= nearest * (1.0 + 1e-14), "{query}: {search} > {nearest}");
                front.advance(|run| {
                    left.retain(|c| c[1] != run.y || c[2] != run.z || c[0] < run.x.0 || c[0] > run.x.1);
                });
            }
            assert_eq!(front.search_distance_squared(), f64::INFINITY);
        }
    }
}
