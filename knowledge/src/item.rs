//! A piece of knowledge, with how it is known.

use perpend_kernel::Fingerprint;
use serde::{Deserialize, Serialize};

/// How something is known.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Basis {
    /// The entity was made so.
    Defined,
    /// Proved from the definition.
    Proved {
        /// Bound of the deviation that the proof leaves, in the unit of the item.
        gap: f64,
    },
    /// Computed numerically from the definition, without proof.
    Measured {
        /// An estimate of the error, in the unit of the item.
        error: f64,
    },
    /// Fitted to data.
    Fitted {
        /// The largest deviation from the data.
        residual: f64,
        /// How many data points there were.
        points: u64,
    },
    /// Stated by a person or another program, without proof.
    Declared,
}

/// A piece of knowledge: the value, how it is known, how far that may be off, and of which definition.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Item<T> {
    /// What is known.
    pub value: T,
    /// How it is known.
    pub basis: Basis,
    /// The tolerance within which it was accepted, in the unit of the value.
    pub tolerance: f64,
    /// The hash of the definition that it was computed from.
    pub of: Fingerprint,
}

impl<T> Item<T> {
    /// Whether the item was computed from another definition than the one with this hash.
    #[must_use]
    pub fn is_stale(&self, definition: Fingerprint) -> bool {
        self.of != definition
    }
}
