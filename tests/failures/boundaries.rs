//! Feet that no perpendicular leads to: on ends, edges and corners.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DVec3, dvec3};
use perpend::kernel::{Frame, Plane, Spacing, curve_through};
use perpend::{Multiplicity, NurbsCurve, Place};

use super::case::{Case, close, u, uv};
use super::shapes::{curve, cylinder, flat, polyline};
use crate::common::oracle::Oracle;
use crate::common::shape::Shape;

/// Cadrum PR 282, with its numbers: the foot on the face of a cube, from a point far above its rim, was sought beyond the rim.
#[test]
fn a_bounded_face_answers_with_its_rim() {
    // the face x = 0 of the cube [0, 10]³
    let frame = Frame::new(DVec3::ZERO, DVec3::X, DVec3::Y).expect("a frame");
    let face = Plane::new(frame, (0.0, 10.0), (0.0, 10.0)).and_then(|p| p.to_nurbs()).expect("a plane");
    let case = Case::new(face);
    let table = [
        // query, foot, place
        ([5.0, 5.0, 100.0], [0.0, 5.0, 10.0], Place::Edge),
        ([5.0, 5.0, 5.0], [0.0, 5.0, 5.0], Place::Interior),
        ([-7.0, -2.0, 3.0], [0.0, 0.0, 3.0], Place::Edge),
        ([1.0, 12.0, -4.0], [0.0, 10.0, 0.0], Place::Corner),
        ([0.0, 10.0, 10.0], [0.0, 10.0, 10.0], Place::Corner),
        ([0.0, 10.5, 10.0], [0.0, 10.0, 10.0], Place::Corner),
    ];
    for (p, expected, place) in table {
        let (p, expected) = (DVec3::from_array(p), DVec3::from_array(expected));
        let foot = case.foot_at(p, p.distance(expected));
        assert!(foot.point.distance(expected) <= 1e-12 * case.size(), "{p}: {foot:?}");
        assert_eq!(foot.place, place, "{p}");
        assert_eq!(foot.multiplicity, Multiplicity::Unique, "{p}");
    }
}

/// Cadrum PR 282: where a quarter of a cylinder is cut out, only the far perpendicular remained before the cut, and it was reported.
#[test]
fn before_the_cut_of_a_cylinder_the_rim_is_the_foot() {
    let (radius, height) = (2.0_f64, 5.0);
    let case = Case::new(cylinder(radius, (0.0, height), 1.5 * PI));
    // angles inside the cut, 270 to 360 degrees, and the rim that is nearer: v = 1 at 270, v = 0 at 360
    for (degrees, v) in [(275.0_f64, 1.0), (300.0, 1.0), (314.0, 1.0), (316.0, 0.0), (340.0, 0.0), (359.0, 0.0)] {
        for rho in [0.5, 1.9, 2.0, 3.0, 40.0] {
            for z in [-1.0, 0.0, 2.5, 5.0, 7.0] {
                let (sin, cos) = degrees.to_radians().sin_cos();
                let p = dvec3(rho * cos, rho * sin, z);
                let rim = if v == 1.0 { dvec3(0.0, -radius, 0.0) } else { dvec3(radius, 0.0, 0.0) };
                let expected = rim + z.clamp(0.0, height) * DVec3::Z;
                let foot = case.foot_at(p, p.distance(expected));
                assert!(foot.point.distance(expected) <= 1e-9 * case.size(), "{p}: {foot:?}, not {expected}");
                assert_eq!(uv(&foot).1, v);
                // level with a rim, rounding decides between the corner and the edge beside it
                let expected = if z > 0.0 && z < height { Place::Edge } else { Place::Corner };
                assert!(foot.place == expected || z == 0.0 || z == height, "{p}: {foot:?}");
            }
        }
    }
    // midway between both rims they tie
    let p = dvec3(1.0, -1.0, 2.5);
    let ties = case.ties(p);
    assert!(ties.complete && ties.continua.is_empty(), "{ties:?}");
    let rims: Vec<f64> = ties.points.iter().map(|foot| uv(foot).1).collect();
    assert_eq!(rims, [0.0, 1.0]);
    assert_eq!(ties.nearest.multiplicity, Multiplicity::Tied);
    close(case.foot_at(p, 2.0_f64.sqrt()).distance, ties.nearest.distance, 0.0);
}

