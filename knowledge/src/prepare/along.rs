//! One direction of a definition, of either kind.

use perpend_kernel::{Definition, Direction, KnotVector};

/// The directions that a definition has.
pub(super) fn directions(definition: &Definition) -> &'static [Direction] {
    match definition {
        Definition::NurbsCurve(_) => &[Direction::U],
        Definition::NurbsSurface(_) => &[Direction::U, Direction::V],
    }
}

pub(super) fn knots(definition: &Definition, direction: Direction) -> &KnotVector {
    match definition {
        Definition::NurbsCurve(curve) => curve.knots(),
        Definition::NurbsSurface(surface) => surface.knots(direction),
    }
}

/// The definition without the knots that can go within a tolerance, `first` before others; with a bound of what that moves.
pub(super) fn without_knots(
    definition: &Definition,
    direction: Direction,
    first: &[f64],
    tolerance: f64,
) -> Option<(Definition, f64)> {
    match definition {
        Definition::NurbsCurve(curve) => {
            let thinned = curve.remove_knots(first, tolerance).ok()?;
            (!thinned.knots.is_empty()).then(|| (thinned.entity.into(), thinned.deviation))
        }
        Definition::NurbsSurface(surface) => {
            let thinned = surface.remove_knots(direction, first, tolerance).ok()?;
            (!thinned.knots.is_empty()).then(|| (thinned.entity.into(), thinned.deviation))
        }
    }
}

/// The definition with its degree lower by 1, where that moves no point farther than a tolerance.
pub(super) fn lowered(definition: &Definition, direction: Direction, tolerance: f64) -> Option<Definition> {
    match definition {
        Definition::NurbsCurve(curve) => curve.reduce_degree(tolerance).ok()?.map(|reduced| reduced.entity.into()),
        Definition::NurbsSurface(surface) => {
            surface.reduce_degree(direction, tolerance).ok()?.map(|reduced| reduced.entity.into())
        }
    }
}

pub(super) fn refined(definition: &Definition, direction: Direction, knots: &[f64]) -> Option<Definition> {
    match definition {
        Definition::NurbsCurve(curve) => curve.refine(knots).ok().map(Definition::from),
        Definition::NurbsSurface(surface) => surface.refine(direction, knots).ok().map(Definition::from),
    }
}

/// A proven bound of the distance between points of equal parameters of two definitions, rounding included; none where one is a
/// curve and the other a surface, or where their domains differ.
#[must_use]
pub fn displacement(a: &Definition, b: &Definition) -> Option<f64> {
    match (a, b) {
        (Definition::NurbsCurve(a), Definition::NurbsCurve(b)) => a.deviation_from(b),
        (Definition::NurbsSurface(a), Definition::NurbsSurface(b)) => a.deviation_from(b),
        _ => None,
    }
}

/// The interior knots of `a` that `b` has not, each as often as it is missing.
pub(super) fn lacking(a: &KnotVector, b: &KnotVector) -> Vec<f64> {
    let missing = |knot: f64, times: usize| std::iter::repeat_n(knot, times.saturating_sub(b.multiplicity(knot)));
    a.breaks().flat_map(|knot| missing(knot.at, knot.multiplicity)).collect()
}
