//! Operations that make entities.

use glam::DVec3;
use perpend_kernel::{Direction, Spacing};
use serde::{Deserialize, Serialize};

use crate::bare;

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
        /// The direction of angle 0, where the circle starts; none: any across the axis.
        #[serde(default, with = "bare", skip_serializing_if = "Option::is_none")]
        xdir: Option<DVec3>,
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
    /// An ellipse or an arc of one, about a centre.
    EllipseByCentre {
        /// The centre.
        centre: DVec3,
        /// The normal of its plane.
        axis: DVec3,
        /// The direction of the first half-axis, of eccentric angle 0.
        xdir: DVec3,
        /// The half-axes along `xdir` and along `axis × xdir`.
        radii: (f64, f64),
        /// The eccentric angles at its ends.
        sweep: (f64, f64),
    },
    /// A rectangle of a plane.
    PlaneByFrame {
        /// The origin of `width` and `height`.
        origin: DVec3,
        /// The normal.
        normal: DVec3,
        /// The direction of `width`.
        xdir: DVec3,
        /// From where to where along `xdir`.
        width: (f64, f64),
        /// From where to where along `normal × xdir`.
        height: (f64, f64),
    },
    /// A cylinder about an axis.
    CylinderByFrame {
        /// A point of the axis, the origin of `height`.
        centre: DVec3,
        /// The axis.
        axis: DVec3,
        /// The direction of angle 0.
        xdir: DVec3,
        /// The radius.
        radius: f64,
        /// From where to where along the axis.
        height: (f64, f64),
        /// The angles at its ends.
        sweep: (f64, f64),
    },
    /// A cone about an axis.
    ConeByFrame {
        /// A point of the axis, the origin of `height`.
        centre: DVec3,
        /// The axis.
        axis: DVec3,
        /// The direction of angle 0.
        xdir: DVec3,
        /// The radii at the first and at the last height; 0 is the apex.
        radii: (f64, f64),
        /// From where to where along the axis.
        height: (f64, f64),
        /// The angles at its ends.
        sweep: (f64, f64),
    },
    /// A sphere about a centre.
    SphereByCentre {
        /// The centre.
        centre: DVec3,
        /// From the south pole to the north pole.
        axis: DVec3,
        /// The direction of longitude 0.
        xdir: DVec3,
        /// The radius.
        radius: f64,
        /// The first and the last latitude.
        latitude: (f64, f64),
        /// The first and the last longitude.
        sweep: (f64, f64),
    },
    /// A torus about an axis.
    TorusByFrame {
        /// The centre.
        centre: DVec3,
        /// The axis.
        axis: DVec3,
        /// The direction of angle 0 about the axis.
        xdir: DVec3,
        /// The radius of the circle of the tube's centres.
        major_radius: f64,
        /// The radius of the tube.
        minor_radius: f64,
        /// The angles about the tube at its ends: 0 is outermost.
        tube: (f64, f64),
        /// The angles about the axis at its ends.
        sweep: (f64, f64),
    },
    /// An interpolation of points.
    Interpolation {
        /// The degrees; on a curve the second is 0.
        degree: (u32, u32),
        /// The points; of a surface, row after row, a row along v.
        points: Vec<DVec3>,
        /// How many points a row of a surface has; of a curve 0.
        #[serde(default)]
        columns: u64,
        /// How the parameters of the points are spread.
        #[serde(default)]
        spacing: Spacing,
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
    /// A surface through the inputs, in their order.
    Loft {
        /// The degree across the inputs.
        degree: u32,
    },
    /// The input, at a distance.
    Offset {
        /// The distance: of a surface, positive on the side of its normal `S_u × S_v`; of a curve, on that of its tangent ×
        /// `normal`.
        distance: f64,
        /// Of a curve, the normal of the plane in which it is offset; none: of a circle, its axis, so that a positive
        /// distance leads outwards.
        #[serde(default, with = "bare", skip_serializing_if = "Option::is_none")]
        normal: Option<DVec3>,
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
        /// The parameter; of a curve it does not matter.
        direction: Direction,
        /// The values.
        range: (f64, f64),
    },
    /// The input under an affine map, `p ↦ columns · p + translation`: a motion, a scaling, a mirroring.
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

/// How many entities an operation takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Takes {
    /// So many.
    Exactly(usize),
    /// So many or more.
    AtLeast(usize),
    /// Any number: what the operation does with them is not known here.
    Any,
}

impl std::fmt::Display for Takes {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let entities = |count: &usize| if *count == 1 { "entity" } else { "entities" };
        match self {
            Self::Exactly(0) => f.write_str("no entities"),
            Self::Exactly(count) => write!(f, "{count} {}", entities(count)),
            Self::AtLeast(count) => write!(f, "at least {count} {}", entities(count)),
            Self::Any => f.write_str("any number of entities"),
        }
    }
}

impl Operation {
    /// Its name, as files write it.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::LineByPoints { .. } => "LineByPoints",
            Self::CircleByCentre { .. } => "CircleByCentre",
            Self::ArcByCentre { .. } => "ArcByCentre",
            Self::ArcByPoints { .. } => "ArcByPoints",
            Self::EllipseByCentre { .. } => "EllipseByCentre",
            Self::PlaneByFrame { .. } => "PlaneByFrame",
            Self::CylinderByFrame { .. } => "CylinderByFrame",
            Self::ConeByFrame { .. } => "ConeByFrame",
            Self::SphereByCentre { .. } => "SphereByCentre",
            Self::TorusByFrame { .. } => "TorusByFrame",
            Self::Interpolation { .. } => "Interpolation",
            Self::Approximation { .. } => "Approximation",
            Self::Extrude { .. } => "Extrude",
            Self::Revolve { .. } => "Revolve",
            Self::Rule => "Rule",
            Self::Loft { .. } => "Loft",
            Self::Offset { .. } => "Offset",
            Self::IsoCurve { .. } => "IsoCurve",
            Self::Split { .. } => "Split",
            Self::Transform { .. } => "Transform",
            Self::ByData => "ByData",
            Self::Other { .. } => "Other",
        }
    }

    /// How many entities it takes.
    #[must_use]
    pub fn takes(&self) -> Takes {
        match self {
            Self::Extrude { .. }
            | Self::Revolve { .. }
            | Self::Offset { .. }
            | Self::IsoCurve { .. }
            | Self::Split { .. }
            | Self::Transform { .. } => Takes::Exactly(1),
            Self::Rule => Takes::Exactly(2),
            Self::Loft { .. } => Takes::AtLeast(2),
            Self::Approximation { .. } | Self::Other { .. } => Takes::Any,
            _ => Takes::Exactly(0),
        }
    }
}
