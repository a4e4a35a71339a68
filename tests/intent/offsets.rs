//! Offsets: at the distance that was asked for, on the side of the normal.

use std::f64::consts::{FRAC_PI_2, TAU};

use perpend::{
    Circle, Cone, Cylinder, DVec3, Definition, Direction, EntityId, Frame, Line, Model, Operation, Plane, Sphere, Torus,
};

fn frame() -> Frame {
    Frame::new(DVec3::new(30.0, -7.0, 2.0), DVec3::new(0.3, -0.5, 0.8), DVec3::X).expect("a frame")
}

fn offset(distance: f64) -> Operation {
    Operation::Offset { distance, normal: None }
}

/// Every point of the offset is at that distance from the surface, on the side of its normal; and the normals agree.
fn check(model: &mut Model, id: EntityId, distance: f64) {
    let made = model.make("offset", offset(distance), &[id]).expect("an exact offset");
    let surface = |id| match model.entity(id).expect("known").definition().as_ref() {
        Definition::NurbsSurface(surface) => surface.clone(),
        Definition::NurbsCurve(_) => panic!("a surface"),
    };
    let (below, above) = (surface(id), surface(made));
    assert_eq!(below.domain(Direction::U), above.domain(Direction::U));
    assert_eq!(below.domain(Direction::V), above.domain(Direction::V));
    let [(u0, u1), (v0, v1)] = [Direction::U, Direction::V].map(|along| below.domain(along));
    for i in 1..12 {
        for j in 1..12 {
            let (u, v) = (u0 + (u1 - u0) * f64::from(i) / 12.0, v0 + (v1 - v0) * f64::from(j) / 12.0);
            let point = above.point(u, v);
            let foot = model.project(id, point).expect("a valid query");
            // recognition's fit, and rounding of points some 30 out
            let near = 1e-12 * 40.0;
            assert!((foot.distance - distance.abs()).abs() < near, "{distance} at {u}, {v}: {foot:?}");
            assert!((foot.signed_distance.expect("a normal") - distance).abs() < near);
            let side = above.normal(u, v).normalize().dot(foot.normal.expect("a normal"));
            assert!(side > 1.0 - 1e-9, "the side is kept");
        }
    }
    assert_eq!(model.replay(made).expect("made").drift.proven, 0.0);
}

#[test]
fn surfaces_are_offset_along_their_normals() {
    let frame = frame();
    let shapes: Vec<Definition> = vec![
        Plane::new(frame, (-1.0, 2.0), (0.0, 3.0)).and_then(|shape| shape.to_nurbs()).expect("valid").into(),
        Cylinder::new(frame, 1.5, (1.0, 4.0), (0.5, 3.0)).and_then(|shape| shape.to_nurbs()).expect("valid").into(),
        Cone::new(frame, (1.0, 2.0), (0.0, 3.0), (0.0, TAU)).and_then(|shape| shape.to_nurbs()).expect("valid").into(),
        Cone::new(frame, (2.0, 1.0), (0.0, 3.0), (1.0, 2.5)).and_then(|shape| shape.to_nurbs()).expect("valid").into(),
        Sphere::new(frame, 2.0, (-1.0, FRAC_PI_2), (0.0, 4.0))
            .and_then(|shape| shape.to_nurbs())
            .expect("valid")
            .into(),
        Torus::new(frame, 3.0, 1.0, (0.0, TAU), (0.2, 2.0)).and_then(|shape| shape.to_nurbs()).expect("valid").into(),
    ];
    for shape in shapes {
        let Definition::NurbsSurface(shape) = shape else { panic!("a surface") };
        for turned in [
            shape.clone(),
            shape.swapped(),
            shape.reversed(Direction::U),
            shape.reversed(Direction::V),
            shape.with_domain(Direction::U, 3.0, 7.0).expect("valid").reversed(Direction::V).swapped(),
        ] {
            let mut model = Model::new();
            let id = model.insert("shape", turned).expect("valid");
            check(&mut model, id, 0.25);
            check(&mut model, id, -0.25);
        }
    }
}

#[test]
fn curves_are_offset_in_their_plane() {
    let mut model = Model::new();
    let circle = model.insert("rim", Circle::new(frame(), 2.0, (0.4, 3.0)).expect("valid")).expect("valid");
    for (normal, distance, radius) in
        [(None, 0.5, 2.5), (None, -0.5, 1.5), (Some(frame().axis), 0.5, 2.5), (Some(-3.0 * frame().axis), 0.5, 1.5)]
    {
        let made = model.make("offset", Operation::Offset { distance, normal }, &[circle]).expect("exact");
        let curve = model.entity(made).expect("known").definition().clone();
        let Definition::NurbsCurve(curve) = curve.as_ref() else { panic!("a curve") };
        for k in 0..=20 {
            let point = curve.point(f64::from(k) / 20.0);
            assert!((point.distance(frame().centre) - radius).abs() < 1e-11, "{normal:?}");
        }
    }
    let line = model.insert("edge", Line::new(DVec3::ZERO, DVec3::new(2.0, 0.0, 0.0)).expect("valid")).expect("valid");
    let made =
        model.make("offset", Operation::Offset { distance: 0.5, normal: Some(DVec3::Z) }, &[line]).expect("exact");
    // right of the tangent, seen from where the normal points to
    assert!(model.project(made, DVec3::new(1.0, -0.5, 0.0)).expect("valid").distance < 1e-15);
}

#[test]
fn offsets_that_are_none_say_why() {
    let mut model = Model::new();
    let mut refused = |shape: &dyn Fn(&mut Model) -> EntityId, operation: Operation, why: &str| {
        let id = shape(&mut model);
        let error = model.make("offset", operation, &[id]).expect_err("no offset").to_string();
        assert!(error.contains(why), "{error}");
    };
    let circle = |model: &mut Model| model.insert("", Circle::whole(frame(), 2.0).expect("valid")).expect("valid");
    let line = |model: &mut Model| model.insert("", Line::new(DVec3::ZERO, DVec3::X).expect("valid")).expect("valid");
    let cone = |model: &mut Model| {
        model.insert("", Cone::new(frame(), (0.5, 2.0), (0.0, 3.0), (0.0, TAU)).expect("valid")).expect("valid")
    };
    let torus = |model: &mut Model| model.insert("", Torus::whole(frame(), 3.0, 1.0).expect("valid")).expect("valid");
    let sphere = |model: &mut Model| model.insert("", Sphere::whole(frame(), 2.0).expect("valid")).expect("valid");
    let with = |normal| Operation::Offset { distance: 0.1, normal: Some(normal) };
    refused(&circle, offset(-2.0), "the offset reaches the centre or axis");
    refused(&circle, with(frame().xdir), "the normal is not that of the circle's plane");
    refused(&line, offset(1.0), "a line is offset in a plane: give its normal");
    refused(&line, with(DVec3::NEG_X), "the normal is zero or runs along the line");
    refused(&line, with(DVec3::ZERO), "the normal is zero or runs along the line");
    // normals of perpend's own surfaces point inward
    refused(&cone, offset(1.0), "the offset passes the apex of the cone");
    refused(&torus, offset(1.0), "the offset passes the spine or the axis of the torus");
    refused(&torus, offset(-2.5), "the offset passes the spine or the axis of the torus");
    refused(&sphere, offset(2.0), "the offset reaches the centre or axis");
    refused(&sphere, offset(f64::MAX), "the offset reaches the centre or axis");
    refused(&sphere, offset(-1e80), "coordinates are finite and within");
}
