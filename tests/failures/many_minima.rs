//! More minima than a grid of starts can tell apart.

use std::f64::consts::TAU;

use glam::{DVec3, dvec3};

use super::case::{Case, close, u, uv};
use super::shapes::{PITCH, bezier, curve, eggcrate, flat, plain_surface, thread, weighted};
use crate::common::random::Random;

/// Conway #594, #642, #648: on a thread of seven turns an 8 × 8 grid of starts led to the neighbouring turn; most points of the ribbon
/// came back from elsewhere, some a whole turn off.
#[test]
fn every_point_of_a_thread_is_found_on_its_own_turn() {
    for (turns, count) in [(7, 4_000), (30, 4_000)] {
        let case = Case::new(thread(turns));
        assert_eq!(case.shape.domain(1), [0.0, 72.0]);
        let mut random = Random::new(594);
        for _ in 0..count {
            let (across, along) = (random.unit(), random.between(0.0, 72.0));
            let p = case.at(across, along);
            let foot = case.foot(p);
            assert!(foot.distance <= 1e-12 * case.size(), "{turns} turns, v = {along}: {foot:?}");
            let (u, v) = uv(&foot);
            // 1e-12 of the size over the least speed in u, 0.05, and in v
            close(u, across, 1e-10);
            close(v, along, 1e-10);
        }
    }
}

/// As above, from between the turns: the nearer of two turns is 0.4 pitches off, the other 0.6.
#[test]
fn between_two_turns_of_a_thread_the_nearer_is_found() {
    let case = Case::new(thread(30));
    let mut random = Random::new(648);
    for _ in 0..150 {
        let (across, along) = (random.between(0.2, 0.8), random.between(5.0, 67.0));
        let up = random.sign();
        let p = case.at(across, along) + up * 0.4 * PITCH * DVec3::Z;
        let foot = case.foot_by_oracle(p);
        assert!(foot.distance <= 0.4 * PITCH, "{foot:?}");
        // the turn is the one that the point was taken from: a whole turn is 2.4 in v
        close(uv(&foot).1, along, 0.5);
    }
}

/// Oblikovati #1608: a fixed 16 × 16 grid was finer than no span of a larger surface, and feet fell on other bumps.
#[test]
fn a_surface_of_33_by_33_spans_is_inverted_at_100_of_its_points() {
    let case = Case::new(eggcrate());
    assert_eq!([case.shape.spans(0).len(), case.shape.spans(1).len()], [33, 33]);
    let mut random = Random::new(1608);
    for _ in 0..100 {
        let (a, b) = (random.between(0.0, 33.0), random.between(0.0, 33.0));
        let foot = case.foot(case.at(a, b));
        assert!(foot.distance <= 1e-12 * case.size(), "({a}, {b}): {foot:?}");
        let (u, v) = uv(&foot);
        close(u, a, 1e-9);
        close(v, b, 1e-9);
    }
    for _ in 0..100 {
        case.foot_by_oracle(dvec3(random.between(-5.0, 40.0), random.between(-5.0, 40.0), random.between(-4.0, 4.0)));
    }
}

/// Nanospline #49: the inverse of a rational patch at one of its own points missed by 0.4.
#[test]
fn points_of_a_rational_patch_are_found_on_it() {
    for spread in [2.0, 30.0, 1e3] {
        let case = Case::new(weighted(spread));
        let mut random = Random::new(49);
        for _ in 0..300 {
            let foot = case.foot(case.at(random.between(0.0, 2.0), random.between(0.0, 2.0)));
            assert!(foot.distance <= 1e-12 * case.size(), "weights within {spread}: {foot:?}");
        }
    }
}

