//! Distances to triangles and polylines by brute force, and surfaces to try.

use glam::{DVec2, DVec3};
use perpend_kernel::{Direction, InvalidTrim, NurbsSurface, TrimCurveData, TrimLoopData, Trimming, TrimmingData};
use perpend_tessellation::Mesh;
use proptest::prelude::*;

/// The distance from a point to a triangle: to its plane where the foot is inside, else to its sides.
pub(crate) fn distance_to_triangle(p: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let normal = (b - a).cross(c - a);
    let sides = [(a, b), (b, c), (c, a)];
    if normal.length() > 0.0 && sides.iter().all(|(from, to)| (*to - *from).cross(p - *from).dot(normal) >= 0.0) {
        return (p - a).dot(normal.normalize()).abs();
    }
    sides.iter().map(|(from, to)| distance_to_segment(p, *from, *to)).fold(f64::INFINITY, f64::min)
}

pub(crate) fn distance_to_segment(p: DVec3, from: DVec3, to: DVec3) -> f64 {
    let along = to - from;
    let share =
        if along == DVec3::ZERO { 0.0 } else { ((p - from).dot(along) / along.length_squared()).clamp(0.0, 1.0) };
    p.distance(from + share * along)
}

pub(crate) fn distance_to_mesh(p: DVec3, mesh: &Mesh) -> f64 {
    mesh.corners().map(|triangle| distance_to_triangle(p, triangle)).fold(f64::INFINITY, f64::min)
}

/// Parameters spread evenly over the domain, ends included.
pub(crate) fn spread(surface: &NurbsSurface, count: usize) -> Vec<DVec2> {
    let [(u0, u1), (v0, v1)] = [Direction::U, Direction::V].map(|direction| surface.domain(direction));
    let share = |k: usize| k as f64 / (count - 1) as f64;
    (0..count * count)
        .map(|k| {
            DVec2::new(u0 + share(k / count) * (u1 - u0), v0 + share(k % count) * (v1 - v0)).min(DVec2::new(u1, v1))
        })
        .collect()
}

/// Points inside a triangle, its corners and the middles of its sides, with their weights.
pub(crate) fn within_triangle() -> impl Iterator<Item = [f64; 3]> {
    (0..=4).flat_map(|i| (0..=4 - i).map(move |j| [f64::from(i) / 4.0, f64::from(j) / 4.0, f64::from(4 - i - j) / 4.0]))
}

/// The largest distance of points of the mesh from the surface at the same parameters.
pub(crate) fn largest_deviation(surface: &NurbsSurface, mesh: &Mesh) -> f64 {
    let mut largest = 0.0_f64;
    for triangle in &mesh.triangles {
        let corners = triangle.map(|i| i as usize);
        for weights in within_triangle() {
            let at = |k: usize| weights[k];
            let place: DVec2 = (0..3).map(|k| at(k) * mesh.parameters[corners[k]]).sum();
            let point: DVec3 = (0..3).map(|k| at(k) * mesh.vertices[corners[k]]).sum();
            largest = largest.max(surface.point(place.x, place.y).distance(point));
        }
    }
    largest
}

/// The trimming of a surface by closed polygons.
pub(crate) fn polygons(surface: &NurbsSurface, loops: &[Vec<DVec2>], reversed: bool) -> Trimming {
    try_polygons(surface, loops, reversed).expect("a valid trim")
}

/// As [`polygons`], of loops that may be refused.
pub(crate) fn try_polygons(
    surface: &NurbsSurface,
    loops: &[Vec<DVec2>],
    reversed: bool,
) -> Result<Trimming, InvalidTrim> {
    let side = |from: DVec2, to: DVec2| TrimCurveData {
        degree: 1,
        knots: vec![0.0, 0.0, 1.0, 1.0],
        points: vec![from, to],
        weights: None,
        edge: None,
    };
    let around = |points: &Vec<DVec2>| TrimLoopData {
        outer: true,
        curves: (0..points.len()).map(|i| side(points[i], points[(i + 1) % points.len()])).collect(),
    };
    let data = TrimmingData { reversed, tolerance: 1e-9, loops: loops.iter().map(around).collect() };
    Trimming::enter(data, surface).map(|(trimming, _)| trimming)
}

pub(crate) fn entered(surface: &NurbsSurface, loops: Vec<TrimLoopData>, reversed: bool) -> Trimming {
    Trimming::enter(TrimmingData { reversed, tolerance: 1e-9, loops }, surface).expect("a valid trim").0
}

/// A whole circle in the parameters, as four rational arcs.
pub(crate) fn circle(centre: DVec2, radius: f64, outer: bool) -> TrimLoopData {
    let points = [(1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (-1.0, 1.0), (-1.0, 0.0), (-1.0, -1.0), (0.0, -1.0), (1.0, -1.0)];
    let points = points.into_iter().chain([points[0]]).map(|(x, y)| centre + radius * DVec2::new(x, y));
    let half = std::f64::consts::FRAC_1_SQRT_2;
    TrimLoopData {
        outer,
        curves: vec![TrimCurveData {
            degree: 2,
            knots: vec![0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 4.0, 4.0, 4.0],
            points: points.collect(),
            weights: Some((0..9).map(|i| if i % 2 == 0 { 1.0 } else { half }).collect()),
            edge: None,
        }],
    }
}

/// Surfaces of any degree up to 4, rational or not, with inner knots up to full multiplicity and control points that may coincide.
pub(crate) fn surfaces() -> impl Strategy<Value = NurbsSurface> {
    let direction = || (1..=4_usize, prop::collection::vec(1..=4_usize, 0..=2));
    (direction(), direction(), any::<bool>()).prop_flat_map(|(u, v, rational)| {
        let knots = |(degree, inner): &(usize, Vec<usize>)| {
            let mut knots = vec![0.0; degree + 1];
            for (i, multiplicity) in inner.iter().enumerate() {
                knots.extend(std::iter::repeat_n((i + 1) as f64 * 0.7, (*multiplicity).min(*degree)));
            }
            knots.extend(std::iter::repeat_n((inner.len() + 1) as f64 * 0.7, degree + 1));
            knots
        };
        let (ku, kv) = (knots(&u), knots(&v));
        let (rows, columns) = (ku.len() - u.0 - 1, kv.len() - v.0 - 1);
        let offset = prop_oneof![4 => -0.6..0.6_f64, 1 => Just(0.0), 1 => Just(-1.0)];
        let net = prop::collection::vec((offset.clone(), offset.clone(), offset), rows * columns);
        let weights = prop::collection::vec(0.3..3.0_f64, rows * columns);
        (net, weights).prop_filter_map("all points are one", move |(net, weights)| {
            let point = |i: usize, j: usize| {
                let (x, y, z) = net[i * columns + j];
                DVec3::new(i as f64 + x, j as f64 + y, z)
            };
            let points = (0..rows).map(|i| (0..columns).map(|j| point(i, j)).collect()).collect();
            let weights = rational.then(|| weights.chunks(columns).map(<[f64]>::to_vec).collect());
            NurbsSurface::new((u.0, v.0), (ku.clone(), kv.clone()), points, weights).ok()
        })
    })
}
