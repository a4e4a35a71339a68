//! The trim of a surface: validated loops of p-curves.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use crate::id::EntityId;
use crate::invalid::Direction;
use crate::surface::NurbsSurface;
use crate::trim::invalid::InvalidTrim;
use crate::trim::plane_curve::PlaneCurve;
use crate::trim::region::Region;

/// By how much of the domain's extent a p-curve may leave it and is clamped: files are seen with 6e-4.
const SLACK: f64 = 1e-3;

/// How often a p-curve's knots are refined to bring its control points closer to it, before it is said to leave the domain.
const REFINEMENTS: usize = 6;

/// Where the straight way over a gap is looked at.
const STEPS: usize = 8;

/// A p-curve of a loop, as files hold it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename = "TrimCurve", deny_unknown_fields)]
pub struct TrimCurveData {
    /// The degree.
    pub degree: usize,
    /// The knots: points + degree + 1 of them.
    pub knots: Vec<f64>,
    /// The control points `(u, v)`, in parameters of the surface.
    pub points: Vec<DVec2>,
    /// One weight a control point; none: all 1.
    #[serde(default)]
    pub weights: Option<Vec<f64>>,
    /// The curve in space that follows this p-curve, if it is an entity.
    #[serde(default)]
    pub edge: Option<EntityId>,
}

/// A loop, as files hold it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename = "TrimLoop", deny_unknown_fields)]
pub struct TrimLoopData {
    /// Whether it bounds the region from outside.
    pub outer: bool,
    /// Its p-curves, end to start.
    pub curves: Vec<TrimCurveData>,
}

/// A trim as files hold it, not validated.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Trimming", deny_unknown_fields)]
pub struct TrimmingData {
    /// Whether the outward normal is `-(S_u × S_v)`.
    #[serde(default)]
    pub reversed: bool,
    /// To what length its loops are closed, in the model's unit.
    pub tolerance: f64,
    /// The loops that bound the region.
    pub loops: Vec<TrimLoopData>,
}

/// A p-curve of a loop.
#[derive(Debug, Clone, PartialEq)]
pub struct TrimCurve {
    /// The curve in the surface's parameters.
    pub curve: PlaneCurve,
    /// The curve in space that follows it, if that is an entity. It is related, and never changes the region.
    pub edge: Option<EntityId>,
}

/// A closed loop of p-curves, each of which begins where the one before it ends, within the tolerance.
#[derive(Debug, Clone, PartialEq)]
pub struct TrimLoop {
    /// Whether it bounds the region from outside.
    pub outer: bool,
    /// Its p-curves, in order.
    pub curves: Vec<TrimCurve>,
}

/// The trim of a surface, validated against it.
///
/// The loops are closed within the tolerance and lie in the surface's domain. The region is what they bound by the even-odd rule, so it depends
/// neither on the sense of a loop nor on `outer`; by convention the material lies on the left of every loop.
#[derive(Debug, Clone)]
pub struct Trimming {
    reversed: bool,
    tolerance: f64,
    loops: Vec<TrimLoop>,
    region: Region,
}

/// What had to be done to a trim on entry.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TrimEntry {
    /// By how much p-curves left the domain and were clamped, as a share of its extent in u and in v.
    pub clamped: [f64; 2],
}

impl Trimming {
    /// Validates the trim of a surface, and says what had to be done.
    ///
    /// # Errors
    ///
    /// The first rule that the data break.
    pub fn enter(data: TrimmingData, surface: &NurbsSurface) -> Result<(Self, TrimEntry), InvalidTrim> {
        let TrimmingData { reversed, tolerance, loops } = data;
        if !(tolerance >= 0.0 && tolerance.is_finite()) {
            return Err(InvalidTrim::Tolerance { tolerance });
        }
        if loops.is_empty() {
            return Err(InvalidTrim::NoLoops);
        }
        let mut entry = TrimEntry::default();
        let mut entered = Vec::with_capacity(loops.len());
        for (of, one) in loops.into_iter().enumerate() {
            if one.curves.is_empty() {
                return Err(InvalidTrim::EmptyLoop { of });
            }
            let mut curves = Vec::with_capacity(one.curves.len());
            for (curve, data) in one.curves.into_iter().enumerate() {
                let TrimCurveData { degree, knots, points, weights, edge } = data;
                let plane = PlaneCurve::new(degree, knots, points, weights).map_err(|source| InvalidTrim::Curve {
                    of,
                    curve,
                    source,
                })?;
                let plane = inside(plane, surface, &mut entry, (of, curve))?;
                curves.push(TrimCurve { curve: plane, edge });
            }
            let one = TrimLoop { outer: one.outer, curves };
            check_closed(&one, of, surface, tolerance)?;
            entered.push(one);
        }
        let region = Region::new(&entered);
        if region.is_empty() {
            return Err(InvalidTrim::Empty);
        }
        Ok((Self { reversed, tolerance, loops: entered, region }, entry))
    }

