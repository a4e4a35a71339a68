//! The same set of points in another form: other parameters, degrees, knots, directions; and one that is a little off.

use glam::DVec3;
use perpend::{Definition, Direction, NurbsCurve, NurbsSurface};

use super::random::Random;

/// The control values of a curve over new knots, where the parameter `u` is `k t / (1 + (k - 1) t)` of the new `t` in `[0, 1]`:
/// homogeneous points are multiplied by the factor's values at their knots.
fn projective(degree: usize, knots: &[f64], k: f64) -> (Vec<f64>, Vec<f64>) {
    let (a, b) = (knots[0], knots[knots.len() - 1]);
    let new: Vec<f64> = knots
        .iter()
        .map(|t| {
            let u = (t - a) / (b - a);
            u / (u + k * (1.0 - u))
        })
        .collect();
    let count = knots.len() - degree - 1;
    let factor = |i: usize| (1..=degree).map(|j| 1.0 + (k - 1.0) * new[i + j]).product::<f64>();
    let factors = (0..count).map(factor).collect();
    (new, factors)
}

/// A curve that runs through the same points at `k` times its speed at the start.
pub fn reparametrised_curve(curve: &NurbsCurve, k: f64) -> NurbsCurve {
    let (knots, factors) = projective(curve.degree(), curve.knots().as_slice(), k);
    let weight = |i: usize| curve.weights().map_or(1.0, |w| w[i]);
    let weights = factors.iter().enumerate().map(|(i, f)| f * weight(i)).collect();
    NurbsCurve::new(curve.degree(), knots, curve.control_points().to_vec(), Some(weights)).expect("valid")
}

/// As [`reparametrised_curve`], in u and in v.
pub fn reparametrised_surface(surface: &NurbsSurface, k: (f64, f64)) -> NurbsSurface {
    let (p, q) = surface.degree();
    let (u, along) = projective(p, surface.knots(Direction::U).as_slice(), k.0);
    let (v, across) = projective(q, surface.knots(Direction::V).as_slice(), k.1);
    let columns = surface.columns();
    let weight = |i: usize, j: usize| surface.weights().map_or(1.0, |w| w[i * columns + j]) * along[i] * across[j];
    let weights = (0..surface.rows()).map(|i| (0..columns).map(|j| weight(i, j)).collect()).collect();
    let points = surface.control_points().chunks(columns).map(<[DVec3]>::to_vec).collect();
    NurbsSurface::new((p, q), (u, v), points, Some(weights)).expect("valid")
}

/// The same set of points in another form.
pub fn disguised(random: &mut Random, definition: &Definition) -> Definition {
    let inside = |random: &mut Random, (a, b): (f64, f64)| a + (b - a) * random.between(0.1, 0.9);
    match definition {
        Definition::NurbsCurve(curve) => {
            let mut curve = reparametrised_curve(curve, random.power(-0.5, 0.5));
            let by = random.count(0, 5);
            if by > 0 {
                curve = curve.elevate_degree(by).expect("a degree within the limit");
            }
            for _ in 0..random.count(0, 3) {
                curve = curve.insert_knot(inside(random, curve.domain()), 1).expect("inside");
            }
            if random.chance(0.5) { curve.reversed().into() } else { curve.into() }
        }
        Definition::NurbsSurface(surface) => {
            let mut surface = reparametrised_surface(surface, (random.power(-0.5, 0.5), random.power(-0.5, 0.5)));
            for direction in [Direction::U, Direction::V] {
                let by = random.count(0, 5);
                if by > 0 {
                    surface = surface.elevate_degree(direction, by).expect("a degree within the limit");
                }
                for _ in 0..random.count(0, 2) {
                    let at = inside(random, surface.domain(direction));
                    surface = surface.insert_knot(direction, at, 1).expect("inside");
                }
                if random.chance(0.5) {
                    surface = surface.reversed(direction);
                }
            }
            if random.chance(0.5) { surface.swapped().into() } else { surface.into() }
        }
    }
}

/// The definition with one control point moved by `off`.
pub fn moved(random: &mut Random, definition: &Definition, off: f64) -> Definition {
    let step = off * random.direction();
    match definition {
        Definition::NurbsCurve(curve) => {
            let mut points = curve.control_points().to_vec();
            let k = random.count(0, points.len() - 1);
            points[k] += step;
            let knots = curve.knots().as_slice().to_vec();
            NurbsCurve::new(curve.degree(), knots, points, curve.weights().map(<[f64]>::to_vec)).expect("valid").into()
        }
        Definition::NurbsSurface(surface) => {
            let mut points = surface.control_points().to_vec();
            let k = random.count(0, points.len() - 1);
            points[k] += step;
            let columns = surface.columns();
            let knots = [Direction::U, Direction::V].map(|d| surface.knots(d).as_slice().to_vec());
            let [u, v] = knots;
            let rows = points.chunks(columns).map(<[DVec3]>::to_vec).collect();
            let weights = surface.weights().map(|w| w.chunks(columns).map(<[f64]>::to_vec).collect());
            NurbsSurface::new(surface.degree(), (u, v), rows, weights).expect("valid").into()
        }
    }
}
