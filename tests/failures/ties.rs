//! Points from which a whole set of points is nearest.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_3, TAU};

use glam::{DVec3, dvec3};
use perpend::{Multiplicity, Ties};

use super::case::{Case, close, u};
use super::shapes::{arc, bezier, circle, cone, curve, cylinder, flat, plane, polyline, sphere, torus};
use crate::common::random::Random;

/// The parameters that the continua cover.
fn covers(ties: &Ties, u: f64, v: f64) -> bool {
    let within = |x: f64, (from, to): (f64, f64)| from <= x && x <= to;
    ties.continua.iter().flat_map(|set| &set.boxes).any(|b| within(u, b.u) && within(v, b.v))
}

/// Fails unless the nearest points of `p` are a continuum at `distance` that covers all parameters that `member` names, and none
/// that is farther than `slack` beyond it.
fn continuum(name: &str, case: &Case, p: DVec3, distance: f64, member: impl Fn(f64, f64) -> bool) {
    let foot = case.foot_at(p, distance);
    // exact but for the rounding of an evaluation
    close(foot.distance, distance, 8.0 * f64::EPSILON * case.size());
    assert_eq!(foot.multiplicity, Multiplicity::Continuum, "{name}: {foot:?}");
    let ties = case.ties(p);
    assert!(ties.complete, "{name}: incomplete");
    assert_eq!(ties.points, [], "{name}: isolated feet beside the continuum");
    assert_eq!(ties.nearest.multiplicity, Multiplicity::Continuum, "{name}");
    let mut members = 0;
    for (u, v, point) in case.grid(48) {
        if member(u, v) {
            members += 1;
            assert!(covers(&ties, u, v), "{name}: ({u}, {v}) is left out");
        } else {
            // boxes are as wide as 1/64 of the size: what lies well off the set is not covered
            let off = point.distance(p) - distance;
            assert!(off < 0.2 * case.size() || !covers(&ties, u, v), "{name}: ({u}, {v}) is {off} farther");
        }
    }
    assert!(members > 8, "{name}: {members} members");
}

/// OCCT bug 30778: the centre of a circle was an exception. Its distance is the radius, all around.
#[test]
fn from_the_centre_of_a_circle_all_of_it_is_nearest() {
    for radius in [1e-3, 1.0, 2.5e5] {
        let case = Case::new(circle(radius));
        continuum("circle", &case, DVec3::ZERO, radius, |_, _| true);
        continuum("circle, above its centre", &case, radius * 0.75 * DVec3::Z, 1.25 * radius, |_, _| true);
        for sweep in [0.2, FRAC_PI_3, FRAC_PI_2, 4.0] {
            continuum("arc", &Case::new(arc(radius, sweep)), DVec3::ZERO, radius, |_, _| true);
        }
    }
}

/// truck: the centre of a sphere was answered with a NaN, a point of its axis with another.
#[test]
fn from_the_centre_of_a_sphere_all_of_it_is_nearest() {
    for radius in [5e-4, 1.0, 7e3] {
        continuum("sphere", &Case::new(sphere(radius)), DVec3::ZERO, radius, |_, _| true);
    }
    // on the axis the pole is one point, though a whole edge of parameters
    let case = Case::new(sphere(1.0));
    for z in [0.25, 1.0, 4.0] {
        let ties = case.ties(z * DVec3::Z);
        assert_eq!(case.foot(z * DVec3::Z).multiplicity, Multiplicity::Unique, "z = {z}");
        assert_eq!((ties.points.len(), ties.continua.len(), ties.complete), (1, 0, true), "z = {z}: {ties:?}");
    }
}

