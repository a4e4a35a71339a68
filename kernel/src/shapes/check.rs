//! What the parameters of shapes must be.

use std::f64::consts::TAU;

use crate::invalid::InvalidDefinition;

pub(crate) fn refuse<T>(
    what: &'static str,
    value: impl std::fmt::Display,
    expected: &'static str,
) -> Result<T, InvalidDefinition> {
    Err(InvalidDefinition::Shape { what, value: value.to_string(), expected })
}

/// A length of a shape: positive and finite.
pub(super) fn positive(what: &'static str, value: f64) -> Result<(), InvalidDefinition> {
    if value > 0.0 && value.is_finite() { Ok(()) } else { refuse(what, value, "it must be positive and finite") }
}

/// A range of a length or an angle: finite, and not empty.
pub(super) fn ascending(what: &'static str, range: (f64, f64)) -> Result<(), InvalidDefinition> {
    if range.0 < range.1 && range.0.is_finite() && range.1.is_finite() {
        Ok(())
    } else {
        refuse(what, format_args!("{range:?}"), "it must ascend between finite bounds")
    }
}

/// A range of angles: not empty, and at most one turn.
pub(crate) fn sweep(what: &'static str, range: (f64, f64)) -> Result<(), InvalidDefinition> {
    ascending(what, range)?;
    if range.1 - range.0 <= TAU || is_full(range) {
        Ok(())
    } else {
        refuse(what, format_args!("{range:?}"), "it must span at most a full turn, 2π radians")
    }
}

/// Whether a range of angles is a full turn, but for the rounding of its two ends and of their difference.
pub(super) fn is_full(range: (f64, f64)) -> bool {
    let largest = range.0.abs().max(range.1.abs()).max(TAU);
    ((range.1 - range.0) - TAU).abs() <= 2.0 * f64::EPSILON * largest
}
