//! Profiles moved along a vector: extrusions, and rectangles.

use glam::{DVec2, DVec3};
use perpend_kernel::{Direction, NurbsCurve, NurbsSurface};

use super::axes::{Axes, ROUNDING};
use super::net::Grid;
use super::profile::{Net, Profile, Search, Segment};
use super::range::Range;
use super::sector::Asked;
use super::{Built, Pair};
use crate::hierarchy::Frame;

/// A profile moved along the third axis.
#[derive(Debug)]
pub(super) struct Extruded {
    profile: Profile,
    /// The heights over the profile, about their middle.
    heights: Range,
    /// Where the profile does not lie across the vector: its own height along the parameter, in the first coordinate.
    oblique: Option<NurbsCurve>,
    along: Direction,
}

impl Extruded {
    /// The reduction of an extrusion to its profile; `gap` is its proven deviation, in the model's unit.
    ///
    /// A profile that lies in a plane across the vector is its shadow there, and the height is free. Of an oblique one the shadow is no farther
    /// away than the surface, and as far where the foot's height is in range.
    pub(super) fn new(
        surface: &NurbsSurface,
        frame: &Frame,
        vector: DVec3,
        along: Direction,
        gap: f64,
    ) -> Option<Built<Self>> {
        let grid = Grid::new(surface, along);
        let (n, m) = grid.count();
        let z = vector.try_normalize()?;
        let (x, y) = z.any_orthonormal_pair();
        let (low, high) = (0..m)
            .map(|j| grid.point(0, j))
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
        let centre = Axes::new(frame, 0.5 * low + 0.5 * high, x, y, z);
        let heights: Vec<f64> = (0..m).map(|j| centre.enter(grid.point(0, j)).z).collect();
        let (least, most) = heights.iter().fold((f64::MAX, f64::MIN), |(l, h), z| (l.min(*z), h.max(*z)));
        let slack = 4.0 * gap * frame.scale + 64.0 * ROUNDING;
        let flat = most - least <= slack;
        let base = if flat { 0.5 * (least + most) / frame.scale } else { 0.0 };
        let axes = Axes::new(frame, 0.5 * low + 0.5 * high + base * z + 0.5 * vector, x, y, z);
        let start: Vec<DVec3> = (0..m).map(|j| axes.enter(grid.point(0, j))).collect();
        let net = Net {
            knots: grid.across().clone(),
            points: start.iter().enumerate().map(|(j, p)| (p.truncate(), grid.weight(0, j))).collect(),
        };
        let half = 0.5 * axes.local(vector.length());
        let range = range(half, &grid, n, &axes)?;
        let (profile, deviation, radius) = Profile::of(&net)?;
        // a search that most queries far away repeat on the surface does not pay
        if !flat && matches!(profile, Profile::Curve(_)) {
            return None;
        }
        let oblique = if flat {
            None
        } else {
            let points = start.iter().map(|p| DVec3::X * (p.z + half)).collect();
            let weights = net.points.iter().map(|(_, w)| *w).collect();
            Some(NurbsCurve::new(net.knots.degree(), net.knots.as_slice().to_vec(), points, Some(weights)).ok()?)
        };
        let deviation = deviation + if flat { most - least } else { 0.0 };
        Some(Built { shape: Self { profile, heights: range, oblique, along }, axes, deviation, radius })
    }

    /// A rectangle from its middle; `sides` are along u and along v.
    pub(super) fn rectangle(
        surface: &NurbsSurface,
        frame: &Frame,
        origin: DVec3,
        sides: (DVec3, DVec3),
    ) -> Option<Built<Self>> {
        let z = sides.1.try_normalize()?;
        let skew = sides.0.dot(z).abs();
        let x = (sides.0 - sides.0.dot(z) * z).try_normalize()?;
        let axes = Axes::new(frame, origin + 0.5 * sides.0 + 0.5 * sides.1, x, z.cross(x), z);
        let grid = Grid::new(surface, Direction::V);
        let (n, m) = grid.count();
        let points = (0..m).map(|j| (axes.enter(grid.point(0, j)).truncate(), grid.weight(0, j))).collect();
        let net = Net { knots: grid.across().clone(), points };
        let half = 0.5 * axes.local(sides.0.length());
        let segment = Segment::new(DVec2::ZERO, DVec2::X, half, &net)?;
        let heights = range(0.5 * axes.local(sides.1.length()), &grid, n, &axes)?;
        let shape = Self { profile: Profile::Segment(segment), heights, oblique: None, along: Direction::V };
        Some(Built { shape, deviation: axes.local(skew), axes, radius: 0.0 })
    }

    #[inline(always)]
    pub(super) fn foot(&self, q: DVec3, asked: &Asked, search: &mut Search<'_>) -> Option<Pair> {
        let (foot, height) = match &self.oblique {
            None => {
                let clamped = self.heights.clamp(q.z, asked.tolerance());
                let beside = clamped.outside * clamped.outside;
                (self.profile.foot(q.truncate(), beside, asked, search)?, clamped.parameter)
            }
            Some(own) => {
                let foot = self.profile.foot(q.truncate(), 0.0, asked, search)?;
                let clamped = self.heights.clamp(q.z - own.point(foot.parameter).x, asked.tolerance());
                if clamped.outside > 0.0 {
                    return None;
                }
                (foot, clamped.parameter)
            }
        };
        let at = Grid::parameters(self.along, (height, foot.parameter));
        Some(Pair { at, distance: foot.distance, unproven: foot.unproven, tie: foot.tie })
    }
}

/// The heights of the first row along the vector, about their middle.
fn range(half: f64, grid: &Grid<'_>, n: usize, axes: &Axes) -> Option<Range> {
    let first = axes.enter(grid.point(0, 0)).z;
    let lengths = (0..n).map(|i| (axes.enter(grid.point(i, 0)).z - first - half, grid.weight(i, 0)));
    Range::new(half, grid.along(), lengths)
}
