//! The certified solver: a prepared tree of Bézier pieces, and a proof for each that may hold the foot.
//!
//! # Order of work
//!
//! Preparing brings the definition into its own [`frame`], cuts it into Bézier [`piece`]s at every knot, splits those that bend too
//! much, and makes a [`leaf`] of each, with its boxes. A query descends to one leaf and takes a first point there by [`newton`]; then it
//! collects the leaves whose boxes are nearer, and proves them one by one, the nearest first ([`certify`]): each either holds no point
//! nearer than `tau`, the upper bound less the gap, or yields a nearer point, and `tau` falls. Where rounding stops the proof, the leaf's vector piece
//! is split and the proof is tried on both halves: rounding falls with the square of their radius.
//!
//! # What makes the same query give the same bits
//!
//! The walk reads nothing but the query: leaves come in the order of their box distance and index, and the first leaf is found from the
//! point alone. A hint (a point of the entity whose distance is known) only bounds which leaves are collected at first; when `tau` does not fall
//! below that bound, the rest is collected too. So the same leaves are proven in the same order, with a hint or without.

mod certify;
mod convex;
#[cfg(test)]
pub(crate) mod double_double;
mod form;
mod frame;
mod jet;
mod leaf;
mod net;
mod newton;
mod oriented_box;
mod piece;
mod state;
mod ties;

use std::sync::OnceLock;

use glam::DVec3;
use perpend_kernel::{Aabb, Definition, Direction, cartesian};
use smallvec::SmallVec;

use self::certify::{Memory, Outcome, Part, certify};
use self::form::{rounding_bound, rounding_factor};
pub(crate) use self::frame::Frame;
use self::jet::Jet;
use self::leaf::Leaf;
use self::newton::{Domain, Found, Search};
use self::piece::Piece;
use self::state::{Foot, Goal, State};
pub(crate) use self::ties::TieSet;
use crate::answer::Method;
use crate::query::{DEFAULT_GAP, Query};
use crate::scratch::Scratch;
use crate::solver::{Solution, Solved, Solver, Tie, unit_normal};
use crate::statistics::Work;
use crate::tree::{BoxTree, Candidate};

/// The unit roundoff `u`.
const ROUNDING: f64 = f64::EPSILON / 2.0;

/// How often a piece is halved at most before queries.
const PREPARED_DEPTH: u32 = 12;

/// How often a leaf is refined at most during a query.
const REFINED_DEPTH: u32 = 30;

/// How often a piece is halved at most in all.
const DEEPEST: u32 = PREPARED_DEPTH + REFINED_DEPTH;

/// How many control points the leaves may have that come of splitting bent pieces; beyond, pieces stay whole.
const MOST_POINTS: usize = 4_000_000;

/// Nearer to a leaf's border than this share of the leaf, a foot may be on it but for rounding.
const NEAR_BORDER: f64 = 1e-6;

/// How many borders a foot is followed across: it is within the gap of the nearest, so that the next leaf or the one after has it.
const CROSSINGS: u32 = 4;

/// An entity's leaves and their tree.
#[derive(Debug)]
pub(crate) struct Hierarchy {
    frame: Frame,
    leaves: Vec<Leaf>,
    tree: BoxTree,
    /// Over the leaves' boxes in the parameters; built when a proposal is first proved.
    parameters: OnceLock<BoxTree>,
    /// The definition's parameters, in u and in v.
    domain: [(f64, f64); 2],
    /// How far rounding may have moved the entity on its way into the leaves: `dg`.
    reserve: f64,
}

/// Working memory of the solver.
#[derive(Debug, Default)]
pub(crate) struct Workspace {
    memory: Memory,
    candidates: Vec<Candidate>,
}

/// What the solver found, in the entity's own coordinates.
#[derive(Debug, Clone)]
pub(crate) struct LocalSolution {
    /// Parameters of the definition.
    pub u: f64,
    pub v: f64,
    pub distance: f64,
    pub lower_bound: f64,
    /// Direction of `S_u × S_v` at the foot, seen from the leaf that holds it; zero where it vanishes, and on curves.
    pub normal: DVec3,
    /// From the query to the foot.
    pub offset: DVec3,
    pub tie: Tie,
    pub done: Work,
}

impl Solver for Hierarchy {
    fn method(&self) -> Method {
        Method::Hierarchy
    }

