//! From what pieces, lines and vertices found to the stationary points of the entity.
//!
//! A zero well inside its piece is a point. One on the border of its piece is found by the neighbours too, or is lost by both to rounding: each
//! piece's polynomials go on beyond its border, so each still finds it beside itself. Such zeros, what lies on the line between, and boxes left undecided
//! are joined where they touch, across seams too.

use glam::DVec3;
use perpend_kernel::{Aabb, Direction};

use super::isolate::{Range, Zero, isolate};
use super::patch::Patch;
use super::strata::{Across, Segment, together};
use super::{Bernstein, LocalPoint, LocalSet};
use crate::stationary::{Certainty, Extremum};
use crate::statistics::Work;
use crate::tree::BoxTree;

/// The widest margin beside a piece, as a share of it, in which a zero still counts as one of its border.
const WIDEST_MARGIN: f64 = 0.05;

/// Finds farther apart than this share of the domain are not the same, however near they are in space: sheets may cross.
const NEAR: f64 = 1e-3;

/// Sets no longer than this many tolerances are points: a point on a corner of four boxes has two of them on each side.
const POINT: f64 = 4.0;

/// How sure a find is to be a point of the entity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum State {
    /// It is one, and no other find is the same.
    Firm,
    /// It is one, unless a neighbour found the same.
    Shared,
    /// It lies beside its piece: it is one if its neighbour's lies beside that one too.
    Outside,
    /// A point of which rounding hides what it is.
    Unclear,
    /// A box.
    Box,
}

/// Something found on a piece, a line or a vertex.
#[derive(Debug, Clone, Copy)]
struct Find {
    at: [f64; 2],
    range: Range,
    point: DVec3,
    kind: Option<Extremum>,
    descends_inward: bool,
    state: State,
    /// 0 for a vertex, 1 on a line (or curve), 2 on a surface.
    dimension: u8,
    /// A collapsed edge.
    is_pole: bool,
    /// Half the extent of a box.
    extent: f64,
}

/// How a zero lies to the borders of its piece, in one direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Position {
    Inside,
    Near,
    On,
    Outside,
    Beyond,
}

impl Bernstein {
    /// All stationary points of the distance from `p`, in the entity's own coordinates, as `tolerance` is. `splits` bounds the work.
    pub(crate) fn stationary(&self, p: DVec3, tolerance: f64, splits: u32, work: &mut Work) -> LocalSet {
        let mut finds = Vec::new();
        let mut complete = self.lines_and_vertices(p, tolerance, u64::from(splits) / 4, work, &mut finds);
        complete &= self.pieces(p, tolerance, u64::from(splits), work, &mut finds);
        let (firm, rest): (Vec<Find>, Vec<Find>) = finds.into_iter().partition(|find| find.state == State::Firm);
        let mut points: Vec<LocalPoint> = firm.iter().map(|find| local_point(find, Certainty::One)).collect();
        let mut continua = Vec::new();
        for set in self.connected(rest, tolerance) {
            match self.as_point(&set, p, tolerance) {
                Joined::Point(point) => points.push(point),
                Joined::Continuum(boxes) => continua.push(boxes),
                Joined::Nothing => {}
            }
        }
        points.sort_by(|a, b| a.at[0].total_cmp(&b.at[0]).then(a.at[1].total_cmp(&b.at[1])));
        LocalSet { points, continua, complete }
    }

    fn pieces(&self, p: DVec3, tolerance: f64, mut splits: u64, work: &mut Work, finds: &mut Vec<Find>) -> bool {
        let systems = self.patches.iter().map(|patch| patch.gradient(p, &self.common));
        let lengths = |piece: usize, range: Range| self.patches[piece].lengths(range[0], range[1]);
        let (found, complete) = isolate(systems, lengths, tolerance, &mut splits, work);
        for (index, found) in found.into_iter().enumerate() {
            let patch = &self.patches[index];
            for zero in &found.zeros {
                finds.extend(self.find_of_piece(index, zero, tolerance));
            }
            let range = |range: Range| if self.is_curve { [range[0], (0.0, 0.0)] } else { range };
            let dimension = if self.is_curve { 1 } else { 2 };
            finds.extend(found.undecided.into_iter().map(|cell| box_find(patch, range(cell), dimension)));
        }
        complete
    }

