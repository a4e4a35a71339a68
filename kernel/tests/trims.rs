//! Trims: what is refused, what is clamped, and on which side of their loops parameters lie.

use std::f64::consts::TAU;

use perpend_kernel::glam::DVec2;
use perpend_kernel::{
    Cover, Cylinder, Frame, InvalidTrim, NurbsSurface, Plane, PlaneCurve, Side, TrimCurveData, TrimLoopData, Trimming,
    TrimmingData,
};
use proptest::prelude::*;

fn plate() -> NurbsSurface {
    Plane::new(Frame::WORLD, (0.0, 10.0), (0.0, 10.0)).and_then(|plane| plane.to_nurbs()).expect("a plate")
}

fn data(curve: &PlaneCurve) -> TrimCurveData {
    TrimCurveData {
        degree: curve.degree(),
        knots: curve.knots().as_slice().to_vec(),
        points: curve.points().collect(),
        weights: curve.weights().map(<[f64]>::to_vec),
        edge: None,
    }
}

fn polygon(outer: bool, corners: &[DVec2]) -> TrimLoopData {
    let next = |k: usize| corners[(k + 1) % corners.len()];
    let side = |k: usize| data(&PlaneCurve::line(corners[k], next(k)).expect("corners differ"));
    TrimLoopData { outer, curves: (0..corners.len()).map(side).collect() }
}

/// A full circle as one rational quadratic, counter-clockwise.
fn circle(centre: DVec2, radius: f64) -> PlaneCurve {
    let w = 0.5_f64.sqrt();
    let corners = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)];
    let points = corners.iter().map(|(x, y)| centre + radius * DVec2::new(f64::from(*x), f64::from(*y))).collect();
    let weights = (0..9).map(|k| if k % 2 == 0 { 1.0 } else { w }).collect();
    let knots = vec![0.0, 0.0, 0.0, 0.25, 0.25, 0.5, 0.5, 0.75, 0.75, 1.0, 1.0, 1.0];
    PlaneCurve::new(2, knots, points, Some(weights)).expect("a circle")
}

fn trimming(loops: Vec<TrimLoopData>) -> Result<Trimming, InvalidTrim> {
    let data = TrimmingData { reversed: false, tolerance: 1e-6, loops };
    Trimming::enter(data, &plate()).map(|(trimming, _)| trimming)
}

fn square(from: f64, to: f64) -> [DVec2; 4] {
    [DVec2::new(from, from), DVec2::new(to, from), DVec2::new(to, to), DVec2::new(from, to)]
}

#[test]
fn a_hole_is_outside_and_its_rim_is_the_boundary() {
    let hole = TrimLoopData { outer: false, curves: vec![data(&circle(DVec2::splat(0.5), 0.25).reversed())] };
    let trimming = trimming(vec![polygon(true, &square(0.0, 1.0)), hole]).expect("valid");
    let side = |u: f64, v: f64| trimming.region().side(DVec2::new(u, v));
    assert_eq!(side(0.5, 0.5), Side::Outside);
    assert_eq!(side(0.1, 0.5), Side::Inside);
    assert_eq!(side(0.75, 0.5), Side::Boundary);
    assert_eq!(side(0.0, 0.5), Side::Boundary);
    assert_eq!(side(1.0, 1.0), Side::Boundary);
    assert_eq!(side(-1e-300, 0.5), Side::Outside);
    for k in 0..1000 {
        let direction = DVec2::from_angle(TAU * f64::from(k) / 1000.0);
        for (radius, expected) in [(0.25 + 1e-14, Side::Inside), (0.25 - 1e-14, Side::Outside)] {
            let at = DVec2::splat(0.5) + radius * direction;
            assert_eq!(trimming.region().side(at), expected, "{k} {radius}");
        }
    }
}

