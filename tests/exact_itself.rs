//! The exact distances to bounded shapes are held to samples of the shapes, to a search of their NURBS forms that knows no shape, and
//! to each other.

mod common;

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use common::double_double::Dd;
use common::exact::Exact;
use common::exact::curve::Arc;
use common::exact::turn::{Range, direction};
use common::exact::vector::Vector;
use common::oracle::{Oracle, TOLERANCE};
use common::random::Random;
use common::shape::Shape;
use glam::DVec3;
use perpend::Frame;

/// A range of angles of 1 to 360 degrees, anywhere.
fn sweep(random: &mut Random) -> (f64, f64) {
    let start = random.pick(&[0.0, -1.0, 2.5, random.clone().between(-7.0, 7.0)]);
    let turn = if random.chance(0.3) { TAU } else { random.power(-1.7, 0.79) };
    (start, start + turn)
}

fn shapes(random: &mut Random) -> Vec<Exact> {
    let [x, _, z] = random.frame();
    let frame = Frame::new(random.in_cube(), z, x).expect("a frame");
    let radius = random.between(0.3, 2.0);
    let height = (random.between(-1.0, 0.0), random.between(0.1, 1.0));
    let sweep = sweep(random);
    let latitude = random.pick(&[(-FRAC_PI_2, FRAC_PI_2), (-0.3, 1.2), (0.2, FRAC_PI_2)]);
    let tube = random.pick(&[(0.0, TAU), (-1.0, 1.0), (1.5, 5.0)]);
    let minor = radius * random.pick(&[0.2, 0.7, 1.0]);
    let profile = Shape::curve(
        2,
        vec![0.0, 0.0, 0.0, 0.4, 1.0, 1.0, 1.0],
        [(0.5, -1.0), (1.5, -0.5), (0.3, 0.5), (1.0, 1.0)].map(|(r, z)| DVec3::new(r, 0.0, z)).to_vec(),
        random.chance(0.5).then(|| vec![1.0, 2.0, 0.7, 1.0]),
    );
    vec![
        Exact::Segment { a: random.in_cube(), b: random.in_cube() },
        Exact::Circle { frame, radius, sweep },
        Exact::Ellipse { frame, radii: (radius, random.between(0.05, 2.0)), sweep },
        Exact::Parallelogram { corner: random.in_cube(), a: random.in_cube(), b: random.in_cube() },
        Exact::Cylinder { frame, radius, height, sweep },
        Exact::Cone { frame, radii: random.pick(&[(radius, 0.0), (0.2, radius), (0.0, 0.1)]), height, sweep },
        Exact::Sphere { frame, radius, latitude, sweep },
        Exact::Torus { frame, major: radius, minor, tube, sweep },
        Exact::Extrusion { profile: profile.clone(), vector: random.in_cube() },
        Exact::Revolution { profile, origin: DVec3::ZERO, axis: DVec3::Z, sweep: sweep.1 - sweep.0 },
    ]
}

fn points(random: &mut Random, shape: &Shape) -> Vec<DVec3> {
    let [low, high] = shape.bounds();
    let (middle, size) = (0.5 * (low + high), shape.size());
    let on = |random: &mut Random| {
        let at = [0, 1].map(|k| random.between(shape.domain(k)[0], shape.domain(k)[1]));
        shape.point(at[0], at[1])
    };
    let mut points: Vec<DVec3> = (0..8).map(|_| middle + size * random.in_cube()).collect();
    points.extend((0..2).map(|_| middle + size * random.power(0.5, 2.0) * random.direction()));
    points.extend((0..4).map(|_| on(random) + size * random.power(-9.0, -2.0) * random.direction()));
    points.extend((0..4).map(|_| 0.5 * (on(random) + on(random))));
    points.extend((0..2).map(|_| on(random)));
    points
}

#[test]
fn exact_distances_agree_with_a_search_of_the_nurbs_form() {
    let mut random = Random::new(40_001);
    for round in 0..40 {
        for exact in shapes(&mut random) {
            let oracle = Oracle::new(Shape::of(&exact.made().0));
            for p in points(&mut random, &oracle.shape) {
                let (exactly, found) = (exact.distance(p), oracle.nearest(p));
                let off = (found.distance - exactly).abs();
                // the form's control points and weights are rounded
                let allowed = 2.0 * TOLERANCE * oracle.size + 16.0 * f64::EPSILON * (exact.reach() + exactly);
                assert!(off <= allowed, "round {round}, {p}: {exactly:e} by {exact:?}, {found:?}, off {off:e}");
            }
        }
    }
}

#[test]
fn no_sample_of_a_shape_is_nearer_than_the_exact_distance() {
    let mut random = Random::new(40_002);
    for _ in 0..10 {
        for exact in shapes(&mut random) {
            let shape = Shape::of(&exact.made().0);
            let count = if shape.curve { 400 } else { 20 };
            let share = |k: usize, along: usize| {
                let [first, last] = shape.domain(along);
                first + (last - first) * k as f64 / count as f64
            };
            let across = if shape.curve { 0 } else { count };
            let samples: Vec<DVec3> = (0..=count)
                .flat_map(|i| (0..=across).map(move |j| (i, j)))
                .map(|(i, j)| shape.point(share(i, 0), share(j, 1)))
                .collect();
            for p in points(&mut random, &shape) {
                let exactly = exact.distance(p);
                let nearest = samples.iter().map(|q| q.distance(p)).fold(f64::INFINITY, f64::min);
                let rounding = 16.0 * f64::EPSILON * (exact.reach() + p.length());
                assert!(nearest >= exactly - rounding, "{p}: {exactly:e} by {exact:?}, a sample at {nearest:e}");
            }
        }
    }
}

