//! Analytic shapes enter a model as their exact NURBS form, with their class and the operation that makes them as knowledge.

use perpend_kernel::{Circle, Cone, Cylinder, Ellipse, InvalidDefinition, Line, Plane, Sphere, Torus};
use perpend_knowledge::Shape;

use crate::enter::{Entered, IntoDefinition};

impl IntoDefinition for Shape {
    fn enter(self) -> Result<Entered, InvalidDefinition> {
        Ok(Entered { kind: Some(self.kind()?), operation: Some(self.into()), ..self.definition()?.into() })
    }
}

macro_rules! shapes {
    ($($shape:ident),*) => {
        $(
            impl IntoDefinition for $shape {
                fn enter(self) -> Result<Entered, InvalidDefinition> {
                    Shape::from(self).enter()
                }
            }
        )*
    };
}

shapes!(Line, Circle, Ellipse, Plane, Cylinder, Cone, Sphere, Torus);
