//! Work is bounded, and bad chord errors are refused.

use glam::DVec2;
use perpend_kernel::{Frame, Plane, Sphere};
use perpend_tessellation::{InvalidChord, Limits, tessellate};

use crate::oracle::{circle, entered, largest_deviation};

#[test]
fn a_limit_gives_a_coarser_mesh_that_says_so_and_its_error_fits() {
    let sphere = Sphere::whole(Frame::WORLD, 1.0).unwrap().to_nurbs().unwrap();
    let limits = Limits { triangles: 2000, ..Limits::default() };
    let mesh = tessellate(&sphere, None, 1e-9, limits).unwrap();
    assert!(mesh.triangles.len() <= 2000 && mesh.triangles.len() > 500, "{}", mesh.triangles.len());
    assert!(mesh.error > 1e-9 && mesh.error < 0.1, "{}", mesh.error);
    assert!(largest_deviation(&sphere, &mesh) <= mesh.error);
    let again = tessellate(&sphere, None, mesh.error, limits).unwrap();
    assert!(again.error <= mesh.error);
}

#[test]
fn trims_have_a_limit_too() {
    let plane = Plane::new(Frame::WORLD, (-1.0, 1.0), (-1.0, 1.0)).unwrap().to_nurbs().unwrap();
    let trimming = entered(&plane, vec![circle(DVec2::splat(0.5), 0.4, true)], false);
    let limits = Limits { segments: 64, ..Limits::default() };
    let mesh = tessellate(&plane, Some(&trimming), 1e-9, limits).unwrap();
    assert!(mesh.triangles.len() < 200 && mesh.error > 1e-9 && mesh.error < 0.01, "{}", mesh.error);
}

#[test]
fn what_is_finer_than_rounding_is_not_tried() {
    let plane = Plane::new(Frame::WORLD, (-1.0, 1.0), (-1.0, 1.0)).unwrap().to_nurbs().unwrap();
    let mesh = tessellate(&plane, None, 1e-300, Limits::default()).unwrap();
    assert_eq!(mesh.triangles.len(), 2);
}

#[test]
fn a_chord_error_is_a_positive_length() {
    let plane = Plane::new(Frame::WORLD, (-1.0, 1.0), (-1.0, 1.0)).unwrap().to_nurbs().unwrap();
    for chord in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let refused = tessellate(&plane, None, chord, Limits::default());
        assert!(matches!(refused, Err(InvalidChord { .. })), "{chord}");
    }
}
