//! Failures that users of other kernels report of trimmed faces, and places where a foot is easily lost.

use glam::{DVec2, DVec3, dvec2, dvec3};
use perpend::{Place, Scratch};

use super::case::Case;
use super::faces::{self, Face, circle, polygon, rectangle};
use crate::common::random::Random;

/// cadrum: from far above a cube, a face's foot fell outside its trims, and the query panicked.
#[test]
fn a_cube_face_is_met_at_its_edge() {
    let case = Case::new(faces::cube_face());
    let foot = case.foot_at(dvec3(5.0, 5.0, 100.0), 90.0_f64.hypot(5.0));
    assert!(foot.point.distance(dvec3(0.0, 5.0, 10.0)) < 1e-6, "{foot:?}");
    assert_eq!(foot.place, Place::TrimEdge);
}

/// cadrum: of a cylinder with a quarter cut out, the far side was answered for a point in the gap: of the extrema, it alone lay in the trims.
#[test]
fn in_the_gap_of_a_cylinder_an_edge_is_met_and_not_the_far_side() {
    let case = Case::new(faces::three_quarters());
    for (p, edge) in [(dvec3(1.5, 1.4, 1.0), DVec3::X), (dvec3(0.6, 0.9, 0.5), DVec3::Y)] {
        let foot = case.foot_at(p, (p - edge).truncate().length());
        assert_eq!(foot.place, Place::TrimEdge, "{foot:?}");
    }
    let beyond = case.foot_at(dvec3(1.5, 1.4, 3.0), dvec3(0.5, 1.4, 1.0).length());
    assert_eq!(beyond.place, Place::Vertex, "{beyond:?}");
}

#[test]
fn above_a_hole_its_rim_is_met_and_at_its_axis_the_whole_rim_is_as_near() {
    let case = Case::new(faces::plate_with_a_round_hole());
    for (x, z) in [(0.5, 0.0), (1.0, 2.0), (1.5 - 1e-9, 1e-6), (1e-9, 1.0), (0.0, 0.0), (0.0, -3.0)] {
        case.foot_at(dvec3(4.0 + x, 3.0, z), (1.5 - x).hypot(z));
        case.foot_at(dvec3(4.0, 3.0 - x, z), (1.5 - x).hypot(z));
    }
    assert_eq!(case.foot(dvec3(4.5, 3.2, 1.0)).place, Place::TrimEdge);
    assert_eq!(case.foot(dvec3(1.5, 3.2, 1.0)).place, Place::Interior);
}

#[test]
fn at_the_inner_corner_of_an_l_both_edges_are_as_near() {
    let case = Case::new(faces::l_shape());
    case.foot_at(dvec3(2.0, 2.0, 0.0), 1.0);
    case.foot_at(dvec3(1.5, 1.75, 1.0), 0.5_f64.hypot(1.0));
    let corner = case.foot_at(dvec3(-1.0, -1.0, 0.0), 2.0_f64.sqrt());
    assert_eq!(corner.place, Place::Vertex, "{corner:?}");
    assert_eq!(case.foot_at(dvec3(1.0, 1.0, 0.5), 0.5).place, Place::Vertex);
}

#[test]
fn between_the_island_and_the_rim_the_nearer_is_met() {
    let case = Case::new(faces::island_in_a_hole());
    case.foot_at(dvec3(5.0, 3.0, 1.0), 1.0);
    case.foot_at(dvec3(6.7, 3.0, 0.0), 0.7);
    case.foot_at(dvec3(6.8, 3.0, 0.0), 0.7);
    case.foot_at(dvec3(6.75, 3.0, 0.5), 0.75_f64.hypot(0.5));
}

/// The carrier's foot lies in the valley that was cut away; neither that foot's nearest boundary point nor any other is right.
#[test]
fn a_farther_local_minimum_inside_the_trims_is_found() {
    let case = Case::new(faces::valley_cut_away());
    let p = dvec3(1.8, 2.0, -1.45);
    let foot = case.foot(p);
    assert_eq!(foot.place, Place::Interior, "{foot:?}");
    let away = case.oracle.outline.distance(dvec2(foot.parameter.u(), foot.parameter.v().unwrap_or(0.0)));
    assert!(away > 0.01, "{foot:?}");
}

