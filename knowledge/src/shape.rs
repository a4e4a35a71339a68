//! Analytic shapes: the operations that make them, their exact NURBS form, their class.

use std::f64::consts::TAU;

use perpend_kernel::{
    Circle, Cone, Cylinder, Definition, Direction, Ellipse, Frame, InvalidDefinition, Line, Plane, Sphere, Torus,
};

use crate::classification::Kind;
use crate::operation::Operation;

/// An analytic shape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// A segment.
    Line(Line),
    /// A circle or an arc.
    Circle(Circle),
    /// An ellipse or an arc of one.
    Ellipse(Ellipse),
    /// A rectangle of a plane.
    Plane(Plane),
    /// A cylinder.
    Cylinder(Cylinder),
    /// A cone.
    Cone(Cone),
    /// A sphere.
    Sphere(Sphere),
    /// A torus.
    Torus(Torus),
}

macro_rules! shapes {
    ($($shape:ident),*) => {
        $(
            impl From<$shape> for Shape {
                fn from(shape: $shape) -> Self {
                    Self::$shape(shape)
                }
            }

            impl From<$shape> for Operation {
                fn from(shape: $shape) -> Self {
                    Shape::from(shape).into()
                }
            }
        )*
    };
}

shapes!(Line, Circle, Ellipse, Plane, Cylinder, Cone, Sphere, Torus);

impl Shape {
    /// Its exact NURBS form, up to the rounding of control points.
    ///
    /// # Errors
    ///
    /// A parameter has no meaning.
    pub fn definition(&self) -> Result<Definition, InvalidDefinition> {
        Ok(match self {
            Self::Line(shape) => shape.to_nurbs()?.into(),
            Self::Circle(shape) => shape.to_nurbs()?.into(),
            Self::Ellipse(shape) => shape.to_nurbs()?.into(),
            Self::Plane(shape) => shape.to_nurbs()?.into(),
            Self::Cylinder(shape) => shape.to_nurbs()?.into(),
            Self::Cone(shape) => shape.to_nurbs()?.into(),
            Self::Sphere(shape) => shape.to_nurbs()?.into(),
            Self::Torus(shape) => shape.to_nurbs()?.into(),
        })
    }

    /// Its class.
    ///
    /// # Errors
    ///
    /// The frame is none.
    pub fn kind(&self) -> Result<Kind, InvalidDefinition> {
        Ok(match *self {
            Self::Line(Line { start, end }) => {
                let (direction, length) = (end - start).normalize_and_length();
                Kind::Line { origin: start, direction, range: (0.0, length) }
            }
            Self::Circle(Circle { frame, radius, sweep }) => {
                let Frame { centre, axis, xdir } = unit(frame)?;
                Kind::Circle { centre, axis, xdir, radius, sweep }
            }
            Self::Ellipse(Ellipse { frame, radii, sweep }) => {
                let Frame { centre, axis, xdir } = unit(frame)?;
                Kind::Ellipse { centre, axis, xdir, radii, sweep }
            }
            Self::Plane(Plane { frame, width, height }) => {
                let Frame { centre, axis, xdir } = unit(frame)?;
                let ydir = axis.cross(xdir);
                Kind::Plane {
                    origin: centre + width.0 * xdir + height.0 * ydir,
                    normal: axis,
                    sides: Some(((width.1 - width.0) * xdir, (height.1 - height.0) * ydir)),
                }
            }
            Self::Cylinder(Cylinder { frame, radius, height, sweep }) => {
                let Frame { centre, axis, xdir } = unit(frame)?;
                Kind::Cylinder { centre, axis, xdir, radius, height, sweep, angular: Direction::V }
            }
            Self::Cone(cone) => of_cone(&cone)?,
            Self::Sphere(Sphere { frame, radius, latitude, sweep }) => {
                let Frame { centre, axis, xdir } = unit(frame)?;
                Kind::Sphere { centre, axis, xdir, radius, sweep, latitude, angular: Direction::V }
            }
            Self::Torus(Torus { frame, major, minor, tube, sweep }) => {
                let Frame { centre, axis, xdir } = unit(frame)?;
                let (major_radius, minor_radius, section) = (major, minor, tube);
                Kind::Torus { centre, axis, xdir, major_radius, minor_radius, sweep, section, angular: Direction::V }
            }
        })
    }
}

/// The frame with unit directions, whatever its fields hold.
fn unit(frame: Frame) -> Result<Frame, InvalidDefinition> {
    Frame::new(frame.centre, frame.axis, frame.xdir)
}