/// compas_occ #10, pythonocc #1137: beyond the ends of a curve no perpendicular exists, and the answer was an exception.
#[test]
fn beyond_the_ends_of_a_curve_the_end_is_the_foot() {
    let points = flat(&[[0.0, 0.0], [0.2, 0.6], [0.5, 0.8], [0.8, 0.6]]);
    let case = Case::new(curve_through(&points, 3, Spacing::ChordLength).expect("four points"));
    // from (1, 0.1, 0) every point of the curve but its end is farther
    let p = dvec3(1.0, 0.1, 0.0);
    let foot = case.foot_at(p, p.distance(points[3]));
    assert_eq!((u(&foot), foot.point, foot.place), (1.0, points[3], Place::End));
    let p = dvec3(-0.3, -1.0, 2.0);
    let foot = case.foot_at(p, p.length());
    assert_eq!((u(&foot), foot.point, foot.place), (0.0, points[0], Place::End));
    // a segment, seen from points straight ahead of it
    let case = Case::new(polyline(&[DVec3::ZERO, dvec3(3.0, 0.0, 4.0)]));
    for (p, end) in [(dvec3(6.0, 0.0, 8.0), 1.0), (dvec3(-3.0, 0.0, -4.0), 0.0)] {
        assert_eq!(u(&case.foot_at(p, 5.0)), end);
    }
}

/// The curve of the tests of parameters, over knots 0, 1, 2, … that are not clamped.
fn wave(unclamped: bool) -> (Vec<f64>, Vec<DVec3>) {
    let points: Vec<DVec3> =
        (0..9).map(|k| dvec3(f64::from(k), (1.7 * f64::from(k)).sin(), 0.3 * f64::from(k % 3))).collect();
    let knots = if unclamped { (0..13).map(f64::from).collect() } else { super::shapes::whole_knots(3, 9) };
    (knots, points)
}

/// Sverchok #3436, #3508, #3529: inversion failed near the end of a curve (0.995 and on), and gave parameters outside the domain.
#[test]
fn parameters_near_both_ends_come_back() {
    for unclamped in [false, true] {
        let (knots, points) = wave(unclamped);
        let made = NurbsCurve::new(3, knots, points, None).expect("valid");
        let own = made.domain();
        for (first, last) in [own, (0.0, 1.0), (-3.0, -1.0), (5.0, 7.0), (1e2, 1e2 + 1.0), (-1e-3, 1e-3)] {
            let curve = if (first, last) == own { made.clone() } else { made.with_domain(first, last).expect("valid") };
            let case = Case::new(curve.clone());
            let range = last - first;
            for share in [0.0, 1e-9, 1e-5, 0.004, 0.01, 0.5, 0.99, 0.995, 0.999, 1.0 - 1e-9, 1.0] {
                let at = case.share(0, share);
                let mut d = [DVec3::ZERO; 2];
                curve.derivatives(at, &mut d);
                let across = d[1].cross(DVec3::Z).normalize();
                for offset in [0.0, 0.01, -0.01] {
                    let foot = case.foot_at(d[0] + offset * across, offset.abs());
                    let u = u(&foot);
                    assert!(first <= u && u <= last, "{u} outside [{first}, {last}]");
                    // rounding of the query over the speed, and of the parameter
                    close(u, at, 1e-12 * case.size() / d[1].length() + 4.0 * f64::EPSILON * at.abs().max(range));
                }
            }
            for (end, sign) in [(first, -1.0), (last, 1.0)] {
                let mut d = [DVec3::ZERO; 2];
                curve.derivatives(end, &mut d);
                let foot = case.foot_at(d[0] + sign * 2.0 * d[1].normalize(), 2.0);
                assert_eq!((u(&foot), foot.place), (end, Place::End));
            }
        }
    }
}

