//! The oracle of trimmed faces against distances in closed form, and its outline against regions that inequalities tell.

use glam::{DVec2, DVec3, dvec2, dvec3};

use super::faces::{self, Face};
use crate::common::face_oracle::FaceOracle;
use crate::common::outline::{Outline, Verdict};
use crate::common::random::Random;

fn oracle(face: &Face) -> FaceOracle {
    FaceOracle::new(&face.surface, &face.trimming)
}

/// Fails where the oracle's distance is not the true one to 1e-9, or lies below it by more than rounding.
#[track_caller]
fn meets(oracle: &FaceOracle, p: DVec3, truth: f64) {
    let found = oracle.nearest(p);
    let rounding = 1e-13 * (10.0 + p.length());
    let excess = found.distance - truth;
    assert!(excess >= -rounding && excess <= 1e-9 + rounding, "{p:?}: true distance {truth:e}, found {found:?}");
}

/// The distance in the plane to `[0, 10] × [0, 6]` less an open disc of radius 1.5 about (4, 3).
fn in_holed_rectangle(q: DVec2) -> f64 {
    let beyond = (q - q.clamp(DVec2::ZERO, dvec2(10.0, 6.0))).length();
    beyond.max(1.5 - q.distance(dvec2(4.0, 3.0)))
}

#[test]
fn it_finds_distances_of_a_plate_with_a_hole() {
    let face = faces::plate_with_a_round_hole();
    let oracle = oracle(&face);
    let mut random = Random::new(1);
    for _ in 0..300 {
        let p = dvec3(5.0, 3.0, 0.0) + 8.0 * random.in_cube();
        meets(&oracle, p, in_holed_rectangle(p.truncate()).hypot(p.z));
    }
    for p in &face.special {
        meets(&oracle, *p, in_holed_rectangle(p.truncate()).hypot(p.z));
    }
}

#[test]
fn it_finds_distances_of_three_quarters_of_a_cylinder() {
    let oracle = oracle(&faces::three_quarters());
    let mut random = Random::new(2);
    for _ in 0..300 {
        let p = dvec3(0.0, 0.0, 1.0) + 3.0 * random.in_cube();
        let above = (p.z - p.z.clamp(0.0, 2.0)).abs();
        let flat = p.truncate();
        let is_in_gap = flat.x > 0.0 && flat.y > 0.0;
        let across =
            if is_in_gap { flat.distance(DVec2::X).min(flat.distance(DVec2::Y)) } else { (flat.length() - 1.0).abs() };
        meets(&oracle, p, above.hypot(across));
    }
}

#[test]
fn it_finds_distances_of_a_cap() {
    // latitudes from 45° to the pole of a sphere of radius 2
    let oracle = oracle(&faces::cap());
    let mut random = Random::new(3);
    for _ in 0..300 {
        let p = 4.0 * random.in_cube();
        let flat = DVec2::new(p.truncate().length(), p.z);
        let rim = DVec2::splat(2.0_f64.sqrt());
        let truth = if p.z >= flat.x { (p.length() - 2.0).abs() } else { flat.distance(rim) };
        meets(&oracle, p, truth);
    }
}

#[test]
fn its_outline_tells_inside_from_outside_to_the_last_digits() {
    let face = faces::plate_with_a_round_hole();
    let outline = Outline::new(&face.surface, face.trimming.loops());
    let mut random = Random::new(4);
    for _ in 0..2_000 {
        let angle = random.between(0.0, std::f64::consts::TAU);
        let way = DVec2::from_angle(angle);
        let off = random.sign() * random.power(-13.0, -0.5);
        let at = dvec2(4.0, 3.0) + (1.5 + off) * way;
        let expected = if off < 0.0 { Verdict::Outside } else { Verdict::Inside };
        assert_eq!(outline.side(at), expected, "{off:e} from the circle");
        let far = outline.distance(at);
        let (low, high) = (off.abs() / 10.0, off.abs() / 6.0);
        assert!(far >= 0.99 * low - 1e-15 && far <= 1.01 * high + 1e-15, "{off:e} from the circle: {far:e}");
    }
}

#[test]
fn its_outline_and_the_kernel_agree_where_both_are_certain() {
    use perpend::kernel::Side;
    let mut random = Random::new(5);
    for face in faces::all() {
        let outline = Outline::new(&face.surface, face.trimming.loops());
        let (low, high) = outline.bounds();
        let (low, high) = (low - 0.05 * (high - low), high + 0.05 * (high - low));
        let mut seen = [0; 2];
        for _ in 0..400 {
            let at = dvec2(random.between(low.x, high.x), random.between(low.y, high.y));
            let kernels = face.trimming.region().side(at);
            match outline.side(at) {
                Verdict::Inside => {
                    assert_eq!(kernels, Side::Inside, "{} at {at:?}", face.name);
                    seen[0] += 1;
                }
                Verdict::Outside => {
                    assert_eq!(kernels, Side::Outside, "{} at {at:?}", face.name);
                    seen[1] += 1;
                }
                Verdict::Beside => {}
            }
        }
        assert!(seen[1] > 0 && (seen[0] > 0 || face.name == "sliver"), "{}: {seen:?}", face.name);
    }
}