#[test]
fn round_ellipses_are_circles_and_evolutes_are_no_obstacle() {
    let frame = Frame::WORLD;
    let mut random = Random::new(40_003);
    for _ in 0..200 {
        let (radius, sweep) = (random.between(0.1, 3.0), sweep(&mut random));
        let p = random.in_cube() * random.pick(&[1e-9, 1.0, 1e3]);
        let circle = Exact::Circle { frame, radius, sweep }.distance(p);
        let ellipse = Exact::Ellipse { frame, radii: (radius, radius), sweep }.distance(p);
        assert!((circle - ellipse).abs() <= 1e-15 * (circle + radius), "{p}: {circle:e} and {ellipse:e}");
    }
    // on the evolute, where two stationary points fall together: the nearest of many samples cannot be bettered
    let (a, b) = (2.0, 0.75);
    let whole = Exact::Ellipse { frame, radii: (a, b), sweep: (0.0, TAU) };
    for k in 0..400 {
        let t = f64::from(k) / 400.0 * TAU;
        let (e, f) = ((a * a - b * b) / a, (b * b - a * a) / b);
        let p = DVec3::new(e * t.cos().powi(3), f * t.sin().powi(3), 0.0);
        let sampled = (0..4000).map(|i| f64::from(i) / 4000.0 * TAU);
        let sampled = sampled.map(|s| p.distance(DVec3::new(a * s.cos(), b * s.sin(), 0.0)));
        let (exactly, nearest) = (whole.distance(p), sampled.fold(f64::INFINITY, f64::min));
        // half a step along the ellipse, which may bend away by its greatest curvature
        let excess = 0.5 * (0.5 * a * TAU / 4000.0).powi(2) * (1.0 / exactly + a / (b * b));
        assert!(exactly <= nearest + 1e-15 && nearest - exactly <= excess, "t = {t}: {exactly:e}, sampled {nearest:e}");
    }
}

#[test]
fn symmetric_points_have_the_distances_of_closed_forms() {
    let frame = Frame::WORLD;
    let half = Exact::Circle { frame, radius: 2.0, sweep: (0.0, PI) };
    // both ends tie opposite the middle
    assert_eq!(half.distance(DVec3::new(0.0, -1.5, 0.0)), 2.5);
    assert_eq!(half.distance(DVec3::new(0.0, 0.0, 1.5)), 2.5);
    let ball = Exact::Sphere { frame, radius: 2.0, latitude: (-FRAC_PI_2, FRAC_PI_2), sweep: (0.0, TAU) };
    assert_eq!(ball.distance(DVec3::ZERO), 2.0);
    assert_eq!(ball.distance(DVec3::new(0.0, 0.0, 2.5)), 0.5);
    let cone = Exact::Cone { frame, radii: (3.0, 0.0), height: (0.0, 4.0), sweep: (0.0, TAU) };
    // behind the apex, and on the axis inside
    assert_eq!(cone.distance(DVec3::new(0.0, 0.0, 5.0)), 1.0);
    assert!((cone.distance(DVec3::new(0.0, 0.0, 1.0)) - 1.8).abs() < 1e-15);
    let torus = Exact::Torus { frame, major: 3.0, minor: 1.0, tube: (0.0, TAU), sweep: (0.0, TAU) };
    assert_eq!(torus.distance(DVec3::new(3.0, 0.0, 0.0)), 1.0);
    assert_eq!(torus.distance(DVec3::ZERO), 2.0);
    let tile = Exact::Parallelogram { corner: DVec3::ZERO, a: DVec3::X, b: DVec3::new(1.0, 1.0, 0.0) };
    assert_eq!(tile.distance(DVec3::new(1.0, 0.5, -2.0)), 2.0);
    assert!((tile.distance(DVec3::new(0.0, 1.0, 0.0)) - 0.5_f64.sqrt()).abs() < 1e-15);
}

#[test]
fn angles_hold_thirty_digits() {
    for k in -40..=40 {
        let [cos, sin] = direction(0.37 * f64::from(k));
        assert!((cos * cos + sin * sin - Dd::ONE).value().abs() < 1e-30);
        assert!((cos.value() - (0.37 * f64::from(k)).cos()).abs() < 2e-16);
        assert!((sin.value() - (0.37 * f64::from(k)).sin()).abs() < 2e-16);
    }
    // the f64 next to π/2 is too small by 6.1e-17
    assert!((direction(FRAC_PI_2)[0].value() - 6.123_233_995_736_766e-17).abs() < 1e-31);
    // of sums
    let ([a, b], [c, d]) = (direction(0.7), direction(0.25));
    let [cos, _] = direction(0.95);
    let apart = a * c - b * d - cos;
    assert!(apart.value().abs() < 2e-16 && apart.value() != 0.0, "0.7 + 0.25 is rounded to 0.95: {apart:?}");
}

#[test]
fn ranges_hold_the_angles_between_their_ends() {
    let mut random = Random::new(40_004);
    for _ in 0..2000 {
        let (low, width) = (random.between(-9.0, 9.0), random.power(-3.0, 0.79));
        let range = Range::new(if random.chance(0.5) { (low, low + width) } else { (low + width, low) });
        let angle = random.between(0.0, TAU);
        let [x, y] = direction(low + angle).map(|x| x * Dd::from(1e3));
        assert_eq!(range.holds(x, y), angle <= width, "{angle} of {width} from {low}");
    }
    let arc = Arc {
        centre: Vector::ZERO,
        x: Vector::from(DVec3::X),
        y: Vector::from(DVec3::Y),
        radii: [Dd::ONE; 2],
        range: Range::new((1.0, 1.0 + TAU)),
    };
    assert!(arc.range.full && arc.distance_of_circle(Vector::from(DVec3::new(0.0, -3.0, 0.0))) == Dd::from(2.0));
}
