//! Small linear least squares.

/// The shares `x` of the columns that come nearest to `right`.
///
/// Columns are made orthogonal one after the other, each twice (Gram–Schmidt; Björck, Numerical Methods for Least Squares
/// Problems, §2.4), so that conditions are not squared as by normal equations. A column that depends on those before it gets
/// the share 0. None where numbers overflow.
pub(super) fn least_squares(mut columns: Vec<Vec<f64>>, mut right: Vec<f64>) -> Option<Vec<f64>> {
    let n = columns.len();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
    // r[k] holds column k of the triangle
    let mut r = vec![vec![0.0; n]; n];
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
    let shares: Vec<f64> = columns
        .iter()
        .map(|q| {
            let share = dot(q, &right);
            right.iter_mut().zip(q).for_each(|(x, y)| *x -= share * y);
            share
        })
        .collect();
    let mut x = vec![0.0; n];
    for k in (0..n).rev() {
        if r[k][k] > 0.0 {
            let known: f64 = (k + 1..n).map(|i| r[i][k] * x[i]).sum();
            x[k] = (shares[k] - known) / r[k][k];
        }
    }
    x.iter().all(|x| x.is_finite()).then_some(x)
}
