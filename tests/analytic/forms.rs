//! Shapes in other forms: other degrees, knots and parameters, parts of them, and classes stated by hand in every way that the
//! conventions allow.

use std::f64::consts::TAU;

use perpend::{Basis, Classification, Definition, Direction, Item, Kind, Model, NurbsCurve, NurbsSurface, Record};

use super::case::{Case, Tally, nearly_all};
use super::probes::{probes, special};
use super::shapes::{CLASSES, Standing, shape};
use crate::common::disguise::{disguised, reparametrised_curve, reparametrised_surface};
use crate::common::exact::Exact;
use crate::common::exact::vector::Axes;
use crate::common::random::Random;

/// The model of a definition alone; its class has to be recognised.
fn unknown(definition: Definition) -> Model {
    let mut model = Model::new();
    model.insert("unknown", definition).expect("valid");
    model
}

/// The model of a definition whose class is stated.
pub(crate) fn stated(definition: Definition, kind: Kind, basis: Basis, tolerance: f64) -> Model {
    let item = Item { value: kind, basis, tolerance, of: definition.fingerprint() };
    let classification = Some(Classification { kind: Some(item), ..Classification::default() });
    let mut model = Model::new();
    let id = model.insert("stated", definition).expect("valid");
    model.set_record(id, Record { classification, ..Record::default() }).expect("the record is valid");
    model
}

fn ask(exact: &Exact, what: String, model: Model, random: &mut Random, tally: &mut Tally) {
    let case = Case::new(exact, what, model);
    let special = special(exact, random);
    case.ask(&probes(&special, &case.shape, 30, random), tally);
}

#[test]
fn disguised_shapes_are_answered_to_the_last_digits() {
    let mut random = Random::new(42_001);
    let mut tally = Tally::default();
    for round in 0..20 {
        for class in CLASSES {
            let standing = Standing::random(&mut random);
            let exact = shape(&mut random, class, standing);
            let definition = disguised(&mut random, &exact.made().0);
            ask(&exact, format!("round {round}, {class}, {standing:?}"), unknown(definition), &mut random, &mut tally);
        }
    }
    tally.settle(nearly_all);
}

/// The definition with both degrees raised to the limit.
fn elevated(definition: &Definition) -> Definition {
    match definition {
        Definition::NurbsCurve(curve) => curve.elevate_degree(25 - curve.degree()).expect("within the limit").into(),
        Definition::NurbsSurface(surface) => {
            let (p, q) = surface.degree();
            let surface = surface.elevate_degree(Direction::U, 25 - p).expect("within the limit");
            surface.elevate_degree(Direction::V, 25 - q).expect("within the limit").into()
        }
    }
}

#[test]
fn shapes_of_degree_25_are_answered_to_the_last_digits() {
    let mut random = Random::new(42_002);
    let mut tally = Tally::default();
    for class in CLASSES {
        let exact = shape(&mut random, class, Standing::WORLD);
        ask(&exact, format!("{class} of degree 25"), unknown(elevated(&exact.made().0)), &mut random, &mut tally);
    }
    tally.settle(nearly_all);
}

#[test]
fn strongly_reparametrised_shapes_are_answered_to_the_last_digits() {
    let mut random = Random::new(42_003);
    let mut tally = Tally::default();
    for k in [1e-3, 0.05, 20.0, 1e3] {
        for class in CLASSES {
            let exact = shape(&mut random, class, Standing::WORLD);
            let definition = match exact.made().0 {
                Definition::NurbsCurve(curve) => Definition::from(reparametrised_curve(&curve, k)),
                Definition::NurbsSurface(surface) => reparametrised_surface(&surface, (k, 1.0 / k)).into(),
            };
            ask(&exact, format!("{class} by {k}"), unknown(definition), &mut random, &mut tally);
        }
    }
    // weights a million apart leave some shapes proved within less than the gap asks
    tally.settle(|class| if ["Line", "Circle", "Plane"].contains(&class) { 1.0 } else { 0.4 });
}

/// The angle of a point about a frame's axis, next after `from`.
fn angle(x: f64, y: f64, from: f64) -> f64 {
    from + (y.atan2(x) - from).rem_euclid(TAU)
}

