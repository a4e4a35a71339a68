//! Carriers, loops and faces of the tests.

use std::f64::consts::{FRAC_1_SQRT_2, TAU};
use std::sync::Arc;

use glam::{DVec2, DVec3, dvec2, dvec3};
use perpend::kernel::{Frame, TrimCurveData, TrimLoopData, Trimming, TrimmingData};
use perpend::{Cone, Cylinder, NurbsSurface, Sphere, Torus};

use crate::common::random::Random;

/// A trimmed face with what a test wants to know of it.
pub(crate) struct Face {
    pub(crate) name: String,
    pub(crate) surface: NurbsSurface,
    pub(crate) trimming: Arc<Trimming>,
    /// Points that are hard on purpose: centres, axes, middles of holes.
    pub(crate) special: Vec<DVec3>,
}

impl Face {
    pub(crate) fn new(name: &str, surface: NurbsSurface, loops: Vec<TrimLoopData>) -> Self {
        Self::closed_to(name, surface, loops, 1e-9)
    }

    pub(crate) fn closed_to(name: &str, surface: NurbsSurface, loops: Vec<TrimLoopData>, tolerance: f64) -> Self {
        let data = TrimmingData { reversed: false, tolerance, loops };
        let (trimming, _) = Trimming::enter(data, &surface).unwrap_or_else(|error| panic!("{name}: {error}"));
        Self { name: name.to_owned(), surface, trimming: Arc::new(trimming), special: Vec::new() }
    }

    pub(crate) fn with_special(self, special: &[DVec3]) -> Self {
        Self { special: special.to_vec(), ..self }
    }
}

// ---- loops

/// Clamped uniform knots over [0, 1].
fn uniform_knots(degree: usize, points: usize) -> Vec<f64> {
    let spans = points - degree;
    let mut knots = vec![0.0; degree];
    knots.extend((0..=spans).map(|k| k as f64 / spans as f64));
    knots.extend(vec![1.0; degree]);
    knots
}

pub(crate) fn trim_curve(degree: usize, points: Vec<DVec2>, weights: Option<Vec<f64>>) -> TrimCurveData {
    TrimCurveData { degree, knots: uniform_knots(degree, points.len()), points, weights, edge: None }
}

pub(crate) fn line(from: DVec2, to: DVec2) -> TrimCurveData {
    trim_curve(1, vec![from, to], None)
}

/// A polygon, an edge a p-curve.
pub(crate) fn polygon(outer: bool, corners: &[DVec2]) -> TrimLoopData {
    let n = corners.len();
    TrimLoopData { outer, curves: (0..n).map(|k| line(corners[k], corners[(k + 1) % n])).collect() }
}

pub(crate) fn rectangle(outer: bool, low: DVec2, high: DVec2) -> TrimLoopData {
    let corners = [low, dvec2(high.x, low.y), high, dvec2(low.x, high.y)];
    let hole = [corners[0], corners[3], corners[2], corners[1]];
    polygon(outer, if outer { &corners } else { &hole })
}

/// Four rational arcs, in one curve or in four; counterclockwise where `outer`.
pub(crate) fn ellipse(outer: bool, centre: DVec2, radii: DVec2, pieces: usize) -> TrimLoopData {
    let corners = [
        (1.0, 0.0),
        (1.0, 1.0),
        (0.0, 1.0),
        (-1.0, 1.0),
        (-1.0, 0.0),
        (-1.0, -1.0),
        (0.0, -1.0),
        (1.0, -1.0),
        (1.0, 0.0),
    ];
    let turn = if outer { 1.0 } else { -1.0 };
    let points: Vec<DVec2> = corners.iter().map(|(x, y)| centre + radii * dvec2(*x, turn * y)).collect();
    let weights: Vec<f64> = (0..9).map(|k| if k % 2 == 0 { 1.0 } else { FRAC_1_SQRT_2 }).collect();
    let curves = if pieces == 1 {
        let mut knots = vec![0.0; 3];
        knots.extend([0.25, 0.25, 0.5, 0.5, 0.75, 0.75, 1.0, 1.0, 1.0]);
        vec![TrimCurveData { degree: 2, knots, points, weights: Some(weights), edge: None }]
    } else {
        let arc = |k: usize| trim_curve(2, points[2 * k..2 * k + 3].to_vec(), Some(weights[2 * k..2 * k + 3].to_vec()));
        (0..4).map(arc).collect()
    };
    TrimLoopData { outer, curves }
}

