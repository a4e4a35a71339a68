//! Normals of vertices.

use glam::{DVec2, DVec3};
use perpend_kernel::{Direction, NurbsSurface};

/// The unit normal `S_u × S_v`; where there is none, that of a place nearby towards the middle of the domain, if that has one.
pub(crate) fn normal(surface: &NurbsSurface, at: DVec2) -> Option<DVec3> {
    let (u, v) = (surface.domain(Direction::U), surface.domain(Direction::V));
    let middle = DVec2::new(0.5 * u.0 + 0.5 * u.1, 0.5 * v.0 + 0.5 * v.1);
    // far enough for a direction to stand out of rounding, near enough to be the limit at a pole for the eye
    [0.0, 1e-6, 1e-4].into_iter().find_map(|share| {
        let at = at + share * (middle - at);
        let mut out = [DVec3::ZERO; 4];
        surface.derivatives(at.x, at.y, 1, &mut out);
        let (by_u, by_v) = (out[2], out[1]);
        let (by_u, by_v) = (by_u.try_normalize()?, by_v.try_normalize()?);
        let normal = by_u.cross(by_v);
        // below, the direction is mostly rounding
        (normal.length() > 1e-8).then(|| normal.normalize())
    })
}
