//! Points and derivatives.

use perpend_kernel::glam::DVec3;
use perpend_kernel::{Direction, NurbsCurve};
use proptest::prelude::*;

use crate::entities::{curve, parameters, rounding, surface};
use crate::oracle;

fn binomial(n: usize, k: usize) -> f64 {
    (1..=k).fold(1.0, |c, i| c * (n + 1 - i) as f64 / i as f64)
}

proptest! {
    #[test]
    fn points_of_curves_are_those_of_the_definition(curve in curve(9)) {
        let tolerance = rounding(curve.degree(), curve.control_points());
        for u in parameters(curve.knots()) {
            prop_assert!((curve.point(u) - oracle::at(&curve, u)).length() <= tolerance, "at {u}");
        }
    }

    #[test]
    fn points_of_surfaces_are_those_of_the_definition(surface in surface(5)) {
        let (p, q) = surface.degree();
        let tolerance = rounding(p + q, surface.control_points());
        for u in parameters(surface.knots(Direction::U)) {
            for v in parameters(surface.knots(Direction::V)) {
                let expected = oracle::surface_at(&surface, u, v);
                prop_assert!((surface.point(u, v) - expected).length() <= tolerance, "at {u}, {v}");
            }
        }
    }

    #[test]
    fn the_derivative_of_order_zero_is_the_point_bit_for_bit(surface in surface(9), order in 0..3_usize) {
        for u in parameters(surface.knots(Direction::U)) {
            for v in parameters(surface.knots(Direction::V)) {
                let mut d = vec![DVec3::ZERO; (order + 1) * (order + 1)];
                surface.derivatives(u, v, order, &mut d);
                prop_assert_eq!(d[0], surface.point(u, v), "at {}, {}", u, v);
            }
        }
    }

    /// Leibniz: the derivatives of `w C` are sums of products of those of `w` and `C`.
    ///
    #[test]
    fn derivatives_of_curves_obey_the_product_rule(curve in curve(7)) {
        let (p, t) = (curve.degree(), curve.knots().as_slice());
        let weight = |i: usize| curve.weights().map_or(1.0, |w| w[i]);
        let mut d = vec![DVec3::ZERO; p + 1];
        for u in parameters(curve.knots()) {
            curve.derivatives(u, &mut d);
            let span = curve.knots().find_span(u);
            let heaviest = (span - p..=span).map(weight).fold(0.0, f64::max);
            let farthest = (span - p..=span).map(|i| weight(i) * curve.control_points()[i].length()).fold(0.0, f64::max);
            let sizes = oracle::sizes(p, t, u);
            let mut weights = Vec::new();
            for k in 0..=p {
                let b = oracle::derived_functions(p, t, u, k);
                weights.push((b.iter().enumerate().map(|(i, b)| b * weight(i)).sum::<f64>(), sizes[k] * heaviest));
                let expected: DVec3 =
                    b.iter().zip(curve.control_points()).enumerate().map(|(i, (b, p))| b * weight(i) * *p).sum();
                let (mut sum, mut magnitude) = (DVec3::ZERO, sizes[k] * farthest);
                for i in 0..=k {
                    sum += binomial(k, i) * weights[i].0 * d[k - i];
                    magnitude += binomial(k, i) * weights[i].1 * d[k - i].length();
                }
                let tolerance = 40.0 * (p + 1) as f64 * f64::EPSILON * magnitude;
                prop_assert!((sum - expected).length() <= tolerance, "order {k} at {u}: {sum} for {expected}");
            }
        }
    }

    #[test]
    fn the_tight_box_holds_the_curve_and_lies_in_the_control_box(curve in curve(7)) {
        let tolerance = DVec3::splat(rounding(curve.degree(), curve.control_points()));
        let (tight, control) = (curve.tight_box(), curve.control_box());
        prop_assert!((tight.min + tolerance).cmpge(control.min).all() && (tight.max - tolerance).cmple(control.max).all());
        for u in parameters(curve.knots()) {
            let point = oracle::at(&curve, u);
            prop_assert!(point.cmpge(tight.min - tolerance).all() && point.cmple(tight.max + tolerance).all());
        }
    }

    #[test]
    fn the_tight_box_holds_the_surface(surface in surface(4)) {
        let tolerance = DVec3::splat(rounding(8, surface.control_points()));
        let tight = surface.tight_box();
        for u in parameters(surface.knots(Direction::U)) {
            for v in parameters(surface.knots(Direction::V)) {
                let point = oracle::surface_at(&surface, u, v);
                prop_assert!(point.cmpge(tight.min - tolerance).all() && point.cmple(tight.max + tolerance).all());
            }
        }
    }

    #[test]
    fn clamping_keeps_curves_with_uneven_weights(
        degree in 1..8_usize,
        gaps in proptest::collection::vec(prop_oneof![4 => 0.1..2.0_f64, 1 => Just(0.0)], 30),
        points in proptest::collection::vec((-1.0..1.0_f64, -1.0..1.0_f64, -1.0..1.0_f64).prop_map(DVec3::from), 14),
        exponents in proptest::collection::vec(-3.0..3.0_f64, 14),
    ) {
        let mut at = 0.0;
        let knots: Vec<f64> = gaps.iter().take(14 + degree + 1).map(|gap| { at += gap; at }).collect();
        let weights: Vec<f64> = exponents.iter().map(|e| 10.0_f64.powf(*e)).collect();
        let entered = NurbsCurve::new(degree, knots.clone(), points.clone(), Some(weights.clone()));
        // knots repeated too often are refused; that is another test's matter
        prop_assume!(entered.is_ok());
        let curve = entered.expect("just tested");
        let tolerance = rounding(2 * degree, &points);
        for u in parameters(curve.knots()) {
            let expected = oracle::curve_point(degree, &knots, &points, Some(&weights), u);
            prop_assert!((curve.point(u) - expected).length() <= tolerance, "at {u}");
        }
    }
}

