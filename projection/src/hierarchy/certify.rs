//! The proof for one leaf by its form, where a glance did not give it: no point of it is nearer than `tau`.
//!
//! A box of the leaf's parameters is described by the net `g` of the form on it. Two things are kept beside the net:
//!
//! - `rounding`: every coefficient of the true form differs from its `g` by at most this;
//! - `slack`: what reductions have given away. The box may stand for a larger one that was reduced to one of its edges or
//!   corners; on all of that one the true form is at least the least of the true form on the box, less `slack`.
//!
//! With `threshold` (`tau²` for a polynomial leaf, whose form leaves `tau` out, else 0), these tests close a box or make it simpler:
//!
//! 1. **Positive**: `min g > threshold + rounding + slack`.
//! 2. **Corner**: the least coefficient is that of a corner, up to `c = g_corner - min g`. The form is at least its value at the
//!    corner less `c + 2 rounding + slack`; that value is evaluated, with an error of its own.
//! 3. **Edge**: all rows stay above the first (or last) one by `v = min (g_kl - g_0l)`. Then `G(s, t) >= G(0, t) - max(0, 2 rounding - v)`,
//!    since the true differences are at least `v - 2 rounding` and the other rows' Bernstein polynomials add up to at most 1. The edge replaces the
//!    box. Asking for this weaker thing than monotony is what lets collapsed edges, zero widths and exact ties through.
//! 4. **Convex**: with `H >= diag(a, c)` on the box and any point `x0` of it,
//!    `G >= G(x0) + min (Gs ds + a ds²/2) + min (Gt dt + c dt²/2)` over the steps that stay in the box. At the corners value and gradient are
//!    coefficients; elsewhere they are evaluated, with errors of their own ([`bound`](super::bound)).
//! 5. **Valley**: convex in one direction, and level enough in the other ([`valley`]), seen from the line of the point that Newton's
//!    method found. Not on the whole leaf, which is split first, and only where that point is no nearer.
//! 6. else the box is split.
//!
//! Reductions may give away a tenth of the margin that the form has at a foot; whether they gave too much, the closing test decides.

use fearless_simd::Level;
use glam::{DVec2, DVec3};
use perpend_kernel::{Region, Side};

use super::ROUNDING;
use super::bound::{least_from, value_error};
use super::convex::{self, Bend, Curvature, Patch};
use super::form::{form, rounding_bound};
use super::leaf::Leaf;
use super::net::{self, Edge, Layout};
use super::newton::{self, Domain, Found, Search};
use super::state::{Foot, State};
use super::valley;

/// Working memory: the nets of all boxes that wait, the boxes, the matrices of the convexity test, and a line of the valley's.
#[derive(Debug, Default)]
pub(super) struct Memory {
    nets: Vec<f64>,
    cells: Vec<Cell>,
    matrices: Vec<f64>,
    line: Vec<f64>,
}

/// A box of the leaf that waits for its proof.
#[derive(Debug, Clone, Copy)]
struct Cell {
    /// Where its net begins. The nets of the waiting boxes lie in the order of the boxes.
    offset: usize,
    layout: Layout,
    domain: Domain,
    rounding: f64,
    slack: f64,
}

impl Cell {
    fn extent(&self) -> (f64, f64) {
        (self.domain.s.1 - self.domain.s.0, self.domain.t.1 - self.domain.t.0)
    }

    /// Too narrow for further splits of the form to tell anything.
    fn is_narrow(&self) -> bool {
        let (s, t) = self.extent();
        (self.layout.m == 0 || s < 1e-12) && (self.layout.n == 0 || t < 1e-12)
    }
}

/// A leaf, or a part of one that came of refinement, and where it lies in its prepared leaf.
#[derive(Debug, Clone, Copy)]
pub(super) struct Part<'a> {
    pub leaf: &'a Leaf,
    /// The prepared leaf.
    pub index: u32,
    /// What it covers of the prepared leaf.
    pub within: Domain,
    /// Of a leaf that the boundary of a trim crosses: the region to which its points belong, or not.
    pub region: Option<&'a Region>,
}

