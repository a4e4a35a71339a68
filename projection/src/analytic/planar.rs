//! Plane curves in space: lines, circles, ellipses.

use glam::{DVec2, DVec3};
use perpend_kernel::NurbsCurve;

use super::Built;
use super::arc::{Arc, FAR, Place};
use super::axes::{Axes, orthonormal};
use super::ellipse::EllipticArc;
use super::profile::{Foot, Net, Profile, Search, Segment};
use super::sector::Asked;
use crate::hierarchy::Frame;

/// A curve of the plane `z = 0`.
#[derive(Debug)]
pub(super) struct Planar {
    profile: Profile,
}

impl Planar {
    pub(super) fn line(
        curve: &NurbsCurve,
        frame: &Frame,
        origin: DVec3,
        direction: DVec3,
        range: (f64, f64),
    ) -> Option<Built<Self>> {
        let direction = direction.try_normalize()?;
        let x = if range.1 < range.0 { -direction } else { direction };
        let (y, z) = x.any_orthonormal_pair();
        let axes = Axes::new(frame, origin + 0.5 * (range.0 + range.1) * direction, x, y, z);
        let half = axes.local(0.5 * (range.1 - range.0).abs());
        let segment = Segment::new(DVec2::ZERO, DVec2::X, half, &net(curve, &axes))?;
        Some(Built { shape: Self { profile: Profile::Segment(segment) }, axes, deviation: 0.0, radius: 0.0 })
    }

    pub(super) fn circle(
        curve: &NurbsCurve,
        frame: &Frame,
        (centre, axis, xdir): (DVec3, DVec3, DVec3),
        radius: f64,
        sweep: (f64, f64),
    ) -> Option<Built<Self>> {
        let (x0, y0, z) = orthonormal(axis, xdir)?;
        let (sin, cos) = (0.5 * (sweep.0 + sweep.1)).sin_cos();
        let (x, across) = (cos * x0 + sin * y0, cos * y0 - sin * x0);
        let y = if sweep.1 < sweep.0 { -across } else { across };
        let local = radius * frame.scale;
        let far = local > FAR;
        let axes = Axes::new(frame, if far { centre + radius * x } else { centre }, x, y, z);
        let half = 0.5 * (sweep.1 - sweep.0).abs();
        let centre = if far { DVec2::new(-local, 0.0) } else { DVec2::ZERO };
        let place = Place { centre, x: DVec2::X, y: DVec2::Y, radius: local, sweep: (-half, half) };
        let net = net(curve, &axes);
        let arc = Arc::new(place, Some(DVec2::ZERO), &net.knots, net.points.iter().copied())?;
        Some(Built { shape: Self { profile: Profile::Arc(arc) }, axes, deviation: 0.0, radius: local })
    }

    pub(super) fn ellipse(
        curve: &NurbsCurve,
        frame: &Frame,
        (centre, axis, xdir): (DVec3, DVec3, DVec3),
        radii: (f64, f64),
        sweep: (f64, f64),
    ) -> Option<Built<Self>> {
        if radii.0 == radii.1 {
            return Self::circle(curve, frame, (centre, axis, xdir), radii.0, sweep);
        }
        let (x, y, z) = orthonormal(axis, xdir)?;
        let axes = Axes::new(frame, centre, x, y, z);
        let local = (axes.local(radii.0), axes.local(radii.1));
        let place = Place { centre: DVec2::ZERO, x: DVec2::X, y: DVec2::Y, radius: 1.0, sweep };
        let net = net(curve, &axes);
        let arc = EllipticArc::new(place, local, &net.knots, net.points.iter().copied())?;
        let shape = Self { profile: Profile::EllipticArc(Box::new(arc)) };
        Some(Built { shape, axes, deviation: 0.0, radius: local.0.max(local.1) })
    }

    pub(super) fn is_elliptic(&self) -> bool {
        matches!(self.profile, Profile::EllipticArc(_))
    }

    #[inline(always)]
    pub(super) fn foot(&self, q: DVec3, asked: &Asked, search: &mut Search<'_>) -> Option<Foot> {
        self.profile.foot(q.truncate(), q.z * q.z, asked, search)
    }
}

fn net(curve: &NurbsCurve, axes: &Axes) -> Net {
    let weight = |i: usize| curve.weights().map_or(1.0, |w| w[i]);
    let points = curve.control_points().iter().enumerate().map(|(i, p)| (axes.enter(*p).truncate(), weight(i)));
    Net { knots: curve.knots().clone(), points: points.collect() }
}
