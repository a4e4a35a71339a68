//! NURBS surfaces.

use glam::{DVec3, DVec4};
use serde::{Deserialize, Serialize};

use crate::basis::{self, LOW_DEGREE, ROOM};
use crate::bounds::Aabb;
use crate::clamp::{self, Entry};
use crate::curve::{check_points, check_weights, net};
use crate::homogeneous::{cartesian, homogeneous, rational_low_partials, rational_partials};
use crate::invalid::{Along, Direction, InvalidDefinition, PointIndex};
use crate::knots::KnotVector;

/// A NURBS surface: degrees, clamped knots and a control net, in u and v.
///
/// The net has `rows` along u and `columns` along v; point `(i, j)` stands at `control_points()[i * columns + j]`. Every
/// value of this type is valid, as for [`NurbsCurve`](crate::NurbsCurve).
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(try_from = "SurfaceData")]
pub struct NurbsSurface {
    pub(crate) u: KnotVector,
    pub(crate) v: KnotVector,
    pub(crate) control_points: Vec<DVec3>,
    pub(crate) weights: Option<Vec<f64>>,
}

/// The data of a surface as a file holds it, not validated.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename = "NurbsSurface", deny_unknown_fields)]
pub struct SurfaceData {
    /// The degrees in u and v.
    pub degree: (usize, usize),
    /// The knots in u and v.
    pub knots: (Vec<f64>, Vec<f64>),
    /// The control net: `control_points[i][j]`, `i` along u.
    pub control_points: Vec<Vec<DVec3>>,
    /// The weights in the same layout; none: all 1.
    #[serde(default)]
    pub weights: Option<Vec<Vec<f64>>>,
}

impl NurbsSurface {
    /// A surface from its defining data, `control_points[i][j]` with `i` along u; knot vectors that are not clamped are
    /// clamped by knot insertion, which does not change the surface.
    ///
    /// # Errors
    ///
    /// The first rule that the data break: see [`InvalidDefinition`].
    pub fn new(
        degree: (usize, usize),
        knots: (Vec<f64>, Vec<f64>),
        control_points: Vec<Vec<DVec3>>,
        weights: Option<Vec<Vec<f64>>>,
    ) -> Result<Self, InvalidDefinition> {
        Self::enter(SurfaceData { degree, knots, control_points, weights }).map(|(surface, _)| surface)
    }

    /// As [`new`](Self::new), and says what had to be done on entry.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new).
    pub fn enter(data: SurfaceData) -> Result<(Self, Entry), InvalidDefinition> {
        let SurfaceData { degree, knots, control_points, weights } = data;
        let (along_u, along_v) = (Along::Surface(Direction::U), Along::Surface(Direction::V));
        let (rows, columns) = (control_points.len(), control_points.first().map_or(0, Vec::len));
        check_rows("control_points", &control_points, columns)?;
        let index = |i: usize| PointIndex::Surface(i / columns, i % columns);
        let count = rows.saturating_mul(columns);
        check_points(count, control_points.iter().flatten().copied(), index)?;
        crate::knots::check_order(degree.0, &knots.0, rows, along_u)?;
        crate::knots::check_order(degree.1, &knots.1, columns, along_v)?;
        let weights = match weights {
            None => None,
            Some(weights) => {
                let found = weights.iter().map(Vec::len).sum();
                if weights.len() != rows || found != count {
                    return Err(InvalidDefinition::WeightCount { found, points: count });
                }
                check_rows("weights", &weights, columns)?;
                let weights: Vec<f64> = weights.into_iter().flatten().collect();
                check_weights(&weights, index)?;
                Some(weights)
            }
        };
        let control_points: Vec<DVec3> = control_points.into_iter().flatten().collect();
        let entry = Entry {
            clamped: [clamp::needed(degree.0, &knots.0, along_u)?, clamp::needed(degree.1, &knots.1, along_v)?],
        };
        if entry.clamped == [false, false] {
            let u = KnotVector::new(degree.0, knots.0, rows, along_u)?;
            let v = KnotVector::new(degree.1, knots.1, columns, along_v)?;
            return Ok((Self { u, v, control_points, weights }, entry));
        }
        let rational = weights.is_some();
        let form = net(&control_points, weights.as_deref());
        let (u, form) = clamp::clamp_rows(degree.0, knots.0, form, columns, along_u)?;
        let (v, form) = clamp::clamp_columns(degree.1, knots.1, form, columns, along_v)?;
        Ok((Self::from_homogeneous(u, v, &form, rational), entry))
    }