    fn solve(&self, query: &Query, hint: Option<DVec3>, scratch: &mut Scratch) -> Solved {
        scratch.statistics.queries += 1;
        match self.project(query, hint, &mut scratch.hierarchy) {
            None => Solved::Beyond,
            Some(solution) => {
                scratch.statistics.proof += solution.done;
                Solved::Foot(self.in_model_units(&solution))
            }
        }
    }
}

impl Hierarchy {
    /// Prepares a definition; `cusps` are parameters of a curve at which its pieces are split too.
    pub(crate) fn new(definition: &Definition, cusps: &[f64]) -> Self {
        let frame = Frame::of(definition);
        let (net, rational) = frame.net(definition);
        let reach = net.iter().fold(0.0_f64, |r, h| r.max(cartesian(*h).length()));
        let degree = match definition {
            Definition::NurbsCurve(curve) => (curve.degree(), 0),
            Definition::NurbsSurface(surface) => surface.degree(),
        };
        let mut pieces = Piece::all(definition, &net);
        for cusp in cusps {
            pieces = pieces.into_iter().flat_map(|piece| piece.cut(*cusp)).collect();
        }
        let leaves: Vec<Leaf> = split_bent(pieces).into_iter().map(|piece| Leaf::new(piece, rational)).collect();
        let boxes: Vec<Aabb> = leaves.iter().map(|leaf| leaf.bounds).collect();
        let whole = |range: fn(&Leaf) -> (f64, f64)| {
            leaves.iter().map(range).fold((f64::MAX, f64::MIN), |(low, high), (from, to)| (low.min(from), high.max(to)))
        };
        let domain = [whole(|leaf| leaf.u), whole(|leaf| leaf.v)];
        Self {
            frame,
            tree: BoxTree::new(&boxes),
            parameters: OnceLock::new(),
            leaves,
            domain,
            reserve: Frame::reserve(degree, reach),
        }
    }

    /// The nearest point of the entity; none where it is proven that nothing is within the query's `max_distance`. `hint` is any point of the entity.
    pub(crate) fn project(
        &self,
        query: &Query,
        hint: Option<DVec3>,
        workspace: &mut Workspace,
    ) -> Option<LocalSolution> {
        let mut state = self.start(query);
        let hint = hint.map_or(f64::INFINITY, |point| self.frame.enter(point).distance(state.point));
        self.finish(query, &mut state, hint, workspace)
    }

    /// The proof from a first point, and its answer.
    fn finish(&self, query: &Query, state: &mut State, hint: f64, workspace: &mut Workspace) -> Option<LocalSolution> {
        self.walk(state, hint, workspace);
        let limit = query.options.max_distance.unwrap_or(f64::INFINITY);
        let coincidence = self.coincidence(query);
        let solution = self.solution(state, coincidence);
        // none is a claim, too: it needs its proof
        let beyond = self.frame.length(solution.distance) > limit && state.tau().min(state.open) >= state.goal.wanted;
        (!beyond).then_some(solution)
    }

    /// The nearest point of the entity, from a proposal of its parameters: proved, or corrected where another point is nearer by more
    /// than the gap.
    pub(crate) fn prove(&self, query: &Query, (u, v): (f64, f64), scratch: &mut Scratch) -> (Solved, bool) {
        let index = self.leaf_at(u, v);
        let leaf = &self.leaves[index as usize];
        let (s, t) = leaf.own_parameters(u, v);
        let jet = leaf.jet(s, t);
        let proposed = jet.cartesian().p.distance(self.frame.enter(query.point) - leaf.origin);
        let found = Found { distance: proposed, s, t, jet };
        let mut state = self.state(query, index, &found, Work { evaluations: 1, ..Work::default() });
        let solution = self.finish(query, &mut state, f64::INFINITY, &mut scratch.hierarchy);
        scratch.statistics.queries += 1;
        scratch.statistics.proof += state.done;
        match solution {
            None => (Solved::Beyond, false),
            Some(solution) => {
                let corrected = proposed - solution.distance > self.asked_gap(query);
                scratch.statistics.corrected += u64::from(corrected);
                (Solved::Foot(self.in_model_units(&solution)), corrected)
            }
        }
    }

