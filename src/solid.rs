//! Bodies made ready for queries: their faces, and on which side of them a point lies whose nearest point is known.
//!
//! Where the foot lies inside a face, its outward normal tells. On an edge or a vertex the *pseudo-normal* does: the sum of the outward
//! normals of the faces that meet there, each times the angle of the face (Bærentzen and Aanæs 2005, "Signed distance
//! computation using the angle weighted pseudo-normal", §4); curved faces count by their tangent planes. Faces meet within their
//! tolerances, and so the faces that meet are those within these of the foot.
//!
//! Where the pseudo-normal is nearly perpendicular to the way from the foot, or nearly nothing (a knife's edge, a cusp), other points decide. The ball
//! about the query point with the lower bound for its radius holds no point of the body, so that all its points lie on one side, as
//! long as it does not reach through a gap. Points of it are taken from which the foot lies inside one of the faces that meet, where the normal
//! tells; where the ball does not reach over any of these, points of it that lie farther out are asked in turn.

use std::sync::OnceLock;

use glam::{DVec2, DVec3};
use perpend_kernel::{Definition, Direction, EntityId, Side};
use perpend_projection::{FootPoint, Parameter, Place, Query, QueryOptions, Scratch};

use crate::corner::{Corner, corners};
use crate::entity::Entity;
use crate::group::{Found, Group};
use crate::model::Model;

/// A body made ready for queries.
#[derive(Debug, Clone)]
pub(crate) struct Solid {
    /// Its faces.
    pub(crate) faces: Group,
    /// The largest tolerance of a face.
    tolerance: f64,
    /// The corners of each face, in the order of the group.
    corners: Vec<OnceLock<Vec<Corner>>>,
    /// Whether points far away are outside.
    is_outward: OnceLock<bool>,
}

/// On which side of a closed body a point lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum BodySide {
    /// In the material.
    Inside,
    /// Outside it, in a void too.
    Outside,
    /// On a face, as far as doubles tell; or in a gap between faces that meet within their tolerances.
    Boundary,
}

/// Below this cosine between the way from the foot and the normal, other points are asked.
const CLEAR: f64 = 0.05;

/// How far beside the foot these look, as shares of the distance.
const BESIDE: [f64; 4] = [0.05, 0.2, 0.01, 0.5];

/// How often points farther out are asked in turn, and how far these lie from one another, as a share of the lower bound.
const DETOURS: u32 = 2;
const DETOUR: f64 = 0.7;

/// How often wider gaps are looked over for the faces that meet, eight times each.
const WIDENED: usize = 4;

impl Solid {
    pub(crate) fn new(model: &Model, items: Vec<usize>) -> Self {
        let tolerances = items.iter().filter_map(|at| model.entities[*at].trimming()).map(|trim| trim.tolerance());
        let tolerance = tolerances.fold(0.0, f64::max);
        let faces = Group::new(model, items);
        let corners = vec![OnceLock::new(); faces.len()];
        Self { faces, tolerance, corners, is_outward: OnceLock::new() }
    }

    /// Whether a point far away is outside, or cannot be told.
    pub(crate) fn is_outward(&self, model: &Model) -> bool {
        let asked = Asked { model, solid: self, options: QueryOptions::default() };
        *self.is_outward.get_or_init(|| asked.is_outward())
    }

    /// On which side of the body a point lies whose nearest point is known; none where the faces do not tell.
    pub(crate) fn side(&self, model: &Model, query: &Query, found: Found, scratch: &mut Scratch) -> Option<BodySide> {
        Asked { model, solid: self, options: query.options }.side(query.point, found, DETOURS, scratch)
    }
}

/// A body that is asked.
#[derive(Clone, Copy)]
struct Asked<'a> {
    model: &'a Model,
    solid: &'a Solid,
    options: QueryOptions,
}

/// What the faces that meet at a foot tell.
struct Meeting {
    /// The sum of the normals, each times its angle.
    sum: DVec3,
    /// The sum of the angles.
    angles: f64,
    /// The faces, with their points nearest to the foot.
    faces: Vec<Met>,
}

/// A face that meets others at a foot.
struct Met {
    /// Its place in the group.
    item: usize,
    /// The parameters of its point nearest to the foot.
    at: DVec2,
    /// Its outward normal there.
    normal: Option<DVec3>,
}

