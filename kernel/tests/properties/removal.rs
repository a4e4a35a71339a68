//! Knot removal keeps its promise.

use perpend_kernel::NurbsCurve;
use perpend_kernel::glam::DVec3;
use proptest::prelude::*;

use crate::entities::{curve, parameters};
use crate::oracle;

proptest! {
    #[test]
    fn no_point_moves_farther_than_the_bound(curve in curve(6), tolerance in 0.0..3.0_f64) {
        for knot in curve.knots().breaks() {
            let removal = curve.remove_knot(knot.at, knot.multiplicity, tolerance).expect("an interior knot");
            prop_assert!(removal.deviation <= tolerance);
            prop_assert_eq!(removal.entity.knots().multiplicity(knot.at), knot.multiplicity - removal.times);
            for u in parameters(curve.knots()) {
                let moved = (oracle::at(&curve, u) - oracle::at(&removal.entity, u)).length();
                prop_assert!(moved <= removal.deviation + crate::entities::rounding(curve.degree(), curve.control_points()));
            }
        }
    }

    #[test]
    fn inserted_knots_can_be_removed_again(
        points in proptest::collection::vec((-1.0..1.0_f64, -1.0..1.0_f64, -1.0..1.0_f64).prop_map(DVec3::from), 12),
        degree in 1..6_usize,
        times in 1..6_usize,
        span in 0..11_usize,
        fraction in 0.1..0.9_f64,
        weights in proptest::option::of(proptest::collection::vec(0.1..10.0_f64, 12)),
    ) {
        let mut knots = vec![0.0; degree + 1];
        knots.extend((1..12 - degree).map(|k| k as f64));
        knots.extend(vec![(12 - degree) as f64; degree + 1]);
        let curve = NurbsCurve::new(degree, knots, points, weights).expect("valid");
        // between two knots: beside one, the equations of removal are steep
        let u = span.min(11 - degree) as f64 + fraction;
        let times = times.min(degree);
        let removal = curve.insert_knot(u, times).expect("new").remove_knot(u, degree, 1e-9).expect("a knot");
        prop_assert_eq!(removal.times, times);
        prop_assert_eq!(removal.entity.knots(), curve.knots());
        for (a, b) in removal.entity.control_points().iter().zip(curve.control_points()) {
            prop_assert!((*a - *b).length() < 1e-9);
        }
    }
}

#[test]
fn a_needed_knot_stays() {
    let points = vec![DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0)];
    let corner = NurbsCurve::new(1, vec![0.0, 0.0, 1.0, 2.0, 2.0], points, None).expect("valid");
    let kept = corner.remove_knot(1.0, 1, 0.7).expect("an interior knot");
    assert_eq!((kept.times, kept.deviation), (0, 0.0));
    assert_eq!(kept.entity, corner);
    // the corner lies √½ off the chord between its neighbours, at equal parameters
    let removed = corner.remove_knot(1.0, 1, 0.708).expect("an interior knot");
    assert_eq!(removed.times, 1);
    assert!((removed.deviation - 0.5_f64.sqrt()).abs() < 1e-13);
}

#[test]
fn removal_that_would_leave_a_single_point_is_not_done() {
    let there_and_back = vec![DVec3::ZERO, DVec3::X, DVec3::ZERO];
    let curve = NurbsCurve::new(1, vec![0.0, 0.0, 1.0, 2.0, 2.0], there_and_back, None).expect("valid");
    assert_eq!(curve.remove_knot(1.0, 1, f64::INFINITY).expect("an interior knot").times, 0);
}
