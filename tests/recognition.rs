//! What shapes are is recognised from their control points alone, with the parameters that they were made of, however they are
//! placed, cut and parametrised; what is only near to a shape is accepted with an honest gap, or not at all.

mod common;

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use common::corpus;
use common::disguise::{disguised, moved};
use common::kinds::{at, distance, gap, name, turn};
use common::random::Random;
use glam::{DAffine3, DVec3};
use perpend::kernel::{extrusion, revolution, ruled};
use perpend::knowledge::{default_tolerance, prove, recognise};
use perpend::{
    Circle, Cone, Cylinder, Definition, Direction, Ellipse, Frame, IntoDefinition, Item, Kind, Line, Model, NurbsCurve,
    Plane, Sphere, Torus,
};
use serde_json::Value;

const EPSILON: f64 = f64::EPSILON;

fn recognised(definition: &Definition) -> Item<Kind> {
    recognise(definition, default_tolerance(definition))
}

fn vector(json: &Value) -> DVec3 {
    let at = |k: usize| json[k].as_f64().expect("a number");
    DVec3::new(at(0), at(1), at(2))
}

fn truths(file: &str) -> Value {
    let path = corpus::data().join(file);
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    serde_json::from_str(&text).expect("JSON")
}

#[test]
fn the_arcs_of_the_papers_table_are_recognised_to_the_last_digits() {
    let truths = truths("circles-table1.analytic.json");
    for entry in corpus::entities(&corpus::data().join("circles-table1.json")) {
        let (definition, truth) = (entry.shape.definition(), &truths[entry.id.to_string()]);
        let item = recognised(&definition);
        let Kind::Circle { centre, axis, xdir, radius, sweep } = item.value else {
            panic!("{}: {:?}", entry.name, item.value);
        };
        let allowed = 1e-12 * definition.size();
        let number = |key: &str| truth[key].as_f64().expect("a number");
        let off = [
            centre.distance(vector(&truth["centre"])),
            axis.distance(vector(&truth["axis"])),
            xdir.distance(vector(&truth["xdir"])),
            (radius - number("radius")).abs(),
            (turn(sweep) - number("sweep")).abs(),
        ];
        assert!(off.iter().all(|off| *off <= allowed), "{}: {off:?} of {allowed:e}", entry.name);
        assert!(gap(&item) < 1e-12, "{}: gap {:e}", entry.name, gap(&item));
    }
}

#[test]
fn the_quadrics_are_recognised_to_the_last_digits() {
    let truths = truths("quadrics.analytic.json");
    for entry in corpus::entities(&corpus::data().join("quadrics.json")) {
        let (definition, truth) = (entry.shape.definition(), &truths[entry.id.to_string()]);
        let item = recognised(&definition);
        let allowed = 1e-12 * definition.size();
        let number = |json: &Value, key: &str| json[key].as_f64().unwrap_or_else(|| panic!("{key} in {json}"));
        let (origin, axis, profile) = (vector(&truth["origin"]), vector(&truth["axis"]), &truth["profile"]);
        let beside = |p: DVec3| (p - origin).cross(axis).length();
        let along = |p: DVec3| (p - origin).dot(axis);
        let rise = |key: &str| profile[key][1].as_f64().expect("a number");
        let sweep_off = |sweep: (f64, f64)| (turn(sweep) - number(truth, "sweep")).abs();
        assert_eq!(name(&item.value).to_lowercase(), truth["type"].as_str().expect("a type"), "{}", entry.name);
        let off = match item.value {
            Kind::Plane { origin: corner, normal, sides } => {
                let (a, b) = sides.expect("a rectangle");
                let (width, height) = (number(truth, "width"), number(truth, "height"));
                let sides = (a.length() - width).abs().max((b.length() - height).abs());
                vec![along(corner).abs(), normal.cross(axis).length(), sides]
            }
            Kind::Cylinder { centre, axis: n, radius, height, sweep, .. } => {
                let heights = [along(centre + height.0 * n) - rise("from"), along(centre + height.1 * n) - rise("to")];
                let heights = heights[0].abs().max(heights[1].abs());
                let radius = (radius - number(truth, "radius")).abs();
                vec![beside(centre), n.cross(axis).length(), radius, sweep_off(sweep), heights]
            }
            Kind::Cone { apex, axis: n, half_angle, height, sweep, .. } => {
                let heights = [along(apex + height.0 * n) - rise("from"), along(apex + height.1 * n) - rise("to")];
                let heights = heights[0].abs().max(heights[1].abs());
                let apex_off = (along(apex) - number(truth, "apex_z")).abs();
                let angle = (half_angle - number(truth, "half_angle")).abs();
                vec![beside(apex), apex_off, n.cross(axis).length(), angle, sweep_off(sweep), heights]
            }
            Kind::Sphere { centre, axis: n, radius, sweep, latitude, .. } => {
                let radius = (radius - number(truth, "radius")).abs();
                let up = n.dot(axis).signum();
                let start = (up * latitude.0 - number(profile, "start")).abs();
                let turned = (turn(latitude) - number(profile, "sweep")).abs();
                vec![centre.distance(origin), n.cross(axis).length(), radius, sweep_off(sweep), start, turned]
            }
            Kind::Torus { centre, axis: n, major_radius, minor_radius, sweep, section, .. } => {
                let radii = [major_radius - number(truth, "major"), minor_radius - number(truth, "minor")];
                let radii = radii[0].abs().max(radii[1].abs());
                let up = n.dot(axis).signum();
                let start = (up * section.0 - number(profile, "start")).abs();
                let turned = (turn(section) - number(profile, "sweep")).abs();
                vec![centre.distance(origin), n.cross(axis).length(), radii, sweep_off(sweep), start, turned]
            }
            kind => panic!("{}: {kind:?}", entry.name),
        };
        assert!(off.iter().all(|off| *off <= allowed), "{}: {off:?} of {allowed:e}", entry.name);
        assert!(gap(&item) < 1e-11, "{}: gap {:e}", entry.name, gap(&item));
    }
}