/// A piece of a shape, cut out by splitting its definition; none for classes that are not cut here.
fn cut(random: &mut Random, exact: &Exact) -> Option<(Exact, Definition)> {
    let mut piece = exact.clone();
    let share = random.between(0.1, 0.9);
    let keep_end = random.chance(0.5);
    let cut_range = |range: &mut (f64, f64), at: f64| if keep_end { range.0 = at } else { range.1 = at };
    match exact.made().0 {
        Definition::NurbsCurve(curve) => {
            let (first, last) = curve.domain();
            let u = first + share * (last - first);
            let q = curve.point(u);
            match &mut piece {
                Exact::Segment { a, b } => *(if keep_end { a } else { b }) = q,
                Exact::Circle { frame, sweep, .. } => {
                    let [x, y, _] = Axes::new(frame.centre, frame.axis, frame.xdir).coordinates(q);
                    cut_range(sweep, angle(x.value(), y.value(), sweep.0));
                }
                Exact::Ellipse { frame, radii, sweep } => {
                    let [x, y, _] = Axes::new(frame.centre, frame.axis, frame.xdir).coordinates(q);
                    cut_range(sweep, angle(x.value() / radii.0, y.value() / radii.1, sweep.0));
                }
                _ => return None,
            }
            let (before, after) = curve.split(u).expect("inside");
            Some((piece, if keep_end { after } else { before }.into()))
        }
        Definition::NurbsSurface(surface) => {
            let around = random.chance(0.5);
            let direction = if around { Direction::V } else { Direction::U };
            let (first, last) = surface.domain(direction);
            let at = first + share * (last - first);
            let across = surface.domain(if around { Direction::U } else { Direction::V });
            // not the middle, where a horn torus comes to its axis
            let aside = across.0 + 0.3 * (across.1 - across.0);
            let q = if around { surface.point(aside, at) } else { surface.point(at, aside) };
            let seen = |frame: &perpend::Frame| {
                let [x, y, z] = Axes::new(frame.centre, frame.axis, frame.xdir).coordinates(q);
                [x.value(), y.value(), z.value()]
            };
            match &mut piece {
                Exact::Cylinder { frame, sweep, .. }
                | Exact::Cone { frame, sweep, .. }
                | Exact::Sphere { frame, sweep, .. }
                | Exact::Torus { frame, sweep, .. }
                    if around =>
                {
                    let [x, y, _] = seen(frame);
                    cut_range(sweep, angle(x, y, sweep.0));
                }
                Exact::Cylinder { frame, height, .. } => cut_range(height, seen(frame)[2]),
                Exact::Cone { frame, radii, height, .. } => {
                    let [x, y, z] = seen(frame);
                    cut_range(height, z);
                    cut_range(radii, x.hypot(y));
                }
                Exact::Sphere { frame, latitude, .. } => {
                    let [x, y, z] = seen(frame);
                    cut_range(latitude, z.atan2(x.hypot(y)));
                }
                Exact::Torus { frame, major, tube, .. } => {
                    let [x, y, z] = seen(frame);
                    cut_range(tube, angle(x.hypot(y) - *major, z, tube.0));
                }
                _ => return None,
            }
            let (before, after) = surface.split(direction, at).expect("inside");
            Some((piece, if keep_end { after } else { before }.into()))
        }
    }
}

#[test]
fn pieces_cut_out_of_shapes_are_answered_to_the_last_digits() {
    let mut random = Random::new(42_004);
    let mut tally = Tally::default();
    for round in 0..30 {
        for class in CLASSES {
            let standing = Standing::random(&mut random);
            let whole = shape(&mut random, class, standing);
            let Some((exact, definition)) = cut(&mut random, &whole) else { continue };
            let what = format!("round {round}, a piece of {class}, {standing:?}");
            ask(&exact, what, unknown(definition), &mut random, &mut tally);
        }
    }
    tally.settle(nearly_all);
}