    /// A leaf that holds these parameters.
    fn leaf_at(&self, u: f64, v: f64) -> u32 {
        let tree = self.parameters.get_or_init(|| {
            let corner = |u: f64, v: f64| DVec3::new(u, v, 0.0);
            let boxes = self
                .leaves
                .iter()
                .map(|leaf| Aabb { min: corner(leaf.u.0, leaf.v.0), max: corner(leaf.u.1, leaf.v.1) });
            BoxTree::new(&boxes.collect::<Vec<_>>())
        });
        let mut found = Vec::new();
        tree.nearer_than(DVec3::new(u, v, 0.0), f64::MIN_POSITIVE, &mut found);
        let leaf = |item: u32| &self.leaves[item as usize];
        let holding = found.iter().map(|c| c.item).filter(|item| holds(leaf(*item).u, u) && holds(leaf(*item).v, v));
        holding.min().unwrap_or_default()
    }

    /// A solution in the model's unit.
    pub(crate) fn in_model_units(&self, local: &LocalSolution) -> Solution {
        let LocalSolution { u, v, normal, tie, .. } = *local;
        Solution {
            u,
            v,
            point: None,
            distance: self.frame.length(local.distance),
            lower_bound: self.frame.length(local.lower_bound),
            normal,
            offset: local.offset / self.frame.scale,
            tie,
        }
    }

    fn coincidence(&self, query: &Query) -> f64 {
        let size = self.frame.size;
        query.options.coincidence.unwrap_or(1e-6 * size) * self.frame.scale
    }

    /// The state after a first point was found: in the leaf that a descent of the tree arrives at, from its linear guess.
    fn start(&self, query: &Query) -> State {
        let point = self.frame.enter(query.point);
        let mut done = Work::default();
        let (index, looked) = self.tree.descend(point).expect("an entity has leaves");
        done.boxes += looked;
        let leaf = &self.leaves[index as usize];
        let asked = self.asked_gap(query);
        let near = leaf.box_distance_squared(point).sqrt();
        let x = point - leaf.origin;
        let (s, t) = leaf.linear_guess(x);
        let search = Search {
            domain: Domain::WHOLE,
            start: Domain::WHOLE.clamp(s, t),
            known: None,
            iterations: 8,
            decrease: 2e-4 * asked * asked.max(near),
        };
        let found = newton::search(leaf, x, search, &mut done, |_| false);
        self.state(query, index, &found, done)
    }

    /// The state of a query of which one point of one leaf is known.
    fn state(&self, query: &Query, index: u32, found: &Found, done: Work) -> State {
        let point = self.frame.enter(query.point);
        let leaf = &self.leaves[index as usize];
        let best = Part { leaf, index, within: Domain::WHOLE }.foot(found);
        // Whether anything is within a maximum distance is told as finely as by default, however wide the gap.
        let finest =
            query.options.max_distance.map_or(f64::INFINITY, |_| DEFAULT_GAP * self.frame.size * self.frame.scale);
        let asked = self.asked_gap(query).min(finest);
        // The proof is sought closer than asked by what rounding may take away again. Where that leaves less than half, or
        // the asked gap is finer than the forms can tell at this distance, the finest gap that they can tell is sought.
        // A fiftieth is kept for the foot's parameters, which are rounded after the proof.
        let left = 0.98 * asked - 2.0 * self.reserve - 20.0 * ROUNDING * point.length();
        let reachable = 40.0 * rounding_factor(leaf.degree) * ROUNDING * best.distance + 2.0 * self.reserve;
        let wanted = query.options.max_distance.map_or(f64::INFINITY, |d| d * self.frame.scale);
        State {
            point,
            goal: Goal {
                gap: if left < 0.5 * asked { left.max(reachable) } else { left },
                wanted,
                limit: wanted + asked,
            },
            best,
            best_jet: Some(found.jet),
            met: smallvec::smallvec![best],
            open: f64::INFINITY,
            work: query.options.work,
            done,
        }
    }

    fn asked_gap(&self, query: &Query) -> f64 {
        query.options.gap.unwrap_or(DEFAULT_GAP * self.frame.size) * self.frame.scale
    }

