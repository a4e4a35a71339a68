//! What Xu et al. 2014 show in their Fig. 2: from the nearest of samples 1e-3 apart, Newton's method leads to a wrong answer, and the squared
//! gradient to the right one. Our numbers: the paper gives none.

use perpend::{DVec3, Method, NurbsCurve, QueryOptions};

use crate::One;

/// Newton's method for a zero of `(C - P) · C'`, from the nearest sample.
fn newton(curve: &NurbsCurve, p: DVec3) -> [f64; 2] {
    let distance = |u: f64| curve.point(u).distance(p);
    let samples = (0..=1000).map(|k| f64::from(k) / 1000.0);
    let start = samples.min_by(|a, b| distance(*a).total_cmp(&distance(*b))).expect("samples");
    let mut u = start;
    for _ in 0..100 {
        let mut d = [DVec3::ZERO; 3];
        curve.derivatives(u, &mut d);
        let offset = d[0] - p;
        u = (u - offset.dot(d[1]) / (d[1].length_squared() + offset.dot(d[2]))).clamp(0.0, 1.0);
    }
    [start, u]
}

fn check(points: &[[f64; 2]], p: [f64; 2]) {
    let degree = points.len() - 1;
    let points = points.iter().map(|[x, y]| DVec3::new(*x, *y, 0.0)).collect();
    let knots = [vec![0.0; degree + 1], vec![1.0; degree + 1]].concat();
    let curve = NurbsCurve::new(degree, knots, points, None).expect("valid");
    let p = DVec3::new(p[0], p[1], 0.0);
    let [start, end] = newton(&curve, p);
    let one = One::new(curve.clone());
    let certified = one.model.project(one.id, p).expect("finite");
    assert!(curve.point(start).distance(p) < certified.distance + 1e-3, "the start is good: {start}");
    assert!(curve.point(end).distance(p) > certified.distance + 1e-2, "the answer is wrong: {end}");
    let mut projector = one.model.projector(one.id).expect("there");
    let options = QueryOptions { method: Some(Method::Bernstein), ..QueryOptions::default() };
    let foot = projector.project(p, &options).expect("finite").expect("no limit");
    assert_eq!(foot.method, Method::Bernstein, "the proposal needed no correction");
    assert_eq!(projector.statistics().corrected, 0);
    assert!((foot.distance - certified.distance).abs() <= 1e-9 * one.size());
}

/// The foot is the end of the curve, no zero of the derivative: Newton's method leaves it for one.
#[test]
fn from_the_nearest_of_a_thousand_samples_newtons_method_leaves_the_end_for_a_farther_point() {
    check(&[[-0.5, -0.2], [-0.1, 0.5], [-0.5, -0.3], [0.3, 0.5], [0.7, -1.0]], [-0.78, -0.8]);
    let bay = [[0.2, -0.6], [-0.3, 1.0], [0.5, 0.0], [0.5, 0.8], [-1.0, 0.7], [0.0, -0.4], [0.6, 0.1]];
    check(&bay, [0.9, 0.97]);
}

/// With a first weight fifteen decades above the others, most of the curve lies in the last thousandth of the domain: an interval of 1e-3 says nothing, and Newton's method starts
/// far from the foot.
#[test]
fn where_weights_crowd_the_curve_into_one_interval_the_proof_corrects_the_proposal() {
    let points = [[0.0, 0.0], [1.0, 2.0], [3.0, -1.0], [4.0, 1.0]].map(|[x, y]| DVec3::new(x, y, 0.0));
    let knots = [vec![0.0; 4], vec![1.0; 4]].concat();
    let curve = NurbsCurve::new(3, knots, points.to_vec(), Some(vec![1e15, 1.0, 1.0, 1.0])).expect("valid");
    let one = One::new(curve);
    let mut projector = one.model.projector(one.id).expect("there");
    for k in 0..40 {
        let p = DVec3::new(0.1 * f64::from(k), 0.5 * f64::from(k % 5) - 1.0, 0.1);
        let certified = one.model.project(one.id, p).expect("finite");
        let options = QueryOptions { method: Some(Method::Bernstein), ..QueryOptions::default() };
        let foot = projector.project(p, &options).expect("finite").expect("no limit");
        assert!((foot.distance - certified.distance).abs() <= 2e-9 * one.size(), "{p}: {foot:?}, {certified:?}");
    }
    assert!(projector.statistics().corrected > 0, "{:?}", projector.statistics());
}
