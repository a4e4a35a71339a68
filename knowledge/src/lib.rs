//! What is known of an entity, and how that is known.
//!
//! A [`Record`] has the parts of Piegl et al. 2008, §2: classification, representation, design intent and relationships; the
//! entity's identity adds a revision. Every [`Item`] carries its basis, its tolerance and a hash of the definition that it
//! was computed from, so that knowledge of an older definition shows as stale. The types are plain data with a stable form
//! in serde; numbers of a record are finite, which [`Record::validate`] checks.

mod acquire;
mod bare;
mod category;
mod classification;
mod contradiction;
mod definitions;
mod finite;
mod intent;
mod item;
mod recognise;
mod record;
mod relationship;
mod representation;

pub use acquire::{AcquireOptions, acquire, two_level_estimate};
pub use category::{Categories, Category, InvalidCategories};
pub use classification::{Classification, Kind, Origin};
pub use contradiction::Contradiction;
pub use definitions::Definitions;
pub use finite::NonFinite;
pub use intent::{Intent, Operation};
pub use item::{Basis, Item};
pub use recognise::{Refuted, default_tolerance, prove, recognise};
pub use record::Record;
pub use relationship::{Checked, Relation, Relationship, Value};
pub use representation::{Break, Cleaning, Irregularity, ParameterPoint, Representation, SpanSpeed, Speed};
