//! Distances to free-form profiles that are moved along a vector or turned about an axis: by one parameter, that of the profile.

use super::curve::{Arc, least, to_segment};
use super::turn::Range;
use super::vector::Vector;
use crate::common::double_double::Dd;
use crate::common::shape::Shape;
use glam::DVec3;

/// The least value of `of` over the spans of a curve's parameter: the best of samples, each local minimum of which is closed in on by
/// the golden section. A valley narrower than two samples may be missed; what is found is a value of `of` in any case.
fn least_over(profile: &Shape, of: impl Fn(Dd) -> Dd) -> Dd {
    const SAMPLES: usize = 48;
    let golden = Dd::from(0.618_033_988_749_894_9);
    let knots = &profile.knots[0];
    let mut found = Dd::from(f64::INFINITY);
    for span in profile.spans(0) {
        let (from, width) = (Dd::from(knots[span]), Dd::difference(knots[span + 1], knots[span]));
        let at = |share: Dd| of(from + width * share);
        let share = |k: usize| Dd::from(k as f64 / SAMPLES as f64);
        let samples: Vec<Dd> = (0..=SAMPLES).map(|k| at(share(k))).collect();
        for k in 0..=SAMPLES {
            found = least([found, samples[k]]);
            let (before, after) = (k.saturating_sub(1), (k + 1).min(SAMPLES));
            if samples[k] > samples[before] || samples[k] > samples[after] {
                continue;
            }
            let (mut low, mut high) = (share(before), share(after));
            for _ in 0..80 {
                let step = (high - low) * golden;
                let (a, b) = (high - step, low + step);
                if at(a) < at(b) { high = b } else { low = a }
            }
            found = least([found, at((low + high) * Dd::from(0.5))]);
        }
    }
    found
}

/// The distance from `p` to the surface that the profile covers when it is moved along `vector`.
pub fn of_extrusion(profile: &Shape, vector: DVec3, p: DVec3) -> Dd {
    least_over(profile, |t| {
        let start = Vector(profile.seen_from(p, t, Dd::ZERO));
        to_segment(Vector::ZERO, start, start.plus(Vector::from(vector)))
    })
}

/// The distance from `p` to the surface that the profile covers when it is turned about the axis through `origin`.
pub fn of_revolution(profile: &Shape, origin: DVec3, axis: Vector, sweep: f64, p: DVec3) -> Dd {
    let range = Range::new((0.0, sweep));
    let seen = Vector::between(origin, p);
    least_over(profile, |t| {
        let q = Vector(profile.seen_from(origin, t, Dd::ZERO));
        let centre = axis.times(q.dot(axis));
        let arm = q.minus(centre);
        let Some(x) = arm.unit() else { return seen.minus(centre).length() };
        Arc { centre, x, y: axis.cross(x), radii: [arm.length(); 2], range }.distance_of_circle(seen)
    })
}
