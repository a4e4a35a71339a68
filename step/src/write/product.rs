//! What surrounds the shape: header, product, units.

use std::io::{self, Write};

use perpend::Units;

use super::text::{Id, Text, real, string};

/// The header section.
pub(super) fn header<W: Write>(text: &mut Text<W>, name: &str) -> io::Result<()> {
    text.line("ISO-10303-21;")?;
    text.line("HEADER;")?;
    text.line("FILE_DESCRIPTION((''),'2;1');")?;
    // no time and no author: one model always gives the same bytes
    let system = string(concat!("perpend ", env!("CARGO_PKG_VERSION")));
    text.line(&format!("FILE_NAME({},'1970-01-01T00:00:00',(''),(''),{system},{system},'');", string(name)))?;
    text.line("FILE_SCHEMA(('AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }'));")?;
    text.line("ENDSEC;")?;
    text.line("DATA;")
}

/// The product and the definition of its shape.
pub(super) fn product<W: Write>(text: &mut Text<W>, name: &str) -> io::Result<Id> {
    let name = string(name);
    let application =
        text.add(format_args!("APPLICATION_CONTEXT('core data for automotive mechanical design processes')"))?;
    text.add(format_args!(
        "APPLICATION_PROTOCOL_DEFINITION('international standard','automotive_design',2000,{application})"
    ))?;
    let context = text.add(format_args!("PRODUCT_CONTEXT('',{application},'mechanical')"))?;
    let product = text.add(format_args!("PRODUCT({name},{name},'',({context}))"))?;
    text.add(format_args!("PRODUCT_RELATED_PRODUCT_CATEGORY('part',$,({product}))"))?;
    let formation = text.add(format_args!("PRODUCT_DEFINITION_FORMATION('','',{product})"))?;
    let context = text.add(format_args!("PRODUCT_DEFINITION_CONTEXT('part definition',{application},'design')"))?;
    let definition = text.add(format_args!("PRODUCT_DEFINITION('design','',{formation},{context})"))?;
    text.add(format_args!("PRODUCT_DEFINITION_SHAPE('','',{definition})"))
}

/// The context of all shapes: units, and the length below which points are one.
pub(super) fn context<W: Write>(text: &mut Text<W>, units: Units, uncertainty: f64) -> io::Result<Id> {
    let si = |prefix: &str| format!("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT({prefix},.METRE.))");
    let length = match units {
        Units::Nanometre => text.add(format_args!("{}", si(".NANO.")))?,
        Units::Micrometre => text.add(format_args!("{}", si(".MICRO.")))?,
        Units::Millimetre => text.add(format_args!("{}", si(".MILLI.")))?,
        Units::Centimetre => text.add(format_args!("{}", si(".CENTI.")))?,
        Units::Metre => text.add(format_args!("{}", si("$")))?,
        Units::Kilometre => text.add(format_args!("{}", si(".KILO.")))?,
        Units::Inch => converted(text, "INCH", 25.4)?,
        Units::Foot => converted(text, "FOOT", 304.8)?,
    };
    let angle = text.add(format_args!("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))"))?;
    let solid = text.add(format_args!("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())"))?;
    let uncertainty = text.add(format_args!(
        "UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE({}),{length},'distance_accuracy_value','')",
        real(uncertainty)
    ))?;
    text.add(format_args!(
        "(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT(({uncertainty}))\
         GLOBAL_UNIT_ASSIGNED_CONTEXT(({length},{angle},{solid}))REPRESENTATION_CONTEXT('','3D'))"
    ))
}

/// A unit of so many millimetres.
fn converted<W: Write>(text: &mut Text<W>, name: &str, millimetres: f64) -> io::Result<Id> {
    let millimetre = text.add(format_args!("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))"))?;
    let measure =
        text.add(format_args!("LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE({}),{millimetre})", real(millimetres)))?;
    let exponents = text.add(format_args!("DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.)"))?;
    text.add(format_args!("(CONVERSION_BASED_UNIT('{name}',{measure})LENGTH_UNIT()NAMED_UNIT({exponents}))"))
}
