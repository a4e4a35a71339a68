//! Knot removal, with a proven bound of what it changes.
//!
//! Removing a knot is guessed and then proved. The guess solves Boehm's equations from both ends towards the middle (The NURBS
//! Book, algorithm A5.8), in homogeneous form. The proof puts the knots back and compares control points: with `P, w` the old and
//! `Q, z` the new ones over the same knots, and `d` the diagonal of the box of the `Q`, no point moves by more than
//!
//! ```text
//! max over i of  |P_i - Q_i| + |w_i - z_i| / w_i * d
//! ```
//!
//! since `C - C' = (Σ B_i (w_i (P_i - Q_i) + (w_i - z_i)(Q_i - C'))) / Σ B_i w_i`, and `C'` lies in the hull of the `Q`.

use glam::{DVec3, DVec4};

use super::invalid::InvalidEdit;
use super::thin::middle;
use crate::bounds::Aabb;
use crate::curve::NurbsCurve;
use crate::invalid::{Along, Direction};
use crate::knots::KnotVector;
use crate::surface::NurbsSurface;

/// What knot removal made of an entity.
#[derive(Debug, Clone, PartialEq)]
pub struct KnotRemoval<T> {
    /// The entity without the knots that could be removed.
    pub entity: T,
    /// How often the knot was removed.
    pub times: usize,
    /// No point of the entity moved farther than this, rounding included; 0 where nothing was removed.
    pub deviation: f64,
}

impl NurbsCurve {
    /// The curve with the interior knot `u` removed up to `times` times, as often as no point moves farther than `tolerance`.
    ///
    /// `tolerance` is a length in model units. Even a removal that is exact on paper counts with its rounding, some
    /// `8 (degree + 1) ε` of the largest coordinate (three times that where the curve is rational).
    ///
    /// # Errors
    ///
    /// `u` is not an interior knot; the tolerance is negative or not a number.
    pub fn remove_knot(&self, u: f64, times: usize, tolerance: f64) -> Result<KnotRemoval<Self>, InvalidEdit> {
        let times = possible(&self.knots, u, times, tolerance, Along::Curve)?;
        let once = |curve: &Self| {
            let removal = Step::new(&curve.knots, u)?;
            let line = removal.solve(&curve.homogeneous_points());
            let rational = self.weights.is_some();
            let (points, weights) = separate(&line, rational)?;
            Self::checked(removal.knots, points, weights).ok()
        };
        let deviation = |curve: &Self, count: usize| {
            let back = curve.insert_knot(u, count).ok()?;
            let (old, new) = ((&self.control_points[..], self.weights()), (&back.control_points[..], back.weights()));
            Some(deviation(self.degree(), old, new))
        };
        Ok(remove(self, times, tolerance, once, deviation))
    }
}

impl NurbsSurface {
    /// The surface with the interior knot `at` of a direction removed up to `times` times; see [`NurbsCurve::remove_knot`].
    ///
    /// # Errors
    ///
    /// `at` is not an interior knot; the tolerance is negative or not a number.
    pub fn remove_knot(
        &self,
        direction: Direction,
        at: f64,
        times: usize,
        tolerance: f64,
    ) -> Result<KnotRemoval<Self>, InvalidEdit> {
        let times = possible(self.knots(direction), at, times, tolerance, Along::Surface(direction))?;
        let once = |surface: &Self| match direction {
            Direction::U => surface.swapped().without_v(at).map(|surface| surface.swapped()),
            Direction::V => surface.without_v(at),
        };
        let deviation = |surface: &Self, count: usize| {
            let back = surface.insert_knot(direction, at, count).ok()?;
            let (old, new) = ((&self.control_points[..], self.weights()), (&back.control_points[..], back.weights()));
            Some(deviation(self.knots(direction).degree(), old, new))
        };
        Ok(remove(self, times, tolerance, once, deviation))
    }

    /// The guess for one removal of a knot in v: every row is a curve.
    fn without_v(&self, at: f64) -> Option<Self> {
        let removal = Step::new(&self.v, at)?;
        let net = self.homogeneous_points();
        let net: Vec<DVec4> = net.chunks(self.columns()).flat_map(|row| removal.solve(row)).collect();
        let (points, weights) = separate(&net, self.weights.is_some())?;
        Self::checked(self.u.clone(), removal.knots, points, weights).ok()
    }
}

