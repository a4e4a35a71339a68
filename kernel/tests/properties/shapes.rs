//! Shapes lie on their implicit equations, cover their ranges, and close.

use perpend_kernel::glam::DVec3;
use perpend_kernel::{
    Circle, Cone, Cylinder, Direction, Ellipse, Frame, Line, NurbsCurve, NurbsSurface, Plane, Sphere, Torus,
};
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Where a point lies in a frame: distance from the axis, height, angle.
struct Place {
    distance: f64,
    height: f64,
    angle: f64,
}

fn place(frame: &Frame, point: DVec3) -> Place {
    let arm = point - frame.centre;
    let (x, y) = (arm.dot(frame.xdir), arm.dot(frame.axis.cross(frame.xdir)));
    Place { distance: x.hypot(y), height: arm.dot(frame.axis), angle: y.atan2(x) }
}

fn frame() -> impl Strategy<Value = Frame> {
    let unit = || (-1.0..1.0_f64, -1.0..1.0_f64, -1.0..1.0_f64).prop_map(DVec3::from);
    let centre = prop_oneof![3 => unit(), 1 => Just(DVec3::ZERO), 1 => unit().prop_map(|p| 1e7 * p)];
    let directions = prop_oneof![1 => Just((DVec3::Z, DVec3::X)), 4 => (unit(), unit())];
    (centre, directions)
        .prop_filter_map("parallel directions", |(centre, (axis, xdir))| Frame::new(centre, axis, xdir).ok())
}

fn length() -> impl Strategy<Value = f64> {
    prop_oneof![3 => 0.1..10.0_f64, 1 => 1e-6..1e-5_f64, 1 => 1e4..1e5_f64]
}

/// Angles up to a full turn; every third a full one.
fn turn() -> impl Strategy<Value = (f64, f64)> {
    let start = prop_oneof![Just(0.0), -4.0..4.0_f64];
    let angle = prop_oneof![2 => 0.01..TAU, 1 => Just(TAU), 1 => Just(FRAC_PI_2), 1 => Just(PI)];
    (start, angle).prop_map(|(start, angle)| (start, start + angle))
}

/// Rounding of control points (their coordinates are sums of four products) and of evaluation at degree 2 × 2.
fn rounding(frame: &Frame, size: f64) -> f64 {
    40.0 * f64::EPSILON * (frame.centre.abs().max_element() + size)
}

fn is_full(range: (f64, f64)) -> bool {
    (range.1 - range.0 - TAU).abs() < 1e-14
}

fn samples() -> impl Iterator<Item = f64> {
    (0..=24).map(|k| f64::from(k) / 24.0)
}

/// Angles are within the sweep, start and end at its ends, and grow.
fn check_angles(angles: &[f64], sweep: (f64, f64), slack: f64) -> Result<(), TestCaseError> {
    let mut before = sweep.0 - slack;
    for (k, angle) in angles.iter().enumerate() {
        // the whole turns that bring it nearest to where even progress would be
        let even = sweep.0 + (sweep.1 - sweep.0) * k as f64 / (angles.len() - 1) as f64;
        let angle = angle + TAU * ((even - angle) / TAU).round();
        prop_assert!(angle >= before - 2.0 * slack, "angles go back at {}: {} after {}", k, angle, before);
        prop_assert!(angle >= sweep.0 - slack && angle <= sweep.1 + slack, "{} outside the sweep", angle);
        before = angle;
    }
    prop_assert!((before - sweep.1).abs() <= slack, "the sweep ends at {}, not {}", before, sweep.1);
    Ok(())
}

fn check_closed_curve(curve: &NurbsCurve, full: bool) -> Result<(), TestCaseError> {
    let bits = |p: DVec3| p.to_array().map(f64::to_bits);
    let (first, last) = (curve.control_points()[0], curve.control_points()[curve.control_points().len() - 1]);
    prop_assert_eq!(bits(first) == bits(last), full);
    prop_assert_eq!(bits(curve.point(0.0)) == bits(curve.point(1.0)), full);
    Ok(())
}

/// A full turn has the same bits at both ends of v, in the net and in evaluation.
fn check_closed_in_v(surface: &NurbsSurface, full: bool) -> Result<(), TestCaseError> {
    if full {
        let [_, _, first, last] = surface.boundary_curves();
        let bits =
            |c: NurbsCurve| c.control_points().iter().map(|p| p.to_array().map(f64::to_bits)).collect::<Vec<_>>();
        // none where the surface is so small and far off that its edge is one point
        prop_assert_eq!(first.map(bits), last.map(bits));
        for u in samples() {
            let (a, b) = (surface.point(u, 0.0), surface.point(u, 1.0));
            prop_assert_eq!(a.to_array().map(f64::to_bits), b.to_array().map(f64::to_bits));
        }
    }
    Ok(())
}