/// A point is inside a polygon by exact predicates, also a last bit away from a slanted side.
#[test]
fn a_bit_beside_a_slanted_side_is_told_apart() {
    let corners = [DVec2::new(0.1, 0.1), DVec2::new(0.9, 0.3), DVec2::new(0.4, 0.9)];
    let trimming = trimming(vec![polygon(true, &corners)]).expect("valid");
    let mut met = [0; 3];
    for k in 1..4000 {
        let at = corners[0].lerp(corners[1], f64::from(k) / 4000.0);
        for at in [at, DVec2::new(at.x, at.y.next_up()), DVec2::new(at.x, at.y.next_down())] {
            let exact = robust::orient2d(coord(corners[0]), coord(corners[1]), coord(at));
            let expected = match exact.total_cmp(&0.0) {
                std::cmp::Ordering::Greater => Side::Inside,
                std::cmp::Ordering::Equal => Side::Boundary,
                std::cmp::Ordering::Less => Side::Outside,
            };
            assert_eq!(trimming.region().side(at), expected);
            met[expected as usize] += 1;
        }
    }
    assert!(met[0] > 1000 && met[2] > 1000, "both sides are met: {met:?}");
}

fn coord(p: DVec2) -> robust::Coord<f64> {
    robust::Coord { x: p.x, y: p.y }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// Against the winding of a fine polygon, for points that lie farther from it than it lies from the curve.
    #[test]
    fn curved_loops_agree_with_fine_polygons(
        radii in prop::collection::vec(0.1..0.45_f64, 5..12),
        seeds in prop::collection::vec((0.0..1.0_f64, 0.0..1.0_f64), 40),
    ) {
        let n = radii.len();
        let corner = |k: usize| DVec2::splat(0.5) + radii[k % n] * DVec2::from_angle(TAU * k as f64 / n as f64);
        // a closed cubic B-spline, clamped on entry
        let points: Vec<DVec2> = (0..n + 3).map(corner).collect();
        let knots: Vec<f64> = (0..n + 7).map(|k| k as f64).collect();
        let curve = PlaneCurve::new(3, knots, points, None).expect("valid");
        let trimming = trimming(vec![TrimLoopData { outer: true, curves: vec![data(&curve)] }]).expect("closed");
        let (first, last) = curve.domain();
        let fine: Vec<DVec2> = (0..4000).map(|k| curve.point(first + (last - first) * f64::from(k) / 4000.0)).collect();
        for (u, v) in seeds {
            let at = DVec2::new(u, v);
            let nearest = fine.iter().map(|p| p.distance(at)).fold(f64::INFINITY, f64::min);
            if nearest < 1e-3 {
                continue;
            }
            let winding: f64 = (0..fine.len())
                .map(|k| (fine[k] - at).angle_to(fine[(k + 1) % fine.len()] - at))
                .sum::<f64>() / TAU;
            let expected = if winding.round() as i64 % 2 == 0 { Side::Outside } else { Side::Inside };
            prop_assert_eq!(trimming.region().side(at), expected);
            let cover = trimming.region().cover(at - 1e-4, at + 1e-4);
            let certain = if expected == Side::Inside { Cover::Inside } else { Cover::Outside };
            prop_assert_eq!(cover, certain);
            let wide = trimming.region().cover(at - nearest, at + nearest);
            prop_assert!(wide == certain || wide == Cover::Crossed);
            let beyond = trimming.region().cover(at - 1.01 * nearest, at + 1.01 * nearest);
            prop_assert_eq!(beyond, Cover::Crossed);
        }
    }
}

#[test]
fn what_leaves_the_domain_by_a_hair_is_clamped_and_said() {
    let data = |slack: f64| TrimmingData {
        reversed: true,
        tolerance: 1e-6,
        loops: vec![polygon(true, &square(-slack, 1.0 + slack))],
    };
    let (trimming, entry) = Trimming::enter(data(6e-4), &plate()).expect("clamped");
    assert_eq!(trimming.region().bounds(), (DVec2::ZERO, DVec2::ONE));
    assert!((entry.clamped[0] - 6e-4).abs() < 1e-15 && (entry.clamped[1] - 6e-4).abs() < 1e-15);
    assert!(trimming.reversed());
    let refused = Trimming::enter(data(2e-3), &plate()).expect_err("too far");
    assert!(matches!(refused, InvalidTrim::OutsideDomain { of: 0, curve: 0, .. }), "{refused}");
    let (again, entry) = Trimming::enter(trimming.data(), &plate()).expect("what was clamped stays");
    assert_eq!((again, entry.clamped), (trimming, [0.0, 0.0]));
}