impl<'a> Asked<'a> {
    /// Whether a point far away is outside, or cannot be told.
    fn is_outward(self) -> bool {
        let bounds = self.solid.faces.bounds;
        let p = bounds.centre() + DVec3::new(1.9, 1.3, 1.6) * bounds.diagonal();
        let scratch = &mut Scratch::default();
        let Ok(query) = Query::new(p, self.options) else { return true };
        let found = self.solid.faces.nearest(self.model, &query, scratch);
        found.and_then(|found| self.side(p, found, DETOURS, scratch)) != Some(BodySide::Inside)
    }

    /// On which side of the body a point lies whose nearest point is known; none where the faces do not tell.
    /// Other points may be asked, and others in their place, `detours` times.
    fn side(self, p: DVec3, (face, foot): Found, detours: u32, scratch: &mut Scratch) -> Option<BodySide> {
        let reach = self.solid.faces.bounds.reach().max(p.abs().max_element());
        if foot.distance <= 16.0 * f64::EPSILON * reach {
            return Some(BodySide::Boundary);
        }
        if let Some(side) = by_normal(p, &foot) {
            return Some(side);
        }
        let way = (p - foot.point).normalize_or_zero();
        let meeting = self.meeting(face, &foot, scratch);
        let clear = CLEAR.max(64.0 * f64::EPSILON * reach / foot.distance);
        if meeting.faces.len() > 1 && meeting.sum.length() > CLEAR * meeting.angles {
            let cosine = way.dot(meeting.sum.normalize());
            if cosine.abs() > clear {
                return Some(side_of(cosine));
            }
        }
        let by_others = self.by_others(p, &foot, &meeting, scratch);
        by_others.or_else(|| self.by_detour(p, &foot, &meeting, detours, scratch)).or_else(|| {
            // no farther than the faces may be apart: a gap is neither inside nor outside
            (foot.distance <= self.tolerance(face, face)).then_some(BodySide::Boundary)
        })
    }

    /// To what length two faces meet.
    fn tolerance(self, a: EntityId, b: EntityId) -> f64 {
        let entity = |id: EntityId| self.model.entity(id);
        let of = |id: EntityId| entity(id).and_then(Entity::trimming).map_or(0.0, |trimming| trimming.tolerance());
        let size = self.solid.faces.bounds.diagonal();
        of(a) + of(b) + self.options.coincidence.unwrap_or(1e-6 * size)
    }

    /// The faces that meet at a foot. Where the foot's own is the only one within the tolerances, wider gaps are looked over, up to
    /// an eighth of the distance: seen from there, they are none.
    fn meeting(self, face: EntityId, foot: &FootPoint, scratch: &mut Scratch) -> Meeting {
        let mut widened = 1.0;
        loop {
            let meeting = self.meeting_within(face, foot, widened, scratch);
            widened *= 8.0;
            let is_wide =
                widened >= 8.0_f64.powi(WIDENED as i32) || widened * self.tolerance(face, face) > 0.125 * foot.distance;
            if meeting.faces.len() > 1 || is_wide {
                return meeting;
            }
        }
    }

    fn meeting_within(self, face: EntityId, foot: &FootPoint, widened: f64, scratch: &mut Scratch) -> Meeting {
        let mut meeting = Meeting { sum: DVec3::ZERO, angles: 0.0, faces: Vec::new() };
        let faces = &self.solid.faces;
        let most = self.tolerance(face, face) + self.solid.tolerance;
        for item in faces.near(self.model, foot.point, widened * most) {
            let entity = faces.entity(self.model, item);
            let within = widened * self.tolerance(face, entity.id);
            let options = QueryOptions { max_distance: Some(within), ..self.options };
            let query = Query { point: foot.point, options };
            let Some(met) = entity.prepared().project(&query, scratch) else { continue };
            if met.distance > within {
                continue;
            }
            let Parameter::Surface(u, v) = met.parameter else { continue };
            meeting.faces.push(Met { item, at: DVec2::new(u, v), normal: met.normal });
            let all = self.solid.corners[item].get_or_init(|| corners(entity));
            let mut turns = false;
            for corner in all.iter().filter(|corner| corner.point.distance(foot.point) <= within) {
                meeting.sum += corner.weighted;
                meeting.angles += corner.angle;
                turns = true;
            }
            if !turns && let Some(normal) = met.normal {
                meeting.sum += std::f64::consts::PI * normal;
                meeting.angles += std::f64::consts::PI;
            }
        }
        meeting
    }