    fn lines_and_vertices(
        &self,
        p: DVec3,
        tolerance: f64,
        mut splits: u64,
        work: &mut Work,
        finds: &mut Vec<Find>,
    ) -> bool {
        let segments = self.segments();
        let systems = segments.iter().map(|segment| segment.system(self, p));
        let lengths = |k: usize, range: Range| {
            let range = segments[k].range(self, range[0]);
            let (_, patch, _) = segments[k].patch(self);
            [patch.lengths(range[0], range[1])[segments[k].direction() as usize], 0.0]
        };
        let (found, complete) = isolate(systems, lengths, tolerance, &mut splits, work);
        for (segment, found) in segments.iter().zip(found) {
            for zero in &found.zeros {
                finds.extend(self.find_of_segment(segment, zero, p, tolerance));
            }
            let (_, patch, _) = segment.patch(self);
            for cell in found.undecided {
                if segment.across(self, p, cell[0]) != Across::Passes {
                    finds.push(box_find(patch, segment.range(self, cell[0]), 1));
                }
            }
        }
        for a in &self.lines[0] {
            if self.is_curve {
                finds.extend(self.find_of_vertex(p, *a, None));
            }
            for b in &self.lines[1] {
                finds.extend(self.find_of_vertex(p, *a, Some(*b)));
            }
        }
        for direction in if self.is_curve { &[][..] } else { &[Direction::U, Direction::V] } {
            for far in [false, true] {
                finds.extend(self.find_of_pole(p, *direction, far));
            }
        }
        complete
    }

    fn find_of_piece(&self, index: usize, zero: &Zero, tolerance: f64) -> Option<Find> {
        let patch = &self.patches[index];
        let [row, column] = [index / self.columns, index % self.columns];
        let count = [self.patches.len() / self.columns, self.columns];
        let mut positions = [Position::Inside; 2];
        let lengths = patch.lengths((0.0, 1.0), (0.0, 1.0));
        for (d, k) in [row, column].into_iter().enumerate().take(if self.is_curve { 1 } else { 2 }) {
            let margin = margin(tolerance, lengths[d]);
            let joined = [k > 0 || self.closed[d], k + 1 < count[d] || self.closed[d]];
            positions[d] = position(zero.at[d], zero.radius[d], margin, joined)?;
        }
        let kind = Some(zero.kind);
        let dimension = if self.is_curve { 1 } else { 2 };
        Some(find_at(patch, zero.at, zero.radius, positions, Find { kind, dimension, ..EMPTY }))
    }

    fn find_of_segment(&self, segment: &Segment, zero: &Zero, p: DVec3, tolerance: f64) -> Option<Find> {
        let (index, patch, far) = segment.patch(self);
        let d = segment.direction() as usize;
        let [row, column] = [index / self.columns, index % self.columns];
        let (k, count) = if d == 0 { (row, self.patches.len() / self.columns) } else { (column, self.columns) };
        let joined = [k > 0 || self.closed[d], k + 1 < count || self.closed[d]];
        let margin = margin(tolerance, patch.lengths((0.0, 1.0), (0.0, 1.0))[d]);
        let position = position(zero.at[0], zero.radius[0], margin, joined)?;
        let across = segment.across(self, p, (zero.at[0] - zero.radius[0], zero.at[0] + zero.radius[0]));
        if across == Across::Passes {
            return None;
        }
        let on_line = if far { 1.0 } else { 0.0 };
        let (mut at, mut radius, mut positions) = ([on_line; 2], [0.0; 2], [Position::Inside; 2]);
        (at[d], radius[d], positions[d]) = (zero.at[0], zero.radius[0], position);
        let kind = across.extremum().map(|across| together(zero.kind, across));
        let descends_inward = segment.line.is_edge() && across == Across::Falls;
        let mut find = find_at(patch, at, radius, positions, Find { kind, descends_inward, dimension: 1, ..EMPTY });
        if across == Across::Unclear {
            find.state = State::Unclear;
        } else if find.state == State::Firm && !segment.line.is_edge() {
            find.state = State::Shared;
        }
        Some(find)
    }