impl Part<'_> {
    pub(super) fn is_whole(&self) -> bool {
        self.within.s == (0.0, 1.0) && self.within.t == (0.0, 1.0)
    }

    /// Parameters of the part as parameters of its prepared leaf.
    pub(super) fn parameters(&self, s: f64, t: f64) -> (f64, f64) {
        let along = |(from, to): (f64, f64), x: f64| if x >= 1.0 { to } else { from + x * (to - from) };
        (along(self.within.s, s), along(self.within.t, t))
    }

    /// A point of the part as a point of the entity.
    pub(super) fn foot(&self, found: &Found) -> Foot {
        let (s, t) = self.parameters(found.s, found.t);
        Foot {
            leaf: self.index,
            s,
            t,
            next: self.parameters(found.next.0, found.next.1),
            point: found.jet.point() + self.leaf.origin,
            distance: found.distance,
        }
    }

    /// Looks for a foot from the part's linear guess: none can be nearer than what is proven, but one may be as near.
    pub(super) fn look_for_tie(&self, state: &mut State<'_>) {
        let x = state.point - self.leaf.origin;
        let (s, t) = self.leaf.linear_guess(x);
        let domain = Domain::WHOLE;
        let decrease = 1e-3 * state.margin();
        let search = Search { domain, start: domain.clamp(s, t), evaluations: 8, decrease };
        let found = newton::search(self.leaf, x, search, &mut state.done, &mut |_| false);
        self.offer(&found, state);
    }

    /// Tells the state of a point of the part, unless that is trimmed away.
    pub(super) fn offer(&self, found: &Found, state: &mut State<'_>) {
        if self.counts(found.s, found.t) {
            state.offer(self.foot(found));
        } else {
            state.rejected = state.rejected.min(found.distance);
        }
    }

    /// Whether a point of the part belongs to the entity: of a leaf that is crossed by a trim, not all do.
    pub(super) fn counts(&self, s: f64, t: f64) -> bool {
        self.region.is_none_or(|region| {
            let (u, v) = self.leaf.parameters(s, t);
            region.side(DVec2::new(u, v)) != Side::Outside
        })
    }
}

/// How the proof of a leaf ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Outcome {
    /// No point of it is nearer than the state's `tau`, but for boxes whose bounds went to the state's `open`.
    Closed,
    /// Rounding or the leaf's share of the work stopped it.
    Stopped,
}

/// Proves the part no nearer than the state's `tau`, or finds nearer points on the way (then `tau` falls).
///
/// At most `share` splits are spent; `last` says that nothing follows: then boxes that resist are left open.
pub(super) fn certify(part: Part<'_>, state: &mut State<'_>, memory: &mut Memory, share: u32, last: bool) -> Outcome {
    let leaf = part.leaf;
    let x = state.point - leaf.origin;
    let mut proof = Proof { part, x, formed: 0.0, tried: false, found: leaf.linear_guess(x) };
    proof.restart(state, memory);
    let mut splits = 0;
    while let Some(cell) = memory.cells.pop() {
        memory.nets.truncate(cell.offset + cell.layout.len());
        if state.tau() == 0.0 {
            return Outcome::Closed;
        }
        if proof.is_stale(state) {
            proof.restart(state, memory);
            continue;
        }
        if part.region.is_some() && state.rejected < state.tau() {
            return Outcome::Stopped; // nearer points that do not count: no form can prove the leaf
        }
        match proof.examine(cell, state, memory) {
            Verdict::Closed => {}
            Verdict::Again(cell) => memory.cells.push(cell),
            Verdict::Open { least } => {
                if splits >= share || state.work == 0 || cell.is_narrow() {
                    if !last && state.work > 0 {
                        return Outcome::Stopped;
                    }
                    proof.leave_open(cell, least, state);
                    continue;
                }
                splits += 1;
                state.work -= 1;
                state.done.subdivisions += 1;
                split(leaf.level, cell, memory);
            }
        }
    }
    Outcome::Closed
}

/// What became of a box.
enum Verdict {
    /// Proven.
    Closed,
    /// Reduced, or the upper bound fell: look again.
    Again(Cell),
    /// To be split; `least` is its least coefficient.
    Open { least: f64 },
}

struct Proof<'a> {
    part: Part<'a>,
    /// The query, about the leaf's origin.
    x: DVec3,
    /// The `tau` that a rational leaf's form was made with.
    formed: f64,
    /// Whether Newton's method was tried from inside the leaf.
    tried: bool,
    /// What it found there, in the leaf's parameters.
    found: (f64, f64),
}

