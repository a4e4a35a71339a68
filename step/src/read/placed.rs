//! Geometry where an assembly puts it: rotated, moved, and scaled alike in all directions.

use glam::DAffine3;
use perpend::{Frame, InvalidDefinition};

use crate::source::{SourceCurve, SourceSurface};

/// The factor of lengths of such a map.
pub(super) fn scale_of(map: &DAffine3) -> f64 {
    let scale = map.matrix3.determinant().cbrt();
    // of a turn it is 1 but for rounding
    if (scale - 1.0).abs() < 1e-13 { 1.0 } else { scale }
}

/// Whether a map turns right-handed frames into left-handed ones.
pub(super) fn is_mirror(map: &DAffine3) -> bool {
    map.matrix3.determinant() < 0.0
}

fn mapped_frame(frame: &Frame, map: &DAffine3) -> Result<Frame, InvalidDefinition> {
    Frame::new(map.transform_point3(frame.centre), map.transform_vector3(frame.axis), map.transform_vector3(frame.xdir))
}

/// A surface where the map puts it; the map must not be a mirror.
pub(super) fn mapped_surface(surface: &SourceSurface, map: &DAffine3) -> Result<SourceSurface, InvalidDefinition> {
    let scale = scale_of(map);
    let frame_of = |frame| mapped_frame(frame, map);
    Ok(match surface {
        SourceSurface::Plane(frame) => SourceSurface::Plane(frame_of(frame)?),
        SourceSurface::Cylinder { frame, radius } => {
            SourceSurface::Cylinder { frame: frame_of(frame)?, radius: scale * radius }
        }
        SourceSurface::Cone { frame, radius, half_angle } => {
            SourceSurface::Cone { frame: frame_of(frame)?, radius: scale * radius, half_angle: *half_angle }
        }
        SourceSurface::Sphere { frame, radius } => {
            SourceSurface::Sphere { frame: frame_of(frame)?, radius: scale * radius }
        }
        SourceSurface::Torus { frame, major, minor } => {
            SourceSurface::Torus { frame: frame_of(frame)?, major: scale * major, minor: scale * minor }
        }
        SourceSurface::Revolution { profile, point, axis } => SourceSurface::Revolution {
            profile: mapped_curve(profile, map)?,
            point: map.transform_point3(*point),
            axis: map.transform_vector3(*axis).normalize(),
        },
        SourceSurface::Extrusion { profile, direction } => SourceSurface::Extrusion {
            profile: mapped_curve(profile, map)?,
            direction: map.transform_vector3(*direction),
        },
        SourceSurface::Nurbs(surface) => SourceSurface::Nurbs(surface.transformed(map)?),
    })
}

/// A curve where the map puts it; the map must not be a mirror.
pub(super) fn mapped_curve(curve: &SourceCurve, map: &DAffine3) -> Result<SourceCurve, InvalidDefinition> {
    let scale = scale_of(map);
    let frame_of = |frame| mapped_frame(frame, map);
    let scaled = |radii: &(f64, f64)| (scale * radii.0, scale * radii.1);
    Ok(match curve {
        SourceCurve::Line { point, direction } => {
            SourceCurve::Line { point: map.transform_point3(*point), direction: map.transform_vector3(*direction) }
        }
        SourceCurve::Circle { frame, radius } => {
            SourceCurve::Circle { frame: frame_of(frame)?, radius: scale * radius }
        }
        SourceCurve::Ellipse { frame, radii } => SourceCurve::Ellipse { frame: frame_of(frame)?, radii: scaled(radii) },
        SourceCurve::Hyperbola { frame, radii } => {
            SourceCurve::Hyperbola { frame: frame_of(frame)?, radii: scaled(radii) }
        }
        SourceCurve::Parabola { frame, focal } => {
            SourceCurve::Parabola { frame: frame_of(frame)?, focal: scale * focal }
        }
        SourceCurve::Nurbs(curve) => SourceCurve::Nurbs(curve.transformed(map)?),
    })
}
