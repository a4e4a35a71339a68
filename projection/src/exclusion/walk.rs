//! The subdivision of one query (Selimovic 2006, §3).

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use glam::DVec3;
use perpend_kernel::Definition;

use super::criteria::{self, Verdict};
use super::newton::Target;
use super::segment::Segment;
use super::{Criteria, control_polygon};
use crate::hierarchy::Frame;
use crate::statistics::Work;

/// A Bézier segment is split across its length where that is this many times its width.
///
/// The paper has no such rule. Without it, its choice of the direction never splits along an edge that holds the foot, as any foot in a
/// plane of symmetry does: strips are halved into strips, up to 20,000 for one query. Measured on the paper's grids: with 4, 16 and 64 the vase takes
/// 15, 17 and 24 subdivisions and the patch 5.7, 6.4 and 7.0; without it 289 and 11.7.
const SLENDER: f64 = 16.0;

/// What a query is asked with, in the entity's own coordinates.
pub(super) struct Walk<'a> {
    pub definition: &'a Definition,
    pub frame: &'a Frame,
    pub criteria: Criteria,
    pub point: DVec3,
    /// Segments are split until their control points lie within this of a line or plane.
    pub flatness: f64,
    /// The difference of distances that matters.
    pub gap: f64,
    /// How many splits are left; see [`cost`].
    pub left: u64,
    /// The squared distance of the nearest point met, and its parameters.
    pub best: (f64, [f64; 2]),
}

/// A segment that waits to be split.
struct Waiting {
    /// Square of the distance to its box.
    distance_squared: f64,
    /// When it came: ties are taken in that order.
    number: u64,
    segment: Segment,
}

impl Walk<'_> {
    /// Splits, drops and searches segments, the nearest box first, until none is left that could hold a nearer point than the best.
    pub(super) fn run(&mut self, whole: &Segment, work: &mut Work) {
        let mut queue = BinaryHeap::new();
        let mut number = 0;
        self.enter([whole.clone()], &mut queue, &mut number, work);
        while let Some(Waiting { distance_squared, segment, .. }) = queue.pop() {
            if distance_squared >= self.best.0 {
                break;
            }
            let flat = !segment.has_breaks() && segment.is_flat(self.flatness);
            let cost = cost(&segment);
            if !flat && self.left < cost {
                work.unresolved += 1 + queue.len() as u64;
                break;
            }
            let parts = if flat { None } else { segment.split(self.direction(&segment)) };
            let Some(parts) = parts else {
                self.search(&segment, work);
                continue;
            };
            work.subdivisions += 1;
            self.left -= cost;
            self.enter(parts, &mut queue, &mut number, work);
        }
    }

    /// Looks at the corners of segments, then keeps what the criteria leave of each.
    fn enter<const N: usize>(
        &mut self,
        segments: [Segment; N],
        queue: &mut BinaryHeap<Waiting>,
        number: &mut u64,
        work: &mut Work,
    ) {
        for segment in &segments {
            for (end, corner) in segment.corners() {
                self.offer(corner.distance_squared(self.point), [segment.end(0, end[0]), segment.end(1, end[1])]);
            }
        }
        for mut segment in segments {
            loop {
                work.pieces += 1;
                let distance_squared = segment.bounds().distance_squared(self.point);
                if distance_squared >= self.best.0 {
                    break;
                }
                let verdict = match self.criteria {
                    Criteria::Selimovic => criteria::verdict(&segment, self.point),
                    Criteria::ControlPolygon => control_polygon::verdict(&segment, self.point),
                };
                match verdict {
                    Verdict::Corner | Verdict::Nothing => break,
                    Verdict::Edge { direction, end } => segment = segment.edge(direction, end),
                    Verdict::Open => {
                        queue.push(Waiting { distance_squared, number: *number, segment });
                        *number += 1;
                        break;
                    }
                }
            }
        }
    }

    fn offer(&mut self, distance_squared: f64, at: [f64; 2]) {
        if distance_squared < self.best.0 {
            self.best = (distance_squared, at);
        }
    }

    /// The direction to split a segment in.
    ///
    /// The one that has interior knots, if only one has; else the one in which the two adjacent corners nearest to the query stay
    /// together; but where neither has knots, a slender segment is split across its length.
    fn direction(&self, segment: &Segment) -> usize {
        if let Some(along) = segment.along() {
            return along;
        }
        match [segment.has_knots(0), segment.has_knots(1)] {
            [true, false] => return 0,
            [false, true] => return 1,
            [true, true] => {}
            [false, false] => {
                let [u, v] = [segment.length(0), segment.length(1)];
                if u.max(v) > SLENDER * u.min(v) {
                    return usize::from(v > u);
                }
            }
        }
        let [a, b, c, d] = segment.corners().map(|(_, corner)| corner.distance(self.point));
        // corners (0, 0), (0, 1), (1, 0), (1, 1): pairs on an edge of constant u stay together when u is split
        let across_u = (a + b).min(c + d);
        let across_v = (a + c).min(b + d);
        usize::from(across_v < across_u)
    }

    /// Newton's method in a flat segment, from where its line or plane is nearest.
    fn search(&mut self, segment: &Segment, work: &mut Work) {
        let [a, b, c, d] = segment.corners().map(|(_, corner)| corner);
        let (du, dv) = (0.5 * (c - a + d - b), 0.5 * (b - a + d - c));
        let from_middle = self.point - 0.25 * (a + b + c + d);
        let (uu, uv, vv) = (du.length_squared(), du.dot(dv), dv.length_squared());
        let (ru, rv) = (from_middle.dot(du), from_middle.dot(dv));
        let determinant = uu * vv - uv * uv;
        let start = if determinant > 1e-12 * uu * vv {
            [(ru * vv - rv * uv) / determinant, (rv * uu - ru * uv) / determinant]
        } else {
            [if uu > 0.0 { ru / uu } else { 0.0 }, if vv > 0.0 { rv / vv } else { 0.0 }]
        };
        let target = Target {
            definition: self.definition,
            frame: self.frame,
            point: self.point,
            range: segment.range,
            gap: self.gap,
        };
        let (at, distance_squared) = target.search(start.map(|x| 0.5 + x), work);
        self.offer(distance_squared, at);
    }
}

/// What a split counts for: more where a Bézier piece has many control points, so that time and memory stay bounded.
fn cost(segment: &Segment) -> u64 {
    if segment.is_bezier() { 1 + (segment.points.len() / 64) as u64 } else { 1 }
}

impl PartialEq for Waiting {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Waiting {}

impl PartialOrd for Waiting {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Waiting {
    /// Greatest is what comes first: the nearest box, then the oldest.
    fn cmp(&self, other: &Self) -> Ordering {
        let nearer = other.distance_squared.total_cmp(&self.distance_squared);
        nearer.then(other.number.cmp(&self.number))
    }
}
