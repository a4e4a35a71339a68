//! Operations, run: definitions from parameters and inputs.

mod error;
mod offset;

use glam::{DAffine3, DMat3, DVec3};
use perpend_kernel::{
    Definition, Direction, NurbsCurve, NurbsSurface, curve_through, extrusion, loft, revolution, ruled, surface_through,
};

pub use error::BuildError;

use crate::classification::Kind;
use crate::finite;
use crate::operation::{Operation, Takes};

/// What an operation made.
#[derive(Debug, Clone, PartialEq)]
pub struct Built {
    /// The definition.
    pub definition: Definition,
    /// The class, where the operation determines it.
    pub kind: Option<Kind>,
}

impl Operation {
    /// Runs the operation on its inputs. The same operation on the same inputs gives the same bits.
    ///
    /// # Errors
    ///
    /// A parameter that is not finite or has no meaning; too few or too many inputs, or an input of the wrong kind; an operation
    /// that perpend does not run; what the construction cannot do.
    pub fn build(&self, inputs: &[&Definition]) -> Result<Built, BuildError> {
        finite::check(self).map_err(|source| BuildError::NonFinite { operation: self.name(), source })?;
        let takes = self.takes();
        let fits = match takes {
            Takes::Exactly(count) => inputs.len() == count,
            Takes::AtLeast(count) => inputs.len() >= count,
            Takes::Any => true,
        };
        if !fits {
            return Err(BuildError::Inputs { operation: self.name(), takes, found: inputs.len() });
        }
        if let Some(shape) = self.shape() {
            let shape = shape.map_err(|source| self.invalid(source))?;
            let definition = shape.definition().map_err(|source| self.invalid(source))?;
            let kind = shape.kind().map_err(|source| self.invalid(source))?;
            return Ok(Built { definition, kind: Some(kind) });
        }
        self.constructed(inputs)
    }

    fn constructed(&self, inputs: &[&Definition]) -> Result<Built, BuildError> {
        let made = |definition: Definition, kind| Ok(Built { definition, kind });
        let refused = |source| self.refused(source);
        match self {
            Self::Interpolation { degree, points, columns, spacing } => {
                self.interpolated(*degree, points, *columns, *spacing)
            }
            Self::Extrude { vector } => {
                let surface = extrusion(self.curve(inputs, 0)?, *vector).map_err(|source| self.invalid(source))?;
                made(surface.into(), Some(Kind::Extrusion { vector: *vector, along: Direction::V }))
            }
            Self::Revolve { origin, axis, angle } => {
                let surface = revolution(self.curve(inputs, 0)?, *origin, *axis, *angle)
                    .map_err(|source| self.invalid(source))?;
                let (sweep, angular) = (*angle, Direction::V);
                let axis = (*axis / axis.abs().max_element()).normalize();
                made(surface.into(), Some(Kind::Revolution { origin: *origin, axis, sweep, angular }))
            }
            Self::Rule => {
                let surface = ruled(self.curve(inputs, 0)?, self.curve(inputs, 1)?).map_err(refused)?;
                made(surface.into(), Some(Kind::Ruled { ruling: Direction::V }))
            }
            Self::Loft { degree } => {
                let sections: Vec<&NurbsCurve> =
                    (0..inputs.len()).map(|k| self.curve(inputs, k)).collect::<Result<_, _>>()?;
                let surface = loft(&sections, *degree as usize).map_err(|source| self.missed(source))?;
                made(surface.into(), None)
            }
            Self::Offset { distance, normal } => {
                let definition = offset::of(inputs[0], *distance, *normal)
                    .map_err(|why| BuildError::NotRebuilt { operation: self.name(), why })?;
                made(definition.map_err(|source| self.invalid(source))?, None)
            }
            Self::IsoCurve { direction, at } => {
                made(self.surface(inputs, 0)?.iso_curve(*direction, *at).map_err(refused)?.into(), None)
            }
            Self::Split { direction, range } => made(self.part(inputs[0], *direction, *range)?, None),
            Self::Transform { columns: (x, y, z), translation } => {
                let map = DAffine3 { matrix3: DMat3::from_cols(*x, *y, *z), translation: *translation };
                let image: Result<Definition, _> = match inputs[0] {
                    Definition::NurbsCurve(curve) => curve.transformed(&map).map(Into::into),
                    Definition::NurbsSurface(surface) => surface.transformed(&map).map(Into::into),
                };
                made(image.map_err(|source| self.invalid(source))?, None)
            }
            Self::ByData => {
                Err(self.not_rebuilt("the defining data were entered as they are, and are not made from anything"))
            }
            Self::Approximation { .. } => Err(self.not_rebuilt("the points that it approximates are not in the model")),
            // all others are shapes
            _ => Err(self.not_rebuilt("it is an operation of an application, which alone can run it")),
        }
    }

