//! Analytic shapes enter a model as their exact NURBS form, with their class as knowledge.

use perpend_kernel::{
    Circle, Cone, Cylinder, Definition, Direction, Ellipse, Frame, InvalidDefinition, Line, Plane, Sphere, Torus,
};
use perpend_knowledge::Kind;

use crate::enter::{Entered, IntoDefinition};

fn entered(definition: impl Into<Definition>, kind: Kind) -> Entered {
    Entered { kind: Some(kind), ..definition.into().into() }
}

/// The frame with unit directions, whatever its fields hold.
fn unit(frame: Frame) -> Result<Frame, InvalidDefinition> {
    Frame::new(frame.centre, frame.axis, frame.xdir)
}

impl IntoDefinition for Line {
    fn enter(self) -> Result<Entered, InvalidDefinition> {
        let (direction, length) = (self.end - self.start).normalize_and_length();
        let kind = Kind::Line { origin: self.start, direction, range: (0.0, length) };
        Ok(entered(self.to_nurbs()?, kind))
    }
}

impl IntoDefinition for Circle {
    fn enter(self) -> Result<Entered, InvalidDefinition> {
        let Self { frame, radius, sweep } = self;
        let Frame { centre, axis, xdir } = unit(frame)?;
        Ok(entered(self.to_nurbs()?, Kind::Circle { centre, axis, xdir, radius, sweep }))
    }
}

impl IntoDefinition for Ellipse {
    fn enter(self) -> Result<Entered, InvalidDefinition> {
        let Self { frame, radii, sweep } = self;
        let Frame { centre, axis, xdir } = unit(frame)?;
        Ok(entered(self.to_nurbs()?, Kind::Ellipse { centre, axis, xdir, radii, sweep }))
    }
}

impl IntoDefinition for Plane {
    fn enter(self) -> Result<Entered, InvalidDefinition> {
        let Self { frame, width, height } = self;
        let Frame { centre, axis, xdir } = unit(frame)?;
        let ydir = axis.cross(xdir);
        let kind = Kind::Plane {
            origin: centre + width.0 * xdir + height.0 * ydir,
            normal: axis,
            sides: Some(((width.1 - width.0) * xdir, (height.1 - height.0) * ydir)),
        };
        Ok(entered(self.to_nurbs()?, kind))
    }
}

impl IntoDefinition for Sphere {
    fn enter(self) -> Result<Entered, InvalidDefinition> {
        let Self { frame, radius, latitude, sweep } = self;
        let Frame { centre, axis, xdir } = unit(frame)?;
        let kind = Kind::Sphere { centre, axis, xdir, radius, sweep, latitude, angular: Direction::V };
        Ok(entered(self.to_nurbs()?, kind))
    }
}

impl IntoDefinition for Cylinder {
    fn enter(self) -> Result<Entered, InvalidDefinition> {
        let Self { frame, radius, height, sweep } = self;
        let Frame { centre, axis, xdir } = unit(frame)?;
        let kind = Kind::Cylinder { centre, axis, xdir, radius, height, sweep, angular: Direction::V };
        Ok(entered(self.to_nurbs()?, kind))
    }
}

impl IntoDefinition for Cone {
    fn enter(self) -> Result<Entered, InvalidDefinition> {
        let Self { frame, radii, height, sweep } = self;
        let Frame { centre, axis, xdir } = unit(frame)?;
        // Heights from the apex are radii by the slope. A cone that narrows is seen along the other direction, from where
        // angles run backwards.
        let slope = (radii.1 - radii.0).abs() / (height.1 - height.0);
        let widens = radii.1 > radii.0;
        let (axis, sweep) = if widens { (axis, sweep) } else { (-axis, (-sweep.0, -sweep.1)) };
        let first = if widens { height.0 } else { -height.0 };
        let kind = Kind::Cone {
            apex: centre + (first - radii.0 / slope) * axis,
            axis,
            xdir,
            half_angle: slope.atan(),
            height: (radii.0 / slope, radii.1 / slope),
            sweep,
            angular: Direction::V,
        };
        Ok(entered(self.to_nurbs()?, kind))
    }
}

impl IntoDefinition for Torus {
    fn enter(self) -> Result<Entered, InvalidDefinition> {
        let Self { frame, major, minor, tube, sweep } = self;
        let Frame { centre, axis, xdir } = unit(frame)?;
        let kind = Kind::Torus {
            centre,
            axis,
            xdir,
            major_radius: major,
            minor_radius: minor,
            sweep,
            section: tube,
            angular: Direction::V,
        };
        Ok(entered(self.to_nurbs()?, kind))
    }
}
