//! Constructions do what they say, point by point.

use perpend_kernel::glam::{DQuat, DVec3};
use perpend_kernel::{
    Circle, Direction, NurbsCurve, Spacing, curve_through, extrusion, loft, revolution, ruled, surface_through,
};
use proptest::collection::vec;
use proptest::prelude::*;
use std::f64::consts::TAU;

use crate::entities::{curve, parameters, rounding};
use crate::oracle;

fn point() -> impl Strategy<Value = DVec3> {
    (-1.0..1.0_f64, -1.0..1.0_f64, -1.0..1.0_f64).prop_map(DVec3::from)
}

fn spacing() -> impl Strategy<Value = Spacing> {
    prop_oneof![Just(Spacing::Uniform), Just(Spacing::ChordLength), Just(Spacing::Centripetal)]
}

/// Parameters by their definition: the shares of chords, of their roots, or even ones.
fn spaced(points: &[DVec3], spacing: Spacing) -> Vec<f64> {
    let steps: Vec<f64> = points
        .windows(2)
        .map(|w| match spacing {
            Spacing::Uniform => 1.0,
            Spacing::ChordLength => (w[1] - w[0]).length(),
            Spacing::Centripetal => (w[1] - w[0]).length().sqrt(),
        })
        .collect();
    let total: f64 = steps.iter().sum();
    (0..points.len()).map(|k| steps[..k].iter().sum::<f64>() / total).collect()
}

/// Elimination is backward stable: what is missed is a few roundings of the largest control point, and of the speed times the
/// rounding of the parameter.
fn missed(degree: usize, control_points: &[DVec3]) -> f64 {
    10.0 * (degree * degree) as f64 * rounding(degree, control_points)
}

proptest! {
    #[test]
    fn an_extrusion_is_the_profile_moved(profile in curve(6), path in point(), v in 0.0..=1.0_f64) {
        let surface = extrusion(&profile, path).expect("valid");
        for u in parameters(profile.knots()) {
            let expected = oracle::at(&profile, u) + v * path;
            let tolerance = rounding(profile.degree() + 1, surface.control_points());
            prop_assert!((surface.point(u, v) - expected).length() <= tolerance);
        }
    }

    #[test]
    fn a_ruled_surface_joins_its_curves(a in curve(5), b in curve(5), v in 0.0..=1.0_f64) {
        // a ruling of equal parameters needs equal domains
        let b = NurbsCurve::new(
            b.degree(),
            b.with_domain(a.domain().0, a.domain().1).expect("valid").knots().as_slice().to_vec(),
            b.control_points().to_vec(),
            b.weights().map(<[f64]>::to_vec),
        ).expect("valid");
        let surface = ruled(&a, &b).expect("compatible");
        prop_assert_eq!(surface.degree(), (a.degree().max(b.degree()), 1));
        let reach: Vec<DVec3> = a.control_points().iter().chain(b.control_points()).copied().collect();
        let tolerance = rounding(40, &reach);
        for u in parameters(surface.knots(Direction::U)) {
            let (start, end) = (oracle::at(&a, u), oracle::at(&b, u));
            prop_assert!((surface.point(u, 0.0) - start).length() <= tolerance);
            prop_assert!((surface.point(u, 1.0) - end).length() <= tolerance);
            let (p, chord) = (surface.point(u, v), end - start);
            if chord.length() > 1e3 * tolerance {
                let off = (p - start) - chord * ((p - start).dot(chord) / chord.length_squared());
                prop_assert!(off.length() <= tolerance);
                if a.weights().is_none() && b.weights().is_none() {
                    prop_assert!((p - (start + v * chord)).length() <= tolerance);
                }
            }
        }
    }

    #[test]
    fn a_revolution_turns_its_profile(
        profile in curve(5), centre in point(), axis in point(),
        angle in prop_oneof![0.1..TAU, Just(TAU)],
    ) {
        prop_assume!(axis.length() > 0.1);
        let surface = revolution(&profile, centre, axis, angle).expect("valid");
        let axis = axis.normalize();
        let tolerance = rounding(profile.degree() + 10, surface.control_points());
        for u in parameters(profile.knots()) {
            let start = oracle::at(&profile, u);
            prop_assert!((surface.point(u, 0.0) - start).length() <= tolerance);
            let end = centre + DQuat::from_axis_angle(axis, angle) * (start - centre);
            prop_assert!((surface.point(u, 1.0) - end).length() <= tolerance);
            let place = |p: DVec3| ((p - centre).dot(axis), (p - centre).cross(axis).length());
            let (height, distance) = place(start);
            for v in [0.2, 0.5, 0.9] {
                let there = place(surface.point(u, v));
                prop_assert!((there.0 - height).abs() <= tolerance && (there.1 - distance).abs() <= tolerance);
            }
        }
        if angle == TAU {
            for row in surface.control_points().chunks(surface.columns()) {
                prop_assert_eq!(row[0], row[row.len() - 1]);
            }
        }
    }

    #[test]
    fn the_curve_through_points_passes_them(points in vec(point(), 6..20), degree in 1..6_usize, spacing in spacing()) {
        let curve = curve_through(&points, degree, spacing).expect("random points are apart");
        prop_assert_eq!(curve.point(0.0), points[0]);
        prop_assert_eq!(curve.point(1.0), points[points.len() - 1]);
        let tolerance = missed(degree, curve.control_points());
        for (u, p) in spaced(&points, spacing).into_iter().zip(&points) {
            // the oracle's parameters are rounded apart from the library's
            let mut d = [DVec3::ZERO; 2];
            curve.derivatives(u, &mut d);
            let slip = 4.0 * f64::EPSILON * points.len() as f64 * d[1].length();
            prop_assert!((curve.point(u) - *p).length() <= tolerance + slip, "{} from {}", curve.point(u), p);
        }
    }

    #[test]
    fn the_surface_through_a_grid_passes_it(
        heights in vec(vec(-1.0..1.0_f64, 7), 6), degree in (1..5_usize, 1..5_usize), spacing in spacing(),
    ) {
        let grid: Vec<Vec<DVec3>> = heights.iter().enumerate()
            .map(|(i, row)| row.iter().enumerate().map(|(j, z)| DVec3::new(i as f64, j as f64, *z)).collect())
            .collect();
        let surface = surface_through(&grid, degree, spacing).expect("the points are apart");
        let mean = |lines: Vec<Vec<DVec3>>| -> Vec<f64> {
            let all: Vec<Vec<f64>> = lines.iter().map(|line| spaced(line, spacing)).collect();
            (0..all[0].len()).map(|k| all.iter().map(|line| line[k]).sum::<f64>() / all.len() as f64).collect()
        };
        let us = mean((0..7).map(|j| grid.iter().map(|row| row[j]).collect()).collect());
        let vs = mean(grid.clone());
        let tolerance = 4.0 * missed(degree.0 + degree.1, surface.control_points());
        for (i, u) in us.iter().enumerate() {
            for (j, v) in vs.iter().enumerate() {
                prop_assert!((surface.point(*u, *v) - grid[i][j]).length() <= tolerance);
            }
        }
        prop_assert_eq!(surface.point(0.0, 0.0), grid[0][0]);
    }
}

