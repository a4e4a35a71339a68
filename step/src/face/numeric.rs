//! Carriers without a closed form: B-splines, revolutions and extrusions.

use std::cell::Cell;
use std::f64::consts::TAU;
use std::sync::{Arc, OnceLock};

use glam::{DVec2, DVec3};
use perpend::kernel::{InvalidEdit, extrusion, revolution};
use perpend::{
    Circle, Definition, Direction, Ellipse, Frame, InvalidDefinition, KnotVector, Line, NurbsCurve, NurbsSurface,
    Prepared, Query, QueryOptions, Scratch,
};

use super::FaceError;
use super::carrier::Pole;
use crate::source::SourceCurve;

/// Steps of Newton's method from a near point, before the certified projection is asked.
const STEPS: usize = 24;

/// How often a step that leads away is halved.
const HALVINGS: usize = 12;

/// A step below this share of the domain ends at its start.
const CONVERGED: f64 = 1e-13;

/// How often one projection may split its surface.
const SPLITS: u32 = 2_000;

/// What the projections for one face may cost, in evaluations, splits, and boxes and pieces looked at: the hardest of some thousand faces of
/// real parts takes 35 000.
const WORK: u64 = 2_000_000;

/// A NURBS surface with the nearest points on it.
#[derive(Debug)]
pub(super) struct Numeric {
    pub(super) surface: NurbsSurface,
    /// Whether its first and last line in u, and in v, are one curve.
    pub(super) closed: [bool; 2],
    /// Whether the face's box may cut it down: revolutions and extrusions, which have no extent of their own.
    pub(super) cropped: bool,
    tolerance: f64,
    /// What of [`WORK`] is left.
    left: Cell<u64>,
    prepared: OnceLock<Prepared>,
}

const DIRECTIONS: [Direction; 2] = [Direction::U, Direction::V];

impl Numeric {
    pub(super) fn new(surface: NurbsSurface, tolerance: f64) -> Self {
        let closed = [0, 1].map(|k| is_closed(&surface, k, tolerance));
        Self { surface, closed, cropped: false, tolerance, left: Cell::new(WORK), prepared: OnceLock::new() }
    }

    /// The profile (u) turned a whole turn (v).
    pub(super) fn revolution(
        profile: &SourceCurve,
        centre: DVec3,
        axis: DVec3,
        points: &[DVec3],
        tolerance: f64,
    ) -> Result<Self, FaceError> {
        if let SourceCurve::Circle { frame, radius } = profile
            && let Some(shell) = Self::spindle((frame, *radius), centre, axis, points, tolerance)?
        {
            return Ok(shell);
        }
        let unit = axis.normalize_or_zero();
        // a point of the profile has the distance from the axis and the height of a point of the surface
        let polar = |p: DVec3| {
            let height = (p - centre).dot(unit);
            ((p - centre - height * unit).length(), height)
        };
        let extent = |origin: DVec3, along: DVec3| {
            // the parameters on a line whose points have the heights, or the distances, of the face's points
            let (slope, (_, start)) = (along.dot(unit), polar(origin));
            let mut range = (f64::INFINITY, f64::NEG_INFINITY);
            for p in points {
                let (distance, height) = polar(*p);
                let t = if slope.abs() > 1e-3 {
                    (height - start) / slope
                } else {
                    let across = along - slope * unit;
                    let foot = origin - centre - start * unit;
                    let (a, b, c) =
                        (across.length_squared(), foot.dot(across), foot.length_squared() - distance * distance);
                    let root = (b * b - a * c).max(0.0).sqrt();
                    // both halves of the line sweep the same points
                    (-b + root) / a
                };
                range = (range.0.min(t), range.1.max(t));
            }
            range
        };
        let profile = profile_curve(profile, extent)?;
        let surface = revolution(&profile, centre, axis, TAU)?;
        Ok(Self { cropped: true, ..Self::new(surface, tolerance) })
    }