    /// Proves every leaf that could hold a point nearer than `tau`, the nearest box first; then looks for feet in those that can
    /// hold none nearer than that, but others as near within the gap.
    fn walk(&self, state: &mut State, hint: f64, workspace: &mut Workspace) {
        let Workspace { memory, candidates } = workspace;
        // a hint of a point at distance h: the best will be at most h + gap away, and others as near within the gap count
        let (mut from, mut to) = (0.0, squared(state.reach().min(hint + 2.0 * state.goal.gap)));
        while state.tau() > 0.0 {
            candidates.clear();
            state.done.boxes += self.tree.nearer_than(state.point, to, candidates);
            for candidate in candidates.iter_mut() {
                let leaf = &self.leaves[candidate.item as usize];
                candidate.distance_squared = leaf.box_distance_squared(state.point);
            }
            candidates.retain(|c| c.distance_squared >= from && c.distance_squared < to);
            candidates
                .sort_unstable_by(|a, b| a.distance_squared.total_cmp(&b.distance_squared).then(a.item.cmp(&b.item)));
            for candidate in candidates.iter() {
                let leaf = &self.leaves[candidate.item as usize];
                let part = Part { leaf, index: candidate.item, within: Domain::WHOLE };
                if candidate.distance_squared < squared(state.tau()) {
                    close(part, state, memory, 0);
                } else if candidate.distance_squared < squared(state.reach()) {
                    part.look_for_tie(state);
                } else {
                    return;
                }
            }
            // the leaves beyond the bound that the hint gave, if they are needed after all
            (from, to) = (to, squared(state.reach()));
            if to <= from {
                return;
            }
        }
    }

    /// Polishes the feet that were met and reads the answer off the least (distance, u, v).
    fn solution(&self, state: &mut State, coincidence: f64) -> LocalSolution {
        let lower = state.tau().min(state.open) - self.reserve - 10.0 * ROUNDING * state.point.length();
        let (best, jet) = (state.best, state.best_jet);
        let mut winner = self.polish(&best, jet, state);
        self.cross_borders(&mut winner, state);
        let mut others = self.others(&winner.0, coincidence, state);
        for other in &mut others {
            if self.rank(&other.0) < self.rank(&winner.0) {
                std::mem::swap(other, &mut winner);
            }
        }
        let tie = self.tie(&winner, &others, coincidence, state);
        LocalSolution { tie, ..self.solution_at(&winner.0, lower.max(0.0), state) }
    }

    /// The order of feet: the nearest first, then the one with the lower parameters.
    fn rank(&self, foot: &Foot) -> (f64, f64, f64) {
        let (u, v) = self.leaves[foot.leaf as usize].parameters(foot.s, foot.t);
        (foot.distance, u, v)
    }

    /// The feet that were met elsewhere and are as near as the best one within the gap, polished.
    fn others(&self, best: &Foot, coincidence: f64, state: &mut State) -> SmallVec<[(Foot, Jet); 2]> {
        let near = best.distance + state.goal.gap;
        // two feet of one leaf that are this close in its parameters are one on its way to convergence
        let close = |foot: &Foot| foot.leaf == best.leaf && (foot.s - best.s).abs().max((foot.t - best.t).abs()) < 1e-2;
        let apart = |foot: &Foot| foot.distance <= near && foot.point.distance(best.point) > coincidence;
        let mut met = std::mem::take(&mut state.met);
        met.retain(|foot| apart(foot) && !close(foot));
        met.iter().map(|foot| self.polish(foot, None, state)).filter(|(foot, _)| apart(foot)).collect()
    }

    /// A foot at the definition's parameters as they are reported.
    fn solution_at(&self, foot: &Foot, lower_bound: f64, state: &State) -> LocalSolution {
        let leaf = &self.leaves[foot.leaf as usize];
        let (s, t) = self.snap(foot, state);
        let (u, v) = leaf.parameters(s, t);
        let (s, t) = leaf.own_parameters(u, v);
        let c = leaf.jet(s, t).cartesian();
        let offset = c.p - (state.point - leaf.origin);
        let distance = offset.length();
        LocalSolution {
            u,
            v,
            distance,
            lower_bound: lower_bound.min(distance),
            normal: unit_normal(c.ps, c.pt),
            offset,
            tie: Tie::None,
            done: state.done,
        }
    }

