//! Every edit leaves the surface where it was.

use perpend_kernel::glam::{DAffine3, DVec3};
use perpend_kernel::{Direction, InvalidEdit, NurbsSurface};
use proptest::prelude::*;

use crate::entities::{direction, inner, parameters, rounding, surface};
use crate::oracle;

fn apart(a: &NurbsSurface, b: &NurbsSurface) -> f64 {
    let mut most = 0.0_f64;
    for u in parameters(a.knots(Direction::U)) {
        for v in parameters(a.knots(Direction::V)) {
            most = most.max((oracle::surface_at(a, u, v) - oracle::surface_at(b, u, v)).length());
        }
    }
    most
}

fn tolerance(surface: &NurbsSurface) -> f64 {
    let (p, q) = surface.degree();
    rounding(2 * (p + q), surface.control_points())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn inserted_knots_leave_the_surface(
        surface in surface(4), direction in direction(), fraction in 0.0..1.0_f64, times in 0..4_usize,
    ) {
        let knots = surface.knots(direction);
        let at = inner(knots, fraction);
        let times = times.min(knots.degree() - knots.multiplicity(at));
        let finer = surface.insert_knot(direction, at, times).expect("the multiplicity allows it");
        prop_assert_eq!(finer.knots(direction).point_count(), knots.point_count() + times);
        prop_assert!(apart(&finer, &surface) <= tolerance(&surface));
    }

    #[test]
    fn elevation_leaves_the_surface(surface in surface(4), direction in direction(), by in 0..4_usize) {
        let higher = surface.elevate_degree(direction, by).expect("below the highest degree");
        prop_assert_eq!(higher.knots(direction).degree(), surface.knots(direction).degree() + by);
        prop_assert!(apart(&higher, &surface) <= (by + 1) as f64 * tolerance(&higher));
    }

    #[test]
    fn the_halves_of_a_split_are_the_surface_and_meet(
        surface in surface(4), direction in direction(), fraction in 0.0..1.0_f64,
    ) {
        let at = inner(surface.knots(direction), fraction);
        let (before, after) = match surface.split(direction, at) {
            Ok(parts) => parts,
            Err(error) => {
                prop_assert!(error.to_string().contains("all control points are equal"), "{}", error);
                return Ok(());
            }
        };
        for part in [&before, &after] {
            prop_assert!(apart(part, &surface) <= tolerance(&surface));
        }
        let (end, start) = match direction {
            Direction::U => (before.boundary_curves()[1].clone(), after.boundary_curves()[0].clone()),
            Direction::V => (before.boundary_curves()[3].clone(), after.boundary_curves()[2].clone()),
        };
        prop_assert_eq!(end, start);
    }

    #[test]
    fn reversal_and_swap_rename_the_parameters(surface in surface(4)) {
        let (by_u, by_v, swapped) =
            (surface.reversed(Direction::U), surface.reversed(Direction::V), surface.swapped());
        prop_assert_eq!(&by_u.reversed(Direction::U), &surface);
        prop_assert_eq!(&by_v.reversed(Direction::V), &surface);
        prop_assert_eq!(&swapped.swapped(), &surface);
        let tolerance = tolerance(&surface);
        for u in parameters(surface.knots(Direction::U)) {
            for v in parameters(surface.knots(Direction::V)) {
                let expected = oracle::surface_at(&surface, u, v);
                for point in [by_u.point(-u, v), by_v.point(u, -v), swapped.point(v, u)] {
                    prop_assert!((point - expected).length() <= tolerance);
                }
            }
        }
    }

    #[test]
    fn iso_curves_lie_on_the_surface(surface in surface(4), direction in direction(), fraction in 0.0..1.0_f64) {
        let (first, last) = surface.domain(direction);
        for at in [first, inner(surface.knots(direction), fraction), last] {
            match surface.iso_curve(direction, at) {
                Ok(curve) => {
                    for t in parameters(curve.knots()) {
                        let (u, v) = if direction == Direction::U { (at, t) } else { (t, at) };
                        let expected = oracle::surface_at(&surface, u, v);
                        prop_assert!((curve.point(t) - expected).length() <= tolerance(&surface));
                    }
                }
                Err(InvalidEdit::Collapsed { .. }) => {}
                Err(other) => prop_assert!(false, "{}", other),
            }
        }
    }

    #[test]
    fn the_image_of_a_surface_is_the_surface_of_the_images(surface in surface(3), angle in -3.0..3.0_f64) {
        let map = DAffine3::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), angle);
        let image = surface.transformed(&map).expect("valid");
        for u in parameters(surface.knots(Direction::U)) {
            for v in parameters(surface.knots(Direction::V)) {
                let expected = map.transform_point3(oracle::surface_at(&surface, u, v));
                prop_assert!((image.point(u, v) - expected).length() <= 3.0 * tolerance(&surface));
            }
        }
    }

    #[test]
    fn a_removed_knot_that_was_inserted_gives_the_surface_back(
        surface in surface(3), direction in direction(), fraction in 0.1..0.7_f64,
    ) {
        let at = inner(surface.knots(direction), fraction);
        prop_assume!(surface.knots(direction).multiplicity(at) == 0);
        let finer = surface.insert_knot(direction, at, 1).expect("a new knot");
        let removal = finer.remove_knot(direction, at, 1, f64::INFINITY).expect("an interior knot");
        prop_assert_eq!(removal.times, 1);
        prop_assert_eq!(removal.entity.knots(direction), surface.knots(direction));
        prop_assert!(apart(&removal.entity, &finer) <= removal.deviation);
    }
}

#[test]
fn a_collapsed_edge_is_no_boundary_curve() {
    let knots = || vec![0.0, 0.0, 1.0, 1.0];
    let points = vec![vec![DVec3::ZERO, DVec3::ZERO], vec![DVec3::X, DVec3::Y]];
    let fan = NurbsSurface::new((1, 1), (knots(), knots()), points, None).expect("valid");
    let [pole, arc, first, last] = fan.boundary_curves();
    assert!(pole.is_none());
    assert_eq!(arc.expect("an edge").control_points(), [DVec3::X, DVec3::Y]);
    assert_eq!(first.expect("an edge").control_points(), [DVec3::ZERO, DVec3::X]);
    assert_eq!(last.expect("an edge").control_points(), [DVec3::ZERO, DVec3::Y]);
    assert!(fan.iso_curve(Direction::U, 0.0).expect_err("a pole").to_string().contains("single point"));
}