pub(crate) fn circle(outer: bool, centre: DVec2, radius: f64) -> TrimLoopData {
    ellipse(outer, centre, DVec2::splat(radius), 4)
}

/// A slot along u: two half circles of this radius about ends, joined by lines; a hole.
pub(crate) fn slot(centre: DVec2, half_length: f64, radius: f64) -> TrimLoopData {
    let (right, left) = (centre + dvec2(half_length, 0.0), centre - dvec2(half_length, 0.0));
    let up = dvec2(0.0, radius);
    let quarter = |about: DVec2, from: DVec2, to: DVec2| {
        let corner = about + (from - about) + (to - about);
        trim_curve(2, vec![from, corner, to], Some(vec![1.0, FRAC_1_SQRT_2, 1.0]))
    };
    let (tip, end) = (right + dvec2(radius, 0.0), left - dvec2(radius, 0.0));
    let curves = vec![
        line(left + up, right + up),
        quarter(right, right + up, tip),
        quarter(right, tip, right - up),
        line(right - up, left - up),
        quarter(left, left - up, end),
        quarter(left, end, left + up),
    ];
    TrimLoopData { outer: false, curves }
}

/// A star-shaped closed curve of one p-curve: a clamped B-spline through scattered radii, rational where `weights` is.
pub(crate) fn star(
    outer: bool,
    centre: DVec2,
    radii: DVec2,
    degree: usize,
    shares: &[f64],
    weights: Option<Vec<f64>>,
) -> TrimLoopData {
    let n = shares.len();
    let turn = if outer { TAU } else { -TAU };
    let mut points: Vec<DVec2> = (0..n)
        .map(|k| {
            let (sin, cos) = (turn * k as f64 / n as f64).sin_cos();
            centre + shares[k] * radii * dvec2(cos, sin)
        })
        .collect();
    points.push(points[0]);
    let weights = weights.map(|mut weights| {
        weights.push(weights[0]);
        weights
    });
    TrimLoopData { outer, curves: vec![trim_curve(degree, points, weights)] }
}

// ---- carriers

/// A surface over `[0, width] × [0, height]` of this degree whose control points are `net(share of u, share of v)`.
pub(crate) fn carrier(
    degree: usize,
    counts: [usize; 2],
    extent: DVec2,
    mut net: impl FnMut(usize, usize) -> (DVec3, f64),
) -> NurbsSurface {
    let row = |i: usize| (0..counts[1]).map(|j| net(i, j)).unzip::<_, _, Vec<DVec3>, Vec<f64>>();
    let (points, weights): (Vec<_>, Vec<_>) = (0..counts[0]).map(row).unzip();
    let plain = weights.iter().flatten().all(|w| *w == 1.0);
    let knots = |count: usize, extent: f64| uniform_knots(degree, count).iter().map(|t| extent * t).collect();
    let knots = (knots(counts[0], extent.x), knots(counts[1], extent.y));
    NurbsSurface::new((degree, degree), knots, points, (!plain).then_some(weights)).expect("a valid surface")
}

/// The plane z = 0 whose parameters are x and y.
pub(crate) fn plane(width: f64, height: f64) -> NurbsSurface {
    carrier(1, [2, 2], dvec2(width, height), |i, j| (dvec3(width * i as f64, height * j as f64, 0.0), 1.0))
}

