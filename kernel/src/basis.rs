//! B-spline basis functions and their derivatives, on the stack.

use crate::knots::{KnotVector, MAX_DEGREE};

/// Room for the basis functions of the highest degree.
pub(crate) const ROOM: usize = MAX_DEGREE + 1;

/// The `degree + 1` basis functions that do not vanish on span `span`, at `u`.
///
/// The NURBS Book, algorithm A2.2 (equation 2.5 without the terms that are known to vanish). `R` is the room, more than the degree, as
/// for [`derivatives`].
pub(crate) fn functions<const R: usize>(knots: &KnotVector, span: usize, u: f64) -> [f64; R] {
    let (p, t) = (knots.degree(), knots.as_slice());
    let mut values = [0.0; R];
    if let Some(only) = interpolated(knots, span, u) {
        values[only] = 1.0;
        return values;
    }
    let (mut left, mut right) = ([0.0; R], [0.0; R]);
    values[0] = 1.0;
    for j in 1..=p {
        left[j] = u - t[span + 1 - j];
        right[j] = t[span + j] - u;
        let mut saved = 0.0;
        for r in 0..j {
            let share = values[r] / (right[r + 1] + left[j - r]);
            values[r] = saved + right[r + 1] * share;
            saved = left[j - r] * share;
        }
        values[j] = saved;
    }
    values
}

/// Rows `k = 0..=order` of `table` become the `k`-th derivatives of the basis functions on `span` at `u`;
/// `order` is at most the degree.
///
/// The functions of degree `p - k` are differentiated `k` times by The NURBS Book, equation 2.7: as accurate as its algorithm
/// A2.3 and shorter. The error is a few ε of the largest that the derivatives become on the span.
///
/// `R` is the room, more than the degree: small tables for low degrees, since clearing the largest takes longer than filling it.
pub(crate) fn derivatives<const R: usize>(
    knots: &KnotVector,
    span: usize,
    u: f64,
    order: usize,
    table: &mut [[f64; R]; R],
) {
    let (p, t) = (knots.degree(), knots.as_slice());
    debug_assert!(order <= p, "derivatives beyond the degree vanish");
    // column j of the upper triangle: the functions of degree j; row j of the lower: the widths that degree j - 1 extends over
    let mut ndu = [[0.0; R]; R];
    let (mut left, mut right) = ([0.0; R], [0.0; R]);
    ndu[0][0] = 1.0;
    for j in 1..=p {
        left[j] = u - t[span + 1 - j];
        right[j] = t[span + j] - u;
        let mut saved = 0.0;
        for r in 0..j {
            ndu[j][r] = right[r + 1] + left[j - r];
            let share = ndu[r][j - 1] / ndu[j][r];
            ndu[r][j] = saved + right[r + 1] * share;
            saved = left[j - r] * share;
        }
        ndu[j][j] = saved;
    }
    for (k, row) in table.iter_mut().enumerate().take(order + 1) {
        for (r, value) in row.iter_mut().enumerate().take(p - k + 1) {
            *value = ndu[r][p - k];
        }
        for degree in p - k + 1..=p {
            let mut before = 0.0;
            for r in 0..degree {
                let slope = degree as f64 * row[r] / ndu[degree][r];
                row[r] = before - slope;
                before = slope;
            }
            row[degree] = before;
        }
    }
    if let Some(only) = interpolated(knots, span, u) {
        table[0] = [0.0; R];
        table[0][only] = 1.0;
    }
}

/// The one basis function of the span that is 1 at `u`, if `u` is an end of the span with a knot of at least the degree's
/// multiplicity: there the curve passes its control point. The recursion alone gets 1 only up to rounding.
fn interpolated(knots: &KnotVector, span: usize, u: f64) -> Option<usize> {
    let (p, t) = (knots.degree(), knots.as_slice());
    if u == t[span] && t[span + 1 - p] == u {
        Some(0)
    } else if u == t[span + 1] && t[span + p] == u {
        Some(p)
    } else {
        None
    }
}

/// Pascal's triangle as far as its numbers are exact.
static TRIANGLE: [[f64; EXACT + 1]; EXACT + 1] = {
    let mut triangle = [[0.0; EXACT + 1]; EXACT + 1];
    let mut n = 0;
    while n <= EXACT {
        triangle[n][0] = 1.0;
        let mut k = 1;
        while k <= n {
            triangle[n][k] = triangle[n - 1][k - 1] + triangle[n - 1][k];
            k += 1;
        }
        n += 1;
    }
    triangle
};

/// Twice the highest degree.
const EXACT: usize = 2 * MAX_DEGREE;

/// The binomial coefficient `n` over `k` as a floating-point number, 0 where `k` exceeds `n`: exact for `n` up to 50.
#[must_use]
pub fn binomial(n: usize, k: usize) -> f64 {
    if k > n {
        return 0.0;
    }
    if n <= EXACT {
        return TRIANGLE[n][k];
    }
    (0..k.min(n - k)).fold(1.0, |c, i| (c * (n - i) as f64 / (i + 1) as f64).round())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::invalid::Along;

    #[test]
    fn derivative_rows_are_the_derivatives_of_the_functions() {
        let t = vec![0.0, 0.0, 0.0, 0.0, 0.3, 0.55, 0.55, 1.0, 1.0, 1.0, 1.0];
        let knots = KnotVector::new(3, t, 7, Along::Curve).expect("valid");
        let (h, u) = (1e-5, 0.41);
        let span = knots.find_span(u);
        let mut table = [[0.0; ROOM]; ROOM];
        derivatives(&knots, span, u, 3, &mut table);
        let (before, after) = (functions::<ROOM>(&knots, span, u - h), functions::<ROOM>(&knots, span, u + h));
        for j in 0..=3 {
            assert!((table[0][j] - functions::<ROOM>(&knots, span, u)[j]).abs() < 1e-15);
            assert!((table[1][j] - (after[j] - before[j]) / (2.0 * h)).abs() < 1e-8);
        }
        for row in &table[1..=3] {
            assert!(row[..=3].iter().sum::<f64>().abs() < 1e-11, "derivatives of a partition of unity add up to 0");
        }
    }

    #[test]
    fn binomials_are_exact() {
        assert_eq!(binomial(50, 25), 126_410_606_437_752.0);
        assert_eq!(binomial(5, 0), 1.0);
        assert_eq!(binomial(3, 4), 0.0);
        // beyond the table by another formula, which continues it
        let of_the_next = |k: usize| binomial(50, k - 1) + binomial(50, k);
        assert!((1..51).all(|k| (binomial(51, k) / of_the_next(k) - 1.0).abs() < 1e-15));
    }
}