    /// A foot's parameters, on the border of its leaf where it lies beside it by no more than rounding: there are the edges,
    /// seams, poles and creases that `place` tells by the parameter.
    ///
    /// Rounding moves a foot by more where the entity bends almost about the query: by the inverse of what its curvature leaves of the
    /// Hessian.
    fn snap(&self, foot: &Foot, state: &State) -> (f64, f64) {
        let leaf = &self.leaves[foot.leaf as usize];
        let border = |x: f64| match x {
            x if x < NEAR_BORDER => 0.0,
            x if x > 1.0 - NEAR_BORDER => 1.0,
            x => x,
        };
        let mut at = (foot.s, foot.t);
        let corner = (border(at.0), border(at.1));
        if corner == at {
            return at;
        }
        let c = leaf.jet(at.0, at.1).cartesian();
        let r = c.p - (state.point - leaf.origin);
        let left = |first: DVec3, second: DVec3| {
            let square = first.length_squared();
            if square > 0.0 { ((square + r.dot(second)) / square).clamp(1e-6, 1.0) } else { 1.0 }
        };
        let rounding = 16.0 * ROUNDING * (1.0 + foot.distance) / left(c.ps, c.pss).min(left(c.pt, c.ptt));
        for snapped in [(corner.0, at.1), (at.0, corner.1), corner] {
            if snapped != at && leaf.jet(snapped.0, snapped.1).cartesian().p.distance(c.p) <= rounding {
                at = snapped;
            }
        }
        at
    }

    /// A foot as exactly as its coordinates allow, in its prepared leaf.
    fn polish(&self, foot: &Foot, known: Option<Jet>, state: &mut State) -> (Foot, Jet) {
        let leaf = &self.leaves[foot.leaf as usize];
        let x = state.point - leaf.origin;
        let found = newton::polish(leaf, x, (foot.s, foot.t), known, &mut state.done);
        (Part { leaf, index: foot.leaf, within: Domain::WHOLE }.foot(&found), found.jet)
    }

    /// Follows a foot out of its leaf: where it lies on a border with another leaf, the distance may go on falling there. The proof
    /// does not ask for that, as it is less than the gap; the foot's place does.
    fn cross_borders(&self, foot: &mut (Foot, Jet), state: &mut State) {
        let mut neighbours = Vec::new();
        for _ in 0..CROSSINGS {
            let here = foot.0;
            let leaf = &self.leaves[here.leaf as usize];
            let inner = |x: f64, (from, to): (f64, f64), (first, last): (f64, f64)| {
                (x == 0.0 && from > first) || (x == 1.0 && to < last)
            };
            let surface = leaf.degree.1 > 0;
            let crosses = inner(here.s, leaf.u, self.domain[0]) || (surface && inner(here.t, leaf.v, self.domain[1]));
            if !crosses {
                return;
            }
            let (u, v) = leaf.parameters(here.s, here.t);
            neighbours.clear();
            state.done.boxes += self.tree.nearer_than(here.point, squared(1e-9), &mut neighbours);
            for neighbour in &neighbours {
                let other = &self.leaves[neighbour.item as usize];
                if neighbour.item != here.leaf && holds(other.u, u) && holds(other.v, v) {
                    let (s, t) = other.own_parameters(u, v);
                    let there = self.polish(&Foot { leaf: neighbour.item, s, t, ..here }, None, state);
                    if there.0.distance < foot.0.distance {
                        *foot = there;
                    }
                }
            }
            if foot.0.leaf == here.leaf {
                return;
            }
        }
    }

    /// The distance from the query to the entity at parameters of the definition.
    fn distance_at(&self, p: DVec3, u: f64, v: f64) -> f64 {
        let leaf = self.leaves.iter().find(|leaf| holds(leaf.u, u) && holds(leaf.v, v)).unwrap_or(&self.leaves[0]);
        let (s, t) = leaf.own_parameters(u, v);
        leaf.jet(s, t).cartesian().p.distance(p - leaf.origin)
    }

    /// What the other feet are to the best one.
    ///
    /// The straight way between the parameters of two feet tells: where it leads farther away than both, they are apart; where the
    /// best one is flat and the whole way is as near to rounding, they belong to a continuum. Else the other is on its way to the
    /// best one, or was kept from it by the border of its leaf.
    fn tie(&self, (best, jet): &(Foot, Jet), others: &[(Foot, Jet)], coincidence: f64, state: &State) -> Tie {
        let flat = self.is_flat(best, jet, state);
        let sides = flat.then(|| self.sides(best, state)).into_iter().flatten();
        let mut tie = Tie::None;
        let noise = 64.0 * ROUNDING * (best.distance + 1.0);
        for foot in others.iter().map(|(foot, _)| *foot).chain(sides) {
            if foot.distance > best.distance + state.goal.gap || foot.point.distance(best.point) <= coincidence {
                continue;
            }
            let [a, b] = [best, &foot].map(|foot| self.leaves[foot.leaf as usize].parameters(foot.s, foot.t));
            let between = [0.25, 0.5, 0.75]
                .map(|share| self.distance_at(state.point, a.0 + share * (b.0 - a.0), a.1 + share * (b.1 - a.1)));
            if between.iter().any(|d| *d > foot.distance.max(best.distance) + noise) {
                tie = Tie::Apart;
            } else if flat && between.iter().all(|d| (d - best.distance).abs() <= noise) {
                return Tie::Connected;
            }
        }
        tie
    }

