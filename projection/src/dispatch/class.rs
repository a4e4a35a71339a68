//! The class: proved, or acquired again.

use perpend_kernel::Definition;
use perpend_knowledge::{Basis, Kind, Record, believed_tolerance, class_and_gap, default_tolerance, prove};

use crate::answer::Method;
use crate::plan::Reason;

/// The field of which this module speaks.
const FIELD: &str = "classification.kind";

/// The class of a definition, with the gap that this program has proved.
pub(super) struct Class {
    pub kind: Kind,
    /// How it is known.
    basis: Basis,
    /// Within what it was looked for.
    tolerance: f64,
    /// Bound of the distance between the definition and the shape, both ways.
    pub gap: f64,
    /// Whether the record did not have it.
    acquired: bool,
}

impl Class {
    /// The class that the record states, if the definition is proved to have it; else the one that is recognised.
    ///
    /// The proof is done anew whatever the record's basis: files can be edited.
    pub(super) fn of(definition: &Definition, record: Option<&Record>, reasons: &mut Vec<Reason>) -> Self {
        let tolerance = default_tolerance(definition);
        let stated = record.and_then(|record| record.classification.as_ref()).and_then(|class| class.kind.as_ref());
        if let Some(item) = stated {
            let mut doubt = |effect: String| {
                reasons.push(Reason { item: FIELD.to_owned(), basis: Some(item.basis), effect });
            };
            if item.is_stale(definition.fingerprint()) {
                doubt("not believed: it was computed from another definition; the class is acquired again".to_owned());
            } else {
                match prove(&item.value, definition, believed_tolerance(item.tolerance, definition)) {
                    Ok(gap) => {
                        let (kind, basis, tolerance) = (item.value.clone(), item.basis, item.tolerance);
                        return Self { kind, basis, tolerance, gap, acquired: false };
                    }
                    Err(refuted) => doubt(format!("not believed: {refuted}; the class is acquired again")),
                }
            }
        }
        let (kind, gap) = class_and_gap(definition, tolerance);
        Self { kind, basis: Basis::Proved { gap }, tolerance, gap, acquired: true }
    }

    /// What the class contributes to a plan of this method.
    pub(super) fn reason(&self, method: Method, has_closed_form: bool, asked: f64) -> Reason {
        let name = words(&self.kind);
        let source = if self.acquired { "acquired for this plan: " } else { "" };
        let (gap, tolerance) = (self.gap, self.tolerance);
        let effect = match (method, &self.kind) {
            (Method::Analytic, _) => format!(
                "{source}{name} has a closed form, which answers; the shape is proved within {gap:.1e} of the definition, and every \
                 lower bound is lowered by that"
            ),
            (_, Kind::FreeForm) if self.acquired => {
                format!("{source}no special shape was proved within {tolerance:.1e}; the certified hierarchy answers")
            }
            (_, Kind::FreeForm) => "free form: the certified hierarchy answers".to_owned(),
            (_, _) if has_closed_form => format!(
                "{source}{name}, proved within {gap:.1e} only, which is more than the gap of {asked:.1e} that queries ask: the certified \
                 hierarchy answers, unless a query names the closed form and a wider gap"
            ),
            _ => format!("{source}{name}, for which no closed form pays; the certified hierarchy answers"),
        };
        Reason { item: FIELD.to_owned(), basis: Some(self.basis), effect }
    }
}

/// A class in words.
fn words(kind: &Kind) -> &'static str {
    match kind {
        Kind::Line { .. } => "a line",
        Kind::Circle { .. } => "a circle",
        Kind::Ellipse { .. } => "an ellipse",
        Kind::Plane { sides: Some(_), .. } => "a plane parallelogram",
        Kind::Plane { sides: None, .. } => "a plane patch of free outline",
        Kind::Sphere { .. } => "a sphere",
        Kind::Cylinder { .. } => "a cylinder",
        Kind::Cone { .. } => "a cone",
        Kind::Torus { .. } => "a torus",
        Kind::Ruled { .. } => "a ruled surface",
        Kind::Revolution { .. } => "a surface of revolution",
        Kind::Extrusion { .. } => "an extrusion",
        Kind::FreeForm => "a free form",
    }
}