/// The places of points at `u` all around.
fn around(surface: &NurbsSurface, frame: &Frame, u: f64) -> Vec<Place> {
    samples().map(|v| place(frame, surface.point(u, v))).collect()
}

proptest! {
    #[test]
    fn circles_are_round_cover_their_sweep_and_close(frame in frame(), radius in length(), sweep in turn()) {
        let curve = Circle::new(frame, radius, sweep).expect("valid").to_nurbs().expect("valid");
        let tolerance = rounding(&frame, radius);
        let places: Vec<Place> = samples().map(|u| place(&frame, curve.point(u))).collect();
        for place in &places {
            prop_assert!((place.distance - radius).abs() <= tolerance && place.height.abs() <= tolerance);
        }
        let angles: Vec<f64> = places.iter().map(|p| p.angle).collect();
        check_angles(&angles, sweep, 2.0 * tolerance / radius)?;
        check_closed_curve(&curve, is_full(sweep))?;
        let spans = curve.knots().spans().count();
        prop_assert_eq!(spans, ((sweep.1 - sweep.0) / FRAC_PI_2 - 1e-9).ceil() as usize);
    }

    #[test]
    fn ellipses_satisfy_their_equation(frame in frame(), a in length(), b in length(), sweep in turn()) {
        let curve = Ellipse::new(frame, (a, b), sweep).expect("valid").to_nurbs().expect("valid");
        let ydir = frame.axis.cross(frame.xdir);
        // as circles, in units of the smaller radius
        let tolerance = rounding(&frame, a.max(b)) / a.min(b);
        let mut angles = Vec::new();
        for u in samples() {
            let arm = curve.point(u) - frame.centre;
            let (x, y) = (arm.dot(frame.xdir) / a, arm.dot(ydir) / b);
            prop_assert!((x.hypot(y) - 1.0).abs() <= tolerance);
            angles.push(y.atan2(x));
        }
        if tolerance < 1e-3 {
            check_angles(&angles, sweep, 2.0 * tolerance)?;
        }
        check_closed_curve(&curve, is_full(sweep))?;
    }

    #[test]
    fn planes_run_along_their_directions(
        frame in frame(), from in (-5.0..5.0_f64, -5.0..5.0_f64), extent in (length(), length()),
    ) {
        let (width, height) = ((from.0, from.0 + extent.0), (from.1, from.1 + extent.1));
        let surface = Plane::new(frame, width, height).expect("valid").to_nurbs().expect("valid");
        let tolerance = rounding(&frame, 10.0 + extent.0 + extent.1);
        for (u, v) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.3, 0.6)] {
            let arm = surface.point(u, v) - frame.centre;
            prop_assert!((arm.dot(frame.xdir) - (width.0 + u * extent.0)).abs() <= tolerance);
            prop_assert!((arm.dot(frame.ydir()) - (height.0 + v * extent.1)).abs() <= tolerance);
            prop_assert!(arm.dot(frame.axis).abs() <= tolerance);
        }
    }

    #[test]
    fn cylinders_keep_their_radius(frame in frame(), radius in length(), low in -3.0..3.0_f64, extent in length(), sweep in turn()) {
        let height = (low, low + extent);
        let surface = Cylinder::new(frame, radius, height, sweep).expect("valid").to_nurbs().expect("valid");
        let tolerance = rounding(&frame, radius + 3.0 + extent);
        for u in [0.0, 0.3, 1.0] {
            let places = around(&surface, &frame, u);
            for place in &places {
                prop_assert!((place.distance - radius).abs() <= tolerance);
                prop_assert!((place.height - (low + u * extent)).abs() <= tolerance);
            }
            let slack = 2.0 * tolerance / radius;
            if slack < 1e-3 {
                check_angles(&places.iter().map(|p| p.angle).collect::<Vec<_>>(), sweep, slack)?;
            }
        }
        check_closed_in_v(&surface, is_full(sweep))?;
    }

    #[test]
    fn cones_narrow_evenly_and_end_in_their_apex(
        frame in frame(), radius in length(), share in prop_oneof![Just(0.0), 0.1..0.9_f64], upside in any::<bool>(),
        extent in length(), sweep in turn(),
    ) {
        let radii = if upside { (share * radius, radius) } else { (radius, share * radius) };
        let surface = Cone::new(frame, radii, (0.0, extent), sweep).expect("valid").to_nurbs().expect("valid");
        let tolerance = rounding(&frame, radius + extent);
        for u in [0.0, 0.4, 1.0] {
            for place in around(&surface, &frame, u) {
                prop_assert!((place.distance - (radii.0 + u * (radii.1 - radii.0))).abs() <= tolerance);
                prop_assert!((place.height - u * extent).abs() <= tolerance);
            }
        }
        let [first, last, ..] = surface.boundary_curves();
        prop_assert_eq!((first.is_none(), last.is_none()), (radii.0 == 0.0, radii.1 == 0.0));
        check_closed_in_v(&surface, is_full(sweep))?;
    }

    #[test]
    fn spheres_are_round_and_cover_their_zone(
        frame in frame(), radius in length(), sweep in turn(),
        latitude in prop_oneof![
            Just((-FRAC_PI_2, FRAC_PI_2)), Just((0.0, FRAC_PI_2)),
            (-1.5..0.0_f64, 0.05..1.5_f64), (-FRAC_PI_2..-0.1, 0.0..0.1_f64),
        ],
    ) {
        let surface = Sphere::new(frame, radius, latitude, sweep).expect("valid").to_nurbs().expect("valid");
        let tolerance = rounding(&frame, radius);
        for u in samples() {
            for place in around(&surface, &frame, u) {
                prop_assert!((place.distance.hypot(place.height) - radius).abs() <= tolerance);
                let slack = 2.0 * tolerance / radius;
                let at = place.height.atan2(place.distance);
                prop_assert!(at >= latitude.0 - slack && at <= latitude.1 + slack);
            }
        }
        let ends = [surface.point(0.0, 0.5), surface.point(1.0, 0.5)].map(|p| place(&frame, p).height);
        prop_assert!((ends[0] - radius * latitude.0.sin()).abs() <= tolerance);
        prop_assert!((ends[1] - radius * latitude.1.sin()).abs() <= tolerance);
        let [south, north, ..] = surface.boundary_curves();
        prop_assert_eq!((south.is_none(), north.is_none()), (latitude.0 == -FRAC_PI_2, latitude.1 == FRAC_PI_2));
        check_closed_in_v(&surface, is_full(sweep))?;
    }

    #[test]
    fn tori_keep_their_tube(frame in frame(), minor in length(), more in prop_oneof![Just(0.0), length()], tube in turn(), sweep in turn()) {
        let major = minor + more;
        let surface = Torus::new(frame, major, minor, tube, sweep).expect("valid").to_nurbs().expect("valid");
        let tolerance = rounding(&frame, major + minor);
        let mut tube_angles = Vec::new();
        for u in samples() {
            for place in around(&surface, &frame, u) {
                prop_assert!(((place.distance - major).hypot(place.height) - minor).abs() <= tolerance);
            }
            let first = place(&frame, surface.point(u, 0.0));
            tube_angles.push(first.height.atan2(first.distance - major));
        }
        let slack = 2.0 * tolerance / minor;
        if slack < 1e-3 {
            check_angles(&tube_angles, tube, slack)?;
        }
        check_closed_in_v(&surface, is_full(sweep))?;
        if is_full(tube) {
            check_closed_in_v(&surface.swapped(), true)?;
        }
    }
}

