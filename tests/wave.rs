//! The wave of Piegl et al. 2008: its decomposition, its cells, its search, and its proposals before and after the proof.

mod common;

use std::sync::Arc;

use common::corpus::{data, entities};
use common::random::Random;
use perpend::projection::Steps;
use perpend::{DVec3, Definition, Direction, Method, Prepared, Query, QueryOptions, Scratch, Wave, WaveSettings};

/// The entities of the sets after the papers' figures, with what the paper recommends.
fn corpora() -> Vec<(String, Arc<Definition>)> {
    let sets = ["seeds-curves.json", "seeds-surfaces.json"];
    let all = sets.iter().flat_map(|set| entities(&data().join(set)));
    all.map(|entry| (entry.name, Arc::new(entry.shape.definition()))).collect()
}

fn named(name: &str) -> Arc<Definition> {
    corpora().into_iter().find(|(of, _)| of == name).expect("a name of the sets").1
}

fn recommended(definition: &Arc<Definition>) -> Wave {
    Wave::new(Arc::clone(definition), WaveSettings::recommended(definition))
}

fn at(definition: &Definition, u: f64, v: f64) -> DVec3 {
    match definition {
        Definition::NurbsCurve(curve) => curve.point(u),
        Definition::NurbsSurface(surface) => surface.point(u, v),
    }
}

/// Points within `times` sizes of the definition's box.
fn points_around(definition: &Definition, times: f64, count: usize, random: &mut Random) -> Vec<DVec3> {
    let bounds = definition.control_box();
    (0..count).map(|_| bounds.centre() + times * definition.size() * random.in_cube()).collect()
}

fn query(p: DVec3) -> Query {
    Query::new(p, QueryOptions::default()).expect("finite")
}

#[test]
fn neighbours_on_a_curve_are_as_far_apart_as_tolerance_and_jitter_ask() {
    for (name, definition) in corpora() {
        let Definition::NurbsCurve(curve) = &*definition else { continue };
        let (first, last) = curve.domain();
        let fine: Vec<DVec3> = (0..=20_000).map(|k| curve.point(first + (last - first) * f64::from(k) / 2e4)).collect();
        let length: f64 = fine.windows(2).map(|p| p[0].distance(p[1])).sum();
        let corners = curve.knots().breaks().filter(|b| b.multiplicity >= curve.degree()).count();
        for (tolerance, jitter) in [(0.1, 0.8), (0.05, 0.8), (0.01, 0.8), (0.05, 0.5), (0.02, 0.95)] {
            let steps = Steps { tolerance, jitter };
            let settings = WaveSettings { decomposition: [steps; 2], sampling: steps };
            let wave = Wave::new(Arc::clone(&definition), settings);
            let u = wave.parameters(Direction::U);
            assert_eq!((u[0], u[u.len() - 1]), (first, last), "{name}");
            assert!(u.windows(2).all(|u| u[0] < u[1]), "{name}");
            let chords: Vec<f64> = wave.points().windows(2).map(|p| p[0].distance(p[1])).collect();
            // the length that the solver takes is that of a polyline: shorter by a share of a percent
            let (least, most) = (0.98 * jitter * tolerance * length, 1.001 * tolerance * length);
            assert!(
                chords.iter().all(|chord| *chord <= most),
                "{name}: {:?} > {most}",
                chords.iter().copied().fold(0.0, f64::max)
            );
            // a step whose chord is short may be one along a coil, whose arc is long
            let arc = |k: usize| {
                let place = |u: f64| ((u - first) / (last - first) * 2e4) as usize;
                fine[place(u[k])..=place(u[k + 1])].windows(2).map(|p| p[0].distance(p[1])).sum::<f64>()
            };
            let short = (0..chords.len()).filter(|k| chords[*k] < least && arc(*k) < 2.0 * least).count();
            // one before the end, one before each corner, and one before each of two cusps
            assert!(short <= 3 + corners, "{name} at {tolerance}, {jitter}: {short} of {} are short", chords.len());
        }
    }
}

