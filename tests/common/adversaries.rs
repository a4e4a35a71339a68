//! Entities that are hard on purpose, by kind and seed.
//!
//! Each kind makes an entity of about unit size about the origin; then it is turned, scaled (1e-6 to 1e8), moved (to 1e7 times its
//! size) and reparametrised, by chance. What is asked of every one: an ulp of a parameter moves its points by less than a
//! billionth of its size, as otherwise no pair of `f64` names the foot point.

use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2, PI, TAU};

use glam::DVec3;

use super::random::Random;
use super::shape::{Shape, bezier_knots, knots_of_spans};

/// A hard entity, with points that are special to it: centres, points of axes and spines.
#[derive(Debug, Clone)]
pub struct Adversary {
    pub kind: &'static str,
    pub shape: Shape,
    pub special: Vec<DVec3>,
}

type Made = (Shape, Vec<DVec3>);
type Kind = (&'static str, fn(&mut Random) -> Made);

/// Every kind, by name.
pub const KINDS: &[Kind] = &[
    ("curve, weights far apart", weighted_curve),
    ("curve, crowded knots", crowded_curve),
    ("curve, uneven parameters", uneven_curve),
    ("curve, collinear net", collinear_curve),
    ("curve, cusp", cusp_curve),
    ("curve, loop", loop_curve),
    ("curve, kinks", kinked_curve),
    ("curve, closed", closed_curve),
    ("curve, circle", circle),
    ("curve, ellipse", ellipse),
    ("curve, high degree", high_degree_curve),
    ("curve, polyline", polyline),
    ("curve, many spans", many_span_curve),
    ("curve, coincident points", coincident_curve),
    ("curve, nearly straight", nearly_straight_curve),
    ("curve, near branches", near_branches),
    ("surface, weights far apart", weighted_surface),
    ("surface, crowded knots and weights", crowded_surface),
    ("surface, sliver", sliver),
    ("surface, shear", |random| shear(random.power(-6.0, -2.0))),
    ("surface, tangents nearly parallel", nearly_parallel),
    ("surface, collinear net", collinear_surface),
    ("surface, collapsed edges", collapsed_surface),
    ("surface, strip of no width", zero_width),
    ("surface, near sheets", near_sheets),
    ("surface, creases", creased_surface),
    ("surface, closed", closed_surface),
    ("surface, sphere", sphere),
    ("surface, torus", torus),
    ("surface, cylinder", cylinder),
    ("surface, cone", cone),
    ("surface, twisted bilinear", twisted_bilinear),
    ("surface, degenerate bilinear", degenerate_bilinear),
    ("surface, high degree", high_degree_surface),
    ("surface, uneven parameters", uneven_surface),
    ("surface, coincident points", coincident_surface),
    ("surface, nearly flat", nearly_flat),
    ("surface, planar", planar),
    ("surface, many spans", many_span_surface),
    ("surface, cusp", cusped_surface),
];

/// An entity of the kind `KINDS[kind]`, placed in the world.
pub fn adversary(kind: usize, random: &mut Random) -> Adversary {
    let (name, make) = KINDS[kind];
    loop {
        let (shape, special) = make(random);
        let adversary = placed(Adversary { kind: name, shape, special }, random);
        if grain(&adversary.shape) <= 1e-9 * adversary.shape.size() {
            return adversary;
        }
    }
}

/// A bound on how far one ulp of a parameter moves a point: the control polygon's speed, times the ratio of neighbouring weights.
pub fn grain(shape: &Shape) -> f64 {
    let along = |along: usize| {
        let (p, knots) = (shape.degree[along], &shape.knots[along]);
        let (step, count) = if along == 0 { (shape.columns, shape.rows) } else { (1, shape.columns) };
        let mut grain = 0.0_f64;
        for at in 0..shape.points.len() {
            let i = if along == 0 { at / shape.columns } else { at % shape.columns };
            if i + 1 == count {
                continue;
            }
            let ulp = f64::EPSILON * knots[i + 1].abs().max(knots[i + p + 1].abs());
            let length = (shape.points[at + step] - shape.points[at]).length();
            let ratio = shape.weight(at + step) / shape.weight(at);
            grain = grain.max(p as f64 * ulp * length * ratio.max(1.0 / ratio) / (knots[i + p + 1] - knots[i + 1]));
        }
        grain
    };
    along(0).max(if shape.curve { 0.0 } else { along(1) })
}

fn placed(mut adversary: Adversary, random: &mut Random) -> Adversary {
    let size = adversary.shape.size();
    let scale = if random.chance(0.4) { random.power(-6.0, 8.0) } else { 1.0 };
    let offset =
        if random.chance(0.3) { random.power(0.0, 7.0) * scale * size * random.direction() } else { DVec3::ZERO };
    let frame = if random.chance(0.5) { random.frame() } else { [DVec3::X, DVec3::Y, DVec3::Z] };
    let map = |p: DVec3| offset + scale * (p.x * frame[0] + p.y * frame[1] + p.z * frame[2]);
    adversary.shape = adversary.shape.mapped(map);
    adversary.special.iter_mut().for_each(|p| *p = map(*p));
    for along in 0..if adversary.shape.curve { 1 } else { 2 } {
        if random.chance(0.3) {
            let domains = [(1e6, 1e6 + 1.0), (-3e-5, 2e-5), (-7.0, 11.0), (0.0, 1e9), (-1e-9, 0.0), (0.25, 0.5)];
            let (low, high) = random.pick(&domains);
            let moved = adversary.shape.clone().over(along, low, high);
            if grain(&moved) <= 1e-9 * moved.size() {
                adversary.shape = moved;
            }
        }
    }
    if !adversary.shape.curve && random.chance(0.3) {
        adversary.shape = adversary.shape.swapped();
    }
    adversary
}

// ---- parts

fn uniform_knots(degree: usize, points: usize) -> Vec<f64> {
    let spans = points - degree;
    knots_of_spans(degree, &vec![1.0 / spans as f64; spans])
}

/// Points along a wandering path.
fn path(random: &mut Random, count: usize) -> Vec<DVec3> {
    let turn = random.between(0.5, 2.0);
    let along = |i: usize| DVec3::new(i as f64 / count as f64 * 2.0 - 1.0, 0.0, 0.0) * turn;
    (0..count).map(|i| along(i) + 0.5 * random.in_cube()).collect()
}

/// A net over a square, row by row.
fn net(random: &mut Random, rows: usize, columns: usize, height: f64) -> Vec<DVec3> {
    let at = |i: usize, n: usize| i as f64 / (n - 1) as f64 * 2.0 - 1.0;
    let noise = random.between(0.0, 0.6);
    (0..rows * columns)
        .map(|k| {
            let r = random.in_cube();
            let (i, j) = (k / columns, k % columns);
            DVec3::new(at(i, rows), at(j, columns), 0.0) + DVec3::new(noise * r.x, noise * r.y, height * r.z)
        })
        .collect()
}

/// Weights that may be anything: all equal and extreme, spikes, far apart.
fn weights(random: &mut Random, count: usize) -> Vec<f64> {
    let spread = random.between(1.0, 3.0);
    match random.count(0, 4) {
        0 => vec![1e-12; count],
        1 => vec![1e12; count],
        2 => {
            let mut weights = vec![1.0; count];
            for _ in 0..random.count(1, 2) {
                weights[random.count(0, count - 1)] = random.power(-6.0, 6.0).clamp(1e-3, 1e6);
            }
            weights
        }
        3 => (0..count).map(|_| random.power(-spread, spread)).collect(),
        _ => (0..count).map(|_| random.between(0.3, 3.0)).collect(),
    }
}

fn no_special(shape: Shape) -> Made {
    (shape, Vec::new())
}

fn plain_curve(degree: usize, points: Vec<DVec3>) -> Made {
    let knots = uniform_knots(degree, points.len());
    no_special(Shape::curve(degree, knots, points, None))
}

/// A surface with uniform knots from a net in row order.
fn plain_surface(degree: [usize; 2], rows: usize, points: Vec<DVec3>, weights: Option<Vec<f64>>) -> Made {
    let knots = [uniform_knots(degree[0], rows), uniform_knots(degree[1], points.len() / rows)];
    no_special(Shape::surface(degree, knots, points, weights))
}

/// An arc of the unit circle in the xy plane from the angle 0, in pieces of at most a quarter: knots, points, weights. The points
/// are `(x, y)` of the arc's control polygon (The NURBS Book, algorithm A7.1).
fn arc(sweep: f64) -> (Vec<f64>, Vec<[f64; 2]>, Vec<f64>) {
    let pieces = ((sweep / FRAC_PI_2).ceil() as usize).max(1);
    let half = sweep / pieces as f64 / 2.0;
    let exact = |angle: f64| {
        let quarters = angle / FRAC_PI_2;
        match quarters.round() as i64 {
            n if quarters == n as f64 => [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]][n.rem_euclid(4) as usize],
            _ => [angle.cos(), angle.sin()],
        }
    };
    let corner = if half == FRAC_PI_2 / 2.0 { FRAC_1_SQRT_2 } else { half.cos() };
    let (mut points, mut weights) = (vec![[1.0, 0.0]], vec![1.0]);
    for k in 0..pieces {
        let [from, to] = [2 * k, 2 * k + 2].map(|n| if n == 2 * pieces { sweep } else { n as f64 * half });
        let (a, b) = (exact(from), exact(to));
        let middle = if corner == FRAC_1_SQRT_2 {
            [a[0] + b[0], a[1] + b[1]]
        } else {
            [(from + half).cos() / corner, (from + half).sin() / corner]
        };
        points.extend([middle, b]);
        weights.extend([corner, 1.0]);
    }
    let mut knots = vec![0.0; 3];
    (1..pieces).for_each(|k| knots.extend([k as f64 / pieces as f64; 2]));
    knots.extend([1.0; 3]);
    (knots, points, weights)
}