impl Proof<'_> {
    /// Makes the form of the whole leaf.
    fn restart(&mut self, state: &mut State<'_>, memory: &mut Memory) {
        let leaf = self.part.leaf;
        self.formed = state.tau();
        memory.nets.clear();
        memory.cells.clear();
        form(leaf.level, leaf.shape(), leaf.tables(), self.x, self.formed, &mut memory.nets);
        state.done.pieces += 1;
        let layout = leaf.shape().layout();
        let rounding = rounding_bound(leaf.degree, self.x.length(), leaf.radius, self.formed, leaf.heaviest);
        memory.cells.push(Cell { offset: 0, layout, domain: Domain::WHOLE, rounding, slack: 0.0 });
    }

    /// Whether `tau` fell so far that the form of a rational leaf asks for more than is needed. What is convex or dominated
    /// at one `tau` need not be at another, since the weights vary. (A form that asks for more still proves what it proves: when the
    /// work is spent, it is kept.)
    fn is_stale(&self, state: &State<'_>) -> bool {
        self.part.leaf.rational && state.work > 0 && state.tau() < self.formed - 0.5 * state.goal.gap
    }

    /// The `tau` that the form speaks of.
    fn tau(&self, state: &State<'_>) -> f64 {
        if self.part.leaf.rational { self.formed } else { state.tau() }
    }

    fn examine(&mut self, mut cell: Cell, state: &mut State<'_>, memory: &mut Memory) -> Verdict {
        let leaf = self.part.leaf;
        let threshold = if leaf.rational { 0.0 } else { state.tau().powi(2) };
        let budget = 0.1 * state.margin() * leaf.lightest * leaf.lightest;
        let g = &mut memory.nets[cell.offset..cell.offset + cell.layout.len()];
        let least = net::least(leaf.level, g, cell.layout);
        if least > threshold + cell.rounding + cell.slack {
            self.look_for_tie(least, state);
            return Verdict::Closed;
        }
        if let Some(verdict) = self.corner(cell, g, least, budget, state) {
            return verdict;
        }
        if reduce_to_edge(leaf.level, &mut cell, g, least, budget) {
            return Verdict::Again(cell);
        }
        let patch = Patch { g, layout: cell.layout, extent: cell.extent(), rounding: cell.rounding };
        let bend = convex::bend(leaf.level, patch, &mut memory.matrices);
        if let Bend::Convex(curvature) = bend {
            if corners_close(cell, g, curvature, threshold) || self.newton_closes(cell, curvature, state) {
                return Verdict::Closed;
            }
            if state.tau() == 0.0 || self.is_stale(state) {
                return Verdict::Again(cell);
            }
        } else if !self.tried || least_corner(cell, g) < threshold - cell.rounding {
            // not tried yet, or a corner is proven nearer than tau
            self.tried = true;
            let before = state.tau();
            self.newton_from_least(cell, g, least, state);
            if state.tau() < before {
                return Verdict::Again(cell);
            }
        }
        match bend {
            Bend::Valley { in_s, bend } if self.valley_closes(cell, in_s, bend, threshold, memory) => Verdict::Closed,
            _ => Verdict::Open { least },
        }
    }

    /// Test 5, along the line of the point that Newton's method found in the leaf. The whole leaf is split first: most forms need no more.
    fn valley_closes(&self, cell: Cell, in_s: bool, bend: f64, threshold: f64, memory: &mut Memory) -> bool {
        let extent = cell.extent();
        if extent == (1.0, 1.0) {
            return false;
        }
        let g = &memory.nets[cell.offset..cell.offset + cell.layout.len()];
        let rounding = (cell.rounding, net::largest(self.part.leaf.level, g, cell.layout));
        let (found, from, extent) = match in_s {
            true => (self.found.0, cell.domain.s.0, extent.0),
            false => (self.found.1, cell.domain.t.0, extent.1),
        };
        let at = ((found - from) / extent).clamp(0.0, 1.0);
        valley::least_beside((g, cell.layout), in_s, at, bend, rounding, &mut memory.line) > threshold + cell.slack
    }

    /// A box that is only just positive may hold a foot as near as the best, within the gap.
    fn look_for_tie(&mut self, least: f64, state: &mut State<'_>) {
        let leaf = self.part.leaf;
        let reach = state.reach();
        let limit = if leaf.rational {
            (reach - self.formed) * (reach + self.formed) * leaf.heaviest * leaf.heaviest
        } else {
            reach * reach
        };
        if least < limit && !self.tried {
            self.tried = true;
            self.part.look_for_tie(state);
        }
    }

    /// Test 2. None where the least coefficient is no corner's; otherwise the corner is evaluated, which may find a nearer point.
    fn corner(&self, cell: Cell, g: &[f64], least: f64, budget: f64, state: &mut State<'_>) -> Option<Verdict> {
        let leaf = self.part.leaf;
        let (at, corner) = corners(cell).min_by(|a, b| g[a.0].total_cmp(&g[b.0]))?;
        let given = g[at] - least + 2.0 * cell.rounding + cell.slack;
        if given > budget {
            return None;
        }
        state.done.evaluations += 1;
        let found = newton::point(leaf, self.x, corner);
        let (d, weight) = (found.distance, found.jet.p.w);
        self.part.offer(&found, state);
        if self.is_stale(state) {
            return Some(Verdict::Again(cell));
        }
        let tau = self.tau(state);
        let value = (d - tau) * (d + tau) * weight * weight;
        (value >= given + value_error(leaf, d)).then_some(Verdict::Closed)
    }

    /// Test 4 away from the corners: Newton's method inside the box, the bound tested at every iterate.
    fn newton_closes(&mut self, cell: Cell, curvature: Curvature, state: &mut State<'_>) -> bool {
        let leaf = self.part.leaf;
        // from the best point, if it lies in the box
        let best = state.best;
        let here = best.leaf == self.part.index && self.part.is_whole() && cell.domain.contains(best.s, best.t);
        let (s, t) = if here { best.next } else { leaf.linear_guess(self.x) };
        let start = cell.domain.clamp(s, t);
        let search = Search { domain: cell.domain, start, evaluations: 16, decrease: 1e-3 * state.margin() };
        let (upper, goal, formed) = (state.best.distance, state.goal, self.formed);
        let is_whole_entity = self.part.region.is_none();
        let mut closed = false;
        let found = newton::search(leaf, self.x, search, &mut state.done, &mut |found| {
            let best = if is_whole_entity { found.distance.min(upper) } else { upper };
            let (tau, reach) = (goal.tau(best), goal.reach(best));
            if leaf.rational && tau < formed - 0.5 * goal.gap {
                return false; // the form will be made again
            }
            let tau = if leaf.rational { formed } else { tau };
            let least = self.bound_from(found, cell, curvature, tau);
            closed |= least > 0.0;
            // what is proven no nearer may still hold a foot that is as near
            let beyond = (reach - tau) * (reach + tau) * leaf.heaviest * leaf.heaviest;
            closed && (found.distance <= reach || least >= beyond)
        });
        self.found = found.next;
        self.part.offer(&found, state);
        closed
    }

    /// The least that the form can be on the box, seen from an evaluated point.
    fn bound_from(&self, found: &Found, cell: Cell, curvature: Curvature, tau: f64) -> f64 {
        least_from(self.part.leaf, self.x, found, cell.domain, curvature, tau) - cell.slack
    }

    /// Newton's method from where the least coefficient has its Greville point: it may find a nearer point.
    fn newton_from_least(&mut self, cell: Cell, g: &[f64], least: f64, state: &mut State<'_>) {
        let Layout { m, n } = cell.layout;
        let at = g.iter().position(|x| *x == least).unwrap_or_default();
        let (row, column) = (at / cell.layout.stride(), at % cell.layout.stride());
        let (i, j) = match (m, n) {
            (_, 0) => (column, 0),
            (0, _) => (0, column),
            _ => (row, column),
        };
        let (extent_s, extent_t) = cell.extent();
        let share = |i: usize, degree: usize| if degree > 0 { i as f64 / degree as f64 } else { 0.0 };
        let start = (cell.domain.s.0 + extent_s * share(i, m), cell.domain.t.0 + extent_t * share(j, n));
        let decrease = 1e-2 * state.margin();
        let search = Search { domain: cell.domain, start, evaluations: 8, decrease };
        let found = newton::search(self.part.leaf, self.x, search, &mut state.done, &mut |_| false);
        self.found = found.next;
        self.part.offer(&found, state);
    }

    /// Leaves a box open: its bound counts for the answer. `G >= c` gives `D >= tau² + c / w²`.
    fn leave_open(&self, cell: Cell, least: f64, state: &mut State<'_>) {
        let leaf = self.part.leaf;
        state.done.unresolved += 1;
        let tau = if leaf.rational { self.formed } else { 0.0 };
        let below = least - cell.rounding - cell.slack;
        let weight = if below < 0.0 { leaf.lightest } else { leaf.heaviest };
        let squared = (tau * tau + below / (weight * weight)).max(leaf.box_distance_squared(state.point)).max(0.0);
        state.open = state.open.min(squared.sqrt());
    }
}

