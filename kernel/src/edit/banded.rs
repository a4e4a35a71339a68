//! Least squares with a banded matrix.

use glam::DVec4;

/// The unknowns `x` for which the sum of squares of `A x - b` is least.
///
/// Row `r` of `A` has the given entries from its first column on; first columns ascend, and `A` has full rank. `right` holds `width`
/// right-hand sides: entry `r` of side `j` at `r * width + j`; so does the result. Rows are brought into triangular form one
/// after the other by rotations (Golub and Van Loan, Matrix Computations, §5.2.6), so that the error is that of the
/// matrix's condition, not of its square.
pub(super) fn least_squares(
    rows: &[(usize, Vec<f64>)],
    mut right: Vec<DVec4>,
    width: usize,
    unknowns: usize,
) -> Vec<DVec4> {
    let band = rows.iter().map(|(_, row)| row.len()).max().unwrap_or(0);
    let mut triangle = vec![0.0; unknowns * band];
    let mut sides = vec![DVec4::ZERO; unknowns * width];
    let mut row = vec![0.0_f64; band];
    for ((first, entries), right) in rows.iter().zip(right.chunks_mut(width)) {
        row.fill(0.0);
        row[..entries.len()].copy_from_slice(entries);
        for column in *first..(first + band).min(unknowns) {
            let pivot = &mut triangle[column * band..(column + 1) * band];
            if row[0] != 0.0 {
                let length = f64::hypot(pivot[0], row[0]);
                let (c, s) = (pivot[0] / length, row[0] / length);
                for (a, b) in pivot.iter_mut().zip(&mut row) {
                    (*a, *b) = (c * *a + s * *b, c * *b - s * *a);
                }
                for (a, b) in sides[column * width..].iter_mut().zip(right.iter_mut()) {
                    (*a, *b) = (c * *a + s * *b, c * *b - s * *a);
                }
            }
            row.rotate_left(1);
            row[band - 1] = 0.0;
        }
    }
    for column in (0..unknowns).rev() {
        let pivot = &triangle[column * band..(column + 1) * band];
        for line in 0..width {
            let mut sum = sides[column * width + line];
            for (k, entry) in pivot.iter().enumerate().skip(1).take(unknowns - 1 - column) {
                sum -= *entry * sides[(column + k) * width + line];
            }
            sides[column * width + line] = sum / pivot[0];
        }
    }
    sides
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_is_the_least_squares_of_equal_rows() {
        let rows = [(0, vec![1.0]), (0, vec![1.0]), (0, vec![1.0])];
        let right = [1.0, 2.0, 6.0].map(DVec4::splat).to_vec();
        let solved = least_squares(&rows, right, 1, 1);
        assert!((solved[0] - DVec4::splat(3.0)).length() < 1e-15, "{solved:?}");
    }

    #[test]
    fn equations_that_can_be_met_are() {
        let rows = [(0, vec![1.0]), (0, vec![0.5, 0.5]), (1, vec![0.25, 0.75]), (1, vec![0.0, 1.0]), (2, vec![1.0])];
        let truth = [DVec4::X, DVec4::Y, DVec4::new(3.0, -1.0, 2.0, 0.5)];
        let value = |(first, row): &(usize, Vec<f64>)| -> DVec4 {
            row.iter().enumerate().map(|(k, entry)| *entry * truth[first + k]).sum()
        };
        // two sides, the second twice the first
        let right = rows.iter().flat_map(|row| [value(row), 2.0 * value(row)]).collect();
        let solved = least_squares(&rows, right, 2, 3);
        for (k, truth) in truth.iter().enumerate() {
            assert!((solved[2 * k] - *truth).length() < 1e-15 && (solved[2 * k + 1] - 2.0 * *truth).length() < 1e-14);
        }
    }
}
