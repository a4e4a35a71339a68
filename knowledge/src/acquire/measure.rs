//! Arc length and area.

use glam::DVec3;
use perpend_kernel::{Definition, Direction, NurbsCurve, NurbsSurface};

use super::bernstein::Side;
use super::source::{Piece, Source};

/// Parts into which a curve is cut to measure it.
const PARTS: usize = 1024;

/// Points of a surface at which its area element is taken.
const POINTS: usize = 200_000;

/// The arc length, and a proven bound of its error.
///
/// Gauss-Legendre quadrature of the speed over parts of the Bézier pieces; the [`enclosure`] by the same parts proves the bound,
/// and the value is usually far better.
pub(super) fn length(curve: &NurbsCurve, source: &Source) -> (f64, f64) {
    let rule = gauss(8);
    let parts = parts(source, PARTS);
    let mut value = 0.0;
    for part in &parts {
        let (from, to) = (part.from.0, part.to.0);
        for (x, weight) in &rule {
            let mut d = [DVec3::ZERO; 2];
            curve.derivatives(from + (to - from) * x, &mut d);
            value += weight * (to - from) * d[1].length();
        }
    }
    let (least, greatest) = between(source, &parts);
    let value = value.clamp(least, greatest);
    (value, (value - least).max(greatest - value))
}

/// Bounds of the arc length of a curve by about `count` parts: each is no shorter than its chord and no longer than its control
/// polygon (weights are positive).
pub(crate) fn enclosure(definition: &Definition, count: usize) -> (f64, f64) {
    let source = Source::of(definition);
    between(&source, &parts(&source, count))
}

fn parts(source: &Source, count: usize) -> Vec<Piece> {
    let mut parts: Vec<Piece> = source.pieces().collect();
    while 2 * parts.len() <= count {
        parts = parts.into_iter().map(|part| part.halves(Side::First)).flat_map(|(a, b)| [a, b]).collect();
    }
    parts
}

fn between(source: &Source, parts: &[Piece]) -> (f64, f64) {
    let (mut least, mut greatest) = (0.0, 0.0);
    for part in parts {
        let points: Vec<DVec3> = part.points().collect();
        least += points[0].distance(points[points.len() - 1]);
        greatest += points.windows(2).map(|side| side[0].distance(side[1])).sum::<f64>();
    }
    let p = source.degree().0;
    let rounding = 16.0 * (p + 4) as f64 * f64::EPSILON * source.reach * parts.len() as f64;
    ((least - rounding).max(0.0), greatest + rounding)
}

/// The area, and the difference that finer cells make to it.
///
/// Gauss-Legendre quadrature over the pairs of spans, then over quarters of them. Not proven.
pub(super) fn area(surface: &NurbsSurface) -> (f64, f64) {
    let spans = |direction| surface.knots(direction).spans().map(|s| (s.start, s.end)).collect::<Vec<_>>();
    let (u, v) = (spans(Direction::U), spans(Direction::V));
    let order = ((POINTS / (5 * u.len() * v.len())) as f64).sqrt() as usize;
    let rule = gauss(order.clamp(2, 8));
    let sum = |u: &[(f64, f64)], v: &[(f64, f64)]| {
        let mut sum = 0.0;
        for (u0, u1) in u {
            for (v0, v1) in v {
                for (x, a) in &rule {
                    for (y, b) in &rule {
                        let element = surface.normal(u0 + (u1 - u0) * x, v0 + (v1 - v0) * y).length();
                        sum += a * b * (u1 - u0) * (v1 - v0) * element;
                    }
                }
            }
        }
        sum
    };
    let halves = |spans: &[(f64, f64)]| {
        let halves = |(a, b): &(f64, f64)| [(*a, 0.5 * a + 0.5 * b), (0.5 * a + 0.5 * b, *b)];
        spans.iter().flat_map(halves).collect::<Vec<_>>()
    };
    let (coarse, fine) = (sum(&u, &v), sum(&halves(&u), &halves(&v)));
    (fine, (fine - coarse).abs())
}

/// The nodes in `[0, 1]` and the weights of Gauss-Legendre quadrature, by Newton's method on the Legendre polynomial.
fn gauss(n: usize) -> Vec<(f64, f64)> {
    let node = |k: usize| {
        let mut x = ((k as f64 + 0.75) / (n as f64 + 0.5) * std::f64::consts::PI).cos();
        let mut slope = 1.0;
        for _ in 0..8 {
            let (mut before, mut value) = (1.0, x);
            for j in 2..=n {
                let j = j as f64;
                (before, value) = (value, ((2.0 * j - 1.0) * x * value - (j - 1.0) * before) / j);
            }
            slope = n as f64 * (x * value - before) / (x * x - 1.0);
            x -= value / slope;
        }
        (0.5 - 0.5 * x, 1.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..n).map(node).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use perpend_kernel::{Circle, Frame, Sphere};
    use std::f64::consts::{PI, TAU};

    #[test]
    fn a_circle_has_its_circumference_within_the_proven_gap() {
        let circle = Circle::new(Frame::WORLD, 2.0, (0.0, TAU)).expect("valid").to_nurbs().expect("valid");
        let (value, gap) = length(&circle, &Source::of(&Definition::from(circle.clone())));
        assert!((value - 2.0 * TAU).abs() < 1e-12 && gap < 1e-4, "{value} {gap}");
    }

    #[test]
    fn a_sphere_has_its_area() {
        let sphere = Sphere::new(Frame::WORLD, 1.5, (-PI / 2.0, PI / 2.0), (0.0, TAU)).expect("valid");
        let (value, error) = area(&sphere.to_nurbs().expect("valid"));
        assert!((value - 9.0 * PI).abs() < 1e-9 && error < 1e-6, "{value} {error}");
    }
}
