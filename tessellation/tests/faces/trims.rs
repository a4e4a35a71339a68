//! Trimmed faces: regions, errors, orientation, and trims that touch, cross or nearly vanish.

use glam::{DVec2, DVec3};
use perpend_kernel::{Cylinder, Frame, NurbsSurface, Plane, Side, Sphere, Trimming};
use perpend_tessellation::{Limits, Mesh, tessellate};
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, TAU};

use crate::oracle::{circle, distance_to_mesh, entered, largest_deviation, polygons, spread, surfaces, try_polygons};

fn unit_square() -> NurbsSurface {
    Plane::new(Frame::WORLD, (0.0, 1.0), (0.0, 1.0)).unwrap().to_nurbs().unwrap()
}

fn mesh(surface: &NurbsSurface, trimming: &Trimming, chord: f64) -> Mesh {
    tessellate(surface, Some(trimming), chord, Limits::default()).unwrap()
}

/// Corners of the parameters of each triangle, counter-clockwise.
fn plane_area(mesh: &Mesh) -> f64 {
    let area = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|i| mesh.parameters[i as usize]);
        0.5 * (b - a).perp_dot(c - a)
    };
    mesh.triangles.iter().map(area).sum()
}

#[test]
fn a_reversed_face_shows_its_other_side() {
    let plane = unit_square();
    let square = vec![DVec2::new(0.2, 0.2), DVec2::new(0.8, 0.2), DVec2::new(0.8, 0.8), DVec2::new(0.2, 0.8)];
    for (reversed, sense) in [(false, DVec3::Z), (true, DVec3::NEG_Z)] {
        let mesh = mesh(&plane, &polygons(&plane, std::slice::from_ref(&square), reversed), 0.1);
        assert!((mesh.area() - 0.36).abs() < 1e-12);
        assert!(mesh.normals.iter().all(|normal| *normal == sense));
        assert!(mesh.corners().all(|[a, b, c]| (b - a).cross(c - a).dot(sense) > 0.0));
    }
}

#[test]
fn trims_may_touch_each_other_and_the_border() {
    let plane = unit_square();
    let middle = DVec2::splat(0.5);
    // the outer one touches the border in four points, the inner ones each other and the outer one
    let holes = [0.25, 0.75].map(|x| circle(DVec2::new(x, 0.5), 0.25, false));
    let [left, right] = holes;
    let trimming = entered(&plane, vec![circle(middle, 0.5, true), left, right], false);
    for chord in [0.05, 1e-3, 1e-5] {
        let mesh = mesh(&plane, &trimming, chord);
        let area = std::f64::consts::PI * (0.25 - 0.125);
        assert!((mesh.area() - area).abs() <= 2.0 * TAU * mesh.error, "{} {area}", mesh.area());
    }
}

#[test]
fn a_part_that_was_cut_twice_is_not_counted() {
    // a slit: the loop runs to the hole and back on one line
    let plane = unit_square();
    let p = |x: f64, y: f64| DVec2::new(x, y);
    let slit = vec![
        p(0.1, 0.1),
        p(0.9, 0.1),
        p(0.9, 0.9),
        p(0.1, 0.9),
        p(0.1, 0.5),
        p(0.4, 0.5),
        p(0.4, 0.6),
        p(0.6, 0.6),
        p(0.6, 0.4),
        p(0.4, 0.4),
        p(0.4, 0.5),
        p(0.1, 0.5),
    ];
    let mesh = mesh(&plane, &polygons(&plane, &[slit], false), 0.01);
    assert!((mesh.area() - (0.64 - 0.04)).abs() < 1e-12, "{}", mesh.area());
}

#[test]
fn a_sliver_far_thinner_than_the_chord_error_has_triangles() {
    let plane = unit_square();
    let p = |x: f64, y: f64| DVec2::new(x, y);
    let sliver = vec![p(0.1, 0.5), p(0.9, 0.5), p(0.9, 0.5 + 1e-9)];
    let mesh = mesh(&plane, &polygons(&plane, &[sliver], false), 0.1);
    assert!((mesh.area() - 0.4e-9).abs() < 1e-15, "{}", mesh.area());
}

#[test]
fn a_hemisphere_trimmed_through_its_pole() {
    // the parameters' rectangle as a trim: it runs along the seam twice and through the pole
    let cap = Sphere::new(Frame::WORLD, 1.0, (0.0, FRAC_PI_2), (0.0, TAU)).unwrap().to_nurbs().unwrap();
    let p = |x: f64, y: f64| DVec2::new(x, y);
    let whole = vec![p(0.0, 0.0), p(1.0, 0.0), p(1.0, 1.0), p(0.0, 1.0)];
    let mesh = mesh(&cap, &polygons(&cap, &[whole], true), 0.001);
    assert!((mesh.area() - TAU).abs() < 0.01, "{}", mesh.area());
    assert!(mesh.normals.iter().zip(&mesh.vertices).all(|(normal, vertex)| normal.dot(*vertex) > 0.999));
}

