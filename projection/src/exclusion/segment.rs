//! A part of a curve or surface over a box of parameters: its control net, which is split at knots and middles.

use glam::{DVec3, DVec4};
use perpend_kernel::{Aabb, Definition, Direction, cartesian};

use crate::hierarchy::Frame;

/// A part of a definition, in the entity's own coordinates, clamped at its borders: its corners are corners of its net.
///
/// A direction of degree 0 has one control point and one parameter: a curve has none in v, and an edge of a surface is a segment
/// whose other direction is gone.
#[derive(Debug, Clone)]
pub(super) struct Segment {
    /// The degrees in u and v.
    pub degree: [usize; 2],
    /// Control points along u and v.
    pub count: [usize; 2],
    /// Homogeneous control points, `i * count[1] + j`.
    net: Vec<DVec4>,
    /// The control points.
    pub points: Vec<DVec3>,
    /// Whether weights differ.
    pub rational: bool,
    /// The parameters of the definition that it covers, in u and v.
    pub range: [(f64, f64); 2],
    /// Interior knots, repeated as often as they occur: none in a Bézier piece.
    knots: [Vec<f64>; 2],
    /// Per direction whether the surface goes on beyond the start and the end, with a continuous first derivative.
    pub goes_on: [[bool; 2]; 2],
}

impl Segment {
    /// The whole of a definition.
    pub(super) fn whole(definition: &Definition, frame: &Frame) -> Self {
        let (net, rational) = frame.net(definition);
        let inner = |knots: &[f64], degree: usize| knots[degree + 1..knots.len() - degree - 1].to_vec();
        let (degree, count, range, knots) = match definition {
            Definition::NurbsCurve(curve) => {
                let (p, n) = (curve.degree(), curve.control_points().len());
                ([p, 0], [n, 1], [curve.domain(), (0.0, 0.0)], [inner(curve.knots().as_slice(), p), Vec::new()])
            }
            Definition::NurbsSurface(surface) => {
                let (p, q) = surface.degree();
                let knots = |d: Direction| surface.knots(d).as_slice();
                let range = [surface.domain(Direction::U), surface.domain(Direction::V)];
                let knots = [inner(knots(Direction::U), p), inner(knots(Direction::V), q)];
                ([p, q], [surface.rows(), surface.columns()], range, knots)
            }
        };
        let points = net.iter().map(|h| cartesian(*h)).collect();
        Self { degree, count, net, points, rational, range, knots, goes_on: [[false; 2]; 2] }
    }

    /// The control point `(i, j)`.
    pub(super) fn at(&self, i: usize, j: usize) -> DVec3 {
        self.points[i * self.count[1] + j]
    }

    /// The weight of the control point `(i, j)`.
    pub(super) fn weight(&self, i: usize, j: usize) -> f64 {
        self.net[i * self.count[1] + j].w
    }

    /// The direction that a curve runs in; none of a surface.
    pub(super) fn along(&self) -> Option<usize> {
        match self.degree {
            [_, 0] => Some(0),
            [0, _] => Some(1),
            _ => None,
        }
    }

    /// Whether it has no interior knots.
    pub(super) fn is_bezier(&self) -> bool {
        self.knots.iter().all(Vec::is_empty)
    }

