//! Where a vector-valued polynomial in one parameter may vanish.

use super::bernstein::Side;
use super::near::Near;
use glam::DVec3;

/// Halvings: a zero is known to this power of 2 of the interval.
const DEEPEST: u32 = 42;

/// Stretches of the unit interval outside of which the polynomial is longer than `least`, ascending: almost always points up
/// to rounding. None where `parts` parts do not settle it.
///
/// A part is left out where one direction makes a product above `least` with all coefficients: the values are among their
/// convex combinations.
pub(super) fn zeros(form: &Near<DVec3>, least: f64, parts: usize) -> Option<Vec<(f64, f64)>> {
    let mut found: Vec<(f64, f64)> = Vec::new();
    let mut open = vec![(form.clone(), 0.0, 1.0, 0)];
    let mut looked = 0;
    while let Some((part, from, to, depth)) = open.pop() {
        looked += 1;
        if part.least() > least {
            continue;
        }
        if depth >= DEEPEST || part.longest() <= least + part.error {
            match found.last_mut() {
                Some(last) if from - last.1 <= 1e-9 => last.1 = to,
                _ => found.push((from, to)),
            }
            continue;
        }
        if looked >= parts {
            return None;
        }
        let middle = 0.5 * (from + to);
        let (lower, upper) = part.halves(Side::First);
        open.push((upper, middle, to, depth + 1));
        open.push((lower, from, middle, depth + 1));
    }
    Some(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::acquire::bernstein::Form;

    #[test]
    fn zeros_are_found_and_nothing_else() {
        // (t - 1/4)(t - 3/4) along x: 3/16 - t + t²
        let line = |c: [f64; 3]| Near {
            form: Form { degree: (2, 0), coefficients: c.map(|x| DVec3::X * x).to_vec() },
            error: 1e-16,
        };
        let found = zeros(&line([3.0 / 16.0, -5.0 / 16.0, 3.0 / 16.0]), 1e-15, 4096).expect("settled");
        assert_eq!(found.len(), 2);
        for ((from, to), at) in found.iter().zip([0.25, 0.75]) {
            assert!(*from <= at && at <= *to && to - from < 1e-9);
        }
        assert_eq!(zeros(&line([1.0, 0.5, 1.0]), 1e-15, 4096), Some(Vec::new()));
        assert_eq!(zeros(&line([3.0 / 16.0, -5.0 / 16.0, 3.0 / 16.0]), 1e-15, 10), None);
    }
}
