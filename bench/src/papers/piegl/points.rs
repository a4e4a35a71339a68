//! Random points about an entity, the same in every run.

use glam::DVec3;
use perpend_kernel::{Definition, Direction};

/// Where the points lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Where {
    /// Within a hundredth of the size from the entity.
    Near,
    /// In a box three times the entity's; a flat side counts as a fifth of the longest.
    Around,
}

impl Where {
    pub(super) const ALL: [Self; 2] = [Self::Near, Self::Around];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Near => "near",
            Self::Around => "far",
        }
    }
}

/// A stream of points.
pub(super) struct Points<'a> {
    definition: &'a Definition,
    place: Where,
    state: u64,
}

impl<'a> Points<'a> {
    pub(super) fn new(definition: &'a Definition, place: Where) -> Self {
        Self { definition, place, state: 2008 }
    }

    /// A number in `[0, 1)`: SplitMix64.
    fn unit(&mut self) -> f64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn in_cube(&mut self) -> DVec3 {
        2.0 * DVec3::new(self.unit(), self.unit(), self.unit()) - 1.0
    }

    pub(super) fn next(&mut self) -> DVec3 {
        match self.place {
            Where::Around => {
                let bounds = self.definition.control_box();
                let extent = bounds.max - bounds.min;
                let sides = extent.max(DVec3::splat(0.2 * extent.max_element()));
                bounds.centre() + 1.5 * sides * self.in_cube()
            }
            Where::Near => {
                let within = |(first, last): (f64, f64), share: f64| first + (last - first) * share;
                let (s, t) = (self.unit(), self.unit());
                let on = match self.definition {
                    Definition::NurbsCurve(curve) => curve.point(within(curve.domain(), s)),
                    Definition::NurbsSurface(surface) => {
                        surface.point(within(surface.domain(Direction::U), s), within(surface.domain(Direction::V), t))
                    }
                };
                on + 0.01 * self.definition.size() * self.in_cube()
            }
        }
    }
}
