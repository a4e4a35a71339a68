//! Where a curve meets itself.

use glam::DVec3;
use perpend_kernel::{Aabb, NurbsCurve};

use super::bernstein::{Side, hodograph, rational_hodograph};
use super::source::{Piece, Source};
use crate::representation::Irregularity;

/// Pairs of parts that are looked at.
const PAIRS: usize = 100_000;

/// Halvings of a pair until Newton's method is asked.
const DEEPEST: u32 = 12;

/// A loop reaches at least this many tolerances away from where it closes: one that is smaller is a cusp.
const REACHES: f64 = 1e3;

/// Self-intersections that are listed.
const LISTED: usize = 64;

/// A part of the curve, with its box.
struct Part {
    piece: Piece,
    bounds: Aabb,
    depth: u32,
}

impl Part {
    fn new(piece: Piece, depth: u32) -> Self {
        Self { bounds: Aabb::around(piece.points()), piece, depth }
    }

    fn halves(&self) -> [Self; 2] {
        let (lower, upper) = self.piece.clone().halves(Side::First);
        [Self::new(lower, self.depth + 1), Self::new(upper, self.depth + 1)]
    }
}

struct Search<'a> {
    curve: &'a NurbsCurve,
    source: &'a Source,
    tolerance: f64,
    pairs: usize,
    found: Vec<(f64, f64, f64)>,
}

/// The self-intersections of a curve, ends that meet left out.
///
/// Pairs of parts whose boxes meet are halved; a part that always moves on in one direction does not meet itself. What is left
/// is polished by Newton's method for the nearest points, whose distance is then evaluated. That there is no other loop is
/// not claimed: the number of pairs is bounded.
pub(super) fn loops(curve: &NurbsCurve, source: &Source, tolerance: f64) -> Vec<Irregularity> {
    let mut search = Search { curve, source, tolerance, pairs: 0, found: Vec::new() };
    let parts: Vec<Part> = source.pieces().map(|piece| Part::new(piece, 0)).collect();
    if curve.degree() > 1 {
        for part in &parts {
            search.within(part);
        }
    }
    // a sweep along the longest side of the box: neighbours in space, however many parts there are
    let whole = parts.iter().fold(Aabb::EMPTY, |whole, part| whole.join(part.bounds));
    let extent = (whole.max - whole.min).to_array();
    let axis = (0..3).max_by(|a, b| extent[*a].total_cmp(&extent[*b])).unwrap_or(0);
    let mut order: Vec<usize> = (0..parts.len()).collect();
    order.sort_by(|a, b| parts[*a].bounds.min[axis].total_cmp(&parts[*b].bounds.min[axis]));
    for (k, a) in order.iter().enumerate() {
        for b in &order[k + 1..] {
            if parts[*b].bounds.min[axis] > parts[*a].bounds.max[axis] + search.tolerance || search.is_spent() {
                break;
            }
            search.between(&parts[*a.min(b)], &parts[*a.max(b)]);
        }
    }
    search.found.sort_by(|a, b| a.0.total_cmp(&b.0));
    search.found.into_iter().map(|(from, to, gap)| Irregularity::Loop { from, to, gap }).collect()
}

impl Search<'_> {
    fn is_spent(&self) -> bool {
        self.pairs > PAIRS || self.found.len() >= LISTED
    }

    /// Whether a part always moves on in one direction: it does not meet itself then.
    fn is_steady(&self, part: &Part) -> bool {
        let sides = if self.source.rational {
            rational_hodograph(&part.piece.form)
        } else {
            hodograph(&part.piece.form.map(|c| c.truncate()))
        };
        let sum: DVec3 = sides.coefficients.iter().copied().sum();
        sides.coefficients.iter().all(|side| side.dot(sum) > 0.0)
    }

    fn within(&mut self, part: &Part) {
        self.pairs += 1;
        if part.depth >= DEEPEST || self.is_spent() || self.is_steady(part) {
            return;
        }
        let [lower, upper] = part.halves();
        self.within(&lower);
        self.within(&upper);
        self.between(&lower, &upper);
    }

    fn between(&mut self, a: &Part, b: &Part) {
        self.pairs += 1;
        if self.is_spent() {
            return;
        }
        let tolerance = DVec3::splat(self.tolerance);
        let (low, high) = (a.bounds.min.max(b.bounds.min), a.bounds.max.min(b.bounds.max));
        if (low - high).cmpgt(tolerance).any() || self.moves_on(a, b) {
            return;
        }
        if a.depth.min(b.depth) >= DEEPEST {
            self.polish(a, b);
            return;
        }
        let (first, second) = (a.halves(), b.halves());
        for a in &first {
            for b in &second {
                self.between(a, b);
            }
        }
    }

    /// Whether neighbours move on in one direction together.
    fn moves_on(&self, a: &Part, b: &Part) -> bool {
        if a.piece.to.0 != b.piece.from.0 {
            return false;
        }
        let points = a.piece.points().chain(b.piece.points().skip(1)).collect::<Vec<_>>();
        let along = points[points.len() - 1] - points[0];
        points.windows(2).all(|side| (side[1] - side[0]).dot(along) > 0.0)
    }

    fn polish(&mut self, a: &Part, b: &Part) {
        let (mut s, mut t) = (0.5 * (a.piece.from.0 + a.piece.to.0), 0.5 * (b.piece.from.0 + b.piece.to.0));
        let (first, last) = self.curve.domain();
        let jet = |u: f64| {
            let mut d = [DVec3::ZERO; 2];
            self.curve.derivatives(u, &mut d);
            d
        };
        for _ in 0..20 {
            // Gauss-Newton for |C(s) - C(t)|²
            let ([p, d], [q, e]) = (jet(s), jet(t));
            let (r, aa, bb, ab) = (q - p, d.length_squared(), e.length_squared(), d.dot(e));
            let determinant = aa * bb - ab * ab;
            if determinant <= 1e-14 * aa * bb {
                break;
            }
            s = (s + (r.dot(d) * bb - r.dot(e) * ab) / determinant).clamp(first, last);
            t = (t + (r.dot(d) * ab - r.dot(e) * aa) / determinant).clamp(first, last);
        }
        let (s, t) = (s.min(t), s.max(t));
        let gap = self.curve.point(s).distance(self.curve.point(t));
        let near = 1e-7 * (last - first);
        let is_seam = s - first <= near && last - t <= near;
        let is_new = |found: &(f64, f64, f64)| (found.0 - s).abs() > near || (found.1 - t).abs() > near;
        let crossing = self.curve.point(s);
        let goes_away = (1..8)
            .any(|k| self.curve.point(s + (t - s) * f64::from(k) / 8.0).distance(crossing) > REACHES * self.tolerance);
        if gap <= self.tolerance && goes_away && t - s > near && !is_seam && self.found.iter().all(is_new) {
            self.found.push((s, t, gap));
        }
    }
}