/// The definition run through in other directions, with its class in the same words: ranges that descend, angles along u.
fn turned_about(random: &mut Random, definition: Definition, mut kind: Kind) -> (Definition, Kind) {
    let flip = |range: &mut (f64, f64)| *range = (range.1, range.0);
    match definition {
        Definition::NurbsCurve(curve) => {
            let curve: NurbsCurve = curve.reversed();
            match &mut kind {
                Kind::Line { range, .. } => flip(range),
                Kind::Circle { sweep, .. } | Kind::Ellipse { sweep, .. } => flip(sweep),
                _ => panic!("{kind:?} over a curve"),
            }
            (curve.into(), kind)
        }
        Definition::NurbsSurface(surface) => {
            let mut surface: NurbsSurface = surface;
            let [along, about] = [random.chance(0.7), random.chance(0.7)];
            if along {
                surface = surface.reversed(Direction::U);
            }
            if about {
                surface = surface.reversed(Direction::V);
            }
            let swapped = random.chance(0.5);
            match &mut kind {
                Kind::Plane { origin, normal, sides: Some((a, b)) } => {
                    for (reversed, side) in [(along, &mut *a), (about, &mut *b)] {
                        if reversed {
                            *origin += *side;
                            *side = -*side;
                        }
                    }
                    if swapped {
                        std::mem::swap(a, b);
                    }
                    *normal = a.cross(*b).normalize();
                }
                Kind::Cylinder { height: range, sweep, angular, .. }
                | Kind::Cone { height: range, sweep, angular, .. }
                | Kind::Sphere { latitude: range, sweep, angular, .. }
                | Kind::Torus { section: range, sweep, angular, .. } => {
                    if along {
                        flip(range);
                    }
                    if about {
                        flip(sweep);
                    }
                    if swapped {
                        *angular = Direction::U;
                    }
                }
                _ => panic!("{kind:?} over a surface"),
            }
            (if swapped { surface.swapped() } else { surface }.into(), kind)
        }
    }
}

#[test]
fn classes_stated_in_other_words_are_answered_to_the_last_digits() {
    let mut random = Random::new(42_005);
    let mut tally = Tally::default();
    for round in 0..30 {
        for class in CLASSES {
            let standing = Standing::random(&mut random);
            let exact = shape(&mut random, class, standing);
            let (definition, kind) = exact.made();
            let (definition, kind) = turned_about(&mut random, definition, kind.expect("a class"));
            let basis = random.pick(&[Basis::Defined, Basis::Declared, Basis::Proved { gap: 0.0 }]);
            let what = format!("round {round}, {kind:?}, {standing:?}");
            let tolerance = 1e-10 * definition.size();
            ask(&exact, what, stated(definition, kind, basis, tolerance), &mut random, &mut tally);
        }
    }
    tally.settle(nearly_all);
}

#[test]
fn two_arcs_of_one_circle_give_the_same_foot() {
    let mut random = Random::new(42_006);
    for _ in 0..200 {
        let standing = Standing::random(&mut random);
        let Exact::Circle { frame, radius, .. } = shape(&mut random, "Circle", standing) else { panic!("a circle") };
        let start = random.between(-3.0, 3.0);
        let arcs = [90.0_f64, 120.0].map(|degrees| {
            let exact = Exact::Circle { frame, radius, sweep: (start, start + degrees.to_radians()) };
            let model = unknown(exact.made().0);
            let id = model.entities()[0].id();
            (model, id)
        });
        for _ in 0..20 {
            // over the part that both have, on both sides, in the plane and off it
            let angle = start + 90.0_f64.to_radians() * random.between(1e-3, 0.999);
            let (out, up) = (radius * random.power(-2.0, 1.0), radius * random.between(-2.0, 2.0));
            let p = Axes::new(frame.centre, frame.axis, frame.xdir).point(out * angle.cos(), out * angle.sin(), up);
            let feet = arcs.each_ref().map(|(model, id)| model.project(*id, p).expect("finite"));
            let apart = feet[0].point.distance(feet[1].point);
            let ulp = f64::EPSILON * (frame.centre.abs().max_element() + radius + p.abs().max_element());
            // the direction from the centre is known as well as the query is far from it
            let allowed = 32.0 * ulp * (1.0 + radius / out);
            assert!(
                apart <= allowed,
                "{p} about {frame:?}, radius {radius}: {apart:e} apart, {allowed:e} allowed; {feet:?}"
            );
            assert!((feet[0].distance - feet[1].distance).abs() <= 16.0 * ulp, "{feet:?}");
        }
    }
}
