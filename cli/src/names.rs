//! Names of enum values in output and on the command line.

use perpend::{Certainty, Effect, EntityId, Extremum, Method, Model, Multiplicity, Place, Relation};

/// All methods that can be asked for.
pub(crate) const METHODS: [Method; 6] =
    [Method::Analytic, Method::Hierarchy, Method::Wave, Method::Exclusion, Method::ControlPolygon, Method::Bernstein];

pub(crate) fn method(method: Method) -> &'static str {
    match method {
        Method::Analytic => "analytic",
        Method::Hierarchy => "hierarchy",
        Method::Wave => "wave",
        Method::Exclusion => "exclusion",
        Method::ControlPolygon => "control-polygon",
        Method::Bernstein => "bernstein",
        Method::Trimmed => "trimmed",
    }
}

pub(crate) fn place(place: Place) -> &'static str {
    match place {
        Place::Interior => "interior",
        Place::End => "end",
        Place::Edge => "edge",
        Place::Corner => "corner",
        Place::Seam => "seam",
        Place::Pole => "pole",
        Place::Cusp => "cusp",
        Place::Crease => "crease",
        Place::TrimEdge => "trim-edge",
        Place::Vertex => "vertex",
    }
}

pub(crate) fn multiplicity(multiplicity: Multiplicity) -> &'static str {
    match multiplicity {
        Multiplicity::Unique => "unique",
        Multiplicity::Tied => "tied",
        Multiplicity::Continuum => "continuum",
    }
}

pub(crate) fn effect(effect: &Effect) -> &'static str {
    match effect {
        Effect::Rebuilt => "rebuilt",
        Effect::Overridden => "overridden",
        Effect::Kept { .. } => "kept",
        _ => "refers",
    }
}

/// What another entity is to one; of an application's own relationship, its name there.
pub(crate) fn relation(relation: &Relation) -> String {
    match relation {
        Relation::Definition => "definition",
        Relation::Boundary => "boundary",
        Relation::Profile => "profile",
        Relation::Axis => "axis",
        Relation::Rail => "rail",
        Relation::Section => "section",
        Relation::Offset => "offset",
        Relation::FittedTo => "fitted-to",
        Relation::IsoCurveOf => "iso-curve-of",
        Relation::PartOf => "part-of",
        Relation::CopyOf => "copy-of",
        Relation::Other(name) => name,
    }
    .to_owned()
}

/// An entity's id and name.
pub(crate) fn entity(model: &Model, id: EntityId) -> String {
    model.entity(id).map_or_else(|| id.to_string(), |entity| format!("{id} {:?}", entity.name()))
}

pub(crate) fn extremum(kind: Extremum) -> &'static str {
    match kind {
        Extremum::Minimum => "minimum",
        Extremum::Maximum => "maximum",
        Extremum::Saddle => "saddle",
    }
}

pub(crate) fn certainty(certainty: Certainty) -> &'static str {
    match certainty {
        Certainty::One => "one",
        Certainty::Undecided => "undecided",
    }
}
