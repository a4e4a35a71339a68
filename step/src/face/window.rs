//! The NURBS of a face's carrier: as much of the surface as the face needs.

use perpend::{Cone, Cylinder, Direction, NurbsSurface, Plane, Shape, Sphere, Torus};

use glam::DVec2;

use super::FaceError;
use super::carrier::{Carrier, Form};
use super::chain::Ring;
use super::numeric;
use super::turn::Turn;

/// How far the surface goes on beyond an edge that bends, as a share of the face's extent: such edges are met between the places where
/// they were looked at.
const MARGIN: f64 = 0.02;

/// A surface with its NURBS, and the way from the carrier's coordinates to its parameters.
#[derive(Debug)]
pub(super) struct Window {
    pub(super) surface: NurbsSurface,
    pub(super) shape: Option<Shape>,
    maps: [Map; 2],
}

/// From a coordinate to a NURBS parameter.
#[derive(Debug, Clone, Copy)]
enum Map {
    /// The range to `[0, 1]`.
    Linear(f64, f64),
    /// Angles to the parameter of an arc.
    Turn(Turn),
    /// The parameter itself, within a range.
    Same(f64, f64),
}

impl Window {
    /// The window of a carrier around rings; `full` are the ranges of coordinates at which it was cut open.
    pub(super) fn new(carrier: &Carrier, rings: &[Ring], full: [Option<(f64, f64)>; 2]) -> Result<Self, FaceError> {
        let ranges = [0, 1].map(|k| full[k].unwrap_or_else(|| range(carrier, rings, k)));
        if !ranges.iter().all(|(low, high)| low < high && (high - low).is_finite()) {
            return Err(FaceError::Empty);
        }
        let [first, second] = ranges;
        let linear = |(low, high): (f64, f64)| Map::Linear(low, high);
        let turn = |range| Map::Turn(Turn::new(range));
        let (shape, maps): (Shape, [Map; 2]) = match &carrier.form {
            Form::Plane(frame) => (Plane::new(*frame, first, second)?.into(), [linear(first), linear(second)]),
            Form::Cylinder { frame, radius } => {
                (Cylinder::new(*frame, *radius, first, second)?.into(), [linear(first), turn(second)])
            }
            Form::Cone { frame, radius, half_angle } => {
                let at = |height: f64| {
                    let apex = carrier.poles[0].value;
                    if height == apex { 0.0 } else { (radius + height * half_angle.tan()).max(0.0) }
                };
                let radii = (at(first.0), at(first.1));
                (Cone::new(*frame, radii, first, second)?.into(), [linear(first), turn(second)])
            }
            Form::Sphere { frame, radius } => {
                (Sphere::new(*frame, *radius, first, second)?.into(), [turn(first), turn(second)])
            }
            Form::Torus { frame, major, minor } => {
                (Torus::new(*frame, *major, *minor, first, second)?.into(), [turn(first), turn(second)])
            }
            Form::Numeric(numeric) => return Self::numeric(numeric, ranges),
        };
        let surface = match shape.definition()? {
            perpend::Definition::NurbsSurface(surface) => surface,
            perpend::Definition::NurbsCurve(_) => unreachable!("shapes of faces are surfaces"),
        };
        Ok(Self { surface, shape: Some(shape), maps })
    }

    fn numeric(numeric: &numeric::Numeric, ranges: [(f64, f64); 2]) -> Result<Self, FaceError> {
        let mut surface = numeric.surface.clone();
        let mut maps = [Map::Same(0.0, 0.0); 2];
        for (k, direction) in [Direction::U, Direction::V].into_iter().enumerate() {
            let (first, last) = surface.domain(direction);
            let (low, high) = ranges[k];
            let extent = last - first;
            // by whole periods, so that the range begins in the domain
            let periods = if numeric.closed[k] { ((low - first) / extent + 1e-9).floor() * extent } else { 0.0 };
            let (start, end) = (low - periods, high - periods);
            let hair = 1e-9 * extent;
            if numeric.closed[k] && end > last + hair {
                let spare = extent - (end - start);
                let at = (start - 0.5 * spare.max(0.0)).max(first);
                if at > first + hair {
                    surface = numeric::cut_open(&surface, direction, at)?;
                }
            }
            if numeric.cropped {
                surface = numeric::part(&surface, direction, (start, end))?;
            }
            let (first, last) = surface.domain(direction);
            if periods != 0.0 {
                surface = surface.with_domain(direction, first + periods, last + periods)?;
            }
            let (first, last) = surface.domain(direction);
            maps[k] = Map::Same(first, last);
        }
        Ok(Self { surface, shape: None, maps })
    }

    /// The ranges of a plane's coordinates.
    pub(super) fn linear_ranges(&self) -> [(f64, f64); 2] {
        self.maps.map(|map| match map {
            Map::Linear(low, high) | Map::Same(low, high) => (low, high),
            Map::Turn(_) => unreachable!("a plane has no angles"),
        })
    }

    /// The NURBS parameters at coordinates.
    pub(super) fn parameters(&self, at: DVec2) -> DVec2 {
        let one = |map: &Map, x: f64| match map {
            Map::Linear(low, high) => ((x - low) / (high - low)).clamp(0.0, 1.0),
            Map::Turn(turn) => turn.parameter(x),
            Map::Same(low, high) => x.clamp(*low, *high),
        };
        DVec2::new(one(&self.maps[0], at.x), one(&self.maps[1], at.y))
    }

    /// The coordinates at which lines of constant coordinate `k` are no longer smooth.
    pub(super) fn joints(&self, k: usize) -> Vec<f64> {
        match &self.maps[k] {
            Map::Turn(turn) => turn.joints(),
            Map::Linear(..) => Vec::new(),
            Map::Same(..) => {
                let direction = [Direction::U, Direction::V][k];
                numeric::inner_knots(self.surface.knots(direction))
            }
        }
    }
}

/// The range of a coordinate that rings need.
fn range(carrier: &Carrier, rings: &[Ring], k: usize) -> (f64, f64) {
    let none = (f64::INFINITY, f64::NEG_INFINITY);
    let extent = |at: &[DVec2]| at.iter().fold(none, |(a, b), at| (a.min(at[k]), b.max(at[k])));
    let (mut all, mut straight) = (none, none);
    for piece in rings.iter().flat_map(|ring| &ring.pieces) {
        let (a, b) = extent(&piece.at);
        all = (all.0.min(a), all.1.max(b));
        if b - a <= carrier.hair(k) {
            straight = (straight.0.min(a), straight.1.max(b));
        }
    }
    let hair = carrier.hair(k);
    let margin = MARGIN * (all.1 - all.0);
    let mut low = if straight.0 <= all.0 + hair { all.0 } else { all.0 - margin };
    let mut high = if straight.1 >= all.1 - hair { all.1 } else { all.1 + margin };
    if let Some(period) = carrier.periods[k] {
        let most = 0.5 * (period - (all.1 - all.0)).max(0.0);
        (low, high) = (low.max(all.0 - most), high.min(all.1 + most));
    }
    let (first, last) = carrier.limits[k];
    // an edge at a limit is that limit
    let onto = |x: f64, limit: f64| if (x - limit).abs() <= hair { limit } else { x };
    (onto(low, first).max(first), onto(high, last).min(last))
}