#[test]
fn the_first_parameters_of_a_surface_are_those_of_its_frame() {
    let frame = Frame::new(DVec3::new(1.0, 2.0, 3.0), DVec3::Z, DVec3::X).expect("valid");
    let cylinder = Cylinder::new(frame, 1.5, (0.0, 4.0), (0.0, TAU)).expect("valid").to_nurbs().expect("valid");
    assert_eq!(cylinder.degree(), (1, 2));
    assert_eq!(cylinder.point(0.0, 0.0), DVec3::new(2.5, 2.0, 3.0));
    assert_eq!(cylinder.point(1.0, 0.25), DVec3::new(1.0, 3.5, 7.0));
    let sphere = Sphere::whole(Frame::WORLD, 2.0).expect("valid").to_nurbs().expect("valid");
    assert_eq!(sphere.point(0.0, 0.4), DVec3::new(0.0, 0.0, -2.0));
    assert_eq!(sphere.point(0.5, 0.25), DVec3::new(0.0, 2.0, 0.0));
    let torus = Torus::whole(Frame::WORLD, 3.0, 1.0).expect("valid").to_nurbs().expect("valid");
    assert_eq!(torus.point(0.0, 0.0), DVec3::new(4.0, 0.0, 0.0));
    assert_eq!(torus.point(0.25, 0.0), DVec3::new(3.0, 0.0, 1.0));
    assert_eq!(torus.domain(Direction::U), (0.0, 1.0));
}

#[test]
fn a_line_is_its_segment() {
    let (start, end) = (DVec3::new(1.0, -2.0, 0.5), DVec3::new(4.0, 0.0, 0.5));
    let line = Line::new(start, end).expect("valid").to_nurbs().expect("valid");
    assert_eq!((line.point(0.0), line.point(0.5), line.point(1.0)), (start, 0.5 * (start + end), end));
}
