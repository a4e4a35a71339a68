//! Evaluation does not allocate.

use perpend_kernel::glam::DVec3;
use perpend_kernel::{Circle, Frame, Line, NurbsCurve, NurbsSurface, Plane, Torus, curve_through};
use std::hint::black_box;

/// How often `act` asked for memory.
fn allocations(act: impl FnOnce()) -> u64 {
    allocation_counter::measure(act).count_total
}

fn curves() -> Vec<NurbsCurve> {
    let points: Vec<DVec3> = (0..40).map(|k| DVec3::new(f64::from(k), f64::from(k * k % 7), 0.0)).collect();
    let line = Line::new(DVec3::ZERO, DVec3::X).expect("valid").to_nurbs().expect("valid");
    let high = line.elevate_degree(24).expect("up to degree 25");
    let circle = Circle::whole(Frame::WORLD, 2.0).expect("valid").to_nurbs().expect("valid");
    let smooth = curve_through(&points, 3, perpend_kernel::Spacing::Uniform).expect("valid");
    vec![line, high, circle, smooth]
}

fn surfaces() -> Vec<NurbsSurface> {
    let plane = Plane::new(Frame::WORLD, (0.0, 1.0), (0.0, 2.0)).expect("valid").to_nurbs().expect("valid");
    vec![plane, Torus::whole(Frame::WORLD, 3.0, 1.0).expect("valid").to_nurbs().expect("valid")]
}

#[test]
fn the_count_sees_an_allocation() {
    assert_eq!(allocations(|| drop(black_box(vec![1.0; 100]))), 1);
}

#[test]
fn points_and_derivatives_of_curves_need_no_memory() {
    let mut d = [DVec3::ZERO; 30];
    for curve in curves() {
        let count = allocations(|| {
            for k in 0..=50 {
                let u = f64::from(k) / 50.0;
                black_box(curve.point(u));
                curve.derivatives(u, &mut d);
                curve.derivatives_from_left(u, &mut d[..3]);
                black_box(d[1]);
            }
        });
        assert_eq!(count, 0, "degree {}", curve.degree());
    }
}

#[test]
fn points_derivatives_and_normals_of_surfaces_need_no_memory() {
    let mut d = [DVec3::ZERO; 36];
    for surface in surfaces() {
        let count = allocations(|| {
            for k in 0..=50 {
                let (u, v) = (f64::from(k) / 50.0, f64::from(k % 7) / 6.0);
                black_box(surface.point(u, v));
                surface.derivatives(u, v, 5, &mut d);
                surface.derivatives_from(u, v, [true, true], 5, &mut d);
                black_box(surface.normal(u, v));
            }
        });
        assert_eq!(count, 0);
    }
}
