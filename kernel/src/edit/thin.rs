//! Removal of all knots that a definition does not need, with a proven bound of what it changes.
//!
//! Which knots go is decided by what each would cost: in rounds, the cheapest first, and of those that touch the same control points
//! one a round (Lyche and Mørken 1987 rank knots so). A removal solves Boehm's equations from both ends towards the middle (The
//! NURBS Book, algorithm A5.8); what the equation in the middle misses moves the entity where one basis function is not zero, and
//! is added up there (Tiller 1992). That steers the choice. Over the knots that are left, control points are fitted to the old ones
//! by least squares: what single removals add up to, the fit takes back. What counts is proved at the end: the knots are put back, and
//! control points compared ([`NurbsCurve::deviation_from`]); where that is more than was asked, the choice is made again with less.

use glam::{DVec3, DVec4};

use super::blend::Blend;
use super::change::Change;
use super::fit::fit;
use super::invalid::InvalidEdit;
use crate::bounds::Aabb;
use crate::curve::NurbsCurve;
use crate::homogeneous::{cartesian, homogeneous};
use crate::invalid::Direction;
use crate::knots::KnotVector;
use crate::surface::NurbsSurface;

/// How often the choice is made again, where the proof asks for less or may bear more.
const ATTEMPTS: usize = 10;

/// By how much less each time, until the proof holds; from there on by halving the exponent.
const SHRINK: f64 = 0.1;

/// How often all of it is done again from what it gave: noise that hides a knot goes with its neighbours.
const PASSES: usize = 4;

/// The choice starts with this much of the tolerance: fitted points are nearer than those that the choice was made by.
const AMBITION: f64 = 32.0;

/// And with this much of the largest coordinate: the equations of high degrees blow rounding up that far, and the fit takes it back
/// (measured on refined curves of degree up to 25).
const NOISE: f64 = 8e6 * f64::EPSILON;

/// What removing many knots made of an entity.
#[derive(Debug, Clone, PartialEq)]
pub struct Thinned<T> {
    /// The entity without the knots that could be removed.
    pub entity: T,
    /// The knots that were removed, in ascending order, each as often as it was.
    pub knots: Vec<f64>,
    /// No point of the entity moved farther than this, rounding included; 0 where nothing was removed.
    pub deviation: f64,
}

impl NurbsCurve {
    /// The curve without the interior knots that can be removed such that no point moves farther than `tolerance`; those of
    /// `first` (ascending) are tried before the others.
    ///
    /// `tolerance` is a length in model units. Even removals that are exact on paper count with their rounding, some
    /// `8 (degree + 1) ε` of the largest coordinate (three times that where the curve is rational). Control points that no
    /// removal touches keep their bits; so does a coordinate that all points around a removed knot share. No weight that is not
    /// positive comes of it. The work grows with the number of control points, not with its square.
    ///
    /// # Errors
    ///
    /// The tolerance is negative or not a number.
    pub fn remove_knots(&self, first: &[f64], tolerance: f64) -> Result<Thinned<Self>, InvalidEdit> {
        let lines = |curve: &Self| Lines {
            degree: curve.degree(),
            knots: curve.knots.as_slice().to_vec(),
            points: curve.control_points.clone(),
            weights: curve.weights.clone(),
            width: 1,
        };
        let whole = |lines: Lines| {
            let knots = KnotVector::trusted(lines.degree, lines.knots);
            Self::checked(knots, lines.points, lines.weights).ok()
        };
        thinned(self, lines, first, tolerance, whole, Self::deviation_from, |curve| &curve.knots)
    }
}

