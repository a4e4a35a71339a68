//! How an entity depends on others.

use std::collections::BTreeMap;

use glam::DVec3;
use perpend_kernel::{EntityId, Fingerprint};
use serde::{Deserialize, Serialize};

/// A relationship to another entity, with all parameters that replaying it needs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Relationship {
    /// What the other entity is to this one.
    pub kind: Relation,
    /// The other entity.
    pub target: EntityId,
    /// The parameters, by name.
    #[serde(default)]
    pub parameters: BTreeMap<String, Value>,
    /// When it last held; none: not checked.
    #[serde(default)]
    pub checked: Option<Checked>,
}

/// What another entity is to this one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Relation {
    /// The shape that defines it.
    Definition,
    /// An edge of it.
    Boundary,
    /// The curve that was swept to make it.
    Profile,
    /// The line about which it was turned.
    Axis,
    /// One of the two curves between which it is ruled.
    Rail,
    /// A curve through which it was lofted.
    Section,
    /// The entity at a distance from which it lies.
    Offset,
    /// The data to which it was fitted.
    FittedTo,
    /// The entity of which it is an iso-curve.
    IsoCurveOf,
    /// The entity of which it is a part.
    PartOf,
    /// The entity of which it is a moved copy.
    CopyOf,
    /// A relationship of an application.
    Other(String),
}

/// A parameter of a relationship.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Value {
    /// A number.
    Number(f64),
    /// Several numbers.
    Numbers(Vec<f64>),
    /// A point or a vector.
    Point(DVec3),
    /// A text.
    Text(String),
    /// Yes or no.
    Flag(bool),
}

/// A check of a relationship: it was replayed and compared with the entity.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Checked {
    /// How far the entity was from its replay.
    pub deviation: f64,
    /// The tolerance within which that is accepted.
    pub tolerance: f64,
    /// The hash of the entity's definition at that time.
    pub of: Fingerprint,
    /// The hash of the target's definition at that time.
    pub target: Fingerprint,
}