    /// A circle turned about an axis that it crosses: one of the two shells, the one on which the points lie.
    ///
    /// None where the circle does not cross the axis, or does not lie in a plane with it.
    pub(super) fn spindle(
        circle: (&Frame, f64),
        centre: DVec3,
        axis: DVec3,
        points: &[DVec3],
        tolerance: f64,
    ) -> Result<Option<Self>, FaceError> {
        let ((frame, radius), unit) = (circle, axis.normalize_or_zero());
        let arm = frame.centre - centre;
        // the direction away from the axis in the circle's plane, and the circle's centre along it
        let out = unit.cross(frame.axis);
        let (along, beside) = (arm.dot(out), arm.dot(frame.axis));
        if unit.dot(frame.axis).abs() > 1e-9 || beside.abs() > tolerance || along.abs() >= radius - tolerance {
            return Ok(None);
        }
        let outermost = out.dot(frame.ydir()).atan2(out.dot(frame.xdir));
        let meets = (-along / radius).acos();
        let middle = arm.dot(unit);
        let off = |along: f64| -> f64 {
            let one = |p: &DVec3| {
                let height = (*p - centre).dot(unit);
                let distance = (*p - centre - height * unit).length();
                ((distance - along).hypot(height - middle) - radius).abs()
            };
            points.iter().map(one).sum()
        };
        let sweep = if off(along) <= off(-along) {
            (outermost - meets, outermost + meets)
        } else {
            (outermost + meets, outermost + TAU - meets)
        };
        let profile = Circle::new(*frame, radius, sweep)?.to_nurbs()?;
        let surface = revolution(&profile, centre, axis, TAU)?;
        Ok(Some(Self { cropped: true, ..Self::new(surface, tolerance) }))
    }