/// The surface that a profile `(radius, height, weight)` sweeps about z, u along the profile.
pub fn revolved(degree: usize, profile_knots: Vec<f64>, profile: &[[f64; 3]], sweep: f64) -> Shape {
    let (knots, circle, around) = arc(sweep);
    let (mut points, mut weights) = (Vec::new(), Vec::new());
    for [radius, height, weight] in profile {
        for ([x, y], w) in circle.iter().zip(&around) {
            points.push(DVec3::new(radius * x, radius * y, *height));
            weights.push(weight * w);
        }
    }
    Shape::surface([degree, 2], [profile_knots, knots], points, Some(weights))
}

/// An arc of a circle about the origin in the xy plane.
pub fn circle_arc(radius: f64, sweep: f64) -> Shape {
    let (knots, points, weights) = arc(sweep);
    let points = points.iter().map(|[x, y]| DVec3::new(radius * x, radius * y, 0.0)).collect();
    Shape::curve(2, knots, points, Some(weights))
}

/// A zone of the unit sphere: latitudes from the south pole on.
pub fn sphere_zone(latitudes: f64, sweep: f64) -> Shape {
    let (knots, points, weights) = arc(latitudes);
    // turned back by a quarter: (x, y) of the arc becomes radius y, height -x from the south pole
    let profile: Vec<[f64; 3]> = points.iter().zip(weights).map(|([x, y], w)| [y.max(0.0), -x, w]).collect();
    revolved(2, knots, &profile, sweep)
}

