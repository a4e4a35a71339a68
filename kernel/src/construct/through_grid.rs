//! Surfaces through grids of points.

use glam::DVec3;

use super::interpolate::{InvalidInterpolation, System, check, check_finite};
use super::spacing::Spacing;
use crate::surface::NurbsSurface;

/// The surface of degrees `(p, q)` over `[0, 1]²` that passes `points[i][j]`, `i` along u; the corners exactly.
///
/// The NURBS Book, §9.2.5, algorithms A9.3 (parameters, averaged over the lines of a direction; lines that are a single point do not
/// count) and A9.4.
///
/// # Accuracy
///
/// As of [`curve_through`](crate::curve_through), in both directions.
///
/// # Errors
///
/// Bad degrees, too few or ragged rows, a coordinate that is not finite, neighbouring lines with one parameter.
pub fn surface_through(
    points: &[Vec<DVec3>],
    degree: (usize, usize),
    spacing: Spacing,
) -> Result<NurbsSurface, InvalidInterpolation> {
    let (rows, columns) = (points.len(), points.first().map_or(0, Vec::len));
    check(rows, degree.0)?;
    if let Some(row) = points.iter().position(|row| row.len() != columns) {
        return Err(InvalidInterpolation::RaggedRow { row, found: points[row].len(), expected: columns });
    }
    check(columns, degree.1)?;
    check_finite(points.iter().flatten().copied())?;
    let lines: Vec<Vec<DVec3>> = (0..columns).map(|j| points.iter().map(|row| row[j]).collect()).collect();
    let u = System::new(degree.0, &averaged(&lines, spacing)?)?;
    let v = System::new(degree.1, &averaged(points, spacing)?)?;
    let solved: Vec<Vec<DVec3>> = lines.iter().map(|line| u.solve(line)).collect();
    let net = (0..rows).flat_map(|i| v.solve(&solved.iter().map(|line| line[i]).collect::<Vec<_>>())).collect();
    Ok(NurbsSurface::checked(u.knots, v.knots, net, None)?)
}

/// The mean of the lines' parameters.
pub(super) fn averaged(lines: &[Vec<DVec3>], spacing: Spacing) -> Result<Vec<f64>, InvalidInterpolation> {
    let each: Vec<Vec<f64>> = lines.iter().filter_map(|line| spacing.parameters(line)).collect();
    let Some(first) = each.first() else { return Err(InvalidInterpolation::Repeated { index: 1 }) };
    let mut mean: Vec<f64> =
        (0..first.len()).map(|k| each.iter().map(|line| line[k]).sum::<f64>() / each.len() as f64).collect();
    // the ends are 0 and 1 in every line; their mean shall be so too
    if let Some(last) = mean.last_mut() {
        *last = 1.0;
    }
    Ok(mean)
}