#[test]
fn a_small_face_of_a_large_carrier_is_not_paid_for_by_its_size() {
    let tube = Cylinder::new(Frame::WORLD, 1000.0, (-1e5, 1e5), (0.0, TAU)).unwrap().to_nurbs().unwrap();
    let trimming = entered(&tube, vec![circle(DVec2::splat(0.6), 0.001, true)], false);
    let mesh = mesh(&tube, &trimming, 1e-3);
    assert!(mesh.error <= 1e-3, "{} {}", mesh.error, mesh.triangles.len());
    assert!(mesh.triangles.len() < 20_000, "{}", mesh.triangles.len());
    assert!(largest_deviation(&tube, &mesh) <= mesh.error);
}

/// Loops of random corners: they cross themselves, each other and the lines between cells.
fn loops() -> impl Strategy<Value = Vec<Vec<DVec2>>> {
    let share = prop_oneof![3 => 0.0..1.0_f64, 1 => Just(0.0), 1 => Just(0.5), 1 => Just(1.0), 1 => Just(0.5 + 1e-15), 1 => Just(1e-300)];
    prop::collection::vec(prop::collection::vec((share.clone(), share).prop_map(DVec2::from), 3..7), 1..4)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn meshes_of_any_loops_fit_their_regions(surface in surfaces(), loops in loops(), share in 0.01..0.3_f64) {
        let scale = DVec2::new(
            surface.domain(perpend_kernel::Direction::U).1,
            surface.domain(perpend_kernel::Direction::V).1,
        );
        let mut loops = loops;
        for points in &mut loops {
            points.iter_mut().for_each(|point| *point *= scale);
            points.dedup();
            while points.len() > 1 && points.first() == points.last() {
                points.pop();
            }
        }
        loops.retain(|points| points.len() > 2);
        prop_assume!(!loops.is_empty());
        let entered = try_polygons(&surface, &loops, false);
        prop_assume!(entered.is_ok());
        let trimming = entered.unwrap();
        let size = surface.control_box().diagonal();
        let mesh = mesh(&surface, &trimming, share * size);
        prop_assert!(mesh.error <= share * size);
        prop_assert!(largest_deviation(&surface, &mesh) <= mesh.error + 1e-14 * size);
        // polygons are their own polylines: the mesh covers the region and nothing else
        let region = trimming.region();
        for at in spread(&surface, 9) {
            let near = loops.iter().any(|points| (0..points.len()).any(|i| {
                let (a, b) = (points[i], points[(i + 1) % points.len()]);
                crate::oracle::distance_to_segment(at.extend(0.0), a.extend(0.0), b.extend(0.0)) < 1e-9
            }));
            if near {
                continue;
            }
            let covered = mesh.triangles.iter().any(|triangle| {
                let [a, b, c] = triangle.map(|i| mesh.parameters[i as usize]);
                let (low, high) = (a.min(b).min(c), a.max(b).max(c));
                at == at.clamp(low, high) && [(a, b), (b, c), (c, a)].iter().all(|(a, b)| (*b - *a).perp_dot(at - *a) >= 0.0)
            });
            let inside = region.side(at) == Side::Inside;
            let lost_at_a_pole = !covered
                && inside
                && distance_to_mesh(surface.point(at.x, at.y), &mesh) <= mesh.error + 1e-14 * size;
            prop_assert!(covered == inside || lost_at_a_pole, "{at} covered {covered}, inside {inside}");
        }
        prop_assert!(plane_area(&mesh) >= 0.0);
    }

    #[test]
    fn meshes_of_curved_trims_are_within_their_error(
        surface in surfaces(),
        (x, y, radius) in (0.3..0.7_f64, 0.3..0.7_f64, 0.01..0.29_f64),
        share in 0.005..0.1_f64,
    ) {
        let (u, v) = (surface.domain(perpend_kernel::Direction::U).1, surface.domain(perpend_kernel::Direction::V).1);
        let least = u.min(v);
        let centre = DVec2::new(x * u, y * v);
        let trimming = entered(&surface, vec![circle(centre, radius * least, true)], false);
        let size = surface.control_box().diagonal();
        let mesh = mesh(&surface, &trimming, share * size);
        prop_assert!(mesh.error <= share * size);
        let rounding = 1e-14 * size;
        // the rim is within the error of the mesh, and so is all that is inside
        for k in 0..40 {
            let angle = f64::from(k) * 0.157;
            let within = if k % 4 == 0 { f64::from(k) / 40.0 } else { 1.0 };
            let at = centre + within * radius * least * DVec2::from_angle(angle);
            let distance = distance_to_mesh(surface.point(at.x, at.y), &mesh);
            prop_assert!(distance <= mesh.error + rounding, "{at}: {distance} > {}", mesh.error);
        }
        // corners lie on the face, or on its rim
        for at in &mesh.parameters {
            prop_assert!(at.distance(centre) <= radius * least * (1.0 + 1e-12));
        }
    }
}
