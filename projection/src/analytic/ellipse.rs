//! An arc of an ellipse in its plane.
//!
//! In lengths of the larger half-axis, with `k` the smaller one, `c² = 1 - k²` and the query in the first quadrant at `(x, y)`, the
//! nearest point `(cos, k sin)` of the whole ellipse has
//!
//! ```text
//! cos = x / (s + c²),   sin = k y / s,   where s >= 0 and cos² + sin² = 1
//! ```
//!
//! `s - k²` is the distance as a multiple of the normal `(cos, sin / k)`, and a point of an ellipse is nearest to all points of its normal with `s >= 0`. The
//! norm `N(s)` of the pair falls; `1 - 1/N` is concave and nearly straight, so that Newton's method for it, from a start where `N >= 1`,
//! ascends to the root in a few steps (the secular equation of trust regions, Moré and Sorensen 1983). Nothing cancels: `c²` is
//! `(1 - k)(1 + k)`, and `s` itself is the unknown, not its distance from a pole.
//!
//! # Proof
//!
//! Whatever `s` is, the pair `(cos, sin) / N` is the exact foot of the query moved by at most `|1 - 1/N|` of its distance from the centre. The bound is lowered by
//! twice that.

use glam::DVec2;
use perpend_kernel::KnotVector;

use super::arc::Place;
use super::axes::ROUNDING;
use super::inverse::Inverse;
use super::profile::Foot;
use super::sector::Asked;
use crate::solver::Tie;

/// An arc of an ellipse.
#[derive(Debug)]
pub(super) struct EllipticArc {
    centre: DVec2,
    /// The directions of the half-axes.
    x: DVec2,
    y: DVec2,
    radii: (f64, f64),
    /// Whether the half-axis along `y` is the larger one.
    upright: bool,
    /// The smaller half-axis as a share of the larger, and `c²`.
    flat: f64,
    focal: f64,
    /// Cosine and sine of the eccentric angle in the middle of the arc; the sine of the turn from `x` to `y` in the parameter's direction.
    middle: DVec2,
    ascending: f64,
    /// Cosine and sine of half the sweep.
    end: DVec2,
    full: bool,
    inverse: Inverse,
}

/// A point of the ellipse by its eccentric angle, with its distance.
#[derive(Debug, Clone, Copy)]
struct Candidate {
    parameter: f64,
    at: DVec2,
    distance: f64,
}

/// The evolute is where two of the feet meet; as near to it as this share, whether they exist is in doubt.
const DOUBT: f64 = 1e-6;

impl EllipticArc {
    /// The arc that a curve runs along, whose control points are `net` with their weights; the radius of `place` is not used.
    pub(super) fn new(
        place: Place,
        radii: (f64, f64),
        knots: &KnotVector,
        net: impl Iterator<Item = (DVec2, f64)>,
    ) -> Option<Self> {
        let Place { centre, x, y, sweep, .. } = place;
        let (large, small) = (radii.0.max(radii.1), radii.0.min(radii.1));
        let flat = small / large;
        let turn = (sweep.1 - sweep.0).abs();
        let full = turn >= std::f64::consts::TAU * (1.0 - 4.0 * f64::EPSILON);
        let (sin, cos) = if full { (0.0, -1.0) } else { (0.5 * turn).sin_cos() };
        let (sin_middle, cos_middle) = (0.5 * (sweep.0 + sweep.1)).sin_cos();
        let middle = DVec2::new(cos_middle, sin_middle);
        let ascending = if sweep.1 < sweep.0 { -1.0 } else { 1.0 };
        let units = net.map(|(p, w)| {
            let arm = p - centre;
            let unit = DVec2::new(arm.dot(x) / radii.0, arm.dot(y) / radii.1);
            (w * from_middle(middle, ascending, unit), w)
        });
        let inverse = Inverse::new(knots, units, true)?;
        let [first, last] = inverse.ends();
        let near = |pair: DVec2, sin: f64| (pair - DVec2::new(cos, sin)).length() <= 1e-6;
        (near(first, -sin) && near(last, sin)).then_some(Self {
            centre,
            x,
            y,
            radii,
            upright: radii.1 > radii.0,
            flat,
            focal: (1.0 - flat) * (1.0 + flat),
            middle,
            ascending,
            end: DVec2::new(cos, sin),
            full,
            inverse,
        })
    }

