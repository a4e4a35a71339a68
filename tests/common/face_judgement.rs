//! What makes an answer on a trimmed face right, false or uncertified.

use glam::{DVec2, DVec3};
use perpend::{FootPoint, NurbsSurface, Place};

use super::face_oracle::FaceOracle;
use super::judgement::{is_certified, is_false_bound, rounding, two_ulps};
use super::outline::Verdict;

/// How far outside the trims a foot may lie, as a share of the domain's extent.
pub const OUTSIDE: f64 = 1e-9;

/// Farther than this, in sizes of the carrier, the gap is not demanded: the bounds of untrimmed carriers too are off by some 2e-13 of the distance
/// (measured), which is more than the gap there. Nothing else is forgiven.
pub const FAR: f64 = 3e4;

/// What an answer was found guilty of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum FaceFault {
    /// The bound lies above the distance of a real point of the face.
    FalseBound,
    /// Another point is nearer by more than the gap (far away: though the answer says that it is certified).
    WrongFoot,
    /// The foot's parameters lie outside the trims.
    OutsideTrims,
    /// The parameters lie outside the domain, or a number is no number.
    OutOfDomain,
    /// `point` is not the surface at the parameters.
    OffSurface,
    /// `distance` is not the distance of `point`.
    DishonestDistance,
    /// `place` says trim edge or vertex, and the foot lies elsewhere.
    WrongPlace,
}

/// An answer, seen from outside.
#[derive(Debug)]
pub struct JudgedOnFace {
    pub fault: Option<FaceFault>,
    /// Whether the gap was reached, or is not demanded.
    pub is_proven: bool,
    /// The least distance of a real point of the face that is known.
    pub real: f64,
    /// How far the foot lies from the outline, in shares of the domain.
    pub from_outline: f64,
}

/// Judges an answer to a query with this gap by the distance of a real point of the face, `real`.
pub fn judge_on_face(
    oracle: &FaceOracle,
    surface: &NurbsSurface,
    p: DVec3,
    foot: &FootPoint,
    gap: f64,
    real: f64,
) -> JudgedOnFace {
    let shape = &oracle.shape;
    let (size, reach) = (shape.size(), shape.reach());
    let uv = DVec2::new(foot.parameter.u(), foot.parameter.v().unwrap_or(f64::NAN));
    let is_in_domain = (0..2).all(|k| (shape.domain(k)[0]..=shape.domain(k)[1]).contains(&uv[k]));
    let certified = is_certified(foot.distance, foot.lower_bound, gap, reach, p);
    if !(is_in_domain && foot.distance >= foot.lower_bound && foot.lower_bound >= 0.0) {
        let fault = Some(FaceFault::OutOfDomain);
        return JudgedOnFace { fault, is_proven: certified, real, from_outline: f64::NAN };
    }
    let side = oracle.outline.side(uv);
    let from_outline = oracle.outline.distance(uv);
    let at_foot = shape.distance_at(p, uv.x.into(), uv.y.into());
    let allowed = rounding(reach, p, at_foot);
    let off = (foot.point - shape.point(uv.x, uv.y)).length();
    let is_inside = side != Verdict::Outside || from_outline <= OUTSIDE;
    let real = if side == Verdict::Outside { real } else { real.min(at_foot) };
    let place = match foot.place {
        Place::TrimEdge => from_outline <= OUTSIDE,
        Place::Vertex => oracle.outline.distance_to_ends(uv) <= OUTSIDE,
        _ => true,
    };
    // points of the outline are told to the grain of the parameters: by so much the named one may lie outside
    let is_false = is_false_bound(foot.lower_bound, real, size)
        && (side != Verdict::Beside || is_false_bound(foot.lower_bound, real + two_ulps(shape, [uv.x, uv.y]), size));
    let fault = if is_false {
        Some(FaceFault::FalseBound)
    } else if (certified || real <= FAR * size) && foot.distance > real + gap + allowed {
        Some(FaceFault::WrongFoot)
    } else if !is_inside {
        Some(FaceFault::OutsideTrims)
    } else if surface.point(uv.x, uv.y) != foot.point || off > allowed {
        Some(FaceFault::OffSurface)
    } else if (foot.distance - at_foot).abs() > allowed
        && (foot.distance - at_foot).abs() > allowed + two_ulps(shape, [uv.x, uv.y])
    {
        Some(FaceFault::DishonestDistance)
    } else if !place {
        Some(FaceFault::WrongPlace)
    } else {
        None
    };
    let is_proven = certified || real > FAR * size;
    JudgedOnFace { fault, is_proven, real, from_outline }
}
