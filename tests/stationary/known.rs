//! Cases whose stationary points are known in closed form, on and beside the places where their number changes.

use std::f64::consts::{FRAC_PI_2, TAU};

use perpend::{
    Certainty, DVec3, Ellipse, Extremum, Frame, NurbsCurve, NurbsSurface, Place, Plane, Sphere, StationaryPoint,
};

use crate::{One, census, is_decided};

/// `y = x²` for x in [-1, 1], with x = 2u - 1.
fn parabola() -> One {
    let points = vec![DVec3::new(-1.0, 1.0, 0.0), DVec3::new(0.0, -1.0, 0.0), DVec3::new(1.0, 1.0, 0.0)];
    One::new(NurbsCurve::new(2, vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0], points, None).expect("valid"))
}

#[test]
fn on_the_axis_of_a_parabola_a_minimum_becomes_a_maximum_between_two_at_the_centre_of_curvature() {
    let parabola = parabola();
    let mut heights = vec![-1.0, 0.0, 0.3, 0.499, 0.501, 0.75, 1.0, 1.4];
    heights.extend((3..=7).flat_map(|k| [0.5 - 10.0_f64.powi(-k), 0.5 + 10.0_f64.powi(-k)]));
    for height in heights {
        let p = DVec3::new(0.0, height, 0.0);
        let found = parabola.stationary(p);
        assert!(is_decided(&found), "{height}: {found:?}");
        let ends = found.points.iter().filter(|point| point.place == Place::End).count();
        assert_eq!(ends, 2);
        let inner: Vec<_> = found.points.iter().filter(|point| point.place == Place::Interior).collect();
        if height <= 0.5 {
            assert_eq!(inner.len(), 1, "{height}: {found:?}");
            assert_eq!(inner[0].kind, Some(Extremum::Minimum));
            assert!((inner[0].parameter.u() - 0.5).abs() < 1e-8, "{height}: {inner:?}");
        } else {
            // x² = h - 1/2
            let x = (height - 0.5).sqrt();
            let kinds = [Extremum::Minimum, Extremum::Maximum, Extremum::Minimum].map(Some);
            assert_eq!(inner.iter().map(|point| point.kind).collect::<Vec<_>>(), kinds, "{height}");
            for (point, x) in inner.iter().zip([-x, 0.0, x]) {
                let u = point.parameter.u();
                assert!((2.0 * u - 1.0 - x).abs() < 1e-7, "{height}: {u} for {x}");
                assert!(point.range.u.0 <= u && u <= point.range.u.1);
            }
        }
    }
}

#[test]
fn at_the_centre_of_curvature_one_undecided_point_is_a_minimum_as_the_signs_beside_it_tell() {
    for height in [0.5, 0.5 - 1e-13, 0.5 + 1e-13] {
        let found = parabola().stationary(DVec3::new(0.0, height, 0.0));
        assert!(found.complete);
        let undecided: Vec<_> = found.points.iter().filter(|point| point.certainty == Certainty::Undecided).collect();
        let wide = &found.continua;
        // rounding hides the derivative, a cubic there, over some 1e-5 of the domain: a point or a set of boxes, as that is wider than the tolerance or not
        assert_eq!(undecided.len() + wide.len(), 1, "{height}: {found:?}");
        assert!(undecided.iter().all(|point| point.kind == Some(Extremum::Minimum)));
        let holds = |range: (f64, f64)| range.0 <= 0.5 && 0.5 <= range.1 && range.1 - range.0 < 1e-4;
        assert!(undecided.iter().all(|point| holds(point.range.u)));
        assert!(wide.iter().all(|set| set.boxes.iter().any(|b| holds(b.u)) && set.boxes.len() < 100));
        assert_eq!(found.points.iter().filter(|point| point.place == Place::End).count(), 2);
    }
}

/// An ellipse has four normals through a point inside its evolute `(a x)^(2/3) + (b y)^(2/3) = (a² - b²)^(2/3)`, and two outside.
#[test]
fn an_ellipse_has_four_stationary_points_inside_its_evolute_and_two_outside() {
    let (a, b) = (3.0_f64, 2.0_f64);
    let ellipse = Ellipse::new(Frame::WORLD, (a, b), (0.0, TAU)).expect("valid");
    let one = One::new(ellipse.to_nurbs().expect("valid"));
    let evolute = |angle: f64| {
        let c = a * a - b * b;
        DVec3::new(c / a * angle.cos().powi(3), -c / b * angle.sin().powi(3), 0.0)
    };
    for k in 0..40 {
        let angle = 0.05 + f64::from(k) * 0.157;
        for share in [0.2, 0.9, 0.999, 1.0 - 1e-6, 1.0 + 1e-6, 1.001, 1.1, 3.0] {
            let p = share * evolute(angle);
            let found = one.stationary(p);
            assert!(is_decided(&found), "{angle}, {share}: {found:?}");
            let expected = if share < 1.0 { [2, 0, 2] } else { [1, 0, 1] };
            assert_eq!(census(&found), expected, "{angle}, {share}");
            // each is a normal: the tangent is at right angles to the way there
            for point in &found.points {
                let t = point.point;
                let tangent = DVec3::new(-t.y * a / b, t.x * b / a, 0.0).normalize();
                assert!((t - p).dot(tangent).abs() < 1e-9, "{point:?}");
            }
        }
    }
    // the centre: on the axes
    let found = one.stationary(DVec3::ZERO);
    assert!(is_decided(&found) && census(&found) == [2, 0, 2]);
    let distances: Vec<f64> = found.points.iter().map(|point| point.distance).collect();
    for (distance, expected) in distances.iter().zip([3.0, 2.0, 3.0, 2.0]) {
        assert!((distance - expected).abs() < 1e-12);
    }
    assert_eq!(found.points[0].place, Place::Seam, "the seam's point is given once, at the lower parameter");
}

