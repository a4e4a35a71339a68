//! Every face against the oracle, at points of all kinds.

use glam::{DAffine3, DMat3, DQuat, Vec2Swizzles, dvec3};
use std::sync::Arc;

use super::case::Case;
use super::faces::{self, Face};
use crate::common::random::Random;

/// Fails where an answer about a face is wrong; names the first of each face.
fn no_faults(faces: Vec<Face>, count: usize, seed: u64) {
    let mut random = Random::new(seed);
    let mut told = Vec::new();
    let mut total = 0;
    for face in faces {
        let case = Case::new(face);
        let points = case.hard_points(count, &mut random);
        let faults = case.faults(&points);
        total += faults.len();
        if let Some(first) = faults.first() {
            told.push(format!("{} of {}: {first}", faults.len(), points.len()));
        }
    }
    assert!(told.is_empty(), "{total} faults\n{}", told.join("\n"));
}

#[test]
fn no_point_of_a_face_is_nearer_and_every_answer_is_proven() {
    no_faults(faces::all(), 150, 1);
}

/// The face under a similarity; the trims stay as they are.
fn moved(face: Face, scale: f64, turn: DQuat, offset: glam::DVec3) -> Face {
    let map = DAffine3 { matrix3: scale * DMat3::from_quat(turn), translation: offset };
    let surface = face.surface.transformed(&map).expect("an image with extent");
    let data = face.trimming.data();
    let tolerance = data.tolerance * scale + 1e-15 * offset.length();
    let data = perpend::kernel::TrimmingData { tolerance, ..data };
    let (trimming, _) = perpend::kernel::Trimming::enter(data, &surface).expect("the same trims");
    let special = face.special.iter().map(|p| map.transform_point3(*p)).collect();
    Face { name: format!("{} ({scale:e})", face.name), surface, trimming: Arc::new(trimming), special }
}

#[test]
fn small_large_and_distant_faces_are_answered_as_well() {
    let turn = DQuat::from_axis_angle(dvec3(1.0, 2.0, 3.0).normalize(), 0.7);
    let some = || {
        let some = [
            faces::plate_with_a_round_hole as fn() -> Face,
            faces::window_in_a_cylinder,
            faces::cap_with_a_window,
            faces::patch_of_a_torus,
            faces::wave_with_wavy_trims,
            faces::creased_disc,
        ];
        some.into_iter()
    };
    let small = some().map(|face| moved(face(), 1e-3, turn, dvec3(1.0, 2.0, 3.0)));
    let large = some().map(|face| moved(face(), 1e6, turn, dvec3(1e6, -1e6, 0.0)));
    let distant = some().map(|face| moved(face(), 1.0, turn, dvec3(1e4, -2e4, 3e4)));
    no_faults(small.chain(large).chain(distant).collect(), 60, 2);
}

#[test]
fn the_sense_of_loops_and_the_exchange_of_parameters_change_no_distance() {
    use perpend::kernel::{TrimCurveData, TrimLoopData, Trimming, TrimmingData};
    let mut random = Random::new(3);
    for face in [faces::plate_with_slots(), faces::patch_of_a_torus(), faces::wave_with_wavy_trims()] {
        let data = face.trimming.data();
        let exchanged = |curve: &TrimCurveData| {
            let points = curve.points.iter().map(|uv| uv.yx()).collect();
            TrimCurveData { points, ..curve.clone() }
        };
        let loops = data
            .loops
            .iter()
            .map(|one| TrimLoopData { outer: one.outer, curves: one.curves.iter().map(exchanged).collect() })
            .collect();
        let surface = face.surface.swapped();
        let (trimming, _) = Trimming::enter(TrimmingData { loops, ..data }, &surface).expect("the same trims");
        let name = format!("{}, exchanged", face.name);
        let other = Case::new(Face { name, surface, trimming: Arc::new(trimming), special: Vec::new() });
        let case = Case::new(face);
        for p in case.hard_points(60, &mut random) {
            let (a, b) = (case.foot(p), other.foot(p));
            let slack = 1e-9 * case.size() + 1e-13 * (a.distance + case.oracle.shape.reach());
            assert!((a.distance - b.distance).abs() <= slack, "{} at {p:?}: {a:?}, {b:?}", case.face.name);
        }
    }
}
