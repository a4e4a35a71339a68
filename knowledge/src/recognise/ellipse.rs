//! The ellipse through samples of a curve.

use glam::{DVec2, DVec3};
use perpend_kernel::NurbsCurve;

use super::axis::through;
use super::conic::{Conic, full_if_closed};
use super::curves::{local, samples};
use super::least_squares::least_squares;
use super::turned::perpendicular;
use crate::classification::Kind;

/// The ellipse whose equation fits samples best, in the direction in which the curve runs; `xdir` is its long half-axis.
pub(super) fn candidate(curve: &NurbsCurve) -> Option<Kind> {
    let (curve_at, origin) = local(curve)?;
    let row = samples(&curve_at);
    let (plane, _) = through(&row)?;
    let (x, y) = plane.axis.any_orthonormal_pair();
    let middle = row.iter().sum::<DVec3>() / row.len() as f64;
    let size = row.iter().map(|p| p.distance(middle)).fold(0.0, f64::max);
    let flat: Vec<DVec2> = row.iter().map(|p| DVec2::new((*p - middle).dot(x), (*p - middle).dot(y)) / size).collect();
    let (centre, long, radii) = fit(&flat)?;
    let centre = middle + size * (centre.x * x + centre.y * y);
    let xdir = perpendicular(long.x * x + long.y * y, plane.axis)?;
    let radii = (size * radii.0, size * radii.1);
    let turned = |normal| {
        let conic = Conic { centre, normal, xdir, radii };
        Some(conic.angles(&curve_at)?.range())
    };
    let mut axis = plane.axis;
    let mut sweep = turned(axis)?;
    if sweep.1 < sweep.0 {
        axis = -axis;
        sweep = turned(axis)?;
    }
    let sweep = full_if_closed(sweep, super::tolerance_in(curve.control_box()) * 1e-2 / radii.0);
    Some(Kind::Ellipse { centre: origin + centre, axis, xdir, radii, sweep })
}

/// The equation `(x² + y²)/2 + a (x² - y²) + b x y + c x + d y + e = 0` of a conic as `[e, c, d, a, b]`: no ellipse makes it trivial.
pub(super) struct Equation([f64; 5]);

impl Equation {
    /// Its left side.
    pub(super) fn at(&self, p: DVec2) -> f64 {
        let Self([e, c, d, a, b]) = *self;
        0.5 * p.length_squared() + a * (p.x * p.x - p.y * p.y) + b * p.x * p.y + c * p.x + d * p.y + e
    }
}

/// The conic near to points: the least squares of its equation.
pub(super) fn equation(points: &[DVec2]) -> Option<Equation> {
    let column = |of: fn(&DVec2) -> f64| points.iter().map(of).collect::<Vec<f64>>();
    let columns =
        [column(|_| 1.0), column(|p| p.x), column(|p| p.y), column(|p| p.x * p.x - p.y * p.y), column(|p| p.x * p.y)];
    least_squares(columns, column(|p| -0.5 * p.length_squared())).map(Equation)
}

/// Centre, direction of the long half-axis, and half-axes of the ellipse near to points.
fn fit(points: &[DVec2]) -> Option<(DVec2, DVec2, (f64, f64))> {
    let Equation([e, c, d, a, b]) = equation(points)?;
    let (xx, yy, xy) = (0.5 + a, 0.5 - a, 0.5 * b);
    let determinant = xx * yy - xy * xy;
    let centre = -0.5 * DVec2::new(yy * c - xy * d, xx * d - xy * c) / determinant;
    let level = -(e + 0.5 * (c * centre.x + d * centre.y));
    // the eigenvalues add up to 1
    let apart = a.hypot(xy);
    let (low, high) = (0.5 - apart, 0.5 + apart);
    let angle = 0.5 * (2.0 * xy).atan2(2.0 * a);
    let steep = DVec2::from_angle(angle);
    let radii = ((level / low).sqrt(), (level / high).sqrt());
    (low > 0.0 && level > 0.0 && centre.is_finite()).then_some((centre, steep.perp(), radii))
}
