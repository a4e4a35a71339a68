//! Ellipses and their arcs.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use super::arc::Arc;
use super::check;
use super::frame::Frame;
use crate::curve::NurbsCurve;
use crate::invalid::InvalidDefinition;

/// An ellipse or an arc of one: the points `centre + a cos t xdir + b sin t ydir`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Ellipse {
    /// Centre, axis of its plane, and the direction of `a`.
    pub frame: Frame,
    /// The radii `a` along `xdir` and `b` along `ydir`; either may be the larger.
    pub radii: (f64, f64),
    /// The first and the last `t` (the eccentric anomaly, not the angle at the centre), at most a full turn apart.
    pub sweep: (f64, f64),
}

impl Ellipse {
    /// The arc of an ellipse over `sweep`.
    ///
    /// # Errors
    ///
    /// The frame is none, a radius is not positive, or the sweep is empty or more than a full turn.
    pub fn new(frame: Frame, radii: (f64, f64), sweep: (f64, f64)) -> Result<Self, InvalidDefinition> {
        let ellipse = Self { frame: frame.checked()?, radii, sweep };
        ellipse.to_nurbs().map(|_| ellipse)
    }

    /// The whole ellipse.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new).
    pub fn whole(frame: Frame, radii: (f64, f64)) -> Result<Self, InvalidDefinition> {
        Self::new(frame, radii, (0.0, TAU))
    }

    /// The arc as a rational quadratic over `[0, 1]`, exact but for the rounding of its control points.
    ///
    /// The NURBS Book, §7.5: the affine image of the arc of a circle.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new).
    pub fn to_nurbs(&self) -> Result<NurbsCurve, InvalidDefinition> {
        check::positive("radius along xdir", self.radii.0)?;
        check::positive("radius along ydir", self.radii.1)?;
        check::sweep("sweep", self.sweep)?;
        let (frame, arc) = (self.frame.checked()?, Arc::new(self.sweep));
        let points = arc.points.iter().map(|(x, y, _)| frame.at(self.radii.0 * x, self.radii.1 * y, 0.0)).collect();
        NurbsCurve::checked(arc.knots, points, Some(arc.points.iter().map(|(_, _, w)| *w).collect()))
    }
}
