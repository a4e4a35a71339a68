//! From a point of a shape to the definition's parameter.
//!
//! A coordinate that runs along a curve, a length or an angle, is the direction of a homogeneous pair: `(w, w g)` for a length `g`,
//! `(w cos, w sin)` for an angle. Both are Bernstein forms of the definition's degree on each of its pieces, so the parameter of the point in
//! direction `(a, b)` is the root of the form `a n - b m`, which has one sign change on the piece that holds it.

use glam::{DVec2, DVec4};
use perpend_kernel::bezier::{BezierCurve, curve_pieces};
use perpend_kernel::{KnotVector, MAX_DEGREE};

/// How often a piece of the definition is halved at most.
const DEPTH: u32 = 6;

/// Pieces beyond this number are not halved.
const PIECES: usize = 4096;

/// Even parts of all keys for each piece, in which the piece that holds a direction is guessed: where it is not, it is a few pieces on.
const PARTS: usize = 4;

/// Borders between pieces up to this number are looked at one by one when a piece is sought.
const FEW: usize = 8;

/// How far the coefficients of a piece of degree 3 or more may be from a straight row, as a share of its length: one step then leads from
/// the start to the root.
const STRAIGHT: f64 = 0.02;

/// A step whose cube is below rounding.
const CUBED: f64 = 3e-6;

/// A coordinate that ascends with the parameter, and its inverse.
#[derive(Debug)]
pub(super) struct Inverse {
    degree: usize,
    /// The first and the last parameter.
    domain: (f64, f64),
    pieces: Vec<Piece>,
    search: PieceSearch,
    /// Of degree 3 or more: `degree + 1` pairs a piece.
    coefficients: Vec<DVec2>,
}

/// A piece of the definition, or a part of one; pairs are `(m, n)`.
#[derive(Debug)]
struct Piece {
    /// The parameters where it begins and ends.
    start: f64,
    end: f64,
    /// The pairs there.
    first: DVec2,
    last: DVec2,
    /// The weights there: what the pairs are relative to.
    weights: (f64, f64),
    /// Of degree 2: the pair between.
    middle: DVec2,
    /// Of degree 3 or more: where the root is beside a straight row's, which is at `r`, as a cubic polynomial in `r` times `r (1 - r)`.
    beside: [f64; 4],
}

impl Inverse {
    /// The inverse of the coordinate that the pairs `(m, n)` of a curve with weights `w` run along; `turns` says that it is an angle.
    ///
    /// None where it does not ascend from piece to piece.
    pub(super) fn new(knots: &KnotVector, net: impl Iterator<Item = (DVec2, f64)>, turns: bool) -> Option<Self> {
        let net: Vec<(DVec2, f64)> = net.collect();
        let largest = net.iter().fold(0.0_f64, |largest, (_, w)| largest.max(*w));
        let form: Vec<DVec4> = net.iter().map(|(pair, w)| (*pair / largest).extend(0.0).extend(w / largest)).collect();
        let mut waiting: Vec<(BezierCurve, u32)> =
            curve_pieces(knots, &form).into_iter().rev().map(|piece| (piece, 0)).collect();
        let mut inverse = Self {
            degree: knots.degree(),
            domain: knots.domain(),
            pieces: Vec::new(),
            search: PieceSearch::Stepped { below: 0 },
            coefficients: Vec::new(),
        };
        while let Some((piece, depth)) = waiting.pop() {
            let row: Vec<DVec2> = piece.points.iter().map(pair).collect();
            let wide = turns && !within_a_sixth(&row);
            let bent = row.len() > 3 && is_bent(&row) && waiting.len() + inverse.pieces.len() < PIECES;
            if (wide || bent) && depth < DEPTH {
                let (low, high) = halves(piece);
                waiting.extend([(high, depth + 1), (low, depth + 1)]);
                continue;
            }
            let (first, last) = (row[0], row[row.len() - 1]);
            let ascends = first.perp_dot(last) > 0.0;
            if wide || !ascends {
                return None;
            }
            inverse.pieces.push(Piece {
                start: piece.span.start,
                end: piece.span.end,
                first,
                last,
                weights: (piece.points[0].w, piece.points[row.len() - 1].w),
                middle: row[row.len() / 2],
                beside: beside(&row),
            });
            if row.len() > 3 {
                inverse.coefficients.extend(row);
            }
        }
        inverse.search = PieceSearch::new(&inverse.pieces, turns);
        Some(inverse)
    }