impl NurbsSurface {
    /// The surface without the interior knots of a direction that can be removed such that no point moves farther than
    /// `tolerance`; see [`NurbsCurve::remove_knots`].
    ///
    /// # Errors
    ///
    /// The tolerance is negative or not a number.
    pub fn remove_knots(
        &self,
        direction: Direction,
        first: &[f64],
        tolerance: f64,
    ) -> Result<Thinned<Self>, InvalidEdit> {
        if direction == Direction::V {
            let Thinned { entity, knots, deviation } = self.swapped().remove_knots(Direction::U, first, tolerance)?;
            return Ok(Thinned { entity: entity.swapped(), knots, deviation });
        }
        let lines = |surface: &Self| Lines {
            degree: surface.u.degree(),
            knots: surface.u.as_slice().to_vec(),
            points: surface.control_points.clone(),
            weights: surface.weights.clone(),
            width: surface.columns(),
        };
        let whole = |lines: Lines| {
            let knots = KnotVector::trusted(lines.degree, lines.knots);
            Self::checked(knots, self.v.clone(), lines.points, lines.weights).ok()
        };
        thinned(self, lines, first, tolerance, whole, Self::deviation_from, |surface| &surface.u)
    }
}

/// Removes what can be removed, and proves it; with less and less where the proof fails, and again from what that gave.
fn thinned<T: Clone>(
    start: &T,
    lines: impl Fn(&T) -> Lines,
    first: &[f64],
    tolerance: f64,
    whole: impl Fn(Lines) -> Option<T>,
    deviation: impl Fn(&T, &T) -> Option<f64>,
    vector: impl Fn(&T) -> &KnotVector,
) -> Result<Thinned<T>, InvalidEdit> {
    if tolerance.is_nan() || tolerance < 0.0 {
        return Err(InvalidEdit::Tolerance { tolerance });
    }
    let original = lines(start);
    let reach = Aabb::around(original.points.iter().copied()).reach();
    let mut best: Option<(T, f64)> = None;
    for _ in 0..PASSES {
        let from = lines(best.as_ref().map_or(start, |(entity, _)| entity));
        let attempt = |asked: f64| {
            let mut work = Work::new(from.clone(), asked);
            work.run(|knot| first.binary_search_by(|f| f.total_cmp(&knot)).is_ok());
            work.run(|_| true);
            let left = work.lines.knots.len();
            if left == from.knots.len() {
                return None;
            }
            let fitted = original.fitted(&work.lines.knots);
            let proven = [fitted, Some(work.lines)].into_iter().flatten().filter_map(|lines| {
                let entity = whole(lines)?;
                let bound = deviation(start, &entity)?;
                Some((entity, bound))
            });
            let best = proven.min_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, bound)| *bound <= tolerance);
            Some((left, best))
        };
        let (mut asked, mut too_much) = (AMBITION * tolerance + NOISE * reach, f64::INFINITY);
        let mut found: Option<(usize, (T, f64))> = None;
        let mut enough = 0.0;
        for _ in 0..ATTEMPTS {
            match attempt(asked) {
                None => enough = asked,
                Some((left, Some(proven))) => {
                    enough = asked;
                    if found.as_ref().is_none_or(|(fewest, _)| left < *fewest) {
                        found = Some((left, proven));
                    }
                }
                Some((_, None)) => too_much = asked,
            }
            asked = if enough == 0.0 { SHRINK * asked } else { (enough * too_much).sqrt() };
            if too_much <= 1.5 * enough || too_much == f64::INFINITY {
                break;
            }
        }
        match found {
            Some((_, proven)) => best = Some(proven),
            None => break,
        }
    }
    Ok(match best {
        Some((entity, deviation)) => Thinned { knots: removed(vector(start), vector(&entity)), entity, deviation },
        None => Thinned { entity: start.clone(), knots: Vec::new(), deviation: 0.0 },
    })
}

/// The knots of `old` that `new` has not, each as often as it is missing.
fn removed(old: &KnotVector, new: &KnotVector) -> Vec<f64> {
    let missing = old.breaks().flat_map(|b| std::iter::repeat_n(b.at, b.multiplicity - new.multiplicity(b.at)));
    missing.collect()
}

