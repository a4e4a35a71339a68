//! Segments that cross, split where they do.
//!
//! Polylines of trims that nearly touch may cross. The triangulation's own way of splitting them was tried: where crossings nearly coincide it
//! ends with an error inside the library.

use robust::{Coord, orient2d};
use spade::Point2;

use crate::fill::Corner;

/// How often segments are looked through. The rounding of a crossing may bring new ones about, hardly ever a second time.
const PASSES: usize = 8;

/// The parts of segments between their crossings. Exact but for the place of the crossings; what is left after all passes the triangulation
/// leaves out.
pub(crate) fn apart(mut segments: Vec<[Corner; 2]>) -> Vec<[Corner; 2]> {
    // more crossings are no accident
    let mut left = 4 * segments.len() + 64;
    for _ in 0..PASSES {
        let crossings = crossings(&segments, &mut left);
        if crossings.is_empty() {
            break;
        }
        let mut points: Vec<Vec<Point2<f64>>> = vec![Vec::new(); segments.len()];
        for (pair, at) in crossings {
            pair.into_iter().for_each(|index| points[index].push(at));
        }
        segments = segments.iter().zip(points).flat_map(|(segment, points)| parts(*segment, points)).collect();
    }
    segments
}

/// Pairs of segments that cross, each in an inner point of both, and where; at most `left` of them.
fn crossings(segments: &[[Corner; 2]], left: &mut usize) -> Vec<([usize; 2], Point2<f64>)> {
    let range = |a: f64, b: f64| (a.min(b), a.max(b));
    let over = |index: usize| {
        let [a, b] = segments[index];
        (range(a.at.x, b.at.x), range(a.at.y, b.at.y))
    };
    let mut order: Vec<usize> = (0..segments.len()).collect();
    order.sort_by(|a, b| over(*a).0.0.total_cmp(&over(*b).0.0).then(a.cmp(b)));
    let mut found = Vec::new();
    for (k, first) in order.iter().enumerate() {
        let ((_, end), (low, high)) = over(*first);
        for second in &order[k + 1..] {
            let ((start, _), (other_low, other_high)) = over(*second);
            if start > end {
                break;
            }
            if other_low > high || other_high < low {
                continue;
            }
            if let Some(at) = crossing(segments[*first], segments[*second]) {
                if *left == 0 {
                    return found;
                }
                *left -= 1;
                found.push(([*first, *second], at));
            }
        }
    }
    found
}

/// Where two segments cross in an inner point of both: whether they do is decided exactly.
fn crossing([a, b]: [Corner; 2], [c, d]: [Corner; 2]) -> Option<Point2<f64>> {
    let coord = |corner: Corner| Coord { x: corner.at.x, y: corner.at.y };
    let side = |from: Corner, to: Corner, of: Corner| orient2d(coord(from), coord(to), coord(of));
    let (to_c, to_d, to_a, to_b) = (side(a, b, c), side(a, b, d), side(c, d, a), side(c, d, b));
    let opposite = |x: f64, y: f64| (x > 0.0 && y < 0.0) || (x < 0.0 && y > 0.0);
    if !(opposite(to_c, to_d) && opposite(to_a, to_b)) {
        return None;
    }
    let share = to_a / (to_a - to_b);
    let between = |a: f64, b: f64| (a + share * (b - a)).clamp(a.min(b), a.max(b));
    Some(Point2::new(between(a.at.x, b.at.x), between(a.at.y, b.at.y)))
}

/// The parts of a segment between points of it.
fn parts([from, to]: [Corner; 2], mut points: Vec<Point2<f64>>) -> Vec<[Corner; 2]> {
    let along = Point2::new(to.at.x - from.at.x, to.at.y - from.at.y);
    points.sort_by(|a, b| (a.x * along.x + a.y * along.y).total_cmp(&(b.x * along.x + b.y * along.y)));
    points.retain(|at| *at != from.at && *at != to.at);
    points.dedup();
    let mut corners = vec![from];
    corners.extend(points.into_iter().map(|at| Corner { at, index: None }));
    corners.push(to);
    corners.windows(2).map(|ends| [ends[0], ends[1]]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corner(x: f64, y: f64) -> Corner {
        Corner { at: Point2::new(x, y), index: None }
    }

    #[test]
    fn what_crosses_is_split_and_what_touches_is_not() {
        let across = [corner(0.0, 0.0), corner(2.0, 2.0)];
        let down = [corner(0.0, 2.0), corner(2.0, 0.0)];
        let beside = [corner(2.0, 0.0), corner(3.0, 0.0)];
        let touching = [corner(1.5, 1.5), corner(3.0, 1.5)];
        let parts = apart(vec![across, down, beside, touching]);
        let ends: Vec<_> = parts.iter().map(|[a, b]| (a.at.x, a.at.y, b.at.x, b.at.y)).collect();
        assert_eq!(
            ends,
            [
                (0.0, 0.0, 1.0, 1.0),
                (1.0, 1.0, 2.0, 2.0),
                (0.0, 2.0, 1.0, 1.0),
                (1.0, 1.0, 2.0, 0.0),
                (2.0, 0.0, 3.0, 0.0),
                (1.5, 1.5, 3.0, 1.5)
            ]
        );
    }
}
