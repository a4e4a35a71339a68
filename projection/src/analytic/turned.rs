//! Surfaces that a profile makes when it is turned about an axis: cylinder, cone, sphere, torus, revolution.
//!
//! The profile lies in a half plane from the axis, `rho >= 0`. Within the sweep the nearest point lies in the query's own half plane, else
//! in that of the nearer end, where the query is as far beside as it is across.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};
use perpend_kernel::{Direction, NurbsSurface};

use super::arc::{Arc, FAR, Place};
use super::axes::{Axes, ROUNDING, orthonormal};
use super::net::Grid;
use super::profile::{Foot, Net, Profile, Search, Segment};
use super::sector::{Asked, Sector};
use super::{Built, Pair};
use crate::hierarchy::Frame;
use crate::solver::Tie;

/// A profile turned about the third axis.
#[derive(Debug)]
pub(super) struct Turned {
    sector: Sector,
    profile: Profile,
    angular: Direction,
    /// Points nearer to the axis are poles.
    pole: f64,
}

/// Where an axis is, and what turns about it.
#[derive(Debug, Clone, Copy)]
pub(super) struct About {
    pub centre: DVec3,
    pub axis: DVec3,
    pub xdir: DVec3,
    pub sweep: (f64, f64),
    pub angular: Direction,
}

/// A profile by its class: distances from the axis and heights, in the model's unit.
#[derive(Debug, Clone, Copy)]
pub(super) enum Stated {
    /// From a point to a point.
    Segment(DVec2, DVec2),
    /// An arc about a centre; the radius, and the angles from outwards to upwards.
    Arc(DVec2, f64, (f64, f64)),
    /// What the definition has.
    General,
}

