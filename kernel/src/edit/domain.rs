//! Affine reparametrisation.

use crate::curve::NurbsCurve;
use crate::invalid::{Along, Direction, InvalidDefinition};
use crate::knots::KnotVector;
use crate::surface::NurbsSurface;

impl NurbsCurve {
    /// The same points over the domain `[first, last]`: the parameter is mapped affinely.
    ///
    /// The ends are exact; interior knots are rounded, which moves the shape where a span is not much longer than `ε` times
    /// the largest parameter.
    ///
    /// # Errors
    ///
    /// `first` is not below `last`, or knots fall together.
    pub fn with_domain(&self, first: f64, last: f64) -> Result<Self, InvalidDefinition> {
        let knots = mapped(&self.knots, first, last, Along::Curve)?;
        Ok(Self { knots, ..self.clone() })
    }
}

impl NurbsSurface {
    /// The same points with the domain of a direction mapped to `[first, last]`; see [`NurbsCurve::with_domain`].
    ///
    /// # Errors
    ///
    /// `first` is not below `last`, or knots fall together.
    pub fn with_domain(&self, direction: Direction, first: f64, last: f64) -> Result<Self, InvalidDefinition> {
        let knots = mapped(self.knots(direction), first, last, Along::Surface(direction))?;
        Ok(match direction {
            Direction::U => Self { u: knots, ..self.clone() },
            Direction::V => Self { v: knots, ..self.clone() },
        })
    }
}

/// The knots with their domain mapped to `[first, last]`.
pub(crate) fn mapped(old: &KnotVector, first: f64, last: f64, along: Along) -> Result<KnotVector, InvalidDefinition> {
    let (a, b) = old.domain();
    let scale = (last - first) / (b - a);
    let map = |knot: &f64| {
        if *knot == a {
            first
        } else if *knot == b {
            last
        } else {
            // every step is monotone in the knot, rounding included
            (first + (knot - a) * scale).min(last)
        }
    };
    KnotVector::new(old.degree(), old.as_slice().iter().map(map).collect(), old.point_count(), along)
}
