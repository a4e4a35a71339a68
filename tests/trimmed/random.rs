//! Random faces that shrink: star-shaped outlines with and without holes, rational or not, on random carriers.

use std::sync::Arc;

use glam::{DVec2, dvec2};
use perpend::Definition;
use perpend::kernel::{TrimLoopData, Trimming, TrimmingData};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use super::case::Case;
use super::faces::{Face, star};
use crate::common::random::Random;
use crate::common::strategies::surface;

/// The same cases every time; the variables `PROPTEST_RNG_SEED` and `PROPTEST_CASES` ask for others.
fn config(cases: u32) -> ProptestConfig {
    let default = ProptestConfig::default();
    let rng_seed = if default.rng_seed == RngSeed::Random { RngSeed::Fixed(1) } else { default.rng_seed };
    let cases = if std::env::var_os("PROPTEST_CASES").is_some() { default.cases } else { cases };
    ProptestConfig { cases, failure_persistence: None, rng_seed, ..default }
}

/// A loop about a middle, in shares of the domain.
#[derive(Debug, Clone)]
struct Outline {
    middle: DVec2,
    radii: DVec2,
    degree: usize,
    shares: Vec<f64>,
    weights: Option<Vec<f64>>,
}

impl Outline {
    fn trim(&self, outer: bool, origin: DVec2, extent: DVec2) -> TrimLoopData {
        let (middle, radii) = (origin + self.middle * extent, self.radii * extent);
        star(outer, middle, radii, self.degree, &self.shares, self.weights.clone())
    }
}

fn outline(least: f64, most: f64) -> impl Strategy<Value = Outline> {
    (1..=3usize, 4..=9usize, -1.0..1.0f64).prop_flat_map(move |(degree, count, size)| {
        // sizes from a thousandth of the whole
        let size = if size < -0.8 { 1e-3 } else { least + (most - least) * size.abs() };
        let shares = prop::collection::vec(0.3..1.0f64, count);
        let weights = prop::option::of(prop::collection::vec(0.3..3.0f64, count));
        let places = (0.0..1.0f64, 0.0..1.0f64, 0.3..1.0f64);
        (shares, weights, places).prop_map(move |(shares, weights, (x, y, flat))| {
            let radii = dvec2(size, flat * size);
            let middle = radii + (DVec2::ONE - 2.0 * radii) * dvec2(x, y);
            Outline { middle, radii, degree, shares, weights }
        })
    })
}

fn face() -> impl Strategy<Value = (Definition, Vec<TrimLoopData>)> {
    let holes = prop::collection::vec(outline(0.05, 0.2), 0..=2);
    (surface(), outline(0.2, 0.5), holes).prop_filter_map("a face has points", |(shape, outer, holes)| {
        let [[u0, u1], [v0, v1]] = [shape.domain(0), shape.domain(1)];
        let (origin, extent) = (dvec2(u0, v0), dvec2(u1 - u0, v1 - v0));
        let definition = shape.definition();
        let loops: Vec<TrimLoopData> = std::iter::once(outer.trim(true, origin, extent))
            .chain(holes.iter().map(|hole| hole.trim(false, origin, extent)))
            .collect();
        Some((definition, loops))
    })
}

proptest! {
    #![proptest_config(config(120))]

    /// Points of all kinds about a random face.
    #[test]
    fn no_point_of_a_random_face_is_nearer((definition, loops) in face(), seed in 0..1_000_000u64) {
        let Definition::NurbsSurface(surface) = definition else { unreachable!("the strategy makes surfaces") };
        let data = TrimmingData { reversed: false, tolerance: 1e-9, loops };
        let (trimming, _) = Trimming::enter(data, &surface).expect("closed loops inside the domain");
        let face = Face { name: "random".to_owned(), surface, trimming: Arc::new(trimming), special: Vec::new() };
        let case = Case::new(face);
        let points = case.hard_points(15, &mut Random::new(seed));
        let faults = case.faults(&points);
        prop_assert!(faults.is_empty(), "{} faults: {}", faults.len(), faults[0]);
    }
}
