//! Analytic shapes enter as their NURBS form, and their record says what they are: the class' parameters give the points of the
//! definition, at the ends of its parameters too.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use perpend::{
    Basis, Circle, Cone, Cylinder, DVec3, Definition, Direction, Ellipse, Entity, Frame, IntoDefinition, Kind, Line,
    Model, Plane, Sphere, Torus,
};

/// A frame that is aligned with nothing.
fn frame() -> Frame {
    let axis = DVec3::new(1.0, -2.0, 2.0) / 3.0;
    Frame { centre: DVec3::new(5.0, -3.0, 0.5), axis, xdir: DVec3::new(2.0, 2.0, 1.0) / 3.0 }
}

fn polar(axis: DVec3, xdir: DVec3, angle: f64) -> DVec3 {
    angle.cos() * xdir + angle.sin() * axis.cross(xdir)
}

/// The point of a shape where its parameters are, as shares of their ranges, `s` along u and `t` along v.
fn point(kind: &Kind, s: f64, t: f64) -> DVec3 {
    let at = |(from, to): (f64, f64), share: f64| from + share * (to - from);
    match kind {
        Kind::Line { origin, direction, range } => *origin + at(*range, s) * *direction,
        Kind::Circle { centre, axis, xdir, radius, sweep } => *centre + *radius * polar(*axis, *xdir, at(*sweep, s)),
        Kind::Ellipse { centre, axis, xdir, radii, sweep } => {
            let angle = at(*sweep, s);
            *centre + radii.0 * angle.cos() * *xdir + radii.1 * angle.sin() * axis.cross(*xdir)
        }
        Kind::Plane { origin, sides, .. } => {
            let (along_u, along_v) = sides.expect("a rectangle");
            *origin + s * along_u + t * along_v
        }
        Kind::Sphere { centre, axis, xdir, radius, sweep, latitude, .. } => {
            let latitude = at(*latitude, s);
            *centre + *radius * (latitude.cos() * polar(*axis, *xdir, at(*sweep, t)) + latitude.sin() * *axis)
        }
        Kind::Cylinder { centre, axis, xdir, radius, height, sweep, .. } => {
            *centre + *radius * polar(*axis, *xdir, at(*sweep, t)) + at(*height, s) * *axis
        }
        Kind::Cone { apex, axis, xdir, half_angle, height, sweep, .. } => {
            let height = at(*height, s);
            *apex + height * (half_angle.tan() * polar(*axis, *xdir, at(*sweep, t)) + *axis)
        }
        Kind::Torus { centre, axis, xdir, major_radius, minor_radius, sweep, section, .. } => {
            let (outwards, section) = (polar(*axis, *xdir, at(*sweep, t)), at(*section, s));
            *centre + *major_radius * outwards + *minor_radius * (section.cos() * outwards + section.sin() * *axis)
        }
        other => panic!("{other:?} is no analytic shape"),
    }
}

fn check(shape: impl IntoDefinition) {
    let mut model = Model::new();
    let id = model.insert("shape", shape).expect("a valid shape");
    let entity = model.entity(id).expect("known");
    assert_eq!(entity.stale(), Vec::<String>::new());
    let class = entity.record().and_then(|record| record.classification.as_ref()).expect("a class");
    let item = class.kind.as_ref().expect("a kind");
    assert_eq!(item.basis, Basis::Defined);
    // shares of a range are shares of the parameter at both ends and, by symmetry, in the middle
    for s in [0.0, 0.5, 1.0] {
        for t in [0.0, 0.5, 1.0] {
            let (on_shape, on_definition) = (point(&item.value, s, t), evaluate(entity, s, t));
            assert!(on_shape.distance(on_definition) < 1e-13, "{:?}: {on_shape} and {on_definition}", item.value);
        }
    }
    assert_eq!(Model::from_ron(&model.to_ron()), Ok(model));
}

/// The definition at shares of its parameters.
fn evaluate(entity: &Entity, s: f64, t: f64) -> DVec3 {
    let at = |(first, last): (f64, f64), share: f64| first + share * (last - first);
    match entity.definition().as_ref() {
        Definition::NurbsCurve(curve) => curve.point(at(curve.domain(), s)),
        Definition::NurbsSurface(surface) => {
            surface.point(at(surface.domain(Direction::U), s), at(surface.domain(Direction::V), t))
        }
    }
}

#[test]
fn the_class_of_a_shape_gives_its_points() {
    let frame = frame();
    check(Line { start: frame.centre, end: frame.centre + DVec3::new(1.0, 2.0, 3.0) });
    for sweep in [(0.0, TAU), (0.3, 2.0), (-1.0, 3.5)] {
        check(Circle { frame, radius: 2.0, sweep });
        check(Ellipse { frame, radii: (2.0, 0.5), sweep });
        check(Cylinder { frame, radius: 1.5, height: (-1.0, 4.0), sweep });
        check(Cone { frame, radii: (0.0, 2.0), height: (1.0, 4.0), sweep });
        check(Cone { frame, radii: (2.5, 1.0), height: (-1.0, 4.0), sweep });
        check(Cone { frame, radii: (1.0, 2.5), height: (-1.0, 4.0), sweep });
        check(Sphere { frame, radius: 2.0, latitude: (-FRAC_PI_2, FRAC_PI_2), sweep });
        check(Sphere { frame, radius: 2.0, latitude: (-0.2, 1.0), sweep });
        check(Torus { frame, major: 3.0, minor: 1.0, tube: (0.0, TAU), sweep });
        check(Torus { frame, major: 3.0, minor: 1.0, tube: (-1.0, PI), sweep });
    }
    // its fields need not be of unit length or perpendicular
    let careless = Frame { axis: 7.0 * frame.axis, xdir: 0.1 * frame.xdir + frame.axis, ..frame };
    check(Cylinder { frame: careless, radius: 1.5, height: (-1.0, 4.0), sweep: (0.3, 2.0) });
    check(Circle { frame: careless, radius: 1.5, sweep: (0.3, 2.0) });
    check(Plane { frame, width: (-1.0, 2.0), height: (0.5, 4.0) });
}

#[test]
fn an_impossible_shape_is_refused() {
    let circle = Circle { frame: frame(), radius: -1.0, sweep: (0.0, TAU) };
    let error = Model::new().insert("circle", circle).expect_err("a negative radius").to_string();
    assert!(error.starts_with("radius is -1"), "{error}");
    let point = Line { start: DVec3::ONE, end: DVec3::ONE };
    assert!(Model::new().insert("point", point).is_err());
}
