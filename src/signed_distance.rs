//! The signed distance to a closed body: that to its nearest face, negative inside.

use glam::DVec3;
use perpend_kernel::EntityId;
use perpend_projection::{FootPoint, Query, QueryError, QueryOptions, Scratch};

use crate::batch;
use crate::model::Model;
use crate::query::at_index;
use crate::solid::BodySide;

/// The nearest point of a closed body, and on which side of it a point lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyFoot {
    /// The face on which the nearest point lies.
    pub face: EntityId,
    /// The nearest point, as [`Model::nearest_of`] gives it.
    pub foot: FootPoint,
    /// The distance: positive outside, negative inside.
    pub signed_distance: f64,
    /// On which side the point lies.
    pub side: BodySide,
    /// Proven: no point of the body is nearer. The sign is no part of the proof.
    pub lower_bound: f64,
}

/// Why a signed distance was not given.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BodyError {
    /// The query is refused.
    #[error(transparent)]
    Query(#[from] QueryError),
    /// A shell is open.
    #[error(
        "body {body} has no inside: shells[{shell}] is not closed; ask its distance, or close the shell and say so"
    )]
    Open {
        /// The body.
        body: EntityId,
        /// The shell.
        shell: usize,
    },
    /// Points far away would be inside.
    #[error("body {body} is inside out: points far away would be inside; reverse its faces")]
    InsideOut {
        /// The body.
        body: EntityId,
    },
    /// The faces contradict each other.
    #[error(
        "body {body}: entity {face} and those that meet it near ({:?}, {:?}, {:?}) do not tell inside from outside: see whether all their normals point outward, and whether they meet within their tolerances", at.x, at.y, at.z
    )]
    Undecided {
        /// The body.
        body: EntityId,
        /// The nearest face.
        face: EntityId,
        /// The nearest point.
        at: DVec3,
    },
}

impl Model {
    /// The distance from `p` to a closed body with its sign, negative inside, and the foot.
    ///
    /// The sign is right where the distance exceeds the tolerances to which the faces meet at the foot. A maximum distance among the options is
    /// passed over.
    ///
    /// # Errors
    ///
    /// An id that no body has; an open shell; a body that is inside out; faces that do not tell inside from outside; a coordinate that
    /// is no finite number or beyond 1e75; an option without meaning.
    pub fn signed_distance(&self, body: EntityId, p: DVec3, options: &QueryOptions) -> Result<BodyFoot, BodyError> {
        let query = Query::new(p, QueryOptions { max_distance: None, ..*options })?;
        self.signed(body, &query, &mut Scratch::default())
    }

    /// [`signed_distance`](Self::signed_distance) for many points, in their order, on all cores where the feature `rayon` is on.
    #[must_use]
    pub fn signed_distance_all(
        &self,
        body: EntityId,
        ps: &[DVec3],
        options: &QueryOptions,
    ) -> Vec<Result<BodyFoot, BodyError>> {
        let options = QueryOptions { max_distance: None, ..*options };
        batch::answers(ps, Scratch::default, |scratch, index, p| {
            let query = Query::new(*p, options).map_err(|error| at_index(error, index))?;
            self.signed(body, &query, scratch)
        })
    }

    fn signed(&self, body: EntityId, query: &Query, scratch: &mut Scratch) -> Result<BodyFoot, BodyError> {
        let solid = self.solid(body)?;
        let shells = self.body(body).map_or(&[][..], crate::Body::shells);
        if let Some(shell) = shells.iter().position(|shell| !shell.closed) {
            return Err(BodyError::Open { body, shell });
        }
        if !solid.is_outward(self) {
            return Err(BodyError::InsideOut { body });
        }
        let (face, foot) = solid.faces.nearest(self, query, scratch).expect("a body has faces, and none is too far");
        let side = solid.side(self, query, (face, foot), scratch);
        let side = side.ok_or(BodyError::Undecided { body, face, at: foot.point })?;
        let signed_distance = if side == BodySide::Inside { -foot.distance } else { foot.distance };
        Ok(BodyFoot { face, foot, signed_distance, side, lower_bound: foot.lower_bound })
    }
}