    /// Whether the distance is flat to second order at a foot: then others may be as near beside it.
    ///
    /// A direction in which the foot is held at a border, the distance falling beyond, is not flat.
    fn is_flat(&self, foot: &Foot, jet: &Jet, state: &State) -> bool {
        let leaf = &self.leaves[foot.leaf as usize];
        let c = jet.cartesian();
        let r = c.p - (state.point - leaf.origin);
        let (a, b) = (c.ps.length_squared(), c.pt.length_squared());
        let held = |derivative: DVec3, square: f64| r.dot(derivative).abs() > 1e-9 * square.sqrt() * foot.distance;
        let (hss, hst, htt) = (a + r.dot(c.pss), c.ps.dot(c.pt) + r.dot(c.pst), b + r.dot(c.ptt));
        match (held(c.ps, a), leaf.degree.1 == 0 || held(c.pt, b)) {
            (true, true) => false,
            (true, false) => htt <= 1e-9 * b,
            (false, true) => hss <= 1e-9 * a,
            (false, false) => hss * htt - hst * hst <= 1e-9 * a * b,
        }
    }

    /// Points to compare a flat foot with: on the sides of its leaf, straight across.
    fn sides(&self, foot: &Foot, state: &State) -> impl Iterator<Item = Foot> {
        let leaf = &self.leaves[foot.leaf as usize];
        let whole = Part { leaf, index: foot.leaf, within: Domain::WHOLE };
        let (x, count) = (state.point - leaf.origin, if leaf.degree.1 == 0 { 2 } else { 4 });
        let sides = [(0.0, foot.t), (1.0, foot.t), (foot.s, 0.0), (foot.s, 1.0)];
        sides.into_iter().take(count).map(move |(s, t)| {
            let jet = leaf.jet(s, t);
            whole.foot(&Found { distance: jet.cartesian().p.distance(x), s, t, jet })
        })
    }
}

/// Proves a part, refining its vector piece where the form alone does not do it.
fn close(part: Part<'_>, state: &mut State, memory: &mut Memory, depth: u32) {
    // where even a leaf without extent would drown in rounding, refining is in vain
    let floor = rounding_bound(part.leaf.degree, state.best.distance, 0.0, state.tau(), 1.0);
    let last = depth >= REFINED_DEPTH || floor > state.margin();
    let share = match (last, depth) {
        (true, _) => 4_000,
        (false, 0) => 200,
        (false, _) => 60,
    };
    if certify(part, state, memory, share, last) == Outcome::Closed {
        return;
    }
    state.done.refinements += 1;
    state.work = state.work.saturating_sub(1);
    let (direction, halves) = part.leaf.refine();
    let within = part.within.halves(direction);
    let mut parts = [0, 1].map(|k| {
        let part = Part { leaf: &halves[k], index: part.index, within: within[k] };
        (part.leaf.box_distance_squared(state.point), part)
    });
    if parts[1].0 < parts[0].0 {
        parts.swap(0, 1);
    }
    for (distance_squared, part) in parts {
        if distance_squared < squared(state.tau()) {
            close(part, state, memory, depth + 1);
        }
    }
}

/// Splits the pieces that depart too far from an affine map.
fn split_bent(pieces: Vec<Piece>) -> Vec<Piece> {
    let mut whole = Vec::with_capacity(pieces.len());
    let mut waiting: Vec<(Piece, u32)> = pieces.into_iter().rev().map(|piece| (piece, 0)).collect();
    while let Some((piece, depth)) = waiting.pop() {
        let room = depth < PREPARED_DEPTH && (whole.len() + waiting.len()) * piece.net.len() < MOST_POINTS;
        match piece.wants_split().filter(|_| room) {
            None => whole.push(piece),
            Some(direction) => {
                let [low, high] = piece.halves(direction);
                waiting.extend([(high, depth + 1), (low, depth + 1)]);
            }
        }
    }
    whole
}

