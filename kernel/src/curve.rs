//! NURBS curves.

use glam::{DVec3, DVec4};
use serde::{Deserialize, Serialize};

use crate::basis::{self, LOW_DEGREE, ROOM};
use crate::bounds::Aabb;
use crate::clamp::{self, Entry};
use crate::homogeneous::{cartesian, homogeneous, rational_derivatives, rational_low_derivatives};
use crate::invalid::{Along, InvalidDefinition, PointIndex};
use crate::knots::KnotVector;

/// A NURBS curve in space: degree, clamped knots (control points + degree + 1 of them), control points, weights.
///
/// Every value of this type is valid: counts agree, knots do not decrease, numbers are finite, weights positive, and the
/// control points are not all one.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(try_from = "CurveData")]
pub struct NurbsCurve {
    pub(crate) knots: KnotVector,
    pub(crate) control_points: Vec<DVec3>,
    pub(crate) weights: Option<Vec<f64>>,
}

/// The data of a curve as a file holds it, not validated.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename = "NurbsCurve", deny_unknown_fields)]
pub struct CurveData {
    /// The degree.
    pub degree: usize,
    /// The knots: control points + degree + 1 of them.
    pub knots: Vec<f64>,
    /// The control points.
    pub control_points: Vec<DVec3>,
    /// One weight a control point; none: all 1.
    #[serde(default)]
    pub weights: Option<Vec<f64>>,
}

impl NurbsCurve {
    /// A curve from its defining data; ends of the knot vector that are not clamped are clamped by knot insertion, which
    /// does not change the curve.
    ///
    /// # Errors
    ///
    /// The first rule that the data break: see [`InvalidDefinition`].
    pub fn new(
        degree: usize,
        knots: Vec<f64>,
        control_points: Vec<DVec3>,
        weights: Option<Vec<f64>>,
    ) -> Result<Self, InvalidDefinition> {
        Self::enter(CurveData { degree, knots, control_points, weights }).map(|(curve, _)| curve)
    }

    /// As [`new`](Self::new), and says what had to be done on entry.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new).
    pub fn enter(data: CurveData) -> Result<(Self, Entry), InvalidDefinition> {
        let CurveData { degree, knots, control_points, weights } = data;
        let along = Along::Curve;
        check_points(control_points.len(), control_points.iter().copied(), PointIndex::Curve)?;
        crate::knots::check_order(degree, &knots, control_points.len(), along)?;
        if let Some(weights) = &weights {
            if weights.len() != control_points.len() {
                return Err(InvalidDefinition::WeightCount { found: weights.len(), points: control_points.len() });
            }
            check_weights(weights, PointIndex::Curve)?;
        }
        let entry = Entry { clamped: [clamp::needed(degree, &knots, along)?, false] };
        if entry.clamped[0] {
            let net: Vec<DVec4> = net(&control_points, weights.as_deref());
            let (knots, net) = clamp::clamp(degree, knots, net, along)?;
            return Ok((Self::from_homogeneous(knots, &net, weights.is_some()), entry));
        }
        let knots = KnotVector::new(degree, knots, control_points.len(), along)?;
        Ok((Self { knots, control_points, weights }, entry))
    }

    /// A curve from a knot vector and homogeneous control points; `rational` says whether the weights are kept.
    pub(crate) fn from_homogeneous(knots: KnotVector, net: &[DVec4], rational: bool) -> Self {
        debug_assert_eq!(knots.point_count(), net.len(), "knots and control points disagree");
        Self {
            knots,
            control_points: net.iter().map(|h| if rational { cartesian(*h) } else { h.truncate() }).collect(),
            weights: rational.then(|| net.iter().map(|h| h.w).collect()),
        }
    }

    /// A curve from knots that fit, and points and weights still to be checked.
    pub(crate) fn checked(
        knots: KnotVector,
        control_points: Vec<DVec3>,
        weights: Option<Vec<f64>>,
    ) -> Result<Self, InvalidDefinition> {
        debug_assert_eq!(knots.point_count(), control_points.len(), "knots and control points disagree");
        check_points(control_points.len(), control_points.iter().copied(), PointIndex::Curve)?;
        check_weights(weights.as_deref().unwrap_or_default(), PointIndex::Curve)?;
        Ok(Self { knots, control_points, weights })
    }

