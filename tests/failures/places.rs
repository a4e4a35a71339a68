//! Where a foot lies: every place by name.

use glam::{DVec3, dvec3};
use perpend::kernel::extrusion;
use perpend::{FootPoint, NurbsCurve, Place};

use super::case::{Case, close, u, uv};
use super::shapes::{
    arc, bezier, circle, cone, curve, cusp, cylinder, flat, plain_surface, plane, polyline, sphere, torus, walls,
};
use std::f64::consts::TAU;

/// SISL s1958 says interior, edge or corner; other systems say nothing, and users cannot tell a foot from the rim.
#[test]
fn every_place_is_named() {
    let closed = flat(&[[0.0, 0.0], [4.0, 0.0], [2.0, 3.0], [0.0, 0.0]]);
    // closes with a corner: leaves to the right, comes back from above
    let drop = flat(&[[0.0, 0.0], [3.0, 0.0], [3.0, 3.0], [0.0, 3.0], [0.0, 0.0]]);
    let table: Vec<(&str, Case, [f64; 3], Place)> = vec![
        ("segment", Case::new(polyline(&flat(&[[0.0, 0.0], [1.0, 0.0]]))), [0.5, 1.0, 0.0], Place::Interior),
        ("segment", Case::new(polyline(&flat(&[[0.0, 0.0], [1.0, 0.0]]))), [2.0, 1.0, 0.0], Place::End),
        ("arc", Case::new(arc(1.0, 1.0)), [2.0, 0.0, 0.0], Place::End),
        ("arc, past its end", Case::new(arc(1.0, 1.0)), [1.0, -1.0, 0.0], Place::End),
        ("circle", Case::new(circle(1.0)), [0.0, 2.0, 0.0], Place::Interior),
        ("circle's seam", Case::new(circle(1.0)), [2.0, 0.0, 0.0], Place::Seam),
        ("cusp", Case::new(cusp()), [0.5, 2.0, 0.0], Place::Cusp),
        ("cusp's flank", Case::new(cusp()), [0.2, 0.7, 0.0], Place::Interior),
        ("polyline's vertex", Case::new(polyline(&closed)), [5.0, -1.0, 0.0], Place::Crease),
        ("closed polyline's first vertex", Case::new(polyline(&closed)), [-1.0, -1.0, 0.0], Place::Crease),
        ("drop's point", Case::new(curve(4, drop)), [-1.0, -1.0, 0.0], Place::Crease),
        ("plane", Case::new(plane((0.0, 2.0), (0.0, 3.0))), [1.0, 1.0, 4.0], Place::Interior),
        ("plane's edge", Case::new(plane((0.0, 2.0), (0.0, 3.0))), [1.0, -1.0, 4.0], Place::Edge),
        ("plane's corner", Case::new(plane((0.0, 2.0), (0.0, 3.0))), [3.0, -1.0, 4.0], Place::Corner),
        ("cylinder's rim", Case::new(cylinder(1.0, (0.0, 2.0), TAU)), [0.0, 2.0, 3.0], Place::Edge),
        ("cylinder's seam", Case::new(cylinder(1.0, (0.0, 2.0), TAU)), [2.0, 0.0, 1.0], Place::Seam),
        ("cylinder's joint", Case::new(cylinder(1.0, (0.0, 2.0), TAU)), [0.0, 2.0, 1.0], Place::Interior),
        ("cone's apex", Case::new(cone(1.0, 1.0)), [0.0, 0.0, 2.0], Place::Pole),
        ("cone's rim", Case::new(cone(1.0, 1.0)), [0.0, -3.0, -1.0], Place::Edge),
        ("sphere's pole", Case::new(sphere(1.0)), [0.0, 0.0, -2.0], Place::Pole),
        ("torus", Case::new(torus(3.0, 1.0)), [-5.0, -4.0, 0.5], Place::Interior),
        ("torus's seams", Case::new(torus(3.0, 1.0)), [5.0, 0.0, 0.0], Place::Seam),
        ("walls", Case::new(walls()), [3.0, 0.5, 0.5], Place::Interior),
        ("walls' upright edge", Case::new(walls()), [3.0, 3.0, 0.5], Place::Crease),
        ("walls' first edge", Case::new(walls()), [-3.0, -3.0, 0.5], Place::Crease),
        ("walls' rim", Case::new(walls()), [3.0, 0.5, 2.0], Place::Edge),
    ];
    for (name, case, p, place) in table {
        let foot = case.foot_by_oracle(DVec3::from_array(p));
        assert_eq!(foot.place, place, "{name}: {foot:?}");
    }
}

