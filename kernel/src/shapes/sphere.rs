//! Spheres and their zones.

use std::f64::consts::{FRAC_PI_2, TAU};

use serde::{Deserialize, Serialize};

use super::arc::Arc;
use super::check;
use super::frame::Frame;
use super::turn::Profile;
use crate::invalid::InvalidDefinition;
use crate::surface::NurbsSurface;

/// A sphere, or a part of one between two latitudes and two longitudes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Sphere {
    /// Centre, the axis through the poles, and the direction of longitude 0.
    pub frame: Frame,
    /// The radius.
    pub radius: f64,
    /// The first and the last latitude, within -π/2 (the pole against the axis) to π/2.
    pub latitude: (f64, f64),
    /// The first and the last longitude, at most a full turn apart.
    pub sweep: (f64, f64),
}

impl Sphere {
    /// The part of a sphere over the latitudes `latitude` and the longitudes `sweep`.
    ///
    /// # Errors
    ///
    /// The frame is none, the radius is not positive, the latitudes do not ascend or pass a pole, or the sweep is empty or
    /// more than a full turn.
    pub fn new(frame: Frame, radius: f64, latitude: (f64, f64), sweep: (f64, f64)) -> Result<Self, InvalidDefinition> {
        let sphere = Self { frame: frame.checked()?, radius, latitude, sweep };
        sphere.to_nurbs().map(|_| sphere)
    }

    /// The whole sphere.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new).
    pub fn whole(frame: Frame, radius: f64) -> Result<Self, InvalidDefinition> {
        Self::new(frame, radius, (-FRAC_PI_2, FRAC_PI_2), (0.0, TAU))
    }

    /// The sphere as a biquadratic surface: u along the latitude, v along the longitude; poles are collapsed edges.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new).
    pub fn to_nurbs(&self) -> Result<NurbsSurface, InvalidDefinition> {
        check::positive("radius", self.radius)?;
        check::ascending("latitude", self.latitude)?;
        for latitude in [self.latitude.0, self.latitude.1] {
            if latitude.abs() > FRAC_PI_2 {
                return check::refuse("latitude", latitude, "it must lie within -π/2 and π/2");
            }
        }
        check::sweep("sweep", self.sweep)?;
        let arc = Arc::new(self.latitude);
        let points = arc.points.iter().map(|(x, y, w)| (self.radius * x, self.radius * y, *w)).collect();
        Profile { knots: arc.knots, points }.turn(&self.frame.checked()?, self.sweep)
    }
}
