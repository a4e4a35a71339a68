//! What is acquired from definitions: Piegl's table, the corpora, and what holds for every entity.

mod common;

use perpend::knowledge::{AcquireOptions, Irregularity, ParameterPoint, Speed, acquire, two_level_estimate};
use perpend::{Basis, CurveData, DVec3, Definition, Direction, Item, NurbsCurve, Representation, SurfaceData};

use common::corpus::{self, data};

fn entities(set: &str) -> Vec<(String, Definition)> {
    let entry = |entry: corpus::Entry| (entry.name, entry.shape.definition());
    corpus::entities(&data().join(set)).into_iter().map(entry).collect()
}

fn named(set: &str, name: &str) -> Definition {
    entities(set).into_iter().find(|(of, _)| of == name).unwrap_or_else(|| panic!("{name} in {set}")).1
}

fn acquired(definition: &Definition) -> Representation {
    acquire(definition, &AcquireOptions::default())
}

fn speeds(part: &Representation) -> &[Item<Speed>] {
    part.speed.as_deref().expect("acquired")
}

fn irregularities(part: &Representation) -> Vec<Irregularity> {
    part.irregularities.iter().flatten().map(|item| item.value).collect()
}

fn gap<T>(item: &Item<T>) -> f64 {
    match item.basis {
        Basis::Proved { gap } => gap,
        other => panic!("{other:?} is no proof"),
    }
}

#[test]
fn the_circles_of_the_paper_have_their_parametrisation_factors() {
    // exact values in closed form: (1 - w) / 2 for quadratic arcs in standard form; the rest by dense evaluation elsewhere
    let exact = [
        ("degree2-90", 0.146_447),
        ("degree2-120", 0.066_987),
        ("degree2-360", 0.146_447),
        ("degree4-90", 0.005),
        ("degree4-120", 0.007),
        ("degree4-360", 0.007),
        ("degree5-90", 0.038_060),
        ("degree5-120", 0.066_987),
        ("degree5-360", 0.5),
    ];
    for (name, factor) in exact {
        let part = acquired(&named("circles-table1.json", name));
        let found = speeds(&part)[0].value.factor;
        assert!((found - factor).abs() < 6e-7, "{name}: {found}, not {factor}");
    }
    let w = 0.5_f64.sqrt();
    let quarter = acquired(&named("circles-table1.json", "degree2-90"));
    assert!((speeds(&quarter)[0].value.factor - 0.5 * (1.0 - w)).abs() < 2e-9);
}

#[test]
fn the_circles_of_the_paper_have_the_estimates_of_two_levels() {
    let estimates = [
        ("degree2-90", 0.1510),
        ("degree2-120", 0.0691),
        ("degree2-360", 0.1510),
        ("degree4-90", 0.0076),
        ("degree4-120", 0.0119),
        ("degree4-360", 0.0119),
        ("degree5-90", 0.0392),
        ("degree5-120", 0.0690),
        ("degree5-360", 0.5138),
    ];
    for (name, factor) in estimates {
        let circle = named("circles-table1.json", name);
        let estimate = two_level_estimate(&circle, Direction::U);
        assert!((estimate - factor).abs() <= 5.1e-5, "{name}: {estimate}, not {factor}");
        assert!(
            estimate >= speeds(&acquired(&circle))[0].value.factor,
            "{name}: an estimate reaches too far, not too short"
        );
    }
}