#[test]
fn a_profile_that_ends_on_the_axis_gives_a_pole() {
    let points = vec![DVec3::new(0.1, 0.2, 0.3) * 3.0, DVec3::new(1.0, 0.0, 0.0), DVec3::new(2.0, 1.0, 4.0)];
    let profile = NurbsCurve::new(2, vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0], points, None).expect("valid");
    // the first point is three times the axis' direction, off the axis by rounding
    let surface = revolution(&profile, DVec3::ZERO, DVec3::new(0.1, 0.2, 0.3), TAU).expect("valid");
    let [pole, rim, ..] = surface.boundary_curves();
    assert!(pole.is_none() && rim.is_some());
}

#[test]
fn a_collapsed_row_does_not_count_for_the_parameters_of_a_grid() {
    let row = |z: f64| (0..4).map(|j| z * DVec3::new(f64::from(j * j), f64::from(j), 0.0) + z * DVec3::Z).collect();
    let fan: Vec<Vec<DVec3>> = vec![row(0.0), row(1.0), row(2.0)];
    let surface = surface_through(&fan, (2, 2), Spacing::ChordLength).expect("valid");
    assert!(surface.boundary_curves()[0].is_none());
    for (v, p) in spaced(&fan[2], Spacing::ChordLength).into_iter().zip(&fan[2]) {
        assert!((surface.point(1.0, v) - *p).length() < 1e-13);
    }
}

#[test]
fn many_points_and_a_high_degree_are_passed() {
    let points: Vec<DVec3> =
        (0..60).map(|k| f64::from(k) * 0.2).map(|t| DVec3::new(t.cos(), t.sin(), 0.1 * t)).collect();
    for degree in [3, 9, 15] {
        let curve = curve_through(&points, degree, Spacing::ChordLength).expect("valid");
        for (u, p) in spaced(&points, Spacing::ChordLength).into_iter().zip(&points) {
            assert!((curve.point(u) - *p).length() < 1e-11, "degree {degree} at {u}");
        }
    }
}