    fn interpolated(
        &self,
        degree: (u32, u32),
        points: &[DVec3],
        columns: u64,
        spacing: perpend_kernel::Spacing,
    ) -> Result<Built, BuildError> {
        let degree = (degree.0 as usize, degree.1 as usize);
        let definition: Definition = if degree.1 == 0 && columns == 0 {
            curve_through(points, degree.0, spacing).map_err(|source| self.missed(source))?.into()
        } else {
            let row = usize::try_from(columns).ok().filter(|row| *row > 0 && points.len().is_multiple_of(*row));
            let row = row.ok_or(BuildError::Columns { columns, points: points.len() })?;
            let rows: Vec<Vec<DVec3>> = points.chunks(row).map(<[DVec3]>::to_vec).collect();
            surface_through(&rows, degree, spacing).map_err(|source| self.missed(source))?.into()
        };
        Ok(Built { definition, kind: None })
    }

    /// The part of an entity over a range that may reach the ends of its domain.
    fn part(&self, of: &Definition, direction: Direction, range: (f64, f64)) -> Result<Definition, BuildError> {
        let domain = match of {
            Definition::NurbsCurve(curve) => curve.domain(),
            Definition::NurbsSurface(surface) => surface.domain(direction),
        };
        if !(domain.0 <= range.0 && range.0 < range.1 && range.1 <= domain.1) {
            return Err(BuildError::Range { range, domain });
        }
        let refused = |source| self.refused(source);
        let mut part = of.clone();
        if range.1 < domain.1 {
            part = match part {
                Definition::NurbsCurve(curve) => curve.split(range.1).map_err(refused)?.0.into(),
                Definition::NurbsSurface(surface) => surface.split(direction, range.1).map_err(refused)?.0.into(),
            };
        }
        if range.0 > domain.0 {
            part = match part {
                Definition::NurbsCurve(curve) => curve.split(range.0).map_err(refused)?.1.into(),
                Definition::NurbsSurface(surface) => surface.split(direction, range.0).map_err(refused)?.1.into(),
            };
        }
        Ok(part)
    }

    fn curve<'a>(&self, inputs: &[&'a Definition], index: usize) -> Result<&'a NurbsCurve, BuildError> {
        match inputs[index] {
            Definition::NurbsCurve(curve) => Ok(curve),
            Definition::NurbsSurface(_) => {
                Err(BuildError::WrongInput { operation: self.name(), index, expected: "a curve", found: "a surface" })
            }
        }
    }

    fn surface<'a>(&self, inputs: &[&'a Definition], index: usize) -> Result<&'a NurbsSurface, BuildError> {
        match inputs[index] {
            Definition::NurbsSurface(surface) => Ok(surface),
            Definition::NurbsCurve(_) => {
                Err(BuildError::WrongInput { operation: self.name(), index, expected: "a surface", found: "a curve" })
            }
        }
    }

    fn invalid(&self, source: perpend_kernel::InvalidDefinition) -> BuildError {
        BuildError::Definition { operation: self.name(), source }
    }

    fn refused(&self, source: perpend_kernel::InvalidEdit) -> BuildError {
        BuildError::Edit { operation: self.name(), source }
    }

    fn missed(&self, source: perpend_kernel::InvalidInterpolation) -> BuildError {
        BuildError::Interpolation { operation: self.name(), source }
    }

    fn not_rebuilt(&self, why: &'static str) -> BuildError {
        BuildError::NotRebuilt { operation: self.name(), why }
    }
}