    /// The first and the last parameter.
    #[inline]
    pub(super) fn domain(&self) -> (f64, f64) {
        self.domain
    }

    /// The pairs at the first and at the last parameter, for weight 1.
    pub(super) fn ends(&self) -> [DVec2; 2] {
        let (first, last) = (&self.pieces[0], &self.pieces[self.pieces.len() - 1]);
        [first.first / first.weights.0, last.last / last.weights.1]
    }

    /// The parameter of the point in direction `(a, b)`, of any length; on the border of a piece where that is within `tolerance`, a difference
    /// of the coordinate times the direction's length. Outside of the range, the nearer end.
    #[inline(never)]
    pub(super) fn parameter(&self, a: f64, b: f64, tolerance: f64) -> f64 {
        let along = |pair: DVec2| a * pair.y - b * pair.x;
        let k = self.search.find(&self.pieces, a, b);
        let piece = &self.pieces[k];
        let (f, l) = (along(piece.first), along(piece.last));
        if f >= -tolerance * piece.weights.0 {
            return piece.start;
        }
        if l <= tolerance * piece.weights.1 {
            return piece.end;
        }
        let share = match self.degree {
            1 => f / (f - l),
            2 => quadratic(f, along(piece.middle), l),
            p => {
                let row = &self.coefficients[k * (p + 1)..(k + 1) * (p + 1)];
                let form = row.iter().map(|pair| along(*pair));
                let start = piece.near(f, l);
                match p {
                    3 => root::<4>(form, p, start),
                    4 => root::<5>(form, p, start),
                    5 => root::<6>(form, p, start),
                    6..=7 => root::<8>(form, p, start),
                    _ => root::<{ MAX_DEGREE + 1 }>(form, p, start),
                }
            }
        };
        let parameter = piece.start + share * (piece.end - piece.start);
        if parameter < piece.end { parameter } else { piece.end }
    }
}

/// How the piece that holds a direction is found.
#[derive(Debug)]
enum PieceSearch {
    /// Of few pieces: by stepping over borders, in one half plane, where the cross product tells their order. That many begin in the lower one, and all
    /// directions of the upper one have passed their ends.
    Stepped { below: usize },
    /// Of many: by the piece in the middle of one of the even parts of all keys, and a few steps from there.
    Guessed { turns: bool, pieces: Vec<u32>, least: f64, density: f64 },
}

impl PieceSearch {
    fn new(pieces: &[Piece], turns: bool) -> Self {
        let borders: Vec<DVec2> = pieces[..pieces.len() - 1].iter().map(|piece| piece.last).collect();
        if borders.len() <= FEW {
            return Self::Stepped { below: borders.iter().filter(|border| border.y < 0.0).count() };
        }
        let key = |pair: DVec2| key(turns, pair.x, pair.y);
        let (least, most) = (key(pieces[0].first), key(pieces[pieces.len() - 1].last));
        let (least, most) = if turns { (-2.0, 2.0) } else { (least, most) };
        let parts = PARTS * pieces.len();
        let width = (most - least) / parts as f64;
        let keys: Vec<f64> = borders.into_iter().map(key).collect();
        let middle = |part: usize| least + (part as f64 + 0.5) * width;
        let pieces = (0..parts).map(|part| keys.partition_point(|border| *border <= middle(part)) as u32).collect();
        Self::Guessed { turns, pieces, least, density: 1.0 / width }
    }

    #[inline]
    fn find(&self, all: &[Piece], a: f64, b: f64) -> usize {
        let along = |pair: DVec2| a * pair.y - b * pair.x;
        match self {
            Self::Stepped { below } => {
                let (mut k, end) = if b >= 0.0 { (*below, all.len() - 1) } else { (0, *below) };
                while k < end && along(all[k].last) <= 0.0 {
                    k += 1;
                }
                k
            }
            Self::Guessed { turns, pieces, least, density } => {
                let part = ((key(*turns, a, b) - least) * density) as usize;
                let mut k = pieces[part.min(pieces.len() - 1)] as usize;
                while k > 0 && along(all[k].first) > 0.0 {
                    k -= 1;
                }
                while k + 1 < all.len() && along(all[k].last) <= 0.0 {
                    k += 1;
                }
                k
            }
        }
    }
}

