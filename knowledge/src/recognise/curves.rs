//! Curves about their own centre.

use glam::DVec3;
use perpend_kernel::NurbsCurve;

/// The curve moved so that the centre of its control points' box is the origin, and that centre.
pub(super) fn local(curve: &NurbsCurve) -> Option<(NurbsCurve, DVec3)> {
    let origin = curve.control_box().centre();
    let points = curve.control_points().iter().map(|p| *p - origin).collect();
    with_points(curve, points).map(|moved| (moved, origin))
}

/// The curve with other control points.
pub(super) fn with_points(curve: &NurbsCurve, points: Vec<DVec3>) -> Option<NurbsCurve> {
    let weights = curve.weights().map(<[f64]>::to_vec);
    NurbsCurve::new(curve.degree(), curve.knots().as_slice().to_vec(), points, weights).ok()
}

/// Points of a curve, its ends included.
pub(super) fn samples(curve: &NurbsCurve) -> Vec<DVec3> {
    parameters(curve.domain(), 32).map(|u| curve.point(u)).collect()
}

/// `count + 1` parameters, evenly over a domain, its ends included.
pub(super) fn parameters(domain: (f64, f64), count: u32) -> impl Iterator<Item = f64> + Clone {
    (0..=count).map(move |k| {
        let t = f64::from(k) / f64::from(count);
        (1.0 - t) * domain.0 + t * domain.1
    })
}
