//! Edges, seams and creases: the lines on which the distance need not be smooth, and the points where they cross.

use glam::DVec3;
use perpend_kernel::Direction;

use super::Bernstein;
use super::isolate::{Range, System};
use super::patch::Patch;
use super::polynomial::Polynomial;
use crate::landmarks::Landmarks;
use crate::stationary::Extremum;

/// A line of constant parameter: an edge of the entity, its seam, or a knot at which the tangent may turn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Line {
    /// The rows (columns) of pieces on its lower and its upper side; an edge has one of them.
    pub below: Option<usize>,
    pub above: Option<usize>,
}

impl Line {
    /// Whether the entity ends here.
    pub(super) fn is_edge(&self) -> bool {
        self.below.is_none() || self.above.is_none()
    }

    /// A row (column) of pieces beside it, and whether the line is that one's far end.
    pub(super) fn beside(&self) -> (usize, bool) {
        match (self.above, self.below) {
            (Some(row), _) => (row, false),
            (None, row) => (row.unwrap_or(0), true),
        }
    }

    /// Both sides: a row (column) of pieces, and whether the line is its far end.
    fn sides(&self) -> impl Iterator<Item = (usize, bool)> {
        self.below.map(|row| (row, true)).into_iter().chain(self.above.map(|row| (row, false)))
    }
}

/// The lines across direction `d` of an entity whose pieces start at `knots`. A collapsed edge is no line.
pub(super) fn lines(knots: &[f64], landmarks: &Landmarks, d: usize) -> Vec<Line> {
    let count = knots.len();
    let (closed, poles) = (landmarks.closed[d], landmarks.poles[d]);
    let mut lines = Vec::new();
    if !poles[0] {
        lines.push(Line { below: closed.then_some(count - 1), above: Some(0) });
    }
    for (k, at) in knots.iter().enumerate().skip(1) {
        if landmarks.breaks[d].contains(at) {
            lines.push(Line { below: Some(k - 1), above: Some(k) });
        }
    }
    if !poles[1] && !closed {
        lines.push(Line { below: Some(count - 1), above: None });
    }
    lines
}

/// What the distance does across a line, seen from it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Across {
    /// It rises on all sides.
    Rises,
    /// It falls on all sides.
    Falls,
    /// It falls on one and rises on the other.
    Passes,
    /// Rounding hides it.
    Unclear,
}

impl Across {
    /// From bounds of the slopes with which one leaves the line, on each side.
    fn of(slopes: impl Iterator<Item = (f64, f64)>) -> Self {
        let (mut up, mut down, mut unclear) = (false, false, false);
        for (low, high) in slopes {
            match (low > 0.0, high < 0.0) {
                (true, _) => up = true,
                (_, true) => down = true,
                _ => unclear = true,
            }
        }
        match (up, down, unclear) {
            (true, true, _) => Self::Passes,
            (_, _, true) => Self::Unclear,
            (true, _, _) => Self::Rises,
            (_, true, _) => Self::Falls,
            (false, false, false) => Self::Unclear,
        }
    }

    /// As an extremum in its direction.
    pub(super) fn extremum(self) -> Option<Extremum> {
        match self {
            Self::Rises => Some(Extremum::Minimum),
            Self::Falls => Some(Extremum::Maximum),
            Self::Passes | Self::Unclear => None,
        }
    }
}

/// What a point is that is `a` in one direction and `b` in the other.
pub(super) fn together(a: Extremum, b: Extremum) -> Extremum {
    if a == b { a } else { Extremum::Saddle }
}

/// A piece of a line.
#[derive(Debug, Clone, Copy)]
pub(super) struct Segment {
    /// The direction across it: `U` for a line of constant u.
    pub across: Direction,
    pub line: Line,
    /// The column (row) of pieces along the line.
    pub along: usize,
}

impl Segment {
    /// The direction of the line itself.
    pub(super) fn direction(&self) -> Direction {
        if self.across == Direction::U { Direction::V } else { Direction::U }
    }

    /// The patch whose edge the segment is, and whether it is its far edge.
    pub(super) fn patch<'a>(&self, entity: &'a Bernstein) -> (usize, &'a Patch, bool) {
        let (row, far) = self.line.beside();
        let (index, patch) = self.patch_in(entity, row);
        (index, patch, far)
    }

    fn patch_in<'a>(&self, entity: &'a Bernstein, row: usize) -> (usize, &'a Patch) {
        match self.across {
            Direction::U => entity.patch(row, self.along),
            Direction::V => entity.patch(self.along, row),
        }
    }

    /// The derivative along the segment, as a polynomial of one variable.
    pub(super) fn system(&self, entity: &Bernstein, p: DVec3) -> System {
        let (_, patch, far) = self.patch(entity);
        let gradient = patch.gradient(p, &entity.common);
        smallvec::smallvec![gradient[self.direction() as usize].edge(self.across, far)]
    }

    /// A range of the segment's own parameter as one of its patch.
    pub(super) fn range(&self, entity: &Bernstein, along: (f64, f64)) -> Range {
        let (_, _, far) = self.patch(entity);
        let on_line = if far { 1.0 } else { 0.0 };
        match self.across {
            Direction::U => [(on_line, on_line), along],
            Direction::V => [along, (on_line, on_line)],
        }
    }

    /// What the distance does across the segment, over a range of it.
    pub(super) fn across(&self, entity: &Bernstein, p: DVec3, along: (f64, f64)) -> Across {
        Across::of(self.line.sides().map(|(row, far)| {
            let (_, patch) = self.patch_in(entity, row);
            let slope = patch.gradient(p, &entity.common)[self.across as usize].edge(self.across, far);
            outward(values(&slope, along), far)
        }))
    }
}

