//! What is asked.

use glam::DVec3;

use crate::answer::Method;

/// The gap of a query that asks for none, as a share of the entity's size.
pub(crate) const DEFAULT_GAP: f64 = 1e-9;

/// The flatness at which subdivision ends unless a query names one, as a share of the entity's size: the middle of the range that was measured
/// (`docs/papers.md`); it costs or spares work and changes no proof.
pub(crate) const DEFAULT_FLATNESS: f64 = 1e-3;

/// What a query asks for. The default is what an inspection wants; none of these is part of what was prepared.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct QueryOptions {
    /// The largest difference between `distance` and `lower_bound` that satisfies, in the model's unit; none: 1e-9 times the
    /// entity's size.
    pub gap: Option<f64>,
    /// Only feet at most this far are wanted, in the model's unit; none: however far. An answer of none is proven: nothing is
    /// within, up to rounding (some 1e-13 of the size, and a few ulps of the query's distance). Where the work bound was met before
    /// that proof, the foot that is known is answered with its bound, though it is farther.
    pub max_distance: Option<f64>,
    /// Feet farther than this from one another are different feet, in the model's unit; none: 1e-6 times the size.
    pub coincidence: Option<f64>,
    /// The solver that is asked first; none: the entity's plan's. A solver that the entity does not have is passed over: the answer says which
    /// one answered.
    pub method: Option<Method>,
    /// Where Newton's method stops in a solver that only proposes. It weakens no proof.
    pub newton: NewtonTolerances,
    /// Solvers that split an entity until its parts are flat take a part as flat when its control points lie within this of a line or
    /// plane, in the model's unit; none: 1e-3 times the size.
    pub flatness: Option<f64>,
    /// How often a query may split a form before it answers with the gap that it reached.
    pub work: u32,
}

/// Where Newton's method stops in a solver that only proposes (Piegl et al. 2008, §3). What it leaves, the proof polishes or corrects.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NewtonTolerances {
    /// Points nearer than this are one: the query lies on the entity, or a step leads nowhere. In the model's unit; none: 1e-6 times the
    /// size.
    pub coincidence: Option<f64>,
    /// The way to the query is perpendicular to a tangent where the cosine between them is at most this.
    pub perpendicularity: f64,
}

impl Default for NewtonTolerances {
    fn default() -> Self {
        Self { coincidence: None, perpendicularity: 1e-4 }
    }
}

impl Default for QueryOptions {
    fn default() -> Self {
        Self {
            gap: None,
            max_distance: None,
            coincidence: None,
            method: None,
            newton: NewtonTolerances::default(),
            flatness: None,
            work: 20_000,
        }
    }
}

impl QueryOptions {
    /// Checks the options.
    ///
    /// # Errors
    ///
    /// [`QueryError::InvalidOption`] where a length is negative or not a number.
    #[inline]
    pub fn validate(&self) -> Result<(), QueryError> {
        let check = |option, value: Option<f64>| match value {
            Some(value) if value.is_nan() || value < 0.0 => Err(QueryError::InvalidOption { option, value }),
            _ => Ok(()),
        };
        check("gap", self.gap)?;
        check("max_distance", self.max_distance)?;
        check("coincidence", self.coincidence)?;
        check("newton.coincidence", self.newton.coincidence)?;
        check("newton.perpendicularity", Some(self.newton.perpendicularity))?;
        check("flatness", self.flatness)
    }
}

/// A query: the object whose nearest point is sought, and what is wanted of the answer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Query {
    /// The query point.
    pub point: DVec3,
    /// What is wanted.
    pub options: QueryOptions,
}

/// Largest |coordinate| of a query point: its square stays finite.
const COORDINATE_LIMIT: f64 = 1e75;

impl Query {
    /// A query for the point nearest to `point`.
    ///
    /// # Errors
    ///
    /// A coordinate that is no finite number or beyond 1e75; an option without meaning.
    #[inline]
    pub fn new(point: DVec3, options: QueryOptions) -> Result<Self, QueryError> {
        options.validate()?;
        if point.abs().cmple(DVec3::splat(COORDINATE_LIMIT)).all() {
            Ok(Self { point, options })
        } else {
            Err(QueryError::InvalidPoint { index: 0, x: point.x, y: point.y, z: point.z })
        }
    }
}

/// Why a query was not answered.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum QueryError {
    /// No entity of the model has this id.
    #[error("the model has no entity {id}; its entities are listed by `perpend show`")]
    UnknownEntity {
        /// The id that was asked for.
        id: perpend_kernel::EntityId,
    },
    /// No body of the model has this id.
    #[error("the model has no body {id}; its bodies are listed by `perpend show`")]
    UnknownBody {
        /// The id that was asked for.
        id: perpend_kernel::EntityId,
    },
    /// The entity is a trimmed face, of which this is not answered.
    #[error(
        "entity {id} is a trimmed face, of which {what} are not available: ask its nearest point, or those of its surface"
    )]
    TrimmedFace {
        /// The face.
        id: perpend_kernel::EntityId,
        /// What was asked for.
        what: &'static str,
    },
    /// A coordinate of the query point is infinite, not a number, or beyond 1e75.
    #[error("query point {index} is ({x:?}, {y:?}, {z:?}); coordinates are finite and within ±1e75")]
    InvalidPoint {
        /// Index of the point in its batch; 0 for a single query.
        index: usize,
        /// Its first coordinate.
        x: f64,
        /// Its second coordinate.
        y: f64,
        /// Its third coordinate.
        z: f64,
    },
    /// An option has no meaning.
    #[error(
        "the option {option} is {value}; it is a length in the model's unit, or a cosine: give it a number of at least 0"
    )]
    InvalidOption {
        /// The option's name.
        option: &'static str,
        /// Its value.
        value: f64,
    },
}