    /// The profile (u) moved along the direction (v), as far as the face's points reach.
    pub(super) fn extrusion(
        profile: &SourceCurve,
        direction: DVec3,
        points: &[DVec3],
        size: f64,
        tolerance: f64,
    ) -> Result<Self, FaceError> {
        let unit = direction.normalize_or_zero();
        let profile = profile_curve(profile, |origin, along| {
            // lines beside the direction: what remains of both across it is parallel
            let across = along - along.dot(unit) * unit;
            let parameters = points.iter().map(|p| (*p - origin).dot(across) / across.length_squared());
            parameters.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), t| (a.min(t), b.max(t)))
        })?;
        let none = (f64::INFINITY, f64::NEG_INFINITY);
        let range = |points: &[DVec3]| points.iter().map(|p| p.dot(unit)).fold(none, |(a, b), t| (a.min(t), b.max(t)));
        let (of_face, of_profile) = (range(points), range(profile.control_points()));
        // whatever point of the profile the face's points are above
        let (low, high) = (of_face.0 - of_profile.1 - 1e-3 * size, of_face.1 - of_profile.0 + 1e-3 * size);
        let moved = profile.transformed(&glam::DAffine3::from_translation(low * unit))?;
        let surface = extrusion(&moved, (high - low) * unit)?;
        Ok(Self { cropped: true, ..Self::new(surface, tolerance) })
    }

    /// The first and the last parameter in u and in v.
    pub(super) fn domain(&self) -> [(f64, f64); 2] {
        DIRECTIONS.map(|direction| self.surface.domain(direction))
    }

    /// The edges of the domain that are one point.
    pub(super) fn poles(&self) -> Vec<Pole> {
        let (rows, columns) = (self.surface.rows(), self.surface.columns());
        let net = self.surface.control_points();
        let row = |i: usize| net[i * columns..(i + 1) * columns].to_vec();
        let column = |j: usize| (0..rows).map(|i| net[i * columns + j]).collect::<Vec<_>>();
        let [(u0, u1), (v0, v1)] = self.domain();
        let edges = [(0, u0, row(0)), (0, u1, row(rows - 1)), (1, v0, column(0)), (1, v1, column(columns - 1))];
        let collapsed = |points: &[DVec3]| points.iter().all(|p| p.distance(points[0]) <= self.tolerance);
        edges
            .into_iter()
            .filter(|(_, _, points)| collapsed(points))
            .map(|(across, value, points)| Pole { across, value, point: points[0] })
            .collect()
    }

    /// The longest derivatives among some.
    pub(super) fn scale(&self) -> DVec2 {
        let [(u0, u1), (v0, v1)] = self.domain();
        let mut scale = DVec2::splat(f64::MIN_POSITIVE);
        for i in 0..=8 {
            for j in 0..=8 {
                let (s, t) = (f64::from(i) / 8.0, f64::from(j) / 8.0);
                let [_, along, across, _] = self.partials(DVec2::new(u0 + s * (u1 - u0), v0 + t * (v1 - v0)));
                scale = scale.max(DVec2::new(across.length(), along.length()));
            }
        }
        scale
    }

    /// Point and first derivatives: `[S, S_v, S_u, ·]`.
    fn partials(&self, at: DVec2) -> [DVec3; 4] {
        let mut out = [DVec3::ZERO; 4];
        self.surface.derivatives(at.x, at.y, 1, &mut out);
        out
    }

    /// The point at parameters, periods taken off.
    pub(super) fn point(&self, at: DVec2) -> DVec3 {
        let at = self.inside(at);
        self.surface.point(at.x, at.y)
    }

    /// Parameters in the domain: periods taken off, the nearer end beyond it.
    fn inside(&self, at: DVec2) -> DVec2 {
        let domain = self.domain();
        let one = |k: usize, x: f64| {
            let (low, high) = domain[k];
            let within = x >= low && x <= high;
            if self.closed[k] && !within { low + (x - low).rem_euclid(high - low) } else { x.clamp(low, high) }
        };
        DVec2::new(one(0, at.x), one(1, at.y))
    }

    /// Whether its projections were given up, since they cost too much.
    pub(super) fn is_exhausted(&self) -> bool {
        self.left.get() == 0
    }

    fn spend(&self, work: u64) {
        self.left.set(self.left.get().saturating_sub(work));
    }

    /// The parameters of the nearest point; where Newton's method leads from `near` to a point within the tolerance, those.
    pub(super) fn inverse(&self, p: DVec3, near: Option<DVec2>) -> DVec2 {
        if self.is_exhausted() {
            return near.unwrap_or_else(|| self.inside(DVec2::ZERO));
        }
        let followed = near.map(|near| self.newton(p, self.inside(near)));
        if let Some((at, distance, true)) = followed
            && distance <= self.tolerance
        {
            return at;
        }
        let certified = self.certified(p).map(|foot| {
            let (polished, distance, _) = self.newton(p, foot);
            let proven = self.point(foot).distance(p);
            if distance <= proven { (polished, distance) } else { (foot, proven) }
        });
        match (followed, certified) {
            (Some((at, distance, true)), Some((_, proven))) if distance <= 1.01 * proven => at,
            (_, Some((foot, _))) => foot,
            (Some((at, ..)), None) => at,
            (None, None) => self.inside(DVec2::ZERO),
        }
    }

    fn certified(&self, p: DVec3) -> Option<DVec2> {
        let prepared = self.prepared.get_or_init(|| {
            let definition = Arc::new(Definition::from(self.surface.clone()));
            Prepared::new(definition, None)
        });
        let query = Query::new(p, QueryOptions { work: SPLITS, ..QueryOptions::default() }).ok()?;
        let mut scratch = Scratch::default();
        let foot = prepared.project(&query, &mut scratch);
        for work in [scratch.statistics.proposal, scratch.statistics.proof] {
            self.spend(work.boxes + work.cells + work.pieces + work.subdivisions + work.refinements + work.evaluations);
        }
        let foot = foot?;
        Some(DVec2::new(foot.parameter.u(), foot.parameter.v()?))
    }

    /// A step that would leave the domain, made along the border that it would cross: normal equations with rows `[(right side, diagonal)]`
    /// and `mixed` beside the diagonal.
    fn along_border(&self, at: DVec2, step: DVec2, rows: [(f64, f64); 2], mixed: f64) -> DVec2 {
        let domain = self.domain();
        let mut step = step;
        for k in 0..2 {
            let (low, high) = domain[k];
            let to = at[k] + step[k];
            if !self.closed[k] && (to < low || to > high) {
                step[k] = to.clamp(low, high) - at[k];
                let (right, diagonal) = rows[1 - k];
                let other = (right - mixed * step[k]) / diagonal;
                if other.is_finite() {
                    step[1 - k] = other;
                }
            }
        }
        step
    }

    /// Where Gauss's steps lead from a start, the distance there, and whether they end there.
    fn newton(&self, p: DVec3, start: DVec2) -> (DVec2, f64, bool) {
        let domain = self.domain();
        let extent = DVec2::new(domain[0].1 - domain[0].0, domain[1].1 - domain[1].0);
        let mut best = (start, self.point(start).distance(p));
        for _ in 0..STEPS {
            self.spend(1);
            let [s, sv, su, _] = self.partials(best.0);
            let r = p - s;
            let (a, b, c) = (su.length_squared(), su.dot(sv), sv.length_squared());
            let (f, g) = (su.dot(r), sv.dot(r));
            let determinant = a * c - b * b;
            let step = if determinant > 1e-14 * a * c {
                DVec2::new(c * f - b * g, a * g - b * f) / determinant
            } else if a * extent.x * extent.x >= c * extent.y * extent.y {
                // along the longer derivative alone, where the two are parallel or one vanishes
                DVec2::new(f / a, 0.0)
            } else {
                DVec2::new(0.0, g / c)
            };
            if !step.is_finite() {
                break;
            }
            let mut step = self.along_border(best.0, step, [(f, a), (g, c)], b);
            let size = (step / extent).abs().max_element();
            if size < CONVERGED {
                return (best.0, best.1, true);
            }
            // near the foot the distance no longer tells, and the step does
            let rounding = 1e-9 * best.1 + 1e-13 * p.abs().max_element();
            let mut next = (self.inside(best.0 + step), 0.0);
            next.1 = self.point(next.0).distance(p);
            for _ in 0..HALVINGS {
                if next.1 <= best.1 + rounding {
                    break;
                }
                self.spend(1);
                step *= 0.5;
                next.0 = self.inside(best.0 + step);
                next.1 = self.point(next.0).distance(p);
            }
            if next.1 > best.1 + rounding {
                break;
            }
            best = next;
        }
        (best.0, best.1, false)
    }
}