    /// A surface from knot vectors and a homogeneous net in row order; `rational` says whether the weights are kept.
    pub(crate) fn from_homogeneous(u: KnotVector, v: KnotVector, net: &[DVec4], rational: bool) -> Self {
        debug_assert_eq!(u.point_count() * v.point_count(), net.len(), "knots and net disagree");
        Self {
            u,
            v,
            control_points: net.iter().map(|h| if rational { cartesian(*h) } else { h.truncate() }).collect(),
            weights: rational.then(|| net.iter().map(|h| h.w).collect()),
        }
    }

    /// A surface from knots that fit, and points and weights still to be checked.
    pub(crate) fn checked(
        u: KnotVector,
        v: KnotVector,
        control_points: Vec<DVec3>,
        weights: Option<Vec<f64>>,
    ) -> Result<Self, InvalidDefinition> {
        debug_assert_eq!(u.point_count() * v.point_count(), control_points.len(), "knots and net disagree");
        let columns = v.point_count();
        let index = |i: usize| PointIndex::Surface(i / columns, i % columns);
        check_points(control_points.len(), control_points.iter().copied(), index)?;
        check_weights(weights.as_deref().unwrap_or_default(), index)?;
        Ok(Self { u, v, control_points, weights })
    }

    /// The degrees in u and v.
    #[must_use]
    #[inline]
    pub fn degree(&self) -> (usize, usize) {
        (self.u.degree(), self.v.degree())
    }

    /// The knot vector of a direction.
    #[must_use]
    #[inline]
    pub fn knots(&self, direction: Direction) -> &KnotVector {
        match direction {
            Direction::U => &self.u,
            Direction::V => &self.v,
        }
    }

    /// Control points along u.
    #[must_use]
    #[inline]
    pub fn rows(&self) -> usize {
        self.u.point_count()
    }

    /// Control points along v.
    #[must_use]
    #[inline]
    pub fn columns(&self) -> usize {
        self.v.point_count()
    }

    /// The control net in row order: point `(i, j)` at `i * columns + j`.
    #[must_use]
    #[inline]
    pub fn control_points(&self) -> &[DVec3] {
        &self.control_points
    }

    /// The weights in the layout of the control points; none where all are 1.
    #[must_use]
    #[inline]
    pub fn weights(&self) -> Option<&[f64]> {
        self.weights.as_deref()
    }

    /// The first and the last parameter of a direction.
    #[must_use]
    #[inline]
    pub fn domain(&self, direction: Direction) -> (f64, f64) {
        self.knots(direction).domain()
    }

    /// The net in homogeneous form, in row order; weight 1 where the surface has none.
    #[must_use]
    pub fn homogeneous_points(&self) -> Vec<DVec4> {
        net(&self.control_points, self.weights())
    }

    /// The box of the control points, which holds the surface.
    #[must_use]
    pub fn control_box(&self) -> Aabb {
        Aabb::around(self.control_points.iter().copied())
    }

    /// The point at `(u, v)`; parameters outside the domain are moved to its nearest one.
    ///
    /// # Accuracy
    ///
    /// Within a few `(p + q) * ε` times the largest coordinate.
    #[must_use]
    pub fn point(&self, u: f64, v: f64) -> DVec3 {
        match self.u.degree().max(self.v.degree()) {
            0..=LOW_DEGREE => self.low_partials::<1>(u, v, [false, false])[0][0],
            6..=7 => self.point_with_room::<8>(u, v),
            _ => self.point_with_room::<ROOM>(u, v),
        }
    }

