//! A lower bound of a form that is convex in one direction only: a valley whose floor may be level, as about a centre, an axis or a spine, where
//! every foot along a line is as near.
//!
//! With `Gss >= a > 0` on the box, for any `s0`,
//!
//! ```text
//! G(s, t) >= G(s0, t) + Gs(s0, t) (s - s0) + a (s - s0)² / 2 >= G(s0, t) - Gs(s0, t)² / 2a
//! ```
//!
//! and the restrictions of `G` and `Gs` to the line are polynomials in `t`, at least the least and at most the largest of their coefficients.

use super::ROUNDING;
use super::net::Layout;

/// The least that the form with the net `g` can be, seen from the line at `at` of its first variable (`in_s`) or of its second, in the box's own
/// parameters, where `bend` is a lower bound of the second differences across the line, positive. `scratch` is working memory.
///
/// Every coefficient of the true form differs from its `g` by at most `rounding`. The restriction takes convex combinations, three roundings a
/// level, of numbers that are at most `largest`.
pub(super) fn least_beside(
    (g, layout): (&[f64], Layout),
    in_s: bool,
    at: f64,
    bend: f64,
    (rounding, largest): (f64, f64),
    scratch: &mut Vec<f64>,
) -> f64 {
    let (degree, across) = if in_s { (layout.m, layout.n) } else { (layout.n, layout.m) };
    let index = |k: usize, l: usize| if in_s { layout.at(k, l) } else { layout.at(l, k) };
    let grown = rounding + 3.0 * degree as f64 * ROUNDING * largest;
    let (mut floor, mut slope) = (f64::INFINITY, 0.0_f64);
    for l in 0..=across {
        scratch.clear();
        scratch.extend((0..=degree).map(|k| g[index(k, l)]));
        // de Casteljau's algorithm down to the last two points, whose difference is the slope
        for left in (2..=degree).rev() {
            for k in 0..left {
                scratch[k] = (1.0 - at) * scratch[k] + at * scratch[k + 1];
            }
        }
        let (value, rise) = ((1.0 - at) * scratch[0] + at * scratch[1], (scratch[1] - scratch[0]).abs());
        // a NaN must not be passed over: it proves nothing
        if !(value.is_finite() && rise.is_finite()) {
            return f64::NEG_INFINITY;
        }
        (floor, slope) = (floor.min(value), slope.max(rise));
    }
    let curvature = bend * (degree * (degree - 1)) as f64;
    let steepest = (slope + 2.0 * grown) * degree as f64;
    floor - grown - steepest * steepest / (2.0 * curvature)
}

#[cfg(test)]
mod tests {
    use super::super::double_double::Random;
    use super::super::net::{self, tests::laid_out};
    use super::*;
    use fearless_simd::{Level, dispatch};
    use perpend_kernel::binomial;

    /// Values of random valleys `c + (s - a)² (1 + b t) + noise` are never below the bound, and a level floor is found to the noise.
    #[test]
    fn no_value_is_below_the_bound_and_a_level_floor_is_met() {
        let mut random = Random(31);
        let (m, n) = (4, 6);
        let layout = Layout { m, n };
        for round in 0..200 {
            let (a, b) = (random.between(0.0, 1.0), random.between(-0.5, 0.5));
            let noise = if round % 2 == 0 { 0.0 } else { 1e-3 };
            // Bernstein coefficients of s, s² and t
            let s1 = |i: usize| i as f64 / m as f64;
            let s2 = |i: usize| (i * i.saturating_sub(1)) as f64 / (m * (m - 1)) as f64;
            let t1 = |j: usize| j as f64 / n as f64;
            let plain: Vec<f64> = (0..=m)
                .flat_map(|i| (0..=n).map(move |j| (i, j)))
                .map(|(i, j)| {
                    let square = s2(i) - 2.0 * a * s1(i) + a * a;
                    0.25 + square * (1.0 + b * t1(j)) + noise * random.between(-1.0, 1.0)
                })
                .collect();
            let value = |s: f64, t: f64| {
                let basis =
                    |d: usize, k: usize, x: f64| binomial(d, k) * x.powi(k as i32) * (1.0 - x).powi((d - k) as i32);
                let terms = plain.iter().enumerate();
                terms.map(|(e, g)| g * basis(m, e / (n + 1), s) * basis(n, e % (n + 1), t)).sum::<f64>()
            };
            let g = laid_out(layout, &plain);
            let differences = dispatch!(Level::new(), simd => net::differences(simd, &g, net::Any(layout)));
            if differences.down <= 0.0 {
                assert!(noise > 0.0, "a smooth valley is convex across");
                continue;
            }
            let bound = least_beside((&g, layout), true, a, differences.down, (0.0, 2.0), &mut Vec::new());
            if noise == 0.0 {
                assert!((0.25 - bound).abs() < 1e-13, "{bound}");
            }
            for k in 0..400 {
                let (s, t) = (f64::from(k % 20) / 19.0, f64::from(k / 20) / 19.0);
                assert!(value(s, t) >= bound - 1e-14, "{} below {bound}", value(s, t));
            }
        }
    }
}
