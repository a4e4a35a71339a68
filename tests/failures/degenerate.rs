//! Derivatives that vanish or are parallel: where Newton's matrix has no inverse.

use std::f64::consts::FRAC_1_SQRT_2;

use glam::{DVec3, dvec3};
use perpend::{Multiplicity, NurbsSurface, Place};

use super::case::{Case, close, uv};
use super::shapes::{bezier, cone, flat, plain_surface, sphere, twisted};
use crate::common::random::Random;

/// A biquadratic bump over the unit square, 1 high, its edges at z = 0.
fn bump() -> NurbsSurface {
    plain_surface(2, 3, 3, |i, j| dvec3(i as f64 / 2.0, j as f64 / 2.0, if (i, j) == (1, 1) { 4.0 } else { 0.0 }))
}

/// truck: from under a bump Newton's method left the square and reported a point outside the surface, or stayed on its start at the
/// top, which is a maximum. The edges' midpoints are nearest.
#[test]
fn under_a_bump_the_midpoints_of_the_edges_are_nearest() {
    let case = Case::new(bump());
    let p = dvec3(0.5, 0.5, -1.0);
    let foot = case.foot_at(p, 1.25_f64.sqrt());
    assert_eq!(foot.place, Place::Edge, "{foot:?}");
    let ties = case.ties(p);
    assert!(ties.complete && ties.continua.is_empty());
    assert_eq!(ties.nearest.multiplicity, Multiplicity::Tied);
    let feet: Vec<(f64, f64)> = ties.points.iter().map(uv).collect();
    assert_eq!(feet.len(), 4, "{feet:?}");
    for ((u, v), expected) in feet.iter().zip([(0.0, 0.5), (0.5, 0.0), (0.5, 1.0), (1.0, 0.5)]) {
        close(*u, expected.0, 1e-9);
        close(*v, expected.1, 1e-9);
    }
    for foot in &ties.points {
        close(foot.distance, 1.25_f64.sqrt(), 1e-12);
    }
    // from above the top is nearest, and the start at the saddle-like corners does not matter
    close(uv(&case.foot_at(dvec3(0.5, 0.5, 3.0), 2.0)).0, 0.5, 1e-9);
}

/// foxtrot PR 7: a start at a stationary point, or on an edge without length, has a singular matrix, and the answer was none.
#[test]
fn collapsed_and_resting_edges_are_no_obstacle() {
    let lift = |i: usize, j: usize| 0.4 * ((2 * i + 3 * j) % 5) as f64;
    // the edge u = 0 is one point
    let collapsed = plain_surface(3, 4, 4, |i, j| {
        dvec3(i as f64, i as f64 * (j as f64 - 1.5), if i == 0 { 0.0 } else { lift(i, j) })
    });
    // its first two rows are one: S_u = 0 along the whole edge u = 0
    let resting =
        plain_surface(3, 4, 4, |i, j| dvec3([0.0, 0.0, 1.0, 2.0][i], j as f64, if i < 2 { 0.0 } else { lift(i, j) }));
    // all rows run through their first point twice
    let both = plain_surface(2, 3, 3, |i, j| dvec3([0.0, 0.0, 2.0][i], [0.0, 0.0, 2.0][j], (i * j) as f64 / 4.0));
    for surface in [collapsed, resting, both] {
        let case = Case::new(surface);
        let edge: Vec<DVec3> = case.grid(4).into_iter().map(|(_, _, point)| point).collect();
        let mut random = Random::new(7);
        for p in edge {
            for share in [0.0, 1e-9, 1e-3, 0.3, 5.0] {
                case.foot_by_oracle(p + share * case.size() * random.direction());
            }
        }
    }
    // a straight cubic whose speed vanishes at both ends
    let case = Case::new(bezier(flat(&[[0.0, 0.0], [0.0, 0.0], [3.0, 0.0], [3.0, 0.0]])));
    for x in [0.0, 1e-9, 1e-4, 0.7, 1.5, 3.0 - 1e-9, 3.0] {
        case.foot_at(dvec3(x, 0.5, 0.0), 0.5);
    }
    case.foot_at(dvec3(-3.0, 4.0, 0.0), 5.0);
}