/// Control points may lie outside where the curve does not: they are brought closer to it.
#[test]
fn a_curve_inside_the_domain_with_control_points_outside_is_taken() {
    let points = vec![DVec2::new(0.2, 0.9), DVec2::new(0.5, 1.05), DVec2::new(0.8, 0.9)];
    let arch = PlaneCurve::new(2, vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0], points, None).expect("valid");
    let base = PlaneCurve::line(arch.end(), arch.start()).expect("valid");
    let one = TrimLoopData { outer: true, curves: vec![data(&arch), data(&base)] };
    let data = TrimmingData { reversed: false, tolerance: 0.0, loops: vec![one] };
    let (_, entry) = Trimming::enter(data, &plate()).expect("valid");
    assert_eq!(entry.clamped, [0.0, 0.0]);
}

#[test]
fn gaps_are_measured_in_space() {
    let gap = |by: f64| {
        let mut one = polygon(true, &square(0.0, 1.0));
        one.curves[1].points[0].y += by;
        trimming(vec![one])
    };
    assert!(gap(0.9e-7).is_ok(), "0.9e-6 on a plate of 10");
    let refused = gap(1e-6).expect_err("1e-5 on a plate of 10");
    let InvalidTrim::Open { of: 0, curve: 1, gap, .. } = refused else { panic!("{refused}") };
    assert!((gap - 1e-5).abs() < 1e-12);
    let mut shuffled = polygon(true, &square(0.0, 1.0));
    shuffled.curves.swap(0, 2);
    assert!(matches!(trimming(vec![shuffled]), Err(InvalidTrim::Open { .. })));
}

/// The ends of a seam are one point in space; the way between their parameters leads around the pipe.
#[test]
fn a_jump_over_the_seam_is_no_closed_loop() {
    let pipe =
        Cylinder::new(Frame::WORLD, 1.0, (0.0, 1.0), (0.0, TAU)).and_then(|pipe| pipe.to_nurbs()).expect("a pipe");
    let rim = |from: DVec2, to: DVec2| data(&PlaneCurve::line(from, to).expect("valid"));
    let bottom = rim(DVec2::new(0.0, 0.0), DVec2::new(0.0, 1.0));
    let one = TrimLoopData { outer: true, curves: vec![bottom] };
    let refused = Trimming::enter(TrimmingData { reversed: false, tolerance: 1e-6, loops: vec![one] }, &pipe);
    assert!(matches!(refused, Err(InvalidTrim::Open { .. })));
}

#[test]
fn what_bounds_nothing_is_refused() {
    assert_eq!(trimming(vec![]).expect_err("no loops"), InvalidTrim::NoLoops);
    let empty = TrimLoopData { outer: true, curves: vec![] };
    assert_eq!(trimming(vec![empty]).expect_err("no curves"), InvalidTrim::EmptyLoop { of: 0 });
    let there = data(&PlaneCurve::line(DVec2::ZERO, DVec2::ONE).expect("valid"));
    let back = data(&PlaneCurve::line(DVec2::ONE, DVec2::ZERO).expect("valid"));
    let slit = TrimLoopData { outer: true, curves: vec![there, back] };
    assert_eq!(trimming(vec![slit]).expect_err("a slit"), InvalidTrim::Empty);
    for tolerance in [-1.0, f64::NAN, f64::INFINITY] {
        let data = TrimmingData { reversed: false, tolerance, loops: vec![polygon(true, &square(0.0, 1.0))] };
        assert!(matches!(Trimming::enter(data, &plate()), Err(InvalidTrim::Tolerance { .. })));
    }
    let mut bad = polygon(true, &square(0.0, 1.0));
    bad.curves[2].points[1].x = f64::NAN;
    assert!(matches!(trimming(vec![bad]), Err(InvalidTrim::Curve { of: 0, curve: 2, .. })));
}

/// A carrier may be larger than its face by far: what is thin beside the domain need not be thin beside itself.
#[test]
fn a_sliver_of_a_vast_carrier_bounds_a_region() {
    // powers of two: the middles of the sides lie on them to the bit, and are no lucky hits
    let (long, thin) = (2.0_f64.powi(-27), 2.0_f64.powi(-33));
    let corners = [DVec2::splat(0.5), DVec2::splat(0.5 + long), DVec2::new(0.5 + long, 0.5 + long + thin)];
    let sliver = trimming(vec![polygon(true, &corners)]).expect("a region");
    let inside = (corners[0] + corners[1] + corners[2]) / 3.0;
    assert_eq!(sliver.region().side(inside), Side::Inside);
}
