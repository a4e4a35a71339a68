//! Bézier pieces in homogeneous form.

use glam::DVec4;

use crate::knots::{KnotVector, Span};

/// The extraction matrix of a span: row `m` gives Bézier point `m` of the span as a combination of the span's `p + 1`
/// control points.
///
/// Entry `(m, k)` is the `k`-th coefficient of the blossom at `p - m` times the span's start and `m` times its end. All
/// entries are non-negative, and quotients to both sides are formed separately (never `1 - t`), so each entry has a
/// relative error of at most about `5 p u`, `u = 2⁻⁵³`: numerator and weight of a rational piece are moved alike.
#[must_use]
pub fn extraction(knots: &KnotVector, span: Span) -> Vec<Vec<f64>> {
    let (p, t) = (knots.degree(), knots.as_slice());
    (0..=p)
        .map(|m| {
            // row j of `d` holds the coefficients of de Boor's point j
            let mut d: Vec<Vec<f64>> =
                (0..=p).map(|j| (0..=p).map(|k| f64::from(u8::from(j == k))).collect()).collect();
            for r in 1..=p {
                let argument = if r <= p - m { span.start } else { span.end };
                for j in (r..=p).rev() {
                    let (a, b) = (t[span.index - p + j], t[span.index + 1 + j - r]);
                    let (from_a, to_b) = ((argument - a) / (b - a), (b - argument) / (b - a));
                    let (before, rest) = d.split_at_mut(j);
                    for (share, previous) in rest[0].iter_mut().zip(&before[j - 1]) {
                        *share = to_b * previous + from_a * *share;
                    }
                }
            }
            d.swap_remove(p)
        })
        .collect()
}

/// A polynomial piece of a curve, homogeneous: `degree + 1` points over `[span.start, span.end]`.
#[derive(Debug, Clone, PartialEq)]
pub struct BezierCurve {
    /// The control points `(w x, w y, w z, w)`.
    pub points: Vec<DVec4>,
    /// The span of the curve that it covers.
    pub span: Span,
}

/// A polynomial piece of a surface, homogeneous: `(p + 1)(q + 1)` points in row order over a pair of spans.
#[derive(Debug, Clone, PartialEq)]
pub struct BezierSurface {
    /// The degrees in u and v.
    pub degree: (usize, usize),
    /// The control points, `i * (q + 1) + j`.
    pub points: Vec<DVec4>,
    /// The spans of the surface that it covers, in u and v.
    pub spans: (Span, Span),
}

/// The Bézier pieces of a curve with these knots and homogeneous control points, in ascending order.
#[must_use]
pub fn curve_pieces(knots: &KnotVector, net: &[DVec4]) -> Vec<BezierCurve> {
    let p = knots.degree();
    knots
        .spans()
        .map(|span| {
            let points = &net[span.index - p..=span.index];
            BezierCurve { points: extraction(knots, span).iter().map(|row| combine(row, points)).collect(), span }
        })
        .collect()
}

/// The Bézier pieces of a surface with these knots and homogeneous net in row order; u-spans outermost, ascending.
#[must_use]
pub fn surface_pieces(u: &KnotVector, v: &KnotVector, net: &[DVec4]) -> Vec<BezierSurface> {
    let (p, q, columns) = (u.degree(), v.degree(), v.point_count());
    let along: Vec<(Span, Vec<Vec<f64>>)> = v.spans().map(|span| (span, extraction(v, span))).collect();
    let mut pieces = Vec::new();
    let mut column = vec![DVec4::ZERO; p + 1];
    let mut strip = vec![DVec4::ZERO; (p + 1) * columns];
    for across in u.spans() {
        let matrix = extraction(u, across);
        for j in 0..columns {
            for (i, point) in column.iter_mut().enumerate() {
                *point = net[(across.index - p + i) * columns + j];
            }
            for (i, row) in matrix.iter().enumerate() {
                strip[i * columns + j] = combine(row, &column);
            }
        }
        for (span, matrix) in &along {
            let mut points = Vec::with_capacity((p + 1) * (q + 1));
            for i in 0..=p {
                let row = &strip[i * columns + span.index - q..=i * columns + span.index];
                points.extend(matrix.iter().map(|coefficients| combine(coefficients, row)));
            }
            pieces.push(BezierSurface { degree: (p, q), points, spans: (across, *span) });
        }
    }
    pieces
}

fn combine(coefficients: &[f64], points: &[DVec4]) -> DVec4 {
    coefficients.iter().zip(points).fold(DVec4::ZERO, |sum, (c, point)| sum + *c * *point)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::basis::binomial;
    use crate::homogeneous::cartesian;
    use crate::{Direction, NurbsCurve, NurbsSurface};
    use glam::DVec3;

    fn bernstein(n: usize, i: usize, t: f64) -> f64 {
        binomial(n, i) * t.powi(i as i32) * (1.0 - t).powi((n - i) as i32)
    }

    #[test]
    fn pieces_of_a_curve_are_the_curve() {
        let points = (0..8).map(|i| DVec3::new(f64::from(i), f64::from(i * i % 7), f64::from(i % 3))).collect();
        let knots = vec![0.0, 0.0, 0.0, 0.0, 0.2, 0.2, 0.5, 0.9, 1.0, 1.0, 1.0, 1.0];
        let weights = Some((0..8).map(|i| 1.0 + f64::from(i % 3)).collect());
        let curve = NurbsCurve::new(3, knots, points, weights).expect("valid");
        let pieces = curve_pieces(curve.knots(), &curve.homogeneous_points());
        assert_eq!(pieces.len(), 4);
        for piece in pieces {
            for k in 0..=10 {
                let t = f64::from(k) / 10.0;
                let sum: DVec4 = (0..=3).map(|i| piece.points[i] * bernstein(3, i, t)).sum();
                let u = piece.span.start + t * (piece.span.end - piece.span.start);
                assert!((cartesian(sum) - curve.point(u)).length() < 1e-14);
            }
        }
    }

    #[test]
    fn pieces_of_a_surface_are_the_surface() {
        let u = vec![0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 3.0, 3.0, 3.0];
        let v = vec![0.0, 0.0, 0.5, 1.0, 1.0];
        let row = |i: i32| (0..3).map(|j| DVec3::new(f64::from(i), f64::from(j), f64::from(i * j % 4))).collect();
        let weights = (0..6).map(|i| (0..3).map(|j| 1.0 + f64::from((i + j) % 3)).collect()).collect();
        let surface = NurbsSurface::new((2, 1), (u, v), (0..6).map(row).collect(), Some(weights)).expect("valid");
        let net = surface.homogeneous_points();
        let pieces = surface_pieces(surface.knots(Direction::U), surface.knots(Direction::V), &net);
        assert_eq!(pieces.len(), 3 * 2);
        for piece in pieces {
            for k in 0..=16 {
                let (s, t) = (f64::from(k % 4) / 3.0_f64.max(1.0), f64::from(k / 4) / 4.0);
                let s = s.min(1.0);
                let mut sum = DVec4::ZERO;
                for i in 0..=2 {
                    for j in 0..=1 {
                        sum += piece.points[i * 2 + j] * bernstein(2, i, s) * bernstein(1, j, t);
                    }
                }
                let (a, b) = piece.spans;
                let at = surface.point(a.start + s * (a.end - a.start), b.start + t * (b.end - b.start));
                assert!((cartesian(sum) - at).length() < 1e-14);
            }
        }
    }
}
