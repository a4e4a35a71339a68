//! Shapes as they are made, with the class with which they enter.

use perpend::Model;

use super::case::{Case, Tally, nearly_all};
use super::probes::{probes, special};
use super::shapes::{CLASSES, Standing, shape};
use crate::common::exact::Exact;
use crate::common::random::Random;
use crate::common::shape::Shape;

/// The model of a shape as it is made.
fn entered(exact: &Exact) -> Model {
    let mut model = Model::new();
    model.insert("made", exact.made().0).expect("valid");
    model
}

fn asked(seed: u64, rounds: usize, standing: impl Fn(&mut Random) -> Standing) {
    let mut random = Random::new(seed);
    let mut tally = Tally::default();
    for round in 0..rounds {
        for class in CLASSES {
            let standing = standing(&mut random);
            let exact = shape(&mut random, class, standing);
            let case = Case::new(&exact, format!("round {round}, {class}, {standing:?}"), entered(&exact));
            let special = special(&exact, &mut random);
            case.ask(&probes(&special, &Shape::of(&exact.made().0), 60, &mut random), &mut tally);
        }
    }
    tally.settle(nearly_all);
}

#[test]
fn shapes_at_the_origin_are_answered_to_the_last_digits() {
    asked(41_001, 12, |_| Standing::WORLD);
}

#[test]
fn shapes_of_every_size_in_every_place_are_answered_to_the_last_digits() {
    asked(41_002, 25, Standing::random);
}

#[test]
fn shapes_from_1e_minus_60_to_1e60_are_answered_to_the_last_digits() {
    asked(41_003, 12, |random| {
        let scale = random.pick(&[1e-60, 1e-30, 1e-20, 1e-10, 1e10, 1e20, 1e30, 1e60]);
        Standing { scale, offset: random.pick(&[0.0, scale, 1e3 * scale]), upright: random.chance(0.5) }
    });
}