impl Turned {
    /// The closed form of a surface that turns; `gap` is its proven deviation, in the model's unit.
    ///
    /// None where the profile crosses the axis.
    pub(super) fn new(
        surface: &NurbsSurface,
        frame: &Frame,
        about: About,
        stated: Stated,
        gap: f64,
    ) -> Option<Built<Self>> {
        let About { centre, axis, xdir, sweep, angular } = about;
        let (x0, y0, z) = orthonormal(axis, xdir)?;
        let (sin, cos) = (0.5 * (sweep.0 + sweep.1)).sin_cos();
        let (x, across) = (cos * x0 + sin * y0, cos * y0 - sin * x0);
        let y = if sweep.1 < sweep.0 { -across } else { across };
        let turn = (sweep.1 - sweep.0).abs();
        let (sin, cos) = (0.5 * turn).sin_cos();
        let grid = Grid::new(surface, angular);
        let (n, m) = grid.count();
        // the start of the turn is a profile
        let about_centre = Axes::new(frame, centre, x, y, z);
        let at_start =
            |p: DVec3, shift: f64| DVec2::new(p.x * cos - p.y * sin - shift * 2.0 * (0.25 * turn).sin().powi(2), p.z);
        let middle = match stated {
            Stated::Segment(from, to) => frame.scale * 0.5 * (from + to),
            Stated::Arc(centre, radius, range) => frame.scale * (centre + radius * section(radius, range).middle().0),
            Stated::General => {
                let points = (0..m).map(|j| at_start(about_centre.enter(grid.point(0, j)), 0.0));
                let (low, high) = points.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(l, h), p| (l.min(p), h.max(p)));
                0.5 * (low + high)
            }
        };
        let shift = if middle.x > FAR { middle.x } else { 0.0 };
        let arm = shift * x + middle.y * z;
        let axes = Axes::new(frame, centre + arm / frame.scale, x, y, z);
        let start: Vec<DVec3> = (0..m).map(|j| axes.enter(grid.point(0, j))).collect();
        let net = Net {
            knots: grid.across().clone(),
            points: start.iter().enumerate().map(|(j, p)| (at_start(*p, shift), grid.weight(0, j))).collect(),
        };
        let local = |p: DVec2| frame.scale * p - DVec2::new(shift, middle.y);
        let mut deviation = 0.0;
        let (profile, radius) = match stated {
            Stated::Segment(from, to) => {
                let (from, to) = (local(from), local(to));
                let along = (to - from).try_normalize()?;
                let segment = Segment::new(0.5 * (from + to), along, 0.5 * from.distance(to), &net)?;
                (Profile::Segment(segment), 0.0)
            }
            Stated::Arc(centre, radius, sweep) => {
                let place = Place { centre: local(centre), ..section(frame.scale * radius, sweep) };
                let known = (shift > 0.0).then_some(DVec2::ZERO);
                let arc = Arc::new(place, known, &net.knots, net.points.iter().copied())?;
                (Profile::Arc(arc), place.radius)
            }
            Stated::General => {
                let off = start.iter().map(|p| (p.y * cos + (p.x + shift) * sin).abs()).fold(0.0, f64::max);
                let (profile, gap, radius) = Profile::of(&net)?;
                deviation = off + gap;
                (profile, radius)
            }
        };
        let reach = shift + middle.abs().max_element() + radius;
        let inner = stated.least(&net, shift, frame.scale);
        let slack = 4.0 * gap * frame.scale + 64.0 * ROUNDING * (2.0 + reach);
        let holds = inner >= -slack && deviation <= slack;
        if !holds {
            return None;
        }
        let widest = (0..m).max_by(|a, b| net.points[*a].0.x.total_cmp(&net.points[*b].0.x))?;
        let unit = net.points[widest].0.x + shift;
        if unit <= 0.0 {
            return None;
        }
        let units = (0..n).map(|i| {
            let p = axes.enter(grid.point(i, widest));
            (DVec2::new(p.x + shift, p.y) / unit, grid.weight(i, widest))
        });
        let sector = Sector::new(turn, shift, grid.along(), units)?;
        let shape = Self { sector, profile, angular, pole: 16.0 * ROUNDING * (2.0 + reach) };
        Some(Built { shape, axes, deviation: deviation + (-inner).max(0.0), radius: reach })
    }

    #[inline(always)]
    pub(super) fn foot(&self, q: DVec3, asked: &Asked, search: &mut Search<'_>) -> Option<Pair> {
        let ray = self.sector.nearest(q.truncate(), asked.noise);
        let foot = self.profile.foot(DVec2::new(ray.radial, q.z), ray.across * ray.across, asked, search)?;
        let radius = foot.x + self.sector.shift();
        let Foot { parameter, distance, unproven, tie, .. } = foot;
        let (angle, turned) = if radius <= self.pole {
            (self.sector.first(), Tie::None)
        } else {
            (self.sector.parameter(&ray, asked.reach), self.sector.tie(&ray, radius, distance, asked))
        };
        let tie = match (tie, turned) {
            (Tie::Connected, _) | (_, Tie::Connected) => Tie::Connected,
            (Tie::Apart, _) | (_, Tie::Apart) => Tie::Apart,
            (Tie::None, Tie::None) => Tie::None,
        };
        Some(Pair { at: Grid::parameters(self.angular, (angle, parameter)), distance, unproven, tie })
    }
}

/// The circle of a profile about its own centre.
fn section(radius: f64, sweep: (f64, f64)) -> Place {
    Place { centre: DVec2::ZERO, x: DVec2::X, y: DVec2::Y, radius, sweep }
}

impl Stated {
    /// The least distance of the profile from the axis, negative beyond; of a general one, of its control points.
    fn least(self, net: &Net, shift: f64, scale: f64) -> f64 {
        match self {
            Self::Segment(from, to) => scale * from.x.min(to.x),
            Self::Arc(centre, radius, (from, to)) => {
                let (low, high) = (from.min(to), from.max(to));
                // the next angle after the start that points to the axis
                let inwards = PI + TAU * ((low - PI) / TAU).ceil();
                let ends = centre.x + radius * low.cos().min(high.cos());
                scale * if inwards <= high { centre.x - radius } else { ends }
            }
            Self::General => net.points.iter().map(|(p, _)| p.x + shift).fold(f64::INFINITY, f64::min),
        }
    }
}
