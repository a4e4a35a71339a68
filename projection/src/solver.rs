//! What all solvers share: what they are asked, and what they answer.

use glam::DVec3;

use crate::answer::Method;
use crate::query::Query;
use crate::scratch::Scratch;

/// A solver: immutable, made once from a definition, shared by threads.
///
/// A solver answers fully or declines. What it answers is proven: the certificate is its own, or it asked the certified solver for it.
pub(crate) trait Solver {
    /// Its name in an answer.
    fn method(&self) -> Method;

    /// Answers a query; `hint` is any point of the entity, and changes no bit of the answer.
    fn solve(&self, query: &Query, hint: Option<DVec3>, scratch: &mut Scratch) -> Solved;
}

/// A solver without a bound of its own: what it proposes, the certificate proves or corrects.
pub(crate) trait Proposer: std::fmt::Debug + Send + Sync {
    /// Its name in an answer.
    fn method(&self) -> Method;

    /// Parameters of the definition at which it takes the foot to be (`v` is 0 for a curve); none where it finds nothing.
    ///
    /// Its work is counted in `scratch.statistics.proposal`; what else it keeps in `scratch` spares work and changes no proposal.
    fn propose(&self, query: &Query, scratch: &mut Scratch) -> Option<(f64, f64)>;
}

/// What became of a query.
#[derive(Debug)]
pub(crate) enum Solved {
    /// The foot, with its proof.
    Foot(Solution),
    /// Proven: nothing lies within the query's `max_distance`.
    Beyond,
    /// The solver cannot prove what is asked; another one can.
    Declined,
}

/// A foot as a solver gives it, in the model's unit.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Solution {
    /// Parameters of the definition.
    pub u: f64,
    pub v: f64,
    /// The definition there, where the solver has evaluated it.
    pub point: Option<DVec3>,
    pub distance: f64,
    pub lower_bound: f64,
    /// Unit vector along `S_u × S_v` at the foot, seen from inside the piece that holds it; zero where it vanishes, and on curves.
    pub normal: DVec3,
    /// From the query to the foot.
    pub offset: DVec3,
    pub tie: Tie,
}

/// What was seen of other feet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Tie {
    /// None.
    None,
    /// Another foot is as near within the gap.
    Apart,
    /// The foot belongs to a curve or region that is as near.
    Connected,
}

/// The unit vector along `a × b`; zero where the two are parallel to rounding or one of them vanishes.
#[inline]
pub(crate) fn unit_normal(a: DVec3, b: DVec3) -> DVec3 {
    let n = a.cross(b);
    let (square, of) = (n.length_squared(), a.length_squared() * b.length_squared());
    if square > 1e-24 * of && of > 0.0 { n * (1.0 / square.sqrt()) } else { DVec3::ZERO }
}
