//! The geometry of perpend: definitions, their evaluation and refinement.
//!
//! This crate evaluates and refines; it never searches, and it knows no knowledge records. All numbers are `f64`, all points
//! [`glam::DVec3`]; knot vectors follow The NURBS Book (clamped, control points + degree + 1 knots).

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

pub use basis::binomial;
pub use bounds::Aabb;
pub use construct::{InvalidInterpolation, Spacing, curve_through, extrusion, revolution, ruled, surface_through};
pub use curve::{CurveData, NurbsCurve};
pub use definition::{Definition, DefinitionData};
pub use edit::{InvalidEdit, KnotRemoval};
pub use fingerprint::{Fingerprint, InvalidFingerprint};
pub use glam;
pub use homogeneous::{cartesian, homogeneous};
pub use id::EntityId;
pub use invalid::{Along, Direction, InvalidDefinition, PointIndex};
pub use knots::{Break, KnotVector, MAX_DEGREE, Span};
pub use shapes::{Circle, Cone, Cylinder, Ellipse, Frame, Line, Plane, Sphere, Torus};
pub use surface::{NurbsSurface, SurfaceData};
