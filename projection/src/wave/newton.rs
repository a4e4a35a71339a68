//! Newton's method for a foot point (Piegl et al. 2008, §3).

use glam::DVec3;
use perpend_kernel::Definition;

use super::jet::Jet;
use super::track::Track;
use crate::query::NewtonTolerances;
use crate::statistics::Work;

/// Steps that are taken at most. From a start near the foot it takes one or two; what has not arrived by then is lost.
const MOST_STEPS: u32 = 30;

/// What the method is applied to.
#[derive(Debug, Clone, Copy)]
pub(super) struct Course<'a> {
    pub definition: &'a Definition,
    /// In u and in v.
    pub tracks: &'a [Track; 2],
    pub query: DVec3,
    pub tolerances: NewtonTolerances,
    /// Two points nearer than this are one, in the model's unit.
    pub coincidence: f64,
}

/// The nearest point that was met, with parameters in the domain.
#[derive(Debug, Clone, Copy)]
pub(super) struct Arrived {
    pub parameters: [f64; 2],
    pub distance: f64,
    /// Per direction: the end of the domain that the foot is pushed over.
    pub pushed: [Option<f64>; 2],
}

/// The place of an iteration: its parameters, perhaps beyond the seam, and the smooth range around each.
#[derive(Debug, Clone, Copy)]
struct Place {
    at: [f64; 2],
    part: [(f64, f64); 2],
}

impl Course<'_> {
    /// The steps from a start.
    ///
    /// They stop where the point lies on the query within the point coincidence tolerance, where the directions in which it may still move are
    /// perpendicular to the way to the query within the perpendicularity tolerance, or where a step moves it by less than the former. At
    /// a break a parameter is held, unless it goes on downhill on the other side; over the seam of a closed entity it goes on; at an end it is held,
    /// and the caller is told.
    pub(super) fn run(&self, start: [f64; 2], work: &mut Work) -> Arrived {
        let part = [0, 1].map(|k| self.tracks[k].part(start[k], false));
        let mut place = Place { at: start, part };
        let mut best = Arrived { parameters: start, distance: f64::INFINITY, pushed: [None; 2] };
        for _ in 0..MOST_STEPS {
            let jet = self.jet(&place);
            work.evaluations += 1;
            let r = jet.point - self.query;
            let distance = r.length();
            if distance < best.distance {
                (best.parameters, best.distance) = (self.parameters(&place), distance);
            }
            if distance <= self.coincidence {
                best.pushed = [None; 2];
                break;
            }
            if self.cross(&mut place, &jet, r, work) {
                continue;
            }
            let held = [0, 1].map(|k| is_held(&place, k, jet.first[k].dot(r)));
            best.pushed = [0, 1].map(|k| {
                let end = self.tracks[k].wrap(place.at[k]);
                (held[k] && self.tracks[k].is_end(end)).then_some(end)
            });
            // the paper leaves the surface for its boundary there
            if best.pushed != [None; 2] || self.is_perpendicular(&jet, r, distance, held) {
                break;
            }
            let step = step(&jet, r, held);
            if !(step[0].is_finite() && step[1].is_finite()) {
                break;
            }
            let next = [0, 1].map(|k| (place.at[k] + step[k]).max(place.part[k].0).min(place.part[k].1));
            let moved = (next[0] - place.at[0]) * jet.first[0] + (next[1] - place.at[1]) * jet.first[1];
            if moved.length() <= self.coincidence {
                break;
            }
            work.newton += 1;
            place.at = next;
        }
        best
    }

    /// The point of a place with its derivatives, from inside its part.
    fn jet(&self, place: &Place) -> Jet {
        Jet::at(self.definition, self.parameters(place), [0, 1].map(|k| place.at[k] >= place.part[k].1))
    }

    fn parameters(&self, place: &Place) -> [f64; 2] {
        [0, 1].map(|k| self.tracks[k].wrap(place.at[k]))
    }

    /// Whether the way to the query is perpendicular to every direction in which the point may move. One in which it stands still is none.
    fn is_perpendicular(&self, jet: &Jet, r: DVec3, distance: f64, held: [bool; 2]) -> bool {
        (0..2).all(|k| {
            let speed = jet.first[k].length();
            held[k] || jet.first[k].dot(r).abs() <= self.tolerances.perpendicularity * speed * distance
        })
    }

    /// Goes over to the smooth range beyond a break at which the place is held, where it leads downhill from there, too; whether it did.
    fn cross(&self, place: &mut Place, jet: &Jet, r: DVec3, work: &mut Work) -> bool {
        for k in 0..2 {
            if !is_held(place, k, jet.first[k].dot(r)) {
                continue;
            }
            let above = place.at[k] >= place.part[k].1;
            let Some((at, part)) = self.tracks[k].beyond(place.at[k], above) else { continue };
            let mut other = *place;
            (other.at[k], other.part[k]) = (at, part);
            let slope = self.jet(&other).first[k].dot(r);
            work.evaluations += 1;
            if (above && slope < 0.0) || (!above && slope > 0.0) {
                *place = other;
                return true;
            }
        }
        false
    }
}

/// Whether a place at a border of its part would leave it downhill.
fn is_held(place: &Place, k: usize, slope: f64) -> bool {
    let (from, to) = place.part[k];
    (place.at[k] <= from && slope > 0.0) || (place.at[k] >= to && slope < 0.0)
}

/// A step of Newton's method for the directions that are not held. Where the second derivatives lead uphill, they are left out.
fn step(jet: &Jet, r: DVec3, held: [bool; 2]) -> [f64; 2] {
    let [du, dv] = jet.first;
    let slope = [r.dot(du), r.dot(dv)];
    let (uu, uv, vv) = (du.length_squared(), du.dot(dv), dv.length_squared());
    let bend = [0, 1, 2].map(|k| r.dot(jet.second[k]));
    let one = |k: usize, first: f64, bend: f64| {
        let second = first + bend;
        let second = if second > 0.0 { second } else { first };
        if second > 0.0 { -slope[k] / second } else { 0.0 }
    };
    match held {
        [true, true] => [0.0; 2],
        [true, false] => [0.0, one(1, vv, bend[2])],
        [false, true] => [one(0, uu, bend[0]), 0.0],
        [false, false] => solve([uu + bend[0], uv + bend[1], vv + bend[2]], slope, uu * vv)
            .or_else(|| solve([uu, uv, vv], slope, uu * vv))
            .unwrap_or_else(|| [one(0, uu, bend[0]), one(1, vv, bend[2])]),
    }
}

/// The solution of a symmetric positive system; none where it is not positive, or too nearly singular to be of use.
fn solve([a, b, c]: [f64; 3], slope: [f64; 2], scale: f64) -> Option<[f64; 2]> {
    let determinant = a * c - b * b;
    (a > 0.0 && determinant > 1e-12 * scale)
        .then(|| [(b * slope[1] - c * slope[0]) / determinant, (b * slope[0] - a * slope[1]) / determinant])
}
