//! The entities of the stories.

use std::f64::consts::{FRAC_PI_2, TAU};

use glam::{DVec3, dvec3};
use perpend::kernel::{
    Circle, Cone, Cylinder, Ellipse, Frame, Plane, Spacing, Sphere, Torus, curve_through, extrusion, ruled,
};
use perpend::{Direction, NurbsCurve, NurbsSurface};

use super::case::Case;

/// Points of the plane z = 0.
pub(crate) fn flat(points: &[[f64; 2]]) -> Vec<DVec3> {
    points.iter().map(|[x, y]| dvec3(*x, *y, 0.0)).collect()
}

/// Clamped knots 0, 1, 2, … for so many control points.
pub(crate) fn whole_knots(degree: usize, points: usize) -> Vec<f64> {
    let spans = points - degree;
    let mut knots = vec![0.0; degree];
    knots.extend((0..=spans).map(|k| k as f64));
    knots.extend(vec![spans as f64; degree]);
    knots
}

pub(crate) fn curve(degree: usize, points: Vec<DVec3>) -> NurbsCurve {
    NurbsCurve::new(degree, whole_knots(degree, points.len()), points, None).expect("valid")
}

/// One Bézier piece over [0, 1].
pub(crate) fn bezier(points: Vec<DVec3>) -> NurbsCurve {
    curve(points.len() - 1, points)
}

/// Segments from point to point; vertex `k` has the parameter `k`.
pub(crate) fn polyline(points: &[DVec3]) -> NurbsCurve {
    curve(1, points.to_vec())
}

/// A surface of this degree in both directions; `net(i, j)` gives point and weight.
pub(crate) fn surface(
    degree: usize,
    rows: usize,
    columns: usize,
    net: impl Fn(usize, usize) -> (DVec3, f64),
) -> NurbsSurface {
    let row = |i: usize| (0..columns).map(|j| net(i, j)).unzip::<_, _, Vec<DVec3>, Vec<f64>>();
    let (points, weights): (Vec<_>, Vec<_>) = (0..rows).map(row).unzip();
    let plain = weights.iter().flatten().all(|w| *w == 1.0);
    let knots = (whole_knots(degree, rows), whole_knots(degree, columns));
    NurbsSurface::new((degree, degree), knots, points, (!plain).then_some(weights)).expect("valid")
}

pub(crate) fn plain_surface(
    degree: usize,
    rows: usize,
    columns: usize,
    net: impl Fn(usize, usize) -> DVec3,
) -> NurbsSurface {
    surface(degree, rows, columns, |i, j| (net(i, j), 1.0))
}

// ---- shapes of closed form, about the origin and z

pub(crate) fn circle(radius: f64) -> NurbsCurve {
    arc(radius, TAU)
}

pub(crate) fn arc(radius: f64, sweep: f64) -> NurbsCurve {
    Circle::new(Frame::WORLD, radius, (0.0, sweep)).and_then(|c| c.to_nurbs()).expect("valid")
}

pub(crate) fn ellipse(a: f64, b: f64) -> NurbsCurve {
    Ellipse::whole(Frame::WORLD, (a, b)).and_then(|e| e.to_nurbs()).expect("valid")
}

pub(crate) fn plane(width: (f64, f64), height: (f64, f64)) -> NurbsSurface {
    Plane::new(Frame::WORLD, width, height).and_then(|p| p.to_nurbs()).expect("valid")
}

/// Heights along u, angles along v.
pub(crate) fn cylinder(radius: f64, height: (f64, f64), sweep: f64) -> NurbsSurface {
    Cylinder::new(Frame::WORLD, radius, height, (0.0, sweep)).and_then(|c| c.to_nurbs()).expect("valid")
}

/// Its base of this radius at z = 0, its apex above.
pub(crate) fn cone(radius: f64, height: f64) -> NurbsSurface {
    Cone::new(Frame::WORLD, (radius, 0.0), (0.0, height), (0.0, TAU)).and_then(|c| c.to_nurbs()).expect("valid")
}

/// Latitudes along u from the south pole, longitudes along v.
pub(crate) fn sphere(radius: f64) -> NurbsSurface {
    Sphere::whole(Frame::WORLD, radius).and_then(|s| s.to_nurbs()).expect("valid")
}

/// The tube's angle along u from the outer equator, the azimuth along v.
pub(crate) fn torus(major: f64, minor: f64) -> NurbsSurface {
    Torus::whole(Frame::WORLD, major, minor).and_then(|t| t.to_nurbs()).expect("valid")
}

// ---- shapes of the stories

/// The pitch of the threads in the report.
pub(crate) const PITCH: f64 = 0.118;