    /// The degree.
    #[must_use]
    #[inline]
    pub fn degree(&self) -> usize {
        self.knots.degree()
    }

    /// The knot vector.
    #[must_use]
    #[inline]
    pub fn knots(&self) -> &KnotVector {
        &self.knots
    }

    /// The control points.
    #[must_use]
    #[inline]
    pub fn control_points(&self) -> &[DVec3] {
        &self.control_points
    }

    /// The weights, one a control point; none where all are 1.
    #[must_use]
    #[inline]
    pub fn weights(&self) -> Option<&[f64]> {
        self.weights.as_deref()
    }

    /// The first and the last parameter.
    #[must_use]
    #[inline]
    pub fn domain(&self) -> (f64, f64) {
        self.knots.domain()
    }

    /// The control points in homogeneous form; weight 1 where the curve has none.
    #[must_use]
    pub fn homogeneous_points(&self) -> Vec<DVec4> {
        net(&self.control_points, self.weights())
    }

    /// The box of the control points, which holds the curve.
    #[must_use]
    pub fn control_box(&self) -> Aabb {
        Aabb::around(self.control_points.iter().copied())
    }

    /// The point at `u`; parameters outside the domain give the nearer end.
    ///
    /// # Accuracy
    ///
    /// Within a few `degree * ε` times the largest coordinate (basis functions are non-negative and add up to 1).
    #[must_use]
    pub fn point(&self, u: f64) -> DVec3 {
        match self.degree() {
            0..=LOW_DEGREE => {
                let u = self.knots.clamp(u);
                self.low_derivatives::<1>(u, self.knots.find_span(u))[0]
            }
            6..=7 => self.point_with_room::<8>(u),
            _ => self.point_with_room::<ROOM>(u),
        }
    }

    #[inline(never)]
    fn point_with_room<const R: usize>(&self, u: f64) -> DVec3 {
        let u = self.knots.clamp(u);
        let (p, span) = (self.degree(), self.knots.find_span(u));
        let values = basis::functions::<R>(&self.knots, span, u);
        let points = &self.control_points[span - p..=span];
        match &self.weights {
            None => points.iter().zip(&values).fold(DVec3::ZERO, |sum, (point, b)| sum + *b * *point),
            Some(weights) => {
                let weights = &weights[span - p..=span];
                let mut sum = DVec4::ZERO;
                for ((point, w), b) in points.iter().zip(weights).zip(&values) {
                    sum += *b * homogeneous(*point, *w);
                }
                cartesian(sum)
            }
        }
    }

    /// Point and derivatives at `u`: `out[k]` becomes the `k`-th derivative, for every `k < out.len()`.
    ///
    /// At a knot the derivatives are those from the right (at the end of the domain, from the left). Nothing is
    /// allocated. The NURBS Book, algorithms A3.2 and A4.2.
    pub fn derivatives(&self, u: f64, out: &mut [DVec3]) {
        let u = self.knots.clamp(u);
        self.derivatives_in_span(u, self.knots.find_span(u), out);
    }

    /// As [`derivatives`](Self::derivatives), from the left where `u` is a knot.
    pub fn derivatives_from_left(&self, u: f64, out: &mut [DVec3]) {
        let u = self.knots.clamp(u);
        let mut span = self.knots.find_span(u);
        let t = self.knots.as_slice();
        while span > self.degree() && t[span] >= u {
            span -= 1;
        }
        self.derivatives_in_span(u, span, out);
    }

    fn derivatives_in_span(&self, u: f64, span: usize, out: &mut [DVec3]) {
        if out.is_empty() {
            return;
        }
        match (self.degree(), out.len()) {
            (0..=LOW_DEGREE, 1) => out.copy_from_slice(&self.low_derivatives::<1>(u, span)),
            (0..=LOW_DEGREE, 2) => out.copy_from_slice(&self.low_derivatives::<2>(u, span)),
            (0..=LOW_DEGREE, 3) => out.copy_from_slice(&self.low_derivatives::<3>(u, span)),
            (0..=7, _) => self.derivatives_with_room::<8>(u, span, out),
            _ => self.derivatives_with_room::<ROOM>(u, span, out),
        }
    }

