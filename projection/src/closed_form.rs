//! Closed forms and their proof: the foot that the shape proposes, the definition evaluated there, and the bound of the shape.

use std::sync::Arc;

use glam::DVec3;
use perpend_kernel::Definition;

use crate::analytic::{Analytic, Proposal};
use crate::answer::Method;
use crate::query::{DEFAULT_GAP, Query};
use crate::scratch::Scratch;
use crate::solver::{Solution, Solved, Solver, unit_normal};

/// What rounding may leave between a distance and its bound beside the gap, in ulps of the largest coordinate in play: what an answer
/// calls certified.
const ROUNDING: f64 = 32.0 * f64::EPSILON;

/// The closed form of a definition whose class is known and proved.
#[derive(Debug)]
pub(crate) struct ClosedForm {
    analytic: Analytic,
    definition: Arc<Definition>,
    size: f64,
    reach: f64,
}

impl ClosedForm {
    pub(crate) fn new(analytic: Analytic, definition: &Arc<Definition>) -> Self {
        let (size, reach) = (definition.size(), definition.reach());
        Self { analytic, definition: Arc::clone(definition), size, reach }
    }

    /// The definition at a proposal's parameters, seen from the query.
    fn evaluate(&self, query: &Query, proposal: &Proposal) -> Solution {
        let &Proposal { u, v, lower_bound, tie } = proposal;
        let (point, normal) = match &*self.definition {
            Definition::NurbsCurve(curve) => (curve.point(u), DVec3::ZERO),
            Definition::NurbsSurface(surface) => {
                let mut d = [DVec3::ZERO; 4];
                surface.derivatives(u, v, 1, &mut d);
                (d[0], unit_normal(d[2], d[1]))
            }
        };
        let offset = point - query.point;
        let distance = offset.length();
        Solution {
            u,
            v,
            point: Some(point),
            distance,
            lower_bound: lower_bound.clamp(0.0, distance),
            normal,
            offset,
            tie,
        }
    }
}

impl Solver for ClosedForm {
    fn method(&self) -> Method {
        Method::Analytic
    }

    /// Declines where the shape's proven gap is wider than what is asked, or where the foot's parameter is not to be had as exactly.
    fn solve(&self, query: &Query, _hint: Option<DVec3>, scratch: &mut Scratch) -> Solved {
        let Some(proposal) = self.analytic.propose(query, &mut scratch.hierarchy, &mut scratch.statistics.proposal)
        else {
            return Solved::Declined;
        };
        let solution = self.evaluate(query, &proposal);
        scratch.statistics.proposal.evaluations += 1;
        let limit = query.options.max_distance.unwrap_or(f64::INFINITY);
        if solution.lower_bound > limit {
            scratch.statistics.queries += 1;
            return Solved::Beyond;
        }
        let gap = query.options.gap.unwrap_or(DEFAULT_GAP * self.size);
        let rounding = ROUNDING * (self.reach + query.point.abs().max_element());
        // whether a foot just beyond the limit is all there is, the certified solver tells more finely
        if solution.distance - solution.lower_bound > gap + rounding || solution.distance > limit {
            return Solved::Declined;
        }
        scratch.statistics.queries += 1;
        Solved::Foot(solution)
    }
}
