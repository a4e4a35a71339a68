//! All nearest points: the boxes of parameters that no proof closes at a distance just above the nearest.
//!
//! The form is made at `reach`, the upper bound plus the gap, and its boxes are split until each is one of these:
//!
//! - positive: it holds no point within `reach`;
//! - reduced to a corner, or convex, and so steep that its points within `reach` extend no farther than the resolution: they
//!   surround one foot, which Newton's method finds;
//! - negative and wide: all of it lies within reach;
//! - as narrow as the resolution: undecided. Undecided boxes that touch make one set. Where Newton's method leads from all of them to one
//!   point, that is a foot (its form is flat, or rounding hides its curvature); else they are a continuum.

use fearless_simd::Level;
use glam::DVec3;

use super::certify::Part;
use super::convex::{self, Patch};
use super::form::{form, rounding_bound};
use super::leaf::Leaf;
use super::net::{self, Edge, Layout};
use super::newton::{self, Domain, Found, Search};
use super::reply::Settled;
use super::state::{Foot, State};
use super::{Hierarchy, LocalSolution, ROUNDING, Workspace, holds, squared};
use crate::answer::ParameterBox;
use crate::query::Query;
use crate::solver::Tie;
use crate::tree::Candidate;

/// Undecided boxes are split down to this share of the entity's size, or to the coincidence if that is more.
const RESOLUTION: f64 = 1.0 / 64.0;

/// All nearest points of an entity.
#[derive(Debug)]
pub(crate) struct TieSet {
    pub nearest: LocalSolution,
    pub feet: Vec<LocalSolution>,
    /// Sets of touching boxes.
    pub continua: Vec<Vec<ParameterBox>>,
    pub complete: bool,
}

/// A box that waits: its net and degrees, and the bound of its rounding.
struct Cell {
    net: Vec<f64>,
    layout: Layout,
    domain: Domain,
    rounding: f64,
}

/// An undecided box of a leaf.
#[derive(Debug, Clone, Copy)]
struct Undecided {
    leaf: u32,
    domain: Domain,
    parameters: ParameterBox,
    /// Whether all of it is proven to lie within reach, and it is wider than the resolution.
    wide: bool,
}

impl Hierarchy {
    /// The nearest points; none where nothing is within the query's `max_distance`.
    pub(crate) fn ties(&self, query: &Query, workspace: &mut Workspace) -> Option<TieSet> {
        let mut nearest = self.project(query, None, workspace)?;
        let Workspace { candidates, lists, .. } = workspace;
        let near = self.near(&nearest, query, candidates);
        let mut state = self.state(query, near, lists);
        let coincidence = self.coincidence(query);
        let reach = nearest.distance + state.goal.gap.max(self.asked_gap(query));
        candidates.clear();
        self.tree.nearer_than(state.point, squared(reach) * (1.0 + 8.0 * ROUNDING), candidates);
        candidates.sort_unstable_by_key(|candidate| candidate.item);
        let (mut feet, mut undecided) = (Vec::new(), Vec::new());
        for candidate in candidates.iter() {
            let leaf = &self.leaves[candidate.item as usize];
            if leaf.box_distance_squared(state.point) <= squared(reach) {
                let part = Part { leaf, index: candidate.item, within: Domain::WHOLE, region: None };
                self.sift(part, reach, coincidence, &mut state, &mut feet, &mut undecided);
            }
        }
        let mut continua = Vec::new();
        for set in connected(undecided) {
            match self.common_foot(&set, coincidence, &mut state) {
                Some(foot) => feet.push(foot),
                None => continua.push(set.into_iter().map(|u| u.parameters).collect::<Vec<_>>()),
            }
        }
        let feet = self.distinct(feet, reach, coincidence, &continua, &mut state);
        nearest.tie = match (continua.is_empty(), feet.len()) {
            (false, _) => Tie::Connected,
            (true, 0 | 1) => Tie::None,
            (true, _) => Tie::Apart,
        };
        let at_nearest = |foot: &Settled| foot.point.distance(state.point + nearest.offset) <= coincidence;
        let solution = |foot: &Settled| match at_nearest(foot) {
            true => nearest.clone(),
            false => self.solution_at(foot, nearest.tie, nearest.lower_bound, &state),
        };
        let in_continuum = continua.iter().flatten().any(|b| holds(b.u, nearest.u) && holds(b.v, nearest.v));
        let found = in_continuum || feet.iter().any(at_nearest);
        let mut feet: Vec<LocalSolution> = feet.iter().map(solution).collect();
        // where the search lost the nearest foot itself, it may have lost others
        if !found {
            feet.push(nearest.clone());
            feet.sort_by(|a, b| a.u.total_cmp(&b.u).then(a.v.total_cmp(&b.v)));
        }
        Some(TieSet { feet, continua, complete: found && state.work > 0, nearest })
    }