/// A random frame, `offset` from the origin.
fn frame(random: &mut Random, offset: f64) -> Frame {
    let [x, _, z] = random.frame();
    Frame::new(offset * random.direction(), z, x).expect("a frame")
}

/// A range of angles of 0.5 to 360 degrees.
fn sweep(random: &mut Random) -> (f64, f64) {
    let start = random.between(-PI, PI);
    let turn = if random.chance(0.2) { TAU } else { random.power(0.5_f64.log10(), 360.0_f64.log10()).to_radians() };
    (start, start + turn)
}

/// A shape of a class with its definition; `scale` is about its size but for short arcs.
fn shape(random: &mut Random, class: &str, scale: f64, offset: f64) -> (Definition, Kind) {
    let sweep = sweep(random);
    // farther away than this the coordinates hold too few digits of the arc
    let farthest = if turn(sweep) < 5.0_f64.to_radians() { 1e3 } else { 1e5 };
    let frame = frame(random, offset.min(farthest * scale));
    let radius = scale * random.between(0.3, 2.0);
    let height = (scale * random.between(-1.0, 0.0), scale * random.between(0.1, 2.0));
    let entered = match class {
        "Line" => Line::new(frame.centre, frame.centre + radius * random.direction()).expect("valid").enter(),
        "Circle" => Circle::new(frame, radius, sweep).expect("valid").enter(),
        "Ellipse" => {
            let start = sweep.0;
            let turn = turn(sweep).max(10.0_f64.to_radians());
            let second = radius * random.between(0.3, 0.9);
            Ellipse::new(frame, (radius, second), (start, start + turn)).expect("valid").enter()
        }
        "Plane" => Plane::new(frame, height, (0.0, radius)).expect("valid").enter(),
        "Cylinder" => Cylinder::new(frame, radius, height, sweep).expect("valid").enter(),
        "Cone" => {
            let other = if random.chance(0.3) { 0.0 } else { radius * random.between(0.1, 0.8) };
            let radii = if random.chance(0.5) { (radius, other) } else { (other, radius) };
            Cone::new(frame, radii, height, sweep).expect("valid").enter()
        }
        "Sphere" => {
            let low = random.pick(&[-FRAC_PI_2, -1.2, -0.3, 0.1]);
            let high = random.pick(&[FRAC_PI_2, 1.3, 0.4]);
            Sphere::new(frame, radius, (low, high), sweep).expect("valid").enter()
        }
        _ => {
            let tube = if random.chance(0.4) { (0.0, TAU) } else { (random.between(-3.0, 1.0), 2.0) };
            Torus::new(frame, 2.0 * radius, radius * random.between(0.2, 1.0), tube, sweep).expect("valid").enter()
        }
    };
    let entered = entered.expect("valid");
    (entered.definition, entered.kind.expect("a shape has a class"))
}

