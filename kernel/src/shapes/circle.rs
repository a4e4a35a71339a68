//! Circles and their arcs.

use std::f64::consts::TAU;

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::check::refuse;
use super::ellipse::Ellipse;
use super::frame::Frame;
use crate::curve::NurbsCurve;
use crate::invalid::InvalidDefinition;

/// A circle or an arc of one, in the plane across the axis of its frame.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Circle {
    /// Centre, axis, and the direction of angle 0.
    pub frame: Frame,
    /// The radius.
    pub radius: f64,
    /// The first and the last angle, at most a full turn apart.
    pub sweep: (f64, f64),
}

impl Circle {
    /// The arc of a circle over the angles `sweep`.
    ///
    /// # Errors
    ///
    /// The frame is none, the radius is not positive, or the sweep is empty or more than a full turn.
    pub fn new(frame: Frame, radius: f64, sweep: (f64, f64)) -> Result<Self, InvalidDefinition> {
        let circle = Self { frame: frame.checked()?, radius, sweep };
        circle.to_nurbs().map(|_| circle)
    }

    /// The whole circle.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new).
    pub fn whole(frame: Frame, radius: f64) -> Result<Self, InvalidDefinition> {
        Self::new(frame, radius, (0.0, TAU))
    }

    /// The arc from `start` over `through` to `end`; its angle 0 is at `start`, and it runs counterclockwise about its axis.
    ///
    /// # Accuracy
    ///
    /// The arc passes the points within a few ε of its radius, or of their largest coordinate where that is larger; so
    /// three points near one line, whose arc is nearly straight, give one that passes them less well.
    ///
    /// # Errors
    ///
    /// A coordinate is not finite; two points are equal; the points lie on one line.
    pub fn through(start: DVec3, through: DVec3, end: DVec3) -> Result<Self, InvalidDefinition> {
        for (what, point) in [("start", start), ("through", through), ("end", end)] {
            if !point.is_finite() {
                return refuse(what, point, "it must be finite");
            }
        }
        let (u, v) = (through - start, end - start);
        let length = u.abs().max_element().max(v.abs().max_element());
        let (u, v) = (u / length, v / length);
        let normal = u.cross(v);
        let narrowest = normal.length() / (u.length() * v.length()).max(f64::MIN_POSITIVE);
        // below this the plane of the three is mostly rounding
        if !(narrowest > 1e-8 && (u - v).length() > 0.0) {
            return refuse("through", through, "it must differ from both ends and lie off the line through them");
        }
        let arm = (u.length_squared() * v.cross(normal) + v.length_squared() * normal.cross(u))
            / (2.0 * normal.length_squared());
        let frame = Frame::new(start + length * arm, normal, -arm)?;
        let to_end = v - arm;
        let angle = to_end.dot(frame.ydir()).atan2(to_end.dot(frame.xdir));
        let angle = if angle > 0.0 { angle } else { angle + TAU };
        Self::new(frame, length * arm.length(), (0.0, angle))
    }

    /// The arc as a rational quadratic over `[0, 1]`, exact but for the rounding of its control points.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new).
    pub fn to_nurbs(&self) -> Result<NurbsCurve, InvalidDefinition> {
        super::check::positive("radius", self.radius)?;
        Ellipse { frame: self.frame, radii: (self.radius, self.radius), sweep: self.sweep }.to_nurbs()
    }
}