/// Oblikovati #1401: steps in u and in v by themselves, blind to the angle between the tangents, never came to rest.
#[test]
fn a_skewed_or_folded_parametrisation_leads_to_the_same_feet() {
    let bump = |i: usize, j: usize| ((3 * i + 5 * j) % 4) as f64 * 0.5;
    let skewed = plain_surface(3, 6, 6, |i, j| dvec3(i as f64 + 20.0 * j as f64, j as f64, bump(i, j)));
    // rows that run forwards, back and forwards again
    let fold = [0.0, 3.0, 1.0, 4.0, 2.0, 5.0];
    let folded = plain_surface(3, 6, 6, |i, j| dvec3(fold[i], j as f64, bump(i, j)));
    for case in [Case::new(skewed), Case::new(folded)] {
        let mut random = Random::new(1401);
        for _ in 0..80 {
            let at = case.at(random.between(0.0, 3.0), random.between(0.0, 3.0));
            for share in [1e-3, 0.1, 1.0] {
                case.foot_by_oracle(at + share * case.size() * random.direction());
            }
        }
    }
}

/// FreeCAD PR 3796: the first extremum found was reported, not the nearest.
#[test]
fn of_several_local_minima_the_nearest_is_found() {
    // a spiral of eight turns, about one unit apart: from near its middle every turn has its own minimum
    let point = |k: usize| {
        let angle = TAU * k as f64 / 12.0;
        dvec3(angle.cos(), angle.sin(), 0.0) * (1.0 + k as f64 / 12.0)
    };
    let case = Case::new(curve(3, (0..96).map(point).collect()));
    let mut random = Random::new(3796);
    for _ in 0..200 {
        let foot = case.foot_by_oracle(9.0 * random.in_cube());
        assert!(foot.distance <= 13.0);
    }
    // a comb of four teeth (an M of Bézier pieces): the nearest tooth is neither the first nor the last
    let teeth =
        [[0.0, 0.0], [0.0, 8.0], [2.0, -8.0], [2.0, 0.0], [2.0, 8.0], [4.0, 9.0], [4.0, -9.0], [6.0, 8.0], [6.0, 0.0]];
    let case = Case::new(curve(3, flat(&teeth)));
    let mut random = Random::new(379);
    for _ in 0..200 {
        case.foot_by_oracle(dvec3(random.between(-1.0, 7.0), random.between(-4.0, 6.0), random.between(-0.5, 0.5)));
    }
}

/// BOSL #50, with its numbers: a cubic's nearest point to the origin was given at 2.41428, another is at 1.91359.
#[test]
fn the_cubic_with_two_minima_gives_the_lesser() {
    let points = [[3.98743, 5.29979], [-8.21663, -2.76544], [-5.4184, -5.00586], [8.26971, -0.0435725]];
    let case = Case::new(bezier(flat(&points)));
    let foot = case.foot_by_oracle(DVec3::ZERO);
    // to the digits of the report
    close(foot.distance, 1.91359, 5e-6);
    close(u(&foot), 0.183_874, 5e-7);
}

/// Kratos PR 13564: from far away Newton's method walks the wrong way.
#[test]
fn far_points_find_the_true_foot() {
    for (name, case) in super::shapes::gallery() {
        let mut random = Random::new(13_564);
        for share in [1e3, 1e3, 1e6] {
            let p = share * case.size() * random.direction();
            let foot = if share == 1e3 {
                case.foot_by_oracle(p)
            } else {
                // farther than any gap of the size can tell: the bounds agree to 12 digits
                let foot = case.model.project(case.id, p).expect("a good query");
                let real = case.oracle_distance(p);
                assert!(
                    foot.lower_bound <= real * (1.0 + 4.0 * f64::EPSILON) && foot.gap() <= 1e-12 * real,
                    "{foot:?}"
                );
                close(foot.distance, real, 1e-14 * real);
                foot
            };
            // the nearest of a grid of points is never nearer
            for (u, v, point) in case.grid(8) {
                let there = p.distance(point);
                assert!(
                    foot.lower_bound <= there * (1.0 + 2.0 * f64::EPSILON),
                    "{name}: {foot:?}, ({u}, {v}) is nearer"
                );
            }
        }
    }
}