/// The speeds of a definition at samples of its spans, ends included.
fn samples(definition: &Definition, direction: Direction) -> Vec<f64> {
    match definition {
        Definition::NurbsCurve(curve) => curve
            .knots()
            .spans()
            .flat_map(|s| (0..=40).map(move |k| s.start + (s.end - s.start) * f64::from(k) / 40.0))
            .map(|u| {
                let mut d = [DVec3::ZERO; 2];
                curve.derivatives(u, &mut d);
                d[1].length()
            })
            .collect(),
        Definition::NurbsSurface(surface) => {
            let ((a, b), (c, d)) = (surface.domain(Direction::U), surface.domain(Direction::V));
            let at = |k: i32| (f64::from(k % 37) / 36.0, f64::from(k / 37) / 36.0);
            (0..37 * 37)
                .map(|k| {
                    let (s, t) = at(k);
                    let mut jet = [DVec3::ZERO; 4];
                    surface.derivatives(a + (b - a) * s, c + (d - c) * t, 1, &mut jet);
                    jet[if direction == Direction::U { 2 } else { 1 }].length()
                })
                .collect()
        }
    }
}

fn speed_at(definition: &Definition, direction: Direction, at: ParameterPoint) -> f64 {
    match (definition, at) {
        (Definition::NurbsCurve(curve), ParameterPoint::Curve(u)) => {
            let (mut d, mut e) = ([DVec3::ZERO; 2], [DVec3::ZERO; 2]);
            curve.derivatives(u, &mut d);
            curve.derivatives_from_left(u, &mut e);
            // at a knot either side may be meant
            if direction == Direction::U { d[1].length() } else { e[1].length() }
        }
        (Definition::NurbsSurface(surface), ParameterPoint::Surface(u, v)) => {
            let mut jet = [DVec3::ZERO; 4];
            surface.derivatives(u, v, 1, &mut jet);
            jet[if direction == Direction::U { 2 } else { 1 }].length()
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn no_sampled_speed_is_beyond_the_bounds_and_the_bounds_are_tight() {
    for set in ["circles-table1.json", "seeds-curves.json", "seeds-surfaces.json", "quadrics.json"] {
        for (name, definition) in entities(set) {
            let part = acquired(&definition);
            for item in speeds(&part) {
                let speed = &item.value;
                // what the evaluation of a sample may lose
                let rounding = 1e-11 * speed.max;
                for sample in samples(&definition, speed.direction) {
                    assert!(sample >= speed.min - rounding, "{set} {name}: {sample} below {}", speed.min);
                    assert!(sample <= speed.max + rounding, "{set} {name}: {sample} above {}", speed.max);
                }
                assert!(gap(item) <= 2e-9 * speed.max, "{set} {name}: {} of {}", gap(item), speed.max);
                if let Definition::NurbsSurface(_) = definition {
                    continue; // at a crease the attained value may belong to the other side
                }
                let (least, greatest) = (speed.min_at.expect("known"), speed.max_at.expect("known"));
                let near = |at, speed: f64| {
                    let sides = [Direction::U, Direction::V].map(|side| speed_at(&definition, side, at));
                    sides.iter().any(|side| (side - speed).abs() <= gap(item) + rounding)
                };
                assert!(near(least, speed.min) && near(greatest, speed.max), "{set} {name}: {speed:?}");
            }
        }
    }
}

#[test]
fn reversal_and_knot_insertion_keep_the_speeds() {
    for (name, definition) in entities("seeds-curves.json") {
        let Definition::NurbsCurve(curve) = &definition else { panic!("{name} is a curve") };
        let (first, last) = curve.domain();
        let whole = acquired(&definition);
        let finer = curve.insert_knot(first + 0.37 * (last - first), 1).expect("an interior knot");
        for other in [curve.reversed(), finer] {
            let other = acquired(&other.into());
            let (a, b) = (&speeds(&whole)[0], &speeds(&other)[0]);
            let allowed = gap(a) + gap(b) + 1e-12 * a.value.max;
            assert!((a.value.min - b.value.min).abs() <= allowed, "{name}: {} {}", a.value.min, b.value.min);
            assert!((a.value.max - b.value.max).abs() <= allowed, "{name}: {} {}", a.value.max, b.value.max);
            let (a, b) = (whole.length.as_ref().expect("known"), other.length.as_ref().expect("known"));
            assert!((a.value - b.value).abs() <= gap(a) + gap(b), "{name}");
        }
    }
}

#[test]
fn the_cusps_of_the_seeds_are_found() {
    let cusps = |name: &str| {
        let part = acquired(&named("seeds-curves.json", name));
        irregularities(&part)
            .into_iter()
            .filter_map(|found| match found {
                Irregularity::Cusp { at: ParameterPoint::Curve(u), angle } => Some((u, angle)),
                _ => None,
            })
            .collect::<Vec<_>>()
    };
    let found = cusps("cusp-bezier");
    assert_eq!(found.len(), 1, "{found:?}");
    assert!((found[0].0 - 0.5).abs() < 1e-9 && (found[0].1 - std::f64::consts::PI).abs() < 1e-3, "{found:?}");
    assert_eq!(cusps("selimovic-3-arch"), []);
}

#[test]
fn the_loop_of_the_seeds_is_found_and_no_other() {
    let loops = |name: &str| {
        let definition = named("seeds-curves.json", name);
        let found = irregularities(&acquired(&definition));
        let loops = found.into_iter().filter_map(|found| match found {
            Irregularity::Loop { from, to, .. } => Some((from, to)),
            _ => None,
        });
        (loops.collect::<Vec<_>>(), definition)
    };
    let (found, definition) = loops("loop");
    assert_eq!(found.len(), 1, "{found:?}");
    let Definition::NurbsCurve(curve) = definition else { panic!("a curve") };
    let (from, to) = found[0];
    assert!(to - from > 0.1 && curve.point(from).distance(curve.point(to)) < 1e-8);
    for name in ["selimovic-1-s", "selimovic-3-arch", "closed-periodic-seam", "near-touch", "polyline", "cusp-bezier"] {
        assert_eq!(loops(name).0, [], "{name}");
    }
}

#[test]
fn seams_poles_and_creases_of_the_seeds_are_found() {
    let closed = acquired(&named("seeds-curves.json", "closed-periodic-seam"));
    assert_eq!(closed.closed.as_ref().map(|item| item.value), Some((true, false)));
    assert!(irregularities(&closed).iter().any(|i| matches!(i, Irregularity::Seam { direction: Direction::U, .. })));

    let kink = acquired(&named("seeds-curves.json", "kink"));
    let breaks: Vec<_> = kink.breaks.iter().flatten().map(|item| (item.value.at, item.value.c, item.value.g)).collect();
    assert_eq!(breaks, [(0.5, 0, 0)]);
    assert!(
        irregularities(&kink).iter().any(|i| matches!(i, Irregularity::Crease { at: 0.5, angle, .. } if *angle > 0.1))
    );

    let creased = acquired(&named("seeds-surfaces.json", "creased"));
    let crease = |i: &Irregularity| matches!(i, Irregularity::Crease { direction: Direction::U, at: 0.5, .. });
    assert!(irregularities(&creased).iter().any(crease));

    let pole = acquired(&named("seeds-surfaces.json", "pole"));
    let found = irregularities(&pole);
    assert!(found.iter().any(|i| matches!(i, Irregularity::Pole { .. })), "{found:?}");
    assert!(found.iter().any(|i| matches!(i, Irregularity::VanishingDerivative { at: ParameterPoint::Iso(..), .. })));

    let vase = acquired(&named("seeds-surfaces.json", "revolution-vase"));
    assert_eq!(vase.closed.as_ref().map(|item| item.value), Some((false, true)));
    assert!(irregularities(&vase).iter().any(|i| matches!(i, Irregularity::Seam { direction: Direction::V, .. })));
}

#[test]
fn a_full_circle_is_smoother_than_its_knots() {
    // double knots of degree 2 promise no tangent; the circle has speed and curvature throughout
    let circle = acquired(&named("circles-table1.json", "degree2-360"));
    for item in circle.breaks.iter().flatten() {
        assert_eq!((item.value.c, item.value.g), (1, 2), "at {}", item.value.at);
    }
    assert_eq!(circle.breaks.map(|breaks| breaks.len()), Some(3));
}

#[test]
fn an_s_has_its_inflection_and_a_line_no_curvature() {
    let bezier = |points: &[[f64; 3]]| {
        let (p, points) = (points.len() - 1, points.iter().map(|p| DVec3::from_array(*p)).collect());
        let knots = [vec![0.0; p + 1], vec![1.0; p + 1]].concat();
        let curve: Definition = NurbsCurve::new(p, knots, points, None).expect("valid").into();
        irregularities(&acquired(&curve))
    };
    let s = bezier(&[[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [2.0, -1.0, 0.0], [3.0, 0.0, 0.0]]);
    assert!(
        matches!(s.as_slice(), [Irregularity::Inflection { at: ParameterPoint::Curve(u), .. }] if (u - 0.5).abs() < 1e-9),
        "{s:?}"
    );
    let line = bezier(&[[0.0, 0.0, 0.0], [1.0, 1.0, 1.0], [3.0, 3.0, 3.0]]);
    assert!(line.iter().any(|i| matches!(i, Irregularity::ZeroCurvature { from: 0.0, to: 1.0, .. })), "{line:?}");
    let bow = bezier(&[[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [2.0, 0.0, 0.0]]);
    assert_eq!(bow, []);
}

#[test]
fn near_knots_and_tiny_spans_are_found() {
    let points: Vec<DVec3> = (0..6).map(|i| DVec3::new(f64::from(i), f64::from(i % 2), 0.0)).collect();
    let knots = vec![0.0, 0.0, 0.0, 0.0, 0.5, 0.5 + 1e-9, 1.0, 1.0, 1.0, 1.0];
    let curve: Definition = NurbsCurve::new(3, knots, points, None).expect("valid").into();
    let found = irregularities(&acquired(&curve));
    assert!(found.iter().any(|i| matches!(i, Irregularity::NearKnots { at: 0.5, .. })), "{found:?}");
    assert!(
        found.iter().any(|i| matches!(i, Irregularity::TinySpan { at: 0.5, extent, .. } if *extent < 1e-7)),
        "{found:?}"
    );
}

#[test]
fn work_is_bounded_whatever_the_definition() {
    let wild = |k: usize, salt: usize| ((k * 7919 + salt * 104_729) % 1009) as f64 / 1009.0;
    let (degree, spans) = (25, 10_000);
    let count = degree + spans;
    let mut knots = vec![0.0; degree + 1];
    knots.extend((1..spans).map(|k| k as f64));
    knots.extend(vec![spans as f64; degree + 1]);
    let points = (0..count).map(|k| DVec3::new(wild(k, 1), wild(k, 2), wild(k, 3))).collect();
    let weights = Some((0..count).map(|k| 0.1 + wild(k, 4)).collect());
    let curve = CurveData { degree, knots, control_points: points, weights };
    let net = |n: usize| {
        (0..n).map(|i| (0..n).map(|j| DVec3::new(wild(i, j), wild(j, i), wild(i + j, 5))).collect()).collect()
    };
    let knots: Vec<f64> = [vec![0.0; 26], (1..15).map(f64::from).collect(), vec![15.0; 26]].concat();
    let weights = Some((0..40).map(|i| (0..40).map(|j| 10.0_f64.powf(90.0 * (wild(i, j) - 0.5))).collect()).collect());
    let surface = SurfaceData { degree: (25, 25), knots: (knots.clone(), knots), control_points: net(40), weights };
    let start = std::time::Instant::now();
    for data in [perpend::DefinitionData::NurbsCurve(curve), perpend::DefinitionData::NurbsSurface(surface)] {
        let (definition, _) = data.enter().expect("valid");
        let part = acquired(&definition);
        let record = perpend::Record { representation: Some(part), ..perpend::Record::default() };
        assert_eq!(record.validate(), Ok(()));
    }
    // seconds on an idle core; without bounds on the work it would be hours
    assert!(start.elapsed().as_secs() < 120);
}
