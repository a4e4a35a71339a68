//! Weights as products.

/// Weights `w(i, j)` as products `rows[i] * columns[j]`, off by a factor within `1 ± off`.
pub(super) struct Separated {
    pub(super) rows: Vec<f64>,
    pub(super) columns: Vec<f64>,
    off: f64,
}

impl Separated {
    pub(super) fn new(count: (usize, usize), weight: impl Fn(usize, usize) -> f64) -> Self {
        let rows: Vec<f64> = (0..count.0).map(|i| weight(i, 0) / weight(0, 0)).collect();
        let columns: Vec<f64> = (0..count.1).map(|j| weight(0, j)).collect();
        let mut off = 0.0_f64;
        for (i, a) in rows.iter().enumerate() {
            for (j, b) in columns.iter().enumerate() {
                off = off.max((weight(i, j) / (a * b) - 1.0).abs());
            }
        }
        Self { rows, columns, off: off + 4.0 * f64::EPSILON }
    }

    /// Bound of how far points move, within a hull of diameter `size`, when the products replace the weights: their shares
    /// in a point change by at most `2 off / (1 - off)` in all.
    pub(super) fn moves(&self, size: f64) -> f64 {
        if self.off < 0.5 { 2.0 * self.off / (1.0 - self.off) * size } else { f64::INFINITY }
    }
}
