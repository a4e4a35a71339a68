//! The curves in space of a face's p-curves.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use perpend::kernel::PlaneCurve;
use perpend::kernel::{Spacing, curve_through};
use perpend::projection::{Prepared, Query, QueryOptions, Scratch};
use perpend::{Definition, Direction, EntityId, NurbsCurve, NurbsSurface, Parameter};

/// Samples by which curves are compared, and told from points.
const SAMPLES: usize = 9;

/// Points that a fitted curve passes at most.
const MOST_POINTS: usize = 1025;

/// A curve in space that runs as a piece of a p-curve does.
#[derive(Debug, Clone)]
pub(super) struct SpaceCurve {
    pub(super) curve: Arc<NurbsCurve>,
    /// Whether the curve runs as the p-curve does.
    pub(super) forward: bool,
    /// The entity that it is.
    pub(super) entity: Option<EntityId>,
    /// How far samples of the p-curve are from it.
    pub(super) deviation: f64,
}

/// Of the coordinates of a surface: points nearer than this share are one within the rounding of their evaluation.
const ROUNDING: f64 = 1e-12;

/// Of a curve's extent: ends nearer than this share, and than the tolerance, are one.
const CLOSED: f64 = 0.01;

/// Whether all of a p-curve is one point within rounding, as at a pole. However short, what is longer bounds the face.
pub(super) fn is_point(surface: &NurbsSurface, plane: &PlaneCurve) -> bool {
    let samples = Image { surface, plane }.samples(plane.domain());
    let rounding = ROUNDING * surface.control_box().reach();
    samples.iter().all(|sample| sample.distance(samples[0]) <= rounding)
}

/// How far samples of a curve are from its start at most.
pub(super) fn extent(curve: &NurbsCurve) -> f64 {
    let (from, to) = curve.domain();
    let at = |k: usize| curve.point(from + k as f64 / (SAMPLES - 1) as f64 * (to - from));
    (1..SAMPLES).map(|k| at(k).distance(at(0))).fold(0.0, f64::max)
}

/// How far apart the ends of a curve are; none where it is closed.
pub(super) fn ends_apart(curve: &NurbsCurve, tolerance: f64) -> Option<f64> {
    let (from, to) = curve.domain();
    let apart = curve.point(from).distance(curve.point(to));
    (apart > tolerance.min(CLOSED * extent(curve))).then_some(apart)
}

/// The edge entity that p-curves, one after the other, follow from end to end; none where they do not.
pub(super) fn whole_edge(
    surface: &NurbsSurface,
    planes: &[&PlaneCurve],
    (id, definition): &(EntityId, Arc<Definition>),
    tolerance: f64,
) -> Option<SpaceCurve> {
    let Definition::NurbsCurve(curve) = &**definition else { return None };
    let samples: Vec<DVec3> =
        planes.iter().flat_map(|plane| Image { surface, plane }.samples(plane.domain())).collect();
    // there and back is not once
    let feet = distances(&samples, curve);
    let slack = 1e-6 * (curve.domain().1 - curve.domain().0);
    let inner = &feet[1..feet.len() - 1];
    let turns = |sign: f64| inner.windows(2).any(|pair| sign * (pair[1].1 - pair[0].1) > slack);
    if turns(1.0) && turns(-1.0) {
        return None;
    }
    let (forward, deviation) = follows(&samples, curve, tolerance)?;
    Some(SpaceCurve { curve: Arc::new(curve.clone()), forward, entity: Some(*id), deviation })
}

/// The curves of a p-curve on a surface, in its order.
pub(super) fn space_curves(
    surface: &NurbsSurface,
    plane: &PlaneCurve,
    edge: Option<&(EntityId, Arc<Definition>)>,
    tolerance: f64,
) -> Vec<SpaceCurve> {
    if let Some(whole) = edge.and_then(|edge| whole_edge(surface, &[plane], edge, tolerance)) {
        return vec![whole];
    }
    let image = Image { surface, plane };
    let samples = image.samples(plane.domain());
    if let Some(curve) = iso_curve(surface, plane).or_else(|| affine_image(surface, plane)) {
        let (forward, deviation) = follows(&samples, &curve, tolerance).unwrap_or((true, 0.0));
        return vec![SpaceCurve { curve: Arc::new(curve), forward, entity: None, deviation }];
    }
    let mut ends = vec![plane.domain().0];
    ends.extend(plane.knots().breaks().filter(|b| b.multiplicity >= plane.degree()).map(|b| b.at));
    ends.push(plane.domain().1);
    ends.windows(2)
        .filter_map(|ends| image.fitted((ends[0], ends[1]), tolerance))
        .map(|(curve, deviation)| SpaceCurve { curve: Arc::new(curve), forward: true, entity: None, deviation })
        .collect()
}

/// A p-curve seen on its surface.
struct Image<'a> {
    surface: &'a NurbsSurface,
    plane: &'a PlaneCurve,
}