    #[inline(never)]
    fn point_with_room<const R: usize>(&self, u: f64, v: f64) -> DVec3 {
        let (u, v) = (self.u.clamp(u), self.v.clamp(v));
        let ((p, q), columns) = (self.degree(), self.columns());
        let (i0, j0) = (self.u.find_span(u) - p, self.v.find_span(v) - q);
        let across = basis::functions::<R>(&self.u, i0 + p, u);
        let along = basis::functions::<R>(&self.v, j0 + q, v);
        let row = |i: usize| (i0 + i) * columns + j0..=(i0 + i) * columns + j0 + q;
        match &self.weights {
            None => {
                let mut sum = DVec3::ZERO;
                for (i, b) in across[..=p].iter().enumerate() {
                    let points = &self.control_points[row(i)];
                    sum += *b * points.iter().zip(&along).fold(DVec3::ZERO, |sum, (point, b)| sum + *b * *point);
                }
                sum
            }
            Some(weights) => {
                let mut sum = DVec4::ZERO;
                for (i, b) in across[..=p].iter().enumerate() {
                    let mut line = DVec4::ZERO;
                    for ((point, w), b) in self.control_points[row(i)].iter().zip(&weights[row(i)]).zip(&along) {
                        line += *b * homogeneous(*point, *w);
                    }
                    sum += *b * line;
                }
                cartesian(sum)
            }
        }
    }

    /// Point and partial derivatives at `(u, v)` up to `order` in all: `out[k * (order + 1) + l]` becomes the derivative of
    /// order `k` in u and `l` in v, for `k + l <= order`; other entries are left alone.
    ///
    /// At a knot the derivatives are those from above (at the end of the domain, from below). Nothing is allocated. `out[0]` is
    /// [`point`](Self::point), bit for bit. The NURBS Book, algorithms A3.6 and A4.4.
    ///
    /// # Panics
    ///
    /// Where `out` has not `(order + 1)²` entries.
    pub fn derivatives(&self, u: f64, v: f64, order: usize, out: &mut [DVec3]) {
        self.derivatives_from(u, v, [false, false], order, out);
    }

    /// As [`derivatives`](Self::derivatives); `below` says per direction whether they are taken from below at a knot.
    ///
    /// # Panics
    ///
    /// Where `out` has not `(order + 1)²` entries.
    pub fn derivatives_from(&self, u: f64, v: f64, below: [bool; 2], order: usize, out: &mut [DVec3]) {
        let side = order + 1;
        assert_eq!(out.len(), side * side, "the derivatives of order {order} need {side} * {side} entries");
        let (p, q) = self.degree();
        match (p.max(q), order) {
            (0..=LOW_DEGREE, 0) => out[0] = self.low_partials::<1>(u, v, below)[0][0],
            (0..=LOW_DEGREE, 1) => copy_partials(&self.low_partials::<2>(u, v, below), out),
            (0..=LOW_DEGREE, 2) => copy_partials(&self.low_partials::<3>(u, v, below), out),
            (0..=7, _) => self.derivatives_with_room::<8>(u, v, below, order, out),
            _ => self.derivatives_with_room::<ROOM>(u, v, below, order, out),
        }
    }

    /// The derivatives of order `k` in u and `l` in v at `[k][l]`, for `k + l < D`; `D` is at most 3 and the degrees are low.
    #[inline]
    fn low_partials<const D: usize>(&self, u: f64, v: f64, below: [bool; 2]) -> [[DVec3; D]; D] {
        let at = (self.u.clamp(u), self.v.clamp(v));
        let spans = (span_from(&self.u, at.0, below[0]), span_from(&self.v, at.1, below[1]));
        match self.u.degree() {
            1 => self.low_partials_in_u::<2, D>(at, spans),
            2 => self.low_partials_in_u::<3, D>(at, spans),
            3 => self.low_partials_in_u::<4, D>(at, spans),
            4 => self.low_partials_in_u::<5, D>(at, spans),
            _ => self.low_partials_in_u::<6, D>(at, spans),
        }
    }

    /// As [`low_partials`](Self::low_partials), of degree `N - 1` in u.
    #[inline]
    fn low_partials_in_u<const N: usize, const D: usize>(
        &self,
        at: (f64, f64),
        spans: (usize, usize),
    ) -> [[DVec3; D]; D] {
        match self.v.degree() {
            1 => self.low_partials_of::<N, 2, D>(at, spans),
            2 => self.low_partials_of::<N, 3, D>(at, spans),
            3 => self.low_partials_of::<N, 4, D>(at, spans),
            4 => self.low_partials_of::<N, 5, D>(at, spans),
            _ => self.low_partials_of::<N, 6, D>(at, spans),
        }
    }