/// A bicubic over the unit square of parameters, 4 wide, of random heights.
pub(crate) fn wavy(seed: u64, count: usize, height: f64, spread: f64) -> NurbsSurface {
    let mut random = Random::new(seed);
    let step = 4.0 / (count - 1) as f64;
    carrier(3, [count, count], DVec2::ONE, |i, j| {
        let jitter = 0.2 * step * random.in_cube();
        let point = dvec3(step * i as f64, step * j as f64, height * random.between(-1.0, 1.0));
        let weight = if spread == 1.0 { 1.0 } else { spread.powf(random.between(-1.0, 1.0)) };
        (point + jitter, weight)
    })
}

/// Two valleys along v at x = 1 (deeper) and x = 3: a bicubic whose heights are those of a wave.
pub(crate) fn valleys() -> NurbsSurface {
    let heights = [0.0, 1.0, -2.0, 1.0, 1.0, -1.5, 1.0, 0.0];
    carrier(3, [8, 4], DVec2::ONE, |i, j| (dvec3(4.0 * i as f64 / 7.0, 4.0 * j as f64 / 3.0, heights[i]), 1.0))
}

/// A roof: two planes that meet at u = 0.5 (degree 1).
pub(crate) fn roof() -> NurbsSurface {
    carrier(1, [3, 2], DVec2::ONE, |i, j| (dvec3(i as f64, 2.0 * j as f64, if i == 1 { 1.0 } else { 0.0 }), 1.0))
}

/// A bicubic with a crease at u = 0.5: the knot has the multiplicity 3.
pub(crate) fn creased() -> NurbsSurface {
    let heights = [0.0, 0.3, 0.4, 1.0, 0.4, 0.3, 0.0];
    let points = (0..7)
        .map(|i| (0..4).map(|j| dvec3(i as f64 / 2.0, j as f64, heights[i] + 0.1 * ((i * j) % 3) as f64)).collect())
        .collect();
    let mut u = vec![0.0; 4];
    u.extend([0.5, 0.5, 0.5, 1.0, 1.0, 1.0, 1.0]);
    let v = vec![0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0];
    NurbsSurface::new((3, 3), (u, v), points, None).expect("a valid surface")
}

/// z = x² - y² over [-1, 1]².
pub(crate) fn saddle() -> NurbsSurface {
    carrier(2, [3, 3], DVec2::ONE, |i, j| {
        let (x, y) = (i as f64 - 1.0, j as f64 - 1.0);
        // Bézier heights of x²: 1, -1, 1
        let square = |k: usize| if k == 1 { -1.0 } else { 1.0 };
        (dvec3(x, y, square(i) - square(j)), 1.0)
    })
}

/// Heights along u, angles along v.
pub(crate) fn cylinder(radius: f64, height: f64) -> NurbsSurface {
    Cylinder::new(Frame::WORLD, radius, (0.0, height), (0.0, TAU)).and_then(|c| c.to_nurbs()).expect("valid")
}

/// Latitudes along u from the south pole, longitudes along v.
pub(crate) fn sphere(radius: f64) -> NurbsSurface {
    Sphere::whole(Frame::WORLD, radius).and_then(|s| s.to_nurbs()).expect("valid")
}

/// Its base of this radius at z = 0 and u = 0, its apex above.
pub(crate) fn cone(radius: f64, height: f64) -> NurbsSurface {
    Cone::new(Frame::WORLD, (radius, 0.0), (0.0, height), (0.0, TAU)).and_then(|c| c.to_nurbs()).expect("valid")
}

/// The tube's angle along u from the outer equator, the azimuth along v.
pub(crate) fn torus(major: f64, minor: f64) -> NurbsSurface {
    Torus::whole(Frame::WORLD, major, minor).and_then(|t| t.to_nurbs()).expect("valid")
}

// ---- faces

pub(crate) fn plate_with_a_round_hole() -> Face {
    let loops = vec![rectangle(true, DVec2::ZERO, dvec2(10.0, 6.0)), circle(false, dvec2(4.0, 3.0), 1.5)];
    let special = [dvec3(4.0, 3.0, 0.0), dvec3(4.0, 3.0, 2.0), dvec3(4.5, 3.0, -1e-6), dvec3(4.0, 3.0 + 1e-9, 1.0)];
    Face::new("plate with a round hole", plane(10.0, 6.0), loops).with_special(&special)
}