const CLASSES: [&str; 8] = ["Line", "Circle", "Ellipse", "Plane", "Cylinder", "Cone", "Sphere", "Torus"];

/// Points of a definition, `n + 1` along each direction.
fn points(definition: &Definition, n: usize) -> Vec<(f64, f64, DVec3)> {
    let share = |k: usize, n: usize, (a, b): (f64, f64)| {
        let t = k as f64 / n as f64;
        (1.0 - t) * a + t * b
    };
    match definition {
        Definition::NurbsCurve(curve) => (0..=n * n)
            .map(|k| {
                let u = share(k, n * n, curve.domain());
                (u, 0.0, curve.point(u))
            })
            .collect(),
        Definition::NurbsSurface(surface) => (0..=n)
            .flat_map(|i| (0..=n).map(move |j| (i, j)))
            .map(|(i, j)| {
                let (u, v) = (share(i, n, surface.domain(Direction::U)), share(j, n, surface.domain(Direction::V)));
                (u, v, surface.point(u, v))
            })
            .collect(),
    }
}

/// Panics where points show that the definition and its class are farther apart than the gap, one way or the other.
fn honest(definition: &Definition, item: &Item<Kind>, what: &str) {
    let rounding = 64.0 * EPSILON * (definition.reach() + definition.size());
    let allowed = gap(item) + rounding;
    for (u, v, p) in points(definition, 12) {
        if let Some(off) = distance(&item.value, p).filter(|off| *off > allowed) {
            panic!("{what}: at ({u}, {v}) {off:e} from {:?}, gap {:e}", item.value, gap(item));
        }
    }
    let mut model = Model::new();
    let id = model.insert("", definition.clone()).expect("valid");
    for i in 0..=4 {
        for j in 0..=4 {
            let Some(p) = at(&item.value, f64::from(i) / 4.0, f64::from(j) / 4.0) else { return };
            let foot = model.project(id, p).expect("finite");
            assert!(foot.lower_bound <= allowed, "{what}: {p} is {foot:?} away, gap {:e}, {:?}", gap(item), item.value);
        }
    }
}

#[test]
fn shapes_are_recognised_in_every_place_size_and_form() {
    let mut random = Random::new(20_061);
    for round in 0..120 {
        for class in CLASSES {
            let scale = random.power(-3.0, 6.0);
            let offset = if random.chance(0.3) { 0.0 } else { random.power(-1.0, 7.0) };
            let (plain, _) = shape(&mut random, class, scale, offset);
            for definition in [plain.clone(), disguised(&mut random, &plain)] {
                let item = recognised(&definition);
                let what = format!("round {round}, {class} of size {:e} at {offset:e}", definition.size());
                assert_eq!(name(&item.value), class, "{what}: {:?} of {definition:?}", item.value);
                if round % 4 == 0 {
                    honest(&definition, &item, &what);
                }
            }
        }
    }
}

#[test]
fn analytic_shapes_prove_the_class_with_which_they_enter() {
    let mut random = Random::new(20_062);
    for _ in 0..100 {
        for class in CLASSES {
            let (scale, offset) = (random.power(-3.0, 6.0), random.power(-2.0, 3.0));
            let (definition, kind) = shape(&mut random, class, scale, offset);
            let proven = prove(&kind, &definition, default_tolerance(&definition));
            assert!(proven.is_ok(), "{proven:?}: {kind:?} over {definition:?}");
        }
    }
}

#[test]
fn almost_shapes_are_never_accepted_beyond_what_they_are_off() {
    let mut random = Random::new(20_063);
    let mut refused = 0;
    for round in 0..60 {
        for class in CLASSES {
            let (scale, offset) = (random.power(-2.0, 3.0), random.power(-2.0, 1.0));
            let (plain, kind) = shape(&mut random, class, scale, offset);
            let plain = disguised(&mut random, &plain);
            let off = plain.size() * random.power(-10.0, -3.0);
            let moved = moved(&mut random, &plain, off);
            for tolerance in [default_tolerance(&moved), 1e-5 * moved.size()] {
                let item = recognise(&moved, tolerance);
                assert!(gap(&item) <= tolerance, "{:?}", item.basis);
                honest(&moved, &item, &format!("round {round}, {class} off by {off:e}"));
                refused += usize::from(name(&item.value) != class);
            }
            // what it was made from is refused where points show that it lies
            let seen = points(&moved, 12).into_iter().filter_map(|(_, _, p)| distance(&kind, p)).fold(0.0, f64::max);
            if let Ok(gap) = prove(&kind, &moved, default_tolerance(&moved)) {
                assert!(seen <= gap + 64.0 * EPSILON * (moved.reach() + moved.size()), "{seen:e} seen, {gap:e} proven");
            }
        }
    }
    assert!(refused > 300, "{refused} of 960: a moved control point makes most of them something else");
}

