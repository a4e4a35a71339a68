//! Bézier pieces in homogeneous form.

use std::ops::{Add, Mul};

use glam::DVec4;

use crate::knots::{KnotVector, Span};

/// The extraction matrix of a span: row `m` gives Bézier point `m` of the span as a combination of the span's `p + 1`
/// control points.
///
/// Entry `(m, k)` is the `k`-th coefficient of the blossom at `p - m` times the span's start and `m` times its end. All
/// entries are non-negative, and quotients to both sides are formed separately (never `1 - t`), so each entry has a
/// relative error of at most about `5 p u`, `u = 2⁻⁵³`: numerator and weight of a rational piece are moved alike.
#[derive(Debug, Clone, PartialEq)]
pub struct Extraction {
    width: usize,
    entries: Vec<f64>,
}

impl Extraction {
    /// The matrix that leaves one point as it is.
    #[must_use]
    pub fn of_a_point() -> Self {
        Self { width: 1, entries: vec![1.0] }
    }

    /// The rows in ascending order.
    pub fn rows(&self) -> impl ExactSizeIterator<Item = &[f64]> {
        self.entries.chunks_exact(self.width)
    }
}

/// The extraction matrix of a span.
#[must_use]
pub fn extraction(knots: &KnotVector, span: Span) -> Extraction {
    let width = knots.degree() + 1;
    let mut blossoms = Blossoms::new(knots);
    blossoms.enter(span);
    let mut entries = vec![0.0; width * width];
    let (mut unit, mut column) = (vec![0.0; width], vec![0.0; width]);
    for k in 0..width {
        unit.fill(0.0);
        unit[k] = 1.0;
        blossoms.bezier_points(&mut unit, &mut column);
        for (row, entry) in entries.chunks_exact_mut(width).zip(&column) {
            row[k] = *entry;
        }
    }
    Extraction { width, entries }
}

/// A level of de Boor's algorithm: every point but the first is combined with the one before it.
fn level<T>(points: &mut [T], quotients: &[(f64, f64)])
where
    T: Copy + std::ops::Add<Output = T> + std::ops::Mul<f64, Output = T>,
{
    for (j, (before, after)) in quotients.iter().enumerate().rev() {
        points[j + 1] = points[j] * *before + points[j + 1] * *after;
    }
}

/// De Boor's algorithm at both ends of a span.
///
/// Bézier point `m` is the blossom at `p - m` times the start and `m` times the end. Its first levels, at the start, are those of the point
/// before it too, and the quotients of a level are the same for all points.
struct Blossoms<'a> {
    knots: &'a KnotVector,
    /// The quotients `(end of the wider span - x, x - its start) / its length` of every level and point, `x` being the start of the span.
    at_start: Vec<(f64, f64)>,
    /// The same, `x` being the end of the span.
    at_end: Vec<(f64, f64)>,
}

impl<'a> Blossoms<'a> {
    fn new(knots: &'a KnotVector) -> Self {
        let pairs = knots.degree() * (knots.degree() + 1) / 2;
        Self { knots, at_start: Vec::with_capacity(pairs), at_end: Vec::with_capacity(pairs) }
    }

    fn enter(&mut self, span: Span) {
        let (p, t) = (self.knots.degree(), self.knots.as_slice());
        self.at_start.clear();
        self.at_end.clear();
        for r in 1..=p {
            for j in r..=p {
                let (a, b) = (t[span.index - p + j], t[span.index + 1 + j - r]);
                let length = b - a;
                self.at_start.push(((b - span.start) / length, (span.start - a) / length));
                self.at_end.push(((b - span.end) / length, (span.end - a) / length));
            }
        }
    }

    /// The Bézier points of the span from its `p + 1` control points, which are used up.
    fn bezier_points<T>(&self, points: &mut [T], out: &mut [T])
    where
        T: Copy + std::ops::Add<Output = T> + std::ops::Mul<f64, Output = T>,
    {
        let p = self.knots.degree();
        let mut first = 0;
        for r in 0..=p {
            // what is not filled yet is room for the levels at the end
            let work = &mut out[..=p - r];
            work.copy_from_slice(&points[r..]);
            let mut from = first;
            for active in (0..p - r).rev() {
                level(&mut work[p - r - active - 1..], &self.at_end[from..=from + active]);
                from += active + 1;
            }
            if r < p {
                level(&mut points[r..], &self.at_start[first..first + p - r]);
                first += p - r;
            }
        }
    }
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

/// Halves a Bézier net by de Casteljau's algorithm: `low` becomes its first half, and `high`, which is as long, its second.
///
/// # Accuracy
///
/// Exact but for one rounding a level.
///
/// # Panics
///
/// Where `high` is shorter than `low`, or both are empty.
pub fn halve<T: Copy + Add<Output = T> + Mul<f64, Output = T>>(low: &mut [T], high: &mut [T]) {
    let degree = low.len() - 1;
    high[degree] = low[degree];
    for k in 1..=degree {
        for i in (k..=degree).rev() {
            low[i] = (low[i - 1] + low[i]) * 0.5;
        }
        high[degree - k] = low[degree];
    }
}

/// The Bézier pieces of a curve with these knots and homogeneous control points, in ascending order.
#[must_use]
pub fn curve_pieces(knots: &KnotVector, net: &[DVec4]) -> Vec<BezierCurve> {
    let p = knots.degree();
    let mut blossoms = Blossoms::new(knots);
    let mut held = vec![DVec4::ZERO; p + 1];
    knots
        .spans()
        .map(|span| {
            blossoms.enter(span);
            held.copy_from_slice(&net[span.index - p..=span.index]);
            let mut points = vec![DVec4::ZERO; p + 1];
            blossoms.bezier_points(&mut held, &mut points);
            BezierCurve { points, span }
        })
        .collect()
}

/// The Bézier pieces of a surface with these knots and homogeneous net in row order; u-spans outermost, ascending.
#[must_use]
pub fn surface_pieces(u: &KnotVector, v: &KnotVector, net: &[DVec4]) -> Vec<BezierSurface> {
    let (p, q, columns) = (u.degree(), v.degree(), v.point_count());
    let along: Vec<(Span, Extraction)> = v.spans().map(|span| (span, extraction(v, span))).collect();
    let mut pieces = Vec::with_capacity(along.len() * u.spans().count());
    let mut strip = vec![DVec4::ZERO; (p + 1) * columns];
    for across in u.spans() {
        let first = (across.index - p) * columns;
        for (row, coefficients) in strip.chunks_exact_mut(columns).zip(extraction(u, across).rows()) {
            row.fill(DVec4::ZERO);
            for (c, points) in coefficients.iter().zip(net[first..].chunks_exact(columns)) {
                row.iter_mut().zip(points).for_each(|(sum, point)| *sum += *c * *point);
            }
        }
        for (span, matrix) in &along {
            let mut points = Vec::with_capacity((p + 1) * (q + 1));
            for row in strip.chunks_exact(columns) {
                let row = &row[span.index - q..=span.index];
                points.extend(matrix.rows().map(|coefficients| combine(coefficients, row)));
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
