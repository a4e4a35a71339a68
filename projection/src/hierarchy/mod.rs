//! The certified solver: a prepared tree of Bézier pieces, and a proof for each that may hold the foot.
//!
//! # Order of work
//!
//! Preparing brings the definition into its own [`frame`], cuts it into Bézier [`piece`]s at every knot, splits those that bend too
//! much, and makes a [`leaf`] of each, with its boxes. A query [`walk`]s: it descends a tree of these boxes to one leaf, whose first look gives an upper
//! bound; then it collects the leaves whose boxes are nearer, and proves them one by one, the nearest first: each either holds no point
//! nearer than `tau`, the upper bound less the gap, or yields a nearer point, and `tau` falls. A [`glance`] at the [`ranges`] of the squared distance
//! proves most; the [`form`] the others ([`certify`]). Ranges and the form's tables are made by the first query that needs them. Where rounding stops
//! the proof, the leaf's vector piece is split and the proof is tried on both halves: rounding falls with the square of their radius. The [`reply`] is
//! read off the best foot.
//!
//! # What makes the same query give the same bits
//!
//! The walk reads nothing but the query: leaves come in the order of their box distance and index, and the first leaf is found from the
//! point alone. A hint (a point of the entity whose distance is known) only bounds which leaves are collected at first; when `tau` does not fall
//! below that bound, the rest is collected too. So the same leaves are proven in the same order, with a hint or without.
//!
//! The SIMD level of the processor changes no bit either: vectors have four lanes at every level, lanes are added in one order, and no product is fused
//! with a sum.

mod bound;
mod certify;
mod convex;
mod crossed;
#[cfg(test)]
pub(crate) mod double_double;
mod form;
mod frame;
mod glance;
mod jet;
mod leaf;
mod net;
mod newton;
mod oriented_box;
mod patches;
mod piece;
mod quotient;
mod ranges;
mod reply;
mod state;
mod ties;
mod valley;
mod walk;

use std::sync::OnceLock;

use fearless_simd::Level;
use glam::{DVec3, DVec4};
use perpend_kernel::{Aabb, Definition, Direction, cartesian};

use self::certify::{Memory, Part};
use self::crossed::Trim;
pub(crate) use self::crossed::{BoundaryPoint, TrimmedFoot};
pub(crate) use self::frame::Frame;
use self::leaf::Leaf;
use self::newton::Domain;
pub(crate) use self::patches::{Patch, Patches};
use self::piece::Piece;
use self::state::Foot;
pub(crate) use self::ties::TieSet;
use crate::answer::Method;
use crate::query::{DEFAULT_GAP, Query};
use crate::scratch::Scratch;
use crate::solver::{Solution, Solved, Solver, Tie};
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
    /// Of a trimmed surface: what the trim does to the leaves.
    trim: Option<Trim>,
}

/// Working memory of the solver.
#[derive(Debug, Default)]
pub(crate) struct Workspace {
    memory: Memory,
    candidates: Vec<Candidate>,
    lists: Lists,
}

