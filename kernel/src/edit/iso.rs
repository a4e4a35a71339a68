//! Iso-curves.

use super::blend::Blend;
use super::invalid::InvalidEdit;
use crate::basis;
use crate::curve::NurbsCurve;
use crate::invalid::{Along, Direction, InvalidDefinition};
use crate::surface::NurbsSurface;

impl NurbsSurface {
    /// The curve on which the parameter of `direction` is `at`; its parameter is that of the other direction.
    ///
    /// The NURBS Book, equation 4.16. At the ends of the domain its control points are the net's edge, bit for bit.
    ///
    /// # Errors
    ///
    /// `at` is outside the domain; the curve is a single point (a pole).
    pub fn iso_curve(&self, direction: Direction, at: f64) -> Result<NurbsCurve, InvalidEdit> {
        let held = self.knots(direction);
        let (first, last) = held.domain();
        if !(first <= at && at <= last) {
            let along = Along::Surface(direction);
            return Err(InvalidEdit::Parameter { along, at, first, last, inside: false });
        }
        let (p, span) = (held.degree(), held.find_span(at));
        let blend = Blend::new(span - p, &basis::functions::<{ basis::ROOM }>(held, span, at)[..=p]);
        let (columns, weights) = (self.columns(), self.weights());
        let point = |k: usize| match direction {
            Direction::U => blend.of(&self.control_points, weights, |i| i * columns + k),
            Direction::V => blend.of(&self.control_points, weights, |j| k * columns + j),
        };
        let (knots, count) = match direction {
            Direction::U => (&self.v, columns),
            Direction::V => (&self.u, self.rows()),
        };
        let (points, blended): (Vec<_>, Vec<_>) = (0..count).map(point).unzip();
        NurbsCurve::checked(knots.clone(), points, weights.is_some().then_some(blended)).map_err(|error| match error {
            InvalidDefinition::NoExtent => InvalidEdit::Collapsed { direction, at },
            other => other.into(),
        })
    }
}