    /// As [`low_partials`](Self::low_partials), of degree `N - 1` in u and `M - 1` in v.
    #[inline(never)]
    fn low_partials_of<const N: usize, const M: usize, const D: usize>(
        &self,
        at: (f64, f64),
        spans: (usize, usize),
    ) -> [[DVec3; D]; D] {
        let across = basis::low::<N, D>(&self.u, spans.0, at.0);
        let along = basis::low::<M, D>(&self.v, spans.1, at.1);
        let columns = self.columns();
        let row = |i: usize| (spans.0 + 1 - N + i) * columns + spans.1 + 1 - M;
        match &self.weights {
            None => tensor_sums(&across, &along, |i| std::array::from_fn(|j| self.control_points[row(i)..][..M][j])),
            Some(weights) => rational_low_partials(&tensor_sums(&across, &along, |i| {
                let (points, weights) = (&self.control_points[row(i)..][..M], &weights[row(i)..][..M]);
                std::array::from_fn(|j| homogeneous(points[j], weights[j]))
            })),
        }
    }

    // not part of the callers: its tables would be cleared, page by page, on the way to every other degree
    #[inline(never)]
    fn derivatives_with_room<const R: usize>(&self, u: f64, v: f64, below: [bool; 2], order: usize, out: &mut [DVec3]) {
        let side = order + 1;
        let (u, v) = (self.u.clamp(u), self.v.clamp(v));
        let ((p, q), columns) = (self.degree(), self.columns());
        let (i0, j0) = (span_from(&self.u, u, below[0]) - p, span_from(&self.v, v, below[1]) - q);
        let (du, dv) = (p.min(order), q.min(order));
        let (mut across, mut along) = ([[0.0; R]; R], [[0.0; R]; R]);
        basis::derivatives(&self.u, i0 + p, u, du, &mut across);
        basis::derivatives(&self.v, j0 + q, v, dv, &mut along);
        let mut form = [[DVec4::ZERO; R]; R];
        for i in 0..=p {
            for (l, functions) in along[..=dv].iter().enumerate() {
                let mut line = DVec4::ZERO;
                for (j, b) in functions[..=q].iter().enumerate() {
                    let at = (i0 + i) * columns + j0 + j;
                    let w = self.weights.as_ref().map_or(1.0, |w| w[at]);
                    line += *b * homogeneous(self.control_points[at], w);
                }
                for (sums, functions) in form.iter_mut().zip(&across).take(du.min(order - l) + 1) {
                    sums[l] += functions[i] * line;
                }
            }
        }
        let at = |k: usize, l: usize| if k <= du && l <= dv { form[k][l] } else { DVec4::ZERO };
        if self.weights.is_some() {
            rational_partials(at, side, out);
        } else {
            for k in 0..side {
                for l in 0..side - k {
                    out[k * side + l] = at(k, l).truncate();
                }
            }
        }
    }

    /// `S_u × S_v` at `(u, v)`, not of unit length; zero at a pole or a cusp.
    #[must_use]
    pub fn normal(&self, u: f64, v: f64) -> DVec3 {
        let mut d = [DVec3::ZERO; 4];
        self.derivatives(u, v, 1, &mut d);
        d[2].cross(d[1])
    }
}

/// The sums of a net with the functions across in row `k` and along in row `l`, at `[k][l]` for `k + l < D`; `row(i)` is a row of the net.
#[inline]
fn tensor_sums<
    P: Default + Copy + std::ops::AddAssign + std::ops::Mul<f64, Output = P>,
    const N: usize,
    const M: usize,
    const D: usize,
>(
    across: &[[f64; N]; D],
    along: &[[f64; M]; D],
    row: impl Fn(usize) -> [P; M],
) -> [[P; D]; D] {
    let mut lines = [[P::default(); D]; N];
    for (i, line) in lines.iter_mut().enumerate() {
        let row = row(i);
        for l in 0..D {
            line[l] = basis::sum(&along[l], |j| row[j]);
        }
    }
    let mut sums = [[P::default(); D]; D];
    for k in 0..D {
        for l in 0..D - k {
            sums[k][l] = basis::sum(&across[k], |i| lines[i][l]);
        }
    }
    sums
}

#[inline]
fn copy_partials<const D: usize>(from: &[[DVec3; D]; D], out: &mut [DVec3]) {
    for k in 0..D {
        out[k * D..(k + 1) * D - k].copy_from_slice(&from[k][..D - k]);
    }
}

