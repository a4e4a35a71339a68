//! A point of an entity with its derivatives, curve or surface.

use glam::DVec3;
use perpend_kernel::Definition;

/// A point with its first and second derivatives; those in v are zero on a curve.
#[derive(Debug, Clone, Copy)]
pub(super) struct Jet {
    pub point: DVec3,
    /// In u and in v.
    pub first: [DVec3; 2],
    /// Twice in u, mixed, twice in v.
    pub second: [DVec3; 3],
}

impl Jet {
    /// At parameters of the domain; from below where a parameter is a knot and `below` asks for it.
    pub(super) fn at(definition: &Definition, [u, v]: [f64; 2], below: [bool; 2]) -> Self {
        match definition {
            Definition::NurbsCurve(curve) => {
                let mut d = [DVec3::ZERO; 3];
                if below[0] {
                    curve.derivatives_from_left(u, &mut d);
                } else {
                    curve.derivatives(u, &mut d);
                }
                Self { point: d[0], first: [d[1], DVec3::ZERO], second: [d[2], DVec3::ZERO, DVec3::ZERO] }
            }
            Definition::NurbsSurface(surface) => {
                let mut d = [DVec3::ZERO; 9];
                surface.derivatives_from(u, v, below, 2, &mut d);
                Self { point: d[0], first: [d[3], d[1]], second: [d[6], d[4], d[2]] }
            }
        }
    }
}
