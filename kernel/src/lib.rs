//! The geometry of perpend: definitions, their evaluation and refinement.
//!
//! This crate evaluates and refines; it never searches, and it knows no knowledge records. All numbers are `f64`, all points
//! [`glam::DVec3`]; knot vectors follow The NURBS Book (clamped, control points + degree + 1 knots).
//!
//! - [`NurbsCurve`] and [`NurbsSurface`] are valid by construction. Evaluating them allocates nothing; editing them (knots,
//!   degree, splits, reversal, domain, maps of space) gives new ones, and all but knot removal leave the shape where it is.
//! - [`Line`], [`Circle`], [`Ellipse`], [`Plane`], [`Cylinder`], [`Cone`], [`Sphere`] and [`Torus`] are plain data with exact
//!   NURBS forms over `[0, 1]`: angles in radians, u along the profile, v around the axis, full turns closed in the same bits.
//! - [`extrusion`], [`ruled`], [`loft`] and [`revolution`] make surfaces of curves; [`curve_through`] and [`surface_through`] interpolate.
//!
//! ```
//! use perpend_kernel::{Cylinder, Direction, Frame, glam::DVec3};
//! use std::f64::consts::TAU;
//!
//! let pipe = Cylinder::new(Frame::WORLD, 1.5, (0.0, 4.0), (0.0, TAU))?.to_nurbs()?;
//! assert_eq!(pipe.point(0.5, 0.25), DVec3::new(0.0, 1.5, 2.0));
//! let (front, back) = pipe.split(Direction::V, 0.5)?;
//! assert_eq!(front.point(0.0, 0.5), back.point(0.0, 0.5));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod basis;
pub mod bezier;
mod bounds;
pub mod clamp;
mod construct;
mod curve;
mod definition;
mod edit;
mod fingerprint;
mod homogeneous;
mod id;
mod invalid;
mod knots;
mod shapes;
mod surface;
mod trim;

pub use basis::binomial;
pub use bounds::Aabb;
pub use construct::{
    InvalidInterpolation, Spacing, curve_through, extrusion, loft, revolution, ruled, surface_through,
};
pub use curve::{CurveData, NurbsCurve};
pub use definition::{Definition, DefinitionData};
pub use edit::{DegreeReduction, InvalidEdit, KnotRemoval, Thinned};
pub use fingerprint::{Fingerprint, InvalidFingerprint};
pub use glam;
pub use homogeneous::{cartesian, homogeneous};
pub use id::EntityId;
pub use invalid::{Along, Direction, InvalidDefinition, PointIndex};
pub use knots::{Break, KnotVector, MAX_DEGREE, Span};
pub use shapes::{Circle, Cone, Cylinder, Ellipse, Frame, Line, Plane, Sphere, Torus};
pub use surface::{NurbsSurface, SurfaceData};
pub use trim::{
    BoundaryPiece, Cover, InvalidTrim, PlaneCurve, Region, Side, TrimCurve, TrimCurveData, TrimEntry, TrimLoop,
    TrimLoopData, Trimming, TrimmingData,
};
