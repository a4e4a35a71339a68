//! Curves in space.

use std::f64::consts::TAU;

use glam::DVec3;
use perpend::{Circle, Ellipse, Frame, InvalidDefinition, Line, NurbsCurve};
use step_io::parser::Attribute;

use super::composite::joined;
use super::entities::{MAX_DEPTH, Understood, Values, real};
use super::placed::mapped_curve;
use super::placement::Geometry;
use super::spline;
use crate::source::SourceCurve;

/// A curve of an edge, and what it takes to read p-curves beside it.
pub(super) struct EdgeCurve {
    pub(super) curve: SourceCurve,
    /// Whether its parameter is that of the file, so that p-curves run as it does.
    pub(super) own_parameter: bool,
}

impl<'a> Geometry<'a> {
    /// A curve without its ends, as an edge needs it: vertices bound it.
    pub(super) fn curve(&self, id: u64) -> Understood<EdgeCurve> {
        self.curve_at(id, 0)
    }

    fn curve_at(&self, id: u64, depth: usize) -> Understood<EdgeCurve> {
        let entities = self.entities;
        entities.spend(id, 1)?;
        if depth > MAX_DEPTH {
            return Err(entities.refuse(id, "curves of curves are nested too deeply".to_owned()));
        }
        if entities.is(id, &spline::CURVES) {
            return Ok(EdgeCurve { curve: SourceCurve::Nurbs(self.spline_curve(id)?), own_parameter: true });
        }
        let Some(values) = entities.simple(id) else {
            // a bounded curve on a surface has several keywords
            let on_surface = ["SURFACE_CURVE", "SEAM_CURVE", "INTERSECTION_CURVE"];
            let part = on_surface.into_iter().find_map(|kind| entities.part(id, kind).filter(|v| v.get(0).is_some()));
            let part = part.ok_or_else(|| entities.unexpected(id, "a curve in space"))?;
            return self.curve_at(part.reference(0)?, depth + 1);
        };
        let curve = match values.keyword {
            "LINE" => SourceCurve::Line {
                point: self.point(values.reference(1)?)?,
                direction: self.vector(values.reference(2)?)?,
            },
            "CIRCLE" => {
                SourceCurve::Circle { frame: self.frame(values.reference(1)?)?, radius: self.length(&values, 2)? }
            }
            "ELLIPSE" => SourceCurve::Ellipse {
                frame: self.frame(values.reference(1)?)?,
                radii: (self.length(&values, 2)?, self.length(&values, 3)?),
            },
            "HYPERBOLA" => SourceCurve::Hyperbola {
                frame: self.frame(values.reference(1)?)?,
                radii: (self.length(&values, 2)?, self.length(&values, 3)?),
            },
            "PARABOLA" => {
                SourceCurve::Parabola { frame: self.frame(values.reference(1)?)?, focal: self.length(&values, 2)? }
            }
            "SURFACE_CURVE" | "SEAM_CURVE" | "INTERSECTION_CURVE" | "BOUNDED_SURFACE_CURVE" => {
                return self.curve_at(values.reference(1)?, depth + 1);
            }
            "TRIMMED_CURVE" => {
                let basis = self.curve_at(values.reference(1)?, depth + 1)?;
                let sense = values.flag(4)?;
                let curve = if sense { basis.curve } else { reversed(&basis.curve) };
                return Ok(EdgeCurve { curve, own_parameter: basis.own_parameter && sense });
            }
            "CURVE_REPLICA" => {
                let basis = self.curve_at(values.reference(1)?, depth + 1)?;
                let map = self.turn(values.reference(2)?)?;
                let curve = mapped_curve(&basis.curve, &map).map_err(|error| values.refuse(error.to_string()))?;
                return Ok(EdgeCurve { curve, own_parameter: false });
            }
            "POLYLINE"
            | "COMPOSITE_CURVE"
            | "COMPOSITE_CURVE_ON_SURFACE"
            | "BOUNDARY_CURVE"
            | "OUTER_BOUNDARY_CURVE" => {
                let curve = SourceCurve::Nurbs(self.bounded_at(id, depth)?);
                return Ok(EdgeCurve { curve, own_parameter: false });
            }
            "PCURVE" => {
                return Err(values.refuse("it lies in a surface only; write the file with curves in space".to_owned()));
            }
            _ => return Err(entities.unexpected(id, "a curve in space")),
        };
        Ok(EdgeCurve { curve, own_parameter: true })
    }

    /// The profile of a swept surface, and whether its parameter is that of the file: bounded where the file bounds it, since a whole circle or
    /// line may sweep a surface that crosses itself.
    pub(super) fn profile(&self, id: u64) -> Understood<EdgeCurve> {
        if self.entities.is(id, &["TRIMMED_CURVE"])
            && let Ok(curve) = self.bounded_at(id, 0)
        {
            return Ok(EdgeCurve { curve: SourceCurve::Nurbs(curve), own_parameter: false });
        }
        self.curve(id)
    }

