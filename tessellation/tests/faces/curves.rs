//! Polylines.

use glam::DVec3;
use perpend_kernel::{Circle, Frame, NurbsCurve};
use perpend_tessellation::{Limits, polyline};
use proptest::prelude::*;

use crate::oracle::distance_to_segment;

#[test]
fn a_circle_has_about_as_many_segments_as_it_must() {
    let circle = Circle::whole(Frame::WORLD, 1.0).unwrap().to_nurbs().unwrap();
    let line = polyline(&circle, 1e-4, Limits::default()).unwrap();
    // 1 - cos(angle / 2) <= 1e-4 needs 223 segments; halves of the four arcs give 256
    assert_eq!(line.points.len(), 257);
    assert!(line.error <= 1e-4 && line.error > 0.5e-4);
    assert_eq!(line.points[0], line.points[256]);
}

proptest! {
    #[test]
    fn no_point_of_the_curve_is_farther_than_the_error(
        points in prop::collection::vec((-1.0..1.0_f64, -1.0..1.0_f64, -1.0..1.0_f64, 0.2..5.0_f64), 4..9),
        chord in 1e-4..0.5_f64,
    ) {
        let mut knots = vec![0.0; 4];
        knots.extend((1..points.len() - 3).map(|i| i as f64));
        knots.extend([(points.len() - 3) as f64; 4]);
        let places = points.iter().map(|(x, y, z, _)| DVec3::new(*x, *y, *z)).collect();
        let weights = points.iter().map(|(.., w)| *w).collect();
        let curve = NurbsCurve::new(3, knots, places, Some(weights)).unwrap();
        let line = polyline(&curve, chord, Limits::default()).unwrap();
        prop_assert!(line.error <= chord);
        for k in 0..=500 {
            let point = curve.point(curve.domain().1 * f64::from(k) / 500.0);
            let distance = line.points.windows(2).map(|ends| distance_to_segment(point, ends[0], ends[1]));
            prop_assert!(distance.fold(f64::INFINITY, f64::min) <= line.error + 1e-14);
        }
    }
}
