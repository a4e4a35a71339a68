//! Counts: random curves against a dense sampling, random surfaces and shapes against Euler's characteristic.

use std::f64::consts::{FRAC_PI_2, TAU};

use perpend::{
    Cylinder, DVec3, Definition, Extremum, Frame, NurbsCurve, NurbsSurface, Sphere, StationaryPoint, StationaryPoints,
    Torus,
};

use crate::common::random::Random;
use crate::{One, census, characteristic, is_decided};

/// Knots on `[0, 1]`; inner ones come as often as up to the degree where `multiple`.
fn knots(degree: usize, points: usize, multiple: bool, random: &mut Random) -> Vec<f64> {
    let mut inner = Vec::new();
    while inner.len() < points - degree - 1 {
        let at = random.between(0.05, 0.95);
        let times = if multiple { random.count(1, degree) } else { 1 };
        inner.extend(std::iter::repeat_n(at, times.min(points - degree - 1 - inner.len())));
    }
    inner.sort_by(f64::total_cmp);
    [vec![0.0; degree + 1], inner, vec![1.0; degree + 1]].concat()
}

/// A point in, beside or far from the cube of the control points.
fn query(random: &mut Random) -> DVec3 {
    random.in_cube() * random.pick(&[0.5, 2.0, 20.0])
}

#[test]
fn curves_have_as_many_minima_and_maxima_as_a_dense_sampling_and_they_alternate() {
    const SAMPLES: usize = 20_000;
    let mut random = Random::new(1);
    for round in 0..240 {
        let degree = [1, 2, 3, 4, 5, 7, 9, 12][round % 8];
        let n = degree + random.count(1, 8);
        let points = (0..n).map(|_| random.in_cube()).collect();
        let weights = (round % 3 == 0).then(|| (0..n).map(|_| random.power(-1.0, 1.0)).collect());
        let knots = knots(degree, n, round % 2 == 0, &mut random);
        let curve = NurbsCurve::new(degree, knots, points, weights).expect("valid");
        let one = One::new(curve.clone());
        for _ in 0..3 {
            let p = query(&mut random);
            let distances: Vec<f64> =
                (0..=SAMPLES).map(|k| curve.point(k as f64 / SAMPLES as f64).distance(p)).collect();
            let turns = distances.windows(3).filter(|d| (d[1] < d[0]) == (d[1] <= d[2])).count();
            let found = one.stationary(p);
            assert!(is_decided(&found), "degree {degree}, round {round}, {p}: {found:?}");
            // a pair closer than two samples may be none for them; that it is one, the distances tell
            let gap = |pair: &[StationaryPoint]| pair[1].parameter.u() - pair[0].parameter.u();
            let close = found.points.windows(2).filter(|pair| gap(pair) < 2.0 / SAMPLES as f64).count();
            let seen = turns + 2..=turns + 2 + 2 * close;
            assert!(seen.contains(&found.points.len()), "degree {degree}, round {round}, {p}: {seen:?}, {found:?}");
            let rises = |pair: &[StationaryPoint]| pair[0].kind == Some(Extremum::Minimum);
            assert!(found.points.windows(2).all(|pair| rises(pair) == (pair[0].distance < pair[1].distance)));
            assert!(found.points.windows(2).all(|pair| pair[0].kind != pair[1].kind), "{found:?}");
            assert!(found.points.iter().all(|point| point.kind.is_some_and(|kind| kind != Extremum::Saddle)));
        }
    }
}

#[test]
fn surfaces_have_the_characteristic_of_a_disk_and_every_way_down_ends_at_a_minimum() {
    let mut random = Random::new(2);
    for round in 0..96 {
        let (p, q) = [(1, 1), (2, 2), (3, 3), (1, 3), (4, 2), (5, 5), (3, 2), (9, 9)][round % 8];
        let (n, m) = (p + random.count(1, 4), q + random.count(1, 4));
        let place = |i: usize, n: usize| i as f64 / (n - 1) as f64 - 0.5;
        let points = (0..n)
            .map(|i| {
                let row = (0..m).map(|j| DVec3::new(place(i, n), place(j, m), 0.0) + 0.3 * random.in_cube());
                row.collect()
            })
            .collect();
        let weights =
            (round % 3 == 0).then(|| (0..n).map(|_| (0..m).map(|_| random.power(-0.5, 0.5)).collect()).collect());
        let knots = (knots(p, n, round % 2 == 0, &mut random), knots(q, m, round % 2 == 0, &mut random));
        let surface = NurbsSurface::new((p, q), knots, points, weights).expect("valid");
        let one = One::new(surface.clone());
        for _ in 0..2 {
            let at = query(&mut random);
            let found = one.stationary(at);
            assert!(is_decided(&found), "degrees {p}, {q}, round {round}, {at}: {found:?}");
            assert_eq!(characteristic(&found), 1, "degrees {p}, {q}, round {round}, {at}: {found:?}");
            // a crease stops steps in random directions
            if round % 2 == 1 && p.min(q) > 1 {
                assert_minima_of_a_grid_are_found(&surface, at, &found);
            }
        }
    }
}

