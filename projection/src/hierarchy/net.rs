//! Signs and differences of a scalar Bernstein net, and its halves.
//!
//! A net of degree `(m, n)` has `(m + 1)(n + 1)` coefficients in row order; a polynomial in one variable is a net with `m = 0` or
//! `n = 0`. Extremes are taken in eight lanes: `f64::min` would keep the loops from being vectorised.

const LANES: usize = 8;

fn smaller(a: f64, b: f64) -> f64 {
    if b < a { b } else { a }
}

fn larger(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}

/// The least coefficient and the largest |coefficient|.
pub(super) fn extremes(g: &[f64]) -> (f64, f64) {
    let (mut low, mut high) = ([f64::INFINITY; LANES], [0.0; LANES]);
    let chunks = g.chunks_exact(LANES);
    let rest = chunks.remainder();
    for chunk in chunks {
        for k in 0..LANES {
            low[k] = smaller(low[k], chunk[k]);
            high[k] = larger(high[k], chunk[k].abs());
        }
    }
    for (k, x) in rest.iter().enumerate() {
        low[k] = smaller(low[k], *x);
        high[k] = larger(high[k], x.abs());
    }
    (low.into_iter().fold(f64::INFINITY, smaller), high.into_iter().fold(0.0, larger))
}

/// The least coefficient.
pub(super) fn least(g: &[f64]) -> f64 {
    g.iter().copied().fold(f64::INFINITY, smaller)
}

/// The largest coefficient.
pub(super) fn most(g: &[f64]) -> f64 {
    g.iter().copied().fold(f64::NEG_INFINITY, larger)
}

/// The least of `a[i] - b[i]`.
fn least_difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a - b).fold(f64::INFINITY, smaller)
}

/// How far every row of the net stays above row `at`: the least difference, negative where one falls below.
pub(super) fn rows_above(g: &[f64], width: usize, at: usize) -> f64 {
    let edge = &g[at * width..(at + 1) * width];
    let rows = g.chunks_exact(width).enumerate().filter(|(i, _)| *i != at);
    rows.map(|(_, row)| least_difference(row, edge)).fold(f64::INFINITY, smaller)
}

/// How far every column of the net stays above column `at`. May stop early, with some value below `enough`, once it falls
/// below that.
pub(super) fn columns_above(g: &[f64], width: usize, at: usize, enough: f64) -> f64 {
    let mut low = f64::INFINITY;
    for row in g.chunks_exact(width) {
        for (j, x) in row.iter().enumerate() {
            if j != at {
                low = smaller(low, x - row[at]);
            }
        }
        if low < enough {
            break;
        }
    }
    low
}

/// The least second difference down the columns: `g[i] - 2 g[i + 1] + g[i + 2]`.
pub(super) fn least_second_down(g: &[f64], width: usize) -> f64 {
    let n = g.len() - 2 * width;
    let (a, b, c) = (&g[..n], &g[width..width + n], &g[2 * width..]);
    let mut low = f64::INFINITY;
    for i in 0..n {
        low = smaller(low, a[i] - 2.0 * b[i] + c[i]);
    }
    low
}

/// The least second difference along the rows.
pub(super) fn least_second_along(g: &[f64], width: usize) -> f64 {
    let mut low = f64::INFINITY;
    for row in g.chunks_exact(width) {
        for w in row.windows(3) {
            low = smaller(low, w[0] - 2.0 * w[1] + w[2]);
        }
    }
    low
}

/// The largest |mixed difference|: `g[i][j] - g[i + 1][j] - g[i][j + 1] + g[i + 1][j + 1]`.
pub(super) fn largest_mixed(g: &[f64], width: usize) -> f64 {
    let mut high = 0.0;
    for (a, b) in g.chunks_exact(width).zip(g[width..].chunks_exact(width)) {
        for j in 0..width - 1 {
            high = larger(high, (a[j] - a[j + 1] - b[j] + b[j + 1]).abs());
        }
    }
    high
}