/// Control points over one knot vector: point `k` of line `j` stands at `k * width + j`.
#[derive(Clone)]
struct Lines {
    degree: usize,
    knots: Vec<f64>,
    points: Vec<DVec3>,
    weights: Option<Vec<f64>>,
    width: usize,
}

/// A knot that might go.
#[derive(Clone, Copy)]
struct Candidate {
    /// Index of its last copy.
    last: usize,
    multiplicity: usize,
}

impl Lines {
    /// The points over some of the knots that are nearest to these by least squares, in homogeneous form about the box's centre.
    /// Ends, and points that no removed knot touches, keep their bits; none where a weight is not positive.
    fn fitted(&self, knots: &[f64]) -> Option<Self> {
        let (degree, width) = (self.degree, self.width);
        let fewer = KnotVector::trusted(degree, knots.to_vec());
        let all = KnotVector::trusted(degree, self.knots.clone());
        let rows: Vec<_> = Change::refinement(&fewer, &removed(&all, &fewer)).blends.iter().map(Blend::row).collect();
        let (points, weights) = fit(&rows, &self.points, self.weights.as_deref(), width, fewer.point_count())?;
        Some(Self { degree, knots: knots.to_vec(), points, weights, width })
    }

    fn candidates(&self) -> impl Iterator<Item = Candidate> + '_ {
        let end = self.knots.len() - self.degree - 1;
        let mut multiplicity = 0;
        (self.degree + 1..end).filter_map(move |last| {
            multiplicity += 1;
            if self.knots[last] == self.knots[last + 1] {
                return None;
            }
            Some(Candidate { last, multiplicity: std::mem::take(&mut multiplicity) })
        })
    }

    fn point(&self, k: usize, line: usize) -> (DVec3, f64) {
        let at = k * self.width + line;
        (self.points[at], self.weights.as_ref().map_or(1.0, |w| w[at]))
    }

    /// The points `first - 1 ..= first + equations` take part in a removal: the equations say `P_(first + k) = a_k Q_k + b_k Q_(k-1)`.
    fn shares(&self, candidate: Candidate, shares: &mut Vec<(f64, f64)>) -> usize {
        let (p, at) = (self.degree, self.knots[candidate.last]);
        let first = candidate.last - p;
        shares.clear();
        shares.extend((first..=candidate.last - candidate.multiplicity).map(|i| {
            // the knot itself is skipped
            let (a, b) = (self.knots[i], self.knots[i + p + 1]);
            ((at - a) / (b - a), (b - at) / (b - a))
        }));
        first
    }

    /// Solves the equations of one line about its first point, and gives that point and what the equation in the middle misses.
    fn solve(&self, first: usize, line: usize, shares: &[(f64, f64)], solved: &mut Vec<DVec4>) -> (DVec3, DVec4) {
        let (origin, _) = self.point(first - 1, line);
        let old = |k: usize| {
            let (point, weight) = self.point(k, line);
            homogeneous(point - origin, weight)
        };
        let (count, middle) = (shares.len(), middle(shares));
        solved.clear();
        solved.resize(count - 1, DVec4::ZERO);
        let mut before = old(first - 1);
        for (k, (a, b)) in shares[..middle].iter().enumerate() {
            before = (old(first + k) - *b * before) / *a;
            solved[k] = before;
        }
        let mut after = old(first + count);
        for k in (middle + 1..count).rev() {
            let (a, b) = shares[k];
            after = (old(first + k) - a * after) / b;
            solved[k - 1] = after;
        }
        let (a, b) = shares[middle];
        (origin, old(first + middle) - (a * after + b * before))
    }
}

/// The equation that is left over: those before it are solved from the left, where they divide by the greater share, those after it
/// from the right, where they do too. So rounding does not grow, also beside another knot.
pub(super) fn middle(shares: &[(f64, f64)]) -> usize {
    shares.partition_point(|(a, b)| a >= b).min(shares.len() - 1)
}