/// OCCT bug 30778 on axes and spines: the answer for "infinitely many" was that of a failure.
#[test]
fn from_axes_and_spines_a_whole_circle_is_nearest() {
    let can = Case::new(cylinder(1.5, (0.0, 4.0), TAU));
    continuum("cylinder's axis", &can, DVec3::Z, 1.5, |u, _| u == 0.25);
    // below its rim: the rim
    continuum("cylinder's axis below", &can, -2.0 * DVec3::Z, 2.5, |u, _| u == 0.0);
    let ring = Case::new(torus(3.0, 1.0));
    // the azimuth of 90 degrees is v = 1/4
    continuum("torus's spine", &ring, 3.0 * DVec3::Y, 1.0, |_, v| v == 0.25);
    // seen from the centre: the inner equator, u = 1/2
    continuum("torus's centre", &ring, DVec3::ZERO, 2.0, |u, _| u == 0.5);
    // seen from (0, 0, 4): 5 from the spine, a tube's angle that is no knot
    let foot = ring.foot_at(4.0 * DVec3::Z, 4.0);
    assert_eq!(foot.multiplicity, Multiplicity::Continuum, "{foot:?}");
    // inside a cone of half angle 45 degrees, 1 below its apex: a circle half way down
    let hat = Case::new(cone(2.0, 2.0));
    continuum("cone's axis", &hat, DVec3::Z, 0.5_f64.sqrt(), |u, _| u == 0.75);
}