/// brepkit PR 206: a fixed threshold on the determinant blew up at the pole of a sphere and the apex of a cone; how, depended on the scale.
#[test]
fn poles_and_apexes_answer_at_every_scale() {
    for scale in [1e-3, 1.0, 1e3, 1e6] {
        let ball = Case::new(sphere(scale));
        for side in [1.0, -1.0] {
            // on the axis the pole is the foot, from outside, on it, and inside
            for z in [3.0, 1.0 + 1e-9, 1.0, 0.9, 0.5] {
                let foot = ball.foot_at(scale * side * z * DVec3::Z, scale * (z - 1.0).abs());
                assert_eq!((foot.place, foot.normal), (Place::Pole, None), "scale {scale}, z = {z}: {foot:?}");
                assert_eq!(foot.signed_distance, None);
                assert_eq!(uv(&foot).0, if side > 0.0 { 1.0 } else { 0.0 });
            }
            // beside the axis it is not
            for tilt in [1e-12, 1e-9, 1e-6, 1e-3_f64] {
                for (cos, sin) in [(1.0, 0.0), (0.6, 0.8), (-FRAC_1_SQRT_2, FRAC_1_SQRT_2)] {
                    let p = 1.5 * scale * dvec3(tilt.sin() * cos, tilt.sin() * sin, side * tilt.cos());
                    let foot = ball.foot_at(p, 0.5 * scale);
                    // nearer to the axis, the pole itself is as near as the gap can tell
                    let settled = tilt < 1e-4 || foot.point.distance(p / 1.5) <= 1e-9 * scale;
                    assert!(settled, "scale {scale}, tilt {tilt}: {foot:?}");
                }
            }
        }
        // the apex at (0, 0, 2), half angle with tangent 1/2
        let case = Case::new(cone(scale, 2.0 * scale));
        for p in [dvec3(0.0, 0.0, 5.0), dvec3(0.0, 0.0, 2.0), dvec3(0.1, 0.2, 4.0), dvec3(-0.5, 0.0, 2.3)] {
            let foot = case.foot_at(scale * p, scale * p.distance(dvec3(0.0, 0.0, 2.0)));
            assert_eq!((foot.place, foot.normal), (Place::Pole, None), "scale {scale}: {foot:?}");
        }
        // just outside the cone of normals of the apex, the foot is on the flank: 1 along and 1 off a ruling
        let (along, off) = (dvec3(1.0, 0.0, -2.0) / 5.0_f64.sqrt(), dvec3(2.0, 0.0, 1.0) / 5.0_f64.sqrt());
        for step in [1e-6, 1e-3, 1.0] {
            let foot = case.foot_at(scale * (2.0 * DVec3::Z + step * along + off), scale);
            assert_eq!(foot.place, Place::Seam, "the flank over xdir: {foot:?}");
            close(uv(&foot).0, 1.0 - step / 5.0_f64.sqrt(), 1e-9);
        }
    }
}

/// imodel-native PR 697: on a bilinear patch with a slight twist the refinement of the foot did not converge.
#[test]
fn a_slightly_twisted_patch_converges() {
    for lift in [1e-12, 1e-9, 1e-6, 1e-3, 0.1, 1.0, 10.0] {
        let case = Case::new(twisted(lift));
        let mut random = Random::new(697);
        for _ in 0..40 {
            let (a, b) = (random.unit(), random.unit());
            let on = case.at(a, b);
            let foot = case.foot_at(on, 0.0);
            close(uv(&foot).0, a, 1e-11 * (1.0 + lift));
            close(uv(&foot).1, b, 1e-11 * (1.0 + lift));
            case.foot_by_oracle(on + random.between(-2.0, 2.0) * case.normal(a, b));
            case.foot_by_oracle(3.0 * random.in_cube());
        }
        // the middle of an edge and the corners, from beyond them
        for p in [dvec3(0.5, -1.0, 0.2), dvec3(2.0, 0.5, lift), dvec3(2.0, 2.0, 0.0), dvec3(-1.0, -1.0, 1.0)] {
            case.foot_by_oracle(p);
        }
    }
}

/// Clothoid-like and loop-shaped nets: control points that coincide in runs make higher derivatives vanish too.
#[test]
fn runs_of_coincident_control_points_are_no_obstacle() {
    let nets = [
        flat(&[[0.0, 0.0], [0.0, 0.0], [0.0, 0.0], [4.0, 1.0], [5.0, 3.0]]),
        flat(&[[0.0, 0.0], [2.0, 2.0], [2.0, 2.0], [2.0, 2.0], [4.0, 0.0]]),
        flat(&[[1.0, 1.0], [1.0, 1.0], [3.0, -1.0], [3.0, -1.0]]),
        flat(&[[0.0, 0.0], [1.0, 0.0], [0.0, 0.0], [1.0, 0.0]]),
    ];
    for net in nets {
        let case = Case::new(bezier(net));
        let mut random = Random::new(3);
        for (_, _, on) in case.grid(10) {
            for share in [0.0, 1e-10, 1e-6, 1e-2, 1.0] {
                case.foot_by_oracle(on + share * case.size() * random.direction());
            }
        }
    }
}
