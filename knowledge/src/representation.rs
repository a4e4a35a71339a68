//! How an entity's parametrisation behaves.
//!
//! A curve has the direction U alone.

use perpend_kernel::{Aabb, Direction};
use serde::{Deserialize, Serialize};

use crate::bare;
use crate::category::Category;
use crate::item::Item;

/// How an entity's parametrisation behaves. An absent part is not known; an empty list says "none found".
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Representation {
    /// How fast the point moves with the parameter, per direction.
    #[serde(default, with = "bare", skip_serializing_if = "Option::is_none")]
    pub speed: Option<Vec<Item<Speed>>>,
    /// Parameters where continuity is less than everywhere else.
    #[serde(default, with = "bare", skip_serializing_if = "Option::is_none")]
    pub breaks: Option<Vec<Item<Break>>>,
    /// Places where the parametrisation or the shape is not regular.
    #[serde(default, with = "bare", skip_serializing_if = "Option::is_none")]
    pub irregularities: Option<Vec<Item<Irregularity>>>,
    /// Whether the entity closes on itself, in u and in v.
    #[serde(default, with = "bare", skip_serializing_if = "Option::is_none")]
    pub closed: Option<Item<(bool, bool)>>,
    /// Whether, in u and in v, it closes on itself and goes on over the seam without a jump of its first derivative.
    #[serde(default, with = "bare", skip_serializing_if = "Option::is_none")]
    pub periodic: Option<Item<(bool, bool)>>,
    /// A box that holds the entity.
    #[serde(default, rename = "box", with = "bare", skip_serializing_if = "Option::is_none")]
    pub bounds: Option<Item<Aabb>>,
    /// The arc length of a curve, in the model's unit.
    #[serde(default, with = "bare", skip_serializing_if = "Option::is_none")]
    pub length: Option<Item<f64>>,
    /// The area of a surface, in the square of the model's unit.
    #[serde(default, with = "bare", skip_serializing_if = "Option::is_none")]
    pub area: Option<Item<f64>>,
    /// The smallest and the largest weight.
    #[serde(default, with = "bare", skip_serializing_if = "Option::is_none")]
    pub weights: Option<Item<(f64, f64)>>,
    /// What was done to the defining data: on their way in, by cleaning, or by purging.
    #[serde(default, with = "bare", skip_serializing_if = "Option::is_none")]
    pub cleaning: Option<Vec<Item<Cleaning>>>,
}

/// How fast the point moves with one parameter, over the whole entity and span by span.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Speed {
    /// The parameter.
    pub direction: Direction,
    /// The least length of the first derivative. Where it was proved, none is below it, and the item's gap says how near to it
    /// one comes.
    pub min: f64,
    /// The greatest length of the first derivative; proved as `min` is.
    pub max: f64,
    /// The parametrisation factor `(max - min) / max`; 1 where `max` is 0 (Piegl et al. 2008, §5).
    pub factor: f64,
    /// Where the least one is.
    #[serde(default, with = "bare", skip_serializing_if = "Option::is_none")]
    pub min_at: Option<ParameterPoint>,
    /// Where the greatest one is.
    #[serde(default, with = "bare", skip_serializing_if = "Option::is_none")]
    pub max_at: Option<ParameterPoint>,
    /// The category of the factor, with the settings that it chooses.
    #[serde(default, with = "bare", skip_serializing_if = "Option::is_none")]
    pub category: Option<Category>,
    /// The same for every span of the parameter, ascending.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub spans: Vec<SpanSpeed>,
}

/// How fast the point moves over one span of a parameter, over the whole of the other one where there is one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SpanSpeed {
    /// Where the span starts.
    pub from: f64,
    /// Where it ends.
    pub to: f64,
    /// As in [`Speed`].
    pub min: f64,
    /// As in [`Speed`].
    pub max: f64,
    /// As in [`Speed`].
    pub factor: f64,
}

/// A parameter where continuity is less than everywhere else.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Break {
    /// The parameter's direction.
    pub direction: Direction,
    /// Its value.
    pub at: f64,
    /// The order of parametric continuity: derivatives up to it are equal within `c_within`.
    pub c: u32,
    /// The order of geometric continuity, at most 2 where `c` is less: tangents (tangent planes) and curvatures up to it are
    /// equal within `g_within`.
    pub g: u32,
    /// The largest jump that the orders up to `c` may have: the terms of the Taylor series over the longer one of both spans, as
    /// a share of the size of both. 0 where the knots alone promise the order.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub c_within: f64,
    /// The largest angle by which the tangent (the tangent plane) turns, in radians, and for order 2 the angle that the jump of
    /// the curvature makes over the size of both spans; 0 where `c` says as much.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub g_within: f64,
}