    /// The nearest point to `q`, which is `beside` the plane (a squared length).
    ///
    /// None where an arc does not hold the foot on the whole ellipse, and rounding does not tell whether another local minimum exists.
    #[inline(never)]
    pub(super) fn foot(&self, q: DVec2, beside: f64, asked: &Asked) -> Option<Foot> {
        let arm = q - self.centre;
        let arm = DVec2::new(arm.dot(self.x), arm.dot(self.y));
        let reach = arm.length();
        // the first quadrant, the larger half-axis first
        let (large, small) = if self.upright { (arm.y, arm.x) } else { (arm.x, arm.y) };
        let size = self.radii.0.max(self.radii.1);
        let (x, y) = (large.abs() / size, small.abs() / size);
        let (pair, off) = self.nearest(x, y);
        let back = |pair: DVec2| {
            let pair = pair * DVec2::new(large, small).signum();
            if self.upright { DVec2::new(pair.y, pair.x) } else { pair }
        };
        let candidate = |pair| self.candidate(back(pair), arm, beside, asked);
        let mirrored = DVec2::new(pair.x, -pair.y);
        let own = candidate(pair);
        let unproven = 2.0 * (off + 6.0 * ROUNDING) * reach;
        let foot = |nearest: Candidate, tie| Foot {
            parameter: nearest.parameter,
            distance: nearest.distance,
            unproven,
            x: self.centre.x + nearest.at.x * self.x.x + nearest.at.y * self.y.x,
            tie,
        };
        let tied = |one: &Candidate, other: &Candidate| {
            other.distance <= one.distance + asked.gap && other.at.distance(one.at) > asked.coincidence
        };
        if self.holds(back(pair)) {
            let excess = asked.gap * (2.0 * own.distance + asked.gap);
            let farthest = (size + reach) * (size + reach) + beside - own.distance * own.distance;
            if farthest <= excess && 2.0 * size > asked.coincidence {
                return Some(foot(own, Tie::Connected));
            }
            if 4.0 * size * size * self.flat * y * pair.y <= excess && self.holds(back(mirrored)) {
                let other = candidate(mirrored);
                if tied(&own, &other) {
                    let between = small.abs() <= asked.noise && other.parameter < own.parameter;
                    return Some(foot(if between { other } else { own }, Tie::Apart));
                }
            }
            return Some(foot(own, Tie::None));
        }
        let (first, last) = self.inverse.domain();
        let [start, end] = [(first, -self.end.y), (last, self.end.y)].map(|(parameter, sin)| {
            let pair = self.at_turn(DVec2::new(self.end.x, sin));
            Candidate { parameter, ..self.candidate(pair, arm, beside, asked) }
        });
        let (mut nearest, mut other) = if end.distance < start.distance { (end, start) } else { (start, end) };
        if let Some((pair, off)) = self.opposite(x, y)? {
            let pair = back(pair);
            if self.holds(pair) {
                let local = self.candidate(pair, arm, beside, asked);
                if local.distance - 2.0 * off * reach < nearest.distance {
                    (nearest, other) = (local, nearest);
                }
            }
        }
        let tie = if tied(&nearest, &other) { Tie::Apart } else { Tie::None };
        Some(foot(nearest, tie))
    }

    /// A point by its eccentric angle.
    fn candidate(&self, pair: DVec2, arm: DVec2, beside: f64, asked: &Asked) -> Candidate {
        let at = DVec2::new(self.radii.0 * pair.x, self.radii.1 * pair.y);
        let turned = from_middle(self.middle, self.ascending, pair);
        let (first, last) = self.inverse.domain();
        let speed = DVec2::new(self.radii.0 * pair.y, self.radii.1 * pair.x).length();
        let parameter = self.inverse.parameter(turned.x, turned.y, (asked.tolerance() / speed).min(1e-9));
        Candidate {
            parameter: if self.full && parameter == last { first } else { parameter },
            at,
            distance: ((arm - at).length_squared() + beside).sqrt(),
        }
    }