impl Image<'_> {
    fn at(&self, t: f64) -> DVec3 {
        let DVec2 { x, y } = self.plane.point(t);
        self.surface.point(x, y)
    }

    fn samples(&self, (from, to): (f64, f64)) -> Vec<DVec3> {
        (0..SAMPLES).map(|k| self.at(from + k as f64 / (SAMPLES - 1) as f64 * (to - from))).collect()
    }

    /// A cubic through points of the image, so many that the points between them are within a tenth of the tolerance, if so many do it; and
    /// how far they are.
    fn fitted(&self, (from, to): (f64, f64), tolerance: f64) -> Option<(NurbsCurve, f64)> {
        let mut count = 9;
        let mut best: Option<(NurbsCurve, f64)> = None;
        while count <= MOST_POINTS {
            let at = |k: f64| self.at(from + k / (count - 1) as f64 * (to - from));
            let mut points: Vec<DVec3> = (0..count).map(|k| at(k as f64)).collect();
            // neighbours with one place have one parameter
            points.dedup_by(|a, b| a.distance(*b) <= 1e-12 * (1.0 + b.length()));
            let degree = 3.min(points.len().saturating_sub(1));
            let Some(curve) = curve_through(&points, degree, Spacing::ChordLength).ok() else { break };
            let between: Vec<DVec3> = (0..count - 1).map(|k| at(k as f64 + 0.5)).collect();
            let deviation = distances(&between, &curve).into_iter().map(|(distance, _)| distance).fold(0.0, f64::max);
            let is_better = best.as_ref().is_none_or(|(_, best)| deviation < *best);
            if is_better {
                best = Some((curve, deviation));
            }
            if deviation <= 0.1 * tolerance {
                break;
            }
            count = 2 * count - 1;
        }
        best
    }
}

/// The distance of each point from the curve, and the parameter of the foot.
fn distances(points: &[DVec3], curve: &NurbsCurve) -> Vec<(f64, f64)> {
    let prepared = Prepared::new(Arc::new(Definition::NurbsCurve(curve.clone())), None);
    let mut scratch = Scratch::default();
    let foot = |point: &DVec3| {
        let query = Query::new(*point, QueryOptions::default()).expect("the point is finite");
        let foot = prepared.project(&query, &mut scratch).expect("no largest distance was asked for");
        match foot.parameter {
            Parameter::Curve(u) | Parameter::Surface(u, _) => (foot.distance, u),
        }
    };
    points.iter().map(foot).collect()
}

/// Whether samples lie on a curve from end to end, and if so whether they run as it does, and how far they are from it.
pub(super) fn follows(samples: &[DVec3], curve: &NurbsCurve, tolerance: f64) -> Option<(bool, f64)> {
    let (first, last) = (samples[0], samples[samples.len() - 1]);
    let (start, end) = (curve.point(curve.domain().0), curve.point(curve.domain().1));
    let joins = |a: DVec3, b: DVec3| a.distance(start) <= tolerance && b.distance(end) <= tolerance;
    if !joins(first, last) && !joins(last, first) {
        return None;
    }
    let inner = distances(&samples[1..samples.len() - 1], curve);
    let deviation = inner.iter().map(|(distance, _)| *distance).fold(0.0, f64::max);
    if deviation > tolerance {
        return None;
    }
    // of a closed curve both ends join; the feet tell
    let ascends = inner[0].1 < inner[inner.len() - 1].1;
    (if ascends { joins(first, last) } else { joins(last, first) }).then_some((ascends, deviation))
}

/// The iso-curve that a straight p-curve along a parameter follows, exactly but for its parametrisation.
fn iso_curve(surface: &NurbsSurface, plane: &PlaneCurve) -> Option<NurbsCurve> {
    let points: Vec<DVec2> = plane.points().collect();
    let (first, last) = (points[0], points[points.len() - 1]);
    let monotone = |at: fn(&DVec2) -> f64| {
        points.windows(2).all(|pair| at(&pair[0]) <= at(&pair[1]))
            || points.windows(2).all(|pair| at(&pair[0]) >= at(&pair[1]))
    };
    let (held, at, range) = if points.iter().all(|point| point.x == first.x) && monotone(|p| p.y) {
        (Direction::U, first.x, (first.y, last.y))
    } else if points.iter().all(|point| point.y == first.y) && monotone(|p| p.x) {
        (Direction::V, first.y, (first.x, last.x))
    } else {
        return None;
    };
    let curve = surface.iso_curve(held, at).ok()?;
    let (low, high) = (range.0.min(range.1), range.0.max(range.1));
    let (start, end) = curve.domain();
    let curve = if high < end { curve.split(high).ok()?.0 } else { curve };
    let curve = if low > start { curve.split(low).ok()?.1 } else { curve };
    Some(if range.0 > range.1 { curve.reversed() } else { curve })
}

/// The image of a p-curve on a surface that is an affine map: its control points are mapped.
fn affine_image(surface: &NurbsSurface, plane: &PlaneCurve) -> Option<NurbsCurve> {
    let net = surface.control_points();
    let is_bilinear = surface.degree() == (1, 1) && net.len() == 4 && surface.weights().is_none();
    if !is_bilinear || (net[0] - net[1] - net[2] + net[3]).length() > 4.0 * f64::EPSILON * surface.control_box().reach()
    {
        return None;
    }
    let points = plane.points().map(|point| surface.point(point.x, point.y)).collect();
    NurbsCurve::new(plane.degree(), plane.knots().as_slice().to_vec(), points, plane.weights().map(<[f64]>::to_vec))
        .ok()
}
