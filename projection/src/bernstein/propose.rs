//! The paper's search: a quadtree over the squared gradient in Bernstein form (Xu et al. 2014, equations 2 to 4).
//!
//! On each piece, `w = f² + g²` of the gradient's two polynomials has degree `(4 m, 4 n)`, of rational pieces `(6 m, 6 n)`. A box on which all coefficients
//! of `w` are positive holds no stationary point; the others are split at the middles of both directions, until they are no wider than 1e-3 of the piece. Their
//! middles are the paper's candidates.
//!
//! What the paper leaves out: minima on edges and creases are no zeros of `w`; there the derivative along the line is squared. Corners are candidates as
//! they are. The middle of a box is half its width off, so Newton's method goes on from the nearest ones.

use glam::DVec3;
use perpend_kernel::Direction;
use smallvec::SmallVec;

use super::Bernstein;
use super::isolate::{Range, System};
use super::polynomial::Polynomial;
use crate::answer::Method;
use crate::query::Query;
use crate::scratch::Scratch;
use crate::solver::Proposer;
use crate::statistics::Work;

/// Boxes are split until their width, as a share of their piece, is at most `2⁻¹⁰`: the paper's interval of 1e-3.
const DEEPEST: u32 = 10;

/// From how many candidates Newton's method goes on at most.
const POLISHED: usize = 16;

/// Its steps from each.
const STEPS: u32 = 12;

/// A box whose squared gradient may vanish.
struct Node {
    square: Polynomial,
    range: Range,
    depth: u32,
}

/// The middle of a box.
#[derive(Debug, Clone, Copy)]
struct Candidate {
    patch: usize,
    at: [f64; 2],
    /// Whether it may move, in s and in t.
    free: [bool; 2],
    distance: f64,
    /// How far from there the box reaches.
    extent: f64,
}

impl Proposer for Bernstein {
    fn method(&self) -> Method {
        Method::Bernstein
    }

    fn propose(&self, query: &Query, scratch: &mut Scratch) -> Option<(f64, f64)> {
        let work = &mut scratch.statistics.proposal;
        let p = self.frame.enter(query.point);
        let mut splits = u64::from(query.options.work);
        let mut candidates = self.vertices(p);
        for segment in self.segments() {
            let (index, _, _) = segment.patch(self);
            let square = self.square(&segment.system(self, p));
            let mut free = [false; 2];
            free[segment.direction() as usize] = true;
            for range in quadtree(square, &mut splits, work) {
                candidates.push(self.candidate(p, index, segment.range(self, range[0]), free));
            }
        }
        for (index, patch) in self.patches.iter().enumerate() {
            let square = self.square(&patch.gradient(p, &self.common));
            let free = [true, !self.is_curve];
            for range in quadtree(square, &mut splits, work) {
                let range = if self.is_curve { [range[0], (0.0, 0.0)] } else { range };
                candidates.push(self.candidate(p, index, range, free));
            }
        }
        work.evaluations += candidates.len() as u64;
        candidates.sort_by(|a, b| a.distance.total_cmp(&b.distance));
        let nearest = candidates.first()?.distance;
        let hopeful = candidates.iter().take(POLISHED).filter(|c| c.distance - c.extent <= nearest);
        let polished = hopeful.map(|candidate| self.polished(p, *candidate, work));
        let best = polished.min_by(|a, b| a.distance.total_cmp(&b.distance))?;
        let [u, v] = self.patches[best.patch].parameters(best.at[0], best.at[1]);
        Some((u, v))
    }
}

impl Bernstein {
    /// The squared gradient, as a polynomial of twice the degree.
    fn square(&self, system: &System) -> Polynomial {
        self.common.products.sum(system.iter().map(|f| (f, f)))
    }

    fn candidate(&self, p: DVec3, patch: usize, range: Range, free: [bool; 2]) -> Candidate {
        let middle = |(from, to): (f64, f64)| 0.5 * (from + to);
        let at = [middle(range[0]), middle(range[1])];
        let lengths = self.patches[patch].lengths(range[0], range[1]);
        let distance = self.patches[patch].point(at[0], at[1]).distance(p);
        Candidate { patch, at, free, distance, extent: lengths[0] + lengths[1] }
    }