    fn at_turn(&self, turned: DVec2) -> DVec2 {
        let turned = DVec2::new(turned.x, self.ascending * turned.y);
        DVec2::new(
            turned.x * self.middle.x - turned.y * self.middle.y,
            turned.x * self.middle.y + turned.y * self.middle.x,
        )
    }

    /// Whether the arc holds an eccentric angle.
    fn holds(&self, pair: DVec2) -> bool {
        let turned = from_middle(self.middle, self.ascending, pair);
        self.full || turned.y.abs() * self.end.x <= turned.x * self.end.y
    }

    /// The foot on the whole ellipse of a query in the first quadrant, and how far the norm is from 1.
    fn nearest(&self, x: f64, y: f64) -> (DVec2, f64) {
        let (ky, focal) = (self.flat * y, self.focal);
        // below this, squares of quotients leave the range of numbers; it is far below rounding
        if ky < 1e-140 {
            if x < focal {
                let cos = x / focal;
                return (DVec2::new(cos, ((1.0 - cos) * (1.0 + cos)).sqrt()), 0.0);
            }
            if y < 1e-140 {
                return (DVec2::X, 0.0);
            }
        }
        let mut s = ky.max((x * x + ky * ky).sqrt() - focal);
        if ky < 1e-2 {
            // s² (s + c² - x) >= (k y)² c² / 2, since 1 - cos² has the factors s + c² ± x: beside the axis, near the cusp of the evolute, all
            // other bounds are far below the root
            let (product, beyond) = (0.5 * ky * ky * focal, focal - x);
            let narrow = if beyond > 0.0 { (0.5 * product / beyond).sqrt() } else { f64::INFINITY };
            s = s.max((0.5 * product).cbrt().min(narrow));
        }
        for _ in 0..32 {
            let (cos, sin) = (x / (s + focal), ky / s);
            let square = cos * cos + sin * sin;
            let norm = square.sqrt();
            let off = (norm - 1.0).abs();
            let next = s + (norm - 1.0) * square / (cos * cos / (s + focal) + sin * sin / s);
            // a step that rounding has taken, or that is no number, ends it
            let ascends = next > s;
            if off <= 2.0 * f64::EPSILON || !ascends {
                return (DVec2::new(cos / norm, sin / norm), off);
            }
            s = next;
        }
        let pair = DVec2::new(x / (s + focal), ky / s);
        let norm = pair.length();
        (pair / norm, (norm - 1.0).abs())
    }

    /// The local minimum on the other side of the larger axis, and how far its norm is from 1; none where there is none. It exists inside the evolute
    /// only; the outer none says that this is in doubt.
    fn opposite(&self, x: f64, y: f64) -> Option<Option<(DVec2, f64)>> {
        let (ky, focal) = (self.flat * y, self.focal);
        let inside = (x / focal).powi(2).cbrt() + (ky / focal).powi(2).cbrt();
        if inside >= 1.0 + DOUBT {
            return Some(None);
        }
        if inside > 1.0 - DOUBT || !inside.is_finite() {
            return None;
        }
        if ky < 1e-140 {
            let cos = x / focal;
            return Some(Some((DVec2::new(cos, -((1.0 - cos) * (1.0 + cos)).sqrt()), 0.0)));
        }
        // the branch s = -t < 0; the norm falls to the root from t = k y
        let mut t = ky;
        for _ in 0..64 {
            let (cos, sin) = (x / (focal - t), ky / t);
            let square = cos * cos + sin * sin;
            let slope = 2.0 * (sin * sin / t - cos * cos / (focal - t));
            let next = t + (square - 1.0) / slope;
            let norm = square.sqrt();
            let ascends = next > t;
            if square - 1.0 <= 4.0 * f64::EPSILON || !ascends {
                return Some(Some((DVec2::new(cos / norm, -sin / norm), (norm - 1.0).abs())));
            }
            t = next;
        }
        None
    }
}

/// An eccentric angle as seen from the middle of the arc, ascending with the parameter.
fn from_middle(middle: DVec2, ascending: f64, pair: DVec2) -> DVec2 {
    DVec2::new(pair.x * middle.x + pair.y * middle.y, ascending * (pair.y * middle.x - pair.x * middle.y))
}