    fn find_of_vertex(&self, p: DVec3, a: super::Line, b: Option<super::Line>) -> Option<Find> {
        let across = self.across_vertex(p, a, b);
        let across: smallvec::SmallVec<[Across; 2]> = across.into_iter().flatten().collect();
        if across.contains(&Across::Passes) {
            return None;
        }
        let kinds: Option<smallvec::SmallVec<[Extremum; 2]>> = across.iter().map(|across| across.extremum()).collect();
        let kind = kinds.and_then(|kinds| kinds.into_iter().reduce(together));
        let edges = [a.is_edge(), b.is_some_and(|b| b.is_edge())];
        let descends_inward = across.iter().zip(edges).any(|(across, edge)| edge && *across == Across::Falls);
        let ((row, row_far), (column, column_far)) = (a.beside(), b.map_or((0, false), |b| b.beside()));
        let (_, patch) = self.patch(row, column);
        let end = |far: bool| if far { 1.0 } else { 0.0 };
        let at = [end(row_far), end(column_far)];
        let mut find = find_at(patch, at, [0.0; 2], [Position::Inside; 2], Find { kind, descends_inward, ..EMPTY });
        let on_edges_only = edges[0] && (b.is_none() || edges[1]);
        find.state = match kind {
            None => State::Unclear,
            Some(_) if on_edges_only => State::Firm,
            Some(_) => State::Shared,
        };
        Some(find)
    }

    fn find_of_pole(&self, p: DVec3, direction: Direction, far: bool) -> Option<Find> {
        let d = direction as usize;
        let (_, corner) = if far {
            let (row, column) = (self.patches.len() / self.columns - 1, self.columns - 1);
            self.patch(row, column)
        } else {
            self.patch(0, 0)
        };
        if !corner.poles[d][usize::from(far)] {
            return None;
        }
        let kind = self.at_pole(p, direction, far)?;
        let end = if far { 1.0 } else { 0.0 };
        let mut find =
            find_at(corner, [end; 2], [0.0; 2], [Position::Inside; 2], Find { kind, is_pole: true, ..EMPTY });
        find.at[1 - d] = self.domain[1 - d].0;
        find.range[1 - d] = self.domain[1 - d];
        find.state = if kind.is_some() { State::Shared } else { State::Unclear };
        Some(find)
    }

    /// Groups finds that touch.
    ///
    /// A tree over their boxes, in shares of the domain, tells which may: there may be as many as the entity has pieces.
    fn connected(&self, finds: Vec<Find>, tolerance: f64) -> Vec<Vec<Find>> {
        let directions = if self.is_curve { 1 } else { 2 };
        let share = |d: usize, x: f64| (x - self.domain[d].0) / (self.domain[d].1 - self.domain[d].0);
        let corner = |find: &Find, end: fn((f64, f64)) -> f64| {
            let mut at = DVec3::ZERO;
            (0..directions).for_each(|d| at[d] = share(d, end(find.range[d])));
            at
        };
        let boxes: Vec<Aabb> =
            finds.iter().map(|find| Aabb { min: corner(find, |r| r.0), max: corner(find, |r| r.1) }).collect();
        let tree = BoxTree::new(&boxes);
        // the lowest find of the set that each belongs to
        let mut parent: Vec<usize> = (0..finds.len()).collect();
        let root = |parent: &mut Vec<usize>, mut k: usize| {
            while parent[k] != k {
                parent[k] = parent[parent[k]];
                k = parent[k];
            }
            k
        };
        let mut near = Vec::new();
        for (k, find) in finds.iter().enumerate() {
            let reach = 0.5 * boxes[k].diagonal() + if find.state == State::Box { 1e-11 } else { 2.0 * NEAR };
            for (a, b) in self.shifts() {
                near.clear();
                tree.nearer_than(boxes[k].centre() + DVec3::new(a, b, 0.0), reach * reach, &mut near);
                for candidate in &near {
                    let other = candidate.item as usize;
                    if self.touch(find, &finds[other], tolerance) {
                        let (a, b) = (root(&mut parent, k), root(&mut parent, other));
                        parent[a.max(b)] = a.min(b);
                    }
                }
            }
        }
        let mut sets: Vec<Vec<Find>> = finds.iter().map(|_| Vec::new()).collect();
        for (k, find) in finds.into_iter().enumerate() {
            sets[root(&mut parent, k)].push(find);
        }
        sets.retain(|set| !set.is_empty());
        sets
    }