    /// What points say that lie on the same side, and whose feet lie inside the faces that meet.
    fn by_others(self, p: DVec3, foot: &FootPoint, meeting: &Meeting, scratch: &mut Scratch) -> Option<BodySide> {
        for share in BESIDE {
            for met in &meeting.faces {
                let entity = self.solid.faces.entity(self.model, met.item);
                for (point, normal) in beside(entity, met.at, share * foot.distance) {
                    let Some(other) = on_normal(p, foot.lower_bound, point, normal) else { continue };
                    let Ok(query) = Query::new(other, self.options) else { continue };
                    let Some((_, foot)) = self.solid.faces.nearest(self.model, &query, scratch) else { continue };
                    if let Some(side) = by_normal(other, &foot) {
                        return Some(side);
                    }
                }
            }
        }
        None
    }

    /// What points on the same side say that lie over or under the faces that meet.
    fn by_detour(
        self,
        p: DVec3,
        foot: &FootPoint,
        meeting: &Meeting,
        detours: u32,
        scratch: &mut Scratch,
    ) -> Option<BodySide> {
        let left = detours.checked_sub(1)?;
        for normal in meeting.faces.iter().filter_map(|met| met.normal) {
            for way in [normal, -normal] {
                let other = p + DETOUR * foot.lower_bound * way;
                let Ok(query) = Query::new(other, self.options) else { continue };
                let Some(found) = self.solid.faces.nearest(self.model, &query, scratch) else { continue };
                match self.side(other, found, left, scratch) {
                    None | Some(BodySide::Boundary) => {}
                    side => return side,
                }
            }
        }
        None
    }
}

/// The side that the normal tells, where the foot lies inside a face.
fn by_normal(p: DVec3, foot: &FootPoint) -> Option<BodySide> {
    if !matches!(foot.place, Place::Interior | Place::Seam | Place::Crease) {
        return None;
    }
    let cosine = (p - foot.point).try_normalize()?.dot(foot.normal?);
    (cosine.abs() > 0.5).then(|| side_of(cosine))
}

fn side_of(cosine: f64) -> BodySide {
    if cosine > 0.0 { BodySide::Outside } else { BodySide::Inside }
}

/// Points inside a face about so far from one of it, with their normals.
fn beside(entity: &Entity, at: DVec2, length: f64) -> Vec<(DVec3, DVec3)> {
    let Definition::NurbsSurface(surface) = entity.definition.as_ref() else { return Vec::new() };
    let [(u0, u1), (v0, v1)] = [Direction::U, Direction::V].map(|direction| surface.domain(direction));
    let (min, max) = (DVec2::new(u0, v0), DVec2::new(u1, v1));
    let mut d = [DVec3::ZERO; 4];
    // beside a pole, where a derivative vanishes, those a little way off tell the speed
    let inner = at.lerp(0.5 * (min + max), 0.01);
    surface.derivatives(inner.x, inner.y, 1, &mut d);
    let speed = DVec2::new(d[2].length(), d[1].length());
    let step = (length / speed).min(0.5 * (max - min));
    let turns = (0..8).map(|k| DVec2::from_angle(f64::from(k) * std::f64::consts::FRAC_PI_4 + 0.2));
    turns
        .filter_map(|turn| {
            let there = at + turn * step;
            let in_domain = there.cmpgt(min).all() && there.cmplt(max).all();
            let kept = |side: Side| side == Side::Inside;
            let is_inside = in_domain && entity.trimming().is_none_or(|trim| kept(trim.region().side(there)));
            let normal = surface.normal(there.x, there.y).try_normalize().filter(|_| is_inside)?;
            Some((surface.point(there.x, there.y), normal))
        })
        .collect()
}

/// A point on the normal of a face's point, as near to that as the open ball about `p` lets it, less a tenth; none where the normal misses the ball.
fn on_normal(p: DVec3, radius: f64, point: DVec3, normal: DVec3) -> Option<DVec3> {
    let along = (p - point).dot(normal);
    let off = (p - point - along * normal).length();
    let half = (radius * radius - off * off).sqrt();
    // NaN where the normal misses the ball
    (half > 0.0).then(|| point + (along - along.signum() * 0.9 * half) * normal)
}
