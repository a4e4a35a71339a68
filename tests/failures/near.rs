//! Very near points, tiny entities, entities far from the origin.

use glam::{DAffine3, DVec3, dvec3};
use perpend::{Definition, Place};

use super::case::Case;
use super::shapes::{circle, curve, cylinder, eggcrate, gallery, sphere, torus, weighted};
use crate::common::random::Random;

/// OCCT bugs 593, 24137, 28866, 33080: points of a surface came back 5e-7 and more away from it. Here: at most 1e-12 of the size.
#[test]
fn points_on_an_entity_are_on_it() {
    for (name, case) in gallery() {
        let mut random = Random::new(28_866);
        let mut points: Vec<DVec3> = case.grid(8).into_iter().map(|(_, _, point)| point).collect();
        points.extend((0..60).map(|_| case.at(case.share(0, random.unit()), case.share(1, random.unit()))));
        for p in points {
            let foot = case.foot(p);
            assert!(foot.distance <= 1e-12 * case.size(), "{name}, {p}: {foot:?}");
        }
    }
}

/// OCCT bug 33080 on both sides: 1e-12 to 1e-5 of the size off a round shape, inside (concave) and outside (convex).
#[test]
fn very_near_points_of_round_shapes_are_certified_on_both_sides() {
    let mut random = Random::new(33_080);
    let ball = Case::new(sphere(1.0));
    let can = Case::new(cylinder(1.0, (-1.0, 1.0), std::f64::consts::TAU));
    let ring = Case::new(torus(1.0, 0.25));
    let hoop = Case::new(circle(1.0));
    for exponent in 5..=12 {
        for _ in 0..12 {
            for side in [1.0, -1.0] {
                let off = 10.0_f64.powi(-exponent);
                let d = random.direction();
                let p = (1.0 + side * off * ball.size()) * d;
                ball.foot_at(p, (p.length() - 1.0).abs());
                let p = (1.0 + side * off * can.size()) * dvec3(d.x, d.y, 0.0).normalize() + 0.9 * d.z * DVec3::Z;
                can.foot_at(p, (p.x.hypot(p.y) - 1.0).abs());
                let p = (1.0 + side * off * hoop.size()) * dvec3(d.x, d.y, 0.0).normalize();
                hoop.foot_at(p, (p.x.hypot(p.y) - 1.0).abs());
                // all of the tube: outside convex, about the hole a saddle
                let spine = dvec3(d.x, d.y, 0.0).normalize();
                let tube = (random.direction() * spine.cross(DVec3::Z).cross(DVec3::ONE)).normalize();
                let tube = (tube - tube.dot(spine.cross(DVec3::Z)) * spine.cross(DVec3::Z)).normalize();
                let p = spine + (0.25 + side * off * ring.size()) * tube;
                ring.foot_at(p, ((p.x.hypot(p.y) - 1.0).hypot(p.z) - 0.25).abs());
            }
        }
    }
}

/// OCCT bugs 593 and 24137 on free forms: very near points on both sides, held to the oracle.
#[test]
fn very_near_points_of_free_forms_are_certified_on_both_sides() {
    for case in [Case::new(eggcrate()), Case::new(weighted(10.0))] {
        let mut random = Random::new(24_137);
        for exponent in 5..=12 {
            for _ in 0..10 {
                let (u, v) = (case.share(0, random.unit()), case.share(1, random.unit()));
                let (on, normal) = (case.at(u, v), case.normal(u, v));
                for side in [1.0, -1.0] {
                    let off = side * 10.0_f64.powi(-exponent) * case.size();
                    let foot = case.foot_by_oracle(on + off * normal);
                    assert!(foot.distance <= off.abs() + 4.0 * f64::EPSILON * case.shape.reach(), "{foot:?}");
                    assert!(foot.signed_distance.is_some_and(|d| d * off > 0.0), "wrong side: {foot:?}");
                }
            }
        }
    }
    let points = (0..9).map(|k| dvec3(f64::from(k), (1.7 * f64::from(k)).sin(), 0.3 * f64::from(k % 3))).collect();
    let case = Case::new(curve(3, points));
    let mut random = Random::new(593);
    for exponent in 5..=12 {
        for _ in 0..20 {
            let off = 10.0_f64.powi(-exponent) * case.size();
            let foot = case.foot_by_oracle(case.at(case.share(0, random.unit()), 0.0) + off * random.direction());
            assert!(foot.distance <= off + 4.0 * f64::EPSILON * case.shape.reach(), "{foot:?}");
        }
    }
}

