//! Surfaces through curves.

use glam::DVec3;

use super::compatible::compatible;
use super::interpolate::{InvalidInterpolation, System, check};
use super::spacing::Spacing;
use super::through_grid::averaged;
use crate::curve::{NurbsCurve, check_weights};
use crate::invalid::PointIndex;
use crate::surface::NurbsSurface;

/// The surface that passes the sections in their order: u runs along them, over the domain of the first, v across them over
/// `[0, 1]`, with `degree`.
///
/// The sections are made compatible as for [`ruled`](crate::ruled); then every line of corresponding control points is
/// interpolated, at parameters that are the means of their chord lengths. The NURBS Book, §10.3. Rational sections are
/// interpolated in homogeneous form, where weights that differ much can overshoot to zero or below, which is refused.
///
/// # Accuracy
///
/// As of [`curve_through`](crate::curve_through); the first and the last section exactly, but for what making them compatible
/// rounds.
///
/// # Errors
///
/// A bad degree, fewer than degree + 1 sections, neighbouring sections that are the same, sections that cannot be made
/// compatible, a weight that is not positive.
pub fn loft(sections: &[&NurbsCurve], degree: usize) -> Result<NurbsSurface, InvalidInterpolation> {
    check(sections.len(), degree)?;
    let sections = compatible(sections).map_err(InvalidInterpolation::Sections)?;
    let count = sections[0].control_points.len();
    let lines: Vec<Vec<DVec3>> =
        (0..count).map(|k| sections.iter().map(|section| section.control_points[k]).collect()).collect();
    let system = System::new(degree, &averaged(&lines, Spacing::ChordLength)?)?;
    let v = system.knots.clone();
    let u = sections[0].knots.clone();
    if sections.iter().all(|section| section.weights.is_none()) {
        let net = lines.iter().flat_map(|line| system.solve(line)).collect();
        return Ok(NurbsSurface::checked(u, v, net, None)?);
    }
    let (mut net, mut weights) = (Vec::new(), Vec::new());
    for (k, line) in lines.iter().enumerate() {
        let weight = |section: &NurbsCurve| section.weights().map_or(1.0, |w| w[k]);
        let line_weights: Vec<f64> = sections.iter().map(weight).collect();
        let raised: Vec<DVec3> = line.iter().zip(&line_weights).map(|(point, w)| *point * *w).collect();
        // the system solves lines of points; a line of numbers is one of their coordinates
        let solved: Vec<f64> =
            system.solve(&line_weights.iter().map(|w| *w * DVec3::X).collect::<Vec<_>>()).iter().map(|p| p.x).collect();
        net.extend(system.solve(&raised).iter().zip(&solved).map(|(point, w)| *point / *w));
        weights.extend(solved);
    }
    // before the points, which a weight of zero has spoilt
    let columns = v.point_count();
    check_weights(&weights, |k| PointIndex::Surface(k / columns, k % columns))?;
    Ok(NurbsSurface::checked(u, v, net, Some(weights))?)
}