#[test]
fn points_cost_little_more_than_one_evaluation_each() {
    let (mut points, mut evaluations) = (0, 0);
    for (name, definition) in corpora() {
        let wave = recommended(&definition);
        let cost = wave.cost();
        let corners = match &*definition {
            Definition::NurbsCurve(curve) => {
                curve.knots().breaks().filter(|b| b.multiplicity >= curve.degree()).count()
            }
            Definition::NurbsSurface(_) => 0,
        };
        assert!(2 * cost.evaluations <= 5 * cost.points, "{name}: {cost:?}");
        if corners == 0 {
            points += cost.points;
            evaluations += cost.evaluations;
        }
    }
    let per_point = evaluations as f64 / points as f64;
    assert!((1.0..1.25).contains(&per_point), "{per_point} evaluations a point");
}

#[test]
fn the_steps_of_an_even_curve_need_no_correction() {
    let knots = vec![0.0, 0.0, 1.0, 1.0];
    let line = perpend::NurbsCurve::new(1, knots, vec![DVec3::ZERO, DVec3::X], None).expect("valid");
    let wave = recommended(&Arc::new(line.into()));
    // steps are sought in the middle of what is allowed: 4.5 % of the length
    assert_eq!((wave.cost().points, wave.cost().evaluations), (24, 24));
}

#[test]
fn every_point_of_an_entity_lies_in_a_cell_with_which_its_segment_is_registered() {
    let mut random = Random::new(71);
    for (name, definition) in corpora() {
        let wave = recommended(&definition);
        let (u, v) = (wave.parameters(Direction::U), wave.parameters(Direction::V));
        let counts = wave.cell_counts();
        let origin = wave.cell_box([0; 3]).min;
        let patches = (v.len() - 1).max(1);
        let span =
            |values: &[f64], x: f64| (values.partition_point(|at| *at <= x).max(1) - 1).min(values.len().max(2) - 2);
        for _ in 0..400 {
            let s = u[0] + (u[u.len() - 1] - u[0]) * random.unit();
            let t = v[0] + (v[v.len() - 1] - v[0]) * random.unit();
            let segment = span(u, s) * patches + span(v, t);
            let place = (at(&definition, s, t) - origin) / wave.cell_side();
            let cell = [0, 1, 2].map(|k| (place[k].floor().max(0.0) as usize).min(counts[k] - 1));
            assert!(wave.cell_box(cell).distance_squared(at(&definition, s, t)).sqrt() <= 1e-9 * definition.size());
            assert!(wave.registered(cell).contains(&(segment as u32)), "{name} at {s}, {t}");
        }
    }
}

#[test]
fn a_segment_is_registered_with_a_cell_once_and_with_those_its_box_meets() {
    for (name, definition) in corpora() {
        let wave = recommended(&definition);
        let [nx, ny, nz] = wave.cell_counts();
        let boxes = wave.segment_boxes();
        for cell in (0..nx * ny * nz).map(|c| [c % nx, c / nx % ny, c / nx / ny]) {
            let registered = wave.registered(cell);
            assert!(registered.windows(2).all(|pair| pair[0] < pair[1]), "{name}: {registered:?}");
            let bounds = wave.cell_box(cell);
            // a box that touches a cell from outside may count or not
            let slack = DVec3::splat(1e-9 * wave.cell_side());
            let meets = |k: usize, slack: DVec3| {
                boxes[k].min.cmple(bounds.max + slack).all() && boxes[k].max.cmpge(bounds.min - slack).all()
            };
            assert!(registered.iter().all(|k| meets(*k as usize, slack)), "{name}");
            let missing = (0..boxes.len()).find(|k| meets(*k, -slack) && !registered.contains(&(*k as u32)));
            assert_eq!(missing, None, "{name}: {cell:?}");
        }
    }
}

