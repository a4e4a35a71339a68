//! A surface taken apart into an arc that turns and a profile that is turned.

use glam::{DVec2, DVec3};
use perpend_kernel::{Direction, NurbsCurve, NurbsSurface};

use super::conic::Conic;
use super::proof::rounding;
use super::weights::Separated;

/// A surface `centre + turn(profile)`: with points across the axis as complex numbers, the product of an arc near the unit
/// circle and a profile, and heights of the profile alone.
pub(super) struct Turned {
    /// Near the unit circle, in the plane of the first two coordinates.
    pub(super) arc: NurbsCurve,
    /// Along `xdir`, along `axis × xdir`, and along the axis.
    pub(super) profile: NurbsCurve,
    /// Bound of the distance of the surface from the product, parameter by parameter.
    pub(super) deviation: f64,
    /// Bound of the profile's distance from the axis.
    pub(super) radius: f64,
}

/// The unit circle, on which arcs lie.
pub(super) const UNIT: Conic = Conic { centre: DVec3::ZERO, normal: DVec3::Z, xdir: DVec3::X, radii: (1.0, 1.0) };

/// A surface's net with the angular direction first.
struct Net<'a> {
    surface: &'a NurbsSurface,
    angular: Direction,
}

impl Net<'_> {
    fn index(&self, i: usize, j: usize) -> usize {
        let (row, column) = if self.angular == Direction::U { (i, j) } else { (j, i) };
        row * self.surface.columns() + column
    }

    fn count(&self) -> (usize, usize) {
        let (rows, columns) = (self.surface.rows(), self.surface.columns());
        if self.angular == Direction::U { (rows, columns) } else { (columns, rows) }
    }

    fn point(&self, i: usize, j: usize) -> DVec3 {
        self.surface.control_points()[self.index(i, j)]
    }

    fn weight(&self, i: usize, j: usize) -> f64 {
        self.surface.weights().map_or(1.0, |w| w[self.index(i, j)])
    }
}

/// The unit vector across an axis towards `arm`; none along the axis.
pub(super) fn perpendicular(arm: DVec3, axis: DVec3) -> Option<DVec3> {
    let across = (arm - arm.dot(axis) * axis).try_normalize()?;
    // twice is enough: what is left along the axis is rounding of the first time
    (across - across.dot(axis) * axis).try_normalize()
}

/// The other direction.
pub(super) fn other(direction: Direction) -> Direction {
    if direction == Direction::U { Direction::V } else { Direction::U }
}

impl Turned {
    /// Takes a surface apart about an axis of unit length, `angular` being the parameter that turns. Angles count from `xdir`;
    /// without it, from the start of the profile point that is farthest from the axis.
    pub(super) fn about(
        surface: &NurbsSurface,
        angular: Direction,
        centre: DVec3,
        axis: DVec3,
        xdir: Option<DVec3>,
    ) -> Option<(Self, DVec3)> {
        let net = Net { surface, angular };
        let (n, m) = net.count();
        let across = |p: DVec3| {
            let arm = p - centre;
            arm - arm.dot(axis) * axis
        };
        let start = |j: &usize| across(net.point(0, *j));
        let widest = (0..m).max_by(|a, b| start(a).length().total_cmp(&start(b).length()))?;
        let radius = start(&widest).length();
        let xdir = xdir.or_else(|| perpendicular(net.point(0, widest) - centre, axis))?;
        let ydir = axis.cross(xdir);
        let flat = |i, j| {
            let arm = net.point(i, j) - centre;
            (DVec2::new(arm.dot(xdir), arm.dot(ydir)), arm.dot(axis))
        };
        let around: Vec<DVec2> = (0..n).map(|i| flat(i, widest).0 / radius).collect();
        let norm: f64 = around.iter().map(|x| x.length_squared()).sum();
        let (mut profile, mut off, mut arms) = (Vec::with_capacity(m), 0.0_f64, 0.0_f64);
        for j in 0..m {
            let row: Vec<(DVec2, f64)> = (0..n).map(|i| flat(i, j)).collect();
            // the complex factor and the height that fit the row best
            let factor = row.iter().zip(&around).map(|((p, _), x)| conjugate(*x).rotate(*p)).sum::<DVec2>() / norm;
            let height = row.iter().map(|(_, z)| z).sum::<f64>() / n as f64;
            for ((p, z), x) in row.iter().zip(&around) {
                off = off.max((*p - x.rotate(factor)).length() + (z - height).abs());
                arms = arms.max(p.length() + z.abs());
            }
            profile.push(factor.extend(height));
        }
        let weights = Separated::new((n, m), |i, j| net.weight(i, j));
        let wide = profile.iter().map(|p| p.truncate().length()).fold(0.0, f64::max);
        let degrees = surface.degree().0 + surface.degree().1;
        let deviation = off + weights.moves(surface.control_box().diagonal() + 2.0 * off) + rounding(degrees) * arms;
        let knots = |direction| surface.knots(direction).as_slice().to_vec();
        let degree = |direction| surface.knots(direction).degree();
        let (turn, along) = (angular, other(angular));
        let rational = surface.weights().is_some();
        let arc = around.iter().map(|x| x.extend(0.0)).collect();
        let arc = NurbsCurve::new(degree(turn), knots(turn), arc, rational.then_some(weights.rows)).ok()?;
        let profile =
            NurbsCurve::new(degree(along), knots(along), profile, rational.then_some(weights.columns)).ok()?;
        Some((Self { arc, profile, deviation, radius: wide }, xdir))
    }

    /// Bound of the distance from the surface that the profile makes when it is turned over `sweep` exactly, but for the
    /// profile's own deviation.
    pub(super) fn gap(&self, sweep: (f64, f64)) -> Option<f64> {
        Some(self.deviation + self.radius * UNIT.gap(&self.arc, sweep)?)
    }
}

fn conjugate(x: DVec2) -> DVec2 {
    DVec2::new(x.x, -x.y)
}
