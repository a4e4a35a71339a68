//! Names of enum values in output and on the command line.

use perpend::{Method, Multiplicity, Place};

/// All methods that can be asked for.
pub(crate) const METHODS: [Method; 5] =
    [Method::Analytic, Method::Hierarchy, Method::Wave, Method::Exclusion, Method::ControlPolygon];

pub(crate) fn method(method: Method) -> &'static str {
    match method {
        Method::Analytic => "analytic",
        Method::Hierarchy => "hierarchy",
        Method::Wave => "wave",
        Method::Exclusion => "exclusion",
        Method::ControlPolygon => "control-polygon",
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
    }
}

pub(crate) fn multiplicity(multiplicity: Multiplicity) -> &'static str {
    match multiplicity {
        Multiplicity::Unique => "unique",
        Multiplicity::Tied => "tied",
        Multiplicity::Continuum => "continuum",
    }
}