proptest! {
    // degrees up to 9 on dense parameters: few cases take as long as many of the others
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn partial_derivatives_of_polynomial_surfaces_are_those_of_the_definition(surface in surface(9)) {
        let surface = perpend_kernel::NurbsSurface::new(
            surface.degree(),
            (surface.knots(Direction::U).as_slice().to_vec(), surface.knots(Direction::V).as_slice().to_vec()),
            surface.control_points().chunks(surface.columns()).map(<[DVec3]>::to_vec).collect(),
            None,
        ).expect("valid without its weights");
        let ((p, q), columns) = (surface.degree(), surface.columns());
        let farthest = surface.control_points().iter().map(|p| p.length()).fold(0.0, f64::max);
        let order = 4;
        let mut d = vec![DVec3::ZERO; (order + 1) * (order + 1)];
        for u in parameters(surface.knots(Direction::U)) {
            for v in parameters(surface.knots(Direction::V)) {
                surface.derivatives(u, v, order, &mut d);
                let by_u = oracle::sizes(p, surface.knots(Direction::U).as_slice(), u);
                let by_v = oracle::sizes(q, surface.knots(Direction::V).as_slice(), v);
                for k in 0..=order.min(p) {
                    for l in 0..=(order - k).min(q) {
                        let across = oracle::derived_functions(p, surface.knots(Direction::U).as_slice(), u, k);
                        let along = oracle::derived_functions(q, surface.knots(Direction::V).as_slice(), v, l);
                        let mut sum = DVec3::ZERO;
                        for (i, a) in across.iter().enumerate() {
                            for (j, b) in along.iter().enumerate() {
                                sum += a * b * surface.control_points()[i * columns + j];
                            }
                        }
                        let magnitude = by_u[k] * by_v[l] * farthest;
                        let tolerance = 40.0 * (p + q + 1) as f64 * f64::EPSILON * magnitude;
                        prop_assert!((d[k * (order + 1) + l] - sum).length() <= tolerance, "({k}, {l}) at {u}, {v}");
                    }
                }
            }
        }
    }
}

#[test]
fn ends_and_full_knots_are_their_control_points_in_every_bit() {
    let points: Vec<DVec3> = (0..6).map(|i| DVec3::new(0.1 * f64::from(i), 1.7 / f64::from(i + 3), 0.3)).collect();
    let knots = vec![0.0, 0.0, 0.0, 49.0, 49.0, 60.0, 103.0, 103.0, 103.0];
    let curve = NurbsCurve::new(2, knots, points.clone(), None).expect("valid");
    for (u, i) in [(0.0, 0), (49.0, 2), (103.0, 5)] {
        assert_eq!(curve.point(u), points[i]);
        let mut d = [DVec3::ZERO; 3];
        curve.derivatives(u, &mut d);
        assert_eq!(d[0], points[i]);
        curve.derivatives_from_left(u, &mut d);
        assert_eq!(d[0], points[i]);
    }
}