    /// A curve that has ends of its own.
    fn bounded_at(&self, id: u64, depth: usize) -> Understood<NurbsCurve> {
        let entities = self.entities;
        entities.spend(id, 1)?;
        if depth > MAX_DEPTH {
            return Err(entities.refuse(id, "curves of curves are nested too deeply".to_owned()));
        }
        if entities.is(id, &spline::CURVES) {
            return self.spline_curve(id);
        }
        let values = entities.simple(id).ok_or_else(|| entities.unexpected(id, "a curve with ends"))?;
        let refuse = |error: InvalidDefinition| values.refuse(error.to_string());
        match values.keyword {
            "POLYLINE" => {
                let points = values.references(1)?;
                entities.spend(id, points.len())?;
                let points = points.into_iter().map(|point| self.point(point)).collect::<Understood<Vec<_>>>()?;
                polyline(points).map_err(refuse)
            }
            "TRIMMED_CURVE" => self.trimmed(&values, depth),
            "SURFACE_CURVE" | "SEAM_CURVE" | "INTERSECTION_CURVE" => self.bounded_at(values.reference(1)?, depth + 1),
            "COMPOSITE_CURVE" | "COMPOSITE_CURVE_ON_SURFACE" | "BOUNDARY_CURVE" | "OUTER_BOUNDARY_CURVE" => {
                let mut pieces = Vec::new();
                for segment in values.references(1)? {
                    let segment = entities
                        .simple_of(segment, &["COMPOSITE_CURVE_SEGMENT", "REPARAMETRISED_COMPOSITE_CURVE_SEGMENT"])
                        .ok_or_else(|| entities.unexpected(segment, "a segment of a curve"))?;
                    let piece = self.bounded_at(segment.reference(2)?, depth + 1)?;
                    entities.spend(id, piece.control_points().len())?;
                    pieces.push(if segment.flag(1)? { piece } else { piece.reversed() });
                }
                check_joints(&pieces).map_err(|reason| values.refuse(reason))?;
                joined(&pieces).map_err(refuse)
            }
            _ => Err(entities.unexpected(id, "a curve with ends")),
        }
    }

    /// A trimmed curve: `'', basis, (trim), (trim), sense, which trims count`.
    fn trimmed(&self, values: &Values<'_>, depth: usize) -> Understood<NurbsCurve> {
        let basis = values.reference(1)?;
        let curve = self.curve_at(basis, depth + 1)?.curve;
        let sense = values.flag(4)?;
        let by_points = matches!(values.get(5), Some(Attribute::Enum(which)) if which == "CARTESIAN");
        let (first, last) = (self.trim(values, 2, &curve, by_points)?, self.trim(values, 3, &curve, by_points)?);
        let (from, to) = if sense { (first, last) } else { (last, first) };
        let refuse = |error: InvalidDefinition| values.refuse(error.to_string());
        let piece = piece(&curve, from, to).map_err(refuse)?;
        let piece =
            piece.ok_or_else(|| values.refuse(format!("its ends, at {from} and {to}, bound no piece of its curve")))?;
        Ok(if sense { piece } else { piece.reversed() })
    }

    /// The parameter of a trim; radians on circles and ellipses.
    fn trim(&self, values: &Values<'_>, index: usize, curve: &SourceCurve, by_points: bool) -> Understood<f64> {
        let (mut parameter, mut point) = (None, None);
        for trim in values.list(index)? {
            match trim {
                Attribute::EntityRef(id) => point = Some(self.point(*id)?),
                other => parameter = real(other),
            }
        }
        let angle = if matches!(curve, SourceCurve::Circle { .. } | SourceCurve::Ellipse { .. }) {
            self.scales.angle
        } else {
            1.0
        };
        let parameter = parameter.map(|parameter| parameter * angle);
        let at_point = point.and_then(|point| parameter_of(curve, point));
        let chosen = if by_points { at_point.or(parameter) } else { parameter.or(at_point) };
        chosen.ok_or_else(|| {
            values.refuse("an end of it is given by a point, which only lines and conics allow".to_owned())
        })
    }

    /// A length above zero.
    pub(super) fn length(&self, values: &Values<'_>, index: usize) -> Understood<f64> {
        Ok(values.positive(index)? * self.scales.length)
    }
}

/// The curve run the other way.
pub(super) fn reversed(curve: &SourceCurve) -> SourceCurve {
    // turned about xdir, a conic runs the other way
    let turned = |frame: &Frame| Frame { axis: -frame.axis, ..*frame };
    match curve {
        SourceCurve::Line { point, direction } => SourceCurve::Line { point: *point, direction: -*direction },
        SourceCurve::Circle { frame, radius } => SourceCurve::Circle { frame: turned(frame), radius: *radius },
        SourceCurve::Ellipse { frame, radii } => SourceCurve::Ellipse { frame: turned(frame), radii: *radii },
        SourceCurve::Hyperbola { frame, radii } => SourceCurve::Hyperbola { frame: turned(frame), radii: *radii },
        SourceCurve::Parabola { frame, focal } => SourceCurve::Parabola { frame: turned(frame), focal: *focal },
        SourceCurve::Nurbs(curve) => SourceCurve::Nurbs(curve.reversed()),
    }
}

