//! Edges: their curves, cut at their vertices.

use std::f64::consts::TAU;
use std::sync::Arc;

use glam::DVec3;
use perpend::kernel::InvalidEdit;
use perpend::{Circle, Definition, Ellipse, Frame, InvalidDefinition, Line, NurbsCurve, Prepared, Query, Scratch};

use super::{FaceError, TOLERANCES_OFF, WIDEST_OFF, computable};
use crate::source::{SourceCurve, SourceEdge};

/// The edge's curve from its start to its end; exact, but for lines, which join the vertices where those lie within `tolerance`.
///
/// # Errors
///
/// The edge has no length, its vertices do not lie on its curve in this order, or far off it.
pub(crate) fn edge_curve(edge: &SourceEdge, tolerance: f64) -> Result<NurbsCurve, FaceError> {
    let refused = |reason: String| FaceError::Edge { entity: edge.entity, reason };
    if let SourceCurve::Nurbs(curve) = &edge.curve {
        computable(curve.control_points(), curve.weights()).map_err(|error| refused(error.to_string()))?;
    }
    let curve = bounded(edge, tolerance).map_err(|error| refused(error.to_string()))?;
    let curve = curve.ok_or_else(|| refused("its curve does not run from its start to its end".to_owned()))?;
    let (first, last) = curve.domain();
    let off = curve.point(first).distance(edge.start).max(curve.point(last).distance(edge.end));
    let allowed = (TOLERANCES_OFF * tolerance).max(WIDEST_OFF * curve.control_box().diagonal());
    if off > allowed {
        return Err(refused(format!("its curve ends {off:e} off its vertices; at most {allowed:e} is taken for them")));
    }
    Ok(curve)
}

/// None where the vertices are not in order on the curve.
fn bounded(edge: &SourceEdge, tolerance: f64) -> Result<Option<NurbsCurve>, InvalidEdit> {
    let ends = if edge.same_sense { (edge.start, edge.end) } else { (edge.end, edge.start) };
    let along = match &edge.curve {
        SourceCurve::Line { point, direction } => {
            let unit = direction.normalize_or_zero();
            let on = |p: DVec3| *point + (p - *point).dot(unit) * unit;
            let near = |p: DVec3| if on(p).distance(p) <= tolerance { p } else { on(p) };
            if (ends.1 - ends.0).dot(unit) <= 0.0 {
                return Ok(None);
            }
            Line::new(near(ends.0), near(ends.1))?.to_nurbs()?
        }
        SourceCurve::Circle { frame, radius } => {
            let sweep = sweep(edge, ends, |p| angle(frame, p, (1.0, 1.0)));
            Circle::new(*frame, *radius, sweep)?.to_nurbs()?
        }
        SourceCurve::Ellipse { frame, radii } => {
            let sweep = sweep(edge, ends, |p| angle(frame, p, *radii));
            Ellipse::new(*frame, *radii, sweep)?.to_nurbs()?
        }
        SourceCurve::Parabola { frame, focal } => {
            // the points centre + f t² xdir + 2 f t ydir
            let parameter = |p: DVec3| (p - frame.centre).dot(frame.ydir()) / (2.0 * focal);
            let (a, b) = (parameter(ends.0), parameter(ends.1));
            let at = |x: f64, y: f64| frame.centre + focal * x * frame.xdir + 2.0 * focal * y * frame.ydir();
            let points = vec![at(a * a, a), at(a * b, 0.5 * (a + b)), at(b * b, b)];
            NurbsCurve::new(2, vec![a, a, a, b, b, b], points, None)?
        }
        SourceCurve::Hyperbola { frame, radii } => {
            // the points centre + a cosh t xdir + b sinh t ydir: one rational quadratic, as the arc of a circle with hyperbolic functions
            let parameter = |p: DVec3| ((p - frame.centre).dot(frame.ydir()) / radii.1).asinh();
            let (a, b) = (parameter(ends.0), parameter(ends.1));
            let at = |t: f64, lift: f64| {
                frame.centre + (radii.0 * t.cosh() * frame.xdir + radii.1 * t.sinh() * frame.ydir()) / lift
            };
            let lift = (0.5 * (b - a)).cosh();
            let points = vec![at(a, 1.0), at(0.5 * (a + b), lift), at(b, 1.0)];
            NurbsCurve::new(2, vec![a, a, a, b, b, b], points, Some(vec![1.0, lift, 1.0]))?
        }
        SourceCurve::Nurbs(curve) => match between(curve, ends, edge.closed, tolerance)? {
            Some(curve) => curve,
            None => return Ok(None),
        },
    };
    Ok(Some(if edge.same_sense { along } else { along.reversed() }))
}

