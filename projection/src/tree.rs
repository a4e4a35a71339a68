//! A tree of boxes: which items lie nearer to a point than a given distance?
//!
//! The same tree serves the pieces of an entity and the entities of a model.

use glam::DVec3;
use perpend_kernel::Aabb;

/// An item whose box may be near enough, with the square of the distance to its box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Candidate {
    /// Square of the distance from the point to the item's box.
    pub distance_squared: f64,
    /// Index of the item.
    pub item: u32,
}

/// A binary tree of axis-aligned boxes over items `0..n`, immutable.
#[derive(Debug, Clone, Default)]
pub struct BoxTree {
    /// Depth first; the left child of an inner node follows it.
    nodes: Vec<Node>,
}

#[derive(Debug, Clone, Copy)]
struct Node {
    bounds: Aabb,
    kind: Kind,
}

#[derive(Debug, Clone, Copy)]
enum Kind {
    Leaf { item: u32 },
    Inner { right: u32 },
}

impl BoxTree {
    /// The tree over `boxes`; item `i` is the one with box `i`.
    #[must_use]
    pub fn new(boxes: &[Aabb]) -> Self {
        let mut order: Vec<u32> = (0..boxes.len()).map(|i| i as u32).collect();
        let mut nodes = Vec::with_capacity((2 * boxes.len()).saturating_sub(1));
        if !boxes.is_empty() {
            build(&mut order, boxes, &mut nodes);
        }
        Self { nodes }
    }

    /// Adds to `found` every item whose box is nearer to `p` than the square root of `limit_squared`; returns how many boxes
    /// were looked at.
    pub fn nearer_than(&self, p: DVec3, limit_squared: f64, found: &mut Vec<Candidate>) -> u64 {
        let mut looked = 0;
        let mut next = 0;
        // Depth first without a stack: an inner node that is too far jumps past its subtree.
        let mut pending: smallvec::SmallVec<[usize; 64]> = smallvec::SmallVec::new();
        while next < self.nodes.len() {
            let node = &self.nodes[next];
            looked += 1;
            let distance_squared = node.bounds.distance_squared(p);
            let near = distance_squared < limit_squared;
            match node.kind {
                Kind::Inner { right } if near => {
                    pending.push(right as usize);
                    next += 1;
                    continue;
                }
                Kind::Leaf { item } if near => found.push(Candidate { distance_squared, item }),
                _ => {}
            }
            match pending.pop() {
                Some(node) => next = node,
                None => break,
            }
        }
        looked
    }

    /// The item that a descent to the nearer child, always, arrives at; none in an empty tree. Among equally near boxes the
    /// one with the nearer middle is taken, then the first. Also returns how many boxes were looked at.
    #[must_use]
    pub fn descend(&self, p: DVec3) -> Option<(u32, u64)> {
        let mut looked = 0;
        let mut at = 0;
        loop {
            match self.nodes.get(at)?.kind {
                Kind::Leaf { item } => return Some((item, looked)),
                Kind::Inner { right } => {
                    let rank =
                        |node: &Node| (node.bounds.distance_squared(p), (node.bounds.centre() - p).length_squared());
                    looked += 2;
                    let (left, right) = (at + 1, right as usize);
                    at = if rank(&self.nodes[right]) < rank(&self.nodes[left]) { right } else { left };
                }
            }
        }
    }
}

/// Splits at the median of the middles along the longest extent: balanced, whatever the boxes.
fn build(order: &mut [u32], boxes: &[Aabb], nodes: &mut Vec<Node>) {
    let bounds = order.iter().fold(Aabb::EMPTY, |all, i| all.join(boxes[*i as usize]));
    if let [item] = *order {
        nodes.push(Node { bounds, kind: Kind::Leaf { item } });
        return;
    }
    let middle = |i: u32| boxes[i as usize].centre();
    let extent = {
        let middles = Aabb::around(order.iter().map(|i| middle(*i)));
        middles.max - middles.min
    };
    let axis = extent.to_array().iter().enumerate().fold(0, |best, (k, e)| if *e > extent[best] { k } else { best });
    let half = order.len() / 2;
    order.select_nth_unstable_by(half, |a, b| middle(*a)[axis].total_cmp(&middle(*b)[axis]).then(a.cmp(b)));
    let (left, right) = order.split_at_mut(half);
    let me = nodes.len();
    nodes.push(Node { bounds, kind: Kind::Inner { right: 0 } });
    build(left, boxes, nodes);
    nodes[me].kind = Kind::Inner { right: nodes.len() as u32 };
    build(right, boxes, nodes);
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
            prop_assert_eq!(items, expected);
            prop_assert!(tree.descend(p).is_some());
        }
    }
}
