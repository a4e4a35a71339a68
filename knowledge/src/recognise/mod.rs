//! Recognition: what shape a definition is, proved by its control points.
//!
//! A candidate's parameters come from samples and least squares; whether it is accepted is decided by a bound of the distance
//! between the two sets of points (both ways: every point of the definition is that near to the shape within its ranges, and
//! every point of the shape to the definition), which is formed from control points and widened by its own rounding. A surface
//! of a quadric is taken apart into the arc that turns and the profile that is turned, so that all proofs are proofs of
//! curves.

mod along;
mod axis;
mod beside;
mod cone;
mod conic;
mod curves;
mod cylinder;
mod ellipse;
mod extrusion;
mod least_squares;
mod line;
mod measure;
mod plane;
mod proof;
mod refuted;
mod revolution;
mod ruled;
mod sphere;
mod torus;
mod turned;
mod weights;

use perpend_kernel::{Aabb, Definition, Direction, NurbsSurface};

pub use refuted::Refuted;

use crate::classification::Kind;
use crate::item::{Basis, Item};

/// The deviation at which a class is accepted unless the caller says otherwise: 1e-10 of the size, and 64 ulps of the largest
/// coordinate, which the refinements of a definition far from the origin (degrees, knots, parametrisation) add up to.
#[must_use]
pub fn default_tolerance(definition: &Definition) -> f64 {
    tolerance_in(definition.control_box())
}

/// The same, from the box of the control points.
fn tolerance_in(bounds: Aabb) -> f64 {
    1e-10 * bounds.diagonal() + 64.0 * f64::EPSILON * bounds.reach()
}

/// The deviation within which a class that a record states is believed: what the record names, but not less than
/// [`default_tolerance`], and not more than a hundredth of the size: what is farther off is another shape.
#[must_use]
pub fn believed_tolerance(stated: f64, definition: &Definition) -> f64 {
    stated.min(1e-2 * definition.size()).max(default_tolerance(definition))
}

/// The class of a definition: the most special one that it is proved to be within `tolerance`, else [`Kind::FreeForm`].
///
/// The basis is [`Basis::Proved`]; its gap bounds the distance between the definition and the shape within its ranges, both
/// ways, rounding included. Of a general revolution, extrusion or ruled surface, it bounds the distance to the surface that
/// the definition's own profile or boundary curves make.
///
/// Angles of a recognised shape start at 0 and ascend, but for a cone, whose axis runs from its apex: there they may descend.
#[must_use]
pub fn recognise(definition: &Definition, tolerance: f64) -> Item<Kind> {
    let (value, gap) = class_and_gap(definition, tolerance);
    Item { value, basis: Basis::Proved { gap }, tolerance, of: definition.fingerprint() }
}

/// The class and its gap alone, as for [`recognise`]: what needs no record is spared the fingerprint.
#[must_use]
pub fn class_and_gap(definition: &Definition, tolerance: f64) -> (Kind, f64) {
    let found = match definition {
        Definition::NurbsCurve(curve) => {
            let accept = |kind: Option<Kind>| accept(kind?, definition, tolerance);
            let conics = || {
                let fitted = !beside::conics(curve, tolerance);
                fitted.then(|| accept(conic::circle(curve)).or_else(|| accept(ellipse::candidate(curve))))?
            };
            accept(line::candidate(curve, tolerance)).or_else(conics)
        }
        Definition::NurbsSurface(surface) => of_surface(surface, definition, tolerance),
    };
    found.unwrap_or((Kind::FreeForm, 0.0))
}

fn of_surface(surface: &NurbsSurface, definition: &Definition, tolerance: f64) -> Option<(Kind, f64)> {
    let directions = [Direction::U, Direction::V];
    let accept = |kind: Option<Kind>| accept(kind?, definition, tolerance);
    if !beside::planes(surface, tolerance)
        && let Some(found) = plane::candidates(surface).into_iter().find_map(|kind| accept(Some(kind)))
    {
        return Some(found);
    }
    let turned = directions.map(|angular| revolution::pose(surface, angular, tolerance));
    for pose in turned.iter().flatten() {
        let candidates = [cylinder::candidate, cone::candidate, sphere::candidate];
        if let Some(found) = candidates.iter().find_map(|candidate| accept(candidate(pose))) {
            return Some(found);
        }
        let slice = accept(sphere::about_meridian(pose, surface, tolerance));
        if let Some(found) = slice.or_else(|| accept(torus::candidate(pose))) {
            return Some(found);
        }
    }
    let straight = || directions.into_iter().filter(|along| !beside::rulings(surface, *along, tolerance));
    straight()
        .find_map(|along| accept(extrusion::candidate(surface, along)))
        .or_else(|| turned.iter().flatten().find_map(|pose| accept(revolution::candidate(pose))))
        .or_else(|| straight().find_map(|ruling| accept(Some(Kind::Ruled { ruling }))))
}

fn accept(kind: Kind, definition: &Definition, tolerance: f64) -> Option<(Kind, f64)> {
    let gap = proof::gap(&kind, definition).ok().flatten()?;
    (gap <= tolerance).then_some((kind, gap))
}

/// Proves that a definition is of a stated class within `tolerance`, and gives the proven gap, as for [`recognise`].
///
/// Everything is free form.
///
/// # Errors
///
/// The class does not fit the definition (a circle over a surface), its parameters break the conventions of [`Kind`], or the
/// proven deviation is above the tolerance.
pub fn prove(kind: &Kind, definition: &Definition, tolerance: f64) -> Result<f64, Refuted> {
    match proof::gap(kind, definition)? {
        Some(gap) if gap <= tolerance => Ok(gap),
        bound => Err(Refuted::Deviates { measured: measure::deviation(kind, definition), bound, tolerance }),
    }
}
