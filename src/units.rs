//! The unit of a model's lengths.

use serde::{Deserialize, Serialize};

/// The unit of a model's lengths. perpend converts nothing: all lengths of a model, and of queries to it, are in its unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
pub enum Units {
    /// 1e-9 m.
    Nanometre,
    /// 1e-6 m.
    Micrometre,
    /// 1e-3 m.
    #[default]
    Millimetre,
    /// 1e-2 m.
    Centimetre,
    /// 1 m.
    Metre,
    /// 1e3 m.
    Kilometre,
    /// 25.4 mm.
    Inch,
    /// 304.8 mm.
    Foot,
}

impl Units {
    /// The length of the unit, in metres.
    #[must_use]
    pub fn in_metres(self) -> f64 {
        match self {
            Self::Nanometre => 1e-9,
            Self::Micrometre => 1e-6,
            Self::Millimetre => 1e-3,
            Self::Centimetre => 1e-2,
            Self::Metre => 1.0,
            Self::Kilometre => 1e3,
            Self::Inch => 0.0254,
            Self::Foot => 0.3048,
        }
    }

    /// The customary abbreviation.
    #[must_use]
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Nanometre => "nm",
            Self::Micrometre => "µm",
            Self::Millimetre => "mm",
            Self::Centimetre => "cm",
            Self::Metre => "m",
            Self::Kilometre => "km",
            Self::Inch => "in",
            Self::Foot => "ft",
        }
    }
}