pub(crate) fn plate_with_slots() -> Face {
    let hexagon: Vec<DVec2> = (0..6)
        .map(|k| {
            let (sin, cos) = (-TAU * f64::from(k) / 6.0).sin_cos();
            dvec2(8.0 + 0.8 * cos, 4.5 + 0.8 * sin)
        })
        .collect();
    let loops = vec![
        rectangle(true, dvec2(0.5, 0.5), dvec2(9.5, 5.5)),
        slot(dvec2(3.0, 2.0), 1.5, 0.4),
        slot(dvec2(3.0, 4.0), 1.0, 0.7),
        polygon(false, &hexagon),
    ];
    let special = [dvec3(3.0, 2.0, 0.0), dvec3(3.0, 4.0, 0.3), dvec3(8.0, 4.5, 0.0), dvec3(2.0, 4.0, 1e-7)];
    Face::new("plate with slots", plane(10.0, 6.0), loops).with_special(&special)
}

pub(crate) fn island_in_a_hole() -> Face {
    let middle = dvec2(5.0, 3.0);
    let loops =
        vec![rectangle(true, DVec2::ZERO, dvec2(10.0, 6.0)), circle(false, middle, 2.5), circle(true, middle, 1.0)];
    let special = [dvec3(5.0, 3.0, 1.0), dvec3(6.75, 3.0, 0.0), dvec3(6.75, 3.0, 0.5)];
    Face::new("island in a hole", plane(10.0, 6.0), loops).with_special(&special)
}