    /// A solution as a foot of its leaf.
    fn near(&self, solution: &LocalSolution, query: &Query, found: &mut Vec<Candidate>) -> Foot {
        let part = self.part(self.leaf_at(solution.u, solution.v, found));
        let x = self.frame.enter(query.point) - part.leaf.origin;
        part.foot(&newton::point(part.leaf, x, part.leaf.own_parameters(solution.u, solution.v)))
    }

    /// Splits a leaf until every box is decided or narrow.
    fn sift(
        &self,
        part: Part<'_>,
        reach: f64,
        coincidence: f64,
        state: &mut State<'_>,
        feet: &mut Vec<Foot>,
        undecided: &mut Vec<Undecided>,
    ) {
        let leaf = part.leaf;
        let x = state.point - leaf.origin;
        let threshold = if leaf.rational { 0.0 } else { squared(reach) };
        let (layout, level) = (leaf.shape().layout(), leaf.level);
        let mut net = Vec::new();
        form(level, leaf.shape(), leaf.tables(), x, reach, &mut net);
        let rounding = rounding_bound(leaf.degree, x.length(), leaf.radius, reach, leaf.heaviest);
        let mut cells = vec![Cell { net, layout, domain: Domain::WHOLE, rounding }];
        let mut matrices = Vec::new();
        let resolution = coincidence.max(RESOLUTION);
        while let Some(mut cell) = cells.pop() {
            if net::least(level, &cell.net, cell.layout) > threshold + cell.rounding {
                continue;
            }
            let diameter = diameter(leaf, &cell.domain);
            // how far the form may fall below the threshold, and how much of the box the points that do may take up
            let depth = threshold + 2.0 * cell.rounding - net::least(level, &cell.net, cell.layout);
            let share = resolution / diameter;
            let wide = diameter > resolution && net::most(level, &cell.net, cell.layout) < threshold - cell.rounding;
            while !wide && reduce(level, &mut cell, depth / share) {}
            let corner = cell.layout == Layout { m: 0, n: 0 };
            let foot = (!wide && (corner || is_steep_valley(level, &cell, depth, share, &mut matrices))).then(|| {
                let start = (0.5 * (cell.domain.s.0 + cell.domain.s.1), 0.5 * (cell.domain.t.0 + cell.domain.t.1));
                part.foot(&converge(leaf, x, cell.domain, start, state))
            });
            // Newton's method may fail; then the box is split like the others
            if let Some(foot) = foot.filter(|foot| corner || foot.distance <= reach) {
                feet.push(foot);
            } else if wide || state.work == 0 || diameter <= resolution {
                let (from, to) = (cell.domain.s, cell.domain.t);
                let low = leaf.parameters(from.0, to.0);
                let high = leaf.parameters(from.1, to.1);
                let parameters = ParameterBox { u: (low.0, high.0), v: (low.1, high.1) };
                undecided.push(Undecided { leaf: part.index, domain: cell.domain, parameters, wide });
            } else {
                state.work -= 1;
                let down = is_longer_down(leaf, &cell.domain);
                cells.extend(halves(level, cell, down));
            }
        }
    }

    /// The one point that Newton's method leads to from all boxes of a set, if it is one.
    fn common_foot(&self, set: &[Undecided], coincidence: f64, state: &mut State<'_>) -> Option<Foot> {
        if set.iter().any(|u| u.wide) {
            return None;
        }
        let feet: Vec<Foot> = set
            .iter()
            .map(|u| {
                let leaf = &self.leaves[u.leaf as usize];
                let start = (0.5 * (u.domain.s.0 + u.domain.s.1), 0.5 * (u.domain.t.0 + u.domain.t.1));
                let found = converge(leaf, state.point - leaf.origin, Domain::WHOLE, start, state);
                Part { leaf, index: u.leaf, within: Domain::WHOLE, region: None }.foot(&found)
            })
            .collect();
        let best = *feet.iter().min_by(|a, b| a.distance.total_cmp(&b.distance))?;
        let noise = 64.0 * ROUNDING * (best.distance + 1.0);
        // the border of its leaf keeps a point from a foot beyond it
        let resolution = coincidence.max(RESOLUTION);
        let held = |foot: &Foot| {
            let border = |x: f64| x <= 0.0 || x >= 1.0;
            let surface = self.leaves[foot.leaf as usize].degree.1 > 0;
            let near = foot.point.distance(best.point) <= 2.0 * resolution;
            near && foot.distance > best.distance + noise && (border(foot.s) || (surface && border(foot.t)))
        };
        if feet.iter().any(|foot| foot.point.distance(best.point) > coincidence && !held(foot)) {
            return None;
        }
        Some(best)
    }