    /// Where else the same point lies, in shares of the domain: beyond a seam.
    fn shifts(&self) -> impl Iterator<Item = (f64, f64)> {
        let steps = |closed: bool| if closed { &[0.0, 1.0, -1.0][..] } else { &[0.0][..] };
        let (u, v) = (steps(self.closed[0]), steps(self.closed[1]));
        u.iter().flat_map(move |a| v.iter().map(move |b| (*a, *b)))
    }

    fn touch(&self, a: &Find, b: &Find, tolerance: f64) -> bool {
        let boxes = [a, b].into_iter().filter(|find| find.state == State::Box).count();
        // beside a seam parameters are a whole period apart
        let near = |share: f64| {
            (0..if self.is_curve { 1 } else { 2 }).all(|d| {
                let ((a, b), (c, e)) = (a.range[d], b.range[d]);
                let period = self.domain[d].1 - self.domain[d].0;
                let overlap = |by: f64| a <= e + by + share * period && c + by <= b + share * period;
                overlap(0.0) || (self.closed[d] && (overlap(period) || overlap(-period)))
            })
        };
        match boxes {
            0 => a.point.distance(b.point) <= tolerance && near(NEAR),
            1 => near(1e-6) || (a.point.distance(b.point) <= tolerance + a.extent + b.extent && near(NEAR)),
            _ => near(1e-12),
        }
    }

    /// What a set of touching finds is.
    fn as_point(&self, set: &[Find], p: DVec3, tolerance: f64) -> Joined {
        let boxes: Vec<&Find> = set.iter().filter(|find| find.state == State::Box).collect();
        let points: Vec<&Find> = set.iter().filter(|find| find.state != State::Box).collect();
        let inside = points.iter().filter(|find| find.state != State::Outside).count();
        if boxes.is_empty() && inside == 0 && points.len() < 2 {
            return Joined::Nothing;
        }
        // the find of the least dimension says best where the set is; of these, one that is inside its piece
        let order = |a: &&&Find, b: &&&Find| {
            let rank = |find: &Find| (find.dimension, find.state == State::Outside);
            rank(a).cmp(&rank(b)).then(a.at[0].total_cmp(&b.at[0])).then(a.at[1].total_cmp(&b.at[1]))
        };
        let first = points.iter().min_by(order).copied().unwrap_or(boxes.first().copied().unwrap_or(&EMPTY));
        let extent = set.iter().map(|find| find.point.distance(first.point) + find.extent).fold(0.0, f64::max);
        if !boxes.is_empty() && extent > POINT * tolerance {
            return Joined::Continuum(boxes.iter().map(|find| find.range).collect());
        }
        let kinds = || points.iter().filter_map(|find| find.kind);
        let agreed = kinds().next().filter(|kind| kinds().all(|other| other == *kind));
        let pole = points.iter().find(|find| find.is_pole);
        let sure = |find: &&&Find| find.state != State::Unclear;
        let (kind, certainty) = match (pole, agreed) {
            (Some(pole), _) if pole.kind.is_some() => (pole.kind, Certainty::One),
            (_, Some(kind)) if boxes.is_empty() && points.iter().any(|find| sure(&find)) => {
                (Some(kind), Certainty::One)
            }
            (_, Some(kind)) => (Some(kind), Certainty::Undecided),
            (_, None) => (self.change_of_sign(&boxes, p), Certainty::Undecided),
        };
        let hull = |d: usize| {
            let here = first.range[d];
            // those beyond a seam are left out: the box is where the point is given
            let near = set.iter().map(|find| find.range[d]).filter(|range| {
                let period = self.domain[d].1 - self.domain[d].0;
                range.0 - here.1 < 0.5 * period && here.0 - range.1 < 0.5 * period
            });
            near.fold(here, |(low, high), (from, to)| (low.min(from), high.max(to)))
        };
        let descends_inward = points.iter().any(|find| find.descends_inward);
        let find = Find { kind, descends_inward, range: [hull(0), hull(1)], ..*first };
        Joined::Point(local_point(&find, certainty))
    }

