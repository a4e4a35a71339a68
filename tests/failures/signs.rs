//! Normals, and on which side of a surface a point lies.

use std::f64::consts::TAU;

use glam::{DVec3, dvec3};

use super::case::Case;
use super::shapes::{circle, cylinder, eggcrate, plane, polyline, sphere, torus, twisted, walls};
use crate::common::random::Random;

/// trimesh #73, parry #379: the sign was wrong on one side of a surface. Positive is the side of `S_u × S_v`.
#[test]
fn the_sign_is_that_of_the_side() {
    let mut random = Random::new(73);
    for case in [Case::new(plane((-1.0, 1.0), (-1.0, 1.0))), Case::new(twisted(0.4)), Case::new(eggcrate())] {
        for _ in 0..60 {
            let share = |random: &mut Random| random.between(0.05, 0.95);
            let (u, v) = (case.share(0, share(&mut random)), case.share(1, share(&mut random)));
            let (on, normal) = (case.at(u, v), case.normal(u, v));
            for off in [0.01, 1e-4, 1e-8] {
                for side in [1.0, -1.0] {
                    let foot = case.foot(on + side * off * normal);
                    let found = foot.normal.expect("a regular foot");
                    assert!(found.distance(normal) < 1e-6, "{foot:?}, not {normal}");
                    assert!((found.length() - 1.0).abs() <= 4.0 * f64::EPSILON);
                    assert_eq!(foot.signed_distance, Some(side * foot.distance), "{foot:?}");
                }
            }
        }
    }
}

/// trimesh #75, #85: the same for closed shapes, inside and out. All of these have outward or all inward normals.
#[test]
fn closed_shapes_have_one_sign_inside_and_one_outside() {
    let ball = Case::new(sphere(1.0));
    let can = Case::new(cylinder(1.0, (-1.0, 1.0), TAU));
    let ring = Case::new(torus(3.0, 1.0));
    let inside = |case: &Case, p: DVec3| case.foot(p).signed_distance.map(f64::signum);
    let outward = [&ball, &can, &ring].map(|case| case.normal(case.share(0, 0.3), case.share(1, 0.4)));
    let ats = [&ball, &can, &ring].map(|case| case.at(case.share(0, 0.3), case.share(1, 0.4)));
    let axes = [ats[0], dvec3(ats[1].x, ats[1].y, 0.0), ats[2] - 3.0 * dvec3(ats[2].x, ats[2].y, 0.0).normalize()];
    // the sign outside, from one normal each
    let signs: Vec<f64> = (0..3).map(|k| outward[k].dot(axes[k]).signum()).collect();
    let mut random = Random::new(85);
    for _ in 0..100 {
        let d = random.direction();
        let about = dvec3(d.x, d.y, 0.0).normalize();
        let tube = d.x * about + d.z * DVec3::Z;
        for (share, side) in [(0.3, -1.0), (0.999, -1.0), (1.001, 1.0), (1.6, 1.0)] {
            assert_eq!(inside(&ball, share * d), Some(side * signs[0]), "{d}, {share}");
            assert_eq!(inside(&can, share * about + 0.5 * d.z * DVec3::Z), Some(side * signs[1]), "{d}, {share}");
            let p = 3.0 * about + share * tube.normalize();
            assert_eq!(inside(&ring, p), Some(side * signs[2]), "{d}, {share}");
        }
    }
}

/// CloudCompare #1976, three-mesh-bvh #704: beside the edge of a box the sign was that of the wall that happened to be asked, and flipped
/// from point to point. At a crease the mean of both normals decides.
#[test]
fn beside_a_crease_the_sign_is_that_of_both_walls() {
    let case = Case::new(walls());
    assert_eq!(case.normal(0.5, 0.5), -DVec3::Y, "the walls face outward");
    for (x, y) in [(1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)] {
        for (a, b) in [(1e-9, 1.0), (1.0, 1e-9), (0.5, 0.5), (1e-3, 1e-3), (2.0, 0.1), (1e-9, 3e-9)] {
            let p = dvec3(x * (1.0 + a), y * (1.0 + b), 0.25);
            let foot = case.foot_at(p, f64::hypot(p.x.abs() - 1.0, p.y.abs() - 1.0));
            assert_eq!(foot.point, dvec3(x, y, 0.25), "{foot:?}");
            let mean = dvec3(x, y, 0.0).normalize();
            assert!(foot.normal.is_some_and(|n| n.distance(mean) <= 1e-15), "{foot:?}");
            assert_eq!(foot.signed_distance, Some(foot.distance), "{foot:?}");
        }
        // inside no point has its foot on the edge; near it the sign is that of the inside
        for (a, b) in [(1e-9, 0.3), (0.3, 1e-9), (0.1, 0.2), (1e-3, 1e-6)] {
            let p = dvec3(x * (1.0 - a), y * (1.0 - b), 0.25);
            let foot = case.foot_at(p, 1.0 - p.x.abs().max(p.y.abs()));
            assert_eq!(foot.signed_distance, Some(-foot.distance), "{foot:?}");
        }
    }
}

/// CloudCompare PR 1005: beyond the border of a plane, in the plane itself, the distance was 0.
#[test]
fn beside_a_plane_and_in_it_the_distance_is_not_zero() {
    let case = Case::new(plane((-1.0, 1.0), (-1.0, 1.0)));
    for (p, distance) in [(dvec3(3.0, 0.0, 0.0), 2.0), (dvec3(4.0, 5.0, 0.0), 5.0), (dvec3(0.0, -1.5, 0.0), 0.5)] {
        let foot = case.foot_at(p, distance);
        assert_eq!(foot.signed_distance.map(f64::abs), Some(distance));
    }
    // and a hair above or below, the sign is that of the side
    for z in [1e-3, -1e-3, 1e-9, -1e-9] {
        let foot = case.foot(dvec3(3.0, 0.0, z));
        assert_eq!(foot.signed_distance, Some(foot.distance.copysign(z)), "{foot:?}");
    }
}

/// A curve has no side.
#[test]
fn curves_have_neither_normal_nor_sign() {
    for case in [Case::new(circle(1.0)), Case::new(polyline(&[DVec3::ZERO, DVec3::X]))] {
        let foot = case.foot(dvec3(0.3, 0.2, 0.5));
        assert_eq!((foot.normal, foot.signed_distance), (None, None));
    }
}

/// At seams the normal is that of the surface, not of a border.
#[test]
fn a_seam_has_the_normal_of_its_surroundings() {
    let ball = Case::new(sphere(2.0));
    let ring = Case::new(torus(3.0, 1.0));
    for (case, p) in [(&ball, dvec3(3.0, 0.0, 0.5)), (&ring, dvec3(5.0, 0.0, 0.0)), (&ring, dvec3(0.0, 6.0, 0.0))] {
        let foot = case.foot(p);
        let straight = (p - foot.point).normalize();
        let normal = foot.normal.expect("a regular foot");
        assert!(1.0 - normal.dot(straight).abs() <= 1e-12, "{foot:?}");
        assert_eq!(foot.signed_distance, Some(foot.distance.copysign(normal.dot(straight))));
    }
}
