//! Small linear least squares.

/// The shares `x` of the columns that come nearest to `right`.
///
/// Columns are made orthogonal one after the other, each twice (Gram–Schmidt; Björck, Numerical Methods for Least Squares
/// Problems, §2.4), so that conditions are not squared as by normal equations. A column that depends on those before it gets
/// the share 0. None where numbers overflow.
pub(super) fn least_squares<const N: usize>(mut columns: [Vec<f64>; N], mut right: Vec<f64>) -> Option<[f64; N]> {
    // r[k] holds column k of the triangle
    let mut r = [[0.0; N]; N];
    for (k, triangle) in r.iter_mut().enumerate() {
        let (earlier, rest) = columns.split_at_mut(k);
        let column = &mut rest[0];
        let before = dot(column, column).sqrt();
        for _ in 0..2 {
            for (i, q) in earlier.iter().enumerate() {
                let share = dot(q, column);
                triangle[i] += share;
                column.iter_mut().zip(q).for_each(|(x, y)| *x -= share * y);
            }
        }
        let norm = dot(column, column).sqrt();
        if norm > 1e-14 * before {
            triangle[k] = norm;
            column.iter_mut().for_each(|x| *x /= norm);
        } else {
            column.fill(0.0);
        }
    }
    let shares = columns.each_ref().map(|q| {
        let share = dot(q, &right);
        right.iter_mut().zip(q).for_each(|(x, y)| *x -= share * y);
        share
    });
    let mut x = [0.0; N];
    for k in (0..N).rev() {
        if r[k][k] > 0.0 {
            let known: f64 = (k + 1..N).map(|i| r[i][k] * x[i]).sum();
            x[k] = (shares[k] - known) / r[k][k];
        }
    }
    x.iter().all(|x| x.is_finite()).then_some(x)
}

/// The scalar product, in four sums: one alone would wait for each of its additions.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (mut sums, (a, rest_a), (b, rest_b)) = ([0.0; 4], a.as_chunks::<4>(), b.as_chunks::<4>());
    for (x, y) in a.iter().zip(b) {
        for k in 0..4 {
            sums[k] += x[k] * y[k];
        }
    }
    let rest: f64 = rest_a.iter().zip(rest_b).map(|(x, y)| x * y).sum();
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}
