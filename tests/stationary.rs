//! All stationary points: known cases, counts that topology fixes, dense sampling, the feet of `project`, continua and hostile input.
//!
//! Two oracles share nothing with the search. On a curve minima and maxima alternate, ends included, and a dense sampling has as many. On a surface the
//! minima less the saddles plus the maxima are Euler's characteristic, where points of the edge count from which the distance does not fall into the surface
//! (Morse theory): 1 for a patch, 2 for a sphere, 0 for a torus or a tube.

mod common;

#[path = "stationary/continua.rs"]
mod continua;
#[path = "stationary/counts.rs"]
mod counts;
#[path = "stationary/feet.rs"]
mod feet;
#[path = "stationary/hostile.rs"]
mod hostile;
#[path = "stationary/known.rs"]
mod known;
#[path = "stationary/newton.rs"]
mod newton;

use perpend::{Certainty, DVec3, Definition, EntityId, Extremum, Model, StationaryOptions, StationaryPoints};

/// A model of one entity.
struct One {
    model: Model,
    id: EntityId,
}

impl One {
    fn new(definition: impl Into<Definition>) -> Self {
        let mut model = Model::new();
        let id = model.insert("", definition.into()).expect("valid");
        Self { model, id }
    }

    fn stationary(&self, p: DVec3) -> StationaryPoints {
        self.model.stationary_points(self.id, p, &StationaryOptions::default()).expect("finite")
    }

    fn size(&self) -> f64 {
        self.model.size()
    }
}

/// Minima less saddles plus maxima, of the points from which the distance does not fall into the entity.
fn characteristic(found: &StationaryPoints) -> i32 {
    let counted = found.points.iter().filter(|point| !point.descends_inward);
    counted.map(|point| if point.kind == Some(Extremum::Saddle) { -1 } else { 1 }).sum()
}

/// How many minima, saddles and maxima there are.
fn census(found: &StationaryPoints) -> [usize; 3] {
    [Extremum::Minimum, Extremum::Saddle, Extremum::Maximum]
        .map(|kind| found.points.iter().filter(|point| point.kind == Some(kind)).count())
}

/// Whether every point is proven, nothing was left, and the work bound was not met.
fn is_decided(found: &StationaryPoints) -> bool {
    found.complete && found.continua.is_empty() && found.points.iter().all(|point| point.certainty == Certainty::One)
}