#[test]
fn the_wave_finds_the_nearest_of_all_samples_near_and_far() {
    let mut random = Random::new(72);
    for (name, definition) in corpora() {
        let steps = Steps { tolerance: 0.1, jitter: 0.8 };
        let wave = Wave::new(Arc::clone(&definition), WaveSettings { decomposition: [steps; 2], sampling: steps });
        let samples: Vec<Vec<DVec3>> = (0..wave.segment_boxes().len()).map(|k| wave.samples(k).to_vec()).collect();
        for times in [0.2, 1.0, 30.0, 1e6] {
            for p in points_around(&definition, times, 25, &mut random) {
                let trace = wave.trace(&query(p));
                let nearest = samples.iter().flatten().map(|s| s.distance(p)).fold(f64::MAX, f64::min);
                let found = trace.start_point.distance(p);
                assert!(found <= nearest * (1.0 + 1e-14), "{name} at {p}: {found} > {nearest}");
                assert!(trace.distance <= found * (1.0 + 1e-14), "{name} at {p}: Newton's method lost its start");
                assert_eq!(trace.start_point, at(&definition, trace.start.0, trace.start.1));
                let all: std::collections::HashSet<_> = trace.cells.iter().collect();
                assert_eq!(all.len(), trace.cells.len(), "{name} at {p}: a cell was visited twice");
                let all: std::collections::HashSet<_> = trace.segments.iter().collect();
                assert_eq!(all.len(), trace.segments.len(), "{name} at {p}: a segment was looked at twice");
            }
        }
    }
}

#[test]
fn the_same_query_gives_the_same_proposal_whatever_queries_came_before() {
    let mut random = Random::new(73);
    let options = QueryOptions { method: Some(Method::Wave), ..QueryOptions::default() };
    for name in ["near-touch", "loop", "closed-periodic-seam", "pole", "creased", "brush-handle"] {
        let definition = named(name);
        let points = [0.3, 1.0, 50.0].iter().flat_map(|times| points_around(&definition, *times, 20, &mut random));
        let points: Vec<DVec3> = points.collect();
        let bits = |prepared: &Prepared, p: DVec3, scratch: &mut Scratch| {
            let query = Query::new(p, options).expect("finite");
            let foot = prepared.project(&query, scratch).expect("no limit");
            let trace = prepared.wave().trace(&query);
            let numbers = [foot.parameter.u(), foot.parameter.v().unwrap_or(0.0), foot.distance, foot.lower_bound];
            ([trace.foot.0, trace.foot.1, trace.distance].map(f64::to_bits), numbers.map(f64::to_bits), foot.method)
        };
        let (shared, mut scratch) = (Prepared::new(Arc::clone(&definition), None), Scratch::default());
        let forward: Vec<_> = points.iter().map(|p| bits(&shared, *p, &mut scratch)).collect();
        let other = Prepared::new(Arc::clone(&definition), None);
        let mut backward: Vec<_> = points.iter().rev().map(|p| bits(&other, *p, &mut scratch)).collect();
        backward.reverse();
        assert_eq!(forward, backward, "{name}");
        let both = Prepared::new(definition, None);
        let half = points.len() / 2;
        let threads = std::thread::scope(|scope| {
            let ask = |points: &[DVec3]| {
                let mut scratch = Scratch::default();
                points.iter().map(|p| bits(&both, *p, &mut scratch)).collect::<Vec<_>>()
            };
            let (early, late) = points.split_at(half);
            let first = scope.spawn(move || ask(early));
            let second = ask(late);
            [first.join().expect("no panic"), second].concat()
        });
        assert_eq!(forward, threads, "{name}");
    }
}

