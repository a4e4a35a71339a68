//! A knowledge-guided geometry kernel: certified nearest points on NURBS curves and surfaces.
//!
//! A [`Model`] holds entities, called by [`EntityId`]; a query gives the nearest point of an entity, over the whole of it,
//! and with it a proven lower bound: the true distance lies in `[lower_bound, distance]`.
//!
//! ```
//! use perpend::{CurveData, DVec3, Model};
//!
//! let mut model = Model::new();
//! let bow = CurveData {
//!     degree: 2,
//!     knots: vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0],
//!     control_points: vec![DVec3::new(-1.0, 0.0, 0.0), DVec3::new(0.0, 2.0, 0.0), DVec3::new(1.0, 0.0, 0.0)],
//!     weights: None,
//! };
//! let id = model.insert("bow", bow)?;
//! let foot = model.project(id, DVec3::new(0.0, 3.0, 0.0))?;
//! assert!((foot.distance - 2.0).abs() < 1e-12 && foot.lower_bound <= foot.distance);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Models live in RON files ([`Model::read`], [`Model::write`]). Lengths are in the model's [`Units`]; all numbers are
//! `f64`.

mod batch;
mod body;
mod corner;
mod decompose;
mod dependence;
mod doubts;
mod edit;
mod enter;
mod entity;
mod explain;
mod file;
mod group;
mod impact;
mod learn;
mod make;
mod model;
mod nearest;
mod original;
mod prepare;
mod projector;
mod query;
mod rebuild;
mod referent;
mod replay;
mod shapes;
mod signed_distance;
mod solid;
mod standing;
mod trimmed;
mod trust;
mod units;
mod uses;
mod written;

pub use body::{Body, InvalidBody, Shell};
pub use doubts::Doubt;
pub use edit::EditError;
pub use enter::{Entered, IntoDefinition};
pub use entity::{Entity, EntityError};
pub use file::{AtomicFile, InvalidModel, ModelError, ReadError, WriteError};
pub use impact::{Effect, Impact};
pub use make::MakeError;
pub use model::Model;
pub use original::Original;
pub use prepare::{Consent, Preparation};
pub use projector::Projector;
pub use rebuild::RebuildError;
pub use referent::Referent;
pub use replay::{Replay, ReplayError};
pub use signed_distance::{BodyError, BodyFoot};
pub use solid::BodySide;
pub use trimmed::{Carrier, InvalidTrimmedSurface, TrimmedSurface};
pub use trust::Trust;
pub use units::Units;

pub use glam::{self, DVec3};
pub use perpend_kernel::{
    self as kernel, Aabb, Along, Circle, Cone, CurveData, Cylinder, Definition, DefinitionData, Direction, Ellipse,
    EntityId, Fingerprint, Frame, InvalidDefinition, InvalidTrim, KnotVector, Line, NurbsCurve, NurbsSurface, Plane,
    PlaneCurve, PointIndex, Region, Side, Sphere, SurfaceData, Torus, TrimCurve, TrimCurveData, TrimLoop, TrimLoopData,
    Trimming, TrimmingData,
};
pub use perpend_knowledge::{
    self as knowledge, AcquireOptions, Basis, Categories, Category, Classification, Cleaning, Contradiction,
    Definitions, Intent, Item, Kind, Operation, Origin, Record, Refuted, Relation, Relationship, Representation,
};
pub use perpend_knowledge::{BuildError, Deviation, Difference, Shape};
pub use perpend_projection::{
    self as projection, Certainty, Continuum, Decomposition, Extremum, FootPoint, Method, Multiplicity,
    NewtonTolerances, Parameter, ParameterBox, Place, Plan, Prepared, Query, QueryError, QueryOptions, Reason, Scratch,
    Settings, StationaryOptions, StationaryPoint, StationaryPoints, Statistics, Ties, Wave, WaveSettings, WaveTrace,
    Work,
};

/// The program of the README, run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

/// The programs of the guide, run as tests.
#[cfg(doctest)]
#[doc = include_str!("../docs/guide.md")]
struct Guide;

/// The program of the page on preparation, run as a test.
#[cfg(doctest)]
#[doc = include_str!("../docs/preparation.md")]
struct PreparationPage;

/// The programs of an entity's life, run as tests.
#[cfg(doctest)]
#[doc = include_str!("../docs/life-of-an-entity.md")]
struct Life;