/// A removal under way.
struct Work {
    lines: Lines,
    tolerance: f64,
    /// The distinct knots at the start, and what was spent on each span between them.
    starts: Vec<f64>,
    spent: Vec<f64>,
    /// What the removal of a knot costs, by the index of its last copy; not a number where that is to be found.
    costs: Vec<f64>,
}

impl Work {
    fn new(lines: Lines, tolerance: f64) -> Self {
        let mut starts = lines.knots.clone();
        starts.dedup();
        let spent = vec![0.0; starts.len() - 1];
        let costs = vec![f64::NAN; lines.knots.len()];
        Self { lines, tolerance, starts, spent, costs }
    }

    /// Rounds of removals of the knots that are meant, until none can go.
    fn run(&mut self, meant: impl Fn(f64) -> bool) {
        // each round takes a share of about 1 / (2 p + 4) of what can go: this ends the rounds of adversaries alone
        let rounds = 64 * (self.lines.degree + 2);
        for _ in 0..rounds {
            let chosen = self.choose(&meant);
            if chosen.is_empty() {
                break;
            }
            self.apply(&chosen);
        }
    }

    /// The removals of a round, by their place: the cheapest that fit, far enough apart not to touch the same points and knots.
    fn choose(&mut self, meant: &impl Fn(f64) -> bool) -> Vec<Candidate> {
        let mut affordable = Vec::new();
        let (mut shares, mut solved) = (Vec::new(), Vec::new());
        for candidate in self.lines.candidates() {
            if !meant(self.lines.knots[candidate.last]) {
                continue;
            }
            if self.costs[candidate.last].is_nan() {
                self.costs[candidate.last] = self.cost(candidate, &mut shares, &mut solved);
            }
            let cost = self.costs[candidate.last];
            if cost <= self.tolerance {
                affordable.push((cost, candidate));
            }
        }
        affordable.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.last.cmp(&b.1.last)));
        let mut taken = vec![false; self.lines.knots.len()];
        let mut chosen = Vec::new();
        let reach = self.lines.degree + 2;
        for (cost, candidate) in affordable {
            let around = candidate.last.saturating_sub(reach)..(candidate.last + reach + 1).min(taken.len());
            if taken[around].contains(&true) || !self.spend(candidate, cost) {
                continue;
            }
            taken[candidate.last] = true;
            chosen.push(candidate);
        }
        chosen.sort_by_key(|candidate| candidate.last);
        chosen
    }

    /// Adds a cost to the spans where the middle equation's basis function is not zero, if all of them can bear it.
    fn spend(&mut self, candidate: Candidate, cost: f64) -> bool {
        let p = self.lines.degree;
        let mut shares = Vec::with_capacity(p);
        let middle = self.lines.shares(candidate, &mut shares) + middle(&shares);
        let (from, to) = (self.lines.knots[middle], self.lines.knots[middle + p + 1]);
        let start = self.starts.partition_point(|knot| *knot < from);
        let end = self.starts.partition_point(|knot| *knot < to);
        let spans = &mut self.spent[start..end];
        if spans.iter().any(|spent| spent + cost > self.tolerance) {
            return false;
        }
        spans.iter_mut().for_each(|spent| *spent += cost);
        true
    }

    /// How far points move where a knot goes: an estimate; infinite where a weight would not be positive.
    fn cost(&self, candidate: Candidate, shares: &mut Vec<(f64, f64)>, solved: &mut Vec<DVec4>) -> f64 {
        let first = self.lines.shares(candidate, shares);
        let mut cost = 0.0_f64;
        for line in 0..self.lines.width {
            let (origin, miss) = self.lines.solve(first, line, shares, solved);
            let moved = if self.lines.weights.is_some() {
                if !solved.iter().all(|q| q.w > 0.0 && q.is_finite()) {
                    return f64::INFINITY;
                }
                let window = first - 1..=first + shares.len();
                let spread = Aabb::around(window.map(|k| self.lines.point(k, line).0)).diagonal();
                let (point, weight) = self.lines.point(first + middle(shares), line);
                ((miss.truncate() - miss.w * (point - origin)).length() + miss.w.abs() * spread) / weight
            } else {
                miss.truncate().length()
            };
            if !moved.is_finite() {
                return f64::INFINITY;
            }
            cost = cost.max(moved);
        }
        cost
    }

    fn apply(&mut self, chosen: &[Candidate]) {
        let (old, p, width) = (&self.lines, self.lines.degree, self.lines.width);
        let size = old.points.len() - chosen.len() * width;
        let mut points = Vec::with_capacity(size);
        let mut weights = old.weights.as_ref().map(|_| Vec::with_capacity(size));
        let (mut shares, mut solved) = (Vec::new(), Vec::new());
        let mut copied = 0;
        let mut copy = |points: &mut Vec<DVec3>, weights: &mut Option<Vec<f64>>, to: usize, next: usize| {
            points.extend_from_slice(&old.points[copied * width..to * width]);
            if let (Some(weights), Some(all)) = (weights, &old.weights) {
                weights.extend_from_slice(&all[copied * width..to * width]);
            }
            copied = next;
        };
        for candidate in chosen {
            let first = old.shares(*candidate, &mut shares);
            copy(&mut points, &mut weights, first, first + shares.len());
            let start = points.len();
            points.resize(start + (shares.len() - 1) * width, DVec3::ZERO);
            if let Some(weights) = &mut weights {
                weights.resize(points.len(), 0.0);
            }
            for line in 0..width {
                let (origin, _) = old.solve(first, line, &shares, &mut solved);
                let shared = Shared::of((first - 1..=first + shares.len()).map(|k| old.point(k, line)));
                for (k, q) in solved.iter().enumerate() {
                    let at = start + k * width + line;
                    points[at] = shared.keep(origin + if weights.is_some() { cartesian(*q) } else { q.truncate() });
                    if let Some(weights) = &mut weights {
                        weights[at] = shared.weight.unwrap_or(q.w);
                    }
                }
            }
        }
        copy(&mut points, &mut weights, old.points.len() / width, 0);
        let mut knots = Vec::with_capacity(old.knots.len() - chosen.len());
        let mut costs = std::mem::take(&mut self.costs);
        let around = 2 * p + 2;
        for candidate in chosen {
            let end = (candidate.last + around + 1).min(costs.len());
            costs[candidate.last.saturating_sub(around)..end].fill(f64::NAN);
        }
        let mut left = chosen.iter().map(|candidate| candidate.last).peekable();
        for (k, (knot, cost)) in old.knots.iter().zip(costs).enumerate() {
            if left.next_if_eq(&k).is_none() {
                knots.push(*knot);
                self.costs.push(cost);
            }
        }
        self.lines = Lines { degree: p, knots, points, weights, width };
    }
}

/// What all points around a removed knot have in common: affine combinations of them have it too, to the bit.
struct Shared {
    point: DVec3,
    same: [bool; 3],
    weight: Option<f64>,
}

impl Shared {
    fn of(mut all: impl Iterator<Item = (DVec3, f64)>) -> Self {
        let (point, weight) = all.next().unwrap_or((DVec3::ZERO, 1.0));
        let mut shared = Self { point, same: [true; 3], weight: Some(weight) };
        for (other, w) in all {
            for k in 0..3 {
                shared.same[k] &= other[k].to_bits() == point[k].to_bits();
            }
            shared.weight.take_if(|weight| *weight != w);
        }
        shared
    }

    fn keep(&self, point: DVec3) -> DVec3 {
        let coordinate = |k: usize| if self.same[k] { self.point[k] } else { point[k] };
        DVec3::new(coordinate(0), coordinate(1), coordinate(2))
    }
}
