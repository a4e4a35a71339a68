//! The shapes that entities of the test sets are, as libraries with such shapes take them.

use std::collections::HashMap;
use std::path::Path;

use perpend::DVec3;
use serde::Deserialize;

use crate::Failure;
use crate::case::read;

/// A plane, cylinder, cone, sphere, torus or circle with the part of it that is meant.
#[derive(Debug, Clone)]
pub(crate) struct Shape {
    /// Its kind: the name that OpenCASCADE's program knows it by.
    pub(crate) kind: &'static str,
    /// Where its frame is.
    pub(crate) origin: DVec3,
    /// The z direction of its frame.
    pub(crate) axis: DVec3,
    /// The x direction of its frame.
    pub(crate) x_direction: DVec3,
    /// Plane: width, height. Cylinder: radius, sweep, height. Cone: radius at the origin, half angle, sweep, slant. Sphere: radius, sweep, start and sweep
    /// of the meridian. Torus: both radii, sweep, start and sweep of the section. Circle: radius, sweep.
    pub(crate) numbers: Vec<f64>,
}

#[derive(Deserialize)]
struct Written {
    #[serde(alias = "centre")]
    origin: DVec3,
    axis: DVec3,
    xdir: DVec3,
    #[serde(flatten)]
    form: Form,
}

#[derive(Deserialize)]
#[serde(tag = "type", rename_all = "lowercase")]
enum Form {
    Plane { width: f64, height: f64 },
    Cylinder { sweep: f64, profile: Segment },
    Cone { sweep: f64, profile: Segment },
    Sphere { sweep: f64, profile: Arc },
    Torus { major: f64, sweep: f64, profile: Arc },
    Circle { radius: f64, sweep: f64 },
}

/// Radius and height of both ends.
#[derive(Deserialize)]
struct Segment {
    from: [f64; 2],
    to: [f64; 2],
}

#[derive(Deserialize)]
struct Arc {
    radius: f64,
    start: f64,
    sweep: f64,
}

impl Shape {
    /// The shapes of a set by their entities' ids; none where the file is not there.
    pub(crate) fn read(path: &Path) -> Result<HashMap<u64, Self>, Failure> {
        if !path.exists() {
            return Ok(HashMap::new());
        }
        let written: HashMap<u64, Written> = serde_json::from_str(&read(path)?)?;
        Ok(written.into_iter().map(|(id, shape)| (id, Self::from(shape))).collect())
    }
}

impl From<Written> for Shape {
    fn from(Written { mut origin, axis, xdir, form }: Written) -> Self {
        let (kind, numbers) = match form {
            Form::Plane { width, height } => ("plane", vec![width, height]),
            Form::Cylinder { sweep, profile: Segment { from, to } } => {
                origin += from[1] * axis;
                ("cylinder", vec![from[0], sweep, to[1] - from[1]])
            }
            Form::Cone { sweep, profile: Segment { from, to } } => {
                origin += from[1] * axis;
                let (out, up) = (to[0] - from[0], to[1] - from[1]);
                ("cone", vec![from[0], out.atan2(up), sweep, out.hypot(up)])
            }
            Form::Sphere { sweep, profile } => ("sphere", vec![profile.radius, sweep, profile.start, profile.sweep]),
            Form::Torus { major, sweep, profile } => {
                ("torus", vec![major, profile.radius, sweep, profile.start, profile.sweep])
            }
            Form::Circle { radius, sweep } => ("circle", vec![radius, sweep]),
        };
        Self { kind, origin, axis, x_direction: xdir, numbers }
    }
}