fn of_cone(cone: &Cone) -> Result<Kind, InvalidDefinition> {
    let Cone { frame, radii, height, sweep } = *cone;
    let Frame { centre, axis, xdir } = unit(frame)?;
    // Heights from the apex are radii by the slope. A cone that narrows is seen along the other direction, from where
    // angles run backwards.
    let slope = (radii.1 - radii.0).abs() / (height.1 - height.0);
    let widens = radii.1 > radii.0;
    let (axis, sweep) = if widens { (axis, sweep) } else { (-axis, (-sweep.0, -sweep.1)) };
    let first = if widens { height.0 } else { -height.0 };
    Ok(Kind::Cone {
        apex: centre + (first - radii.0 / slope) * axis,
        axis,
        xdir,
        half_angle: slope.atan(),
        height: (radii.0 / slope, radii.1 / slope),
        sweep,
        angular: Direction::V,
    })
}

/// The operation that makes the shape, bit for bit.
impl From<Shape> for Operation {
    fn from(shape: Shape) -> Self {
        match shape {
            Shape::Line(Line { start, end }) => Self::LineByPoints { start, end },
            Shape::Circle(Circle { frame: Frame { centre, axis, xdir }, radius, sweep }) => {
                if sweep == (0.0, TAU) {
                    Self::CircleByCentre { centre, axis, radius, xdir: Some(xdir) }
                } else {
                    Self::ArcByCentre { centre, axis, xdir, radius, sweep }
                }
            }
            Shape::Ellipse(Ellipse { frame: Frame { centre, axis, xdir }, radii, sweep }) => {
                Self::EllipseByCentre { centre, axis, xdir, radii, sweep }
            }
            Shape::Plane(Plane { frame: Frame { centre, axis, xdir }, width, height }) => {
                Self::PlaneByFrame { origin: centre, normal: axis, xdir, width, height }
            }
            Shape::Cylinder(Cylinder { frame: Frame { centre, axis, xdir }, radius, height, sweep }) => {
                Self::CylinderByFrame { centre, axis, xdir, radius, height, sweep }
            }
            Shape::Cone(Cone { frame: Frame { centre, axis, xdir }, radii, height, sweep }) => {
                Self::ConeByFrame { centre, axis, xdir, radii, height, sweep }
            }
            Shape::Sphere(Sphere { frame: Frame { centre, axis, xdir }, radius, latitude, sweep }) => {
                Self::SphereByCentre { centre, axis, xdir, radius, latitude, sweep }
            }
            Shape::Torus(Torus { frame: Frame { centre, axis, xdir }, major, minor, tube, sweep }) => {
                Self::TorusByFrame { centre, axis, xdir, major_radius: major, minor_radius: minor, tube, sweep }
            }
        }
    }
}

impl Operation {
    /// The analytic shape that it makes; none where it makes something else.
    ///
    /// # Errors
    ///
    /// A parameter has no meaning.
    pub fn shape(&self) -> Option<Result<Shape, InvalidDefinition>> {
        Some(Ok(match *self {
            Self::LineByPoints { start, end } => Line { start, end }.into(),
            Self::CircleByCentre { centre, axis, radius, xdir } => {
                let frame = match xdir {
                    Some(xdir) => Frame { centre, axis, xdir },
                    None => match Frame::about(centre, axis) {
                        Ok(frame) => frame,
                        Err(error) => return Some(Err(error)),
                    },
                };
                Circle { frame, radius, sweep: (0.0, TAU) }.into()
            }
            Self::ArcByCentre { centre, axis, xdir, radius, sweep } => {
                Circle { frame: Frame { centre, axis, xdir }, radius, sweep }.into()
            }
            Self::ArcByPoints { start, through, end } => {
                return Some(Circle::through(start, through, end).map(Shape::from));
            }
            Self::EllipseByCentre { centre, axis, xdir, radii, sweep } => {
                Ellipse { frame: Frame { centre, axis, xdir }, radii, sweep }.into()
            }
            Self::PlaneByFrame { origin, normal, xdir, width, height } => {
                Plane { frame: Frame { centre: origin, axis: normal, xdir }, width, height }.into()
            }
            Self::CylinderByFrame { centre, axis, xdir, radius, height, sweep } => {
                Cylinder { frame: Frame { centre, axis, xdir }, radius, height, sweep }.into()
            }
            Self::ConeByFrame { centre, axis, xdir, radii, height, sweep } => {
                Cone { frame: Frame { centre, axis, xdir }, radii, height, sweep }.into()
            }
            Self::SphereByCentre { centre, axis, xdir, radius, latitude, sweep } => {
                Sphere { frame: Frame { centre, axis, xdir }, radius, latitude, sweep }.into()
            }
            Self::TorusByFrame { centre, axis, xdir, major_radius, minor_radius, tube, sweep } => {
                let frame = Frame { centre, axis, xdir };
                Torus { frame, major: major_radius, minor: minor_radius, tube, sweep }.into()
            }
            _ => return None,
        }))
    }
}
