//! An arc of a circle in its plane.

use glam::DVec2;
use perpend_kernel::KnotVector;

use super::profile::Foot;
use super::sector::{Asked, Sector};

/// Beyond this radius in lengths of the entity, coordinates are taken from a point of the arc.
pub(super) const FAR: f64 = 4.0;

/// An arc of a circle.
#[derive(Debug)]
pub(super) struct Arc {
    /// What coordinates are relative to: the centre, or the middle of the arc.
    origin: DVec2,
    /// The direction of the arc's middle, and the one across in which it ascends with the parameter.
    x: DVec2,
    y: DVec2,
    radius: f64,
    sector: Sector,
}

/// Where a circle lies in a plane, and over which angles an arc of it runs.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    pub centre: DVec2,
    /// The directions of the angles 0 and π/2.
    pub x: DVec2,
    pub y: DVec2,
    pub radius: f64,
    pub sweep: (f64, f64),
}

impl Place {
    /// The direction of the arc's middle, and the one across in which it runs.
    pub(super) fn middle(&self) -> (DVec2, DVec2) {
        let (from, to) = self.sweep;
        let (sin, cos) = (0.5 * (from + to)).sin_cos();
        let across = cos * self.y - sin * self.x;
        (cos * self.x + sin * self.y, if to < from { -across } else { across })
    }
}

impl Arc {
    /// The arc that a curve runs along, whose control points are `net` with their weights. A radius beyond [`FAR`] makes the arc's middle the
    /// origin; `middle` is it, where it is known better than by the centre.
    pub(super) fn new(
        place: Place,
        middle: Option<DVec2>,
        knots: &KnotVector,
        net: impl Iterator<Item = (DVec2, f64)>,
    ) -> Option<Self> {
        let Place { centre, radius, sweep, .. } = place;
        let (x, y) = place.middle();
        let shift = if radius > FAR { radius } else { 0.0 };
        let origin = if shift > 0.0 { middle.unwrap_or(centre + radius * x) } else { centre };
        let units = net.map(|(p, w)| {
            let arm = p - origin;
            (DVec2::new((arm.dot(x) + shift) / radius, arm.dot(y) / radius), w)
        });
        let sector = Sector::new((sweep.1 - sweep.0).abs(), shift, knots, units)?;
        Some(Self { origin, x, y, radius, sector })
    }

    /// The nearest point to `q`, which is `beside` the plane (a squared length).
    #[inline(always)]
    pub(super) fn foot(&self, q: DVec2, beside: f64, asked: &Asked) -> Foot {
        let arm = q - self.origin;
        let ray = self.sector.nearest(DVec2::new(arm.dot(self.x), arm.dot(self.y)), asked.noise);
        let rim = self.radius - self.sector.shift();
        let off = ray.radial - rim;
        let distance = (off * off + ray.across * ray.across + beside).sqrt();
        let at =
            (ray.direction.x * self.radius - self.sector.shift()) * self.x.x + ray.direction.y * self.radius * self.y.x;
        Foot {
            parameter: self.sector.parameter(&ray, asked.reach),
            distance,
            unproven: 0.0,
            x: self.origin.x + at,
            tie: self.sector.tie(&ray, self.radius, distance, asked),
        }
    }
}