/// A profile as NURBS; of a line, the part that `extent` gives for its origin and unit direction.
fn profile_curve(profile: &SourceCurve, extent: impl Fn(DVec3, DVec3) -> (f64, f64)) -> Result<NurbsCurve, FaceError> {
    Ok(match profile {
        SourceCurve::Line { point, direction } => {
            let unit = direction.normalize_or_zero();
            let (a, b) = extent(*point, unit);
            Line::new(*point + a * unit, *point + b * unit)?.to_nurbs()?
        }
        SourceCurve::Circle { frame, radius } => Circle::whole(*frame, *radius)?.to_nurbs()?,
        SourceCurve::Ellipse { frame, radii } => Ellipse::whole(*frame, *radii)?.to_nurbs()?,
        SourceCurve::Nurbs(curve) => curve.clone(),
        SourceCurve::Hyperbola { .. } | SourceCurve::Parabola { .. } => return Err(FaceError::UnboundedProfile),
    })
}

/// Whether the first and the last line of control points are one, up to the tolerance, and others are not.
fn is_closed(surface: &NurbsSurface, k: usize, tolerance: f64) -> bool {
    let (rows, columns) = (surface.rows(), surface.columns());
    let net = surface.control_points();
    let (along, lines) = if k == 0 { (rows, columns) } else { (columns, rows) };
    let index = |i: usize, line: usize| if k == 0 { i * columns + line } else { line * columns + i };
    // weights of the last line are a multiple of those of the first
    let share = |i: usize, line: usize| surface.weights().map_or(1.0, |w| w[index(i, line)] / w[index(i, 0)]);
    let last = along - 1;
    let meets = |line: usize| {
        net[index(0, line)].distance(net[index(last, line)]) <= tolerance
            && (share(0, line) - share(last, line)).abs() <= 1e-9 * share(0, line)
    };
    let opens = |line: usize| (1..last).any(|i| net[index(i, line)].distance(net[index(0, line)]) > tolerance);
    (0..lines).all(meets) && (0..lines).any(opens)
}

