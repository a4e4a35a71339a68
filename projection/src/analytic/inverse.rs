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

/// How far the coefficients of a piece of degree 3 or more may be from a straight row, as a share of its length: two steps then lead to
/// the root.
const STRAIGHT: f64 = 0.02;

/// A step whose cube is below rounding.
const CUBED: f64 = 3e-6;

/// A coordinate that ascends with the parameter, and its inverse.
#[derive(Debug)]
pub(super) struct Inverse {
    degree: usize,
    /// Pairs `(m, n)`: `degree + 1` a piece.
    coefficients: Vec<DVec2>,
    /// The pair in the middle of each piece.
    middles: Vec<DVec2>,
    /// The parameters where pieces begin and end.
    parameters: Vec<f64>,
    /// The pair at each of these.
    borders: Vec<DVec2>,
    /// The weight there: what `m` and `n` are relative to.
    weights: Vec<f64>,
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
            coefficients: Vec::new(),
            middles: Vec::new(),
            parameters: vec![knots.domain().0],
            borders: vec![pair(&form[0])],
            weights: vec![form[0].w],
        };
        while let Some((piece, depth)) = waiting.pop() {
            let row: Vec<DVec2> = piece.points.iter().map(pair).collect();
            let wide = turns && !within_a_sixth(&row);
            let bent = row.len() > 3 && is_bent(&row) && waiting.len() + inverse.parameters.len() < PIECES;
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
            inverse.coefficients.extend(row);
            inverse.parameters.push(piece.span.end);
            inverse.borders.push(last);
            inverse.weights.push(piece.points[piece.points.len() - 1].w);
            inverse.middles.push(pair(&halves(piece).1.points[0]));
        }
        Some(inverse)
    }

    /// The first and the last parameter.
    pub(super) fn domain(&self) -> (f64, f64) {
        (self.parameters[0], self.parameters[self.parameters.len() - 1])
    }

    /// The pairs at the first and at the last parameter, for weight 1.
    pub(super) fn ends(&self) -> [DVec2; 2] {
        let last = self.weights.len() - 1;
        [self.borders[0] / self.weights[0], self.borders[last] / self.weights[last]]
    }

    /// The parameter of the point in direction `(a, b)`; on the border of a piece where that is within `tolerance`, a difference of the
    /// coordinate. Outside of the range, the nearer end.
    pub(super) fn parameter(&self, a: f64, b: f64, tolerance: f64) -> f64 {
        let k = self.piece(a, b);
        let (p, along) = (self.degree, |pair: DVec2| a * pair.y - b * pair.x);
        if along(self.borders[k]) >= -tolerance * self.weights[k] {
            return self.parameters[k];
        }
        if along(self.borders[k + 1]) <= tolerance * self.weights[k + 1] {
            return self.parameters[k + 1];
        }
        let row = &self.coefficients[k * (p + 1)..(k + 1) * (p + 1)];
        let share = match *row {
            [first, last] => {
                let (f, l) = (along(first), along(last));
                f / (f - l)
            }
            [first, middle, last] => quadratic(along(first), along(middle), along(last)),
            [first, .., last] => {
                // the parabola through the ends and the middle gives three digits
                let (f, l) = (along(first), along(last));
                let start = quadratic(f, 2.0 * along(self.middles[k]) - 0.5 * (f + l), l);
                let form = row.iter().map(|pair| along(*pair));
                match p {
                    3 => root::<4>(form, p, start),
                    4..=7 => root::<8>(form, p, start),
                    _ => root::<{ MAX_DEGREE + 1 }>(form, p, start),
                }
            }
            [..] => 0.0,
        };
        let (start, end) = (self.parameters[k], self.parameters[k + 1]);
        (start + share * (end - start)).clamp(start, end)
    }

    /// The piece that holds a direction.
    fn piece(&self, a: f64, b: f64) -> usize {
        let inner = &self.borders[1..self.borders.len() - 1];
        // in one half plane the cross product tells the order, else the half plane does
        let before = |border: &DVec2| {
            let ahead = a * border.y - b * border.x <= 0.0;
            if (border.y >= 0.0) == (b >= 0.0) { ahead } else { b >= 0.0 }
        };
        if inner.len() <= 8 {
            inner.iter().map(|border| usize::from(before(border))).sum()
        } else {
            inner.partition_point(before)
        }
    }
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

/// The root in `[0, 1]` of the quadratic Bernstein form `f, m, l` with `f <= 0 <= l`.
///
/// In `r = t / (1 - t)` it is `l r² + 2 m r + f`, whose discriminant is a sum of squares; of the two formulas for the positive root,
/// the one without cancellation is taken.
fn quadratic(f: f64, m: f64, l: f64) -> f64 {
    let root = (m * m - f * l).sqrt();
    let share = if m >= 0.0 { -f / (m + root - f) } else { (root - m) / (root - m + l) };
    if share.is_finite() { share } else { 0.5 }
}

/// A root in `[0, 1]` of a Bernstein form that begins below 0 and ends above, from a start: Chebyshev's method, Newton's with the bend of
/// the form, kept inside the bracket.
fn root<const R: usize>(form: impl Iterator<Item = f64>, p: usize, start: f64) -> f64 {
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
