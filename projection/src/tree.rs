//! A tree of boxes: which items lie nearer to a point than a given distance?
//!
//! The same tree serves the pieces of an entity and the entities of a model. A node holds the boxes of its four children side by side, so that
//! one pass over the node's lanes tells the distances to all of them.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use fearless_simd::prelude::*;
use fearless_simd::{Level, dispatch, f64x4};
use glam::DVec3;
use perpend_kernel::Aabb;
use smallvec::SmallVec;

/// An item whose box may be near enough, with the square of the distance to its box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Candidate {
    /// Square of the distance from the point to the item's box.
    pub distance_squared: f64,
    /// Index of the item.
    pub item: u32,
}

/// Children of a node.
const WIDTH: usize = 4;

/// A tree of axis-aligned boxes over items `0..n`, four children a node, immutable.
#[derive(Debug, Clone)]
pub struct BoxTree {
    /// Depth first; the root is the first.
    nodes: Vec<Node>,
    /// What the processor can do: changes times, and no bit.
    level: Level,
}

/// The boxes of four children, one a lane; the box of a lane without a child holds nothing and is infinitely far.
#[derive(Debug, Clone, Copy)]
struct Node {
    min: [[f64; WIDTH]; 3],
    max: [[f64; WIDTH]; 3],
    children: [Child; WIDTH],
}

/// A child: an item, or an inner node.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Child {
    Item(u32),
    Inner(u32),
}

impl Node {
    const EMPTY: Self = Self {
        min: [[f64::INFINITY; WIDTH]; 3],
        max: [[f64::NEG_INFINITY; WIDTH]; 3],
        children: [Child::Item(u32::MAX); WIDTH],
    };

    fn set(&mut self, lane: usize, bounds: Aabb, child: Child) {
        for axis in 0..3 {
            self.min[axis][lane] = bounds.min[axis];
            self.max[axis][lane] = bounds.max[axis];
        }
        self.children[lane] = child;
    }

    /// Squares of the distances from `p` to the children's boxes.
    #[inline(always)]
    fn distances_squared<S: Simd>(&self, simd: S, p: DVec3) -> f64x4<S> {
        let mut sum = f64x4::splat(simd, 0.0);
        for (axis, p) in p.to_array().into_iter().enumerate() {
            let (min, max) = (f64x4::simd_from(simd, self.min[axis]), f64x4::simd_from(simd, self.max[axis]));
            let p = f64x4::splat(simd, p);
            let outside = (min - p).max(p - max).max(0.0);
            sum += outside * outside;
        }
        sum
    }

    /// Squares of the distances from `p` to the middles of the children's boxes, times four; not a number where there is no child.
    #[inline(always)]
    fn middles_squared<S: Simd>(&self, simd: S, p: DVec3) -> f64x4<S> {
        let mut sum = f64x4::splat(simd, 0.0);
        for (axis, p) in p.to_array().into_iter().enumerate() {
            let (min, max) = (f64x4::simd_from(simd, self.min[axis]), f64x4::simd_from(simd, self.max[axis]));
            let apart = (min - p) + (max - p);
            sum += apart * apart;
        }
        sum
    }
}

impl Node {
    /// Squares of the distances from `p` to the children's boxes, and to their middles, times four.
    #[inline(always)]
    fn seen_from<S: Simd>(&self, simd: S, p: DVec3) -> ([f64; WIDTH], [f64; WIDTH]) {
        let (distances, middles) = (self.distances_squared(simd, p), self.middles_squared(simd, p));
        let lanes = [0, 1, 2, 3];
        (lanes.map(|lane| distances[lane]), lanes.map(|lane| middles[lane]))
    }
}

impl BoxTree {
    /// The tree over `boxes`; item `i` is the one with box `i`.
    #[must_use]
    pub fn new(boxes: &[Aabb]) -> Self {
        Self::with_level(boxes, Level::new())
    }

    /// The same for a processor that can do what `level` says.
    pub(crate) fn with_level(boxes: &[Aabb], level: Level) -> Self {
        let mut items: Vec<Item> =
            boxes.iter().enumerate().map(|(at, bounds)| Item { middle: bounds.centre(), at: at as u32 }).collect();
        let mut nodes = Vec::with_capacity(boxes.len() / 2 + 1);
        if !boxes.is_empty() {
            build(&mut items, boxes, &mut nodes);
        }
        Self { nodes, level }
    }

