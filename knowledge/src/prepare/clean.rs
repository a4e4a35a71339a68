//! Cleaning: what a definition does not need is removed.

use perpend_kernel::{Definition, Direction, NurbsCurve, NurbsSurface};

use super::PreparedDefinition;
use super::along::{directions, displacement, knots, lacking, lowered, without_knots};
use crate::representation::Cleaning;

/// Removes what a definition does not need: weights that are all one number, knots that can go, and degrees to which it was
/// elevated.
///
/// # Accuracy
///
/// Every step is taken where the whole, from the definition that was given, is proven to be rounding: some thirty
/// `(degree + 1) ε` of the largest |coordinate| a step (three times that where weights differ). Knots that carry less than that cannot
/// be told from those that carry nothing.
#[must_use]
pub fn clean(definition: &Definition) -> PreparedDefinition {
    let mut state = State {
        from: definition,
        now: PreparedDefinition { definition: definition.clone(), steps: Vec::new(), deviation: 0.0 },
        rounding: rounding(definition),
    };
    if let Some((plain, weight)) = without_weights(definition) {
        state.take(plain, || Cleaning::DroppedWeights { weight });
    }
    state.remove_knots();
    for direction in directions(definition) {
        while state.lower(*direction) {}
    }
    if state.now.steps.iter().any(|step| matches!(step, Cleaning::ReducedDegree { .. })) {
        // of a lower degree, knots may go that were needed for their continuity before
        state.remove_knots();
    }
    state.now
}

/// The rounding that a step may add: four times what its proof counts for itself.
fn rounding(definition: &Definition) -> f64 {
    let orders: usize = directions(definition).iter().map(|d| knots(definition, *d).degree() + 1).sum();
    let reach = definition.control_points().iter().map(|p| p.length()).fold(0.0, f64::max);
    let factor = if definition.weights().is_some() { 24.0 } else { 8.0 };
    4.0 * factor * (orders + 1) as f64 * f64::EPSILON * reach
}

struct State<'a> {
    from: &'a Definition,
    now: PreparedDefinition,
    /// What one step may add.
    rounding: f64,
}

impl State<'_> {
    /// Takes a step where the whole is proven to be rounding still.
    fn take(&mut self, next: Definition, step: impl FnOnce() -> Cleaning) -> bool {
        let allowed = self.rounding * (self.now.steps.len() + 1) as f64;
        match displacement(self.from, &next) {
            Some(bound) if bound <= allowed => {
                self.now.definition = next;
                self.now.deviation = bound;
                self.now.steps.push(step());
                true
            }
            _ => false,
        }
    }

    fn remove_knots(&mut self) {
        for direction in directions(self.from) {
            let old = self.now.definition.clone();
            if let Some((next, _)) = without_knots(&old, *direction, &[], self.rounding) {
                let knots = lacking(knots(&old, *direction), knots(&next, *direction));
                self.take(next, || Cleaning::RemovedKnots { direction: *direction, knots });
            }
        }
    }

    /// Lowers the degree by 1, if that is exact to rounding.
    fn lower(&mut self, direction: Direction) -> bool {
        let from = knots(&self.now.definition, direction).degree();
        lowered(&self.now.definition, direction, self.rounding)
            .is_some_and(|next| self.take(next, || Cleaning::ReducedDegree { direction, from, to: from - 1 }))
    }
}

/// The definition without its weights, where all of them are one number.
fn without_weights(definition: &Definition) -> Option<(Definition, f64)> {
    let weights = definition.weights()?;
    if weights.iter().any(|w| *w != weights[0]) {
        return None;
    }
    let points = definition.control_points();
    let plain = match definition {
        Definition::NurbsCurve(curve) => {
            NurbsCurve::new(curve.degree(), curve.knots().as_slice().to_vec(), points.to_vec(), None).ok()?.into()
        }
        Definition::NurbsSurface(surface) => {
            let [u, v] = [Direction::U, Direction::V].map(|d| surface.knots(d).as_slice().to_vec());
            let rows = points.chunks(surface.columns()).map(<[_]>::to_vec).collect();
            NurbsSurface::new(surface.degree(), (u, v), rows, None).ok()?.into()
        }
    };
    Some((plain, weights[0]))
}