/// Sverchok #3508: clamping on entry moves nothing. The oracle has the data as they were given.
#[test]
fn an_unclamped_curve_answers_as_its_own_data() {
    let (knots, points) = wave(true);
    let oracle = Oracle::new(Shape::curve(3, knots.clone(), points.clone(), None));
    let case = Case::new(NurbsCurve::new(3, knots, points, None).expect("valid"));
    assert_eq!(case.shape.domain(0), [3.0, 9.0]);
    for k in 0..60 {
        let k = f64::from(k);
        let p = dvec3(-1.0 + k / 6.0, 1.5 * (2.1 * k).sin(), (0.9 * k).cos());
        case.foot_at(p, oracle.nearest(p).distance);
    }
}

/// Sverchok #3436 on surfaces: edges and corners give the ends of the domain, whatever it is.
#[test]
fn parameters_at_edges_are_the_ends_of_the_domain() {
    let base = super::shapes::plain_surface(3, 5, 6, |i, j| dvec3(i as f64, j as f64, 0.2 * ((i * j) % 3) as f64));
    let base = base.with_domain(perpend::Direction::U, -7.0, -2.5).expect("a domain");
    let case = Case::new(base.with_domain(perpend::Direction::V, 1e3, 1e3 + 2.0).expect("a domain"));
    for (p, expected, place) in [
        (dvec3(-3.0, -3.0, 0.0), (-7.0, 1e3), Place::Corner),
        (dvec3(9.0, -3.0, 1.0), (-2.5, 1e3), Place::Corner),
        (dvec3(-3.0, 9.0, 1.0), (-7.0, 1e3 + 2.0), Place::Corner),
        (dvec3(9.0, 9.0, 0.0), (-2.5, 1e3 + 2.0), Place::Corner),
    ] {
        let foot = case.foot_by_oracle(p);
        assert_eq!((uv(&foot), foot.place), (expected, place), "{p}");
    }
    for (p, along, end) in [
        (dvec3(-3.0, 2.5, 0.0), 0, -7.0),
        (dvec3(9.0, 2.5, 0.0), 0, -2.5),
        (dvec3(2.0, -3.0, 0.0), 1, 1e3),
        (dvec3(2.0, 9.0, 0.0), 1, 1e3 + 2.0),
    ] {
        let foot = case.foot_by_oracle(p);
        let (u, v) = uv(&foot);
        assert_eq!(([u, v][along], foot.place), (end, Place::Edge), "{p}");
    }
}

/// Cadrum PR 282 on curves: an arc answers with its end where the circle's foot is cut away.
#[test]
fn an_arc_answers_with_its_end_before_its_cut() {
    let case = Case::new(super::shapes::arc(1.0, 1.5 * PI));
    for (angle, end) in [(-0.1, 0.0), (-0.7, 0.0), (-0.9, 1.0), (-FRAC_PI_2 + 0.01, 1.0)] {
        for rho in [0.2, 1.0, 30.0] {
            let p = dvec3(rho * f64::cos(angle), rho * f64::sin(angle), 0.5);
            let rim = if end == 0.0 { DVec3::X } else { -DVec3::Y };
            let foot = case.foot_at(p, p.distance(rim));
            assert_eq!((u(&foot), foot.place), (end, Place::End), "{p}");
        }
    }
    // a curve that turns back on itself at its end: the end is nearest although the tangent there points at the query
    let hook = curve(2, flat(&[[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [2.0, 3.0]]));
    assert_eq!(Case::new(hook).foot_at(dvec3(1.0, 3.5, 0.0), 1.25_f64.sqrt()).place, Place::End);
}