/// Bounds of a polynomial of one variable over a range near its box.
fn values(f: &Polynomial, (from, to): (f64, f64)) -> (f64, f64) {
    if to - from > 0.5 {
        let (low, high) = f.range();
        return (low - f.error, high + f.error);
    }
    let (value, error) = f.value(0.5 * (from + to), 0.0);
    let (low, high) = f.slope(Direction::U);
    // the slope is bounded on the box, and little beyond it
    let spread = error + low.abs().max(high.abs()) * (to - from);
    (value - spread, value + spread)
}

/// The slope with which one leaves a line into the piece whose far end it is, or whose near end.
fn outward((low, high): (f64, f64), far: bool) -> (f64, f64) {
    if far { (-high, -low) } else { (low, high) }
}

impl Bernstein {
    /// All pieces of all lines of a surface.
    pub(super) fn segments(&self) -> Vec<Segment> {
        if self.is_curve {
            return Vec::new();
        }
        let rows = self.patches.len() / self.columns;
        let of = |across: Direction, count: usize| {
            let lines = self.lines[across as usize].iter();
            lines.flat_map(move |line| (0..count).map(move |along| Segment { across, line: *line, along }))
        };
        of(Direction::U, self.columns).chain(of(Direction::V, rows)).collect()
    }

    /// What the distance from `p` does across the lines `a` (of constant u) and `b` (of constant v), at the point where they cross; on a curve
    /// there is no `b`.
    pub(super) fn across_vertex(&self, p: DVec3, a: Line, b: Option<Line>) -> [Option<Across>; 2] {
        let slope = |row: usize, column: usize, direction: Direction, ends: [bool; 2]| {
            let gradient = self.patch(row, column).1.gradient(p, &self.common);
            let f = &gradient[direction as usize];
            let at = if ends[0] { f.m } else { 0 } * (f.n + 1) + if ends[1] { f.n } else { 0 };
            outward((f.c[at] - f.error, f.c[at] + f.error), ends[direction as usize])
        };
        let (row, row_far) = a.beside();
        let (column, column_far) = b.map_or((0, false), |b| b.beside());
        let in_u = Across::of(a.sides().map(|(row, far)| slope(row, column, Direction::U, [far, column_far])));
        let in_v =
            b.map(|b| Across::of(b.sides().map(|(column, far)| slope(row, column, Direction::V, [row_far, far]))));
        [Some(in_u), in_v]
    }

    /// What the surface's pole at an end of a direction is for the distance from `p`: an extremum, nothing (the outer none), or what
    /// rounding hides (the inner none).
    ///
    /// The slope with which one leaves a pole is that of the derivative across it, for every parameter along it. Where all of these vanish, the query lies on
    /// the normal, and the derivative's own slope decides.
    pub(super) fn at_pole(&self, p: DVec3, direction: Direction, far: bool) -> Option<Option<Extremum>> {
        let rows = self.patches.len() / self.columns;
        let last = if far { usize::MAX } else { 0 };
        let (mut first, mut second) = ([f64::INFINITY, f64::NEG_INFINITY], [f64::INFINITY, f64::NEG_INFINITY]);
        let (mut noise, mut seen) = (true, [false; 2]);
        let count = if direction == Direction::U { self.columns } else { rows };
        for along in 0..count {
            let (_, patch) = match direction {
                Direction::U => self.patch(last.min(rows - 1), along),
                Direction::V => self.patch(along, last.min(self.columns - 1)),
            };
            let f = &patch.gradient(p, &self.common)[direction as usize];
            let edge = f.edge(direction, far);
            noise &= edge.is_noise();
            let (low, high) = edge.range();
            let (low, high) = outward((low - edge.error, high + edge.error), far);
            first = [first[0].min(low), first[1].max(high)];
            let degree = if direction == Direction::U { f.m } else { f.n };
            if degree > 0 {
                let beside = f.divided(direction, far).edge(direction, far);
                let (low, high) = beside.range();
                let (low, high) = outward((low - beside.error, high + beside.error), far);
                second = [second[0].min(low), second[1].max(high)];
                for k in 0..=8 {
                    let (value, error) = beside.value(f64::from(k) / 8.0, 0.0);
                    seen = [seen[0] || value < -error, seen[1] || value > error];
                }
            }
        }
        let extremum = |[low, high]: [f64; 2]| match (low > 0.0, high < 0.0) {
            (true, _) => Some(Extremum::Minimum),
            (_, true) => Some(Extremum::Maximum),
            _ => None,
        };
        if !noise {
            return extremum(first).map(Some);
        }
        Some(extremum(second).or((seen == [true; 2]).then_some(Extremum::Saddle)))
    }
}
