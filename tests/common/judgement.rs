//! What makes an answer right, false or uncertified. The bounds are those that the answers' documentation promises.

use glam::DVec3;
use perpend::{Definition, FootPoint};

use super::double_double::Dd;
use super::shape::Shape;

/// The spacing of f64 at 1.
pub const EPSILON: f64 = f64::EPSILON;

/// Rounding of a distance measured between points of the world: 16 ulps of the largest coordinate.
pub fn rounding(reach: f64, p: DVec3, distance: f64) -> f64 {
    1e-13 * distance + 16.0 * EPSILON * reach.max(p.abs().max_element())
}

/// Whether the distance of a real point proves `lower_bound` false. No allowance is made for the place of the
/// entity in the world: a bound pays for its own rounding.
pub fn is_false_bound(lower_bound: f64, real: f64, size: f64) -> bool {
    lower_bound.is_nan() || lower_bound > real + 1e-12 * size + 1e-15 * real
}

/// Whether the answer is proven to within `gap`.
pub fn is_certified(distance: f64, lower_bound: f64, gap: f64, reach: f64, p: DVec3) -> bool {
    distance - lower_bound <= gap + 32.0 * EPSILON * (reach + p.abs().max_element())
}

/// How far two ulps of each parameter move the point at `parameter`: what a foot point named by `f64` may be off.
pub fn two_ulps(shape: &Shape, [u, v]: [f64; 2]) -> f64 {
    let here = exactly(shape, u, v);
    let mut most = 0.0_f64;
    for along in 0..if shape.curve { 1 } else { 2 } {
        let [first, last] = shape.domain(along);
        for moved in [f64::next_up, f64::next_down] {
            let mut at = [u, v];
            at[along] = moved(moved(at[along])).clamp(first, last);
            let there = exactly(shape, at[0], at[1]);
            let apart = [0, 1, 2].map(|k| (there[k] - here[k]).value());
            most = most.max(DVec3::from_array(apart).length());
        }
    }
    most
}

fn exactly(shape: &Shape, u: f64, v: f64) -> [Dd; 3] {
    shape.seen_from(DVec3::ZERO, u.into(), v.into())
}

/// What an answer was found guilty of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fault {
    /// The bound lies above the distance of a real point.
    FalseBound,
    /// Another point is nearer by more than the gap, and the answer says that it is certified.
    WrongFoot,
    /// `distance` is not the distance of the point at `parameter`.
    DishonestDistance,
    /// `point` is not the definition at `parameter`, bit for bit or in truth.
    OffEntity,
    /// The parameter lies outside the domain, or a number is no number.
    OutOfDomain,
}

/// An answer, seen from outside.
#[derive(Debug)]
pub struct Judged {
    pub fault: Option<Fault>,
    pub certified: bool,
    /// The least distance of a real point that is known.
    pub real: f64,
    /// The distance of the point at the answer's parameter, to the last digit.
    pub at_foot: f64,
}

/// Judges an answer to a query with this gap by the distance of a real point, `oracle`.
pub fn judge(shape: &Shape, definition: &Definition, p: DVec3, foot: &FootPoint, gap: f64, oracle: f64) -> Judged {
    let (size, reach) = (shape.size(), shape.reach());
    let at = [foot.parameter.u(), foot.parameter.v().unwrap_or(0.0)];
    let inside = (0..2).all(|k| (shape.domain(k)[0]..=shape.domain(k)[1]).contains(&at[k]));
    let certified = is_certified(foot.distance, foot.lower_bound, gap, reach, p);
    if !(inside && foot.distance >= foot.lower_bound && foot.lower_bound >= 0.0) {
        return Judged { fault: Some(Fault::OutOfDomain), certified, real: oracle, at_foot: f64::NAN };
    }
    let at_foot = shape.distance_at(p, at[0].into(), at[1].into());
    let real = oracle.min(at_foot);
    let allowed = rounding(reach, p, at_foot);
    let evaluated = match definition {
        Definition::NurbsCurve(curve) => curve.point(at[0]),
        Definition::NurbsSurface(surface) => surface.point(at[0], at[1]),
    };
    let off = (foot.point - shape.point(at[0], at[1])).length();
    let fault = if is_false_bound(foot.lower_bound, real, size) {
        Some(Fault::FalseBound)
    } else if certified && foot.distance > real + gap + allowed {
        Some(Fault::WrongFoot)
    } else if evaluated != foot.point || off > allowed {
        Some(Fault::OffEntity)
    } else if (foot.distance - at_foot).abs() > allowed
        && (foot.distance - at_foot).abs() > allowed + two_ulps(shape, at)
    {
        Some(Fault::DishonestDistance)
    } else {
        None
    };
    Judged { fault, certified, real, at_foot }
}