    /// Adds to `found` every item whose box is nearer to `p` than the square root of `limit_squared`; returns how many boxes
    /// were looked at.
    pub fn nearer_than(&self, p: DVec3, limit_squared: f64, found: &mut Vec<Candidate>) -> u64 {
        dispatch!(self.level, simd => self.collect(simd, p, limit_squared, found))
    }

    #[inline(always)]
    fn collect<S: Simd>(&self, simd: S, p: DVec3, limit_squared: f64, found: &mut Vec<Candidate>) -> u64 {
        let mut looked = 0;
        let mut pending: SmallVec<[u32; 64]> = SmallVec::new();
        let mut next = if self.nodes.is_empty() { None } else { Some(0) };
        while let Some(at) = next {
            let node = &self.nodes[at as usize];
            looked += WIDTH as u64;
            let distances = node.distances_squared(simd, p);
            let mut near = distances.simd_lt(limit_squared).to_bitmask();
            while near != 0 {
                let lane = near.trailing_zeros() as usize;
                near &= near - 1;
                match node.children[lane] {
                    Child::Item(item) => found.push(Candidate { distance_squared: distances[lane], item }),
                    Child::Inner(node) => pending.push(node),
                }
            }
            next = pending.pop();
        }
        looked
    }

    /// The item that a descent to the nearest child, always, arrives at; none in an empty tree. Among equally near boxes the
    /// one with the nearest middle is taken, then the first. Also returns how many boxes were looked at.
    #[must_use]
    pub fn descend(&self, p: DVec3) -> Option<(u32, u64)> {
        dispatch!(self.level, simd => self.nearest_item(simd, p))
    }

    /// Visits items, the nearest box first, among boxes that hold `p` the one with the nearest middle, while their boxes are nearer to `p` than the square root of a
    /// limit: of `limit_squared` at first, and then of what the last visit returned.
    pub fn visit_nearest(&self, p: DVec3, mut limit_squared: f64, mut visit: impl FnMut(u32) -> f64) {
        let mut waiting: BinaryHeap<Waiting> = BinaryHeap::with_capacity(64);
        let mut next = (!self.nodes.is_empty()).then_some(Child::Inner(0));
        while let Some(child) = next {
            match child {
                Child::Item(item) => limit_squared = visit(item),
                Child::Inner(at) => self.expand(at, p, limit_squared, &mut waiting),
            }
            next = waiting.pop().filter(|first| first.is_nearer_than(limit_squared)).map(|first| first.child);
        }
    }

    /// Adds the children of a node whose boxes are near enough.
    fn expand(&self, at: u32, p: DVec3, limit_squared: f64, waiting: &mut BinaryHeap<Waiting>) {
        let node = &self.nodes[at as usize];
        let (distances, middles) = dispatch!(self.level, simd => node.seen_from(simd, p));
        for lane in 0..WIDTH {
            let key = if distances[lane] > 0.0 { distances[lane] } else { -middles[lane].recip() };
            let child = Waiting { key, child: node.children[lane] };
            if child.is_nearer_than(limit_squared) {
                waiting.push(child);
            }
        }
    }

    #[inline(always)]
    fn nearest_item<S: Simd>(&self, simd: S, p: DVec3) -> Option<(u32, u64)> {
        let mut looked = 0;
        let mut node = self.nodes.first()?;
        loop {
            looked += WIDTH as u64;
            let (distances, middles) = (node.distances_squared(simd, p), node.middles_squared(simd, p));
            let mut best = 0;
            for lane in 1..WIDTH {
                let nearer = distances[lane] < distances[best];
                if nearer || (distances[lane] == distances[best] && middles[lane] < middles[best]) {
                    best = lane;
                }
            }
            match node.children[best] {
                Child::Item(item) => return Some((item, looked)),
                Child::Inner(at) => node = &self.nodes[at as usize],
            }
        }
    }
}

