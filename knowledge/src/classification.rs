//! What shape an entity is, where it comes from and what it is for.

use glam::DVec3;
use perpend_kernel::{Direction, EntityId};
use serde::{Deserialize, Serialize};

use crate::bare;
use crate::item::Item;

/// What shape an entity is, where it comes from and what it is for.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Classification {
    /// The class of shapes that the entity belongs to, with its parameters.
    #[serde(default, with = "bare", skip_serializing_if = "Option::is_none")]
    pub kind: Option<Item<Kind>>,
    /// Where the entity comes from.
    #[serde(default, with = "bare", skip_serializing_if = "Option::is_none")]
    pub origin: Option<Origin>,
    /// What it is for: styling, machining, inspection, …
    #[serde(default)]
    pub destination: Vec<String>,
}

/// A class of shapes with its defining parameters.
///
/// Lengths are in the model's unit, angles in radians. `axis` and `xdir` are orthogonal unit vectors; angles about the axis
/// are measured from `xdir` towards `axis × xdir`. A range is written as the values at the start and at the end of the NURBS
/// parameter that runs along it, so that a descending range runs against the parameter; on a surface `angular` says which
/// parameter runs about the axis, the other runs along the profile.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Kind {
    /// A straight segment.
    Line {
        /// A point of the line.
        origin: DVec3,
        /// Its unit direction.
        direction: DVec3,
        /// The signed lengths from the origin at the ends.
        range: (f64, f64),
    },
    /// A circle or an arc.
    Circle {
        /// The centre.
        centre: DVec3,
        /// The normal of its plane.
        axis: DVec3,
        /// The direction of angle 0.
        xdir: DVec3,
        /// The radius.
        radius: f64,
        /// The angles at the ends.
        sweep: (f64, f64),
    },
    /// An ellipse or an arc of one.
    Ellipse {
        /// The centre.
        centre: DVec3,
        /// The normal of its plane.
        axis: DVec3,
        /// The direction of the first half-axis.
        xdir: DVec3,
        /// The half-axes along `xdir` and along `axis × xdir`.
        radii: (f64, f64),
        /// The eccentric angles at the ends.
        sweep: (f64, f64),
    },
    /// A plane patch.
    Plane {
        /// A point of the plane; of a parallelogram, its corner at the start of both parameters.
        origin: DVec3,
        /// The unit normal.
        normal: DVec3,
        /// The sides along u and along v where the patch is a parallelogram; left out for another outline.
        #[serde(default, with = "bare", skip_serializing_if = "Option::is_none")]
        sides: Option<(DVec3, DVec3)>,
    },
    /// A sphere or a part of one.
    Sphere {
        /// The centre.
        centre: DVec3,
        /// From the south pole to the north pole.
        axis: DVec3,
        /// The direction of longitude 0.
        xdir: DVec3,
        /// The radius.
        radius: f64,
        /// The longitudes.
        sweep: (f64, f64),
        /// The latitudes, from -π/2 at the south pole to π/2.
        latitude: (f64, f64),
        /// The parameter that runs along the longitude.
        angular: Direction,
    },
    /// A circular cylinder or a part of one.
    Cylinder {
        /// A point of the axis: height 0.
        centre: DVec3,
        /// The axis.
        axis: DVec3,
        /// The direction of angle 0.
        xdir: DVec3,
        /// The radius.
        radius: f64,
        /// The heights along the axis.
        height: (f64, f64),
        /// The angles about the axis.
        sweep: (f64, f64),
        /// The parameter that runs about the axis.
        angular: Direction,
    },
    /// A circular cone or a part of one.
    Cone {
        /// The apex: height 0.
        apex: DVec3,
        /// The axis, from the apex into the cone.
        axis: DVec3,
        /// The direction of angle 0.
        xdir: DVec3,
        /// The angle between axis and cone.
        half_angle: f64,
        /// The heights along the axis.
        height: (f64, f64),
        /// The angles about the axis.
        sweep: (f64, f64),
        /// The parameter that runs about the axis.
        angular: Direction,
    },
    /// A torus or a part of one.
    Torus {
        /// The centre.
        centre: DVec3,
        /// The axis.
        axis: DVec3,
        /// The direction of angle 0.
        xdir: DVec3,
        /// The radius of the circle of the tube's centres.
        major_radius: f64,
        /// The radius of the tube.
        minor_radius: f64,
        /// The angles about the axis.
        sweep: (f64, f64),
        /// The angles about the tube, 0 on the outer equator, π/2 on the axis' side.
        section: (f64, f64),
        /// The parameter that runs about the axis.
        angular: Direction,
    },
    /// A ruled surface between two of its boundary curves.
    Ruled {
        /// The parameter that runs along the straight lines.
        ruling: Direction,
    },
    /// A surface of revolution; its profile is the iso-curve at the start of `angular`.
    Revolution {
        /// A point of the axis.
        origin: DVec3,
        /// The axis.
        axis: DVec3,
        /// The angle at the end of `angular`; 0 at its start.
        sweep: f64,
        /// The parameter that runs about the axis.
        angular: Direction,
    },
    /// A profile moved along a vector; the profile is the iso-curve at the start of `along`.
    Extrusion {
        /// From the profile to its copy at the end of `along`.
        vector: DVec3,
        /// The parameter that runs along the vector.
        along: Direction,
    },
    /// None of these.
    FreeForm,
}

/// Where an entity comes from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Origin {
    /// It was designed in this model.
    Designed,
    /// It was read from a file of another system.
    Imported {
        /// The file's format: STEP, IGES, …
        format: String,
        /// Where in the file.
        from: String,
    },
    /// It was fitted to data.
    Fitted {
        /// What data.
        from: String,
        /// How many points.
        points: u64,
        /// The largest deviation from them.
        residual: f64,
    },
    /// It was computed from other entities.
    Derived {
        /// By which operation.
        operation: String,
        /// From which entities.
        from: Vec<EntityId>,
    },
}