fn holds((from, to): (f64, f64), x: f64) -> bool {
    from <= x && x <= to
}

fn squared(x: f64) -> f64 {
    x * x
}

impl Domain {
    /// Both halves in a direction.
    fn halves(&self, direction: Direction) -> [Self; 2] {
        let (mut low, mut high) = (*self, *self);
        match direction {
            Direction::U => {
                low.s.1 = piece::middle(self.s);
                high.s.0 = low.s.1;
            }
            Direction::V => {
                low.t.1 = piece::middle(self.t);
                high.t.0 = low.t.1;
            }
        }
        [low, high]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::query::QueryOptions;
    use double_double::Random;
    use perpend_kernel::{NurbsCurve, NurbsSurface};

    fn knots(degree: usize, points: usize, random: &mut Random) -> Vec<f64> {
        let mut inner: Vec<f64> = (0..points - degree - 1).map(|_| random.between(0.05, 0.95)).collect();
        inner.sort_by(f64::total_cmp);
        let mut knots = vec![0.0; degree + 1];
        knots.extend(inner);
        knots.extend(std::iter::repeat_n(1.0, degree + 1));
        knots
    }

    fn entities(random: &mut Random) -> Vec<Definition> {
        let mut entities = Vec::new();
        for degree in [1, 2, 3, 5, 9] {
            for rational in [false, true] {
                let n = degree + 4;
                let points = (0..n).map(|_| random.point()).collect();
                let weights = rational.then(|| (0..n).map(|_| 10.0_f64.powf(random.between(-1.0, 1.0))).collect());
                let knots = knots(degree, n, random);
                entities.push(NurbsCurve::new(degree, knots, points, weights).expect("valid").into());
            }
        }
        for (p, q) in [(1, 1), (2, 3), (3, 3), (5, 2)] {
            for rational in [false, true] {
                let (n, m) = (p + 3, q + 2);
                let at = |i: usize, j: usize, random: &mut Random| {
                    DVec3::new(i as f64, j as f64, 0.0) + 0.7 * random.point()
                };
                let points = (0..n).map(|i| (0..m).map(|j| at(i, j, random)).collect()).collect();
                let weight = |random: &mut Random| 10.0_f64.powf(random.between(-1.0, 1.0));
                let weights = rational.then(|| (0..n).map(|_| (0..m).map(|_| weight(random)).collect()).collect());
                let knots = (knots(p, n, random), knots(q, m, random));
                entities.push(NurbsSurface::new((p, q), knots, points, weights).expect("valid").into());
            }
        }
        entities
    }

    /// The proof must not depend on a good start: any point of any leaf, without Newton's method, leads to the same distance.
    #[test]
    fn a_spoilt_start_costs_work_and_changes_no_distance() {
        let mut random = Random(7);
        let mut workspace = Workspace::default();
        for definition in entities(&mut random) {
            let hierarchy = Hierarchy::new(&definition, &[]);
            let size = hierarchy.frame.size;
            for k in 0..60 {
                let p = definition.control_points()[k % definition.control_points().len()]
                    + [0.01, 0.3, 3.0][k % 3] * size * random.point();
                let query = Query::new(p, QueryOptions::default()).expect("finite");
                let good = hierarchy.project(&query, None, &mut workspace).expect("no limit");
                let index = (random.next() % hierarchy.leaves.len() as u64) as u32;
                let leaf = &hierarchy.leaves[index as usize];
                let jet = leaf.jet(0.3, 0.6);
                let x = hierarchy.frame.enter(p) - leaf.origin;
                let found = Found { distance: jet.cartesian().p.distance(x), s: 0.3, t: 0.6, jet };
                let mut state = hierarchy.state(&query, index, &found, Work::default());
                hierarchy.walk(&mut state, f64::INFINITY, &mut workspace);
                let spoilt = hierarchy.solution(&mut state, 0.0);
                let gap = hierarchy.asked_gap(&query) + 64.0 * ROUNDING * hierarchy.frame.enter(p).length();
                assert_eq!(state.done.unresolved, 0);
                assert!(spoilt.distance - spoilt.lower_bound <= gap, "{spoilt:?}");
                assert!(spoilt.lower_bound <= good.distance && good.lower_bound <= spoilt.distance);
            }
        }
    }

    #[test]
    fn any_proposal_is_proved_or_corrected() {
        let mut random = Random(13);
        let mut scratch = Scratch::default();
        for definition in entities(&mut random) {
            let hierarchy = Hierarchy::new(&definition, &[]);
            for k in 0..40 {
                let p =
                    definition.control_points()[0] + [0.01, 0.4, 4.0][k % 3] * hierarchy.frame.size * random.point();
                let query = Query::new(p, QueryOptions::default()).expect("finite");
                let plain = hierarchy.project(&query, None, &mut Workspace::default()).expect("no limit");
                let [u, v] = hierarchy.domain.map(|(from, to)| random.between(from, to));
                let gap = hierarchy.asked_gap(&query) + 64.0 * ROUNDING * hierarchy.frame.enter(p).length();
                let point = match &definition {
                    Definition::NurbsCurve(curve) => curve.point(u),
                    Definition::NurbsSurface(surface) => surface.point(u, v),
                };
                let is_wrong = point.distance(p) * hierarchy.frame.scale > plain.distance + 2.0 * gap;
                for (proposal, wrong) in [((plain.u, plain.v), false), ((u, v), is_wrong)] {
                    let (Solved::Foot(solution), corrected) = hierarchy.prove(&query, proposal, &mut scratch) else {
                        panic!("no limit");
                    };
                    let [upper, lower] = [solution.distance, solution.lower_bound].map(|d| d * hierarchy.frame.scale);
                    assert!(upper - lower <= gap && lower <= plain.distance && plain.lower_bound <= upper);
                    assert_eq!(corrected, wrong, "{p} at {u}, {v}");
                }
            }
        }
    }

    #[test]
    fn a_hint_changes_no_bit() {
        let mut random = Random(11);
        let mut workspace = Workspace::default();
        for definition in entities(&mut random) {
            let hierarchy = Hierarchy::new(&definition, &[]);
            let corner = definition.control_points()[0];
            for _ in 0..40 {
                let p = corner + 0.5 * hierarchy.frame.size * random.point();
                let query = Query::new(p, QueryOptions::default()).expect("finite");
                let plain = hierarchy.project(&query, None, &mut workspace).expect("no limit");
                let foot = {
                    let (u, v) = (plain.u, plain.v);
                    match &definition {
                        Definition::NurbsCurve(curve) => curve.point(u),
                        Definition::NurbsSurface(surface) => surface.point(u, v),
                    }
                };
                for hint in [corner, foot] {
                    let hinted = hierarchy.project(&query, Some(hint), &mut workspace).expect("no limit");
                    let bits = |s: &LocalSolution| [s.u, s.v, s.distance, s.lower_bound].map(f64::to_bits);
                    assert_eq!(bits(&plain), bits(&hinted));
                }
            }
        }
    }

    /// A piece that is closed without an evaluation, or that no proof needs, may still hold a foot as near.
    #[test]
    fn a_tie_with_another_piece_is_met() {
        let at = |x: f64, y: f64| DVec3::new(x, y, 11.0);
        let legs = |points: Vec<DVec3>| {
            let n = points.len();
            let knots = [vec![0.0], (0..n).map(|i| i as f64).collect(), vec![(n - 1) as f64]].concat();
            Hierarchy::new(&NurbsCurve::new(1, knots, points, None).expect("valid").into(), &[])
        };
        let bent = legs(vec![at(0.0, 0.0), at(0.0, 2.0), at(2.0, 4.0)]);
        let rails = legs(vec![at(0.0, 0.0), at(4.0, 0.0), at(4.0, 2.0), at(0.0, 2.0)]);
        let ask = |hierarchy: &Hierarchy, p: DVec3| {
            let query = Query::new(p, QueryOptions::default()).expect("finite");
            hierarchy.project(&query, None, &mut Workspace::default()).expect("no limit")
        };
        assert_eq!(ask(&bent, at(1.0, 1.585_786_437_626_905)).tie, Tie::Apart);
        let solution = ask(&rails, at(1.0, 1.0));
        assert_eq!(solution.tie, Tie::Apart);
        assert!(solution.u < 1.0, "of feet at the same distance the one with the lower parameter: {solution:?}");
    }
}
