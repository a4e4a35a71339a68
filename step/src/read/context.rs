//! The units of a representation's context: what its numbers mean.

use std::f64::consts::TAU;

use perpend::Units;

use super::entities::{Entities, MAX_DEPTH, Understood, Values};

/// How lengths and angles of a context become those of the part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Scales {
    /// The part's unit of length in one of the context's.
    pub(super) length: f64,
    /// Radians in the context's unit of angle.
    pub(super) angle: f64,
}

/// What a context states.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Stated {
    /// Metres in its unit of length.
    pub(super) metres: Option<f64>,
    /// Radians in its unit of angle.
    pub(super) radians: Option<f64>,
    /// Its uncertainty of lengths, in metres.
    pub(super) uncertainty: Option<f64>,
}

impl Stated {
    /// What the context with this number states; units that cannot be read are left out and said.
    pub(super) fn of(entities: &Entities, context: u64) -> Understood<Self> {
        let mut stated = Self::default();
        if let Some(assigned) = values_of(entities, context, "GLOBAL_UNIT_ASSIGNED_CONTEXT") {
            for unit in assigned.0.references(assigned.1)? {
                let is = |kind| entities.is(unit, &[kind]);
                if is("LENGTH_UNIT") {
                    stated.metres = Some(size(entities, unit, 0)?);
                } else if is("PLANE_ANGLE_UNIT") {
                    stated.radians = Some(size(entities, unit, 0)?);
                }
            }
        }
        if let Some(assigned) = values_of(entities, context, "GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT") {
            for measure in assigned.0.references(assigned.1)? {
                // of several, the last one that speaks of lengths
                if let Some(length) = uncertainty(entities, measure)? {
                    stated.uncertainty = Some(length);
                }
            }
        }
        Ok(stated)
    }

    /// The unit of a part whose lengths this context states: its own where perpend has it, else millimetres.
    pub(super) fn units(&self) -> Units {
        self.known().unwrap_or_default()
    }

    /// How this context's numbers become those of a part in these units. Without a unit of length they are taken for the part's own.
    pub(super) fn scales(&self, units: Units) -> Scales {
        let length = match self.metres {
            // exactly 1 where the unit is the part's, whatever digits the file gives it
            Some(metres) if self.known() != Some(units) => metres / units.in_metres(),
            _ => 1.0,
        };
        Scales { length, angle: self.radians.map_or(1.0, sharpened) }
    }

    /// The unit of length, where perpend has it.
    fn known(&self) -> Option<Units> {
        let all = [
            Units::Nanometre,
            Units::Micrometre,
            Units::Millimetre,
            Units::Centimetre,
            Units::Metre,
            Units::Kilometre,
            Units::Inch,
            Units::Foot,
        ];
        let metres = self.metres?;
        // files round conversions to some digits; the foot of surveyors differs by 2e-6
        all.into_iter().find(|units| (metres / units.in_metres() - 1.0).abs() < 1e-9)
    }
}

/// A degree, where a file gives it to some digits only.
fn sharpened(radians: f64) -> f64 {
    let degree = TAU / 360.0;
    if (radians / degree - 1.0).abs() < 1e-6 { degree } else { radians }
}

/// The values of a context of this kind, and where its list stands: contexts are written with one keyword or with several.
fn values_of<'a>(entities: &'a Entities, context: u64, kind: &str) -> Option<(Values<'a>, usize)> {
    let alone = || entities.simple_of(context, &[kind]).map(|values| (values, 2));
    entities.part(context, kind).map(|values| (values, 0)).or_else(alone)
}

/// A unit in metres or radians.
fn size(entities: &Entities, unit: u64, depth: usize) -> Understood<f64> {
    entities.spend(unit, 1)?;
    if depth > MAX_DEPTH {
        return Err(entities.refuse(unit, "units of units are nested too deeply".to_owned()));
    }
    if let Some(si) = entities.part(unit, "SI_UNIT") {
        return prefix(&si, 0);
    }
    if let Some(si) = entities.simple_of(unit, &["SI_UNIT"]) {
        return prefix(&si, 1);
    }
    let Some(converted) = entities.part(unit, "CONVERSION_BASED_UNIT") else {
        return Err(entities.unexpected(unit, "a unit: write the file in millimetres"));
    };
    let (factor, base) = measure(entities, converted.reference(1)?)?;
    Ok(factor * size(entities, base, depth + 1)?)
}

/// A measure and its unit.
fn measure(entities: &Entities, id: u64) -> Understood<(f64, u64)> {
    let values = entities
        .part(id, "MEASURE_WITH_UNIT")
        .or_else(|| entities.simple(id))
        .ok_or_else(|| entities.unexpected(id, "a measure with its unit"))?;
    Ok((values.positive(0)?, values.reference(1)?))
}

/// The factor of an SI prefix.
fn prefix(values: &Values<'_>, index: usize) -> Understood<f64> {
    use step_io::parser::Attribute;
    let name = match values.get(index) {
        Some(Attribute::Enum(name)) => name.as_str(),
        _ => "",
    };
    Ok(match name {
        "" => 1.0,
        "EXA" => 1e18,
        "PETA" => 1e15,
        "TERA" => 1e12,
        "GIGA" => 1e9,
        "MEGA" => 1e6,
        "KILO" => 1e3,
        "HECTO" => 1e2,
        "DECA" => 1e1,
        "DECI" => 1e-1,
        "CENTI" => 1e-2,
        "MILLI" => 1e-3,
        "MICRO" => 1e-6,
        "NANO" => 1e-9,
        "PICO" => 1e-12,
        "FEMTO" => 1e-15,
        "ATTO" => 1e-18,
        _ => return Err(values.refuse(format!("the prefix {name} is none of the SI"))),
    })
}

/// An uncertainty of lengths, in metres; none where it is of something else or zero.
fn uncertainty(entities: &Entities, id: u64) -> Understood<Option<f64>> {
    let values = entities
        .part(id, "MEASURE_WITH_UNIT")
        .or_else(|| entities.simple(id))
        .ok_or_else(|| entities.unexpected(id, "an uncertainty"))?;
    let (value, unit) = (values.real(0)?, values.reference(1)?);
    if !entities.is(unit, &["LENGTH_UNIT"]) || value <= 0.0 {
        return Ok(None);
    }
    Ok(Some(value * size(entities, unit, 0)?))
}