    /// Whether the outward normal is `-(S_u × S_v)`.
    #[must_use]
    pub fn reversed(&self) -> bool {
        self.reversed
    }

    /// To what length the loops are closed, in the model's unit.
    #[must_use]
    pub fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// The loops.
    #[must_use]
    pub fn loops(&self) -> &[TrimLoop] {
        &self.loops
    }

    /// What the loops bound.
    #[must_use]
    pub fn region(&self) -> &Region {
        &self.region
    }

    /// The related curves in space, in order.
    pub fn edges(&self) -> impl Iterator<Item = EntityId> + '_ {
        self.loops.iter().flat_map(|one| &one.curves).filter_map(|curve| curve.edge)
    }

    /// The data that a file holds of it.
    #[must_use]
    pub fn data(&self) -> TrimmingData {
        let curve = |one: &TrimCurve| TrimCurveData {
            degree: one.curve.degree(),
            knots: one.curve.knots().as_slice().to_vec(),
            points: one.curve.points().collect(),
            weights: one.curve.weights().map(<[f64]>::to_vec),
            edge: one.edge,
        };
        let of_loop =
            |one: &TrimLoop| TrimLoopData { outer: one.outer, curves: one.curves.iter().map(curve).collect() };
        TrimmingData {
            reversed: self.reversed,
            tolerance: self.tolerance,
            loops: self.loops.iter().map(of_loop).collect(),
        }
    }
}

/// Two trims are equal where their files are.
impl PartialEq for Trimming {
    fn eq(&self, other: &Self) -> bool {
        (self.reversed, self.tolerance, &self.loops) == (other.reversed, other.tolerance, &other.loops)
    }
}

/// The curve with its control points in the domain, where it leaves that by no more than the slack.
fn inside(
    mut plane: PlaneCurve,
    surface: &NurbsSurface,
    entry: &mut TrimEntry,
    (of, curve): (usize, usize),
) -> Result<PlaneCurve, InvalidTrim> {
    let [(u0, u1), (v0, v1)] = [Direction::U, Direction::V].map(|direction| surface.domain(direction));
    let (min, max) = (DVec2::new(u0, v0), DVec2::new(u1, v1));
    let share = |point: DVec2| ((min - point).max(point - max) / (max - min)).max(DVec2::ZERO);
    for refinement in 0..=REFINEMENTS {
        let beyond = plane.points().fold(DVec2::ZERO, |most, point| most.max(share(point)));
        if beyond == DVec2::ZERO {
            return Ok(plane);
        }
        if beyond.max_element() <= SLACK {
            entry.clamped = [entry.clamped[0].max(beyond.x), entry.clamped[1].max(beyond.y)];
            return plane.clamped(min, max).map_err(|source| InvalidTrim::Curve { of, curve, source });
        }
        let on_curve = plane.knots().spans().fold(0.0_f64, |most, span| {
            [span.start, 0.5 * (span.start + span.end), span.end]
                .into_iter()
                .fold(most, |most, t| most.max(share(plane.point(t)).max_element()))
        });
        let outside = |share| Err(InvalidTrim::OutsideDomain { of, curve, share, most: SLACK });
        if on_curve > SLACK {
            return outside(on_curve);
        }
        match plane.refined().filter(|_| refinement < REFINEMENTS) {
            Some(refined) => plane = refined,
            None => return outside(beyond.max_element()),
        }
    }
    unreachable!("the last refinement returns")
}

/// Every curve begins where the one before it ends: the ends, and what the straight way between their parameters passes, are within the
/// tolerance (and rounding) of each other.
fn check_closed(one: &TrimLoop, of: usize, surface: &NurbsSurface, tolerance: f64) -> Result<(), InvalidTrim> {
    let rounding = 64.0 * f64::EPSILON * surface.control_box().reach();
    for (curve, this) in one.curves.iter().enumerate() {
        let before = &one.curves[(curve + one.curves.len() - 1) % one.curves.len()];
        let (from, to) = (before.curve.end(), this.curve.start());
        if from == to {
            continue;
        }
        let at = |uv: DVec2| surface.point(uv.x, uv.y);
        let (start, end) = (at(from), at(to));
        let gap = (0..=STEPS).fold(0.0_f64, |most, k| {
            let point = at(from.lerp(to, k as f64 / STEPS as f64));
            most.max(point.distance(start).min(point.distance(end)))
        });
        let gap = gap.max(start.distance(end));
        if gap > tolerance + rounding {
            return Err(InvalidTrim::Open { of, curve, gap, tolerance });
        }
    }
    Ok(())
}