/// A torus about z: the tube's arc begins on the outer equator.
pub fn torus_part(major: f64, minor: f64, tube: f64, sweep: f64) -> Shape {
    let (knots, points, weights) = arc(tube);
    let profile: Vec<[f64; 3]> =
        points.iter().zip(weights).map(|([x, y], w)| [major + minor * x, minor * y, w]).collect();
    revolved(2, knots, &profile, sweep)
}

fn sweep(random: &mut Random) -> f64 {
    if random.chance(0.5) { TAU } else { random.between(PI / 6.0, TAU) }
}

fn on_axis(random: &mut Random, [low, high]: [f64; 2]) -> Vec<DVec3> {
    (0..3).map(|_| DVec3::Z * random.between(low, high)).collect()
}

// ---- curves

fn weighted_curve(random: &mut Random) -> Made {
    let (degree, extra) = (random.count(2, 5), random.count(1, 6));
    let points = path(random, degree + extra);
    let weights = weights(random, points.len());
    no_special(Shape::curve(degree, uniform_knots(degree, points.len()), points, Some(weights)))
}

/// The knots of `spans` spans, some of them tiny: crowded at an end to 1e-9, elsewhere to 1e-6. The crowded end is at 0, where the
/// parameters between its knots can be told apart.
fn crowded_knots(random: &mut Random, degree: usize, spans: usize) -> Vec<f64> {
    let mut lengths = vec![1.0; spans];
    let crowd = random.count(1, spans - 1);
    if random.chance(0.5) {
        let tiny = random.power(-9.0, -2.0);
        lengths[..crowd].fill(tiny);
    } else {
        let (at, tiny) = (random.count(0, spans - 1), random.power(-6.0, -2.0));
        lengths[at] = tiny;
    }
    let knots = knots_of_spans(degree, &lengths);
    if random.chance(0.5) { knots } else { knots.iter().rev().map(|t| -t).collect() }
}