/// The span that holds `u`; the one below where `u` is a knot and `below` is asked, if there is one.
#[inline]
fn span_from(knots: &KnotVector, u: f64, below: bool) -> usize {
    let mut span = knots.find_span(u);
    while below && span > knots.degree() && knots.as_slice()[span] >= u {
        span -= 1;
    }
    span
}

fn check_rows<T>(field: &'static str, rows: &[Vec<T>], expected: usize) -> Result<(), InvalidDefinition> {
    match rows.iter().position(|row| row.len() != expected) {
        Some(row) => Err(InvalidDefinition::RaggedRow { field, row, found: rows[row].len(), expected }),
        None => Ok(()),
    }
}

/// A flat array, written as rows.
struct Rows<'a, T>(&'a [T], usize);

impl<T: Serialize> Serialize for Rows<'_, T> {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.0.chunks(self.1))
    }
}

impl Serialize for NurbsSurface {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        use serde::ser::SerializeStruct;
        let mut s = serializer.serialize_struct("NurbsSurface", 4)?;
        s.serialize_field("degree", &self.degree())?;
        s.serialize_field("knots", &(self.u.as_slice(), self.v.as_slice()))?;
        s.serialize_field("control_points", &Rows(&self.control_points, self.columns()))?;
        s.serialize_field("weights", &self.weights.as_ref().map(|w| Rows(w, self.columns())))?;
        s.end()
    }
}

impl TryFrom<SurfaceData> for NurbsSurface {
    type Error = InvalidDefinition;

    fn try_from(data: SurfaceData) -> Result<Self, InvalidDefinition> {
        Self::enter(data).map(|(surface, _)| surface)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dome(rational: bool) -> NurbsSurface {
        let knots = vec![0.0, 0.0, 0.0, 0.4, 1.0, 1.0, 1.0];
        let points =
            (0..4).map(|i| (0..4).map(|j| DVec3::new(f64::from(i), f64::from(j), f64::from((i * j) % 3))).collect());
        let weights = (0..4).map(|i| (0..4).map(|j| 1.0 + 0.3 * f64::from((i + 2 * j) % 4)).collect()).collect();
        NurbsSurface::new((2, 2), (knots.clone(), knots), points.collect(), rational.then_some(weights)).expect("valid")
    }

    #[test]
    fn partial_derivatives_agree_with_differences() {
        for surface in [dome(false), dome(true)] {
            let (h, order) = (1e-4, 3);
            let at = |u: f64, v: f64| {
                let mut d = [DVec3::ZERO; 16];
                surface.derivatives(u, v, order, &mut d);
                d
            };
            for (u, v) in [(0.2, 0.7), (0.9, 0.1), (0.6, 0.6)] {
                let d = at(u, v);
                assert!((d[0] - surface.point(u, v)).length() < 1e-14);
                for (k, l) in [(0, 0), (1, 0), (0, 1), (1, 1), (2, 0), (0, 2)] {
                    let by_u = (at(u + h, v)[k * 4 + l] - at(u - h, v)[k * 4 + l]) / (2.0 * h);
                    let by_v = (at(u, v + h)[k * 4 + l] - at(u, v - h)[k * 4 + l]) / (2.0 * h);
                    assert!((by_u - d[(k + 1) * 4 + l]).length() < 1e-4, "{k} {l}");
                    assert!((by_v - d[k * 4 + l + 1]).length() < 1e-4, "{k} {l}");
                }
            }
        }
    }

    #[test]
    fn ragged_nets_and_missing_weights_are_named() {
        let knots = || vec![0.0, 0.0, 1.0, 1.0];
        let new = |points: Vec<Vec<DVec3>>, weights| {
            NurbsSurface::new((1, 1), (knots(), knots()), points, weights).expect_err("invalid").to_string()
        };
        let row = vec![DVec3::ZERO, DVec3::X];
        assert!(new(vec![row.clone(), vec![DVec3::Y]], None).contains("control_points[1] has 1 entries"));
        assert!(new(vec![row.clone(), row.clone()], Some(vec![vec![1.0; 2]])).contains("2 weights for 4"));
        assert!(new(vec![row.clone(), row.clone()], Some(vec![vec![1.0; 3], vec![1.0]])).contains("weights[0]"));
        assert!(new(vec![], None).contains("0 control points"));
        assert!(new(vec![vec![], vec![]], None).contains("0 control points"));
    }
}
