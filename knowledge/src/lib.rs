//! What is known of an entity, and how that is known.
//!
//! A [`Record`] has the parts of Piegl et al. 2008, §2: classification, representation, design intent and relationships; the
//! entity's identity adds a revision. Every [`Item`] carries its basis, its tolerance and a hash of the definition that it
//! was computed from, so that knowledge of an older definition shows as stale. The types are plain data with a stable form
//! in serde; numbers of a record are finite, which [`Record::validate`] checks.

mod acquire;
mod bare;
mod build;
mod category;
mod classification;
mod contradiction;
mod definitions;
mod deviation;
mod finite;
mod intent;
mod item;
mod making;
mod operation;
mod prepare;
mod recognise;
mod record;
mod relate;
mod relationship;
mod representation;
mod shape;

pub use acquire::{AcquireOptions, acquire, two_level_estimate};
pub use build::{BuildError, Built};
pub use category::{Categories, Category, InvalidCategories};
pub use classification::{Classification, Kind, Origin};
pub use contradiction::Contradiction;
pub use definitions::Definitions;
pub use deviation::{Deviation, Difference, deviation};
pub use finite::NonFinite;
pub use intent::Intent;
pub use item::{Basis, Item};
pub use making::{Making, MakingError};
pub use operation::{Operation, Takes};
pub use prepare::{InvalidTolerance, PreparedDefinition, clean, cuts, cuts_at, displacement, parted, purge};
pub use recognise::{Refuted, believed_tolerance, class_and_gap, default_tolerance, prove, recognise};
pub use record::Record;
pub use relationship::{Checked, Relation, Relationship, Value};
pub use representation::{Break, Cleaning, Irregularity, ParameterPoint, Representation, SpanSpeed, Speed};
pub use shape::Shape;