    /// The derivatives of orders less than `D`, which is at most 3; the degree is low.
    fn low_derivatives<const D: usize>(&self, u: f64, span: usize) -> [DVec3; D] {
        match self.degree() {
            1 => self.low_derivatives_of::<2, D>(u, span),
            2 => self.low_derivatives_of::<3, D>(u, span),
            3 => self.low_derivatives_of::<4, D>(u, span),
            4 => self.low_derivatives_of::<5, D>(u, span),
            _ => self.low_derivatives_of::<6, D>(u, span),
        }
    }

    /// As [`low_derivatives`](Self::low_derivatives), of degree `N - 1`.
    #[inline]
    fn low_derivatives_of<const N: usize, const D: usize>(&self, u: f64, span: usize) -> [DVec3; D] {
        let functions = basis::low_on_curve::<N, D>(&self.knots, span, u);
        let points = &self.control_points[span + 1 - N..][..N];
        match &self.weights {
            None => functions.map(|row| points.iter().zip(row).fold(DVec3::ZERO, |sum, (point, b)| sum + b * *point)),
            Some(weights) => {
                let weights = &weights[span + 1 - N..][..N];
                let mut form = [DVec4::ZERO; D];
                for (j, (point, w)) in points.iter().zip(weights).enumerate() {
                    let point = homogeneous(*point, *w);
                    (0..D).for_each(|k| form[k] += functions[k][j] * point);
                }
                rational_low_derivatives(&form)
            }
        }
    }

    // not part of the callers: its tables would be cleared, page by page, on the way to every other degree
    #[inline(never)]
    fn derivatives_with_room<const R: usize>(&self, u: f64, span: usize, out: &mut [DVec3]) {
        let p = self.degree();
        let order = p.min(out.len() - 1);
        let mut table = [[0.0; R]; R];
        basis::derivatives(&self.knots, span, u, order, &mut table);
        let mut form = [DVec4::ZERO; R];
        for (k, sum) in form.iter_mut().enumerate().take(order + 1) {
            for (i, b) in table[k][..=p].iter().enumerate() {
                let at = span - p + i;
                let w = self.weights.as_ref().map_or(1.0, |w| w[at]);
                *sum += *b * homogeneous(self.control_points[at], w);
            }
        }
        if self.weights.is_some() {
            rational_derivatives(&form[..=order], out);
        } else {
            out.fill(DVec3::ZERO);
            out.iter_mut().zip(&form[..=order]).for_each(|(out, form)| *out = form.truncate());
        }
    }
}

impl Serialize for NurbsCurve {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        use serde::ser::SerializeStruct;
        let mut s = serializer.serialize_struct("NurbsCurve", 4)?;
        s.serialize_field("degree", &self.degree())?;
        s.serialize_field("knots", self.knots.as_slice())?;
        s.serialize_field("control_points", &self.control_points)?;
        s.serialize_field("weights", &self.weights)?;
        s.end()
    }
}

impl TryFrom<CurveData> for NurbsCurve {
    type Error = InvalidDefinition;

    fn try_from(data: CurveData) -> Result<Self, InvalidDefinition> {
        Self::enter(data).map(|(curve, _)| curve)
    }
}

/// The homogeneous control points of `points` with `weights`.
pub(crate) fn net(points: &[DVec3], weights: Option<&[f64]>) -> Vec<DVec4> {
    match weights {
        None => points.iter().map(|p| p.extend(1.0)).collect(),
        Some(weights) => points.iter().zip(weights).map(|(p, w)| homogeneous(*p, *w)).collect(),
    }
}

/// Largest |coordinate| of a definition: squares of differences stay finite.
pub(crate) const COORDINATE_LIMIT: f64 = 1e70;

/// The most control points of one definition.
pub(crate) const POINT_LIMIT: usize = 10_000_000;

/// What holds for the control points of every definition.
pub(crate) fn check_points(
    count: usize,
    points: impl Iterator<Item = DVec3> + Clone,
    index: impl Fn(usize) -> PointIndex,
) -> Result<(), InvalidDefinition> {
    if count > POINT_LIMIT {
        return Err(InvalidDefinition::TooManyPoints { points: count });
    }
    for (i, p) in points.clone().enumerate() {
        // not `>`: a NaN must fail too
        if !p.abs().cmple(DVec3::splat(COORDINATE_LIMIT)).all() {
            return Err(InvalidDefinition::BadPoint { at: index(i), x: p.x, y: p.y, z: p.z });
        }
    }
    if count > 0 && Aabb::around(points).diagonal() < 1.0 / COORDINATE_LIMIT {
        return Err(InvalidDefinition::NoExtent);
    }
    Ok(())
}

