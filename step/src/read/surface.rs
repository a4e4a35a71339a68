//! Surfaces of faces.

use glam::DVec3;
use perpend::Frame;

use super::curve::EdgeCurve;
use super::entities::{MAX_DEPTH, Understood, Values};
use super::placed::mapped_surface;
use super::placement::Geometry;
use super::spline;
use crate::source::{SourceCurve, SourceSurface};

/// The surface of a face, and how its parameters lie to those of the file.
pub(super) struct FaceSurface {
    pub(super) surface: SourceSurface,
    /// Whether its normal is the opposite of the file's.
    pub(super) flipped: bool,
    /// Factors from the file's parameters (u, v) to radians and the part's lengths; none where more than factors lies between.
    pub(super) scales: Option<(f64, f64)>,
}

impl Geometry<'_> {
    /// The surface of a face.
    pub(super) fn surface(&self, id: u64) -> Understood<FaceSurface> {
        self.surface_at(id, 0)
    }

    fn surface_at(&self, id: u64, depth: usize) -> Understood<FaceSurface> {
        let entities = self.entities;
        entities.spend(id, 1)?;
        if depth > MAX_DEPTH {
            return Err(entities.refuse(id, "surfaces of surfaces are nested too deeply".to_owned()));
        }
        if entities.is(id, &spline::SURFACES) {
            let surface = SourceSurface::Nurbs(self.spline_surface(id)?);
            return Ok(FaceSurface { surface, flipped: false, scales: Some((1.0, 1.0)) });
        }
        let values = entities.simple(id).ok_or_else(|| entities.unexpected(id, "a surface"))?;
        let (length, angle) = (self.scales.length, self.scales.angle);
        let (surface, scales) = match values.keyword {
            "PLANE" => (SourceSurface::Plane(self.frame(values.reference(1)?)?), (length, length)),
            "CYLINDRICAL_SURFACE" => {
                let frame = self.frame(values.reference(1)?)?;
                (SourceSurface::Cylinder { frame, radius: self.length(&values, 2)? }, (angle, length))
            }
            "CONICAL_SURFACE" => (self.cone(&values)?, (angle, length)),
            "SPHERICAL_SURFACE" => {
                let frame = self.frame(values.reference(1)?)?;
                (SourceSurface::Sphere { frame, radius: self.length(&values, 2)? }, (angle, angle))
            }
            "TOROIDAL_SURFACE" | "DEGENERATE_TOROIDAL_SURFACE" => (self.torus(&values)?, (angle, angle)),
            "SURFACE_OF_REVOLUTION" => {
                let profile = self.profile(values.reference(1)?)?;
                let (point, axis) = self.axis(values.reference(2)?)?;
                let along = self.along(&profile);
                let surface = SourceSurface::Revolution { profile: profile.curve, point, axis };
                return Ok(FaceSurface { surface, flipped: false, scales: along.map(|along| (angle, along)) });
            }
            "SURFACE_OF_LINEAR_EXTRUSION" => {
                let profile = self.profile(values.reference(1)?)?;
                let direction = self.vector(values.reference(2)?)?;
                let along = self.along(&profile);
                let surface = SourceSurface::Extrusion { profile: profile.curve, direction };
                return Ok(FaceSurface { surface, flipped: false, scales: along.map(|along| (along, 1.0)) });
            }
            "RECTANGULAR_TRIMMED_SURFACE" => {
                let basis = self.surface_at(values.reference(1)?, depth + 1)?;
                let (u, v) = (values.flag(6)?, values.flag(7)?);
                let scales = basis.scales.filter(|_| u && v);
                return Ok(FaceSurface { flipped: basis.flipped != (u != v), scales, ..basis });
            }
            "CURVE_BOUNDED_SURFACE" => return self.surface_at(values.reference(1)?, depth + 1),
            "OFFSET_SURFACE" => {
                let basis = self.surface_at(values.reference(1)?, depth + 1)?;
                let distance = values.real(2)? * self.scales.length;
                let along = if basis.flipped { -distance } else { distance };
                let surface = offset(&basis.surface, along).map_err(|reason| values.refuse(reason))?;
                return Ok(FaceSurface { surface, ..basis });
            }
            "SURFACE_REPLICA" => {
                let basis = self.surface_at(values.reference(1)?, depth + 1)?;
                let map = self.turn(values.reference(2)?)?;
                let surface = mapped_surface(&basis.surface, &map).map_err(|error| values.refuse(error.to_string()))?;
                return Ok(FaceSurface { surface, scales: None, ..basis });
            }
            _ => return Err(entities.unexpected(id, "a surface")),
        };
        Ok(FaceSurface { surface, flipped: false, scales: Some(scales) })
    }

    /// A cone; where its radius counts from the apex it is zero, which the file may say.
    fn cone(&self, values: &Values<'_>) -> Understood<SourceSurface> {
        let frame = self.frame(values.reference(1)?)?;
        let (radius, half_angle) = (values.real(2)? * self.scales.length, values.real(3)? * self.scales.angle);
        if !(radius >= 0.0 && radius.is_finite()) {
            return Err(values.refuse(format!("its radius is {radius}; it must not be negative")));
        }
        if !(half_angle > 0.0 && half_angle < std::f64::consts::FRAC_PI_2) {
            return Err(values.refuse(format!("its half angle is {half_angle} rad; it must lie between 0 and π/2")));
        }
        Ok(SourceSurface::Cone { frame, radius, half_angle })
    }

    /// A torus; one whose tube crosses the axis is given as the turn of its tube's circle, of which the face is some part.
    fn torus(&self, values: &Values<'_>) -> Understood<SourceSurface> {
        let frame = self.frame(values.reference(1)?)?;
        let (major, minor) = (values.real(2)? * self.scales.length, self.length(values, 3)?);
        if major >= minor {
            return Ok(SourceSurface::Torus { frame, major, minor });
        }
        if !major.is_finite() {
            return Err(values.refuse("its major radius is not finite".to_owned()));
        }
        let around = Frame { centre: frame.centre + major * frame.xdir, axis: -frame.ydir(), xdir: frame.xdir };
        let profile = SourceCurve::Circle { frame: around, radius: minor };
        Ok(SourceSurface::Revolution { profile, point: frame.centre, axis: frame.axis })
    }

    /// The factor of the parameter along a profile.
    fn along(&self, profile: &EdgeCurve) -> Option<f64> {
        let angle = matches!(profile.curve, SourceCurve::Circle { .. } | SourceCurve::Ellipse { .. });
        profile.own_parameter.then_some(if angle { self.scales.angle } else { 1.0 })
    }
}

