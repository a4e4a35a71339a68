//! Evaluation straight from Cox and de Boor's definition, over all basis functions, for clamped and other knots.

use perpend_kernel::glam::{DVec3, DVec4};
use perpend_kernel::{Direction, NurbsCurve, NurbsSurface};

/// All basis functions of degree `p` at `u` of a curve of degree `whole`; the end of the domain belongs to the last span that
/// is not empty.
fn of_degree(p: usize, t: &[f64], u: f64, whole: usize) -> Vec<f64> {
    let last = t[t.len() - whole - 1];
    let holds = |i: usize| t[i] < t[i + 1] && t[i] <= u && (u < t[i + 1] || (u == last && t[i + 1] == u));
    let mut values: Vec<f64> = (0..t.len() - 1).map(|i| f64::from(u8::from(holds(i)))).collect();
    if u == last {
        // knots may go on past the domain: one span alone holds its end
        let span = values.iter().position(|value| *value > 0.0);
        values.iter_mut().enumerate().for_each(|(i, value)| *value = f64::from(u8::from(Some(i) == span)));
    }
    for k in 1..=p {
        let part = |top: f64, width: f64| if width > 0.0 { top / width } else { 0.0 };
        values = (0..t.len() - 1 - k)
            .map(|i| {
                part(u - t[i], t[i + k] - t[i]) * values[i]
                    + part(t[i + k + 1] - u, t[i + k + 1] - t[i + 1]) * values[i + 1]
            })
            .collect();
    }
    values
}

/// All basis functions of degree `p` at `u`.
pub(crate) fn functions(p: usize, t: &[f64], u: f64) -> Vec<f64> {
    of_degree(p, t, u, p)
}

/// The `k`-th derivatives of all basis functions at `u`: The NURBS Book, equation 2.7, again and again.
pub(crate) fn derived_functions(p: usize, t: &[f64], u: f64, k: usize) -> Vec<f64> {
    let part = |value: f64, width: f64| if width > 0.0 { value / width } else { 0.0 };
    let mut values = of_degree(p - k, t, u, p);
    for n in p - k + 1..=p {
        values = (0..t.len() - n - 1)
            .map(|i| n as f64 * (part(values[i], t[i + n] - t[i]) - part(values[i + 1], t[i + n + 1] - t[i + 1])))
            .collect();
    }
    values
}

/// How large the `k`-th derivatives of the basis functions become over the span of `u`: a Taylor bound, for `k = 0..=p`.
///
/// The rounding of `u` against the ends of its span moves a derivative by `ε` of this, not of its value at `u`.
pub(crate) fn sizes(p: usize, t: &[f64], u: f64) -> Vec<f64> {
    let after = t.partition_point(|knot| *knot <= u).min(t.len() - p - 1);
    let before = t[..after].partition_point(|knot| *knot < t[after]) - 1;
    let width = t[after] - t[before];
    let here: Vec<f64> = (0..=p).map(|k| derived_functions(p, t, u, k).iter().map(|b| b.abs()).sum()).collect();
    (0..=p).map(|k| here[k..].iter().rev().fold(0.0, |sum, size| sum * width + size)).collect()
}

/// The point of a curve's data at `u`.
pub(crate) fn curve_point(p: usize, t: &[f64], points: &[DVec3], weights: Option<&[f64]>, u: f64) -> DVec3 {
    let sum: DVec4 = functions(p, t, u)
        .into_iter()
        .enumerate()
        .map(|(i, b)| {
            let w = weights.map_or(1.0, |w| w[i]);
            (b * w * points[i]).extend(b * w)
        })
        .sum();
    sum.truncate() / sum.w
}

/// The point of a curve at `u`.
pub(crate) fn at(curve: &NurbsCurve, u: f64) -> DVec3 {
    curve_point(curve.degree(), curve.knots().as_slice(), curve.control_points(), curve.weights(), u)
}

/// The point of a surface at `(u, v)`.
pub(crate) fn surface_at(surface: &NurbsSurface, u: f64, v: f64) -> DVec3 {
    let (p, q) = surface.degree();
    let across = functions(p, surface.knots(Direction::U).as_slice(), u);
    let along = functions(q, surface.knots(Direction::V).as_slice(), v);
    let mut sum = DVec4::ZERO;
    for (i, a) in across.iter().enumerate() {
        for (j, b) in along.iter().enumerate() {
            let k = i * surface.columns() + j;
            let w = surface.weights().map_or(1.0, |w| w[k]);
            sum += (a * b * w * surface.control_points()[k]).extend(a * b * w);
        }
    }
    sum.truncate() / sum.w
}