/// What holds for the weights of every definition.
pub(crate) fn check_weights(weights: &[f64], index: impl Fn(usize) -> PointIndex) -> Result<(), InvalidDefinition> {
    let (mut smallest, mut largest) = (f64::INFINITY, 0.0_f64);
    for (i, weight) in weights.iter().enumerate() {
        if !(weight.is_finite() && *weight > 0.0) {
            return Err(InvalidDefinition::BadWeight { at: index(i), weight: *weight });
        }
        (smallest, largest) = (smallest.min(*weight), largest.max(*weight));
    }
    // also keeps w P finite and normal
    if largest / smallest > 1e100 || largest > 1e100 || smallest < 1e-100 {
        return Err(InvalidDefinition::WeightRatio { smallest, largest });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn circle_quarter() -> NurbsCurve {
        let points = vec![DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
        let weights = Some(vec![1.0, 0.5_f64.sqrt(), 1.0]);
        NurbsCurve::new(2, vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0], points, weights).expect("valid")
    }

    #[test]
    fn a_rational_quarter_circle_is_round_and_its_derivatives_are_right() {
        let curve = circle_quarter();
        let h = 1e-4;
        for i in 0..=20 {
            let u = f64::from(i) / 20.0;
            assert!((curve.point(u).length() - 1.0).abs() < 1e-15);
            let u = u.clamp(3.0 * h, 1.0 - 3.0 * h);
            let mut d = [DVec3::ZERO; 6];
            curve.derivatives(u, &mut d);
            for k in 0..5 {
                let (mut before, mut after) = ([DVec3::ZERO; 6], [DVec3::ZERO; 6]);
                curve.derivatives(u - h, &mut before);
                curve.derivatives(u + h, &mut after);
                let difference = (after[k] - before[k]) / (2.0 * h);
                assert!((difference - d[k + 1]).length() < 1e-6 * (1.0 + d[k + 1].length()) * 100.0, "order {}", k + 1);
            }
        }
    }

    #[test]
    fn derivatives_at_a_break_come_from_the_side_that_is_asked() {
        let points = vec![DVec3::ZERO, DVec3::X, DVec3::new(1.0, 2.0, 0.0)];
        let curve = NurbsCurve::new(1, vec![0.0, 0.0, 1.0, 2.0, 2.0], points, None).expect("valid");
        let mut d = [DVec3::ZERO; 2];
        curve.derivatives(1.0, &mut d);
        assert_eq!(d[1], 2.0 * DVec3::Y);
        curve.derivatives_from_left(1.0, &mut d);
        assert_eq!(d[1], DVec3::X);
        curve.derivatives_from_left(0.0, &mut d);
        assert_eq!(d[1], DVec3::X);
    }

    #[test]
    fn bad_points_and_weights_are_named() {
        let knots = vec![0.0, 0.0, 1.0, 1.0];
        let new = |points: Vec<DVec3>, weights| {
            NurbsCurve::new(1, knots.clone(), points, weights).expect_err("invalid").to_string()
        };
        assert!(new(vec![DVec3::ZERO, DVec3::new(0.0, f64::NAN, 0.0)], None).contains("control_points[1]"));
        assert!(new(vec![DVec3::ZERO, DVec3::splat(1e200)], None).contains("±1e70"));
        assert!(new(vec![DVec3::ONE, DVec3::ONE], None).contains("all control points are equal"));
        assert!(new(vec![DVec3::ZERO, DVec3::ONE], Some(vec![1.0])).contains("1 weights for 2"));
        assert!(new(vec![DVec3::ZERO, DVec3::ONE], Some(vec![1.0, 0.0])).contains("weights[1] is 0"));
        assert!(new(vec![DVec3::ZERO, DVec3::ONE], Some(vec![1e-90, 1e90])).contains("ratio"));
    }
}