    /// The control points along a direction in the line `line` of its net.
    pub(super) fn line(&self, direction: usize, line: usize) -> impl Iterator<Item = DVec3> + '_ {
        (0..self.count[direction]).map(move |k| if direction == 0 { self.at(k, line) } else { self.at(line, k) })
    }

    /// The corners: ends of both directions, with the point there; of a curve, each end twice.
    pub(super) fn corners(&self) -> [([usize; 2], DVec3); 4] {
        [[0, 0], [0, 1], [1, 0], [1, 1]].map(|end| {
            let [i, j] = [0, 1].map(|d| if end[d] == 0 { 0 } else { self.count[d] - 1 });
            (end, self.at(i, j))
        })
    }

    /// The parameter at an end of a direction.
    pub(super) fn end(&self, direction: usize, end: usize) -> f64 {
        if end == 0 { self.range[direction].0 } else { self.range[direction].1 }
    }

    /// The box of the control points, which holds the segment.
    pub(super) fn bounds(&self) -> Aabb {
        Aabb::around(self.points.iter().copied())
    }

    /// The edge at an end of a direction, a curve in the other one.
    pub(super) fn edge(&self, direction: usize, end: usize) -> Self {
        let other = 1 - direction;
        let line = if end == 0 { 0 } else { self.count[direction] - 1 };
        let place = |k: usize| if direction == 0 { line * self.count[1] + k } else { k * self.count[1] + line };
        let mut edge = self.clone();
        (edge.degree[direction], edge.count[direction]) = (0, 1);
        edge.net = (0..self.count[other]).map(|k| self.net[place(k)]).collect();
        edge.points = (0..self.count[other]).map(|k| self.points[place(k)]).collect();
        let at = self.end(direction, end);
        edge.range[direction] = (at, at);
        edge.knots[direction] = Vec::new();
        edge
    }

    /// The parameter at which a direction is split, with how often it is a knot: the interior knot that leaves as many spans on
    /// either side as can be, or the middle where there is none; nothing where the parameters end.
    fn cut(&self, direction: usize) -> Option<(f64, usize)> {
        let knots = &self.knots[direction];
        if knots.is_empty() {
            let (from, to) = self.range[direction];
            let middle = from + 0.5 * (to - from);
            return (from < middle && middle < to).then_some((middle, 0));
        }
        let at = knots[knots.len() / 2];
        Some((at, knots.iter().filter(|knot| **knot == at).count()))
    }

    /// Whether a direction has interior knots.
    pub(super) fn has_knots(&self, direction: usize) -> bool {
        !self.knots[direction].is_empty()
    }

    /// Whether the first derivative may jump inside: at a knot that occurs as often as the degree.
    pub(super) fn has_breaks(&self) -> bool {
        (0..2).any(|d| self.knots[d].chunk_by(|a, b| a == b).any(|run| run.len() >= self.degree[d]))
    }

    /// Both parts, split in a direction at an interior knot, or else in the middle; none where the parameters end.
    ///
    /// The knot is inserted up to the degree (The NURBS Book, algorithm A5.1); both quotients of a step are formed, so that the ratio of
    /// weights keeps its relative accuracy.
    pub(super) fn split(&self, direction: usize) -> Option<[Self; 2]> {
        let (at, multiplicity) = self.cut(direction)?;
        let (p, knots) = (self.degree[direction], &self.knots[direction]);
        let (from, to) = self.range[direction];
        let knot = |i: usize| match i {
            i if i <= p => from,
            i if i > p + knots.len() => to,
            i => knots[i - p - 1],
        };
        // the last knot that is not after the cut: among the interior ones, before them their clamped start
        let k = p + knots.partition_point(|knot| *knot <= at);
        let times = p - multiplicity;
        let mut shares = Vec::with_capacity(times * (times + 1) / 2);
        for r in 1..=times {
            for i in 0..=times - r {
                let (a, b) = (knot(k - p + r + i), knot(k + 1 + i));
                shares.push(((at - a) / (b - a), (b - at) / (b - a)));
            }
        }
        let before = k - multiplicity + 1;
        let after = self.count[direction] + times - before + 1;
        let mut parts = [before, after].map(|count| self.resized(direction, count));
        let (low, high) = (k - p, k - multiplicity);
        let mut work = vec![DVec4::ZERO; times + 1];
        for line in 0..self.count[1 - direction] {
            let place = |count: usize, k: usize| {
                if direction == 0 { k * self.count[1] + line } else { line * count + k }
            };
            let [start, end] = &mut parts;
            let old = |k: usize| self.net[place(self.count[1], k)];
            (0..low).for_each(|k| start.net[place(before, k)] = old(k));
            (high + 1..self.count[direction])
                .for_each(|k| end.net[place(after, after + k - self.count[direction])] = old(k));
            (0..=times).for_each(|i| work[i] = old(low + i));
            let mut next = shares.iter();
            for r in 0..=times {
                start.net[place(before, low + r)] = work[0];
                end.net[place(after, times - r)] = work[times - r];
                for (i, (share, rest)) in (0..times - r).zip(&mut next) {
                    work[i] = *rest * work[i] + *share * work[i + 1];
                }
            }
        }
        let smooth = multiplicity < p;
        for (part, end) in parts.iter_mut().zip([1, 0]) {
            part.points = part.net.iter().map(|h| cartesian(*h)).collect();
            part.goes_on[direction][end] = smooth;
        }
        parts[0].range[direction].1 = at;
        parts[1].range[direction].0 = at;
        parts[0].knots[direction] = knots.iter().copied().filter(|knot| *knot < at).collect();
        parts[1].knots[direction] = knots.iter().copied().filter(|knot| *knot > at).collect();
        Some(parts)
    }

    /// A segment like this one with room for `count` control points along a direction.
    fn resized(&self, direction: usize, count: usize) -> Self {
        let mut counts = self.count;
        counts[direction] = count;
        Self {
            count: counts,
            net: vec![DVec4::ZERO; counts[0] * counts[1]],
            points: Vec::new(),
            knots: self.knots.clone(),
            ..*self
        }
    }

    /// Length of the longest control polygon along a direction.
    pub(super) fn length(&self, direction: usize) -> f64 {
        let length = |line: usize| {
            let (from, to) = (self.line(direction, line), self.line(direction, line).skip(1));
            from.zip(to).map(|(a, b)| a.distance(b)).sum::<f64>()
        };
        (0..self.count[1 - direction]).map(length).fold(0.0, f64::max)
    }

    /// Whether every control point lies within a tolerance of one line, on a surface of one plane: the line through the ends, the plane of
    /// the middles between the corners. Where those give no direction, of one point.
    pub(super) fn is_flat(&self, tolerance: f64) -> bool {
        let [a, b, c, d] = self.corners().map(|(_, point)| point);
        let from_line = |origin: DVec3, along: DVec3| match along.try_normalize() {
            Some(unit) => self.points.iter().all(|p| (*p - origin).reject_from_normalized(unit).length() <= tolerance),
            None => self.points.iter().all(|p| p.distance(origin) <= tolerance),
        };
        let diagonals = [d - a, c - b];
        if self.along().is_some() {
            return from_line(a, diagonals[0]);
        }
        let normal = diagonals[0].cross(diagonals[1]);
        // parallel to rounding: the plane is noise
        if normal.length() <= 1e-12 * diagonals[0].length() * diagonals[1].length() {
            let longest =
                if diagonals[0].length() >= diagonals[1].length() { (a, diagonals[0]) } else { (b, diagonals[1]) };
            return from_line(longest.0, longest.1);
        }
        let (middle, normal) = (0.25 * (a + b + c + d), normal.normalize());
        self.points.iter().all(|p| (*p - middle).dot(normal).abs() <= tolerance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use perpend_kernel::NurbsSurface;

    /// Its corners and edges belong to the definition, whatever knots a split meets.
    #[test]
    fn parts_meet_on_the_definition() {
        let (u, v) = (vec![0.0, 0.0, 0.0, 0.25, 0.5, 0.5, 1.0, 1.0, 1.0], vec![2.0, 2.0, 3.0, 4.0, 4.0]);
        let at = |i: usize, j: usize| DVec3::new(i as f64, j as f64, ((i * i + 2 * j) % 5) as f64);
        let points: Vec<Vec<DVec3>> = (0..6).map(|i| (0..3).map(|j| at(i, j)).collect()).collect();
        let weights = (0..6).map(|i| (0..3).map(|j| 1.0 + ((i + j) % 3) as f64).collect()).collect();
        let surface = NurbsSurface::new((2, 1), (u, v), points, Some(weights)).expect("valid");
        let definition = Definition::from(surface.clone());
        let frame = Frame::of(&definition);
        let mut parts = vec![Segment::whole(&definition, &frame)];
        let mut cuts = Vec::new();
        for round in 0..5 {
            let direction = round % 2;
            parts = parts.iter().flat_map(|part| part.split(direction).expect("it has an inside")).collect();
            cuts.push(parts[0].range);
            for part in &parts {
                for (end, corner) in part.corners() {
                    let on = surface.point(part.end(0, end[0]), part.end(1, end[1]));
                    assert!(corner.distance(frame.enter(on)) < 1e-14);
                }
                for (direction, end) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                    let edge = part.edge(direction, end);
                    assert_eq!(
                        (edge.along(), edge.range[direction].0),
                        (Some(1 - direction), part.end(direction, end))
                    );
                    let middle = edge.split(1 - direction).expect("it has an inside")[1].clone();
                    let [u, v] = [middle.range[0].0, middle.range[1].0];
                    assert!(middle.at(0, 0).distance(frame.enter(surface.point(u, v))) < 1e-14);
                }
            }
        }
        // knots first: 0.5 twice, then the middle of what has none
        let along_u: Vec<f64> = cuts.iter().map(|range| range[0].1).collect();
        assert_eq!(along_u, [0.5, 0.5, 0.25, 0.25, 0.125]);
        let smooth: Vec<bool> =
            parts.iter().filter(|part| part.range[0].1 == 0.5).map(|part| part.goes_on[0][1]).collect();
        assert!(!smooth.is_empty() && smooth.iter().all(|smooth| !smooth), "0.5 is a break");
        let inside = parts.iter().filter(|part| part.range[0].1 == 0.25).all(|part| part.goes_on[0][1]);
        assert!(inside && parts.iter().all(|part| !part.goes_on[0][0] || part.range[0].0 > 0.0));
    }

    #[test]
    fn flat_is_what_lies_within_the_tolerance_of_a_plane() {
        let knots = || vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0];
        let net = |height: f64| {
            (0..3)
                .map(|i| {
                    (0..3)
                        .map(|j| DVec3::new(f64::from(i), f64::from(j), if (i, j) == (1, 1) { height } else { 7.0 }))
                        .collect()
                })
                .collect()
        };
        let flat = |height: f64, tolerance: f64| {
            let definition = NurbsSurface::new((2, 2), (knots(), knots()), net(height), None).expect("valid").into();
            let frame = Frame::of(&definition);
            Segment::whole(&definition, &frame).is_flat(tolerance * frame.scale)
        };
        assert!(flat(7.0, 0.0) && flat(7.1, 0.11) && flat(6.9, 0.11));
        assert!(!flat(7.1, 0.09) && !flat(6.9, 0.09));
    }
}
