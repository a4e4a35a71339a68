//! The surface that carries a face, in the coordinates in which its loops are followed.
//!
//! These coordinates are, in the order of the NURBS parameters: of a plane the lengths along its frame; of a cylinder or cone the height and the
//! angle; of a sphere latitude and longitude; of a torus the angle around the tube and that about the axis; of every other surface the
//! parameters of its NURBS. They are unbounded where the surface is, and go on over seams.

use std::f64::consts::{FRAC_PI_2, TAU};

use glam::{DVec2, DVec3};
use perpend::{Aabb, Frame, NurbsSurface};

use super::numeric::Numeric;
use super::{FaceError, computable};
use crate::source::{SourceCurve, SourceSurface};

/// A surface and what is known of its coordinates.
#[derive(Debug)]
pub(super) struct Carrier {
    pub(super) form: Form,
    /// The period of each coordinate; none where it is not periodic.
    pub(super) periods: [Option<f64>; 2],
    /// Where each coordinate ends; infinite where it does not.
    pub(super) limits: [(f64, f64); 2],
    /// Where a line of one coordinate is one point.
    pub(super) poles: Vec<Pole>,
    /// `S_u × S_v` of the NURBS is the normal of the surface in STEP.
    pub(super) normal_kept: bool,
    /// The length that a unit of each coordinate has at most, about.
    pub(super) scale: DVec2,
    /// What can be told apart, a length.
    pub(super) tolerance: f64,
    /// Nearer than this to a pole is at the pole: how far edges lie off the surface counts too.
    pub(super) pole_tolerance: f64,
}

/// A line of a constant coordinate that is one point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pole {
    /// Which coordinate is constant.
    pub(super) across: usize,
    pub(super) value: f64,
    pub(super) point: DVec3,
}

/// The formulas of a surface.
#[derive(Debug)]
pub(super) enum Form {
    Plane(Frame),
    Cylinder { frame: Frame, radius: f64 },
    Cone { frame: Frame, radius: f64, half_angle: f64 },
    Sphere { frame: Frame, radius: f64 },
    Torus { frame: Frame, major: f64, minor: f64 },
    Numeric(Box<Numeric>),
}

const NO_LIMIT: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);

