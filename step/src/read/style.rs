//! Colours of faces, shells and bodies.

use std::collections::HashMap;

use step_io::parser::Attribute;

use super::entities::{Entities, Values};

/// Colours by the numbers of what they are given to: red, green and blue from 0 to 1.
pub(super) struct Colours {
    own: HashMap<u64, [f64; 3]>,
}

/// From a styled item to a colour real files have eight steps at most.
const MAX_STEPS: usize = 10;

impl Colours {
    /// The colours that the file gives to surfaces; those of curves, points and texts are left out.
    pub(super) fn of(entities: &Entities) -> Self {
        let mut own = HashMap::new();
        // what overrides a style is read last, so that it stays
        for kind in ["STYLED_ITEM", "OVER_RIDING_STYLED_ITEM"] {
            for (id, _) in entities.iter() {
                if let Some(values) = entities.simple_of(id, &[kind])
                    && let (Ok(styles), Ok(item)) = (values.references(1), values.reference(2))
                    && let Some(colour) = styles.iter().find_map(|style| colour(entities, *style, MAX_STEPS))
                {
                    own.insert(item, colour);
                }
            }
        }
        Self { own }
    }

    pub(super) fn get(&self, id: u64) -> Option<[f64; 3]> {
        self.own.get(&id).copied()
    }
}

/// The first colour that a style leads to.
fn colour(entities: &Entities, id: u64, steps: usize) -> Option<[f64; 3]> {
    let values = entities.simple(id)?;
    let steps = steps.checked_sub(1)?;
    entities.spend(id, 1).ok()?;
    let along = |index: usize| colour(entities, values.reference(index).ok()?, steps);
    let among =
        |index: usize| values.references(index).ok()?.into_iter().find_map(|next| colour(entities, next, steps));
    match values.keyword {
        "PRESENTATION_STYLE_ASSIGNMENT" | "PRESENTATION_STYLE_BY_CONTEXT" => among(0),
        "SURFACE_STYLE_USAGE" | "SURFACE_STYLE_RENDERING" | "SURFACE_STYLE_RENDERING_WITH_PROPERTIES" => along(1),
        "SURFACE_SIDE_STYLE" | "FILL_AREA_STYLE" => among(1),
        "SURFACE_STYLE_FILL_AREA" => along(0),
        "FILL_AREA_STYLE_COLOUR" => along(1),
        "COLOUR_RGB" => rgb(&values),
        "DRAUGHTING_PRE_DEFINED_COLOUR" | "PRE_DEFINED_COLOUR" => named(&values),
        _ => None,
    }
}

fn rgb(values: &Values<'_>) -> Option<[f64; 3]> {
    let colour = [values.real(1).ok()?, values.real(2).ok()?, values.real(3).ok()?];
    colour.iter().all(|part| (0.0..=1.0).contains(part)).then_some(colour)
}

/// The colours that ISO 10303-202 names.
fn named(values: &Values<'_>) -> Option<[f64; 3]> {
    let Some(Attribute::String(name)) = values.get(0) else { return None };
    Some(match name.trim().to_ascii_lowercase().as_str() {
        "red" => [1.0, 0.0, 0.0],
        "green" => [0.0, 1.0, 0.0],
        "blue" => [0.0, 0.0, 1.0],
        "yellow" => [1.0, 1.0, 0.0],
        "magenta" => [1.0, 0.0, 1.0],
        "cyan" => [0.0, 1.0, 1.0],
        "black" => [0.0, 0.0, 0.0],
        "white" => [1.0, 1.0, 1.0],
        _ => return None,
    })
}
