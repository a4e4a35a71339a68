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

/// Degrees up to this one, of nearly all definitions, are evaluated by loops of known length.
pub(crate) const LOW_DEGREE: usize = 5;

/// Row `k` holds the `k`-th derivatives of the basis functions of degree `N - 1` on span `span`, at `u`, for `k < D`; `D` is at most 3.
///
/// A derivative is made of the quotients that the recursion for the values divides anyway (The NURBS Book, equation 2.7): as accurate as
/// [`derivatives`].
#[inline]
pub(crate) fn low<const N: usize, const D: usize>(knots: &KnotVector, span: usize, u: f64) -> [[f64; N]; D] {
    let p = N - 1;
    let t = &knots.as_slice()[span + 1 - p..=span + p];
    let (mut left, mut right) = ([0.0; N], [0.0; N]);
    for j in 1..N {
        left[j] = u - t[p - j];
        right[j] = t[p + j - 1] - u;
    }
    let mut rows = [[0.0; N]; D];
    // of the last step: each function of a degree less over the width that it is extended by; of the step before, the same
    let (mut shares, mut before, mut widths) = ([0.0; N], [0.0; N], [1.0; N]);
    rows[0][0] = 1.0;
    for j in 1..N {
        let mut saved = 0.0;
        before = shares;
        for r in 0..j {
            widths[r] = right[r + 1] + left[j - r];
            shares[r] = rows[0][r] / widths[r];
            rows[0][r] = saved + right[r + 1] * shares[r];
            saved = left[j - r] * shares[r];
        }
        rows[0][j] = saved;
    }
    // the derivatives of functions of a degree, from the quotients of those of a degree less
    let slope = |degree: usize, shares: &[f64; N], r: usize| {
        let (rises, falls) = (if r > 0 { shares[r - 1] } else { 0.0 }, if r < degree { shares[r] } else { 0.0 });
        degree as f64 * (rises - falls)
    };
    if D > 1 {
        rows[1] = std::array::from_fn(|r| slope(p, &shares, r));
    }
    if D > 2 {
        let slopes = std::array::from_fn(|r| if r < p { slope(p - 1, &before, r) / widths[r] } else { 0.0 });
        rows[2] = std::array::from_fn(|r| slope(p, &slopes, r));
    }
    // where the span interpolates a control point, the recursion gets 1 only up to rounding
    if left[p] == 0.0 || right[p] == 0.0 {
        rows[0] = [0.0; N];
        rows[0][if left[p] == 0.0 { 0 } else { p }] = 1.0;
    }
    rows
}

/// As [`low`], with one division in all where the span is a Bézier segment. It pays on curves; on surfaces the quotients of both directions
/// overlap, and it does not.
#[inline]
pub(crate) fn low_on_curve<const N: usize, const D: usize>(knots: &KnotVector, span: usize, u: f64) -> [[f64; N]; D] {
    let t = &knots.as_slice()[span + 2 - N..span + N];
    let (start, end) = (t[N - 2], t[N - 1]);
    if t[0] == start && t[2 * N - 3] == end { bernstein(start, end, u) } else { low(knots, span, u) }
}

/// The Bernstein polynomials of degree `N - 1` from `start` to `end`, with derivatives as in [`low`].
#[inline]
fn bernstein<const N: usize, const D: usize>(start: f64, end: f64, u: f64) -> [[f64; N]; D] {
    let p = N - 1;
    let inverse = 1.0 / (end - start);
    // exactly 0 and 1 at both ends
    let share = if u == end { 1.0 } else { (u - start) * inverse };
    let other = if u == start { 1.0 } else { (end - u) * inverse };
    let mut rows = [[0.0; N]; D];
    // the polynomials of one and of two degrees less
    let (mut lower, mut lowest) = ([0.0; N], [0.0; N]);
    let mut values = [0.0; N];
    values[0] = 1.0;
    for j in 1..N {
        (lowest, lower) = (lower, values);
        values[j] = share * lower[j - 1];
        for r in (1..j).rev() {
            values[r] = other * lower[r] + share * lower[r - 1];
        }
        values[0] = other * lower[0];
    }
    rows[0] = values;
    let at = |values: &[f64; N], r: usize, less: usize| if r >= less { values[r - less] } else { 0.0 };
    if D > 1 {
        let slope = p as f64 * inverse;
        rows[1] = std::array::from_fn(|r| slope * (at(&lower, r, 1) - at(&lower, r, 0)));
    }
    if D > 2 {
        let bend = (p * (p - 1)) as f64 * inverse * inverse;
        let difference = |r| at(&lowest, r, 2) - 2.0 * at(&lowest, r, 1) + at(&lowest, r, 0);
        rows[2] = std::array::from_fn(|r| bend * difference(r));
    }
    rows
}

/// The sum of all terms, each with its share.
#[inline]
pub(crate) fn sum<P, const N: usize>(shares: &[f64; N], term: impl Fn(usize) -> P) -> P
where
    P: std::ops::AddAssign + std::ops::Mul<f64, Output = P>,
{
    let mut sum = term(0) * shares[0];
    for (i, share) in shares.iter().enumerate().skip(1) {
        sum += term(i) * *share;
    }
    sum
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
    fn functions_of_known_degree_are_those_of_any() {
        fn compare<const N: usize>() {
            let p = N - 1;
            for inside in [vec![], vec![0.3, 0.5, 0.5], vec![0.4; p]] {
                let t = [vec![0.0; N], inside, vec![1.0; N]].concat();
                let points = t.len() - N;
                let knots = KnotVector::new(p, t, points, Along::Curve);
                // a double knot is one too many for the lowest degree
                let Ok(knots) = knots else { continue };
                for k in 0..=40 {
                    let u = f64::from(k) / 40.0;
                    let span = knots.find_span(u);
                    let mut table = [[0.0; ROOM]; ROOM];
                    derivatives(&knots, span, u, 2.min(p), &mut table);
                    let values = functions::<ROOM>(&knots, span, u);
                    for rows in [low::<N, 3>(&knots, span, u), low_on_curve::<N, 3>(&knots, span, u)] {
                        for (row, expected) in rows.iter().zip(&table) {
                            let largest = expected.iter().fold(0.0_f64, |largest, b| largest.max(b.abs()));
                            assert!((0..N).all(|r| (row[r] - expected[r]).abs() <= 1e-14 * largest), "{p} {u}");
                        }
                        // exactly 1 where a control point is met
                        assert!((0..N).all(|r| values[r] != 1.0 || rows[0][r] == 1.0), "{p} {u}");
                    }
                }
            }
        }
        compare::<2>();
        compare::<3>();
        compare::<4>();
        compare::<5>();
        compare::<6>();
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
