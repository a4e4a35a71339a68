//! What decides when knowledge is acquired.

use crate::category::Categories;

/// What decides when knowledge is acquired. Every tolerance is a share, so that it fits any unit.
#[derive(Debug, Clone, PartialEq)]
pub struct AcquireOptions {
    /// The table that names parametrisation factors and chooses their settings.
    pub categories: Categories,
    /// Points of an entity are one within this share of its size: seams, poles and loops.
    pub coincidence: f64,
    /// Continuity holds up to this jump: for parametric orders a share of the neighbouring spans' size, for geometric ones an
    /// angle in radians. A tangent (tangent plane) that turns by more makes a crease.
    pub continuity: f64,
    /// A derivative vanishes where, times the length of its parameter's domain, it is below this share of the size.
    pub vanishing: f64,
    /// Knots nearly coincide below this share of the mean span.
    pub near_knots: f64,
    /// A span is tiny where its control points' box is below this share of the size.
    pub tiny_span: f64,
    /// How much work the bounds of speeds and the search for vanishing normals may take, in products of coefficients, for each
    /// direction of an entity: about a nanosecond each. Bounds stay proven whatever it is, and get wider.
    pub work: u64,
}

impl Default for AcquireOptions {
    fn default() -> Self {
        Self {
            categories: Categories::default(),
            coincidence: 1e-9,
            continuity: 1e-7,
            vanishing: 1e-9,
            near_knots: 1e-6,
            tiny_span: 1e-6,
            work: 200_000_000,
        }
    }
}