/// The angle of a point about the axis, of an ellipse its eccentric anomaly.
fn angle(frame: &Frame, p: DVec3, radii: (f64, f64)) -> f64 {
    let arm = p - frame.centre;
    (arm.dot(frame.ydir()) / radii.1).atan2(arm.dot(frame.xdir) / radii.0)
}

/// The angles from the first to the last vertex in the curve's direction.
fn sweep(edge: &SourceEdge, ends: (DVec3, DVec3), angle: impl Fn(DVec3) -> f64) -> (f64, f64) {
    let start = angle(ends.0);
    if edge.closed {
        return (start, start + TAU);
    }
    let end = angle(ends.1);
    (start, if end > start { end } else { end + TAU })
}

/// The part of a curve between two of its points; over its own seam where it is closed and the points lie so.
fn between(
    curve: &NurbsCurve,
    ends: (DVec3, DVec3),
    closed: bool,
    tolerance: f64,
) -> Result<Option<NurbsCurve>, InvalidEdit> {
    let (first, last) = curve.domain();
    let slack = tolerance.max(1e-9 * curve.control_box().reach());
    let near = |p: DVec3, t: f64| curve.point(t).distance(p) <= slack;
    let is_closed = curve.point(first).distance(curve.point(last)) <= slack;
    if near(ends.0, first) && near(ends.1, last) && (closed || !is_closed || ends.0.distance(ends.1) <= slack) {
        return Ok(Some(curve.clone()));
    }
    let prepared = Prepared::new(Arc::new(Definition::from(curve.clone())), None);
    let at = |p: DVec3| nearest(&prepared, p);
    let from = if near(ends.0, first) { first } else { at(ends.0).unwrap_or(first) };
    let to = if closed {
        from
    } else if near(ends.1, last) {
        last
    } else {
        at(ends.1).unwrap_or(last)
    };
    if from < to {
        let whole = if to < last { curve.split(to)?.0 } else { curve.clone() };
        return Ok(Some(if from > first { whole.split(from)?.1 } else { whole }));
    }
    if !is_closed {
        return Ok(None);
    }
    // over the seam: from `from` to the end, then from the start to `to`
    let tail = if from <= first || from >= last { None } else { Some(curve.split(from)?.1) };
    let head = if to <= first || to >= last { None } else { Some(curve.split(to)?.0) };
    Ok(match (tail, head) {
        (Some(tail), Some(head)) => Some(joined(&tail, &head)?),
        (tail, head) => Some(tail.or(head).unwrap_or_else(|| curve.clone())),
    })
}

/// The parameter of the point nearest to `p`.
fn nearest(prepared: &Prepared, p: DVec3) -> Option<f64> {
    let query = Query::new(p, Default::default()).ok()?;
    prepared.project(&query, &mut Scratch::default()).map(|foot| foot.parameter.u())
}

/// One curve of two that meet, the second moved to begin at the parameter where the first ends.
fn joined(first: &NurbsCurve, second: &NurbsCurve) -> Result<NurbsCurve, InvalidDefinition> {
    let (p, end) = (first.degree(), first.domain().1);
    let (from, to) = second.domain();
    let second = second.with_domain(end, end + (to - from))?;
    let mut knots = first.knots().as_slice().to_vec();
    knots.pop();
    knots.extend(&second.knots().as_slice()[p + 1..]);
    let mut points = first.control_points().to_vec();
    points.extend(&second.control_points()[1..]);
    let weights = first.weights().zip(second.weights()).map(|(a, b)| {
        let share = a[a.len() - 1] / b[0];
        a.iter().copied().chain(b[1..].iter().map(|w| w * share)).collect()
    });
    NurbsCurve::new(p, knots, points, weights)
}
