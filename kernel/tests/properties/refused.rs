//! Bad arguments are refused, with a message that says what is wrong.

use perpend_kernel::glam::{DAffine3, DVec3};
use perpend_kernel::{
    Circle, Cone, Cylinder, Direction, Ellipse, Frame, Line, NurbsCurve, NurbsSurface, Plane, Spacing, Sphere, Torus,
    curve_through, extrusion, revolution, surface_through,
};
use std::f64::consts::{PI, TAU};

fn curve() -> NurbsCurve {
    let points = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    NurbsCurve::new(2, vec![0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 2.0], points, None).expect("valid")
}

fn surface() -> NurbsSurface {
    Plane::new(Frame::WORLD, (0.0, 1.0), (0.0, 1.0)).expect("valid").to_nurbs().expect("valid")
}

/// What a refused act says.
fn said<T: std::fmt::Debug, E: std::error::Error>(result: Result<T, E>) -> String {
    result.expect_err("refused").to_string()
}

#[test]
fn bad_edits_are_named() {
    let (curve, surface) = (curve(), surface());
    for u in [0.0, 2.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(said(curve.insert_knot(u, 1)).contains("strictly between 0 and 2"));
        assert!(said(curve.split(u)).contains("strictly between 0 and 2"));
    }
    assert!(said(curve.insert_knot(1.0, 2)).contains("multiplicity 3; the degree, 2"));
    assert!(said(curve.insert_knot(0.5, usize::MAX)).contains("insert it fewer times"));
    assert!(said(curve.refine(&[0.5, 0.7, 0.5, 0.5])).contains("the knot 0.5 would have multiplicity 3"));
    assert!(said(curve.elevate_degree(24)).contains("degree would be 26"));
    assert!(said(curve.elevate_degree(usize::MAX)).contains("25 is the highest"));
    assert!(said(curve.remove_knot(0.5, 1, 0.1)).contains("0.5 is not an interior knot"));
    assert!(said(curve.remove_knot(0.0, 1, 0.1)).contains("0 is not an interior knot"));
    assert!(said(curve.remove_knot(1.0, 1, -0.1)).contains("tolerance is -0.1"));
    assert!(said(curve.remove_knot(1.0, 1, f64::NAN)).contains("tolerance is NaN"));
    assert!(said(curve.with_domain(1.0, 1.0)).contains("domain is the single value 1"));
    assert!(said(curve.with_domain(1.0, 0.0)).contains("sort the knots"));
    assert!(said(curve.with_domain(0.0, f64::NAN)).contains("NaN"));
    assert!(said(curve.transformed(&DAffine3::from_scale(DVec3::ZERO))).contains("all control points are equal"));
    assert!(said(curve.transformed(&DAffine3::from_scale(DVec3::splat(1e120)))).contains("control_points[1]"));
    assert!(said(surface.split(Direction::V, 1.0)).contains("the v parameter is 1"));
    assert!(said(surface.iso_curve(Direction::U, 1.5)).contains("from the domain, between 0 and 1"));
    assert!(said(surface.insert_knot(Direction::U, 0.5, 2)).contains("the u knot 0.5 would have multiplicity 2"));
}

#[test]
fn splitting_off_a_part_that_is_one_point_is_refused() {
    let points = vec![DVec3::ONE, DVec3::ONE, DVec3::X];
    let waits = NurbsCurve::new(1, vec![0.0, 0.0, 1.0, 2.0, 2.0], points, None).expect("valid");
    assert!(said(waits.split(1.0)).contains("all control points are equal"));
}