fn crowded_curve(random: &mut Random) -> Made {
    let (degree, spans) = (random.count(2, 5), random.count(2, 6));
    let knots = crowded_knots(random, degree, spans);
    let points = path(random, degree + spans);
    let weights = random.chance(0.6).then(|| weights(random, points.len()));
    no_special(Shape::curve(degree, knots, points, weights))
}

fn uneven_curve(random: &mut Random) -> Made {
    let (degree, spans) = (random.count(1, 4), random.count(3, 8));
    let lengths: Vec<f64> = (0..spans).map(|_| random.power(-4.0, 0.0)).collect();
    no_special(Shape::curve(degree, knots_of_spans(degree, &lengths), path(random, degree + spans), None))
}

fn collinear_curve(random: &mut Random) -> Made {
    let (degree, extra) = (random.count(2, 6), random.count(1, 4));
    let direction = random.pick(&[DVec3::X, DVec3::ONE, random.clone().direction()]);
    let points = (0..degree + extra).map(|_| direction * random.between(-1.0, 1.0)).collect();
    plain_curve(degree, points)
}

/// A cubic cusp; by chance opened a little or closed to a tiny loop.
fn cusp_curve(random: &mut Random) -> Made {
    let off = if random.chance(0.5) { 0.0 } else { random.sign() * random.power(-9.0, -2.0) };
    let height = random.between(0.3, 1.5);
    let points = [(-1.0, 0.0), (1.0 + off, height), (-1.0 - off, height), (1.0, 0.0)];
    let (shape, _) = plain_curve(3, points.map(|(x, y)| DVec3::new(x, y, 0.0)).to_vec());
    (shape, vec![DVec3::new(0.0, 0.75 * height, 0.0), DVec3::new(0.0, height, 0.0)])
}

fn loop_curve(random: &mut Random) -> Made {
    let wide = random.between(1.5, 4.0);
    let points = [(-1.0, 0.0), (wide, 1.0), (-wide, 1.0), (1.0, 0.0)];
    let lift = random.pick(&[0.0, 1e-9, 1e-3]);
    let points = points.iter().enumerate().map(|(i, (x, y))| DVec3::new(*x, *y, lift * i as f64)).collect();
    plain_curve(3, points)
}

fn kinked_curve(random: &mut Random) -> Made {
    let degree = random.count(2, 4);
    let pieces = random.count(2, 4);
    let mut knots = vec![0.0; degree + 1];
    (1..pieces).for_each(|k| knots.extend(vec![k as f64; degree]));
    knots.extend(vec![pieces as f64; degree + 1]);
    let points = path(random, degree * pieces + 1);
    let special = (1..pieces).map(|k| points[k * degree]).collect();
    (Shape::curve(degree, knots, points, None), special)
}

fn closed_curve(random: &mut Random) -> Made {
    let count = random.count(6, 12);
    let round = |i: usize| {
        let angle = i as f64 / (count - 1) as f64 * TAU;
        DVec3::new(angle.cos(), angle.sin(), 0.0)
    };
    let mut points: Vec<DVec3> = (0..count).map(|i| round(i) + 0.2 * random.in_cube()).collect();
    points[count - 1] = points[0];
    let (shape, _) = plain_curve(3, points);
    (shape, vec![DVec3::ZERO])
}

fn circle(random: &mut Random) -> Made {
    let (radius, sweep) = (random.between(0.3, 2.0), sweep(random));
    let mut special = on_axis(random, [-1.0, 1.0]);
    special.push(DVec3::ZERO);
    (circle_arc(radius, sweep), special)
}