/// What ascends with the coordinate that a direction stands for: an angle or a length.
#[inline]
fn key(turns: bool, a: f64, b: f64) -> f64 {
    if turns { (1.0 - a / DVec2::new(a, b).length()).copysign(b) } else { b / a }
}

impl Piece {
    /// About where the root is, of a form that begins at `f` and ends at `l`.
    fn near(&self, f: f64, l: f64) -> f64 {
        let r = f / (f - l);
        let [a, b, c, d] = self.beside;
        let start = r + r * (1.0 - r) * (a + r * (b + r * (c + r * d)));
        start.clamp(0.0, 1.0)
    }
}

/// [`Piece::beside`] of a row of pairs: exact at four places inside.
fn beside(row: &[DVec2]) -> [f64; 4] {
    let (first, last) = (row[0], row[row.len() - 1]);
    let places = [0.07, 0.35, 0.65, 0.93].map(|share| {
        let at = value(row, share);
        let (f, l) = (at.perp_dot(first), at.perp_dot(last));
        let r = f / (f - l);
        (r, (share - r) / (r * (1.0 - r)))
    });
    // Newton's divided differences, then the powers of r
    let (at, mut steps) = (places.map(|place| place.0), places.map(|place| place.1));
    for k in 1..4 {
        for i in (k..4).rev() {
            steps[i] = (steps[i] - steps[i - 1]) / (at[i] - at[i - k]);
        }
    }
    let mut powers = [0.0; 4];
    for i in (0..4).rev() {
        for k in (1..4).rev() {
            powers[k] = powers[k - 1] - at[i] * powers[k];
        }
        powers[0] = steps[i] - at[i] * powers[0];
    }
    if powers.iter().all(|power| power.is_finite()) { powers } else { [0.0; 4] }
}

/// De Casteljau's algorithm.
fn value(row: &[DVec2], share: f64) -> DVec2 {
    let mut row = row.to_vec();
    while row.len() > 1 {
        row = row.windows(2).map(|pair| pair[0].lerp(pair[1], share)).collect();
    }
    row[0]
}

fn pair(point: &DVec4) -> DVec2 {
    DVec2::new(point.x, point.y)
}

/// Whether all pairs lie within a sixth of a turn of the first and of the last.
fn within_a_sixth(row: &[DVec2]) -> bool {
    let last = row[row.len() - 1];
    let near = |a: DVec2, b: DVec2| {
        let product = a.dot(b);
        product >= 0.0 && product * product >= 0.25 * (a.length_squared() * b.length_squared())
    };
    row.iter().all(|pair| near(*pair, row[0]) && near(*pair, last))
}

/// Whether a row departs from equal steps by more than [`STRAIGHT`].
fn is_bent(row: &[DVec2]) -> bool {
    let (first, last, p) = (row[0], row[row.len() - 1], row.len() - 1);
    let step = (last - first) / p as f64;
    let most = (STRAIGHT * STRAIGHT) * first.distance_squared(last);
    row.iter().enumerate().any(|(i, pair)| (*pair - first).distance_squared(i as f64 * step) > most)
}

/// De Casteljau's algorithm at one half.
fn halves(piece: BezierCurve) -> (BezierCurve, BezierCurve) {
    let (mut low, mut high) = (piece.clone(), piece);
    let middle = 0.5 * low.span.start + 0.5 * low.span.end;
    (low.span.end, high.span.start) = (middle, middle);
    let p = high.points.len() - 1;
    for k in 1..=p {
        for i in 0..=p - k {
            high.points[i] = 0.5 * (high.points[i] + high.points[i + 1]);
        }
        low.points[k] = high.points[0];
    }
    (low, high)
}

/// The root in `[0, 1]` of the quadratic Bernstein form `f, m, l` with `f < 0 < l`.
///
/// In `r = t / (1 - t)` it is `l r² + 2 m r + f`, whose discriminant is a sum of squares; of the two formulas for the positive root,
/// the one without cancellation is taken.
#[inline]
fn quadratic(f: f64, m: f64, l: f64) -> f64 {
    let root = (m * m - f * l).sqrt();
    if m >= 0.0 { -f / (m + root - f) } else { (root - m) / (root - m + l) }
}