    /// What a curve's undecided boxes hold at least: the sign of the derivative on both sides tells.
    fn change_of_sign(&self, boxes: &[&Find], p: DVec3) -> Option<Extremum> {
        let low = boxes.iter().map(|find| find.range[0].0).fold(f64::INFINITY, f64::min);
        let high = boxes.iter().map(|find| find.range[0].1).fold(f64::NEG_INFINITY, f64::max);
        let patch = self.patches.iter().find(|patch| self.is_curve && patch.u.0 <= low && high <= patch.u.1)?;
        let slope = &patch.gradient(p, &self.common)[0];
        let sign = |u: f64| {
            let (value, error) = slope.value((u - patch.u.0) / (patch.u.1 - patch.u.0), 0.0);
            if value > error {
                1
            } else if value < -error {
                -1
            } else {
                0
            }
        };
        match (sign(low), sign(high)) {
            (-1, 1) => Some(Extremum::Minimum),
            (1, -1) => Some(Extremum::Maximum),
            _ => None,
        }
    }
}

/// What a set of finds is.
enum Joined {
    Point(LocalPoint),
    Continuum(Vec<Range>),
    Nothing,
}

const EMPTY: Find = Find {
    at: [0.0; 2],
    range: [(0.0, 0.0); 2],
    point: DVec3::ZERO,
    kind: None,
    descends_inward: false,
    state: State::Firm,
    dimension: 0,
    is_pole: false,
    extent: 0.0,
};

/// How far beside its piece a zero may lie, as a share of the piece.
fn margin(tolerance: f64, length: f64) -> f64 {
    if length > 0.0 { (tolerance / length).clamp(1e-12, WIDEST_MARGIN) } else { WIDEST_MARGIN }
}

/// Where a zero lies; none where it is no point of the piece nor of a neighbour. `joined` says where there are neighbours.
fn position(x: f64, radius: f64, margin: f64, joined: [bool; 2]) -> Option<Position> {
    let towards = |x: f64| match x {
        x if x + radius < -margin => Position::Beyond,
        x if x + radius < 0.0 => Position::Outside,
        x if x - radius <= 0.0 => Position::On,
        x if x < margin => Position::Near,
        _ => Position::Inside,
    };
    let [low, high] = [towards(x), towards(1.0 - x)];
    let (side, position) = if low == Position::Inside { (1, high) } else { (0, low) };
    match (position, joined[side]) {
        (Position::Beyond, _) | (Position::Outside, false) => None,
        (Position::Near, false) => Some(Position::Inside),
        (position, _) => Some(position),
    }
}

/// A point find: on the border of its piece where it is on it or beside it.
fn find_at(patch: &Patch, at: [f64; 2], radius: [f64; 2], positions: [Position; 2], find: Find) -> Find {
    let mut snapped = at;
    for d in 0..2 {
        if matches!(positions[d], Position::On | Position::Outside) {
            snapped[d] = if at[d] < 0.5 { 0.0 } else { 1.0 };
        }
    }
    let low = patch.parameters(at[0] - radius[0], at[1] - radius[1]);
    let high = patch.parameters(at[0] + radius[0], at[1] + radius[1]);
    let state = match positions {
        positions if positions.contains(&Position::Outside) => State::Outside,
        [Position::Inside, Position::Inside] => State::Firm,
        _ => State::Shared,
    };
    Find {
        at: patch.parameters(snapped[0], snapped[1]),
        range: [(low[0], high[0]), (low[1], high[1])],
        point: patch.point(snapped[0], snapped[1]),
        state,
        ..find
    }
}

fn box_find(patch: &Patch, range: Range, dimension: u8) -> Find {
    let [s, t] = range;
    let middle = (0.5 * (s.0 + s.1), 0.5 * (t.0 + t.1));
    let (low, high) = (patch.parameters(s.0, t.0), patch.parameters(s.1, t.1));
    let lengths = patch.lengths(s, t);
    Find {
        at: patch.parameters(middle.0, middle.1),
        range: [(low[0], high[0]), (low[1], high[1])],
        point: patch.point(middle.0, middle.1),
        state: State::Box,
        dimension,
        extent: 0.5 * (lengths[0] + lengths[1]),
        ..EMPTY
    }
}

fn local_point(find: &Find, certainty: Certainty) -> LocalPoint {
    let Find { at, range, point, kind, descends_inward, .. } = *find;
    LocalPoint { at, range, point, kind, descends_inward, certainty }
}
