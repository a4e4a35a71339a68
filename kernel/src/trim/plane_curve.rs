//! Curves in the parameters of a surface.

use glam::{DVec2, DVec3};

use crate::bezier::{BezierCurve, curve_pieces};
use crate::curve::NurbsCurve;
use crate::invalid::InvalidDefinition;
use crate::knots::KnotVector;

/// A p-curve: a NURBS curve whose points are parameters `(u, v)` of a surface.
///
/// Valid as every [`NurbsCurve`] is; it is one, in the plane.
#[derive(Debug, Clone, PartialEq)]
pub struct PlaneCurve(NurbsCurve);

impl PlaneCurve {
    /// A curve from its defining data; ends of the knot vector that are not clamped are clamped.
    ///
    /// # Errors
    ///
    /// The first rule that the data break: see [`InvalidDefinition`].
    pub fn new(
        degree: usize,
        knots: Vec<f64>,
        points: Vec<DVec2>,
        weights: Option<Vec<f64>>,
    ) -> Result<Self, InvalidDefinition> {
        let points = points.into_iter().map(|point| point.extend(0.0)).collect();
        NurbsCurve::new(degree, knots, points, weights).map(Self)
    }

    /// The straight way between two points, over `[0, 1]`.
    ///
    /// # Errors
    ///
    /// Points that are one, or not finite.
    pub fn line(from: DVec2, to: DVec2) -> Result<Self, InvalidDefinition> {
        Self::new(1, vec![0.0, 0.0, 1.0, 1.0], vec![from, to], None)
    }

    /// The degree.
    #[must_use]
    pub fn degree(&self) -> usize {
        self.0.degree()
    }

    /// The knot vector.
    #[must_use]
    pub fn knots(&self) -> &KnotVector {
        self.0.knots()
    }

    /// The control points.
    pub fn points(&self) -> impl ExactSizeIterator<Item = DVec2> + Clone + '_ {
        self.0.control_points().iter().map(|point| point.truncate())
    }

    /// The weights, one a control point; none where all are 1.
    #[must_use]
    pub fn weights(&self) -> Option<&[f64]> {
        self.0.weights()
    }

    /// The first and the last parameter.
    #[must_use]
    pub fn domain(&self) -> (f64, f64) {
        self.0.domain()
    }

    /// The parameters of the surface at `t`; outside the domain, at the nearer end.
    #[must_use]
    pub fn point(&self, t: f64) -> DVec2 {
        self.0.point(t).truncate()
    }

    /// Where it begins: the first control point, to the bit.
    #[must_use]
    pub fn start(&self) -> DVec2 {
        self.0.control_points()[0].truncate()
    }

    /// Where it ends: the last control point, to the bit.
    #[must_use]
    pub fn end(&self) -> DVec2 {
        self.0.control_points()[self.0.control_points().len() - 1].truncate()
    }

    /// Point and derivatives at `t`: `out[k]` becomes the `k`-th derivative; at a knot those from the right.
    pub fn derivatives(&self, t: f64, out: &mut [DVec2]) {
        let mut space = vec![DVec3::ZERO; out.len()];
        self.0.derivatives(t, &mut space);
        out.iter_mut().zip(space).for_each(|(out, space)| *out = space.truncate());
    }

    /// The same curve run through the other way, over the same domain.
    #[must_use]
    pub fn reversed(&self) -> Self {
        Self(self.0.reversed())
    }

    /// The Bézier pieces, homogeneous with `z = 0`, in ascending order.
    #[must_use]
    pub fn pieces(&self) -> Vec<BezierCurve> {
        curve_pieces(self.0.knots(), &self.0.homogeneous_points())
    }

    /// The curve in the plane `z = 0` of space.
    #[must_use]
    pub fn as_curve(&self) -> &NurbsCurve {
        &self.0
    }

    /// With knots at the middles of all spans: control points closer to the curve.
    pub(crate) fn refined(&self) -> Option<Self> {
        let middles: Vec<f64> = self.knots().spans().map(|span| 0.5 * (span.start + span.end)).collect();
        self.0.refine(&middles).ok().map(Self)
    }

    /// With every control point moved into a box.
    pub(crate) fn clamped(&self, min: DVec2, max: DVec2) -> Result<Self, InvalidDefinition> {
        let points = self.points().map(|point| point.clamp(min, max)).collect();
        Self::new(self.degree(), self.knots().as_slice().to_vec(), points, self.weights().map(<[f64]>::to_vec))
    }
}