pub(crate) fn l_shape() -> Face {
    let corners = [[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [1.0, 1.0], [1.0, 4.0], [0.0, 4.0]].map(DVec2::from_array);
    let special = [dvec3(2.0, 2.0, 0.0), dvec3(1.0, 1.0, 0.5), dvec3(1.5, 1.5, -1.0)];
    Face::new("L", plane(5.0, 5.0), vec![polygon(true, &corners)]).with_special(&special)
}

pub(crate) fn annulus() -> Face {
    let middle = dvec2(5.0, 5.0);
    let loops = vec![ellipse(true, middle, DVec2::splat(4.0), 1), ellipse(false, middle, DVec2::splat(3.9), 1)];
    let special = [dvec3(5.0, 5.0, 0.0), dvec3(5.0, 5.0, 3.0), dvec3(5.0, 5.0 + 1e-8, 0.0)];
    Face::new("annulus", plane(10.0, 10.0), loops).with_special(&special)
}

pub(crate) fn sliver() -> Face {
    let corners = [dvec2(0.1, 0.1), dvec2(9.0, 7.0), dvec2(9.0, 7.0 + 1e-5)];
    Face::new("sliver", plane(10.0, 10.0), vec![polygon(true, &corners)]).with_special(&[dvec3(5.0, 3.8, 0.0)])
}

pub(crate) fn strip_of_a_wave() -> Face {
    let loops = vec![rectangle(true, dvec2(0.1, 0.5), dvec2(0.9, 0.5 + 1e-6))];
    Face::new("strip of a wave", wavy(3, 9, 0.8, 1.0), loops)
}

pub(crate) fn stamp_on_a_sheet() -> Face {
    let loops = vec![circle(true, dvec2(0.4, 0.6), 5e-4)];
    Face::new("stamp on a sheet", wavy(4, 8, 0.8, 2.0), loops)
}

pub(crate) fn whole_domain() -> Face {
    Face::new("whole domain", wavy(5, 6, 0.5, 1.0), vec![rectangle(true, DVec2::ZERO, DVec2::ONE)])
}

pub(crate) fn cube_face() -> Face {
    let square = carrier(1, [2, 2], DVec2::splat(10.0), |i, j| (dvec3(0.0, 10.0 * i as f64, 10.0 * j as f64), 1.0));
    let loops = vec![rectangle(true, DVec2::ZERO, DVec2::splat(10.0))];
    Face::new("cube face", square, loops).with_special(&[dvec3(5.0, 5.0, 100.0)])
}

/// Three quarters of a cylinder of radius 1: angles from 90° to 360° of a whole one.
pub(crate) fn three_quarters() -> Face {
    let loops = vec![rectangle(true, dvec2(0.0, 0.25), DVec2::ONE)];
    let special = [dvec3(2.0, 2.0, 1.0), dvec3(0.0, 0.0, 1.0), dvec3(0.1, 0.1, 1.0), dvec3(0.5, 0.5, 3.0)];
    Face::new("three quarters of a cylinder", cylinder(1.0, 2.0), loops).with_special(&special)
}

pub(crate) fn window_in_a_cylinder() -> Face {
    let loops = vec![
        rectangle(true, DVec2::ZERO, DVec2::ONE),
        ellipse(false, dvec2(0.5, 0.5), dvec2(0.3, 0.2), 4),
        ellipse(false, dvec2(0.5, 0.125), dvec2(0.2, 0.1), 1),
    ];
    let special = [dvec3(0.0, 0.0, 2.0), dvec3(-3.0, 0.0, 2.0), dvec3(-2.0, 0.0, 2.0), dvec3(1e-9, 0.0, 2.0)];
    Face::new("windows in a cylinder", cylinder(2.0, 4.0), loops).with_special(&special)
}

pub(crate) fn cap() -> Face {
    let loops = vec![rectangle(true, dvec2(0.75, 0.0), DVec2::ONE)];
    let special =
        [DVec3::ZERO, dvec3(0.0, 0.0, 5.0), dvec3(0.0, 0.0, 2.0), dvec3(0.0, 0.0, -3.0), dvec3(1e-9, 0.0, 1.0)];
    Face::new("cap about a pole", sphere(2.0), loops).with_special(&special)
}

pub(crate) fn cap_with_a_window() -> Face {
    let loops =
        vec![rectangle(true, dvec2(0.6, 0.0), DVec2::ONE), ellipse(false, dvec2(0.85, 0.4), dvec2(0.1, 0.25), 4)];
    Face::new("cap with a window", sphere(2.0), loops).with_special(&[DVec3::ZERO, dvec3(0.0, 0.0, 4.0)])
}

pub(crate) fn lune() -> Face {
    let loops = vec![rectangle(true, dvec2(0.0, 0.1), dvec2(1.0, 0.3))];
    Face::new("lune", sphere(1.0), loops).with_special(&[DVec3::ZERO, dvec3(0.0, 0.0, 3.0), dvec3(-1.0, -1.0, 0.0)])
}

pub(crate) fn sector_of_a_cone() -> Face {
    let loops = vec![rectangle(true, dvec2(0.3, 0.125), DVec2::ONE)];
    let special = [dvec3(0.0, 0.0, 3.0), dvec3(0.0, 0.0, 1.0), dvec3(0.0, 0.0, 5.0), dvec3(1.0, 0.3, 3.0)];
    Face::new("sector of a cone", cone(2.0, 3.0), loops).with_special(&special)
}

pub(crate) fn patch_of_a_torus() -> Face {
    let loops =
        vec![rectangle(true, dvec2(0.1, 0.05), dvec2(0.9, 0.95)), ellipse(false, dvec2(0.5, 0.5), dvec2(0.25, 0.1), 4)];
    let special =
        [DVec3::ZERO, dvec3(-3.0, 0.0, 0.0), dvec3(0.0, 3.0, 0.0), dvec3(0.0, 0.0, 1.0), dvec3(4.5, 0.0, 0.0)];
    Face::new("patch of a torus", torus(3.0, 1.0), loops).with_special(&special)
}

/// The deeper valley is cut away, save for its flanks.
pub(crate) fn valley_cut_away() -> Face {
    let loops = vec![rectangle(true, dvec2(0.45, 0.1), dvec2(0.95, 0.9))];
    let special = [dvec3(1.2, 2.0, -3.0), dvec3(1.2, 2.0, -1.2), dvec3(1.7, 2.0, -1.5), dvec3(2.0, 1.0, -4.0)];
    Face::new("valley cut away", valleys(), loops).with_special(&special)
}

/// A ring about the middle of a saddle.
pub(crate) fn ring_of_a_saddle() -> Face {
    let middle = dvec2(0.5, 0.5);
    let loops = vec![circle(true, middle, 0.45), circle(false, middle, 0.15)];
    let special = [DVec3::ZERO, dvec3(0.0, 0.0, 0.5), dvec3(0.0, 0.0, -2.0), dvec3(0.0, 0.0, 1e-6)];
    Face::new("ring of a saddle", saddle(), loops).with_special(&special)
}

pub(crate) fn roof_with_a_window() -> Face {
    let middle = dvec2(0.5, 0.5);
    let loops = vec![rectangle(true, dvec2(0.2, 0.1), dvec2(0.9, 0.9)), circle(false, middle, 0.2)];
    let special = [dvec3(1.0, 1.0, 1.0), dvec3(1.0, 1.0, 2.0), dvec3(1.0, 0.4, 3.0), dvec3(1.0, 1.0, 0.0)];
    Face::new("roof with a window", roof(), loops).with_special(&special)
}

pub(crate) fn creased_disc() -> Face {
    let loops = vec![circle(true, dvec2(0.45, 0.5), 0.3)];
    Face::new("creased disc", creased(), loops).with_special(&[dvec3(1.5, 1.5, 2.0), dvec3(1.5, 1.5, -1.0)])
}

pub(crate) fn wave_with_wavy_trims() -> Face {
    let shares = [1.0, 0.6, 0.9, 0.5, 1.0, 0.7, 0.95, 0.55, 0.8];
    let weights: Vec<f64> = (0..9).map(|k| [1.0, 3.0, 0.4][k % 3]).collect();
    let middle = dvec2(0.5, 0.5);
    let loops = vec![
        star(true, middle, DVec2::splat(0.48), 3, &shares, Some(weights)),
        star(false, middle, DVec2::splat(0.2), 2, &shares, None),
    ];
    Face::new("wave with wavy trims", wavy(6, 8, 0.8, 2.0), loops)
}

pub(crate) fn eggcrate_with_holes() -> Face {
    let heights = |k: usize| (std::f64::consts::FRAC_PI_2 * k as f64).sin();
    let crate_of = carrier(3, [19, 19], DVec2::splat(16.0), |i, j| {
        (dvec3(i as f64, j as f64, 2.0 * heights(i) * heights(j)), 1.0)
    });
    let mut loops = vec![rectangle(true, dvec2(0.5, 0.5), dvec2(15.5, 15.5))];
    for i in 0..4 {
        for j in 0..4 {
            loops.push(circle(false, dvec2(2.3 + 3.7 * f64::from(i), 2.1 + 3.8 * f64::from(j)), 1.1));
        }
    }
    Face::new("eggcrate with holes", crate_of, loops)
}

/// All of them.
pub(crate) fn all() -> Vec<Face> {
    vec![
        plate_with_a_round_hole(),
        plate_with_slots(),
        island_in_a_hole(),
        l_shape(),
        annulus(),
        sliver(),
        strip_of_a_wave(),
        stamp_on_a_sheet(),
        whole_domain(),
        cube_face(),
        three_quarters(),
        window_in_a_cylinder(),
        cap(),
        cap_with_a_window(),
        lune(),
        sector_of_a_cone(),
        patch_of_a_torus(),
        valley_cut_away(),
        ring_of_a_saddle(),
        roof_with_a_window(),
        creased_disc(),
        wave_with_wavy_trims(),
        eggcrate_with_holes(),
    ]
}