/// The corners of a box: index of the coefficient, and parameters. One for each that differs.
fn corners(cell: Cell) -> impl Iterator<Item = (usize, (f64, f64))> {
    let Domain { s, t } = cell.domain;
    let end = |(from, to): (f64, f64), last: bool| if last { to } else { from };
    cell.layout.corners().map(move |(at, last_s, last_t)| (at, (end(s, last_s), end(t, last_t))))
}

fn least_corner(cell: Cell, g: &[f64]) -> f64 {
    corners(cell).fold(f64::INFINITY, |least, (at, _)| least.min(g[at]))
}

/// Test 3. Only an edge that holds the least coefficient, up to the budget, can be below all others.
fn reduce_to_edge(level: Level, cell: &mut Cell, g: &mut [f64], least: f64, budget: f64) -> bool {
    if cell.layout.m == 0 || cell.layout.n == 0 {
        return false;
    }
    // what the reduction gives away where the others stay above by `above`
    let allowed = budget - 2.0 * cell.rounding;
    let Some((edge, above)) = net::edge_below(level, g, cell.layout, least + budget, allowed) else { return false };
    cell.layout = net::take_edge(g, cell.layout, edge);
    cell.slack += (2.0 * cell.rounding - above).max(0.0);
    let end = |(from, to): (f64, f64), last: bool| if last { (to, to) } else { (from, from) };
    match edge {
        Edge::Row { last } => cell.domain.s = end(cell.domain.s, last),
        Edge::Column { last } => cell.domain.t = end(cell.domain.t, last),
    }
    true
}

