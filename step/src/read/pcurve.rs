//! The file's own p-curves, as hints.

use std::f64::consts::TAU;

use glam::DVec2;
use step_io::parser::Attribute;

use super::curve::parameter_of;
use super::entities::{Understood, Values, real};
use super::placement::Geometry;
use super::spline;
use super::surface::FaceSurface;
use crate::source::{RawPcurve, SourceCurve, SourceEdge};

/// A p-curve of an edge: the surface it lies in, and its curve in the plane of parameters.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pcurve {
    pub(super) surface: u64,
    curve: u64,
}

impl Geometry<'_> {
    /// The p-curves that stand beside the curve of an edge, in their order.
    pub(super) fn pcurves(&self, curve: u64) -> Vec<Pcurve> {
        let entities = self.entities;
        let Some(values) = entities.simple_of(curve, &["SURFACE_CURVE", "SEAM_CURVE", "INTERSECTION_CURVE"]) else {
            return Vec::new();
        };
        let beside = values.references(2).unwrap_or_default();
        beside.into_iter().filter_map(|id| self.pcurve(id).ok()).collect()
    }

    fn pcurve(&self, id: u64) -> Understood<Pcurve> {
        let entities = self.entities;
        let values = entities.simple_of(id, &["PCURVE"]).ok_or_else(|| entities.unexpected(id, "a p-curve"))?;
        let representation = values.reference(2)?;
        let representation = entities
            .simple_of(representation, &["DEFINITIONAL_REPRESENTATION"])
            .ok_or_else(|| entities.unexpected(representation, "what defines a p-curve"))?;
        let curve =
            *representation.references(1)?.first().ok_or_else(|| representation.refuse("it is empty".to_owned()))?;
        Ok(Pcurve { surface: values.reference(1)?, curve })
    }

    /// The data of a p-curve in the units of the part; none where it is of a kind that is not worth it, or lies in parameters of another scale.
    pub(super) fn raw(&self, pcurve: Pcurve, surface: &FaceSurface, edge: &SourceEdge) -> Option<RawPcurve> {
        let scale = DVec2::from(surface.scales?);
        let mut raw = self.plane_curve(pcurve.curve, edge)?;
        for point in &mut raw.points {
            *point *= scale;
        }
        raw.points.iter().all(|point| point.is_finite()).then_some(raw)
    }

    fn plane_curve(&self, id: u64, edge: &SourceEdge) -> Option<RawPcurve> {
        let entities = self.entities;
        if entities.is(id, &spline::CURVES) {
            let spline = self.read_spline_curve(id).ok()?;
            let points = spline.points.iter().map(|point| self.plane_point(*point)).collect::<Option<_>>()?;
            return Some(RawPcurve { degree: spline.degree, knots: spline.knots, points, weights: spline.weights });
        }
        let values = entities.simple(id)?;
        match values.keyword {
            // a line has no ends: those of the edge's curve are its own, since both run alike
            "LINE" => self.plane_line(&values, self.range(edge)?),
            "TRIMMED_CURVE" => {
                let line = entities.simple_of(values.reference(1).ok()?, &["LINE"])?;
                let (from, to) = (trim(&values, 2)?, trim(&values, 3)?);
                self.plane_line(&line, (from, to))
            }
            _ => None,
        }
    }

    /// The straight p-curve over a range of the file's parameter.
    fn plane_line(&self, values: &Values<'_>, (from, to): (f64, f64)) -> Option<RawPcurve> {
        let vector = self.entities.simple_of(values.reference(2).ok()?, &["VECTOR"])?;
        let direction = self.entities.simple_of(vector.reference(1).ok()?, &["DIRECTION"])?;
        let origin = self.plane_point(values.reference(1).ok()?)?;
        let along = two(&direction.reals(1).ok()?)?.try_normalize()? * vector.real(2).ok()?;
        let points = vec![origin + from * along, origin + to * along];
        Some(RawPcurve { degree: 1, knots: vec![from, from, to, to], points, weights: None })
    }

    fn plane_point(&self, id: u64) -> Option<DVec2> {
        two(&self.entities.simple_of(id, &["CARTESIAN_POINT"])?.reals(1).ok()?)
    }

    /// Where an edge lies on its curve, in the file's parameter.
    fn range(&self, edge: &SourceEdge) -> Option<(f64, f64)> {
        let (first, last) = if edge.same_sense { (edge.start, edge.end) } else { (edge.end, edge.start) };
        match &edge.curve {
            SourceCurve::Nurbs(curve) => {
                // of a curve that goes on beyond the edge only a projection tells
                let (from, to) = curve.domain();
                let near = 1e-6 * curve.control_box().diagonal();
                let ends = curve.point(from).distance(first).max(curve.point(to).distance(last));
                (ends <= near).then_some((from, to))
            }
            SourceCurve::Circle { .. } | SourceCurve::Ellipse { .. } => {
                let (from, to) = (parameter_of(&edge.curve, first)?, parameter_of(&edge.curve, last)?);
                let to = if edge.closed || to <= from { to + TAU } else { to };
                let unit = self.scales.angle;
                Some((from / unit, to / unit))
            }
            curve => Some((parameter_of(curve, first)?, parameter_of(curve, last)?)),
        }
    }
}

/// The parameter of a trim that is given by one.
fn trim(values: &Values<'_>, index: usize) -> Option<f64> {
    values.list(index).ok()?.iter().filter(|trim| !matches!(trim, Attribute::EntityRef(_))).find_map(real)
}

fn two(values: &[f64]) -> Option<DVec2> {
    values.try_into().ok().map(DVec2::from_array)
}