/// Lists that a query's state keeps.
#[derive(Debug, Default)]
struct Lists {
    met: Vec<Foot>,
    neighbours: Vec<Candidate>,
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
        Self::with_level(definition, cusps, Level::new())
    }

    /// The same for a processor that can do what `level` says: that changes times, and no bit.
    fn with_level(definition: &Definition, cusps: &[f64], level: Level) -> Self {
        let frame = Frame::of(definition);
        let (net, rational) = frame.net(definition);
        let reach = net.iter().fold(0.0_f64, |r, h| r.max(cartesian(*h).length()));
        let degree = match definition {
            Definition::NurbsCurve(curve) => (curve.degree(), 0),
            Definition::NurbsSurface(surface) => surface.degree(),
        };
        let mut pieces = Piece::all(definition, &net, rational);
        for cusp in cusps {
            pieces = pieces.into_iter().flat_map(|piece| piece.cut(Direction::U, *cusp)).collect();
        }
        let mut points = Vec::new();
        let pieces = split_bent(pieces, &mut points);
        Self::of_pieces(frame, pieces, Frame::reserve(degree, reach), level, &mut points)
    }

    /// Bézier curves with homogeneous control points in a frame's coordinates, each with the parameter at which it starts; it covers 1. `reserve` says how far
    /// rounding has moved them already, in these coordinates.
    pub(crate) fn of_curves(frame: Frame, nets: Vec<(f64, Vec<DVec4>)>, reserve: f64) -> Self {
        let degree = nets.iter().map(|(_, net)| net.len() - 1).max().unwrap_or(1);
        let points = nets.iter().flat_map(|(_, net)| net).map(|h| cartesian(*h).length());
        let reserve = reserve + Frame::reserve((degree, 0), points.fold(0.0, f64::max));
        let pieces = nets.into_iter().map(|(from, net)| Piece::curve(net, (from, from + 1.0))).collect();
        let mut points = Vec::new();
        let pieces = split_bent(pieces, &mut points);
        Self::of_pieces(frame, pieces, reserve, Level::new(), &mut points)
    }

    /// `points` is working memory.
    fn of_pieces(frame: Frame, pieces: Vec<Piece>, reserve: f64, level: Level, points: &mut Vec<DVec3>) -> Self {
        let leaves: Vec<Leaf> = pieces.into_iter().map(|piece| Leaf::new(piece, level, points)).collect();
        let boxes: Vec<Aabb> = leaves.iter().map(|leaf| leaf.bounds).collect();
        let whole = |range: fn(&Leaf) -> (f64, f64)| {
            leaves.iter().map(range).fold((f64::MAX, f64::MIN), |(low, high), (from, to)| (low.min(from), high.max(to)))
        };
        let domain = [whole(|leaf| leaf.u), whole(|leaf| leaf.v)];
        Self {
            frame,
            tree: BoxTree::with_level(&boxes, level),
            parameters: OnceLock::new(),
            leaves,
            domain,
            reserve,
            trim: None,
        }
    }

    /// The nearest point of the entity; none where it is proven that nothing is within the query's `max_distance`. `hint` is any point of the entity.
    pub(crate) fn project(
        &self,
        query: &Query,
        hint: Option<DVec3>,
        workspace: &mut Workspace,
    ) -> Option<LocalSolution> {
        let Workspace { memory, candidates, lists } = workspace;
        let point = self.frame.enter(query.point);
        let hint = hint.map_or(f64::INFINITY, |hint| self.frame.enter(hint).distance(point));
        let (first, boxes) = self.tree.descend(point).expect("an entity has leaves");
        let mut state = self.state(query, self.part(first).middle(point), lists);
        state.done.boxes += boxes;
        if self.is_beyond(query, &mut state, candidates) {
            return None;
        }
        let visited = self.visit_first(query, first, &mut state);
        self.walk(Some(visited), &mut state, hint, memory, candidates);
        if state.is_clearly_beyond() {
            return None;
        }
        self.within(query, self.solution(&mut state, self.coincidence(query)), &state)
    }

    /// Whether the boxes of the leaves tell that nothing is within the query's `max_distance`, with its gap for rounding.
    fn is_beyond(&self, query: &Query, state: &mut state::State<'_>, candidates: &mut Vec<Candidate>) -> bool {
        if query.options.max_distance.is_none() {
            return false;
        }
        candidates.clear();
        state.done.boxes += self.tree.nearer_than(state.point, squared(state.goal.limit), candidates);
        candidates.is_empty()
    }

    /// The nearest point of the entity, from a proposal of its parameters: proved, or corrected where another point is nearer by more
    /// than the gap.
    pub(crate) fn prove(&self, query: &Query, (u, v): (f64, f64), scratch: &mut Scratch) -> (Solved, bool) {
        let Workspace { memory, candidates, lists } = &mut scratch.hierarchy;
        let part = self.part(self.leaf_at(u, v, candidates));
        let x = self.frame.enter(query.point) - part.leaf.origin;
        let proposal = part.foot(&newton::point(part.leaf, x, part.leaf.own_parameters(u, v)));
        let proposed = proposal.distance;
        let mut state = self.state(query, proposal, lists);
        state.done.evaluations += 1;
        self.walk(None, &mut state, f64::INFINITY, memory, candidates);
        let solution = self.within(query, self.solution(&mut state, self.coincidence(query)), &state);
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

    /// A leaf that holds these parameters; `found` is working memory.
    fn leaf_at(&self, u: f64, v: f64, found: &mut Vec<Candidate>) -> u32 {
        let tree = self.parameters.get_or_init(|| {
            let corner = |u: f64, v: f64| DVec3::new(u, v, 0.0);
            let boxes = self
                .leaves
                .iter()
                .map(|leaf| Aabb { min: corner(leaf.u.0, leaf.v.0), max: corner(leaf.u.1, leaf.v.1) });
            BoxTree::new(&boxes.collect::<Vec<_>>())
        });
        found.clear();
        tree.nearer_than(DVec3::new(u, v, 0.0), f64::MIN_POSITIVE, found);
        let leaf = |item: u32| &self.leaves[item as usize];
        let holding = found.iter().map(|c| c.item).filter(|item| holds(leaf(*item).u, u) && holds(leaf(*item).v, v));
        holding.min().unwrap_or_default()
    }

    /// All of a leaf.
    fn part(&self, index: u32) -> Part<'_> {
        let region = self.trim.as_ref().and_then(|trim| trim.crossing(index));
        Part { leaf: &self.leaves[index as usize], index, within: Domain::WHOLE, region }
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

    fn asked_gap(&self, query: &Query) -> f64 {
        query.options.gap.unwrap_or(DEFAULT_GAP * self.frame.size) * self.frame.scale
    }
}

