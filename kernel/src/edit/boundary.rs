//! Boundary curves.

use crate::curve::NurbsCurve;
use crate::invalid::Direction;
use crate::surface::NurbsSurface;

impl NurbsSurface {
    /// The curves at the first u, the last u, the first v and the last v, in this order; none where an edge collapses to a
    /// point (a pole). Their control points are the net's edges, bit for bit.
    #[must_use]
    pub fn boundary_curves(&self) -> [Option<NurbsCurve>; 4] {
        let ends = |direction| {
            let (first, last) = self.domain(direction);
            // inside the domain, so that collapsing is all that can go wrong
            [self.iso_curve(direction, first).ok(), self.iso_curve(direction, last).ok()]
        };
        let ([first_u, last_u], [first_v, last_v]) = (ends(Direction::U), ends(Direction::V));
        [first_u, last_u, first_v, last_v]
    }
}