    /// The points where lines cross, and the poles.
    fn vertices(&self, p: DVec3) -> Vec<Candidate> {
        let mut found = Vec::new();
        let end = |far: bool| if far { (1.0, 1.0) } else { (0.0, 0.0) };
        let mut add = |row: usize, column: usize, ends: [bool; 2]| {
            let (index, _) = self.patch(row, column);
            found.push(self.candidate(p, index, [end(ends[0]), end(ends[1])], [false; 2]));
        };
        for a in &self.lines[0] {
            let (row, far) = a.beside();
            if self.is_curve {
                add(row, 0, [far, false]);
            }
            for b in &self.lines[1] {
                let (column, b_far) = b.beside();
                add(row, column, [far, b_far]);
            }
        }
        // the corners of the domain: poles among them
        let (rows, columns) = (self.patches.len() / self.columns, self.columns);
        for far in [false, true] {
            add(if far { rows - 1 } else { 0 }, 0, [far, false]);
            add(0, if far { columns - 1 } else { 0 }, [false, far && !self.is_curve]);
        }
        found
    }

    /// Newton's method for a zero of the gradient, kept inside the piece; the nearest point on its way.
    fn polished(&self, p: DVec3, start: Candidate, work: &mut Work) -> Candidate {
        let patch = &self.patches[start.patch];
        let mut best = start;
        if start.free == [false; 2] {
            return best;
        }
        let system = patch.gradient(p, &self.common);
        let mut at = start.at;
        for _ in 0..STEPS {
            let values: SmallVec<[f64; 2]> = system.iter().map(|f| f.value(at[0], at[1]).0).collect();
            let slopes: SmallVec<[[f64; 2]; 2]> = system.iter().map(|f| f.gradient(at[0], at[1])).collect();
            let step = match (start.free, &values[..], &slopes[..]) {
                ([true, true], [f, g], [[a, b], [c, d]]) => {
                    let determinant = a * d - b * c;
                    [(d * f - b * g) / determinant, (a * g - c * f) / determinant]
                }
                ([true, false], [f, ..], [[a, _], ..]) => [f / a, 0.0],
                ([false, true], [_, g], [_, [_, d]]) => [0.0, g / d],
                _ => break,
            };
            let next = [0, 1].map(|d| (at[d] - step[d]).clamp(0.0, 1.0));
            if next.iter().any(|x| x.is_nan()) || next == at {
                break;
            }
            at = next;
            work.newton += 1;
            work.evaluations += 1;
            let distance = patch.point(at[0], at[1]).distance(p);
            if distance < best.distance {
                best = Candidate { at, distance, ..best };
            }
        }
        best
    }
}

/// The boxes in which a square may vanish.
fn quadtree(square: Polynomial, splits: &mut u64, work: &mut Work) -> Vec<Range> {
    work.pieces += 1;
    let mut left = Vec::new();
    let mut waiting = vec![Node { square, range: [(0.0, 1.0); 2], depth: 0 }];
    while let Some(node) = waiting.pop() {
        work.cells += 1;
        if node.square.has_no_zero() {
            continue;
        }
        if node.depth == DEEPEST || *splits == 0 || node.square.is_noise() {
            work.unresolved += u64::from(node.depth < DEEPEST && *splits == 0);
            left.push(node.range);
            continue;
        }
        *splits = splits.saturating_sub(1 + (node.square.c.len() * (node.square.m + node.square.n) / 10_000) as u64);
        work.subdivisions += 1;
        let is_surface = node.square.n > 0;
        for half in halves(node, Direction::U) {
            if is_surface {
                waiting.extend(halves(half, Direction::V).map(deeper));
            } else {
                waiting.push(deeper(half));
            }
        }
    }
    left
}

fn deeper(node: Node) -> Node {
    Node { depth: node.depth + 1, ..node }
}

fn halves(node: Node, direction: Direction) -> [Node; 2] {
    let [low, high] = node.square.halves(direction);
    let at = direction as usize;
    let (from, to) = node.range[at];
    let middle = 0.5 * (from + to);
    let mut ranges = [node.range; 2];
    ranges[0][at].1 = middle;
    ranges[1][at].0 = middle;
    [
        Node { square: low, range: ranges[0], depth: node.depth },
        Node { square: high, range: ranges[1], depth: node.depth },
    ]
}
