//! Tori.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use super::arc::Arc;
use super::check;
use super::frame::Frame;
use super::turn::Profile;
use crate::invalid::InvalidDefinition;
use crate::surface::NurbsSurface;

/// A ring torus (or a horn torus, where the radii are equal), or a part of one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Torus {
    /// Centre, axis, and the direction of angle 0 about the axis.
    pub frame: Frame,
    /// The radius of the spine, the circle that the tube follows.
    pub major: f64,
    /// The radius of the tube.
    pub minor: f64,
    /// The first and the last angle around the tube: 0 is outermost, π/2 the side of the axis' direction.
    pub tube: (f64, f64),
    /// The first and the last angle about the axis, at most a full turn apart.
    pub sweep: (f64, f64),
}

impl Torus {
    /// The part of a torus over the angles `tube` around the tube and `sweep` about the axis.
    ///
    /// # Errors
    ///
    /// The frame is none, a radius is not positive, the minor radius is above the major one (such a torus intersects
    /// itself), or an angle's range is empty or more than a full turn.
    pub fn new(
        frame: Frame,
        major: f64,
        minor: f64,
        tube: (f64, f64),
        sweep: (f64, f64),
    ) -> Result<Self, InvalidDefinition> {
        let torus = Self { frame: frame.checked()?, major, minor, tube, sweep };
        torus.to_nurbs().map(|_| torus)
    }

    /// The whole torus.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new).
    pub fn whole(frame: Frame, major: f64, minor: f64) -> Result<Self, InvalidDefinition> {
        Self::new(frame, major, minor, (0.0, TAU), (0.0, TAU))
    }

    /// The torus as a biquadratic surface: u around the tube, v about the axis. Exact but for rounding.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new).
    pub fn to_nurbs(&self) -> Result<NurbsSurface, InvalidDefinition> {
        check::positive("major radius", self.major)?;
        check::positive("minor radius", self.minor)?;
        if self.minor > self.major {
            return check::refuse("minor radius", self.minor, "it must be at most the major radius");
        }
        check::sweep("tube", self.tube)?;
        check::sweep("sweep", self.sweep)?;
        let arc = Arc::new(self.tube);
        let points = arc.points.iter().map(|(x, y, w)| (self.major + self.minor * x, self.minor * y, *w)).collect();
        Profile { knots: arc.knots, points }.turn(&self.frame.checked()?, self.sweep)
    }
}