/// How often a removal can be tried at all.
fn possible(knots: &KnotVector, at: f64, times: usize, tolerance: f64, along: Along) -> Result<usize, InvalidEdit> {
    if tolerance.is_nan() || tolerance < 0.0 {
        return Err(InvalidEdit::Tolerance { tolerance });
    }
    match knots.breaks().find(|b| b.at == at) {
        Some(found) => Ok(found.multiplicity.min(times)),
        None => Err(InvalidEdit::NotAKnot { along, at }),
    }
}

/// Removes one knot after the other while the result, knots put back, stays within the tolerance of the start.
fn remove<T: Clone>(
    start: &T,
    times: usize,
    tolerance: f64,
    once: impl Fn(&T) -> Option<T>,
    deviation: impl Fn(&T, usize) -> Option<f64>,
) -> KnotRemoval<T> {
    let mut best = KnotRemoval { entity: start.clone(), times: 0, deviation: 0.0 };
    for count in 1..=times {
        let Some(entity) = once(&best.entity) else { break };
        match deviation(&entity, count) {
            Some(deviation) if deviation <= tolerance => best = KnotRemoval { entity, times: count, deviation },
            _ => break,
        }
    }
    best
}

/// One removal of a knot, for any line of control points over the knots.
struct Step {
    knots: KnotVector,
    /// The old points that give way: equation `i` of them is `P_i = a_i Q_i + b_i Q_(i-1)`.
    first: usize,
    shares: Vec<(f64, f64)>,
}

impl Step {
    fn new(old: &KnotVector, at: f64) -> Option<Self> {
        let (p, multiplicity) = (old.degree(), old.multiplicity(at));
        let last = old.as_slice().iter().rposition(|knot| *knot == at)?;
        let mut knots = old.as_slice().to_vec();
        knots.remove(last);
        let share = |i: usize| {
            let (a, b) = (knots[i], knots[i + p]);
            ((at - a) / (b - a), (b - at) / (b - a))
        };
        let first = last - p;
        let shares = (first..=last - multiplicity).map(share).collect();
        Some(Self { knots: KnotVector::trusted(p, knots), first, shares })
    }

    /// The new points: equations solved from the left and from the right; the one where they meet is left over, and what it misses is
    /// part of the deviation.
    fn solve(&self, line: &[DVec4]) -> Vec<DVec4> {
        let middle = middle(&self.shares);
        let equation = |k: usize| (line[self.first + k], self.shares[k]);
        let mut left = Vec::with_capacity(middle);
        let mut before = line[self.first - 1];
        for (point, (a, b)) in (0..middle).map(equation) {
            before = (point - b * before) / a;
            left.push(before);
        }
        let mut right = Vec::with_capacity(middle);
        let end = self.first + self.shares.len();
        let mut after = line[end];
        for (point, (a, b)) in (middle + 1..self.shares.len()).rev().map(equation) {
            after = (point - a * after) / b;
            right.push(after);
        }
        let mut result = line[..self.first].to_vec();
        result.extend(left);
        result.extend(right.into_iter().rev());
        result.extend_from_slice(&line[end..]);
        result
    }
}

/// Points and weights of homogeneous points; none where a weight is not positive.
fn separate(net: &[DVec4], rational: bool) -> Option<(Vec<DVec3>, Option<Vec<f64>>)> {
    if !rational {
        return Some((net.iter().map(|h| h.truncate()).collect(), None));
    }
    let positive = net.iter().all(|h| h.w > 0.0);
    positive.then(|| (net.iter().map(|h| h.truncate() / h.w).collect(), Some(net.iter().map(|h| h.w).collect())))
}

/// The bound of the module's head, plus the rounding of putting the knots back.
///
/// That rounding: of a share at most `2.5 p ε` (five operations a level), of its use and of the sum `(p + 3) ε`, of the division
/// `2 ε`; together below `8 (p + 1) ε` of the largest |point|. In the rational case numerator and weight have it, each
/// times a length of at most twice that.
fn deviation(degree: usize, old: (&[DVec3], Option<&[f64]>), new: (&[DVec3], Option<&[f64]>)) -> f64 {
    let diagonal = Aabb::around(new.0.iter().copied()).diagonal();
    let reach = new.0.iter().map(|p| p.length()).fold(0.0, f64::max);
    let weight = |k: usize| match (old.1, new.1) {
        (Some(w), Some(z)) => (w[k] - z[k]).abs() / w[k] * diagonal,
        _ => 0.0,
    };
    let moved = old.0.iter().zip(new.0).enumerate().map(|(k, (p, q))| (*p - *q).length() + weight(k));
    let factor = if old.1.is_some() { 24.0 } else { 8.0 };
    moved.fold(0.0, f64::max) + factor * (degree + 1) as f64 * f64::EPSILON * reach
}