#[test]
fn around_a_pole_the_cap_is_met_at_the_pole_and_at_its_rim() {
    let case = Case::new(faces::cap());
    case.foot_at(dvec3(0.0, 0.0, 5.0), 3.0);
    case.foot_at(dvec3(0.0, 0.0, 2.0), 0.0);
    case.foot_at(dvec3(0.0, 0.0, 2.0 - 1e-7), 1e-7);
    case.foot_at(DVec3::ZERO, 2.0);
    let rim = 2.0_f64.sqrt();
    case.foot_at(dvec3(0.0, 0.0, -3.0), rim.hypot(3.0 + rim));
    case.foot_at(dvec3(3.0, 0.0, 0.0), rim.hypot(3.0 - rim));
}

#[test]
fn a_foot_on_the_seam_belongs_to_a_face_on_either_side() {
    for (from, to) in [(0.0, 0.3), (0.7, 1.0)] {
        let loops = vec![rectangle(true, dvec2(0.2, from), dvec2(0.8, to))];
        let case = Case::new(Face::new("beside the seam", faces::cylinder(1.0, 2.0), loops));
        for (p, distance) in [(dvec3(2.0, 0.0, 1.0), 1.0), (dvec3(0.5, 0.0, 1.0), 0.5), (dvec3(1.0, 0.0, 1.0), 0.0)] {
            case.foot_at(p, distance);
        }
    }
}

#[test]
fn the_apex_of_a_sector_is_met() {
    let case = Case::new(faces::sector_of_a_cone());
    case.foot_at(dvec3(0.0, 0.0, 5.0), 2.0);
    case.foot_at(dvec3(0.0, 0.0, 3.0), 0.0);
}

#[test]
fn on_an_axis_a_whole_parallel_is_as_near() {
    let case = Case::new(faces::window_in_a_cylinder());
    case.foot_at(dvec3(0.0, 0.0, 1.0), 2.0);
    case.foot_at(dvec3(0.0, 0.0, 5.0), 2.0_f64.hypot(1.0));
    let torus = Case::new(faces::patch_of_a_torus());
    torus.foot(dvec3(0.0, 0.0, 1.0));
    torus.foot(dvec3(3.0 * 0.6, 3.0 * 0.8, 0.0));
}

/// The carrier's foot lies on the outline itself, to the last bit and a hair to either side.
#[test]
fn feet_on_the_outline_belong_to_the_face() {
    let case = Case::new(faces::plate_with_a_round_hole());
    for off in [-1e-6, -1e-9, -1e-12, -1e-15, 0.0, 1e-15, 1e-12, 1e-9, 1e-6] {
        for z in [0.0, 1e-9, 1e-3, 2.0] {
            let hole = dvec3(2.5 + off, 3.0, z);
            case.foot_at(hole, f64::max(off, 0.0).hypot(z));
            let edge = dvec3(10.0 + off, 2.0, z);
            case.foot_at(edge, f64::max(off, 0.0).hypot(z));
        }
    }
}

/// The corner at which a loop begins is where it ends; its parameter along the whole boundary must not be taken for the beginning of the next loop.
#[test]
fn the_corner_that_closes_a_loop_is_met_though_another_loop_follows() {
    let loops = vec![
        rectangle(true, DVec2::splat(0.5), dvec2(9.5, 5.5)),
        rectangle(false, DVec2::ONE, DVec2::splat(2.0)),
        circle(false, dvec2(5.0, 3.0), 1.0),
    ];
    let case = Case::new(Face::new("plate with two holes", faces::plane(10.0, 6.0), loops));
    let mut random = Random::new(7);
    let corner = dvec3(0.5, 0.5, 0.0);
    for _ in 0..100 {
        let way = dvec3(-random.unit(), -random.unit(), random.between(-2.0, 2.0));
        let p = corner + random.power(-6.0, 3.0) * way;
        let foot = case.foot_at(p, p.distance(corner));
        assert_eq!(foot.place, Place::Vertex, "{foot:?}");
    }
    let seen = Case::new(faces::window_in_a_cylinder());
    let outline = seen.face.surface.point(0.7, 0.125);
    seen.foot_at(outline, 0.0);
    seen.foot(seen.face.surface.point(0.8, 0.5));
}