/// Splits the pieces that depart too far from an affine map; `points` is working memory.
fn split_bent(pieces: Vec<Piece>, points: &mut Vec<DVec3>) -> Vec<Piece> {
    let mut whole = Vec::with_capacity(pieces.len());
    let mut waiting: Vec<(Piece, u32)> = pieces.into_iter().rev().map(|piece| (piece, 0)).collect();
    while let Some((piece, depth)) = waiting.pop() {
        let room = depth < PREPARED_DEPTH && (whole.len() + waiting.len()) * piece.net.len() < MOST_POINTS;
        match piece.wants_split(points).filter(|_| room) {
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
                let x = hierarchy.frame.enter(p) - leaf.origin;
                let start = hierarchy.part(index).foot(&newton::point(leaf, x, (0.3, 0.6)));
                let spoilt = Foot { next: (start.s, start.t), ..start };
                let Workspace { memory, candidates, lists } = &mut workspace;
                let mut state = hierarchy.state(&query, spoilt, lists);
                hierarchy.walk(None, &mut state, f64::INFINITY, memory, candidates);
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

    /// A full circle of radius 1 about the z axis, by quadratic arcs: points and weights.
    fn circle(z: f64) -> (Vec<DVec3>, Vec<f64>) {
        let corners = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)];
        let points = corners.map(|(x, y)| DVec3::new(f64::from(x), f64::from(y), z));
        let weights = [1.0, 0.0].repeat(5)[..9].iter().map(|w| if *w > 0.0 { 1.0 } else { 0.5_f64.sqrt() }).collect();
        (points.to_vec(), weights)
    }

    /// What a processor can do changes times, and no bit: feet near and far, on the entity, and where a whole circle is as near.
    #[test]
    fn the_level_of_the_processor_changes_no_bit() {
        const DEGREES: [usize; 7] = [1, 2, 3, 4, 5, 7, 9];
        let mut random = Random(17);
        let mut definitions = Vec::new();
        let arcs = [0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 4.0, 4.0, 4.0].to_vec();
        let (low, weights) = circle(-1.0);
        let rows = low.iter().map(|p| vec![*p, *p + 2.0 * DVec3::Z]).collect();
        let row_weights = weights.iter().map(|w| vec![*w; 2]).collect();
        let knots_v = vec![0.0, 0.0, 1.0, 1.0];
        let cylinder = NurbsSurface::new((2, 1), (arcs.clone(), knots_v), rows, Some(row_weights)).expect("valid");
        definitions.push(Definition::from(cylinder));
        definitions.push(NurbsCurve::new(2, arcs, circle(0.0).0, Some(weights)).expect("valid").into());
        for rational in [false, true] {
            let weight = |random: &mut Random| 10.0_f64.powf(random.between(-0.7, 0.7));
            for p in DEGREES {
                let n = p + 3;
                let points = (0..n).map(|_| random.point()).collect();
                let weights = rational.then(|| (0..n).map(|_| weight(&mut random)).collect());
                let knots_u = knots(p, n, &mut random);
                definitions.push(NurbsCurve::new(p, knots_u, points, weights).expect("valid").into());
                for q in DEGREES {
                    let (n, m) = (p + 2, q + 2);
                    let bend = 0.6 * random.between(0.0, 1.0);
                    let mut at = |i: usize, j: usize| {
                        DVec3::new(i as f64 / n as f64, j as f64 / m as f64, 0.0) + bend * random.point()
                    };
                    let points = (0..n).map(|i| (0..m).map(|j| at(i, j)).collect()).collect();
                    let weights =
                        rational.then(|| (0..n).map(|_| (0..m).map(|_| weight(&mut random)).collect()).collect());
                    let knots = (knots(p, n, &mut random), knots(q, m, &mut random));
                    definitions.push(NurbsSurface::new((p, q), knots, points, weights).expect("valid").into());
                }
            }
        }
        let numbers = |s: &LocalSolution| {
            let [n, o] = [s.normal, s.offset];
            [s.u, s.v, s.distance, s.lower_bound, n.x, n.y, n.z, o.x, o.y, o.z].map(f64::to_bits)
        };
        let mut connected = 0;
        for definition in definitions {
            let hierarchies = [Level::baseline(), Level::new()].map(|l| Hierarchy::with_level(&definition, &[], l));
            let Frame { origin, size, .. } = hierarchies[0].frame;
            let mut queries = vec![origin, origin + 0.25 * DVec3::Z, definition.control_points()[0]];
            for away in [0.0, 1e-9, 1e-3, 0.1, 0.5, 3.0, 1e3, 1e9] {
                let (u, v) = (random.between(0.0, 1.0), random.between(0.0, 1.0));
                let on = match &definition {
                    Definition::NurbsCurve(curve) => curve.point(u),
                    Definition::NurbsSurface(surface) => surface.point(u, v),
                };
                queries.push(on + away * size * random.point());
            }
            for p in queries {
                let query = Query::new(p, QueryOptions::default()).expect("finite");
                let [plain, wide] = hierarchies
                    .each_ref()
                    .map(|h| h.project(&query, None, &mut Workspace::default()).expect("no limit"));
                assert_eq!(numbers(&plain), numbers(&wide), "{p} of {definition:?}");
                assert_eq!((plain.tie, plain.done), (wide.tie, wide.done), "{p} of {definition:?}");
                connected += usize::from(plain.tie == Tie::Connected);
            }
        }
        assert!(connected >= 3, "the axis and the centre have whole circles: {connected}");
    }

    /// The form of a polynomial leaf takes its weights for 1: knots leave them 1 but for rounding, which is then no part of the form's bound.
    #[test]
    fn the_weights_of_a_polynomial_leaf_are_one() {
        let mut random = Random(19);
        for degree in [1, 2, 3, 9] {
            let n = degree + 9;
            let points = (0..n).map(|_| random.point()).collect();
            let curve = NurbsCurve::new(degree, knots(degree, n, &mut random), points, None).expect("valid");
            let hierarchy = Hierarchy::new(&curve.into(), &[0.123, 0.456]);
            let leaves = hierarchy.leaves.iter().flat_map(|leaf| [leaf.net.clone(), leaf.refine().1[0].net.clone()]);
            assert!(leaves.flatten().all(|h| h.w == 1.0));
            assert!(hierarchy.leaves.iter().all(|leaf| (leaf.lightest, leaf.heaviest) == (1.0, 1.0)));
        }
    }

    /// Of a piece and its mirror image both feet are met, however soon the proof of the second ends.
    #[test]
    fn mirrored_feet_are_met() {
        let mut random = Random(23);
        let (mut apart, mut missed) = (0, Vec::new());
        for round in 0..300 {
            // strips along x: a piece, a straight way across the plane z = 0 far off, and the piece's mirror image
            let (degree, columns) = (2 + round % 3, [1, 3][round / 3 % 2]);
            let bend = 10.0_f64.powf(random.between(-3.0, -0.5));
            let mut strip = |column: usize| -> Vec<DVec3> {
                let at = |k: usize| DVec3::new(6.0 * k as f64 / degree as f64, column as f64, 1.0);
                let half: Vec<DVec3> = (0..=degree).map(|k| at(k) + bend * random.point()).collect();
                let end = half[degree];
                let across = (1..degree).map(|k| end - DVec3::Z * (2.0 * end.z * k as f64 / degree as f64));
                let mirrored = half.iter().rev().map(|p| DVec3::new(p.x, p.y, -p.z));
                half.iter().copied().chain(across).chain(mirrored).collect()
            };
            let strips: Vec<Vec<DVec3>> = (0..columns).map(&mut strip).collect();
            let count = strips[0].len();
            // the weights rise to the middle and fall again
            let weight = |k: usize| 1.0 + 0.2 * (round % 2 * k.min(count - 1 - k).min(degree)) as f64;
            let ends = |x: f64, times: usize| vec![x; times];
            let knots = [ends(0.0, degree + 1), ends(1.0, degree), ends(2.0, degree), ends(3.0, degree + 1)].concat();
            let definition: Definition = if columns == 1 {
                let weights = (0..count).map(weight).collect();
                NurbsCurve::new(degree, knots, strips[0].clone(), Some(weights)).expect("valid").into()
            } else {
                let rows = (0..count).map(|k| strips.iter().map(|strip| strip[k]).collect()).collect();
                let weights = (0..count).map(|k| vec![weight(k); columns]).collect();
                let knots = (knots, [ends(0.0, columns), ends(1.0, columns)].concat());
                NurbsSurface::new((degree, columns - 1), knots, rows, Some(weights)).expect("valid").into()
            };
            let hierarchy = Hierarchy::new(&definition, &[]);
            for _ in 0..20 {
                let p = DVec3::new(random.between(0.0, 4.0), random.between(0.0, columns as f64 - 1.0), 0.0);
                let query = Query::new(p, QueryOptions::default()).expect("finite");
                let solution = hierarchy.project(&query, None, &mut Workspace::default()).expect("no limit");
                apart += usize::from(solution.tie == Tie::Apart);
                if solution.tie != Tie::Apart {
                    missed.push((definition.clone(), p, solution));
                }
            }
        }
        assert!(missed.is_empty(), "{apart} were met, {} not: {:?}", missed.len(), missed.first());
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
