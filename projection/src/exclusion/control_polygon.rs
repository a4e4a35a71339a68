//! The comparator of Selimovic's tables: which segments the control polygon tells to hold no nearest point inside (Ma and Hewitt 2003).
//!
//! Reconstructed: the paper is known here by its abstract and by what Selimovic says of it. A polygon that is simple and convex is taken to
//! have its nearest point at an end where the query lies behind the leg and behind the chord there; a net, at a corner where all its lines in
//! both directions have theirs at the same end. For a plane polygon this is what theorem 4.1 says, since a convex polygon lies within
//! the angle at its end; for spatial polygons and for nets it is a guess, and what it excludes wrongly the proof corrects.

use std::f64::consts::PI;

use glam::DVec3;

use super::criteria::Verdict;
use super::segment::Segment;

/// The verdict of the control polygons.
pub(super) fn verdict(segment: &Segment, p: DVec3) -> Verdict {
    let agrees = |direction: usize| {
        let mut ends = (0..segment.count[1 - direction])
            .map(|line| nearest_end(&segment.line(direction, line).collect::<Vec<_>>(), p));
        ends.next().flatten().is_some_and(|first| ends.all(|end| end == Some(first)))
    };
    let told = match segment.along() {
        Some(along) => agrees(along),
        None => agrees(0) && agrees(1),
    };
    if told { Verdict::Corner } else { Verdict::Open }
}

/// The end at which a line of control points is taken to be nearest to `p`; none where that is not told.
fn nearest_end(line: &[DVec3], p: DVec3) -> Option<usize> {
    let last = line.len() - 1;
    let chord = line[last] - line[0];
    let is_behind =
        |end: usize, leg: DVec3, chord: DVec3| leg.dot(p - line[end]) < 0.0 && chord.dot(p - line[end]) < 0.0;
    let end = if is_behind(0, line[1] - line[0], chord) {
        0
    } else if is_behind(last, line[last - 1] - line[last], -chord) {
        1
    } else {
        return None;
    };
    is_convex(line).then_some(end)
}

/// Whether a closed polygon turns to one side only, and once around; as seen along the normal of its sharpest turn where it is not plane.
fn is_convex(line: &[DVec3]) -> bool {
    let n = line.len();
    let legs: Vec<DVec3> = (0..n).map(|k| line[(k + 1) % n] - line[k]).filter(|leg| *leg != DVec3::ZERO).collect();
    let turns = || (0..legs.len()).map(|k| (legs[k], legs[(k + 1) % legs.len()]));
    let longer = |a: DVec3, b: DVec3| if b.length_squared() > a.length_squared() { b } else { a };
    let Some(normal) = turns().map(|(a, b)| a.cross(b)).fold(DVec3::ZERO, longer).try_normalize() else {
        // all on one line: not folded
        let chord = line[n - 1] - line[0];
        return line.windows(2).all(|leg| (leg[1] - leg[0]).dot(chord) >= 0.0);
    };
    let angle = |(a, b): (DVec3, DVec3)| normal.dot(a.cross(b)).atan2(a.dot(b));
    turns().all(|turn| angle(turn) >= 0.0) && turns().map(angle).sum::<f64>() < 3.0 * PI
}
