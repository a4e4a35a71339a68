//! Areas and volumes of shapes that have a formula.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::{DVec2, DVec3};
use perpend_kernel::{Cone, Cylinder, Frame, NurbsSurface, Plane, Sphere, Torus};
use perpend_tessellation::{Limits, Mesh, tessellate};

use crate::oracle::{circle, entered};

/// Areas of inscribed triangles fall short in proportion to the chord error: at half of it, by half as much.
fn check(mesh: impl Fn(f64) -> Mesh, area: f64, chord: f64) {
    let short = |chord: f64| {
        let short = (area - mesh(chord).area()) / area;
        assert!(short > -1e-12, "{short}");
        short
    };
    let (coarse, fine) = (short(chord), short(chord / 64.0));
    assert!(coarse < 0.1 && fine < coarse / 16.0, "{coarse} {fine}");
}

#[test]
fn areas_of_analytic_shapes() {
    let cylinder = Cylinder::new(Frame::WORLD, 2.0, (0.0, 3.0), (0.0, TAU)).unwrap().to_nurbs().unwrap();
    let cone = Cone::new(Frame::WORLD, (0.0, 3.0), (0.0, 4.0), (0.0, TAU)).unwrap().to_nurbs().unwrap();
    let sphere = Sphere::whole(Frame::WORLD, 2.0).unwrap().to_nurbs().unwrap();
    let zone = Sphere::new(Frame::WORLD, 2.0, (0.0, FRAC_PI_2), (0.5, 1.5)).unwrap().to_nurbs().unwrap();
    let torus = Torus::whole(Frame::WORLD, 3.0, 1.0).unwrap().to_nurbs().unwrap();
    let of =
        |surface, area: f64| check(|chord| tessellate(surface, None, chord, Limits::default()).unwrap(), area, 0.1);
    of(&cylinder, TAU * 2.0 * 3.0);
    of(&cone, PI * 3.0 * 5.0);
    of(&sphere, 4.0 * PI * 4.0);
    of(&zone, 4.0);
    of(&torus, 4.0 * PI * PI * 3.0);
}

/// A strip between a straight line and one across it: z = x y over the rectangle, ten times as long as wide.
#[test]
fn the_area_of_a_twisted_strip_is_approached() {
    let point = |x: f64, y: f64| DVec3::new(x, y, x * y);
    let knots = || vec![0.0, 0.0, 1.0, 1.0];
    let points = [0.0, 1.0].map(|x| [0.0, 10.0].map(|y| point(x, y)).to_vec()).to_vec();
    let strip = NurbsSurface::new((1, 1), (knots(), knots()), points, None).unwrap();
    // the mean of sqrt(1 + x² + y²), by the midpoint rule
    let steps = 1000;
    let middle = |k: usize, length: f64| (k as f64 + 0.5) / steps as f64 * length;
    let at = |k: usize| (1.0 + middle(k / steps, 1.0).powi(2) + middle(k % steps, 10.0).powi(2)).sqrt();
    let area = 10.0 * (0..steps * steps).map(at).sum::<f64>() / (steps * steps) as f64;
    for (chord, share) in [(0.1, 1e-1), (0.01, 1e-2), (1e-4, 1e-4)] {
        let found = tessellate(&strip, None, chord, Limits::default()).unwrap().area();
        assert!((found / area - 1.0).abs() < share, "{chord}: {found} {area}");
    }
}

#[test]
fn an_annulus_of_a_plane() {
    let plane = Plane::new(Frame::WORLD, (-3.0, 3.0), (-3.0, 3.0)).unwrap().to_nurbs().unwrap();
    let middle = DVec2::splat(0.5);
    let trimming = entered(&plane, vec![circle(middle, 0.4, true), circle(middle, 0.2, false)], false);
    for chord in [0.3, 0.01, 1e-4] {
        let mesh = tessellate(&plane, Some(&trimming), chord, Limits::default()).unwrap();
        assert!(mesh.error <= chord);
        let missing = (mesh.area() - PI * (2.4_f64.powi(2) - 1.2_f64.powi(2))).abs();
        // both rims, each off by at most the error
        assert!(missing <= TAU * (2.4 + 1.2) * mesh.error, "{missing} {}", mesh.error);
        assert!(mesh.triangles.len() < 40 + (30.0 / chord.sqrt()) as usize, "{}", mesh.triangles.len());
    }
}

#[test]
fn the_volume_of_a_ball_has_the_sign_of_its_normals() {
    // u along the latitude, v along the longitude: S_u × S_v points inward
    let sphere = Sphere::whole(Frame::WORLD, 1.0).unwrap().to_nurbs().unwrap();
    let mesh = tessellate(&sphere, None, 1e-3, Limits::default()).unwrap();
    assert!((mesh.volume() + 4.0 / 3.0 * PI).abs() < 0.02, "{}", mesh.volume());
    for (normal, vertex) in mesh.normals.iter().zip(&mesh.vertices) {
        assert!(normal.dot(*vertex) < -0.999, "{normal} at {vertex}");
    }
}
