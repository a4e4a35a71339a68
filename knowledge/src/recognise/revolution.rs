//! Surfaces of revolution.

use glam::DVec3;
use perpend_kernel::{Direction, NurbsSurface};

use super::conic::full_if_closed;
use super::curves::parameters;
use super::turned::{Turned, UNIT, other};
use super::{axis, beside};
use crate::classification::Kind;

/// A surface as it turns about an axis that fits it.
pub(super) struct Pose {
    pub(super) centre: DVec3,
    pub(super) axis: DVec3,
    pub(super) xdir: DVec3,
    pub(super) sweep: (f64, f64),
    pub(super) angular: Direction,
    pub(super) turned: Turned,
    /// Lengths below this are rounding or within the tolerance.
    pub(super) slack: f64,
}

/// The axis about which a surface turns along `angular`, ascending; none where it does not within `tolerance`.
pub(super) fn pose(surface: &NurbsSurface, angular: Direction, tolerance: f64) -> Option<Pose> {
    let bounds = surface.control_box();
    let origin = bounds.centre();
    let mut rows: Vec<Vec<DVec3>> = Vec::with_capacity(7);
    for t in parameters(surface.domain(other(angular)), 6) {
        let at = |s| if angular == Direction::U { surface.point(s, t) } else { surface.point(t, s) };
        let row: Vec<DVec3> = parameters(surface.domain(angular), 16).map(|s| at(s) - origin).collect();
        if beside::circles(&row, tolerance) {
            return None;
        }
        rows.push(row);
    }
    let turned = |meridians| {
        let fitted = axis::fit(&rows, meridians)?;
        // the point of the axis that is nearest to the surface's middle
        let centre = origin + (fitted.centre - fitted.centre.dot(fitted.axis) * fitted.axis);
        about(surface, angular, centre, fitted.axis, tolerance)
    };
    // profiles need not lie in planes with the axis: the better fit counts
    let poses = [true, false].into_iter().filter_map(turned);
    let pose = poses.min_by(|a, b| a.turned.deviation.total_cmp(&b.turned.deviation))?;
    if pose.sweep.1 >= pose.sweep.0 {
        return Some(pose);
    }
    about(surface, angular, pose.centre, -pose.axis, tolerance)
}

/// The surface as it turns about an axis; none where it does not within `tolerance`.
pub(super) fn about(
    surface: &NurbsSurface,
    angular: Direction,
    centre: DVec3,
    axis: DVec3,
    tolerance: f64,
) -> Option<Pose> {
    let (turned, xdir) = Turned::about(surface, angular, centre, axis, None)?;
    if turned.deviation > tolerance {
        return None;
    }
    let bounds = surface.control_box();
    let slack = tolerance.min(1e-9 * bounds.diagonal() + 64.0 * f64::EPSILON * bounds.reach());
    let sweep = full_if_closed(UNIT.angles(&turned.arc)?.range(), 1e-2 * slack / turned.radius);
    Some(Pose { centre, axis, xdir, sweep, angular, turned, slack })
}

/// The surface of revolution.
pub(super) fn candidate(pose: &Pose) -> Option<Kind> {
    let sweep = pose.sweep.1 - pose.sweep.0;
    Some(Kind::Revolution { origin: pose.centre, axis: pose.axis, sweep, angular: pose.angular })
}

/// Bound of the distance from the surface that the iso-curve at the start makes when it is turned.
pub(super) fn gap(surface: &NurbsSurface, angular: Direction, origin: DVec3, axis: DVec3, sweep: f64) -> Option<f64> {
    let (turned, _) = Turned::about(surface, angular, origin, axis, None)?;
    // the iso-curve itself is as far from the profile as the surface
    Some(turned.deviation + turned.gap((0.0, sweep))?)
}