impl Carrier {
    /// The carrier of a face whose edges have these points; `size` is their extent, `tolerance` what can be told apart.
    pub(super) fn new(surface: &SourceSurface, points: &[DVec3], size: f64, tolerance: f64) -> Result<Self, FaceError> {
        let analytic = |form, periods, limits, poles, scale| Self {
            form,
            periods,
            limits,
            poles,
            normal_kept: false,
            scale,
            tolerance,
            pole_tolerance: tolerance,
        };
        let positive = |what: &'static str, value: f64| {
            if value > 0.0 && value.is_finite() { Ok(()) } else { Err(FaceError::Length { what, value }) }
        };
        let frame = |frame: &Frame| Frame::new(frame.centre, frame.axis, frame.xdir);
        Ok(match surface {
            SourceSurface::Plane(given) => {
                let form = Form::Plane(beside(frame(given)?, points));
                let carrier = analytic(form, [None; 2], [NO_LIMIT; 2], Vec::new(), DVec2::ONE);
                Self { normal_kept: true, ..carrier }
            }
            SourceSurface::Cylinder { frame: given, radius } => {
                positive("radius", *radius)?;
                let form = Form::Cylinder { frame: along(frame(given)?, points), radius: *radius };
                let scale = DVec2::new(1.0, *radius);
                analytic(form, [None, Some(TAU)], [NO_LIMIT; 2], Vec::new(), scale)
            }
            SourceSurface::Cone { frame: given, radius, half_angle } => {
                let frame = frame(given)?;
                if !(radius.is_finite() && *radius >= 0.0) {
                    return Err(FaceError::Length { what: "radius", value: *radius });
                }
                if !(half_angle.abs() > 1e-9 && half_angle.abs() < FRAC_PI_2 - 1e-9) {
                    return Err(FaceError::HalfAngle(*half_angle));
                }
                let apex = -radius / half_angle.tan();
                let pole = Pole { across: 0, value: apex, point: frame.centre + apex * frame.axis };
                let limit = if *half_angle > 0.0 { (apex, f64::INFINITY) } else { (f64::NEG_INFINITY, apex) };
                let around = points.iter().fold(0.0_f64, |most, p| most.max(polar(&frame, *p).0));
                let scale = DVec2::new(1.0 / half_angle.cos(), around.max(1e-6 * size));
                let form = Form::Cone { frame, radius: *radius, half_angle: *half_angle };
                analytic(form, [None, Some(TAU)], [limit, NO_LIMIT], vec![pole], scale)
            }
            SourceSurface::Sphere { frame: given, radius } => {
                positive("radius", *radius)?;
                let frame = frame(given)?;
                let pole = |sign: f64| Pole {
                    across: 0,
                    value: sign * FRAC_PI_2,
                    point: frame.centre + sign * *radius * frame.axis,
                };
                let poles = vec![pole(-1.0), pole(1.0)];
                let form = Form::Sphere { frame, radius: *radius };
                let limits = [(-FRAC_PI_2, FRAC_PI_2), NO_LIMIT];
                analytic(form, [None, Some(TAU)], limits, poles, DVec2::splat(*radius))
            }
            SourceSurface::Torus { frame: given, major, minor } => {
                positive("major radius", *major)?;
                positive("minor radius", *minor)?;
                if minor > major {
                    let frame = frame(given)?;
                    let tube = Frame::new(frame.centre + *major * frame.xdir, -frame.ydir(), frame.xdir)?;
                    let profile = SourceCurve::Circle { frame: tube, radius: *minor };
                    let numeric = Numeric::revolution(&profile, frame.centre, frame.axis, points, tolerance)?;
                    return Self::numeric(numeric, false, tolerance);
                }
                let form = Form::Torus { frame: frame(given)?, major: *major, minor: *minor };
                let scale = DVec2::new(*minor, major + minor);
                analytic(form, [Some(TAU); 2], [NO_LIMIT; 2], Vec::new(), scale)
            }
            SourceSurface::Revolution { profile, point, axis } => {
                let numeric = Numeric::revolution(profile, *point, *axis, points, tolerance)?;
                Self::numeric(numeric, false, tolerance)?
            }
            SourceSurface::Extrusion { profile, direction } => {
                let numeric = Numeric::extrusion(profile, *direction, points, size, tolerance)?;
                Self::numeric(numeric, true, tolerance)?
            }
            SourceSurface::Nurbs(surface) => Self::numeric(Numeric::new(surface.clone(), tolerance), true, tolerance)?,
        })
    }

    fn numeric(numeric: Numeric, normal_kept: bool, tolerance: f64) -> Result<Self, FaceError> {
        computable(numeric.surface.control_points(), numeric.surface.weights())?;
        let domain = numeric.domain();
        let periods = [0, 1].map(|k| numeric.closed[k].then(|| domain[k].1 - domain[k].0));
        let limits = [0, 1].map(|k| if numeric.closed[k] { NO_LIMIT } else { domain[k] });
        let (poles, scale) = (numeric.poles(), numeric.scale());
        Ok(Self {
            form: Form::Numeric(Box::new(numeric)),
            periods,
            limits,
            poles,
            normal_kept,
            scale,
            tolerance,
            pole_tolerance: tolerance,
        })
    }

    /// The coordinates of the surface's point nearest to `p`; where `near` is given, those of a point about there.
    pub(super) fn inverse(&self, p: DVec3, near: Option<DVec2>) -> DVec2 {
        match &self.form {
            Form::Plane(frame) => {
                let arm = p - frame.centre;
                DVec2::new(arm.dot(frame.xdir), arm.dot(frame.ydir()))
            }
            Form::Cylinder { frame, .. } => {
                let (_, angle, height) = polar(frame, p);
                DVec2::new(height, angle)
            }
            Form::Cone { frame, radius, half_angle } => {
                let (distance, angle, height) = polar(frame, p);
                let (sin, cos) = half_angle.sin_cos();
                DVec2::new(((distance - radius) * sin + height * cos) * cos, angle)
            }
            Form::Sphere { frame, .. } => {
                let (distance, angle, height) = polar(frame, p);
                DVec2::new(height.atan2(distance), angle)
            }
            Form::Torus { frame, major, .. } => {
                let (distance, angle, height) = polar(frame, p);
                DVec2::new(height.atan2(distance - major), angle)
            }
            Form::Numeric(numeric) => numeric.inverse(p, near),
        }
    }

    /// The point at coordinates.
    pub(super) fn point(&self, at: DVec2) -> DVec3 {
        let turned = |frame: &Frame, distance: f64, height: f64| {
            let (sin, cos) = at.y.sin_cos();
            frame.centre + distance * cos * frame.xdir + distance * sin * frame.ydir() + height * frame.axis
        };
        match &self.form {
            Form::Plane(frame) => frame.centre + at.x * frame.xdir + at.y * frame.ydir(),
            Form::Cylinder { frame, radius } => turned(frame, *radius, at.x),
            Form::Cone { frame, radius, half_angle } => turned(frame, radius + at.x * half_angle.tan(), at.x),
            Form::Sphere { frame, radius } => turned(frame, radius * at.x.cos(), radius * at.x.sin()),
            Form::Torus { frame, major, minor } => turned(frame, major + minor * at.x.cos(), minor * at.x.sin()),
            Form::Numeric(numeric) => numeric.point(at),
        }
    }

    /// Whether the surface has no border at the ends of a coordinate: it is periodic, or both ends are poles.
    pub(super) fn is_closed(&self, coordinate: usize) -> bool {
        let (low, high) = self.limits[coordinate];
        let is_pole = |end: f64| self.poles.iter().any(|pole| pole.across == coordinate && pole.value == end);
        self.periods[coordinate].is_some() || is_pole(low) && is_pole(high)
    }

    /// Where a period of a coordinate begins.
    pub(super) fn base(&self, coordinate: usize) -> f64 {
        match &self.form {
            Form::Numeric(numeric) => numeric.domain()[coordinate].0,
            _ => 0.0,
        }
    }

    /// What of a coordinate cannot be told apart.
    pub(super) fn hair(&self, coordinate: usize) -> f64 {
        let extent = self.periods[coordinate].unwrap_or_else(|| {
            let (low, high) = self.limits[coordinate];
            if (high - low).is_finite() { high - low } else { f64::INFINITY }
        });
        (self.tolerance / self.scale[coordinate]).min(1e-4 * extent)
    }

    /// The multiple of the period that brings a coordinate nearest to `near`; 0 where it has none.
    pub(super) fn shift(&self, coordinate: usize, from: f64, near: f64) -> f64 {
        self.periods[coordinate].map_or(0.0, |period| ((near - from) / period).round() * period)
    }

    /// Coordinates moved by whole periods next to `near`.
    pub(super) fn beside(&self, at: DVec2, near: DVec2) -> DVec2 {
        DVec2::new(at.x + self.shift(0, at.x, near.x), at.y + self.shift(1, at.y, near.y))
    }

    /// The pole that a point cannot be told from.
    pub(super) fn pole(&self, p: DVec3) -> Option<usize> {
        self.poles.iter().position(|pole| pole.point.distance(p) <= self.pole_tolerance)
    }

    /// Whether following edges on it was given up, since it cost too much.
    pub(super) fn is_exhausted(&self) -> bool {
        matches!(&self.form, Form::Numeric(numeric) if numeric.is_exhausted())
    }

    /// The NURBS of a surface that is only known as one.
    pub(super) fn nurbs(&self) -> Option<&NurbsSurface> {
        match &self.form {
            Form::Numeric(numeric) => Some(&numeric.surface),
            _ => None,
        }
    }
}

/// Distance from the axis, angle about it, height along it.
fn polar(frame: &Frame, p: DVec3) -> (f64, f64, f64) {
    let arm = p - frame.centre;
    let (x, y) = (arm.dot(frame.xdir), arm.dot(frame.ydir()));
    (x.hypot(y), y.atan2(x), arm.dot(frame.axis))
}

/// The same plane with its origin beside the points: files put it a mile away, where nothing can be proved to the digits of the face.
fn beside(frame: Frame, points: &[DVec3]) -> Frame {
    let arm = Aabb::around(points.iter().copied()).centre() - frame.centre;
    let centre = frame.centre + arm.dot(frame.xdir) * frame.xdir + arm.dot(frame.ydir()) * frame.ydir();
    if centre.is_finite() { Frame { centre, ..frame } } else { frame }
}

/// The same axis with its origin beside the points.
fn along(frame: Frame, points: &[DVec3]) -> Frame {
    let arm = Aabb::around(points.iter().copied()).centre() - frame.centre;
    let centre = frame.centre + arm.dot(frame.axis) * frame.axis;
    if centre.is_finite() { Frame { centre, ..frame } } else { frame }
}
