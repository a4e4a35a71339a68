//! Every edit leaves the curve where it was.

use perpend_kernel::glam::{DAffine3, DQuat, DVec3};
use perpend_kernel::{MAX_DEGREE, NurbsCurve};
use proptest::prelude::*;

use crate::entities::{curve, inner, parameters, rounding};
use crate::oracle;

/// The largest distance between two curves of the same parameters, over samples of the first.
fn apart(a: &NurbsCurve, b: &NurbsCurve) -> f64 {
    parameters(a.knots()).into_iter().map(|u| (oracle::at(a, u) - oracle::at(b, u)).length()).fold(0.0, f64::max)
}

proptest! {
    #[test]
    fn inserted_knots_leave_the_curve(curve in curve(9), fraction in 0.0..1.0_f64, times in 0..9_usize) {
        let u = inner(curve.knots(), fraction);
        let times = times.min(curve.degree() - curve.knots().multiplicity(u));
        let finer = curve.insert_knot(u, times).expect("the multiplicity allows it");
        prop_assert_eq!(finer.control_points().len(), curve.control_points().len() + times);
        prop_assert_eq!(finer.knots().multiplicity(u), curve.knots().multiplicity(u) + times);
        prop_assert!(apart(&finer, &curve) <= rounding(2 * curve.degree(), curve.control_points()));
        prop_assert_eq!(finer.domain(), curve.domain());
    }

    #[test]
    fn refinement_leaves_the_curve(curve in curve(7), fractions in proptest::collection::vec(0.0..0.8_f64, 0..6)) {
        let added: Vec<f64> = fractions.iter().map(|f| inner(curve.knots(), *f)).collect();
        if let Ok(finer) = curve.refine(&added) {
            prop_assert_eq!(finer.control_points().len(), curve.control_points().len() + added.len());
            prop_assert!(apart(&finer, &curve) <= rounding(3 * curve.degree(), curve.control_points()));
            let mut ratio = (f64::INFINITY, 0.0_f64);
            for w in finer.weights().unwrap_or_default() {
                ratio = (ratio.0.min(*w), ratio.1.max(*w));
            }
            prop_assert!(ratio.1 <= 1e3 * 1.001 && (finer.weights().is_none() || ratio.0 >= 1e-3 * 0.999), "convex");
        } else {
            // the same knot twice in degree 1 is all that can be refused here
            prop_assert!(curve.degree() <= added.len());
        }
    }

    #[test]
    fn elevation_leaves_the_curve(curve in curve(9), by in 0..5_usize) {
        let higher = curve.elevate_degree(by).expect("below the highest degree");
        prop_assert_eq!(higher.degree(), curve.degree() + by);
        let before: Vec<_> = curve.knots().breaks().map(|b| (b.at, b.multiplicity + by)).collect();
        prop_assert_eq!(higher.knots().breaks().map(|b| (b.at, b.multiplicity)).collect::<Vec<_>>(), before);
        let tolerance = rounding((by + 1) * higher.degree(), curve.control_points());
        prop_assert!(apart(&higher, &curve) <= tolerance);
    }

    #[test]
    fn elevation_to_the_highest_degree_leaves_the_curve(curve in curve(3)) {
        let higher = curve.elevate_degree(MAX_DEGREE - curve.degree()).expect("up to the highest degree");
        prop_assert!(apart(&higher, &curve) <= rounding(25 * 25, curve.control_points()));
    }

    #[test]
    fn the_halves_of_a_split_are_the_curve_and_meet(curve in curve(9), fraction in 0.0..1.0_f64) {
        let u = inner(curve.knots(), fraction);
        let ((first, last), tolerance) = (curve.domain(), rounding(2 * curve.degree(), curve.control_points()));
        let (before, after) = match curve.split(u) {
            Ok(parts) => parts,
            // a part whose control points all coincide is no curve
            Err(error) => {
                prop_assert!(error.to_string().contains("all control points are equal"), "{}", error);
                return Ok(());
            }
        };
        prop_assert_eq!((before.domain(), after.domain()), ((first, u), (u, last)));
        prop_assert_eq!(before.control_points().last(), after.control_points().first());
        for part in [&before, &after] {
            prop_assert!(apart(part, &curve) <= tolerance);
        }
    }

    #[test]
    fn reversal_runs_backwards_and_is_its_own_inverse(curve in curve(9)) {
        let reversed = curve.reversed();
        prop_assert_eq!(&reversed.reversed(), &curve);
        let tolerance = rounding(curve.degree(), curve.control_points());
        for u in parameters(curve.knots()) {
            prop_assert!((reversed.point(-u) - oracle::at(&curve, u)).length() <= tolerance);
        }
    }

    #[test]
    fn a_mapped_domain_keeps_the_points(curve in curve(7), first in -5.0..5.0_f64, exponent in -3..10_i32) {
        prop_assert_eq!(curve.with_domain(first, first + 7.0).expect("valid").domain(), (first, first + 7.0));
        // a power of two times a domain that starts at 0 is mapped without rounding
        let (start, end) = curve.domain();
        if start != 0.0 {
            return Ok(());
        }
        let scale = f64::from(exponent).exp2();
        let mapped = curve.with_domain(0.0, scale * end).expect("valid");
        let tolerance = rounding(curve.degree(), curve.control_points());
        for u in parameters(curve.knots()) {
            prop_assert!((mapped.point(scale * u) - oracle::at(&curve, u)).length() <= tolerance);
        }
    }

    #[test]
    fn the_image_of_a_curve_is_the_curve_of_the_images(
        curve in curve(7),
        axis in (-1.0..1.0_f64, -1.0..1.0_f64, 0.1..1.0_f64),
        angle in -3.0..3.0_f64,
        scale in 1e-3..1e3_f64,
        shift in (-9.0..9.0_f64, -9.0..9.0_f64, -9.0..9.0_f64),
    ) {
        let turn = DQuat::from_axis_angle(DVec3::from(axis).normalize(), angle);
        let map = DAffine3::from_scale_rotation_translation(DVec3::new(scale, 2.0 * scale, scale), turn, shift.into());
        let image = curve.transformed(&map).expect("valid");
        let reach = curve.control_points().iter().chain(image.control_points()).copied().collect::<Vec<_>>();
        let tolerance = rounding(curve.degree(), &reach) * (1.0 + 2.0 * scale);
        for u in parameters(curve.knots()) {
            prop_assert!((image.point(u) - map.transform_point3(oracle::at(&curve, u))).length() <= tolerance);
        }
    }
}
#[test]
fn control_points_that_an_insertion_does_not_touch_keep_their_bits() {
    let points: Vec<DVec3> = (0..9).map(|i| DVec3::splat(0.1).powf(0.3 * f64::from(i))).collect();
    let weights: Vec<f64> = (0..9).map(|i| 0.7 + 0.1 * f64::from(i)).collect();
    let knots = vec![0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 7.0, 7.0];
    let curve = NurbsCurve::new(2, knots, points.clone(), Some(weights.clone())).expect("valid");
    let finer = curve.insert_knot(3.5, 1).expect("valid");
    // points 0 to 3 and, one place later, 5 to 8 belong to other spans
    assert_eq!(finer.control_points()[..4], points[..4]);
    assert_eq!(finer.control_points()[6..], points[5..]);
    assert_eq!(finer.weights().map(|w| &w[6..]), Some(&weights[5..]));
}