/// Test 4 at the corners, where value and gradient are coefficients: `G = g ± rounding`, `Gs = m (g_1 - g_0) ± 2 m rounding` over the box.
fn corners_close(cell: Cell, g: &[f64], curvature: Curvature, threshold: f64) -> bool {
    let Layout { m, n } = cell.layout;
    let (extent_s, extent_t) = cell.extent();
    let needed = threshold + cell.rounding + cell.slack;
    cell.layout.corners().any(|(at, last_s, last_t)| {
        let mut bound = g[at];
        let mut inward = |neighbour: usize, degree: usize, curvature: f64| {
            let (slope, error) = ((g[neighbour] - g[at]) * degree as f64, 2.0 * degree as f64 * cell.rounding);
            bound += convex::descent(slope, error, curvature, 0.0, 1.0);
        };
        let (i, j) = (if last_s { m } else { 0 }, if last_t { n } else { 0 });
        let next = |k: usize, last: bool| if last { k - 1 } else { k + 1 };
        if m > 0 {
            inward(cell.layout.at(next(i, last_s), j), m, curvature.s * extent_s * extent_s);
        }
        if n > 0 {
            inward(cell.layout.at(i, next(j, last_t)), n, curvature.t * extent_t * extent_t);
        }
        bound > needed
    })
}

/// Halves a box, whose net lies at the end of the nets; the half with the lesser coefficients is looked at first.
fn split(level: Level, cell: Cell, memory: &mut Memory) {
    let len = cell.layout.len();
    let largest = net::largest(level, &memory.nets[cell.offset..], cell.layout);
    memory.nets.resize(cell.offset + 2 * len, 0.0);
    let (low, high) = memory.nets[cell.offset..].split_at_mut(len);
    let in_s = net::bends_more_in_s(level, low, cell.layout);
    net::halve(level, low, high, cell.layout, in_s);
    let (mut first, mut second) = (cell, cell);
    let degree = if in_s {
        let middle = 0.5 * (cell.domain.s.0 + cell.domain.s.1);
        (first.domain.s.1, second.domain.s.0) = (middle, middle);
        cell.layout.m
    } else {
        let middle = 0.5 * (cell.domain.t.0 + cell.domain.t.1);
        (first.domain.t.1, second.domain.t.0) = (middle, middle);
        cell.layout.n
    };
    // halving is exact, one rounding a level; averages do not amplify
    let grown = cell.rounding + degree as f64 * ROUNDING * largest;
    (first.rounding, second.rounding) = (grown, grown);
    if net::least(level, low, cell.layout) <= net::least(level, high, cell.layout) {
        low.swap_with_slice(high);
        (first, second) = (second, first);
    }
    first.offset = cell.offset;
    second.offset = cell.offset + len;
    memory.cells.push(first);
    memory.cells.push(second);
}