fn ellipse(random: &mut Random) -> Made {
    let (flat, sweep) = (random.power(-4.0, 0.0), sweep(random));
    let shape = circle_arc(1.0, sweep).mapped(|p| DVec3::new(p.x, flat * p.y, p.z));
    // the centres of curvature at the two ends of each axis
    let special = vec![
        DVec3::ZERO,
        DVec3::X * (1.0 - flat * flat),
        DVec3::Y * (flat - 1.0 / flat).max(-50.0),
        DVec3::X * random.between(-1.0, 1.0),
    ];
    (shape, special)
}

fn high_degree_curve(random: &mut Random) -> Made {
    let (degree, extra) = (random.count(8, 25), random.count(1, 4));
    let points = path(random, degree + extra);
    let weights = random.chance(0.4).then(|| (0..points.len()).map(|_| random.power(-1.0, 1.0)).collect());
    no_special(Shape::curve(degree, uniform_knots(degree, points.len()), points, weights))
}

fn polyline(random: &mut Random) -> Made {
    let count = random.count(2, 30);
    let mut points = path(random, count);
    if random.chance(0.3) {
        points.iter_mut().for_each(|p| *p = p.round());
    }
    points[0] = DVec3::NEG_ONE;
    plain_curve(1, points)
}

fn many_span_curve(random: &mut Random) -> Made {
    let (degree, count) = (random.count(2, 4), random.count(60, 200));
    let wave = random.between(1.0, 20.0);
    let at = |i: usize| i as f64 / count as f64;
    let points = (0..count).map(|i| {
        let angle = wave * at(i) * TAU;
        DVec3::new(2.0 * at(i), 0.3 * angle.cos(), 0.3 * angle.sin()) + 0.01 * random.in_cube()
    });
    plain_curve(degree, points.collect())
}

/// Runs of equal control points, at the ends or inside; nearly equal ones by chance.
fn coincident_curve(random: &mut Random) -> Made {
    let (degree, extra) = (random.count(2, 5), random.count(2, 5));
    let mut points = path(random, degree + extra);
    let run = random.count(1, degree);
    let start = random.pick(&[0, points.len() - 1 - run, random.clone().count(0, points.len() - 1 - run)]);
    let apart = random.pick(&[0.0, 1e-14, 1e-9, 1e-6]);
    for i in start + 1..=start + run {
        points[i] = points[start] + apart * random.in_cube();
    }
    let special = vec![points[start]];
    let (shape, _) = plain_curve(degree, points);
    (shape, special)
}

fn nearly_straight_curve(random: &mut Random) -> Made {
    let (degree, extra) = (random.count(2, 5), random.count(1, 4));
    let off = random.power(-13.0, -3.0);
    let count = degree + extra;
    let points = (0..count).map(|i| DVec3::X * (i as f64 / count as f64) + off * random.in_cube());
    plain_curve(degree, points.collect())
}

/// There and back again, 1e-9 to 1e-3 apart.
fn near_branches(random: &mut Random) -> Made {
    let apart = random.power(-9.0, -3.0);
    let there: Vec<DVec3> = path(random, 6);
    let away = apart * random.direction();
    let back = there.iter().rev().map(|p| *p + away);
    let points: Vec<DVec3> = there.iter().copied().chain(back).collect();
    let special = there.iter().map(|p| *p + 0.5 * away).collect();
    let (shape, _) = plain_curve(3, points);
    (shape, special)
}

// ---- surfaces

fn degrees(random: &mut Random) -> [usize; 2] {
    [random.count(1, 4), random.count(1, 4)]
}

fn weighted_surface(random: &mut Random) -> Made {
    let degree = degrees(random);
    let [rows, columns] = degree.map(|d| d + random.count(1, 3));
    let points = net(random, rows, columns, 0.7);
    let weights = weights(random, points.len());
    plain_surface(degree, rows, points, Some(weights))
}

fn crowded_surface(random: &mut Random) -> Made {
    let degree = [random.count(2, 3), random.count(1, 3)];
    let spans = [random.count(2, 5), random.count(2, 4)];
    let knots = [0, 1].map(|k| crowded_knots(random, degree[k], spans[k]));
    let points = net(random, degree[0] + spans[0], degree[1] + spans[1], 0.7);
    let weights = random.chance(0.8).then(|| weights(random, points.len()));
    no_special(Shape::surface(degree, knots, points, weights))
}