/// The parameter of a point that lies on a line or a conic; angles from 0 to 2π.
pub(super) fn parameter_of(curve: &SourceCurve, point: DVec3) -> Option<f64> {
    let local = |frame: &Frame| {
        let arm = point - frame.centre;
        (arm.dot(frame.xdir), arm.dot(frame.ydir()))
    };
    match curve {
        SourceCurve::Line { point: origin, direction } => {
            Some((point - *origin).dot(*direction) / direction.length_squared())
        }
        SourceCurve::Circle { frame, .. } => {
            let (x, y) = local(frame);
            Some(y.atan2(x).rem_euclid(TAU))
        }
        SourceCurve::Ellipse { frame, radii } => {
            let (x, y) = local(frame);
            Some((y / radii.1).atan2(x / radii.0).rem_euclid(TAU))
        }
        SourceCurve::Hyperbola { frame, radii } => Some((local(frame).1 / radii.1).asinh()),
        SourceCurve::Parabola { frame, focal } => Some(local(frame).1 / (2.0 * focal)),
        SourceCurve::Nurbs(_) => None,
    }
}

/// The piece of a curve between two parameters, in its own direction; none where they bound none.
fn piece(curve: &SourceCurve, from: f64, to: f64) -> Result<Option<NurbsCurve>, InvalidDefinition> {
    if !(from.is_finite() && to.is_finite()) {
        return Ok(None);
    }
    // around a circle the end follows the start, at most a full turn later
    let around = |from: f64, to: f64| {
        let sweep = (to - from).rem_euclid(TAU);
        (from, from + if sweep > 1e-12 { sweep } else { TAU })
    };
    Ok(Some(match curve {
        SourceCurve::Line { point, direction } => {
            if from == to {
                return Ok(None);
            }
            Line::new(*point + from * *direction, *point + to * *direction)?.to_nurbs()?
        }
        SourceCurve::Circle { frame, radius } => Circle::new(*frame, *radius, around(from, to))?.to_nurbs()?,
        SourceCurve::Ellipse { frame, radii } => Ellipse::new(*frame, *radii, around(from, to))?.to_nurbs()?,
        SourceCurve::Hyperbola { frame, radii } => {
            // one rational piece: the middle point is where the tangents of the ends meet
            let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
            let at = |x: f64, y: f64| frame.centre + radii.0 * x * frame.xdir + radii.1 * y * frame.ydir();
            let weight = half.cosh();
            let points = vec![
                at(from.cosh(), from.sinh()),
                at(middle.cosh() / weight, middle.sinh() / weight),
                at(to.cosh(), to.sinh()),
            ];
            NurbsCurve::new(2, vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0], points, Some(vec![1.0, weight, 1.0]))?
        }
        SourceCurve::Parabola { frame, focal } => {
            // one polynomial piece, by blossoms
            let at = |s: f64, t: f64| frame.centre + focal * s * t * frame.xdir + focal * (s + t) * frame.ydir();
            let points = vec![at(from, from), at(from, to), at(to, to)];
            NurbsCurve::new(2, vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0], points, None)?
        }
        SourceCurve::Nurbs(curve) => {
            let (first, last) = curve.domain();
            let (from, to) = (from.max(first), to.min(last));
            if from >= to {
                return Ok(None);
            }
            let mut piece = curve.clone();
            if to < last {
                piece = match piece.split(to) {
                    Ok((before, _)) => before,
                    Err(_) => return Ok(None),
                };
            }
            if from > first {
                piece = match piece.split(from) {
                    Ok((_, after)) => after,
                    Err(_) => return Ok(None),
                };
            }
            piece
        }
    }))
}

/// The polyline through points, one unit of the parameter a side.
pub(super) fn polyline(points: Vec<DVec3>) -> Result<NurbsCurve, InvalidDefinition> {
    let last = points.len().saturating_sub(1);
    let knots = std::iter::once(0.0).chain((0..=last).map(|i| i as f64)).chain(std::iter::once(last as f64)).collect();
    NurbsCurve::new(1, knots, points, None)
}

/// Pieces of a curve must meet: a gap of a thousandth of their size is no rounding of the file any more.
fn check_joints(pieces: &[NurbsCurve]) -> Result<(), String> {
    if pieces.is_empty() {
        return Err("it has no segments".to_owned());
    }
    let size = pieces.iter().map(|piece| piece.control_box().diagonal()).fold(0.0, f64::max);
    for (i, pair) in pieces.windows(2).enumerate() {
        let (end, start) = (pair[0].point(pair[0].domain().1), pair[1].point(pair[1].domain().0));
        let gap = end.distance(start);
        if gap > 1e-3 * size {
            return Err(format!("its segments {} and {} are {gap} apart", i + 1, i + 2));
        }
    }
    Ok(())
}