/// A place in the parameters of an entity.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum ParameterPoint {
    /// The parameter of a curve.
    Curve(f64),
    /// The parameters of a surface.
    Surface(f64, f64),
    /// The whole iso-curve of a surface at this value of a parameter.
    Iso(Direction, f64),
}

/// A place where the parametrisation or the shape is not regular.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Irregularity {
    /// The curve stops and goes on in another direction; the normal of a surface vanishes, and is another one beside.
    Cusp {
        /// Where.
        at: ParameterPoint,
        /// The angle by which the tangent (the normal) turns, in radians.
        angle: f64,
    },
    /// An edge of the surface's domain is a single point.
    Pole {
        /// The parameter that is constant along the edge.
        direction: Direction,
        /// Its value there.
        at: f64,
        /// The largest distance between two points of the edge.
        extent: f64,
    },
    /// The entity closes on itself: the start and the end of this parameter are one place.
    Seam {
        /// The parameter.
        direction: Direction,
        /// The largest distance between corresponding points; left out where it is 0.
        #[serde(default, skip_serializing_if = "is_zero")]
        gap: f64,
        /// The orders of parametric and geometric continuity over the seam, as in [`Break`]; absent: not known.
        #[serde(default, with = "bare", skip_serializing_if = "Option::is_none")]
        order: Option<(u32, u32)>,
    },
    /// The first derivative in a parameter vanishes.
    VanishingDerivative {
        /// The parameter.
        direction: Direction,
        /// Where.
        at: ParameterPoint,
        /// The length of the derivative there.
        speed: f64,
    },
    /// The normal of a surface vanishes: the derivatives in u and in v are parallel there, or one of them vanishes.
    VanishingNormal {
        /// Where.
        at: ParameterPoint,
        /// The length of the cross product of the derivatives there.
        area: f64,
    },
    /// The tangent (the tangent plane) turns abruptly.
    Crease {
        /// The parameter at whose value it turns.
        direction: Direction,
        /// The value.
        at: f64,
        /// The largest angle by which it turns, in radians.
        angle: f64,
    },
    /// A curve meets itself.
    Loop {
        /// The parameter at which it is there first.
        from: f64,
        /// The parameter at which it comes back.
        to: f64,
        /// The distance between the two points.
        gap: f64,
    },
    /// The curvature of a curve changes its sign.
    Inflection {
        /// Where.
        at: ParameterPoint,
        /// The curvature beside it, on the side where that is greater, in the inverse of the model's unit.
        #[serde(default, skip_serializing_if = "is_zero")]
        curvature: f64,
    },
    /// The curvature of a curve is zero and keeps its sign: a straight stretch, or a point, where `from` is `to`.
    ZeroCurvature {
        /// Where it starts.
        from: f64,
        /// Where it ends.
        to: f64,
        /// The greatest curvature that was met there, in the inverse of the model's unit.
        #[serde(default, skip_serializing_if = "is_zero")]
        curvature: f64,
    },
    /// Two knots nearly coincide.
    NearKnots {
        /// Their direction.
        direction: Direction,
        /// The lower one.
        at: f64,
        /// Their distance as a share of the domain.
        apart: f64,
    },
    /// A span of the entity is very small.
    TinySpan {
        /// Its direction.
        direction: Direction,
        /// The parameter at which it starts.
        at: f64,
        /// The diagonal of its control points' box.
        extent: f64,
    },
}

fn is_zero(x: &f64) -> bool {
    x.to_bits() == 0
}

/// What was done to the defining data: on their way in, by cleaning, or by purging.
///
/// The basis of an item bounds how far points moved: of a cleaning, by all its steps together; of a purge, from the original that
/// is kept.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum Cleaning {
    /// The knots were not clamped; they were, by knot insertion, which leaves the entity as it is.
    Clamped {
        /// The direction of the knots.
        direction: Direction,
    },
    /// P-curves of the entity's trim left the domain, and were clamped to it.
    TrimClamped {
        /// By how much they left it, as a share of its extent in u and in v.
        share: (f64, f64),
    },
    /// Knots without which the entity is the same were removed.
    RemovedKnots {
        /// Their direction.
        direction: Direction,
        /// The knots, ascending, each as often as it was removed.
        knots: Vec<f64>,
    },
    /// The degree was higher than the entity needs, and was lowered.
    ReducedDegree {
        /// The direction.
        direction: Direction,
        /// The degree before.
        from: usize,
        /// The degree after.
        to: usize,
    },
    /// All weights were one number, and were left out.
    DroppedWeights {
        /// The number.
        weight: f64,
    },
    /// Knots were removed, and near ones merged, within a tolerance that the application named: the item's.
    Purged {
        /// Their direction.
        direction: Direction,
        /// The knots that went, ascending, each as often as it did.
        removed: Vec<f64>,
        /// The knots that others were merged into, as often as they were added.
        added: Vec<f64>,
    },
}