/// A p-curve along the border of the domain: no rounding of its points leaves the domain. The numbers are those of a wind turbine's blade.
#[test]
fn feet_on_the_border_of_the_domain_lie_in_the_domain() {
    let (width, height) = (0.164763226097204, 117.589976972617);
    let wave = |i: usize, j: usize| dvec3(width * i as f64, height / 3.0 * j as f64, [0.0, 0.1, -0.1, 0.2][j]);
    let surface = faces::carrier(1, [2, 4], dvec2(width, height), |i, j| (wave(i, j), 1.0));
    let whole = rectangle(true, DVec2::ZERO, dvec2(width, height));
    let case = Case::new(Face::new("blade", surface, vec![whole]));
    for k in 0..400 {
        let v = height * f64::from(k) / 401.0;
        let edge = case.face.surface.point(width, v);
        case.foot_at(edge, 0.0);
        case.foot_at(edge + DVec3::X, 1.0);
    }
}

/// Loops that only touch, and a hole that touches the outer loop.
#[test]
fn touching_loops_are_answered() {
    let loops = vec![
        rectangle(true, DVec2::ZERO, dvec2(10.0, 6.0)),
        circle(false, dvec2(2.0, 3.0), 1.0),
        circle(false, dvec2(4.0, 3.0), 1.0),
        circle(false, dvec2(8.0, 4.0), 2.0),
    ];
    let case = Case::new(Face::new("touching holes", faces::plane(10.0, 6.0), loops));
    case.foot_at(dvec3(3.0, 3.0, 1.0), 1.0);
    case.foot_at(dvec3(2.5, 3.0, 1.0), 0.5_f64.hypot(1.0));
    case.foot_at(dvec3(8.0, 5.5, 0.0), 0.5);
    case.foot_at(dvec3(10.0, 4.0, 0.5), 0.5);
}

/// A hair off the rim of a curved face, the proof must reach the gap too.
#[test]
fn beside_a_curved_rim_the_gap_is_reached() {
    for face in [faces::ring_of_a_saddle(), faces::creased_disc(), faces::stamp_on_a_sheet(), faces::valley_cut_away()]
    {
        let case = Case::new(face);
        let rim: Vec<DVec3> = case.oracle.rim_points().collect();
        let middle = rim.iter().sum::<DVec3>() / rim.len() as f64;
        let size = rim[0].distance(middle);
        let mut lost = Vec::new();
        for (k, at) in rim.iter().step_by(rim.len() / 12).enumerate() {
            for decade in -9..=-2 {
                let way = dvec3((k as f64).cos(), (k as f64).sin(), 0.6);
                let p = *at + size * 10.0_f64.powi(decade) * way;
                let (foot, wrong) = case.ask(p, case.oracle.nearest(p).distance, &mut Scratch::default());
                if let Some(wrong) = wrong {
                    lost.push((decade, foot.gap(), wrong));
                }
            }
        }
        let decades: Vec<(i32, f64)> = lost.iter().map(|(decade, gap, _)| (*decade, *gap)).collect();
        assert!(lost.is_empty(), "{} lost, by decade of the distance and gap: {decades:?}; {}", lost.len(), lost[0].2);
    }
}

/// A p-curve over many knots of a wavy carrier, and trims through its creases.
#[test]
fn edges_across_many_spans_are_met() {
    let corners = [dvec2(0.5, 0.7), dvec2(15.3, 7.1), dvec2(0.9, 15.1)];
    let face = faces::eggcrate_with_holes();
    let case = Case::new(Face::new("triangle of an eggcrate", face.surface, vec![polygon(true, &corners)]));
    for k in 0..40 {
        let x = 0.45 * f64::from(k);
        case.foot(dvec3(x, 2.0, 1.0));
        case.foot(dvec3(15.0 - 0.5 * x, 14.0, -1.0));
        case.foot(dvec3(x, 18.0 - x, 30.0));
    }
}