/// A root in `[0, 1]` of a Bernstein form that begins below 0 and ends above, from a start: Chebyshev's method, Newton's with the bend of
/// the form, kept inside the bracket.
#[inline]
fn root<const R: usize>(form: impl Iterator<Item = f64>, degree: usize, start: f64) -> f64 {
    // a degree that fills the room is known to the compiler, and its loops are
    let p = if R <= 6 { R - 1 } else { degree };
    let mut coefficients = [0.0; R];
    coefficients.iter_mut().zip(form).for_each(|(c, f)| *c = f);
    let (mut low, mut high) = (0.0, 1.0);
    let mut t = start;
    for _ in 0..64 {
        let (mut row, other) = (coefficients, 1.0 - t);
        for k in (2..p).rev() {
            for i in 0..=k {
                row[i] = other * row[i] + t * row[i + 1];
            }
        }
        let bend = row[2] - 2.0 * row[1] + row[0];
        let (before, after) = (other * row[0] + t * row[1], other * row[1] + t * row[2]);
        let (value, slope) = (other * before + t * after, p as f64 * (after - before));
        if value < 0.0 {
            low = t;
        } else {
            high = t;
        }
        let inverse = 1.0 / slope;
        let newton = value * inverse;
        // how much the slope changes over half of Newton's step, as a share of it
        let turned = 0.5 * (p * (p - 1)) as f64 * bend * newton * inverse;
        let next = t - newton * (1.0 + turned);
        // not outside, and not where a slope of 0 leads
        let inside = next >= low && next <= high;
        let next = if inside { next } else { 0.5 * (low + high) };
        let step = (next - t).abs();
        t = next;
        // the error left is about the step's cube; elsewhere the bracket closes
        if inside && step <= CUBED && turned.abs() <= CUBED || step <= f64::EPSILON * t.max(1.0 / 64.0) {
            break;
        }
    }
    t
}

#[cfg(test)]
mod tests {
    use super::*;
    use perpend_kernel::NurbsCurve;
    use perpend_kernel::glam::DVec3;

    fn length(curve: &NurbsCurve) -> Option<Inverse> {
        let weight = |i: usize| curve.weights().map_or(1.0, |w| w[i]);
        let net = curve.control_points().iter().enumerate().map(|(i, p)| (weight(i) * DVec2::new(1.0, p.x), weight(i)));
        Inverse::new(curve.knots(), net, false)
    }

    #[test]
    fn lengths_are_inverted_at_every_degree_and_weight() {
        for degree in 1..=9_usize {
            for rational in [false, true] {
                let n = degree + 4;
                let mut knots = vec![0.0; degree];
                knots.extend([0.0, 0.2, 0.5, 0.9, 1.0]);
                knots.extend(vec![1.0; degree]);
                let points =
                    (0..n).map(|i| DVec3::X * (i as f64 + 0.3 * f64::from(u8::from(i % 3 == 1)) - 2.0)).collect();
                let weights = rational.then(|| (0..n).map(|i| 1.0 + 0.7 * (i % 4) as f64).collect());
                let curve = NurbsCurve::new(degree, knots, points, weights).expect("valid");
                let inverse = length(&curve).expect("it ascends");
                for k in 0..=1000 {
                    let u = f64::from(k) / 1000.0;
                    let found = inverse.parameter(1.0, curve.point(u).x, 0.0);
                    // evaluation rounds by a few ulps of the largest coordinate a degree, and was asked twice
                    let rounding = 2.0 * f64::EPSILON * (degree + 1) as f64 * n as f64;
                    assert!((curve.point(found).x - curve.point(u).x).abs() < rounding, "degree {degree}: {u} {found}");
                }
            }
        }
    }

    #[test]
    fn a_length_that_stands_still_at_the_end_is_inverted() {
        let points = [0.0, 0.0, 0.0, 1.0].map(|x| x * DVec3::X).to_vec();
        let knots = vec![0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0];
        let inverse = length(&NurbsCurve::new(3, knots, points, None).expect("valid")).expect("it ascends");
        for h in [1e-30, 1e-12, 1e-3, 0.5, 1.0] {
            let u = inverse.parameter(1.0, h, 0.0);
            assert!((u * u * u - h).abs() <= 4e-16, "{h}: {u}");
        }
    }

    #[test]
    fn what_runs_back_has_no_inverse() {
        let points = [0.0, 2.0, 1.0].map(|x| x * DVec3::X).to_vec();
        let curve = NurbsCurve::new(1, vec![0.0, 0.0, 1.0, 2.0, 2.0], points, None).expect("valid");
        assert!(length(&curve).is_none());
    }
}