/// The parallel surface at a distance along the normal, where it is of the same kind.
fn offset(surface: &SourceSurface, distance: f64) -> Result<SourceSurface, String> {
    let grown = |radius: f64, by: f64| {
        let radius = radius + by;
        if radius > 0.0 { Ok(radius) } else { Err(format!("at the distance {distance} its basis shrinks to nothing")) }
    };
    let moved = |frame: &Frame, by: DVec3| Frame { centre: frame.centre + by, ..*frame };
    Ok(match surface {
        SourceSurface::Plane(frame) => SourceSurface::Plane(moved(frame, distance * frame.axis)),
        SourceSurface::Cylinder { frame, radius } => {
            SourceSurface::Cylinder { frame: *frame, radius: grown(*radius, distance)? }
        }
        SourceSurface::Cone { frame, radius, half_angle } => SourceSurface::Cone {
            frame: *frame,
            radius: grown(*radius, distance / half_angle.cos())?,
            half_angle: *half_angle,
        },
        SourceSurface::Sphere { frame, radius } => {
            SourceSurface::Sphere { frame: *frame, radius: grown(*radius, distance)? }
        }
        SourceSurface::Torus { frame, major, minor } => {
            let minor = grown(*minor, distance)?;
            if minor > *major {
                return Err(format!("at the distance {distance} its tube crosses the axis"));
            }
            SourceSurface::Torus { frame: *frame, major: *major, minor }
        }
        _ => {
            return Err(
                "offsets are read of planes, cylinders, cones, spheres and tori: convert it to a B-spline surface"
                    .to_owned(),
            );
        }
    })
}
