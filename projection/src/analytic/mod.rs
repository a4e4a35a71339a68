//! Closed forms: the nearest point of a shape whose class is known.

use perpend_kernel::Definition;
use perpend_knowledge::Kind;

use crate::hierarchy::Workspace;
use crate::query::Query;
use crate::solver::Tie;
use crate::statistics::Work;

/// The closed form of a shape.
#[derive(Debug)]
pub(crate) enum Analytic {}

/// A foot as the shape has it, in parameters of the definition.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Proposal {
    pub u: f64,
    pub v: f64,
    /// Proven: no point of the definition is nearer, in the model's unit.
    pub lower_bound: f64,
    pub tie: Tie,
}

impl Analytic {
    /// The closed form of a definition of this class; `gap` is the proven bound of the distance between the two, both ways. None
    /// where the class has none.
    pub(crate) fn new(_definition: &Definition, _kind: &Kind, _gap: f64) -> Option<Self> {
        None
    }

    /// The foot that the shape proposes; none where it declines.
    pub(crate) fn propose(&self, _: &Query, _: &mut Workspace, _: &mut Work) -> Option<Proposal> {
        match *self {}
    }
}