#[test]
fn the_poles_of_a_sphere_are_points_once_where_the_query_is_on_the_axis_and_none_elsewhere() {
    let sphere = Sphere::new(Frame::WORLD, 2.0, (-FRAC_PI_2, FRAC_PI_2), (0.0, TAU)).expect("valid");
    let one = One::new(sphere.to_nurbs().expect("valid"));
    for height in [0.1, 1.0, 1.9999, 7.0, -3.0] {
        let found = one.stationary(DVec3::new(0.0, 0.0, height));
        assert!(is_decided(&found), "{height}: {found:?}");
        assert_eq!((census(&found), found.points.len()), ([1, 0, 1], 2));
        assert!(found.points.iter().all(|point| point.place == Place::Pole));
        let minimum = found.points.iter().find(|point| point.kind == Some(Extremum::Minimum)).expect("counted");
        assert!((minimum.distance - (2.0 - height.abs()).abs()).abs() < 1e-12);
    }
    for p in [DVec3::new(1e-3, 0.0, 1.0), DVec3::new(0.0, 1e-6, 1.0), DVec3::new(1.0, 1.0, 0.0)] {
        let found = one.stationary(p);
        assert!(is_decided(&found) && census(&found) == [1, 0, 1], "{p}: {found:?}");
        assert!(found.points.iter().all(|point| point.place != Place::Pole), "{p}: {found:?}");
    }
}

/// Above an edge or a corner of a plane, what is inside and what is on the edge cannot be told apart: one point.
#[test]
fn above_the_border_of_a_plane_there_is_one_minimum() {
    let one = One::new(Plane::new(Frame::WORLD, (-1.0, 2.0), (-1.0, 2.0)).expect("valid").to_nurbs().expect("valid"));
    let inside = one.stationary(DVec3::new(0.2, 0.4, 3.0));
    assert!(is_decided(&inside));
    // the four sides' feet fall into the plane, as two do from every corner
    assert_eq!((census(&inside), inside.points.len()), ([1, 4, 4], 9), "{inside:?}");
    for (p, place) in [
        (DVec3::new(2.0, 0.3, 1.5), Place::Edge),
        (DVec3::new(-1.0, 0.3, 0.5), Place::Edge),
        (DVec3::new(2.0, -1.0, 1.0), Place::Corner),
        (DVec3::new(2.0, 2.0, 1.0), Place::Corner),
    ] {
        let found = one.stationary(p);
        let minima: Vec<_> = found.points.iter().filter(|point| point.kind == Some(Extremum::Minimum)).collect();
        assert_eq!(minima.len(), 1, "{p}: {found:?}");
        assert_eq!(minima[0].place, place);
        assert!((minima[0].distance - p.z).abs() < 1e-12 && found.continua.is_empty());
    }
}

#[test]
fn a_crease_is_a_point_where_it_is_a_ridge_or_a_valley_and_none_where_the_distance_passes_it() {
    let corner =
        |points: Vec<DVec3>| One::new(NurbsCurve::new(1, vec![0.0, 0.0, 1.0, 2.0, 2.0], points, None).expect("valid"));
    let bent = corner(vec![DVec3::new(-1.0, 0.0, 0.0), DVec3::ZERO, DVec3::new(0.0, -1.0, 0.0)]);
    let at_corner = |p: DVec3| {
        let found = bent.stationary(p);
        assert!(is_decided(&found), "{found:?}");
        found.points.iter().find(|point| point.place == Place::Crease).and_then(|point| point.kind)
    };
    assert_eq!(at_corner(DVec3::new(1.0, 1.0, 0.0)), Some(Extremum::Minimum));
    assert_eq!(at_corner(DVec3::new(-1.0, -1.0, 0.0)), Some(Extremum::Maximum));
    assert_eq!(at_corner(DVec3::new(1.0, -0.5, 0.0)), None);
    // a roof: its ridge along y, at x = 0
    let row = |x: f64, z: f64| vec![DVec3::new(x, -1.0, z), DVec3::new(x, 1.0, z)];
    let knots = (vec![0.0, 0.0, 1.0, 2.0, 2.0], vec![0.0, 0.0, 1.0, 1.0]);
    let points = vec![row(-1.0, 0.0), row(0.0, 1.0), row(1.0, 0.0)];
    let roof = One::new(NurbsSurface::new((1, 1), knots, points, None).expect("valid"));
    let above = roof.stationary(DVec3::new(0.1, 0.2, 3.0));
    assert!(is_decided(&above) && crate::characteristic(&above) == 1, "{above:?}");
    let on_ridge =
        |kind: Extremum| move |point: &&StationaryPoint| point.kind == Some(kind) && point.place == Place::Crease;
    let ridge: Vec<_> = above.points.iter().filter(on_ridge(Extremum::Minimum)).collect();
    assert_eq!(ridge.len(), 1, "{above:?}");
    assert!((ridge[0].point - DVec3::new(0.0, 0.2, 1.0)).length() < 1e-12);
    let below = roof.stationary(DVec3::new(0.1, 0.2, -1.0));
    assert!(is_decided(&below) && crate::characteristic(&below) == 1, "{below:?}");
    let ridge: Vec<_> = below.points.iter().filter(on_ridge(Extremum::Saddle)).collect();
    assert!(
        ridge.iter().any(|point| (point.point - DVec3::new(0.0, 0.2, 1.0)).length() < 1e-12),
        "falls to both sides"
    );
}