#[test]
fn knots_that_agree_but_for_the_rounding_of_the_mapping_count_once() {
    let through = |knots: &dyn Fn(i32) -> f64, z: f64| {
        let mut all = vec![knots(0)];
        all.extend((0..=10).map(knots));
        all.push(knots(10));
        let points = (0..11).map(|i| DVec3::new(f64::from(i), f64::from(i * i % 3), z)).collect();
        NurbsCurve::new(1, all, points, None).expect("valid")
    };
    // tenths are rounded, sevenths of a shifted domain otherwise
    let (a, b) = (through(&|k| f64::from(k) / 10.0, 0.0), through(&|k| 0.3 + 0.7 * f64::from(k), 1.0));
    let surface = ruled(&a, &b).expect("compatible");
    assert_eq!((surface.rows(), surface.columns()), (11, 2));
    assert_eq!(surface.knots(Direction::U), a.knots());
}

proptest! {
    #[test]
    fn a_loft_passes_its_sections(sections in vec(curve(4), 2..6), degree in 1..4_usize) {
        // one domain, so that equal parameters are corresponding ones
        let (first, last) = sections[0].domain();
        let sections: Vec<NurbsCurve> = sections.iter().map(|one| one.with_domain(first, last).expect("valid")).collect();
        let given: Vec<&NurbsCurve> = sections.iter().collect();
        match loft(&given, degree) {
            Ok(surface) => {
                prop_assert_eq!(surface.knots(Direction::V).degree(), degree);
                prop_assert_eq!((surface.domain(Direction::U), surface.domain(Direction::V)), ((first, last), (0.0, 1.0)));
                for (section, at) in [(&sections[0], 0.0), (&sections[sections.len() - 1], 1.0)] {
                    for u in parameters(section.knots()) {
                        // elevation and refinement to the common degree and knots, a few tens of roundings each
                        let tolerance = 64.0 * rounding(surface.degree().0 + 2, surface.control_points());
                        prop_assert!((surface.point(u, at) - oracle::at(section, u)).length() <= tolerance);
                    }
                }
            }
            Err(error) => {
                // sections far nearer to one another than the others are get the same parameter, as the error says
                let ends = |section: &NurbsCurve| [section.point(first), section.point(last)];
                let steps: Vec<f64> = sections
                    .windows(2)
                    .map(|pair| {
                        let (a, b) = (ends(&pair[0]), ends(&pair[1]));
                        a[0].distance(b[0]).max(a[1].distance(b[1]))
                    })
                    .collect();
                let near = steps.iter().any(|step| *step <= 1e-9 * steps.iter().sum::<f64>());
                let text = error.to_string();
                let is_reason = text.contains("weight") || sections.len() <= degree || (near && text.contains("same parameter"));
                prop_assert!(is_reason, "{}", error);
            }
        }
    }

    #[test]
    fn an_arc_through_points_passes_them_in_their_order(start in point(), through in point(), end in point(), far in point()) {
        let (far, sine) = (1e3 * far, (through - start).cross(end - start).length());
        let lengths = [through - start, end - start, end - through].map(|side| side.length());
        prop_assume!(sine > 1e-3 * lengths[0] * lengths[1] && lengths.iter().all(|length| *length > 1e-3));
        let arc = Circle::through(far + start, far + through, far + end).expect("not on one line");
        let curve = arc.to_nurbs().expect("valid");
        // rounding of coordinates, and of a centre that is the less certain the flatter the three lie
        let tolerance = 64.0 * f64::EPSILON * (1e3 + arc.radius) * (lengths[0] * lengths[1] / sine).powi(2);
        prop_assert!(curve.point(0.0).distance(far + start) <= tolerance);
        prop_assert!(curve.point(1.0).distance(far + end) <= tolerance);
        let arm = far + through - arc.frame.centre;
        prop_assert!((arm.length() - arc.radius).abs() <= tolerance && arm.dot(arc.frame.axis).abs() <= tolerance);
        let angle = arm.dot(arc.frame.ydir()).atan2(arm.dot(arc.frame.xdir)).rem_euclid(TAU);
        prop_assert!(angle < arc.sweep.1 + tolerance / arc.radius, "{} of {:?}", angle, arc.sweep);
    }
}