/// A stretch of parallels: the middle line of a gutter, the points inside a polyline's parallel runs.
#[test]
fn isolated_ties_are_told_from_continua() {
    // two feet: midway between two walls
    let fork = Case::new(polyline(&flat(&[[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [0.0, 2.0]])));
    let p = dvec3(1.0, 1.0, 0.0);
    fork.foot_at(p, 1.0);
    let ties = fork.ties(p);
    assert_eq!(ties.nearest.multiplicity, Multiplicity::Tied);
    let feet: Vec<f64> = ties.points.iter().map(u).collect();
    assert_eq!((feet.len(), ties.continua.len(), ties.complete), (2, 0, true), "{ties:?}");
    close(feet[0], 0.25, 1e-12);
    close(feet[1], 2.75, 1e-12);
    // three: with the closing wall
    let feet: Vec<f64> = fork.ties(dvec3(3.0, 1.0, 0.0)).points.iter().map(u).collect();
    assert_eq!(feet.len(), 3, "{feet:?}");
    close(feet[1], 1.5, 1e-12);
    // one
    let ties = fork.ties(dvec3(1.0, 0.9, 0.0));
    assert_eq!((ties.points.len(), ties.nearest.multiplicity), (1, Multiplicity::Unique), "{ties:?}");
    // a flat place has one foot
    let ties = Case::new(plane((0.0, 1.0), (0.0, 1.0))).ties(dvec3(0.3, 0.4, 2.0));
    assert_eq!((ties.points.len(), ties.continua.len()), (1, 0));
}

/// bezier #13, WorldBuilder PR 452, with their numbers: where a cubic crosses itself one point has two parameters.
#[test]
fn where_a_curve_crosses_itself_both_parameters_are_feet() {
    let case = Case::new(bezier(flat(&[[0.0, 2.0], [-1.0, 0.0], [1.0, 1.0], [-0.75, 1.625]])));
    let p = dvec3(-0.25, 1.375, 0.0);
    let foot = case.foot_at(p, 0.0);
    let half = 5.0_f64.sqrt() / 6.0;
    let distance_from = |u: f64| (u - (0.5 - half)).abs().min((u - (0.5 + half)).abs());
    assert!(distance_from(u(&foot)) <= 1e-15, "{foot:?}");
    assert!(foot.distance <= 1e-15);
    // a hair beside the crossing both branches are near, and the nearer is found
    for angle in 0..12 {
        let (sin, cos) = f64::from(angle).sin_cos();
        for step in [1e-9, 1e-6, 1e-3] {
            let foot = case.foot_by_oracle(p + step * dvec3(cos, sin, 0.0));
            assert!(foot.distance <= step);
        }
    }
}

/// As above: `project_ties` gives both parameters, one foot point.
#[test]
fn the_parameters_of_a_crossing_belong_to_one_foot_point() {
    let case = Case::new(bezier(flat(&[[0.0, 2.0], [-1.0, 0.0], [1.0, 1.0], [-0.75, 1.625]])));
    let ties = case.ties(dvec3(-0.25, 1.375, 0.0));
    assert!(ties.complete && ties.continua.is_empty(), "{ties:?}");
    // no two feet are closer than `coincidence`: the crossing counts once
    assert_eq!((ties.points.len(), ties.nearest.multiplicity), (1, Multiplicity::Unique), "{ties:?}");
}

/// A valley is wider within the gap than two feet may be close, so the piece beyond a knot once called its border another foot.
#[test]
fn a_foot_beside_a_knot_is_one_foot() {
    let mut random = Random::new(777);
    for round in 0..400 {
        let degree = 2 + round % 3;
        let points = (0..degree + 4).map(|i| i as f64 * DVec3::X + 0.5 * random.in_cube()).collect();
        let case = Case::new(curve(degree, points));
        for _ in 0..5 {
            let knot = case.share(0, 0.25);
            let u = knot + random.sign() * random.power(-8.0, -2.0);
            let across = random.direction();
            let tangent = case.at(u + 1e-6, 0.0) - case.at(u - 1e-6, 0.0);
            let p = case.at(u, 0.0) + case.size() * random.power(-3.0, -1.5) * across.reject_from(tangent).normalize();
            let ties = case.ties(p);
            if ties.nearest.distance < 0.9 * case.at(u, 0.0).distance(p) {
                continue; // another branch is nearer: its foot is not beside the knot
            }
            assert!(ties.complete && ties.continua.is_empty(), "{u} {p}: {ties:?}");
            assert_eq!(ties.points.len(), 1, "degree {degree}, u = {u}, {p}: {ties:?}");
        }
    }
}

/// A step that leaves the box in one parameter need not lead downhill in the other: the search stuck at a border that is no
/// minimum, and the only foot was lost while the search called itself complete.
#[test]
fn the_only_foot_is_not_lost_at_a_border() {
    let weights = [
        [1.1922667614476072, 5.1130607034174265, 2.484797635477261],
        [7.556271946550355, 8.833310073504459, 1.6090744938963317],
    ];
    let points = [
        [
            dvec3(-0.10140079539134843, 0.48361420714276876, 0.43308307859176254),
            dvec3(0.535469503332352, 1.3758060298515904, 0.3868495767804294),
            dvec3(-0.27855974075142087, 2.6590783173263146, 0.6023403877934418),
        ],
        [
            dvec3(0.3635209185984478, 0.2764510895541003, 0.13240336225502156),
            dvec3(0.8683853750190522, 1.0278905993226684, 0.45329294363934786),
            dvec3(1.4592736444496546, 1.6640425436863358, 0.6097975599109741),
        ],
    ];
    let knots = (vec![0.0, 0.0, 1.0, 1.0], vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0]);
    let points = points.map(|row| row.to_vec()).to_vec();
    let weights = weights.map(|row| row.to_vec()).to_vec();
    let surface = perpend::NurbsSurface::new((1, 2), knots, points, Some(weights)).expect("valid");
    let ties = Case::new(surface).ties(dvec3(-0.27856230814316935, 2.6592064492241443, 0.6004205827601131));
    assert!(ties.complete && ties.continua.is_empty(), "{ties:?}");
    assert_eq!((ties.points.len(), ties.points[0]), (1, ties.nearest), "{ties:?}");
}

/// Beside the centre of a circle rounding moves a foot by more; one at the seam was taken off it.
#[test]
fn a_foot_at_the_seam_is_on_it_also_near_the_centre() {
    let case = Case::new(circle(60.0));
    for x in [0.01, 0.1, 0.5, 1.0, 2.0, 10.0, 59.0, 61.0, 600.0] {
        let foot = case.foot_at(x * DVec3::X, (x - 60.0_f64).abs());
        assert_eq!((u(&foot), foot.place), (0.0, perpend::Place::Seam), "x = {x}: {foot:?}");
    }
}