/// Entities at the limits of what a definition may be: huge, tiny, far from the origin, of the highest degree, of weights that differ by a hundred
/// orders, nearly without extent in one direction, coiled up, with clusters of knots.
fn hostile() -> Vec<(&'static str, Definition)> {
    let spans = |degree: usize, points: usize| -> Vec<f64> {
        (0..points + degree + 1).map(|k| k.clamp(degree, points) as f64).collect()
    };
    let wild = |count: usize, scale: f64, seed: u64| -> Vec<DVec3> {
        let mut random = Random::new(seed);
        (0..count).map(|_| scale * random.in_cube()).collect()
    };
    let curve = |degree: usize, points: Vec<DVec3>, weights: Option<Vec<f64>>| -> Definition {
        perpend::NurbsCurve::new(degree, spans(degree, points.len()), points, weights).expect("valid").into()
    };
    let surface =
        |degree: (usize, usize), rows: usize, points: Vec<DVec3>, weights: Option<Vec<Vec<f64>>>| -> Definition {
            let columns = points.len() / rows;
            let net = points.chunks(columns).map(<[DVec3]>::to_vec).collect();
            let knots = (spans(degree.0, rows), spans(degree.1, columns));
            perpend::NurbsSurface::new(degree, knots, net, weights).expect("valid").into()
        };
    let powers = |count: usize| -> Vec<f64> { (0..count).map(|k| [1e-50, 1.0, 1e50][k % 3]).collect() };
    let coil =
        (0..2000).map(|k| DVec3::new((f64::from(k) * 0.4).cos(), (f64::from(k) * 0.4).sin(), f64::from(k) * 1e-6));
    let clustered = {
        let inner = (0..40).map(|k| 0.5 + f64::from(k) * 1e-15);
        let knots: Vec<f64> = [0.0; 4].into_iter().chain(inner).chain([1.0; 4]).collect();
        perpend::NurbsCurve::new(3, knots, wild(44, 1.0, 5), None).expect("valid").into()
    };
    vec![
        ("huge", curve(3, wild(12, 1e70, 1), None)),
        ("tiny", curve(3, wild(12, 1e-69, 2), None)),
        ("far away", curve(3, wild(12, 1.0, 3).into_iter().map(|p| p + DVec3::splat(1e12)).collect(), None)),
        ("degree 25", curve(25, wild(40, 1.0, 4), None)),
        ("weights", curve(3, wild(12, 1.0, 6), Some(powers(12)))),
        ("zigzag", curve(1, (0..3000).map(|k| DVec3::new(f64::from(k % 2), 1e-4 * f64::from(k), 0.0)).collect(), None)),
        ("coil", curve(3, coil.collect(), None)),
        ("clustered knots", clustered),
        ("huge patch", surface((3, 2), 8, wild(64, 1e70, 7), None)),
        ("tiny patch", surface((3, 2), 8, wild(64, 1e-69, 8), None)),
        ("degree 25 patch", surface((25, 25), 26, wild(26 * 26, 1.0, 9), None)),
        (
            "weighted patch",
            surface((2, 2), 6, wild(36, 1.0, 10), Some(powers(36).chunks(6).map(<[f64]>::to_vec).collect())),
        ),
        ("line as a patch", surface((1, 1), 2, vec![DVec3::ZERO, DVec3::X, DVec3::ZERO, DVec3::X], None)),
        (
            "sliver",
            surface((1, 2), 2, wild(6, 1.0, 11).into_iter().map(|p| p * DVec3::new(1e9, 1.0, 1e-9)).collect(), None),
        ),
    ]
}