/// Whether the net varies more down its columns than along its rows, by second differences and degrees.
pub(super) fn bends_more_down(g: &[f64], m: usize, n: usize) -> bool {
    let width = n + 1;
    let second = |a: f64, b: f64, c: f64| (a - 2.0 * b + c).abs();
    let mut down = 0.0;
    for i in 0..g.len().saturating_sub(2 * width) {
        down = larger(down, second(g[i], g[i + width], g[i + 2 * width]));
    }
    let mut along = 0.0;
    for row in g.chunks_exact(width) {
        for w in row.windows(3) {
            along = larger(along, second(w[0], w[1], w[2]));
        }
    }
    down * (m * m) as f64 > along * (n * n) as f64
}

/// Halves the net down its columns: `low` keeps the first half, `high` takes the second.
pub(super) fn halve_down(low: &mut [f64], high: &mut [f64], m: usize, width: usize) {
    high[m * width..].copy_from_slice(&low[m * width..]);
    for k in 1..=m {
        for i in (k..=m).rev() {
            let (above, row) = low.split_at_mut(i * width);
            for (x, y) in row[..width].iter_mut().zip(&above[(i - 1) * width..]) {
                *x = 0.5 * (*x + y);
            }
        }
        high[(m - k) * width..(m - k + 1) * width].copy_from_slice(&low[m * width..]);
    }
}

/// Halves the net along its rows.
pub(super) fn halve_along(low: &mut [f64], high: &mut [f64], n: usize) {
    for (low, high) in low.chunks_exact_mut(n + 1).zip(high.chunks_exact_mut(n + 1)) {
        high[n] = low[n];
        for k in 1..=n {
            for j in (k..=n).rev() {
                low[j] = 0.5 * (low[j] + low[j - 1]);
            }
            high[n - k] = low[n];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_and_halves_agree_with_their_definitions() {
        let (m, n) = (4, 6);
        let g: Vec<f64> = (0..(m + 1) * (n + 1)).map(|i| f64::from((i * i % 17) as u32) - 5.0).collect();
        let at = |i: usize, j: usize| g[i * (n + 1) + j];
        assert_eq!(extremes(&g), (-5.0, 11.0));
        let mut seconds = (f64::INFINITY, f64::INFINITY, 0.0_f64);
        for i in 0..=m {
            for j in 0..=n {
                if i + 2 <= m {
                    seconds.0 = seconds.0.min(at(i, j) - 2.0 * at(i + 1, j) + at(i + 2, j));
                }
                if j + 2 <= n {
                    seconds.1 = seconds.1.min(at(i, j) - 2.0 * at(i, j + 1) + at(i, j + 2));
                }
                if i < m && j < n {
                    seconds.2 = seconds.2.max((at(i, j) - at(i + 1, j) - at(i, j + 1) + at(i + 1, j + 1)).abs());
                }
            }
        }
        let found = (least_second_down(&g, n + 1), least_second_along(&g, n + 1), largest_mixed(&g, n + 1));
        assert_eq!(found, seconds);
        let (mut low, mut high) = (g.clone(), g.clone());
        halve_down(&mut low, &mut high, m, n + 1);
        // the halves meet, and keep the ends
        assert_eq!(low[m * (n + 1)..], high[..=n]);
        assert_eq!((&low[..=n], &high[m * (n + 1)..]), (&g[..=n], &g[m * (n + 1)..]));
        let (mut low, mut high) = (g.clone(), g.clone());
        halve_along(&mut low, &mut high, n);
        for i in 0..=m {
            assert_eq!(low[i * (n + 1) + n], high[i * (n + 1)]);
            let row = &g[i * (n + 1)..(i + 1) * (n + 1)];
            let middle: f64 = (0..=n).map(|j| row[j] * perpend_kernel::binomial(n, j) / 64.0).sum();
            assert!((high[i * (n + 1)] - middle).abs() < 1e-14);
        }
    }
}