    /// The feet within `reach`, no two closer than `coincidence` and none in a continuum, in ascending order of parameters.
    fn distinct(
        &self,
        feet: Vec<Foot>,
        reach: f64,
        coincidence: f64,
        continua: &[Vec<ParameterBox>],
        state: &mut State<'_>,
    ) -> Vec<Settled> {
        let mut polished: Vec<Settled> =
            feet.into_iter().map(|foot| self.polish(&foot, state)).filter(|foot| foot.distance() <= reach).collect();
        let by_parameters = |a: &Settled, b: &Settled| {
            let (a, b) = (a.parameters(), b.parameters());
            a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1))
        };
        // the nearest first: of feet in one valley, cut apart by the borders of leaves, it is the bottom
        polished.sort_by(|a, b| a.distance().total_cmp(&b.distance()).then(by_parameters(a, b)));
        let mut distinct: Vec<Settled> = Vec::new();
        for foot in polished {
            let at = foot.parameters();
            let in_continuum = continua.iter().flatten().any(|b| holds(b.u, at.0) && holds(b.v, at.1));
            let known = |other: &Settled| {
                other.point.distance(foot.point) <= coincidence
                    || !self.is_ridge_between(state.point, other.parameters(), at, foot.distance())
            };
            if !in_continuum && !distinct.iter().any(known) {
                distinct.push(foot);
            }
        }
        distinct.sort_by(by_parameters);
        distinct
    }

    /// Whether the straight way between two parameters leads farther from `p` than `distance`, by more than rounding.
    fn is_ridge_between(&self, p: DVec3, a: (f64, f64), b: (f64, f64), distance: f64) -> bool {
        let noise = 64.0 * ROUNDING * (distance + 1.0);
        [0.25, 0.5, 0.75]
            .iter()
            .any(|share| self.distance_at(p, a.0 + share * (b.0 - a.0), a.1 + share * (b.1 - a.1)) > distance + noise)
    }
}

/// The foot inside a box, from `start`, to convergence.
fn converge(leaf: &Leaf, x: DVec3, domain: Domain, start: (f64, f64), state: &mut State<'_>) -> Found {
    // a flat minimum is approached by a constant factor only: many iterations, and no early end
    let search = Search { domain, start, evaluations: 100, decrease: 0.0 };
    newton::search(leaf, x, search, &mut state.done, &mut |_| false)
}

/// Whether the form is convex on the box, and rises so fast that its points below the threshold take up no more than
/// `share` of the box in either direction: where the form falls to `-depth`, they reach `sqrt(2 depth / curvature)` far.
fn is_steep_valley(level: Level, cell: &Cell, depth: f64, share: f64, matrices: &mut Vec<f64>) -> bool {
    // in units of the box
    let patch = Patch { g: &cell.net, layout: cell.layout, extent: (1.0, 1.0), rounding: cell.rounding };
    let steep = |degree: usize, curvature: f64| degree == 0 || 2.0 * depth <= curvature * share * share;
    let curvature = convex::curvature(level, patch, matrices);
    curvature.is_some_and(|c| steep(cell.layout.m, c.s) && steep(cell.layout.n, c.t))
}

