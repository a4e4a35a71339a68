//! How an entity was made, and why so.

use glam::DVec3;
use perpend_kernel::{Direction, EntityId};
use serde::{Deserialize, Serialize};

/// An operation that took part in making an entity.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Intent {
    /// The operation with its parameters.
    pub operation: Operation,
    /// The entities that it worked on.
    #[serde(default)]
    pub inputs: Vec<EntityId>,
    /// What else was considered.
    #[serde(default)]
    pub alternatives: Vec<String>,
    /// What was decided, and why.
    #[serde(default)]
    pub decision: String,
}

/// An operation with its parameters. Lengths are in the model's unit, angles in radians.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Operation {
    /// A segment between two points.
    LineByPoints {
        /// Where it starts.
        start: DVec3,
        /// Where it ends.
        end: DVec3,
    },
    /// A circle about a centre.
    CircleByCentre {
        /// The centre.
        centre: DVec3,
        /// The normal of its plane.
        axis: DVec3,
        /// The radius.
        radius: f64,
    },
    /// An arc about a centre.
    ArcByCentre {
        /// The centre.
        centre: DVec3,
        /// The normal of its plane.
        axis: DVec3,
        /// The direction of angle 0.
        xdir: DVec3,
        /// The radius.
        radius: f64,
        /// The angles at its ends.
        sweep: (f64, f64),
    },
    /// The arc through three points.
    ArcByPoints {
        /// Where it starts.
        start: DVec3,
        /// A point on the way.
        through: DVec3,
        /// Where it ends.
        end: DVec3,
    },
    /// An interpolation of points.
    Interpolation {
        /// The degrees; on a curve the second is 0.
        degree: (u32, u32),
        /// The points; of a surface, row after row along v.
        points: Vec<DVec3>,
    },
    /// An approximation of points.
    Approximation {
        /// The degrees; on a curve the second is 0.
        degree: (u32, u32),
        /// How many points.
        points: u64,
        /// The tolerance that was asked for.
        tolerance: f64,
    },
    /// The input, moved along a vector.
    Extrude {
        /// The vector.
        vector: DVec3,
    },
    /// The input, turned about an axis.
    Revolve {
        /// A point of the axis.
        origin: DVec3,
        /// The axis.
        axis: DVec3,
        /// The angle.
        angle: f64,
    },
    /// The straight lines between corresponding points of two inputs.
    Rule,
    /// A surface through the inputs.
    Loft {
        /// The degree across the inputs.
        degree: u32,
    },
    /// The input, at a distance.
    Offset {
        /// The distance, positive on the normal's side.
        distance: f64,
    },
    /// The iso-curve of the input.
    IsoCurve {
        /// The parameter that is constant.
        direction: Direction,
        /// Its value.
        at: f64,
    },
    /// The part of the input between two values of a parameter.
    Split {
        /// The parameter.
        direction: Direction,
        /// The values.
        range: (f64, f64),
    },
    /// A rigid motion with scaling: `p ↦ columns · p + translation`.
    Transform {
        /// The images of the three unit vectors.
        columns: (DVec3, DVec3, DVec3),
        /// The image of the origin.
        translation: DVec3,
    },
    /// The defining data were entered as they are.
    ByData,
    /// An operation of an application.
    Other {
        /// Its name there.
        name: String,
    },
}