/// The closed surface cut open at `at`, a parameter strictly inside the domain: it then begins there, and goes on over its seam.
pub(super) fn cut_open(surface: &NurbsSurface, direction: Direction, at: f64) -> Result<NurbsSurface, InvalidEdit> {
    let (head, tail) = surface.split(direction, at)?;
    let (first, last) = surface.domain(direction);
    let head = head.with_domain(direction, last, last + (at - first))?;
    Ok(joined(&tail, &head, direction)?)
}

/// One surface of two that meet along a line.
fn joined(
    first: &NurbsSurface,
    second: &NurbsSurface,
    direction: Direction,
) -> Result<NurbsSurface, InvalidDefinition> {
    let knots = |surface: &NurbsSurface, direction| surface.knots(direction).as_slice().to_vec();
    let degree = first.knots(direction).degree();
    let mut along = knots(first, direction);
    along.pop();
    along.extend(&second.knots(direction).as_slice()[degree + 1..]);
    let (rows, columns) = (first.rows(), first.columns());
    let net = |surface: &NurbsSurface| -> Vec<Vec<DVec3>> {
        surface.control_points().chunks(surface.columns()).map(<[DVec3]>::to_vec).collect()
    };
    let weights = |surface: &NurbsSurface| -> Option<Vec<Vec<f64>>> {
        surface.weights().map(|w| w.chunks(surface.columns()).map(<[f64]>::to_vec).collect())
    };
    let (mut points, mut all) = (net(first), weights(first));
    let (more, mut more_weights) = (net(second), weights(second));
    if let (Some(a), Some(b)) = (&all, &mut more_weights) {
        let share = match direction {
            Direction::U => a[rows - 1][0] / b[0][0],
            Direction::V => a[0][columns - 1] / b[0][0],
        };
        b.iter_mut().flatten().for_each(|w| *w *= share);
    }
    match direction {
        Direction::U => {
            points.extend(more.into_iter().skip(1));
            if let (Some(a), Some(b)) = (&mut all, more_weights) {
                a.extend(b.into_iter().skip(1));
            }
        }
        Direction::V => {
            points.iter_mut().zip(more).for_each(|(row, more)| row.extend(&more[1..]));
            if let (Some(a), Some(b)) = (&mut all, more_weights) {
                a.iter_mut().zip(b).for_each(|(row, more)| row.extend(&more[1..]));
            }
        }
    }
    let (u, v) = match direction {
        Direction::U => (along, knots(first, Direction::V)),
        Direction::V => (knots(first, Direction::U), along),
    };
    NurbsSurface::new(first.degree(), (u, v), points, all)
}

/// The part of a surface between two parameters, as far as they lie in the domain.
pub(super) fn part(
    surface: &NurbsSurface,
    direction: Direction,
    range: (f64, f64),
) -> Result<NurbsSurface, InvalidEdit> {
    let (first, last) = surface.domain(direction);
    let hair = 1e-9 * (last - first);
    let mut part = surface.clone();
    if range.1 < last - hair {
        part = part.split(direction, range.1)?.0;
    }
    if range.0 > first + hair {
        part = part.split(direction, range.0)?.1;
    }
    Ok(part)
}

/// Where a direction's derivatives may jump: its inner knots.
pub(super) fn inner_knots(knots: &KnotVector) -> Vec<f64> {
    let enough = knots.degree().saturating_sub(1).max(1);
    knots.breaks().filter(|knot| knot.multiplicity >= enough).map(|knot| knot.at).collect()
}