/// The same beside edges, corners, ends, poles and creases, where no normal leads to the foot.
#[test]
fn very_near_points_of_boundaries_are_certified() {
    for (_, case) in gallery() {
        let ends: Vec<DVec3> = case.grid(1).into_iter().map(|(_, _, point)| point).collect();
        let mut random = Random::new(17);
        for exponent in [5, 7, 8, 10, 12] {
            let off = 10.0_f64.powi(-exponent) * case.size();
            for end in &ends {
                case.foot_by_oracle(*end + off * random.direction());
            }
        }
    }
}

/// An entity with every control point mapped.
fn moved(case: &Case, scale: f64, offset: DVec3) -> Case {
    let map = DAffine3 { translation: offset, ..DAffine3::from_scale(DVec3::splat(scale)) };
    Case::new(match &case.definition {
        Definition::NurbsCurve(curve) => Definition::from(curve.transformed(&map).expect("valid")),
        Definition::NurbsSurface(surface) => surface.transformed(&map).expect("valid").into(),
    })
}

/// OCCT bug 24137, brepkit PR 206: what works at 1 fails at 1e-6, or 1e7 from the origin, where a fixed tolerance is everything or nothing.
#[test]
fn tiny_and_remote_entities_are_certified() {
    let far = dvec3(1e7, -7e6, 4e6);
    for (_, case) in gallery() {
        let unit = 1.0 / case.size();
        for case in
            [moved(&case, 1e-6 * unit, DVec3::ZERO), moved(&case, unit, far), moved(&case, 1e-6 * unit, 1e-6 * far)]
        {
            let mut random = Random::new(206);
            let ons: Vec<DVec3> = case.grid(3).into_iter().map(|(_, _, point)| point).collect();
            for on in ons {
                case.foot(on);
                for share in [1e-9, 1e-5, 1e-2, 0.5] {
                    case.foot_by_oracle(on + share * case.size() * random.direction());
                }
            }
        }
    }
}

/// As above: what is one point at one scale is one point at another, and what is two stays two.
#[test]
fn places_do_not_depend_on_scale_or_offset() {
    for (scale, offset) in [(1e-6, DVec3::ZERO), (1.0, dvec3(1e7, -7e6, 4e6)), (1e6, DVec3::ZERO)] {
        let on = |p: DVec3| offset + scale * p;
        let place = |case: &Case, p: DVec3| moved(case, scale, offset).foot(on(p)).place;
        assert_eq!(place(&Case::new(circle(1.0)), dvec3(1.5, 0.0, 0.0)), Place::Seam, "{scale}, {offset}");
        assert_eq!(place(&Case::new(circle(1.0)), dvec3(1.5, 0.01, 0.0)), Place::Interior, "{scale}, {offset}");
        assert_eq!(place(&Case::new(sphere(1.0)), dvec3(0.0, 0.0, 2.0)), Place::Pole, "{scale}, {offset}");
        assert_eq!(place(&Case::new(sphere(1.0)), dvec3(1.0, 0.3, 1.0)), Place::Interior, "{scale}, {offset}");
        assert_eq!(place(&Case::new(super::shapes::walls()), dvec3(2.0, 2.0, 0.0)), Place::Crease, "{scale}, {offset}");
    }
}

/// A point on the entity beside a knot is answered with itself, not with the knot, though that lies within the gap.
#[test]
fn beside_a_knot_the_foot_is_on_its_own_side() {
    let points: Vec<DVec3> = (0..7).map(|i| dvec3(f64::from(i), f64::from(i * i % 5), f64::from(i % 3))).collect();
    let case = Case::new(super::shapes::curve(3, points));
    for knot in 1..4 {
        for step in [1e-12, 1e-11, 1e-10, 1e-9, 1e-8, 1e-6] {
            for u in [case.share(0, f64::from(knot) / 4.0) - step, case.share(0, f64::from(knot) / 4.0) + step] {
                let foot = case.foot_at(case.at(u, 0.0), 0.0);
                assert!(foot.distance <= 1e-14 * case.size(), "{u}: {foot:?}");
            }
        }
    }
}
