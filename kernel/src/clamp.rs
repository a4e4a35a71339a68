//! Clamping: unclamped and periodic knot vectors are clamped on entry, by knot insertion.

use glam::DVec4;

use crate::edit::Blend;
use crate::invalid::{Along, InvalidDefinition};
use crate::knots::{KnotVector, check_order};

/// What had to be done to a definition on entry.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Entry {
    /// Whether the knots were clamped, in u and in v.
    pub clamped: [bool; 2],
}

/// Whether the knot vector needs clamping.
///
/// # Errors
///
/// An end that is repeated too often: clamping cannot mend it.
pub(crate) fn needed(degree: usize, knots: &[f64], along: Along) -> Result<bool, InvalidDefinition> {
    let (first, last) = (knots[degree], knots[knots.len() - degree - 1]);
    for knot in [first, last] {
        let multiplicity = knots.iter().filter(|k| **k == knot).count();
        if multiplicity > degree + 1 {
            return Err(InvalidDefinition::EndMultiplicity { along, knot, multiplicity, degree });
        }
    }
    Ok(knots[0] < first || knots[knots.len() - 1] > last)
}

/// The same curve on its domain, with clamped ends: by blossoms, the new end points are values at the ends.
pub(crate) fn clamp(
    degree: usize,
    knots: Vec<f64>,
    net: Vec<DVec4>,
    along: Along,
) -> Result<(KnotVector, Vec<DVec4>), InvalidDefinition> {
    check_order(degree, &knots, net.len(), along)?;
    let (knots, net) = clamp_start(degree, knots, net);
    // the end is the start of the reversed curve
    let reversed: Vec<f64> = knots.iter().rev().map(|k| -k).collect();
    let (knots, net) = clamp_start(degree, reversed, net.into_iter().rev().collect());
    let knots: Vec<f64> = knots.iter().rev().map(|k| -k).collect();
    let net: Vec<DVec4> = net.into_iter().rev().collect();
    let knots = KnotVector::new(degree, knots, net.len(), along)?;
    Ok((knots, net))
}

/// Clamps the start: control points before the domain give way to blossoms at its first parameter.
///
/// With `a` the start and `t` the knots, the new point `i` is the blossom of the arguments `a, …, a, t_(s+1), …, t_(s+i)`,
/// where `s` is the last index with `t_s = a`: knot insertion, a convex combination (The NURBS Book, §5.2).
fn clamp_start(p: usize, knots: Vec<f64>, net: Vec<DVec4>) -> (Vec<f64>, Vec<DVec4>) {
    let start = knots[p];
    if knots[0] == start {
        return (knots, net);
    }
    let s = knots.partition_point(|k| *k <= start) - 1;
    let mut clamped = vec![start; p + 1];
    clamped.extend_from_slice(&knots[s + 1..]);
    let mut points: Vec<DVec4> =
        (0..p).map(|i| Blend::blossom(p, &knots, &clamped[i + 1..=i + p]).of_homogeneous(&net)).collect();
    points.extend_from_slice(&net[s..]);
    (clamped, points)
}

/// Clamps a net in u: every column is a curve.
pub(crate) fn clamp_rows(
    degree: usize,
    knots: Vec<f64>,
    net: Vec<DVec4>,
    columns: usize,
    along: Along,
) -> Result<(KnotVector, Vec<DVec4>), InvalidDefinition> {
    let mut result: Vec<DVec4> = Vec::new();
    let mut clamped = None;
    for j in 0..columns {
        let column: Vec<DVec4> = net.iter().skip(j).step_by(columns).copied().collect();
        let (vector, column) = clamp(degree, knots.clone(), column, along)?;
        result.resize(column.len() * columns, DVec4::ZERO);
        for (i, point) in column.into_iter().enumerate() {
            result[i * columns + j] = point;
        }
        clamped = Some(vector);
    }
    Ok((clamped.expect("a validated net has columns"), result))
}

/// Clamps a net in v: every row is a curve.
pub(crate) fn clamp_columns(
    degree: usize,
    knots: Vec<f64>,
    net: Vec<DVec4>,
    columns: usize,
    along: Along,
) -> Result<(KnotVector, Vec<DVec4>), InvalidDefinition> {
    let mut result = Vec::new();
    let mut clamped = None;
    for row in net.chunks(columns) {
        let (vector, row) = clamp(degree, knots.clone(), row.to_vec(), along)?;
        result.extend(row);
        clamped = Some(vector);
    }
    Ok((clamped.expect("a validated net has rows"), result))
}

#[cfg(test)]
mod tests {
    use crate::NurbsCurve;
    use glam::DVec3;

    /// Cox and de Boor's recursion, straight from its definition, for any knot vector.
    fn cox_de_boor(i: usize, p: usize, t: &[f64], u: f64) -> f64 {
        if p == 0 {
            return f64::from(u8::from(t[i] <= u && u < t[i + 1]));
        }
        let part = |a: f64, b: f64| if b == 0.0 { 0.0 } else { a / b };
        part(u - t[i], t[i + p] - t[i]) * cox_de_boor(i, p - 1, t, u)
            + part(t[i + p + 1] - u, t[i + p + 1] - t[i + 1]) * cox_de_boor(i + 1, p - 1, t, u)
    }

    #[test]
    fn clamping_keeps_the_curve() {
        let points: Vec<DVec3> =
            (0..7).map(|i| DVec3::new(f64::from(i), f64::from(i * i % 5), f64::from(i % 2))).collect();
        for (degree, knots) in [
            (3, (0..11).map(f64::from).collect::<Vec<_>>()),
            (3, vec![0.0, 1.0, 1.0, 2.0, 2.5, 4.0, 5.0, 5.0, 5.5, 6.0, 6.0]),
            (2, vec![0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]),
            (1, vec![0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0]),
        ] {
            let curve = NurbsCurve::new(degree, knots.clone(), points.clone(), None).expect("valid");
            let (first, last) = curve.domain();
            assert_eq!((first, last), (knots[degree], knots[7]));
            for k in 0..100 {
                let u = first + (last - first) * f64::from(k) / 100.0;
                let sum: DVec3 = (0..7).map(|i| points[i] * cox_de_boor(i, degree, &knots, u)).sum();
                assert!((curve.point(u) - sum).length() < 1e-13, "degree {degree} at {u}");
            }
        }
    }
}