/// Replaces a box by an edge above which the form rises at once: `G(s, t) >= G(0, t) + v s`, where all other rows stay above the
/// edge's by `v` (for `1 - (1 - s)^m >= s`), the bound of rounding apart. With `v` of at least `steepness`, the points below the
/// threshold stay beside the edge. A box with one direction is replaced by an end likewise.
fn reduce(level: Level, cell: &mut Cell, steepness: f64) -> bool {
    let Layout { m, n } = cell.layout;
    let enough = steepness + 2.0 * cell.rounding;
    let end = |(from, to): (f64, f64), last: bool| if last { (to, to) } else { (from, from) };
    if m > 0 && n > 0 {
        let steep = |edge: &Edge| net::above(level, &cell.net, cell.layout, *edge) > enough;
        let Some(edge) = net::EDGES.into_iter().find(steep) else { return false };
        cell.layout = net::take_edge(&mut cell.net, cell.layout, edge);
        match edge {
            Edge::Row { last } => cell.domain.s = end(cell.domain.s, last),
            Edge::Column { last } => cell.domain.t = end(cell.domain.t, last),
        }
        return true;
    }
    let (degree, row) = (cell.layout.along(), &mut cell.net);
    let above = |at: usize| (0..=degree).filter(|k| *k != at).all(|k| row[k] - row[at] > enough);
    if degree == 0 || !(above(0) || above(degree)) {
        return false;
    }
    let last = !above(0);
    row[0] = row[if last { degree } else { 0 }];
    *(if m > 0 { &mut cell.domain.s } else { &mut cell.domain.t }) =
        end(if m > 0 { cell.domain.s } else { cell.domain.t }, last);
    cell.layout = Layout { m: 0, n: 0 };
    cell.layout.pad(&mut cell.net);
    true
}

fn halves(level: Level, cell: Cell, down: bool) -> [Cell; 2] {
    let Cell { net: mut low, layout, domain, rounding } = cell;
    let largest = net::largest(level, &low, layout);
    let mut high = vec![0.0; low.len()];
    let in_s = layout.n == 0 || (layout.m > 0 && down);
    net::halve(level, &mut low, &mut high, layout, in_s);
    let (mut first, mut second) = (domain, domain);
    let degree = if in_s {
        let middle = 0.5 * (domain.s.0 + domain.s.1);
        (first.s.1, second.s.0) = (middle, middle);
        layout.m
    } else {
        let middle = 0.5 * (domain.t.0 + domain.t.1);
        (first.t.1, second.t.0) = (middle, middle);
        layout.n
    };
    let rounding = rounding + degree as f64 * ROUNDING * largest;
    [Cell { net: low, layout, domain: first, rounding }, Cell { net: high, layout, domain: second, rounding }]
}

/// The largest distance between the corners and the middle of a box of a leaf: as good a diameter as the resolution needs.
fn diameter(leaf: &Leaf, domain: &Domain) -> f64 {
    let middle = (0.5 * (domain.s.0 + domain.s.1), 0.5 * (domain.t.0 + domain.t.1));
    let corners =
        [(domain.s.0, domain.t.0), (domain.s.0, domain.t.1), (domain.s.1, domain.t.0), (domain.s.1, domain.t.1)];
    let points = corners.into_iter().chain([middle]).map(|(s, t)| leaf.jet(s, t).point());
    let points: smallvec::SmallVec<[DVec3; 5]> = points.collect();
    points.iter().flat_map(|a| points.iter().map(|b| a.distance(*b))).fold(0.0, f64::max)
}

/// Whether a box of a leaf is longer in s than in t, across its middle.
fn is_longer_down(leaf: &Leaf, domain: &Domain) -> bool {
    let middle = (0.5 * (domain.s.0 + domain.s.1), 0.5 * (domain.t.0 + domain.t.1));
    let at = |s: f64, t: f64| leaf.jet(s, t).point();
    let s = at(domain.s.0, middle.1).distance_squared(at(domain.s.1, middle.1));
    let t = at(middle.0, domain.t.0).distance_squared(at(middle.0, domain.t.1));
    s >= t
}

/// Groups boxes that touch.
fn connected(boxes: Vec<Undecided>) -> Vec<Vec<Undecided>> {
    let overlap = |a: (f64, f64), b: (f64, f64)| a.0 <= b.1 && b.0 <= a.1;
    let touch = |a: &Undecided, b: &Undecided| {
        overlap(a.parameters.u, b.parameters.u) && overlap(a.parameters.v, b.parameters.v)
    };
    let mut waiting = boxes;
    let mut sets = Vec::new();
    while let Some(first) = waiting.pop() {
        let mut set = vec![first];
        let mut next = 0;
        while next < set.len() {
            let here = set[next];
            let (near, rest) = waiting.into_iter().partition(|other| touch(&here, other));
            set.extend::<Vec<_>>(near);
            waiting = rest;
            next += 1;
        }
        sets.push(set);
    }
    sets
}
