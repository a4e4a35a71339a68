//! Definitions as files hold them: the kind's name, then its fields in the same brackets.

use glam::DVec3;
use perpend_kernel::{CurveData, Definition, DefinitionData, Direction, SurfaceData};
use serde::ser::{SerializeStructVariant, Serializer};
use serde::{Deserialize, Serialize};

/// A definition as files hold it, not validated.
#[derive(Debug, Deserialize)]
#[serde(rename = "Definition", deny_unknown_fields)]
pub(crate) enum Written {
    NurbsCurve {
        degree: usize,
        knots: Vec<f64>,
        control_points: Vec<DVec3>,
        #[serde(default)]
        weights: Option<Vec<f64>>,
    },
    NurbsSurface {
        degree: (usize, usize),
        knots: (Vec<f64>, Vec<f64>),
        control_points: Vec<Vec<DVec3>>,
        #[serde(default)]
        weights: Option<Vec<Vec<f64>>>,
    },
}

impl From<Written> for DefinitionData {
    fn from(written: Written) -> Self {
        match written {
            Written::NurbsCurve { degree, knots, control_points, weights } => {
                Self::NurbsCurve(CurveData { degree, knots, control_points, weights })
            }
            Written::NurbsSurface { degree, knots, control_points, weights } => {
                Self::NurbsSurface(SurfaceData { degree, knots, control_points, weights })
            }
        }
    }
}

/// Writes a definition.
pub(crate) struct Writing<'a>(pub(crate) &'a Definition);

impl Serialize for Writing<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.0 {
            Definition::NurbsCurve(curve) => {
                let mut s = serializer.serialize_struct_variant("Definition", 0, "NurbsCurve", 4)?;
                s.serialize_field("degree", &curve.degree())?;
                s.serialize_field("knots", curve.knots().as_slice())?;
                s.serialize_field("control_points", curve.control_points())?;
                s.serialize_field("weights", &curve.weights())?;
                s.end()
            }
            Definition::NurbsSurface(surface) => {
                let columns = surface.columns();
                let knots = [Direction::U, Direction::V].map(|direction| surface.knots(direction).as_slice());
                let mut s = serializer.serialize_struct_variant("Definition", 1, "NurbsSurface", 4)?;
                s.serialize_field("degree", &surface.degree())?;
                s.serialize_field("knots", &(knots[0], knots[1]))?;
                s.serialize_field("control_points", &Rows(surface.control_points(), columns))?;
                s.serialize_field("weights", &surface.weights().map(|weights| Rows(weights, columns)))?;
                s.end()
            }
        }
    }
}

/// A flat net, written as rows.
struct Rows<'a, T>(&'a [T], usize);

impl<T: Serialize> Serialize for Rows<'_, T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.0.chunks(self.1))
    }
}
