//! Curves of degree 1: their corners are no places for a derivative.

use glam::{DVec3, dvec3};
use perpend::{Multiplicity, Place};

use super::case::{Case, close, u};
use super::shapes::{flat, polyline};

/// OCCT bug 30199: on a curve of degree 1 the nearest points at corners were not found. A U of 4 by 3, its feet by hand.
#[test]
fn corners_of_a_polyline_are_feet() {
    let case = Case::new(polyline(&flat(&[[0.0, 3.0], [0.0, 0.0], [4.0, 0.0], [4.0, 3.0]])));
    let table = [
        // query, parameter, distance, place
        ([5.0, -1.0], 2.0, 2.0_f64.sqrt(), Place::Crease),
        ([4.5, -0.2], 2.0, 0.29_f64.sqrt(), Place::Crease),
        ([-3.0, -4.0], 1.0, 5.0, Place::Crease),
        ([3.75, 0.5], 2.0 + 0.5 / 3.0, 0.25, Place::Interior),
        ([3.0, 0.125], 1.75, 0.125, Place::Interior),
        ([4.0, 0.0], 2.0, 0.0, Place::Crease),
        ([4.0, 4.0], 3.0, 1.0, Place::End),
        ([-1.0, 5.0], 0.0, 5.0_f64.sqrt(), Place::End),
        ([2.0, 1.0], 1.5, 1.0, Place::Interior),
    ];
    for ([x, y], parameter, distance, place) in table {
        let foot = case.foot_at(dvec3(x, y, 0.0), distance);
        close(u(&foot), parameter, 1e-12);
        assert_eq!(foot.place, place, "({x}, {y}): {foot:?}");
        assert_eq!(foot.multiplicity, Multiplicity::Unique, "({x}, {y})");
    }
}

/// OCCT bug 30199, with own numbers of its kind: hundreds of units, corners that are no round numbers.
#[test]
fn corners_far_from_the_origin_are_feet() {
    let vertices = flat(&[[350.25, -120.5], [199.5, -197.75], [211.125, -203.0], [360.0, -140.0]]);
    let case = Case::new(polyline(&vertices));
    for (k, away) in [(1, [-1.75, 1.0]), (2, [0.5, -6.5]), (0, [2.0, 0.5]), (3, [1.5, 6.25])] {
        let p = vertices[k] + dvec3(away[0], away[1], 0.0);
        // exact: the coordinates are sums of few powers of two
        let foot = case.foot_at(p, away[0].hypot(away[1]));
        assert_eq!(u(&foot), k as f64, "{foot:?}");
        assert_eq!(foot.point, vertices[k]);
        assert_eq!(foot.place, if k == 0 || k == 3 { Place::End } else { Place::Crease });
    }
}

/// Oblikovati PR 1093: a search whose tolerance began at infinity took every distance to a polyline for 0.
#[test]
fn distances_to_polylines_are_those_of_their_segments() {
    let open = flat(&[[0.0, 0.0], [3.0, 0.0], [3.0, 2.0], [7.0, 2.0], [7.0, -5.0]]);
    let closed = flat(&[[0.0, 0.0], [6.0, 0.0], [3.0, 5.0], [0.0, 0.0]]);
    let repeated = flat(&[[0.0, 0.0], [2.0, 1.0], [2.0, 1.0], [4.0, -1.0]]);
    let straight = flat(&[[0.0, 0.0], [1.0, 0.5], [4.0, 2.0], [6.0, 3.0]]);
    let there_and_back = flat(&[[0.0, 0.0], [4.0, 1.0], [0.0, 0.0], [-1.0, 3.0]]);
    let single = flat(&[[-1.0, -1.0], [2.0, 5.0]]);
    for vertices in [open, closed, repeated, straight, there_and_back, single] {
        let case = Case::new(polyline(&vertices));
        for i in -3..=9 {
            for j in -7..=7 {
                let p = dvec3(f64::from(i) + 0.125, f64::from(j), 0.25);
                let distance = vertices.windows(2).map(|s| to_segment(p, s[0], s[1])).fold(f64::INFINITY, f64::min);
                assert!(case.foot_at(p, distance).distance > 0.2);
            }
        }
    }
}

fn to_segment(p: DVec3, a: DVec3, b: DVec3) -> f64 {
    let along = b - a;
    let share = if along == DVec3::ZERO { 0.0 } else { (p - a).dot(along) / along.length_squared() };
    p.distance(a + share.clamp(0.0, 1.0) * along)
}