#[test]
fn bad_shapes_are_named() {
    let (world, turn) = (Frame::WORLD, (0.0, TAU));
    assert!(
        said(Frame::new(DVec3::ZERO, DVec3::ZERO, DVec3::X))
            .contains("axis is [0, 0, 0]; it must be finite and not zero")
    );
    assert!(said(Frame::new(DVec3::ZERO, DVec3::Z, DVec3::NEG_Z)).contains("parallel"));
    assert!(said(Frame::new(DVec3::NAN, DVec3::Z, DVec3::X)).contains("centre"));
    assert!(said(Frame::about(DVec3::ZERO, DVec3::NAN)).contains("axis"));
    assert!(said(Line::new(DVec3::X, DVec3::X)).contains("all control points are equal"));
    assert!(said(Circle::new(world, -1.0, turn)).contains("radius is -1; it must be positive"));
    assert!(said(Circle::new(world, 1.0, (0.0, 6.3))).contains("at most a full turn"));
    assert!(said(Circle::new(world, 1.0, (1.0, 1.0))).contains("must ascend"));
    assert!(said(Circle::new(world, 1.0, (0.0, f64::NAN))).contains("sweep is (0.0, NaN)"));
    assert!(said(Ellipse::whole(world, (1.0, 0.0))).contains("radius along ydir is 0"));
    assert!(said(Plane::new(world, (1.0, 0.0), (0.0, 1.0))).contains("width"));
    assert!(said(Cylinder::new(world, f64::INFINITY, (0.0, 1.0), turn)).contains("radius is inf"));
    assert!(said(Cylinder::new(world, 1.0, (0.0, 0.0), turn)).contains("height"));
    assert!(said(Cone::new(world, (1.0, 1.0), (0.0, 1.0), turn)).contains("equal radii are a cylinder"));
    assert!(said(Cone::new(world, (1.0, -1.0), (0.0, 1.0), turn)).contains("not negative"));
    assert!(said(Sphere::new(world, 1.0, (0.0, PI), turn)).contains("within -π/2 and π/2"));
    assert!(said(Torus::whole(world, 1.0, 2.0)).contains("at most the major radius"));
    assert!(said(Torus::new(world, 2.0, 1.0, (0.0, 7.0), turn)).contains("tube"));
    // fields are open: what `new` did not see, `to_nurbs` refuses
    let bent = Circle { frame: Frame { axis: DVec3::ZERO, ..world }, radius: 1.0, sweep: turn };
    assert!(said(bent.to_nurbs()).contains("axis"));
}

#[test]
fn bad_constructions_are_named() {
    let points = [DVec3::ZERO, DVec3::X, DVec3::X, DVec3::Y];
    assert!(
        said(curve_through(&points, 3, Spacing::ChordLength))
            .contains("point 2 and the one before it get the same parameter")
    );
    assert!(said(curve_through(&points, 4, Spacing::Uniform)).contains("4 points and degree 4"));
    assert!(said(curve_through(&points, 0, Spacing::Uniform)).contains("degree 0"));
    assert!(said(curve_through(&[DVec3::ZERO, DVec3::NAN], 1, Spacing::Uniform)).contains("point 1 is [NaN"));
    assert!(said(curve_through(&[DVec3::ONE; 3], 1, Spacing::Centripetal)).contains("same parameter"));
    assert!(said(curve_through(&[DVec3::ONE; 3], 1, Spacing::Uniform)).contains("all control points are equal"));
    let ragged = [points.to_vec(), vec![DVec3::ONE]];
    assert!(said(surface_through(&ragged, (1, 1), Spacing::Uniform)).contains("row 1 has 1 points, row 0 has 4"));
    assert!(said(surface_through(&[], (1, 1), Spacing::Uniform)).contains("0 points"));
    assert!(said(extrusion(&curve(), DVec3::ZERO)).contains("path is [0, 0, 0]"));
    assert!(said(revolution(&curve(), DVec3::ZERO, DVec3::ZERO, 1.0)).contains("axis"));
    assert!(said(revolution(&curve(), DVec3::ZERO, DVec3::X, 7.0)).contains("full turn"));
    assert!(said(revolution(&curve(), DVec3::ZERO, DVec3::X, 0.0)).contains("angle"));
}
