//! Purging: what a definition hardly needs is removed, within a tolerance that somebody has named.

use perpend_kernel::{Definition, Direction, KnotVector};

use super::PreparedDefinition;
use super::along::{directions, displacement, knots, lacking, refined, without_knots};
use super::clean::clean;
use crate::representation::Cleaning;

/// Knots nearly coincide where they are nearer than this share of the mean span.
const NEAR: f64 = 1e-6;

/// How often the choice is made again where the proof of the whole asks for less.
const ATTEMPTS: usize = 6;

/// The tolerance of a purge is no length above 0.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("the tolerance is {tolerance}; it is how far points may move, a finite length above 0 in the model's unit")]
pub struct InvalidTolerance {
    /// What was given.
    pub tolerance: f64,
}

/// Removes knots, with their control points, as long as no point of the entity moves farther than `tolerance`, a length in model
/// units; what [`clean`] removes goes first, then knots that nearly coincide become one, then the others go by what they cost.
///
/// # Accuracy
///
/// The deviation is proven, for all steps together, against the definition that was given. It is a bound: points move less. How much
/// goes is heuristic, and not the most that could.
///
/// # Errors
///
/// The tolerance is no finite length above 0.
pub fn purge(definition: &Definition, tolerance: f64) -> Result<PreparedDefinition, InvalidTolerance> {
    if !(tolerance > 0.0 && tolerance.is_finite()) {
        return Err(InvalidTolerance { tolerance });
    }
    let as_it_is = || PreparedDefinition { definition: definition.clone(), steps: Vec::new(), deviation: 0.0 };
    let cleaned = Some(clean(definition)).filter(|cleaned| cleaned.deviation <= tolerance).unwrap_or_else(as_it_is);
    let mut asked = tolerance - cleaned.deviation;
    for _ in 0..ATTEMPTS {
        let thin = thinned(&cleaned.definition, asked);
        if thin == cleaned.definition {
            break;
        }
        match displacement(definition, &thin) {
            Some(deviation) if deviation <= tolerance => {
                let mut steps = cleaned.steps;
                steps.extend(differences(&cleaned.definition, &thin));
                return Ok(PreparedDefinition { definition: thin, steps, deviation });
            }
            Some(bound) if bound.is_finite() => asked *= 0.5 * (tolerance / bound).max(0.02),
            _ => asked *= 0.1,
        }
    }
    Ok(cleaned)
}

/// The definition with fewer knots; `tolerance` is shared by the directions, and what one leaves goes to the other.
fn thinned(definition: &Definition, tolerance: f64) -> Definition {
    let rounds: &[(Direction, f64)] = match definition {
        Definition::NurbsCurve(_) => &[(Direction::U, 1.0)],
        Definition::NurbsSurface(_) => &[(Direction::U, 0.5), (Direction::V, 1.0), (Direction::U, 1.0)],
    };
    let (mut now, mut spent) = (definition.clone(), 0.0);
    for (direction, share) in rounds {
        let (added, leaving) = near(knots(&now, *direction));
        let Some(start) = refined(&now, *direction, &added) else { continue };
        let Some((next, moved)) = without_knots(&start, *direction, &leaving, share * (tolerance - spent)) else {
            continue;
        };
        if next.control_points().len() <= now.control_points().len() && next != now {
            (now, spent) = (next, spent + moved);
        }
    }
    now
}

/// Of knots that nearly coincide: the copies to add to the one that stays, and those that are to leave, both ascending.
///
/// Together they leave the continuity at the place as it was. A knot next to an end of the domain is to leave for good.
fn near(knots: &KnotVector) -> (Vec<f64>, Vec<f64>) {
    let (first, last) = knots.domain();
    let close = NEAR * (last - first) / knots.spans().count() as f64;
    let (mut added, mut leaving) = (Vec::new(), Vec::new());
    let (mut stays, mut room) = (first, 0);
    for knot in knots.breaks() {
        if last - knot.at <= close {
            leaving.push(knot.at);
        } else if knot.at - stays <= close {
            let copies = knot.multiplicity.min(room);
            added.extend(std::iter::repeat_n(stays, copies));
            room -= copies;
            leaving.push(knot.at);
        } else {
            (stays, room) = (knot.at, knots.degree() - knot.multiplicity);
        }
    }
    (added, leaving)
}

/// What was removed and added, by direction.
fn differences(old: &Definition, new: &Definition) -> Vec<Cleaning> {
    let change = |direction: &Direction| {
        let (old, new) = (knots(old, *direction), knots(new, *direction));
        Cleaning::Purged { direction: *direction, removed: lacking(old, new), added: lacking(new, old) }
    };
    let changes = directions(old).iter().map(change);
    changes.filter(|change| !matches!(change, Cleaning::Purged { removed, added, .. } if removed.is_empty() && added.is_empty())).collect()
}

#[cfg(test)]
mod tests {
    use perpend_kernel::Along;

    use super::*;

    #[test]
    fn near_knots_become_one_with_their_copies() {
        let t = 0.5 + 1e-9;
        let all = vec![0.0, 0.0, 0.0, 0.0, 1e-9, 0.5, 0.5, t, t, 0.7, 1.0 - 1e-9, 1.0, 1.0, 1.0, 1.0];
        let knots = KnotVector::new(3, all, 11, Along::Curve).expect("valid");
        // the degree has room for one copy more
        assert_eq!(near(&knots), (vec![0.5], vec![1e-9, t, 1.0 - 1e-9]));
    }
}
