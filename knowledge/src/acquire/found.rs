//! An irregularity on its way into a record.

use crate::item::Basis;
use crate::representation::Irregularity;

/// An irregularity, how it is known, and with which tolerance it was looked for.
pub(super) type Found = (Irregularity, Basis, f64);

/// What was proved up to a gap.
pub(super) fn proved(value: Irregularity, gap: f64, tolerance: f64) -> Found {
    (value, Basis::Proved { gap }, tolerance)
}

/// What was computed without proof.
pub(super) fn measured(value: Irregularity, error: f64, tolerance: f64) -> Found {
    (value, Basis::Measured { error }, tolerance)
}
