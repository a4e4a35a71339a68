//! Colours.

use std::io::{self, Write};

use super::text::{Id, Text, list, real};

/// Styled items under way.
#[derive(Debug, Default)]
pub(super) struct Styles {
    items: Vec<Id>,
}

impl Styles {
    /// Gives a face, a shell or a solid a colour on both sides.
    pub(super) fn surface<W: Write>(&mut self, text: &mut Text<W>, item: Id, colour: [f64; 3]) -> io::Result<()> {
        let colour = rgb(text, colour)?;
        let fill = text.add(format_args!("FILL_AREA_STYLE_COLOUR('',{colour})"))?;
        let fill = text.add(format_args!("FILL_AREA_STYLE('',({fill}))"))?;
        let fill = text.add(format_args!("SURFACE_STYLE_FILL_AREA({fill})"))?;
        let side = text.add(format_args!("SURFACE_SIDE_STYLE('',({fill}))"))?;
        let usage = text.add(format_args!("SURFACE_STYLE_USAGE(.BOTH.,{side})"))?;
        self.assign(text, item, usage)
    }

    /// Gives a curve a colour.
    pub(super) fn curve<W: Write>(&mut self, text: &mut Text<W>, item: Id, colour: [f64; 3]) -> io::Result<()> {
        let colour = rgb(text, colour)?;
        let font = text.add(format_args!("DRAUGHTING_PRE_DEFINED_CURVE_FONT('continuous')"))?;
        let style = text.add(format_args!("CURVE_STYLE('',{font},POSITIVE_LENGTH_MEASURE(0.1),{colour})"))?;
        self.assign(text, item, style)
    }

    fn assign<W: Write>(&mut self, text: &mut Text<W>, item: Id, style: Id) -> io::Result<()> {
        let style = text.add(format_args!("PRESENTATION_STYLE_ASSIGNMENT(({style}))"))?;
        self.items.push(text.add(format_args!("STYLED_ITEM('',({style}),{item})"))?);
        Ok(())
    }

    /// Ends the list, where there is one.
    pub(super) fn finish<W: Write>(self, text: &mut Text<W>, context: Id) -> io::Result<()> {
        if !self.items.is_empty() {
            let items = list(self.items, |id| id.to_string());
            text.add(format_args!("MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION('',{items},{context})"))?;
        }
        Ok(())
    }
}

fn rgb<W: Write>(text: &mut Text<W>, [red, green, blue]: [f64; 3]) -> io::Result<Id> {
    text.add(format_args!("COLOUR_RGB('',{},{},{})", real(red), real(green), real(blue)))
}