/// Every sample that no neighbour undercuts leads down to a minimum that was found, by steps in random directions.
fn assert_minima_of_a_grid_are_found(surface: &NurbsSurface, p: DVec3, found: &StationaryPoints) {
    const SIDE: i32 = 40;
    let mut random = Random::new(5);
    let at = |i: i32| f64::from(i) / f64::from(SIDE);
    let distance = |u: f64, v: f64| surface.point(u, v).distance(p);
    let grid: Vec<Vec<f64>> = (0..=SIDE).map(|i| (0..=SIDE).map(|j| distance(at(i), at(j))).collect()).collect();
    let value = |i: i32, j: i32| {
        let inside = (0..=SIDE).contains(&i) && (0..=SIDE).contains(&j);
        if inside { grid[i as usize][j as usize] } else { f64::INFINITY }
    };
    for (i, j) in (0..=SIDE).flat_map(|i| (0..=SIDE).map(move |j| (i, j))) {
        let neighbours = (-1..=1).flat_map(|a| (-1..=1).map(move |b| (a, b))).filter(|step| *step != (0, 0));
        if neighbours.map(|(a, b)| value(i + a, j + b)).any(|other| other < value(i, j)) {
            continue;
        }
        let (mut u, mut v, mut here, mut step) = (at(i), at(j), value(i, j), 1.0 / f64::from(SIDE));
        while step > 1e-7 {
            let tried = (0..100).find_map(|_| {
                let (a, b) = (random.between(-1.0, 1.0), random.between(-1.0, 1.0));
                let (a, b) = ((u + a * step).clamp(0.0, 1.0), (v + b * step).clamp(0.0, 1.0));
                let there = distance(a, b);
                (there < here).then_some((a, b, there))
            });
            match tried {
                Some(better) => (u, v, here) = better,
                None => step *= 0.5,
            }
        }
        let is_found = found.points.iter().filter(|point| point.kind == Some(Extremum::Minimum)).any(|point| {
            let (a, b) = (point.parameter.u(), point.parameter.v().expect("a surface"));
            (a - u).abs().max((b - v).abs()) < 1e-3 && point.distance <= here * (1.0 + 1e-14)
        });
        assert!(is_found, "{p}: the way down from {}, {} ends at {u}, {v}: {found:?}", at(i), at(j));
    }
}

#[test]
fn spheres_tori_and_tubes_have_the_census_of_morse_theory() {
    let turn = (0.0, TAU);
    let sphere = Sphere::new(Frame::WORLD, 2.0, (-FRAC_PI_2, FRAC_PI_2), turn).expect("valid");
    let torus = Torus::new(Frame::WORLD, 3.0, 1.0, turn, turn).expect("valid");
    let tube = Cylinder::new(Frame::WORLD, 2.0, (0.0, 3.0), turn).expect("valid");
    let definitions: [(Definition, i32); 3] = [
        (sphere.to_nurbs().expect("valid").into(), 2),
        (torus.to_nurbs().expect("valid").into(), 0),
        (tube.to_nurbs().expect("valid").into(), 0),
    ];
    let mut random = Random::new(3);
    for (definition, expected) in definitions {
        let one = One::new(definition);
        for _ in 0..60 {
            let p = random.in_cube() * 5.0;
            let found = one.stationary(p);
            assert!(is_decided(&found), "{p}: {found:?}");
            assert_eq!(characteristic(&found), expected, "{p}: {found:?}");
            match expected {
                2 => assert_eq!(census(&found), [1, 0, 1]),
                _ if found.points.len() == 4 => assert_eq!(census(&found), [1, 2, 1]),
                // a tube has its ends besides, and where it does not see the point, only these
                _ => assert!(found.points.iter().any(|point| point.parameter.u() == 0.0), "{found:?}"),
            }
        }
    }
}

/// Shapes with bumps, closed in one or both directions: the control net of a torus, and of a tube, shaken.
#[test]
fn closed_free_forms_have_the_characteristic_of_their_topology() {
    let mut random = Random::new(4);
    for round in 0..24 {
        let closed_v = round % 2 == 0;
        let (n, m) = (8, 7);
        let net: Vec<Vec<DVec3>> = (0..n)
            .map(|i| {
                let around = TAU * f64::from(i) / f64::from(n);
                (0..m)
                    .map(|j| {
                        let across = TAU * f64::from(j) / f64::from(m);
                        let radius = 3.0 + if closed_v { across.cos() } else { 0.0 };
                        let height = if closed_v { across.sin() } else { f64::from(j) };
                        DVec3::new(radius * around.cos(), radius * around.sin(), height) + 0.3 * random.in_cube()
                    })
                    .collect()
            })
            .collect();
        // periodic cubics: unclamped knots, the first three rows again at the end
        let wrapped = |k: usize, count: usize| k % count;
        let columns = if closed_v { m as usize + 3 } else { m as usize };
        let points: Vec<Vec<DVec3>> = (0..n as usize + 3)
            .map(|i| (0..columns).map(|j| net[wrapped(i, n as usize)][wrapped(j, m as usize)]).collect())
            .collect();
        let uniform = |points: usize| (0..points + 4).map(|k| k as f64).collect::<Vec<f64>>();
        let clamped = |points: usize| {
            let spans = points - 3;
            (0..points + 4).map(|k| k.clamp(3, spans + 3) as f64 - 3.0).collect::<Vec<f64>>()
        };
        let v = if closed_v { uniform(columns) } else { clamped(columns) };
        let surface = NurbsSurface::new((3, 3), (uniform(points.len()), v), points, None).expect("valid");
        let one = One::new(surface);
        for _ in 0..4 {
            let p = random.in_cube() * 4.0;
            let found = one.stationary(p);
            assert!(is_decided(&found), "round {round}, {p}: {found:?}");
            assert_eq!(characteristic(&found), 0, "round {round}, {p}: {found:?}");
        }
    }
}
