//! Definitions as files hold them: the kind's name, then its fields in the same brackets.

use glam::DVec3;
use perpend_kernel::{
    CurveData, Definition, DefinitionData, Direction, EntityId, SurfaceData, TrimLoopData, TrimmingData,
};
use serde::ser::{SerializeStructVariant, Serializer};
use serde::{Deserialize, Serialize};

use crate::body::Shell;
use crate::entity::Part;
use crate::referent::Referent;

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
    TrimmedSurface {
        surface: WrittenCarrier,
        #[serde(default)]
        reversed: bool,
        tolerance: f64,
        loops: Vec<TrimLoopData>,
    },
    Body {
        shells: Vec<Shell>,
    },
}

/// The carrier of a trimmed face as files hold it.
#[derive(Debug, Deserialize)]
#[serde(rename = "surface")]
pub(crate) enum WrittenCarrier {
    Own(WrittenSurface),
    Ref(EntityId),
}

/// A surface as files hold it.
#[derive(Debug, Deserialize)]
#[serde(rename = "surface", deny_unknown_fields)]
pub(crate) enum WrittenSurface {
    NurbsSurface {
        degree: (usize, usize),
        knots: (Vec<f64>, Vec<f64>),
        control_points: Vec<Vec<DVec3>>,
        #[serde(default)]
        weights: Option<Vec<Vec<f64>>>,
    },
}

/// What a file says that something is, not validated.
pub(crate) enum Form {
    /// An entity without a trim.
    Plain(DefinitionData),
    /// A trimmed face.
    Trimmed(Source, TrimmingData),
    /// A body.
    Body(Vec<Shell>),
}

/// Where the surface of a trimmed face stands.
pub(crate) enum Source {
    /// With it.
    Own(SurfaceData),
    /// In another entity.
    Ref(EntityId),
}

impl Written {
    /// What it says it is.
    pub(crate) fn referent(&self) -> Referent {
        match self {
            Self::NurbsCurve { .. } => Referent::Curve,
            Self::NurbsSurface { .. } => Referent::Surface,
            Self::TrimmedSurface { .. } => Referent::Trimmed,
            Self::Body { .. } => Referent::Body,
        }
    }

    /// The entity that it names as its carrier.
    pub(crate) fn carrier(&self) -> Option<EntityId> {
        match self {
            Self::TrimmedSurface { surface: WrittenCarrier::Ref(id), .. } => Some(*id),
            _ => None,
        }
    }
}

impl From<Written> for Form {
    fn from(written: Written) -> Self {
        match written {
            Written::NurbsCurve { degree, knots, control_points, weights } => {
                Self::Plain(DefinitionData::NurbsCurve(CurveData { degree, knots, control_points, weights }))
            }
            Written::NurbsSurface { degree, knots, control_points, weights } => {
                Self::Plain(DefinitionData::NurbsSurface(SurfaceData { degree, knots, control_points, weights }))
            }
            Written::TrimmedSurface { surface, reversed, tolerance, loops } => {
                let source = match surface {
                    WrittenCarrier::Own(WrittenSurface::NurbsSurface { degree, knots, control_points, weights }) => {
                        Source::Own(SurfaceData { degree, knots, control_points, weights })
                    }
                    WrittenCarrier::Ref(id) => Source::Ref(id),
                };
                Self::Trimmed(source, TrimmingData { reversed, tolerance, loops })
            }
            Written::Body { shells } => Self::Body(shells),
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

/// Writes a trimmed face.
pub(crate) struct WritingTrimmed<'a>(pub(crate) &'a Definition, pub(crate) &'a Part);

impl Serialize for WritingTrimmed<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let TrimmingData { reversed, tolerance, loops } = self.1.trimming.data();
        let mut s = serializer.serialize_struct_variant("Definition", 2, "TrimmedSurface", 4)?;
        match self.1.carrier {
            Some(id) => s.serialize_field("surface", &WritingCarrier::Ref(id))?,
            None => s.serialize_field("surface", &WritingCarrier::Own(Writing(self.0)))?,
        }
        s.serialize_field("reversed", &reversed)?;
        s.serialize_field("tolerance", &tolerance)?;
        s.serialize_field("loops", &loops)?;
        s.end()
    }
}

/// Writes a carrier.
#[derive(Serialize)]
enum WritingCarrier<'a> {
    Own(Writing<'a>),
    Ref(EntityId),
}

/// A flat net, written as rows.
struct Rows<'a, T>(&'a [T], usize);

impl<T: Serialize> Serialize for Rows<'_, T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.0.chunks(self.1))
    }
}