/// A child that waits for its turn: that with the least key comes first, then the one with the lowest index.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Waiting {
    /// The square of the distance to its box; where the point lies in that, a negative number that rises with the distance to its middle.
    key: f64,
    child: Child,
}

impl Waiting {
    fn is_nearer_than(self, limit_squared: f64) -> bool {
        self.key.max(0.0) < limit_squared
    }
}

impl Eq for Waiting {}

impl Ord for Waiting {
    /// The greatest is the first out of a heap.
    fn cmp(&self, other: &Self) -> Ordering {
        other.key.total_cmp(&self.key).then_with(|| other.child.cmp(&self.child))
    }
}

impl PartialOrd for Waiting {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// An item on its way into the tree: the middle of its box, and its index.
#[derive(Debug, Clone, Copy)]
struct Item {
    middle: DVec3,
    at: u32,
}

/// Splits at the medians of the middles along the longest extents: balanced, whatever the boxes. Returns the node's index.
fn build(items: &mut [Item], boxes: &[Aabb], nodes: &mut Vec<Node>) -> u32 {
    let me = nodes.len();
    nodes.push(Node::EMPTY);
    let mut node = Node::EMPTY;
    let (low, high) = halves(items);
    let quarters = [halves(low), halves(high)].map(<[_; 2]>::from).into_iter().flatten();
    for (lane, part) in quarters.filter(|part| !part.is_empty()).enumerate() {
        let bounds = part.iter().fold(Aabb::EMPTY, |all, i| all.join(boxes[i.at as usize]));
        let child = match *part {
            [item] => Child::Item(item.at),
            _ => Child::Inner(build(part, boxes, nodes)),
        };
        node.set(lane, bounds, child);
    }
    nodes[me] = node;
    me as u32
}

/// Both halves of some items, by their middles along the longest extent of these.
fn halves(items: &mut [Item]) -> (&mut [Item], &mut [Item]) {
    let half = items.len() / 2;
    if half > 0 {
        let middles = Aabb::around(items.iter().map(|item| item.middle));
        let extent = middles.max - middles.min;
        let axis =
            extent.to_array().iter().enumerate().fold(0, |best, (k, e)| if *e > extent[best] { k } else { best });
        items.select_nth_unstable_by(half, |a, b| a.middle[axis].total_cmp(&b.middle[axis]).then(a.at.cmp(&b.at)));
    }
    items.split_at_mut(half)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn boxes() -> impl Strategy<Value = Vec<Aabb>> {
        let corner = prop::array::uniform3(-9..9i32);
        let one = (corner, prop::array::uniform3(0..4i32)).prop_map(|(at, extent)| {
            let min = DVec3::from_array(at.map(f64::from));
            Aabb { min, max: min + DVec3::from_array(extent.map(f64::from)) }
        });
        prop::collection::vec(one, 1..60)
    }

    proptest! {
        #[test]
        fn the_items_found_are_those_of_a_plain_loop(boxes in boxes(), p in prop::array::uniform3(-12..12i32), limit in 0.0..12.0_f64) {
            let p = DVec3::from_array(p.map(f64::from));
            let tree = BoxTree::new(&boxes);
            let mut found = Vec::new();
            tree.nearer_than(p, limit * limit, &mut found);
            let mut items: Vec<u32> = found.iter().map(|c| c.item).collect();
            items.sort_unstable();
            let expected: Vec<u32> =
                (0..boxes.len() as u32).filter(|i| boxes[*i as usize].distance_squared(p) < limit * limit).collect();
            prop_assert_eq!(&items, &expected);
            prop_assert!(tree.descend(p).is_some());
            let (mut visited, mut last) = (Vec::new(), 0.0);
            tree.visit_nearest(p, limit * limit, |item| {
                let distance = boxes[item as usize].distance_squared(p);
                assert!(distance >= last, "the nearest comes first");
                last = distance;
                visited.push(item);
                limit * limit
            });
            visited.sort_unstable();
            prop_assert_eq!(&visited, &expected);
            let mut few = Vec::new();
            tree.visit_nearest(p, f64::INFINITY, |item| {
                few.push(item);
                boxes[item as usize].distance_squared(p)
            });
            prop_assert_eq!(few.len(), 1, "no other box is nearer than the nearest");
        }
    }
}