/// A tangent that turns by nothing is no crease: a knot of full multiplicity on a smooth curve.
#[test]
fn a_smooth_knot_is_no_crease() {
    // two Bézier parabolas that meet with one tangent; then with another
    let smooth = flat(&[[0.0, 0.0], [1.0, 1.0], [2.0, 1.0], [4.0, 1.0], [5.0, 0.0]]);
    let bent = flat(&[[0.0, 0.0], [1.0, 1.0], [2.0, 1.0], [4.0, 0.9], [5.0, 0.0]]);
    for (points, place) in [(smooth, Place::Interior), (bent, Place::Crease)] {
        let knots = vec![0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 2.0];
        let case = Case::new(NurbsCurve::new(2, knots, points, None).expect("valid"));
        let foot = case.foot_at(dvec3(2.0, 1.75, 0.0), 0.75);
        assert_eq!(foot.place, place, "{foot:?}");
        close(u(&foot), 1.0, 1e-12);
    }
}

/// Cusps, as foxtrot PR 7 has them on edges: the derivative vanishes at the foot, and the parameter is that of the cusp.
#[test]
fn a_cusp_is_met_from_all_round() {
    let case = Case::new(cusp());
    // the cusp points along y: what lies above it within 45 degrees has it as its foot
    for degrees in [45.0_f64, 60.0, 90.0, 120.0, 135.0] {
        for distance in [1e-6, 0.1, 1.0, 50.0] {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let foot = case.foot_at(dvec3(0.5, 0.75, 0.0) + distance * dvec3(cos, sin, 0.0), distance);
            assert_eq!(foot.place, Place::Cusp, "{degrees}, {distance}: {foot:?}");
            close(u(&foot), 0.5, 1e-9);
        }
    }
}

fn no_normal(foot: &FootPoint) {
    assert_eq!((foot.normal, foot.signed_distance), (None, None), "{foot:?}");
}

/// truck, foxtrot PR 7 on surfaces: where the tangents are parallel there is no normal, and the answer says so.
#[test]
fn a_corner_with_parallel_tangents_is_a_cusp() {
    // both edges leave the corner (0, 0, 0) along x
    let net = [
        [[0.0, 0.0], [1.0, 0.0], [2.0, 1.0]],
        [[1.0, 0.0], [2.0, 0.5], [3.0, 2.0]],
        [[2.0, -1.0], [3.0, 0.0], [4.0, 1.0]],
    ];
    let case = Case::new(plain_surface(2, 3, 3, |i, j| dvec3(net[i][j][0], net[i][j][1], 0.0)));
    for p in [dvec3(-1.0, 0.0, 0.5), dvec3(-2.0, 0.3, 0.0), dvec3(-1.0, -0.4, -3.0)] {
        let foot = case.foot_at(p, p.length());
        assert_eq!((uv(&foot), foot.place), ((0.0, 0.0), Place::Cusp), "{foot:?}");
        no_normal(&foot);
    }
}

/// As above, along a whole line inside the surface: the extrusion of a curve with a cusp.
#[test]
fn the_ridge_of_an_extruded_cusp_is_a_cusp() {
    let case = Case::new(extrusion(&cusp(), 2.0 * DVec3::Z).expect("a path"));
    for p in [dvec3(0.5, 2.0, 1.0), dvec3(0.2, 1.5, 0.3)] {
        let foot = case.foot_at(p, (p.x - 0.5).hypot(p.y - 0.75));
        close(uv(&foot).0, 0.5, 1e-9);
        assert_eq!(foot.place, Place::Cusp, "{foot:?}");
        no_normal(&foot);
    }
    // a ridge at an end of the domain: the profile starts with a double point, its tangent is still the limit
    let resting = bezier(flat(&[[0.0, 0.0], [0.0, 0.0], [2.0, 1.0]]));
    assert_eq!(Case::new(resting).foot_at(dvec3(-2.0, -1.0, 0.0), 5.0_f64.sqrt()).place, Place::End);
}
