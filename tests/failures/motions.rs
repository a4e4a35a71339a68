//! Distances do not depend on where an entity stands, how it is turned, or in what unit it is given.

use std::f64::consts::PI;

use glam::{DAffine3, DQuat, DVec3, dvec3};
use perpend::Definition;

use super::case::Case;
use super::shapes::{arc, gallery, points_about};
use crate::common::judgement::rounding;

fn image(case: &Case, map: &DAffine3) -> Case {
    Case::new(match &case.definition {
        Definition::NurbsCurve(curve) => Definition::from(curve.transformed(map).expect("valid")),
        Definition::NurbsSurface(surface) => surface.transformed(map).expect("valid").into(),
    })
}

/// OCCT bugs 27184, 30722, 31047, 32960, 33515, FreeCAD #25158: a distance changed when both bodies were moved together; a point of the
/// body was off it afterwards.
#[test]
fn distances_survive_motions_and_scales() {
    let turn = DQuat::from_axis_angle(dvec3(1.0, -2.0, 0.5).normalize(), 1.234_5);
    let scaled = |scale: f64| DAffine3::from_scale(DVec3::splat(scale));
    for (name, case) in gallery() {
        let size = case.size();
        let maps = [
            (1.0, DAffine3::from_translation(dvec3(3.0, -5.0, 0.7) * size)),
            (1.0, DAffine3::from_translation(dvec3(-1e3, 2e3, 5e2) * size)),
            (1.0, DAffine3::from_quat(turn)),
            (1.0, DAffine3::from_rotation_translation(turn, dvec3(20.0, 30.0, -9.0) * size)),
            (1e-3, scaled(1e-3)),
            (25.4, scaled(25.4)),
            (1e6, scaled(1e6)),
        ];
        let points = points_about(&case, &[0.0, 1e-6, 0.01, 0.2, 3.0]);
        let before: Vec<f64> = points.iter().map(|p| case.foot(*p).distance).collect();
        for (scale, map) in maps {
            let image = image(&case, &map);
            for (p, before) in points.iter().zip(&before) {
                let p = map.transform_point3(*p);
                let after = image.foot(p).distance;
                // control points and query are rounded to the grid of their coordinates; weights 30 to 1 may stretch that
                let allowed = rounding(image.shape.reach(), p, after) + 1e-12 * image.size();
                assert!((after - scale * before).abs() <= allowed, "{name}, {map:?}, {p}: {before:e}, then {after:e}");
            }
        }
    }
}

/// As above: powers of two are no rounding, so no bit may change but the exponent.
#[test]
fn powers_of_two_scale_the_answer_exactly() {
    for (name, case) in gallery() {
        let image = image(&case, &DAffine3::from_scale(DVec3::splat(1024.0)));
        for p in points_about(&case, &[1e-6, 0.2, 3.0]) {
            let (before, after) = (case.foot(p), image.foot(1024.0 * p));
            assert_eq!(1024.0 * before.distance, after.distance, "{name}, {p}");
            assert_eq!(before.parameter, after.parameter, "{name}, {p}");
        }
    }
}

/// Piegl et al. 2008, Table 1: a 90-degree and a 120-degree arc of one circle gave different results, because they are parametrised
/// differently. The nearest point does not know of parameters.
#[test]
fn arcs_of_one_circle_give_one_foot() {
    let arcs = [PI / 2.0, 2.0 * PI / 3.0, PI, 2.0 * PI].map(|sweep| Case::new(arc(1.0, sweep)));
    for degrees in [1.0_f64, 17.0, 45.0, 60.0, 89.0] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        for p in
            [dvec3(0.3 * cos, 0.3 * sin, 0.2), dvec3(2.0 * cos, 2.0 * sin, 0.0), dvec3(50.0 * cos, 50.0 * sin, -8.0)]
        {
            for case in &arcs {
                let foot = case.foot_at(p, (p.x.hypot(p.y) - 1.0).hypot(p.z));
                assert!(foot.point.distance(dvec3(cos, sin, 0.0)) <= 1e-9, "{foot:?}");
            }
        }
    }
}