#[test]
fn hostile_entities_and_far_queries_are_answered_as_by_the_hierarchy() {
    let mut random = Random::new(74);
    for (name, definition) in hostile() {
        let (size, reach) = (definition.size(), definition.reach());
        let definition = Arc::new(definition);
        let prepared = Prepared::new(Arc::clone(&definition), None);
        let mut scratch = Scratch::default();
        let mut points = Vec::new();
        for times in [0.3, 2.0, 1e3, 1e9] {
            points.extend(points_around(&definition, times, 4, &mut random));
        }
        points.extend([DVec3::splat(1e75), DVec3::new(-1e75, 0.0, 1e3), DVec3::new(0.0, 1e40, -1e40), DVec3::ZERO]);
        points.retain(|p| p.abs().max_element() <= 1e75);
        for p in points {
            let ask = |method: Method, scratch: &mut Scratch| {
                let options = QueryOptions { method: Some(method), ..QueryOptions::default() };
                prepared.project(&Query::new(p, options).expect("finite"), scratch).expect("no limit")
            };
            let (wave, hierarchy) = (ask(Method::Wave, &mut scratch), ask(Method::Hierarchy, &mut scratch));
            let noise = 64.0 * f64::EPSILON * (reach + p.abs().max_element());
            // where the bound of work is met, the gap says so
            let allowed = (1e-9 * size).max(wave.gap()).max(hierarchy.gap()) + noise;
            let apart = (wave.distance - hierarchy.distance).abs();
            assert!(apart <= allowed, "{name} at {p}: {} and {}", wave.distance, hierarchy.distance);
            let trace = prepared.wave().trace(&query(p));
            assert!(trace.distance.is_finite(), "{name} at {p}");
            let domains = [Direction::U, Direction::V].map(|d| prepared.wave().parameters(d).to_vec());
            for (x, domain) in [trace.foot.0, trace.foot.1].iter().zip(&domains) {
                assert!(domain[0] <= *x && *x <= domain[domain.len() - 1], "{name} at {p}");
            }
        }
        assert!(prepared.wave().memory() < 300_000_000, "{name}: {}", prepared.wave().memory());
    }
}

#[test]
fn settings_without_a_meaning_make_no_more_points_than_there_is_room_for() {
    for name in ["selimovic-2-wave", "dust-pan"] {
        let definition = named(name);
        for wrong in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-300] {
            let steps = Steps { tolerance: wrong, jitter: wrong };
            let settings = WaveSettings { decomposition: [steps; 2], sampling: steps };
            let wave = Wave::new(Arc::clone(&definition), settings);
            assert!(wave.segment_boxes().len() <= 70_000, "{name} at {wrong}: {}", wave.segment_boxes().len());
            let trace = wave.trace(&query(DVec3::splat(3.0)));
            assert!(trace.distance.is_finite() && wave.memory() < 300_000_000, "{name} at {wrong}: {}", wave.memory());
        }
    }
}

/// The start is the nearest of all samples, and may lie on the wrong one of two branches that are as near as samples tell.
#[test]
fn a_proposal_on_the_wrong_branch_is_corrected_by_the_proof() {
    let rails = vec![(0.0, 0.0), (4.0, 0.0), (6.0, 1.0), (4.0, 2.0), (0.0, 2.0)];
    let points: Vec<DVec3> = rails.into_iter().map(|(x, y)| DVec3::new(x, y, 0.0)).collect();
    let knots = vec![0.0, 0.0, 1.0, 2.0, 3.0, 4.0, 4.0];
    let curve = perpend::NurbsCurve::new(1, knots, points, None).expect("valid");
    let coarse = Steps { tolerance: 0.3, jitter: 0.5 };
    let settings = WaveSettings { decomposition: [coarse; 2], sampling: coarse };
    let prepared = Prepared::new(Arc::new(curve.into()), None).with_wave(settings);
    let mut scratch = Scratch::default();
    let mut wrong = 0;
    for k in 0..400 {
        // a little nearer to one rail than to the other
        let (side, x) = (if k % 2 == 0 { 1e-3 } else { -1e-3 }, 3.0 * (f64::from(k) + 0.5) / 400.0);
        let p = DVec3::new(x, 1.0 + side, 0.0);
        let options = QueryOptions { method: Some(Method::Wave), ..QueryOptions::default() };
        let foot = prepared.project(&Query::new(p, options).expect("finite"), &mut scratch).expect("no limit");
        assert!((foot.distance - (1.0 - 1e-3)).abs() < 1e-12, "{p}: {foot:?}");
        let is_corrected = foot.method == Method::Hierarchy;
        assert_eq!(is_corrected, prepared.wave().trace(&query(p)).distance > 1.0, "{p}");
        wrong += u64::from(is_corrected);
    }
    assert!(wrong > 0, "no proposal was wrong");
    assert_eq!(scratch.statistics.corrected, wrong);
}