fn sliver(random: &mut Random) -> Made {
    let degree = degrees(random);
    let [rows, columns] = degree.map(|d| d + random.count(1, 3));
    let thin = random.power(-9.0, -2.0);
    let points = net(random, rows, columns, 0.5).iter().map(|p| DVec3::new(p.x, thin * p.y, p.z)).collect();
    plain_surface(degree, rows, points, None)
}

/// The biquadratic `(u + v, e (u - v), (u² + v² - uv) / 100)` over the unit square.
pub fn shear(e: f64) -> Made {
    // blossoms of the monomials in u and v at the Bézier points
    let (linear, square) = ([0.0, 0.5, 1.0], [0.0, 0.0, 1.0]);
    let at = |k: usize| {
        let (i, j) = (k / 3, k % 3);
        let height = square[i] + square[j] - linear[i] * linear[j];
        DVec3::new(linear[i] + linear[j], e * (linear[i] - linear[j]), height / 100.0)
    };
    let shape = Shape::surface([2, 2], [bezier_knots(2), bezier_knots(2)], (0..9).map(at).collect(), None);
    // a hair above the point of the middle
    (shape, vec![DVec3::new(1.0, 0.0, 0.0025 + 1e-5), DVec3::new(0.8, 0.0, 1e-3)])
}

/// Bicubic by linear, with `S_u` and `S_v` nearly parallel everywhere.
fn nearly_parallel(random: &mut Random) -> Made {
    let off = random.power(-6.0, -1.0);
    let bend = random.between(0.05, 0.5);
    let spine: Vec<DVec3> = (0..4).map(|i| DVec3::X * i as f64 + bend * random.in_cube()).collect();
    let across = DVec3::new(1.0, off, off * random.between(-1.0, 1.0));
    let points = spine.iter().flat_map(|p| [*p, *p + across]).collect();
    plain_surface([3, 1], 4, points, None)
}

fn collinear_surface(random: &mut Random) -> Made {
    let degree = degrees(random);
    let [rows, columns] = degree.map(|d| d + 1);
    let direction = random.direction();
    let off = random.pick(&[0.0, 0.0, 1e-12, 1e-6]);
    let points = (0..rows * columns).map(|_| direction * random.between(-1.0, 1.0) + off * random.in_cube());
    plain_surface(degree, rows, points.collect(), None)
}

/// One edge or two of the net drawn to a point each.
fn collapsed_surface(random: &mut Random) -> Made {
    let degree = [random.count(2, 4), random.count(1, 4)];
    let [rows, columns] = degree.map(|d| d + random.count(1, 3));
    let mut points = net(random, rows, columns, 0.7);
    let apart = random.pick(&[0.0, 0.0, 1e-13, 1e-8]);
    let mut special = vec![points[0]];
    for j in 1..columns {
        points[j] = points[0] + apart * random.in_cube();
    }
    if random.chance(0.5) {
        let last = (rows - 1) * columns;
        special.push(points[last]);
        for j in 1..columns {
            points[last + j] = points[last] + apart * random.in_cube();
        }
    }
    let weights = random.chance(0.3).then(|| (0..points.len()).map(|_| random.power(-1.0, 1.0)).collect());
    let (shape, _) = plain_surface(degree, rows, points, weights);
    (shape, special)
}

/// A surface that is a curve in part or whole: columns of the net that coincide.
fn zero_width(random: &mut Random) -> Made {
    let degree = [random.count(1, 3), random.count(1, 3)];
    let [rows, columns] = [degree[0] + 2, degree[1] + 3];
    let mut points = net(random, rows, columns, 0.5);
    let whole = random.chance(0.3);
    for i in 0..rows {
        for j in 0..if whole { columns - 1 } else { degree[1] } {
            points[i * columns + j + 1] = points[i * columns];
        }
    }
    plain_surface(degree, rows, points, None)
}

/// A sheet folded back over itself, 1e-9 to 1e-3 above.
fn near_sheets(random: &mut Random) -> Made {
    let apart = random.power(-9.0, -3.0);
    let (half, columns) = (4, 4);
    let lower = net(random, half, columns, 0.4);
    let upper = (0..half).rev().flat_map(|i| (0..columns).map(move |j| i * columns + j));
    let points: Vec<DVec3> = lower.iter().copied().chain(upper.map(|k| lower[k] + apart * DVec3::Z)).collect();
    let special = lower.iter().map(|p| *p + 0.5 * apart * DVec3::Z).collect();
    let (shape, _) = plain_surface([3, 3], 2 * half, points, None);
    (shape, special)
}

