//! Whole curves and surfaces of stationary points come back as such, and at a bounded cost.

use std::f64::consts::{FRAC_PI_2, TAU};

use perpend::{Circle, Cylinder, DVec3, Definition, Extremum, Frame, ParameterBox, Sphere, StationaryPoints, Torus};

use crate::One;

const TURN: (f64, f64) = (0.0, TAU);

fn holds(boxes: &[ParameterBox], u: f64, v: f64) -> bool {
    let slack = 1e-6;
    let within = |(from, to): (f64, f64), x: f64| from - slack <= x && x <= to + slack;
    boxes.iter().any(|b| within(b.u, u) && within(b.v, v))
}

/// Whether some continuum covers the curve of parameters `at(k / 16)`.
fn is_covered(found: &StationaryPoints, at: impl Fn(f64) -> (f64, f64)) -> bool {
    found
        .continua
        .iter()
        .any(|set| (0..=16).all(|k| holds(&set.boxes, at(f64::from(k) / 16.0).0, at(f64::from(k) / 16.0).1)))
}

#[test]
fn the_axis_of_a_circle_sees_all_of_it() {
    let one = One::new(Circle::new(Frame::WORLD, 2.0, TURN).expect("valid").to_nurbs().expect("valid"));
    for p in [DVec3::ZERO, DVec3::new(0.0, 0.0, 3.0), DVec3::new(0.0, 0.0, -1e3)] {
        let found = one.stationary(p);
        assert!(found.points.is_empty() && found.complete && found.continua.len() == 1, "{p}: {found:?}");
        assert!(is_covered(&found, |share| (share, 0.0)));
    }
    // beside it: two points again, down to where rounding hides them
    for off in [1e-3, 1e-6, 1e-9] {
        let found = one.stationary(DVec3::new(off, 0.0, 1.0));
        assert_eq!((found.points.len(), found.continua.len()), (2, 0), "{off}: {found:?}");
    }
}

#[test]
fn the_axes_of_surfaces_of_revolution_see_circles_and_the_centre_of_a_sphere_all() {
    let tube = One::new(Cylinder::new(Frame::WORLD, 2.0, (0.0, 3.0), TURN).expect("valid").to_nurbs().expect("valid"));
    let found = tube.stationary(DVec3::new(0.0, 0.0, 1.0));
    assert!(found.complete && found.points.is_empty());
    assert_eq!(found.continua.len(), 3, "the nearest circle and both ends: {found:?}");
    assert!(is_covered(&found, |share| (1.0 / 3.0, share)) && is_covered(&found, |share| (1.0, share)));
    let ring = One::new(Torus::new(Frame::WORLD, 3.0, 1.0, TURN, TURN).expect("valid").to_nurbs().expect("valid"));
    let found = ring.stationary(DVec3::new(0.0, 0.0, 0.5));
    assert!(found.complete && found.points.is_empty());
    assert_eq!(found.continua.len(), 2, "the nearest circle and the farthest: {found:?}");
    let ball = Sphere::new(Frame::WORLD, 2.0, (-FRAC_PI_2, FRAC_PI_2), TURN).expect("valid");
    let found = One::new(ball.to_nurbs().expect("valid")).stationary(DVec3::ZERO);
    assert!(found.points.is_empty());
    assert_eq!(found.continua.len(), 1);
    assert!((0..=8).all(|k| is_covered(&found, |share| (share, f64::from(k) / 8.0))));
}

/// On the spine, a circle of the tube is as near, and the gradient tells it from its surroundings by a square only: the budget ends the search.
#[test]
fn where_a_continuum_spends_the_budget_it_is_covered_and_the_other_points_are_found() {
    let ring: Definition =
        Torus::new(Frame::WORLD, 3.0, 1.0, TURN, TURN).expect("valid").to_nurbs().expect("valid").into();
    let found = One::new(ring).stationary(DVec3::new(3.0, 0.0, 0.0));
    assert!(is_covered(&found, |share| (share, 0.0)) || is_covered(&found, |share| (share, 1.0)), "{found:?}");
    let others: Vec<_> = found.points.iter().map(|point| (point.kind, point.distance)).collect();
    assert_eq!(others.len(), 2, "{others:?}");
    assert!(others.iter().any(|(kind, d)| *kind == Some(Extremum::Maximum) && (d - 7.0).abs() < 1e-12));
    assert!(others.iter().any(|(kind, d)| *kind == Some(Extremum::Saddle) && (d - 5.0).abs() < 1e-12));
}