/// The crest of a thread: a helical ribbon, u across it over [0, 1], v along its turns over [0, 72].
pub(crate) fn thread(turns: usize) -> NurbsSurface {
    let rim = |radius: f64| {
        let points: Vec<DVec3> = (0..=16 * turns)
            .map(|k| {
                let (sin, cos) = (TAU * k as f64 / 16.0).sin_cos();
                dvec3(radius * cos, radius * sin, PITCH * k as f64 / 16.0)
            })
            .collect();
        curve_through(&points, 3, Spacing::Uniform).expect("a helix")
    };
    let ribbon = ruled(&rim(0.45), &rim(0.5)).expect("rims of one kind").swapped();
    ribbon.with_domain(Direction::V, 0.0, 72.0).expect("a domain")
}

/// 33 × 33 bicubic spans of bumps, two spans each way from one to the next.
pub(crate) fn eggcrate() -> NurbsSurface {
    let wave = |k: usize| (FRAC_PI_2 * k as f64).sin();
    plain_surface(3, 36, 36, |i, j| dvec3(i as f64, j as f64, 2.0 * wave(i) * wave(j)))
}

/// A bicubic net over [0, 4]² whose weights lie between 1 / `spread` and `spread`.
pub(crate) fn weighted(spread: f64) -> NurbsSurface {
    let number = |i: usize, j: usize| ((7 * i + 5 * j + 3 * i * j) % 11) as f64 / 5.0 - 1.0;
    surface(3, 5, 5, |i, j| (dvec3(i as f64, j as f64, number(i, j)), spread.powf(number(j, i + 2))))
}

/// The unit square with one corner lifted.
pub(crate) fn twisted(lift: f64) -> NurbsSurface {
    plain_surface(1, 2, 2, |i, j| dvec3(i as f64, j as f64, lift * (i * j) as f64))
}

/// Four walls without floor and lid: the square of half width 1, z from -1 to 1, normals outward.
pub(crate) fn walls() -> NurbsSurface {
    let square = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]];
    let base: Vec<DVec3> = square.iter().map(|[x, y]| dvec3(*x, *y, -1.0)).collect();
    extrusion(&polyline(&base), 2.0 * DVec3::Z).expect("a path")
}

/// A cusp at (0.5, 0.75), u = 0.5, pointing up.
pub(crate) fn cusp() -> NurbsCurve {
    bezier(flat(&[[0.0, 0.0], [1.0, 1.0], [0.0, 1.0], [1.0, 0.0]]))
}

/// One entity of every kind, each about 1 to 50 in size.
pub(crate) fn gallery() -> Vec<(&'static str, Case)> {
    let wave = |k: usize| dvec3(0.7 * k as f64, (1.9 * k as f64).sin(), (1.1 * k as f64).cos());
    vec![
        ("segment", Case::new(polyline(&[dvec3(1.0, 2.0, -1.0), dvec3(-2.0, 0.5, 3.0)]))),
        ("polyline", Case::new(polyline(&flat(&[[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0], [1.0, 1.0]])))),
        ("circle", Case::new(circle(1.5))),
        ("short arc", Case::new(arc(2.0, 0.7))),
        ("ellipse", Case::new(ellipse(3.0, 0.5))),
        ("cubic", Case::new(curve(3, (0..12).map(wave).collect()))),
        ("degree 9", Case::new(bezier((0..10).map(wave).collect()))),
        ("cusp", Case::new(cusp())),
        ("plane", Case::new(plane((-1.0, 2.0), (0.0, 5.0)))),
        ("twisted", Case::new(twisted(0.3))),
        ("cylinder", Case::new(cylinder(1.5, (-1.0, 3.0), TAU))),
        ("open cylinder", Case::new(cylinder(1.5, (-1.0, 3.0), 1.5 * std::f64::consts::PI))),
        ("cone", Case::new(cone(1.0, 2.0))),
        ("sphere", Case::new(sphere(2.0))),
        ("torus", Case::new(torus(3.0, 1.0))),
        ("walls", Case::new(walls())),
        ("eggcrate", Case::new(eggcrate())),
        ("weights", Case::new(weighted(30.0))),
        ("thread", Case::new(thread(7))),
    ]
}

/// Query points about an entity: on, near, beside and beyond it, as shares of its size.
pub(crate) fn points_about(case: &Case, shares: &[f64]) -> Vec<DVec3> {
    let directions = [dvec3(0.6, -0.5, 0.62), dvec3(-0.35, 0.8, -0.48), dvec3(0.1, -0.2, -0.97)];
    let starts = case.grid(3).into_iter().map(|(_, _, point)| point);
    let around =
        |point: DVec3| shares.iter().zip(directions.iter().cycle()).map(move |(s, d)| (point, *s, d.normalize()));
    starts.flat_map(around).map(|(point, share, d)| point + share * case.size() * d).collect()
}
