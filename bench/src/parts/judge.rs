//! What makes the answer of a whole model wrong, its bound false, or its proof incomplete: every face that could be nearer is asked alone.

use glam::DVec3;
use perpend::{EntityId, FootPoint, Model, Query, QueryError, QueryOptions, Scratch};
use perpend_bench::Faults;

/// The default gap, as a share of a face's size.
const GAP: f64 = 1e-9;

/// Judges the answers of a model to queries with the default gap.
pub(crate) struct Judge<'m> {
    model: &'m Model,
    /// The faces, which stand for their carriers and edges.
    faces: Vec<EntityId>,
    /// The gap of the largest face.
    gap: f64,
}

impl<'m> Judge<'m> {
    pub(crate) fn new(model: &'m Model) -> Self {
        let faces = model.entities().iter().filter(|entity| entity.trimming().is_some());
        let size = faces.clone().map(|face| face.prepared().bounds().diagonal()).fold(0.0, f64::max);
        Self { model, faces: faces.map(|face| face.id()).collect(), gap: GAP * size }
    }

    /// How many faces there are.
    pub(crate) fn len(&self) -> usize {
        self.faces.len()
    }

    /// The distances of all faces, each asked alone, in ascending order.
    pub(crate) fn one_by_one(&self, p: DVec3) -> Result<Vec<(EntityId, f64)>, QueryError> {
        let query = Query::new(p, QueryOptions::default())?;
        let mut scratch = Scratch::default();
        let distance = |id: &EntityId| {
            let entity = self.model.entity(*id).expect("a face of the model");
            let foot = entity.prepared().project(&query, &mut scratch).expect("no distance is too far");
            (*id, foot.distance)
        };
        let mut all: Vec<(EntityId, f64)> = self.faces.iter().map(distance).collect();
        all.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
        Ok(all)
    }

    /// The faults of the foot that is said to lie `true_distance` away.
    pub(crate) fn faults(&self, p: DVec3, foot: &FootPoint, true_distance: f64) -> Faults {
        let rounding = self.rounding(p);
        Faults {
            wrong: u64::from(foot.distance > true_distance + self.gap + rounding),
            false_bounds: u64::from(foot.lower_bound > true_distance + rounding),
            open: u64::from(foot.gap() > self.gap + rounding),
        }
    }

    /// The fault of an answer that is missing, or should not be there.
    pub(crate) fn wrong() -> Faults {
        Faults { wrong: 1, ..Faults::default() }
    }

    /// How far distances may be apart without a fault.
    pub(crate) fn slack(&self, p: DVec3) -> f64 {
        self.gap + self.rounding(p)
    }

    fn rounding(&self, p: DVec3) -> f64 {
        32.0 * f64::EPSILON * (self.model.size() + p.abs().max_element())
    }
}