fn creased_surface(random: &mut Random) -> Made {
    let degree = [random.count(2, 3), random.count(2, 3)];
    let knots = degree.map(|d| {
        let mut knots = vec![0.0; d + 1];
        knots.extend(vec![0.5; d]);
        knots.extend(vec![1.0; d + 1]);
        knots
    });
    let points = net(random, 2 * degree[0] + 1, 2 * degree[1] + 1, 0.7);
    let special = vec![points[points.len() / 2]];
    (Shape::surface(degree, knots, points, None), special)
}

fn closed_surface(random: &mut Random) -> Made {
    let (rows, columns) = (random.count(4, 6), random.count(6, 9));
    let mut points = Vec::new();
    for i in 0..rows {
        let radius = random.between(0.5, 1.5);
        let start = points.len();
        for j in 0..columns - 1 {
            let angle = j as f64 / (columns - 1) as f64 * TAU;
            points.push(DVec3::new(radius * angle.cos(), radius * angle.sin(), i as f64) + 0.1 * random.in_cube());
        }
        points.push(points[start]);
    }
    let special = on_axis(random, [0.0, rows as f64 - 1.0]);
    let (shape, _) = plain_surface([3, 3], rows, points, None);
    (shape, special)
}

fn sphere(random: &mut Random) -> Made {
    let latitudes = if random.chance(0.6) { PI } else { random.between(0.3, PI) };
    let mut special = on_axis(random, [-1.5, 1.5]);
    special.extend([DVec3::ZERO, DVec3::Z, DVec3::NEG_Z]);
    (sphere_zone(latitudes, sweep(random)), special)
}

fn torus(random: &mut Random) -> Made {
    // ring, horn and spindle
    let (major, minor) = (1.0, random.pick(&[0.2, 0.5, 1.0, 1.4]));
    let mut special = on_axis(random, [-1.0, 1.0]);
    special.push(DVec3::ZERO);
    for _ in 0..3 {
        let angle = random.between(0.0, TAU);
        special.push(DVec3::new(major * angle.cos(), major * angle.sin(), 0.0));
    }
    let tube = if random.chance(0.6) { TAU } else { random.between(0.5, TAU) };
    (torus_part(major, minor, tube, sweep(random)), special)
}

fn cylinder(random: &mut Random) -> Made {
    let height = random.power(-2.0, 2.0);
    let profile = [[1.0, 0.0, 1.0], [1.0, height, 1.0]];
    let special = on_axis(random, [-0.2 * height, 1.2 * height]);
    (revolved(1, bezier_knots(1), &profile, sweep(random)), special)
}

fn cone(random: &mut Random) -> Made {
    let (top, height) = (random.pick(&[0.0, 1e-9, 1e-3, 0.5]), random.power(-2.0, 2.0));
    let profile = [[1.0, 0.0, 1.0], [top, height, 1.0]];
    let mut special = on_axis(random, [-0.5 * height, 1.5 * height]);
    special.push(DVec3::Z * height);
    (revolved(1, bezier_knots(1), &profile, sweep(random)), special)
}

fn twisted_bilinear(random: &mut Random) -> Made {
    let twist = random.power(-8.0, 1.0);
    let corners = [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)];
    let points = corners.iter().map(|(x, y)| DVec3::new(*x, *y, twist * x * y)).collect();
    let (shape, _) = plain_surface([1, 1], 2, points, None);
    (shape, vec![DVec3::ZERO, DVec3::Z * random.between(-1.0, 1.0) / twist])
}

/// Bilinear, with directions in u and v that are parallel to rounding in the middle: an oriented box finds no frame there.
fn degenerate_bilinear(random: &mut Random) -> Made {
    let tenth = |random: &mut Random| (random.between(-10.0, 10.0).round()) / 10.0;
    let mut corner = || DVec3::new(tenth(random), tenth(random), tenth(random));
    let (a, du) = (corner(), corner() + DVec3::new(0.05, 0.0, 0.0));
    let parallel = 0.1 * tenth(random) + 0.85;
    // du and dv are the means of opposite sides
    let (dv, twist) = (parallel * du, DVec3::new(tenth(random), tenth(random), tenth(random)));
    let points = vec![a, a + dv - twist, a + du - twist, a + du + dv];
    plain_surface([1, 1], 2, points, None)
}

