//! Closed entities: where they begin and end at once.

use std::f64::consts::TAU;

use glam::{DVec3, dvec3};
use perpend::{Multiplicity, Place};

use super::case::{Case, close, u, uv};
use super::shapes::{circle, cylinder, sphere, torus};

/// A query on the seam must give one foot: the lower parameter, and no tie with the upper.
fn one_answer(case: &Case, p: DVec3, distance: f64, lower: [Option<f64>; 2]) {
    let foot = case.foot_at(p, distance);
    assert_eq!((foot.place, foot.multiplicity), (Place::Seam, Multiplicity::Unique), "{p}: {foot:?}");
    let found = [Some(foot.parameter.u()), foot.parameter.v()];
    for (found, expected) in found.into_iter().zip(lower) {
        assert!(expected.is_none() || found == expected, "{p}: {foot:?}");
    }
    let ties = case.ties(p);
    assert_eq!((ties.points.len(), ties.continua.len(), ties.complete), (1, 0, true), "{p}: {ties:?}");
    // the search for ties is the hierarchy's, the foot may be a closed form's: parameters differ by rounding
    let tie = ties.points[0].parameter;
    close(tie.u(), foot.parameter.u(), 1e-14);
    close(tie.v().unwrap_or(0.0), foot.parameter.v().unwrap_or(0.0), 1e-14);
}

/// Salome geom #12, #22: a point beside the seam vertex of a circle had "multiple solutions", the two ends of the domain.
#[test]
fn beside_the_seam_of_a_circle_there_is_one_foot() {
    for radius in [1e-3, 1.0, 250.0_f64] {
        let case = Case::new(circle(radius));
        for rho in [0.4, 1.0, 1.5, 100.0_f64] {
            for z in [0.0, 0.7] {
                let distance = radius * (rho - 1.0).abs().hypot(z);
                one_answer(&case, radius * dvec3(rho, 0.0, z), distance, [Some(0.0), None]);
            }
        }
    }
}

/// Salome geom #22: the same at the two seams of a torus, and on those of a cylinder and a sphere.
#[test]
fn beside_the_seam_of_a_surface_there_is_one_foot() {
    let ring = Case::new(torus(3.0, 1.0));
    // both seams at once; the seam of the tube alone, at 60 degrees; the seam of the azimuth alone, at 90 degrees of the tube
    one_answer(&ring, dvec3(5.0, 0.0, 0.0), 1.0, [Some(0.0), Some(0.0)]);
    one_answer(&ring, dvec3(4.0, 0.0, 0.0), 0.0, [Some(0.0), Some(0.0)]);
    one_answer(&ring, 5.0 * dvec3(0.5, 0.75_f64.sqrt(), 0.0), 1.0, [Some(0.0), None]);
    one_answer(&ring, dvec3(3.0, 0.0, 1.25), 0.25, [None, Some(0.0)]);
    let can = Case::new(cylinder(2.0, (0.0, 3.0), TAU));
    for rho in [0.5, 2.0, 7.0] {
        one_answer(&can, dvec3(rho, 0.0, 1.0), (rho - 2.0).abs(), [None, Some(0.0)]);
    }
    let ball = Case::new(sphere(1.0));
    one_answer(&ball, 2.0 * dvec3(0.8, 0.0, 0.6), 1.0, [None, Some(0.0)]);
}

/// iGeo #4: points near a seam were pulled onto it.
#[test]
fn beside_a_seam_feet_keep_their_own_parameters() {
    let ring = Case::new(circle(1.0));
    let can = Case::new(cylinder(1.0, (0.0, 3.0), TAU));
    for size in [1e-10, 1e-7, 1e-4, 0.1] {
        for angle in [size, -size] {
            let (sin, cos) = f64::sin_cos(angle);
            let foot = ring.foot_at(1.5 * dvec3(cos, sin, 0.0), 0.5);
            assert_eq!(foot.place, Place::Interior, "{angle}: {foot:?}");
            assert!(foot.point.distance(dvec3(cos, sin, 0.0)) <= 1e-14, "{angle}: {foot:?}");
            assert_eq!(u(&foot) < 0.5, angle > 0.0);
            let foot = can.foot_at(dvec3(1.5 * cos, 1.5 * sin, 2.0), 0.5);
            assert_eq!((foot.place, foot.multiplicity), (Place::Interior, Multiplicity::Unique), "{angle}: {foot:?}");
            assert_eq!(uv(&foot).1 < 0.5, angle > 0.0);
            close(foot.point.y, sin, 1e-14);
        }
    }
}