#[test]
fn a_line_that_runs_back_on_itself_is_the_set_that_it_covers() {
    let points = [0.0, 3.0, -1.0, 2.0].map(|x| DVec3::new(x, 2.0 * x, 1.0)).to_vec();
    let curve = NurbsCurve::new(1, vec![0.0, 0.0, 1.0, 2.0, 3.0, 3.0], points, None).expect("valid");
    let item = recognised(&curve.into());
    let Kind::Line { origin, direction, range } = item.value else { panic!("{:?}", item.value) };
    let ends = [origin + range.0 * direction, origin + range.1 * direction].map(|p| p.x);
    let (low, high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
    assert!((low + 1.0).abs() < 1e-14 && (high - 3.0).abs() < 1e-14, "{ends:?}");
    assert!(gap(&item) < 1e-12, "{:e}", gap(&item));
}

#[test]
fn an_arc_is_refused_where_its_range_stops_short_or_goes_too_far() {
    let circle = Circle::new(Frame::WORLD, 2.0, (0.0, 2.0)).expect("valid");
    let definition: Definition = circle.to_nurbs().expect("valid").into();
    let tolerance = default_tolerance(&definition);
    let stated = |sweep| Kind::Circle { centre: DVec3::ZERO, axis: DVec3::Z, xdir: DVec3::X, radius: 2.0, sweep };
    assert!(prove(&stated((0.0, 2.0)), &definition, tolerance).is_ok());
    for sweep in [(0.0, 2.001), (0.0, 1.999), (0.001, 2.0), (2.0, 0.0), (0.0, TAU)] {
        let refuted = prove(&stated(sweep), &definition, tolerance).expect_err("another arc");
        assert!(refuted.deviation().is_some_and(|off| off >= 1e-3), "{sweep:?}: {refuted}");
    }
}

/// A wavy profile in the half plane from the third axis, away from it, as a curve in space.
fn profile(random: &mut Random, degree: usize) -> NurbsCurve {
    let n = degree + 4;
    let points = (0..n).map(|k| DVec3::new(2.0 + random.between(-0.6, 0.6), 0.0, k as f64 * 0.7)).collect();
    let weights = (0..n).map(|_| random.between(0.5, 2.0)).collect();
    let inner = (1..4).map(|k| f64::from(k) / 4.0);
    let knots = std::iter::repeat_n(0.0, degree + 1).chain(inner).chain(std::iter::repeat_n(1.0, degree + 1)).collect();
    NurbsCurve::new(degree, knots, points, Some(weights)).expect("valid")
}

#[test]
fn free_profiles_that_are_swept_are_recognised_with_their_sweep_and_refused_with_another() {
    let mut random = Random::new(41);
    for degree in [2, 3, 5] {
        for scale in [1e-3, 1.0, 1e4] {
            let [x, y, z] = random.frame();
            let place = DAffine3 {
                matrix3: glam::DMat3::from_cols(scale * x, scale * y, scale * z),
                translation: scale * DVec3::new(3.0, -7.0, 2.0),
            };
            let flat = profile(&mut random, degree);
            let curve = flat.transformed(&place).expect("a similarity");
            let vector = scale * (0.3 * x + 4.0 * y - 0.2 * z);
            let swept = Definition::from(extrusion(&curve, vector).expect("valid"));
            let item = recognised(&swept);
            let Kind::Extrusion { vector: found, along } = item.value else { panic!("{degree}, {scale}: {item:?}") };
            assert!(along == Direction::V && found.distance(vector) <= 1e-12 * swept.size(), "{found}");
            refused_beyond(&swept, &Kind::Extrusion { vector: 1.01 * vector, along }, 0.01 * vector.length());

            let (centre, turned_by) = (place.translation, random.between(0.1, TAU));
            let vase = Definition::from(revolution(&curve, centre, z, turned_by).expect("valid"));
            let item = recognised(&vase);
            let Kind::Revolution { origin, axis, sweep, angular } = item.value else {
                panic!("{degree}, {scale}: {item:?}")
            };
            let off = [(origin - centre).cross(z).length(), scale * axis.cross(z).length()];
            assert!(off.iter().all(|off| *off <= 1e-9 * vase.size()), "{off:?}");
            assert!((sweep - turned_by).abs() <= 1e-9, "{sweep}, {turned_by}");
            let moved = Kind::Revolution { origin: origin + 0.01 * scale * x, axis, sweep, angular };
            refused_beyond(&vase, &moved, 1e-4 * scale);

            let slant = DAffine3::from_axis_angle(x, 0.4) * DAffine3::from_translation(scale * (5.0 * y + z));
            let other = profile(&mut random, degree).transformed(&place).and_then(|c| c.transformed(&slant));
            let wall = Definition::from(ruled(&curve, &other.expect("rigid")).expect("valid"));
            let item = recognised(&wall);
            assert_eq!(item.value, Kind::Ruled { ruling: Direction::V }, "{item:?}");
            assert!(gap(&item) < 1e-12 * wall.size(), "{item:?}");
            refused_beyond(&wall, &Kind::Ruled { ruling: Direction::U }, 1e-3 * scale);
        }
    }
}

/// A false class is refused with a measured deviation of at least `off`.
fn refused_beyond(definition: &Definition, lie: &Kind, off: f64) {
    let refuted = prove(lie, definition, default_tolerance(definition)).expect_err("a lie");
    let measured = refuted.deviation().unwrap_or_else(|| panic!("{lie:?}: {refuted}"));
    assert!(measured >= 0.9 * off, "{lie:?}: {measured:e}, {off:e}: {refuted}");
}

#[test]
fn almost_swept_surfaces_stay_what_they_are() {
    let mut random = Random::new(43);
    let (curve, other) = (profile(&mut random, 3), profile(&mut random, 3));
    let slant = DAffine3::from_axis_angle(DVec3::X, 0.4) * DAffine3::from_translation(DVec3::new(0.0, 5.0, 1.0));
    let other = other.transformed(&slant).expect("rigid");
    let surfaces = [
        extrusion(&curve, DVec3::new(0.3, 4.0, -0.2)).expect("valid"),
        revolution(&curve, DVec3::ZERO, DVec3::Z, 4.0).expect("valid"),
        ruled(&curve, &other).expect("valid"),
    ];
    for surface in surfaces {
        // an inner row of control points along the sweep makes room for a bump
        let surface = surface.elevate_degree(Direction::V, 1).expect("within the highest degree");
        for exponent in 3..=10 {
            let size = Definition::from(surface.clone()).size();
            let bump = 10.0_f64.powi(-exponent) * size;
            let (p, q) = surface.degree();
            let mut points = surface.control_points().to_vec();
            let at = 3 * surface.columns() + 1;
            points[at] += bump * DVec3::new(0.6, 0.48, 0.64);
            let rows = points.chunks(surface.columns()).map(<[DVec3]>::to_vec).collect();
            let weights = surface.weights().map(|w| w.chunks(surface.columns()).map(<[f64]>::to_vec).collect());
            let knots = [Direction::U, Direction::V].map(|d| surface.knots(d).as_slice().to_vec());
            let [u, v] = knots;
            let bumpy = perpend::NurbsSurface::new((p, q), (u, v), rows, weights).expect("valid");
            // what the bump lifts, seen at points: a lower bound of what the surface is off its straight rulings or arcs
            let lifted = points_of(&bumpy).zip(points_of(&surface)).map(|(a, b)| a.distance(b)).fold(0.0, f64::max);
            let item = recognised(&Definition::from(bumpy));
            if item.value != Kind::FreeForm {
                assert!(lifted <= gap(&item), "1e-{exponent}: {item:?}, lifted {lifted:e}");
            }
            assert!(exponent >= 9 || item.value == Kind::FreeForm, "1e-{exponent}: {item:?}");
        }
    }
}

fn points_of(surface: &perpend::NurbsSurface) -> impl Iterator<Item = DVec3> + '_ {
    (0..=20).flat_map(move |i| (0..=20).map(move |j| surface.point(f64::from(i) / 20.0, f64::from(j) / 20.0)))
}