fn high_degree_surface(random: &mut Random) -> Made {
    let degree = [random.count(4, 9), random.count(4, 9)];
    let rows = degree[0] + 1;
    let points = net(random, rows, degree[1] + 1, 0.7);
    let weights = random.chance(0.3).then(|| (0..points.len()).map(|_| random.power(-0.5, 0.5)).collect());
    plain_surface(degree, rows, points, weights)
}

fn uneven_surface(random: &mut Random) -> Made {
    let degree = degrees(random);
    let knots = degree.map(|d| {
        let lengths: Vec<f64> = (0..random.count(2, 4)).map(|_| random.power(-4.0, 0.0)).collect();
        knots_of_spans(d, &lengths)
    });
    let [rows, columns] = [0, 1].map(|k| knots[k].len() - degree[k] - 1);
    let points = net(random, rows, columns, 0.6);
    no_special(Shape::surface(degree, knots, points, None))
}

fn coincident_surface(random: &mut Random) -> Made {
    let degree = [random.count(2, 4), random.count(2, 4)];
    let [rows, columns] = degree.map(|d| d + 2);
    let mut points = net(random, rows, columns, 0.6);
    let apart = random.pick(&[0.0, 1e-14, 1e-9]);
    // a block of the net in one point
    let (i0, j0) = (random.count(0, rows - 2), random.count(0, columns - 2));
    let target = points[i0 * columns + j0];
    for i in i0..=(i0 + 1 + random.count(0, 1)).min(rows - 1) {
        for j in j0..=(j0 + 1 + random.count(0, 1)).min(columns - 1) {
            points[i * columns + j] = target + apart * random.in_cube();
        }
    }
    let (shape, _) = plain_surface(degree, rows, points, None);
    (shape, vec![target])
}

fn nearly_flat(random: &mut Random) -> Made {
    let degree = degrees(random);
    let [rows, columns] = degree.map(|d| d + random.count(1, 3));
    let points = net(random, rows, columns, random.clone().power(-14.0, -4.0));
    plain_surface(degree, rows, points, None)
}

/// All in a plane, folds of the parametrisation included; by chance a saddle instead.
fn planar(random: &mut Random) -> Made {
    if random.chance(0.5) {
        let tall = random.power(-3.0, 1.0);
        let heights = [-1.0, 0.0, 1.0];
        let points = (0..9).map(|k| {
            let (x, y) = (heights[k / 3], heights[k % 3]);
            // x² - y² as a biquadratic: its blossoms at the corners and at the middles of the sides
            let square = |t: f64| if t == 0.0 { -1.0 } else { 1.0 };
            DVec3::new(x, y, tall * (square(x) - square(y)))
        });
        let (shape, _) = plain_surface([2, 2], 3, points.collect(), None);
        return (shape, vec![DVec3::ZERO, DVec3::Z * 0.5 / tall, DVec3::Z * random.between(-2.0, 2.0)]);
    }
    let degree = degrees(random);
    let [rows, columns] = degree.map(|d| d + random.count(1, 3));
    let points = net(random, rows, columns, 0.0);
    plain_surface(degree, rows, points, None)
}

fn many_span_surface(random: &mut Random) -> Made {
    let (rows, columns) = (random.count(12, 24), random.count(12, 24));
    let points = net(random, rows, columns, 0.1);
    plain_surface([3, random.count(1, 3)], rows, points, None)
}

/// Ruled from a cusp: the cusp runs along an edge of regression.
fn cusped_surface(random: &mut Random) -> Made {
    let (shape, special) = cusp_curve(random);
    let across = DVec3::new(random.between(-0.3, 0.3), random.between(-0.3, 0.3), 1.0);
    let points = shape.points.iter().flat_map(|p| [*p, *p + across]).collect();
    let (shape, _) = plain_surface([3, 1], 4, points, None);
    (shape, special.iter().map(|p| *p + 0.5 * across).collect())
}
