//! B-spline curves and surfaces in their many spellings: with knots, uniform, quasi-uniform, Bézier, each rational or not.

use glam::DVec3;
use perpend::{NurbsCurve, NurbsSurface};
use step_io::parser::Attribute;

use super::entities::{Understood, Values};
use super::placement::Geometry;

/// The keywords of B-spline curves.
pub(super) const CURVES: [&str; 6] = [
    "B_SPLINE_CURVE_WITH_KNOTS",
    "QUASI_UNIFORM_CURVE",
    "UNIFORM_CURVE",
    "BEZIER_CURVE",
    "B_SPLINE_CURVE",
    "RATIONAL_B_SPLINE_CURVE",
];

/// The keywords of B-spline surfaces.
pub(super) const SURFACES: [&str; 6] = [
    "B_SPLINE_SURFACE_WITH_KNOTS",
    "QUASI_UNIFORM_SURFACE",
    "UNIFORM_SURFACE",
    "BEZIER_SURFACE",
    "B_SPLINE_SURFACE",
    "RATIONAL_B_SPLINE_SURFACE",
];

/// A B-spline curve as the file has it, its points still references.
pub(super) struct SplineCurve<'a> {
    pub(super) values: Values<'a>,
    pub(super) degree: usize,
    pub(super) points: Vec<u64>,
    pub(super) knots: Vec<f64>,
    pub(super) weights: Option<Vec<f64>>,
}

impl<'a> Geometry<'a> {
    /// A B-spline curve in space.
    pub(super) fn spline_curve(&self, id: u64) -> Understood<NurbsCurve> {
        let SplineCurve { values, degree, points, knots, weights } = self.read_spline_curve(id)?;
        let points = points.into_iter().map(|point| self.point(point)).collect::<Understood<Vec<DVec3>>>()?;
        NurbsCurve::new(degree, knots, points, weights).map_err(|error| values.refuse(error.to_string()))
    }

    /// The data of a B-spline curve in space or in the plane.
    pub(super) fn read_spline_curve(&self, id: u64) -> Understood<SplineCurve<'a>> {
        let entities = self.entities;
        let kinds = |kind: &str| entities.is(id, &[kind]);
        // where an entity has one keyword, its values follow the inherited ones: the name, and the curve's own five
        let (values, first) = match entities.part(id, "B_SPLINE_CURVE") {
            Some(values) => (values, 0),
            None => (entities.simple_of(id, &CURVES).ok_or_else(|| entities.unexpected(id, "a B-spline curve"))?, 1),
        };
        let (degree, points) = (values.count(first)?, values.references(first + 1)?);
        entities.spend(id, points.len())?;
        let knots = if kinds("B_SPLINE_CURVE_WITH_KNOTS") {
            let (knots, at) = match entities.part(id, "B_SPLINE_CURVE_WITH_KNOTS") {
                Some(knots) => (knots, 0),
                None => (values, 6),
            };
            repeated(&knots, at, at + 1, degree, points.len())?
        } else {
            implied(&values, kinds("UNIFORM_CURVE"), kinds("BEZIER_CURVE"), degree, points.len())?
        };
        let weights = match entities.part(id, "RATIONAL_B_SPLINE_CURVE") {
            Some(rational) => Some(rational.reals(0)?),
            None => None,
        };
        Ok(SplineCurve { values, degree, points, knots, weights })
    }

    /// A B-spline surface.
    pub(super) fn spline_surface(&self, id: u64) -> Understood<NurbsSurface> {
        let entities = self.entities;
        let kinds = |kind: &str| entities.is(id, &[kind]);
        let (values, first) = match entities.part(id, "B_SPLINE_SURFACE") {
            Some(values) => (values, 0),
            None => {
                (entities.simple_of(id, &SURFACES).ok_or_else(|| entities.unexpected(id, "a B-spline surface"))?, 1)
            }
        };
        let degree = (values.count(first)?, values.count(first + 1)?);
        let rows = values.rows(first + 2)?;
        entities.spend(id, rows.iter().map(|row| row.len()).sum())?;
        let points = rows.iter().map(|row| self.points(&values, first + 2, row)).collect::<Understood<Vec<_>>>()?;
        let counts = (points.len(), points.first().map_or(0, Vec::len));
        let knots = if kinds("B_SPLINE_SURFACE_WITH_KNOTS") {
            let (knots, at) = match entities.part(id, "B_SPLINE_SURFACE_WITH_KNOTS") {
                Some(knots) => (knots, 0),
                None => (values, 8),
            };
            (repeated(&knots, at, at + 2, degree.0, counts.0)?, repeated(&knots, at + 1, at + 3, degree.1, counts.1)?)
        } else {
            let (uniform, bezier) = (kinds("UNIFORM_SURFACE"), kinds("BEZIER_SURFACE"));
            (
                implied(&values, uniform, bezier, degree.0, counts.0)?,
                implied(&values, uniform, bezier, degree.1, counts.1)?,
            )
        };
        let weights = match entities.part(id, "RATIONAL_B_SPLINE_SURFACE") {
            Some(rational) => {
                let rows = rational.rows(0)?;
                Some(rows.iter().map(|row| rational.reals_of(0, row)).collect::<Understood<Vec<_>>>()?)
            }
            None => None,
        };
        NurbsSurface::new(degree, knots, points, weights).map_err(|error| values.refuse(error.to_string()))
    }

    fn points(&self, values: &Values<'_>, index: usize, row: &[Attribute]) -> Understood<Vec<DVec3>> {
        values.references_of(index, row)?.into_iter().map(|point| self.point(point)).collect()
    }
}

/// Knots from their multiplicities; the sum is checked before anything is made room for.
fn repeated(
    values: &Values<'_>,
    multiplicities: usize,
    knots: usize,
    degree: usize,
    points: usize,
) -> Understood<Vec<f64>> {
    let (multiplicities, knots) = (values.counts(multiplicities)?, values.reals(knots)?);
    if multiplicities.len() != knots.len() {
        let (found, given) = (knots.len(), multiplicities.len());
        return Err(
            values.refuse(format!("it has {found} knots and {given} multiplicities; there must be one for each"))
        );
    }
    let sum = multiplicities.iter().try_fold(0_usize, |sum, many| sum.checked_add(*many));
    let wanted = points.saturating_add(degree).saturating_add(1);
    if sum != Some(wanted) {
        return Err(values.refuse(format!(
            "its multiplicities do not add up to control points ({points}) + degree ({degree}) + 1 = {wanted}"
        )));
    }
    Ok(knots.iter().zip(multiplicities).flat_map(|(knot, many)| std::iter::repeat_n(*knot, many)).collect())
}

/// The knots that a keyword implies (ISO 10303-42): steps of 1 without repetition, with the ends repeated, or all repeated as of Bézier pieces.
fn implied(values: &Values<'_>, uniform: bool, bezier: bool, degree: usize, points: usize) -> Understood<Vec<f64>> {
    if degree == 0 || points <= degree {
        return Err(values.refuse(format!("{points} control points are too few for degree {degree}")));
    }
    if uniform {
        return Ok((0..points + degree + 1).map(|i| i as f64 - degree as f64).collect());
    }
    let step = if bezier { degree } else { 1 };
    let inner = points - degree - 1;
    if !inner.is_multiple_of(step) {
        return Err(values.refuse(format!("{points} control points do not make Bézier pieces of degree {degree}")));
    }
    let last = (inner / step + 1) as f64;
    let ends = |knot: f64| std::iter::repeat_n(knot, degree + 1);
    Ok(ends(0.0).chain((0..inner).map(|i| (i / step + 1) as f64)).chain(ends(last)).collect())
}
