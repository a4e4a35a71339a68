//! What an entity is made of.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::bounds::Aabb;
use crate::clamp::Entry;
use crate::curve::{CurveData, NurbsCurve};
use crate::fingerprint::Fingerprint;
use crate::invalid::{Direction, InvalidDefinition};
use crate::surface::{NurbsSurface, SurfaceData};

/// The defining data of an entity.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Definition {
    /// A curve.
    NurbsCurve(NurbsCurve),
    /// A surface.
    NurbsSurface(NurbsSurface),
}

/// Defining data as a file holds them, not validated.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Definition")]
pub enum DefinitionData {
    /// A curve.
    NurbsCurve(CurveData),
    /// A surface.
    NurbsSurface(SurfaceData),
}

impl DefinitionData {
    /// Validates the data, and says what had to be done on entry.
    ///
    /// # Errors
    ///
    /// The first rule that the data break.
    pub fn enter(self) -> Result<(Definition, Entry), InvalidDefinition> {
        Ok(match self {
            Self::NurbsCurve(data) => {
                let (curve, entry) = NurbsCurve::enter(data)?;
                (Definition::NurbsCurve(curve), entry)
            }
            Self::NurbsSurface(data) => {
                let (surface, entry) = NurbsSurface::enter(data)?;
                (Definition::NurbsSurface(surface), entry)
            }
        })
    }
}

impl Definition {
    /// The kind's name, as files write it.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        match self {
            Self::NurbsCurve(_) => "NurbsCurve",
            Self::NurbsSurface(_) => "NurbsSurface",
        }
    }

    /// The control points; a surface's in row order.
    #[must_use]
    pub fn control_points(&self) -> &[DVec3] {
        match self {
            Self::NurbsCurve(curve) => curve.control_points(),
            Self::NurbsSurface(surface) => surface.control_points(),
        }
    }

    /// The weights in the layout of the control points; none where all are 1.
    #[must_use]
    pub fn weights(&self) -> Option<&[f64]> {
        match self {
            Self::NurbsCurve(curve) => curve.weights(),
            Self::NurbsSurface(surface) => surface.weights(),
        }
    }

    /// The box of the control points, which holds the entity.
    #[must_use]
    pub fn control_box(&self) -> Aabb {
        Aabb::around(self.control_points().iter().copied())
    }

    /// The size of the entity: the diagonal of its control points' box.
    #[must_use]
    pub fn size(&self) -> f64 {
        self.control_box().diagonal()
    }

    /// The largest |coordinate| of the control points.
    #[must_use]
    pub fn reach(&self) -> f64 {
        self.control_box().reach()
    }

    /// A hash of the definition: two definitions that differ in a bit differ in it (but for chance).
    #[must_use]
    pub fn fingerprint(&self) -> Fingerprint {
        let mut hash = Fingerprint::of(self.kind());
        match self {
            Self::NurbsCurve(curve) => {
                hash.count(curve.degree()).count(curve.control_points().len()).numbers(curve.knots().as_slice());
            }
            Self::NurbsSurface(surface) => {
                let (p, q) = surface.degree();
                hash.count(p).count(q).count(surface.rows()).count(surface.columns());
                hash.numbers(surface.knots(Direction::U).as_slice()).numbers(surface.knots(Direction::V).as_slice());
            }
        }
        for point in self.control_points() {
            hash.numbers(&point.to_array());
        }
        hash.numbers(self.weights().unwrap_or_default());
        hash
    }
}

impl From<NurbsCurve> for Definition {
    fn from(curve: NurbsCurve) -> Self {
        Self::NurbsCurve(curve)
    }
}

impl From<NurbsSurface> for Definition {
    fn from(surface: NurbsSurface) -> Self {
        Self::NurbsSurface(surface)
    }
}
