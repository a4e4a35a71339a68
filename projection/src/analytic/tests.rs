//! Closed forms beside the certified solver, which shares nothing with them.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::Arc;

use glam::DVec3;
use perpend_kernel::{
    Circle, Cone, Cylinder, Definition, Direction, Ellipse, Frame, Line, NurbsCurve, NurbsSurface, Plane, Sphere,
    Torus, extrusion, revolution,
};

use perpend_knowledge::Kind;

use crate::analytic::Analytic;
use crate::hierarchy::Workspace;
use crate::hierarchy::double_double::{DoubleDouble, Random};
use crate::statistics::Work;
use crate::{FootPoint, Method, Multiplicity, Parameter, Place, Prepared, Query, QueryOptions, Scratch};

const CLASSES: [&str; 12] = [
    "line",
    "circle",
    "ellipse",
    "rectangle",
    "parallelogram",
    "cylinder",
    "cone",
    "sphere",
    "torus",
    "elliptic extrusion",
    "free extrusion",
    "free revolution",
];

fn pick<T: Copy>(random: &mut Random, of: &[T]) -> T {
    of[(random.next() % of.len() as u64) as usize]
}

fn chance(random: &mut Random, share: f64) -> bool {
    random.between(0.0, 1.0) < share
}

fn frame(random: &mut Random, offset: f64) -> Frame {
    if chance(random, 0.2) {
        return Frame::WORLD;
    }
    Frame::new(offset * random.point(), random.point().normalize(), random.point()).expect("a frame")
}

fn sweep(random: &mut Random) -> (f64, f64) {
    let start = random.between(-PI, PI);
    let turn = match random.next() % 4 {
        0 => TAU,
        1 => 10.0_f64.powf(random.between(-2.0, 0.0)),
        _ => random.between(0.3, 6.2),
    };
    (start, start + turn)
}

/// A free curve in the plane of two directions.
fn free(random: &mut Random, from: DVec3, x: DVec3, y: DVec3) -> NurbsCurve {
    let points = (0..7).map(|i| from + f64::from(i) * x + random.between(0.0, 1.5) * y).collect();
    let weights = chance(random, 0.5).then(|| (0..7).map(|_| random.between(0.5, 2.0)).collect());
    let knots = vec![0.0, 0.0, 0.0, 0.0, 0.2, 0.4, 0.7, 1.0, 1.0, 1.0, 1.0];
    NurbsCurve::new(3, knots, points, weights).expect("valid")
}

fn shape(random: &mut Random, class: &str, scale: f64, offset: f64) -> Definition {
    let (frame, sweep) = (frame(random, offset), sweep(random));
    let radius = scale * random.between(0.3, 2.0);
    let height = (scale * random.between(-1.0, 0.0), scale * random.between(0.1, 2.0));
    match class {
        "line" => {
            Line::new(frame.centre, frame.centre + radius * random.point()).expect("valid").to_nurbs().map(Into::into)
        }
        "circle" => Circle::new(frame, radius, sweep).expect("valid").to_nurbs().map(Into::into),
        "ellipse" => {
            let second = radius * pick(random, &[0.01, 0.3, 0.7, 0.9999, 1.5]);
            let (from, to) = sweep;
            let sweep = (from, to.max(from + 0.1));
            Ellipse::new(frame, (radius, second), sweep).expect("valid").to_nurbs().map(Into::into)
        }
        "rectangle" => Plane::new(frame, height, (0.0, radius)).expect("valid").to_nurbs().map(Into::into),
        "parallelogram" => {
            let (a, b) = (radius * frame.xdir, height.1 * (frame.ydir() + random.between(-2.0, 2.0) * frame.xdir));
            let o = frame.centre;
            let knots = vec![0.0, 0.0, 1.0, 1.0];
            let points = vec![vec![o, o + b], vec![o + a, o + a + b]];
            NurbsSurface::new((1, 1), (knots.clone(), knots), points, None).map(Into::into)
        }
        "cylinder" => Cylinder::new(frame, radius, height, sweep).expect("valid").to_nurbs().map(Into::into),
        "cone" => {
            let other = radius * pick(random, &[0.0, 0.1, 0.8]);
            let radii = if chance(random, 0.5) { (radius, other) } else { (other, radius) };
            Cone::new(frame, radii, height, sweep).expect("valid").to_nurbs().map(Into::into)
        }
        "sphere" => {
            let low = pick(random, &[-FRAC_PI_2, -1.2, -0.3, 0.1]);
            let high = pick(random, &[FRAC_PI_2, 1.3, 0.4]);
            Sphere::new(frame, radius, (low, high), sweep).expect("valid").to_nurbs().map(Into::into)
        }
        "torus" => {
            let tube = if chance(random, 0.4) { (0.0, TAU) } else { (random.between(-3.0, 1.0), 2.0) };
            let minor = radius * random.between(0.2, 1.0);
            Torus::new(frame, 2.0 * radius, minor, tube, sweep).expect("valid").to_nurbs().map(Into::into)
        }
        "elliptic extrusion" => {
            let ellipse = Ellipse::new(frame, (radius, 0.4 * radius), sweep).expect("valid").to_nurbs().expect("valid");
            let slant = if chance(random, 0.3) { 0.5 } else { 0.0 };
            extrusion(&ellipse, scale * (frame.axis + slant * frame.xdir)).map(Into::into)
        }
        "free extrusion" => {
            let profile = free(random, frame.centre, scale * frame.xdir, scale * frame.ydir());
            extrusion(&profile, 3.0 * scale * frame.axis).map(Into::into)
        }
        _ => {
            let from = frame.centre + scale * frame.xdir;
            let profile = free(random, from, scale * frame.axis, scale * frame.xdir);
            revolution(&profile, frame.centre, frame.axis, sweep.1 - sweep.0).map(Into::into)
        }
    }
    .expect("valid")
}

/// The same set of points in another form.
fn disguised(random: &mut Random, definition: Definition) -> Definition {
    let inside = |random: &mut Random, (a, b): (f64, f64)| a + (b - a) * random.between(0.1, 0.9);
    match definition {
        Definition::NurbsCurve(mut curve) => {
            let by = (random.next() % 5) as usize;
            if by > 0 {
                curve = curve.elevate_degree(by).expect("within the limit");
            }
            for _ in 0..random.next() % 3 {
                curve = curve.insert_knot(inside(random, curve.domain()), 1).expect("inside");
            }
            if chance(random, 0.5) { curve.reversed().into() } else { curve.into() }
        }
        Definition::NurbsSurface(mut surface) => {
            for direction in [Direction::U, Direction::V] {
                let by = (random.next() % 4) as usize;
                if by > 0 {
                    surface = surface.elevate_degree(direction, by).expect("within the limit");
                }
                for _ in 0..random.next() % 3 {
                    surface =
                        surface.insert_knot(direction, inside(random, surface.domain(direction)), 1).expect("inside");
                }
                if chance(random, 0.5) {
                    surface = surface.reversed(direction);
                }
            }
            if chance(random, 0.5) { surface.swapped().into() } else { surface.into() }
        }
    }
}

fn at(definition: &Definition, s: f64, t: f64) -> DVec3 {
    let share = |(a, b): (f64, f64), t: f64| (1.0 - t) * a + t * b;
    match definition {
        Definition::NurbsCurve(curve) => curve.point(share(curve.domain(), s)),
        Definition::NurbsSurface(surface) => {
            surface.point(share(surface.domain(Direction::U), s), share(surface.domain(Direction::V), t))
        }
    }
}

/// A query: in the box, far, on the shape, beside it, beyond its ends.
fn query(random: &mut Random, definition: &Definition) -> DVec3 {
    let size = definition.size();
    let centre = definition.control_box().centre();
    let [s, t] =
        [0, 1].map(|_| if chance(random, 0.2) { pick(random, &[0.0, 0.5, 1.0]) } else { random.between(0.0, 1.0) });
    let foot = at(definition, s, t);
    match random.next() % 5 {
        0 => centre + size * random.point(),
        1 => centre + 100.0 * size * random.point(),
        2 => foot,
        3 => foot + 10.0_f64.powf(random.between(-12.0, 0.0)) * size * random.point(),
        _ => foot + random.between(-2.0, 2.0) * (foot - centre),
    }
}

fn ask(prepared: &Prepared, p: DVec3, method: Method, scratch: &mut Scratch) -> FootPoint {
    let options = QueryOptions { method: Some(method), ..QueryOptions::default() };
    prepared.project(&Query::new(p, options).expect("finite"), scratch).expect("no limit")
}

#[test]
fn closed_forms_and_the_certified_solver_agree() {
    let mut random = Random(3);
    let mut scratch = Scratch::default();
    for class in CLASSES {
        let (mut asked, mut answered, mut refused) = (0, 0, 0);
        for round in 0..40 {
            let scale = 10.0_f64.powf(random.between(-3.0, 4.0));
            let offset = scale * pick(&mut random, &[0.0, 1.0, 100.0]);
            let mut definition = shape(&mut random, class, scale, offset);
            if round % 2 == 1 {
                definition = disguised(&mut random, definition);
            }
            let definition = Arc::new(definition);
            let prepared = Prepared::new(Arc::clone(&definition), None);
            if prepared.plan().method != Method::Analytic {
                refused += 1;
                continue;
            }
            let (size, reach) = (definition.size(), definition.reach());
            for _ in 0..60 {
                let p = query(&mut random, &definition);
                let ours = ask(&prepared, p, Method::Analytic, &mut scratch);
                let theirs = ask(&prepared, p, Method::Hierarchy, &mut scratch);
                asked += 1;
                answered += u32::from(ours.method == Method::Analytic);
                let allowed = 1e-9 * size + 32.0 * f64::EPSILON * (reach + p.abs().max_element());
                let what = || format!("{class}, round {round}, {p}: {ours:?}\nbut {theirs:?}\nof {definition:?}");
                assert!(ours.distance - ours.lower_bound <= allowed, "{}", what());
                assert!(ours.lower_bound <= theirs.distance, "{}", what());
                assert!(theirs.lower_bound <= ours.distance, "{}", what());
            }
        }
        assert_eq!(refused, 0, "{class}");
        // of an oblique extrusion only queries beside it are answered
        let least = if class == "elliptic extrusion" { asked * 3 / 4 } else { asked };
        assert!(answered >= least, "{class}: {answered} of {asked} queries");
    }
}

fn prepared(definition: impl Into<Definition>) -> Prepared {
    let prepared = Prepared::new(Arc::new(definition.into()), None);
    assert_eq!(prepared.plan().method, Method::Analytic, "{:?}", prepared.plan().reasons);
    prepared
}

fn foot(prepared: &Prepared, p: DVec3) -> FootPoint {
    let foot = ask(prepared, p, Method::Analytic, &mut Scratch::default());
    assert_eq!(foot.method, Method::Analytic);
    foot
}

fn circle(sweep: (f64, f64)) -> NurbsCurve {
    Circle::new(Frame::WORLD, 2.0, sweep).expect("valid").to_nurbs().expect("valid")
}

#[test]
fn centres_axes_and_spines_tie_all_around_and_the_lowest_parameters_are_given() {
    let whole = (0.0, TAU);
    let continuum = |definition: Definition, p: DVec3, distance: f64| {
        let foot = foot(&prepared(definition), p);
        assert_eq!(foot.multiplicity, Multiplicity::Continuum, "{foot:?}");
        assert!((foot.distance - distance).abs() < 1e-14, "{foot:?}");
        (foot.parameter.u(), foot.parameter.v())
    };
    assert_eq!(continuum(circle(whole).into(), DVec3::ZERO, 2.0), (0.0, None));
    assert_eq!(continuum(circle((0.3, 1.0)).into(), 3.0 * DVec3::Z, 13.0_f64.sqrt()).1, None);
    let cylinder = Cylinder::new(Frame::WORLD, 2.0, (0.0, 4.0), whole).expect("valid").to_nurbs().expect("valid");
    assert_eq!(continuum(cylinder.into(), DVec3::Z, 2.0), (0.25, Some(0.0)));
    let sphere = Sphere::whole(Frame::WORLD, 2.0).expect("valid").to_nurbs().expect("valid");
    assert_eq!(continuum(sphere.into(), DVec3::ZERO, 2.0), (0.0, Some(0.0)));
    let torus = Torus::whole(Frame::WORLD, 3.0, 1.0).expect("valid").to_nurbs().expect("valid");
    assert_eq!(continuum(torus.clone().into(), DVec3::ZERO, 2.0).1, Some(0.0));
    let on_spine = continuum(torus.into(), DVec3::new(0.0, 3.0, 0.0), 1.0);
    assert!(on_spine.0 == 0.0 || on_spine.1 == Some(0.0), "{on_spine:?}");
}

#[test]
fn ends_that_are_equally_near_tie_and_the_lower_parameter_is_given() {
    let half = prepared(circle((-FRAC_PI_2, FRAC_PI_2)));
    let (first, last) = (foot(&half, DVec3::new(-1.0, 0.0, 0.5)), foot(&half, DVec3::new(-1.0, 1e-3, 0.5)));
    assert_eq!(
        (first.multiplicity, first.place, first.parameter),
        (Multiplicity::Tied, Place::End, Parameter::Curve(0.0))
    );
    assert_eq!(
        (last.multiplicity, last.place, last.parameter),
        (Multiplicity::Unique, Place::End, Parameter::Curve(1.0))
    );
    // beside the centre of more than half a turn, the ray of the foot and the far end
    let most = prepared(circle((-3.0, 3.0)));
    let foot_beside = foot(&most, DVec3::new(-1e-10, 1e-12, 0.0));
    assert_eq!(foot_beside.multiplicity, Multiplicity::Continuum);
    let ellipse = Ellipse::whole(Frame::WORLD, (2.0, 1.0)).expect("valid").to_nurbs().expect("valid");
    let between = foot(&prepared(ellipse), DVec3::new(0.5, 0.0, 0.0));
    assert_eq!(between.multiplicity, Multiplicity::Tied);
    assert!(between.point.y > 0.0, "of both sides, the upper one has the lower parameter: {between:?}");
}

#[test]
fn feet_at_ends_edges_corners_seams_and_the_apex_have_exactly_their_parameters() {
    let place = |prepared: &Prepared, p: DVec3| {
        let foot = foot(prepared, p);
        (foot.place, foot.parameter)
    };
    let arc = prepared(circle((0.1, 1.3)));
    let end = |angle: f64, radius: f64| DVec3::new(radius * angle.cos(), radius * angle.sin(), 0.0);
    for radius in [1e-3, 0.7, 2.0, 5.0, 1e6] {
        assert_eq!(place(&arc, end(0.1, radius)), (Place::End, Parameter::Curve(0.0)), "{radius}");
        assert_eq!(place(&arc, end(1.3, radius)), (Place::End, Parameter::Curve(1.0)), "{radius}");
        assert_eq!(place(&arc, end(0.1 - 1e-9, radius)).0, Place::End);
        assert_eq!(place(&arc, end(0.1 + 1e-9, radius)).0, Place::Interior);
    }
    let whole = prepared(circle((0.1, 0.1 + TAU)));
    assert_eq!(place(&whole, end(0.1, 1.0)), (Place::Seam, Parameter::Curve(0.0)));
    let cone = Cone::new(Frame::WORLD, (1.0, 0.0), (0.0, 2.0), (0.0, TAU)).expect("valid").to_nurbs().expect("valid");
    let cone = prepared(cone);
    assert_eq!(place(&cone, DVec3::new(0.3, 0.1, 4.0)).0, Place::Pole);
    assert_eq!(place(&cone, DVec3::new(5.0, 0.5, -3.0)).0, Place::Edge);
    let rectangle = Plane::new(Frame::WORLD, (0.0, 2.0), (0.0, 1.0)).expect("valid").to_nurbs().expect("valid");
    assert_eq!(place(&prepared(rectangle), DVec3::new(3.0, -1.0, 1.0)), (Place::Corner, Parameter::Surface(1.0, 0.0)));
}

#[test]
fn two_arcs_of_one_circle_give_the_same_foot() {
    let arcs = [90.0_f64, 120.0].map(|degrees| prepared(circle((0.0, degrees.to_radians()))));
    let mut random = Random(19);
    for _ in 0..500 {
        let (angle, radius) = (random.between(0.0, FRAC_PI_2), 10.0_f64.powf(random.between(-3.0, 3.0)));
        let p = DVec3::new(radius * angle.cos(), radius * angle.sin(), random.between(-3.0, 3.0));
        let [a, b] = arcs.each_ref().map(|arc| foot(arc, p));
        let off = a.point.distance(b.point).max((a.distance - b.distance).abs());
        assert!(off <= 8.0 * f64::EPSILON * (2.0 + p.length()), "{p}: {a:?} {b:?}");
    }
}

/// Points at a planted foot, straight above it.
#[test]
fn planted_feet_are_found_to_a_few_ulps() {
    let mut random = Random(23);
    for class in ["rectangle", "parallelogram", "cylinder", "cone", "sphere", "torus"] {
        for round in 0..60 {
            let mut definition = shape(&mut random, class, 1.0, 1.0);
            if round % 2 == 1 {
                definition = disguised(&mut random, definition);
            }
            let prepared = prepared(definition.clone());
            let Definition::NurbsSurface(surface) = &definition else { panic!("{class} is a curve") };
            for _ in 0..10 {
                let share = |(a, b): (f64, f64), t: f64| (1.0 - t) * a + t * b;
                let u = share(surface.domain(Direction::U), random.between(0.01, 0.99));
                let v = share(surface.domain(Direction::V), random.between(0.01, 0.99));
                let (at, normal) = (surface.point(u, v), surface.normal(u, v));
                let Some(normal) = normal.try_normalize() else { continue };
                // nowhere near a focus: radii are at least 0.06
                let p = at + random.between(-0.01, 0.01) * normal;
                let foot = foot(&prepared, p);
                let ulp = f64::EPSILON * (definition.reach() + p.abs().max_element());
                assert!(foot.point.distance(at) <= 32.0 * ulp, "{class}: {p} {foot:?} of {definition:?}");
            }
        }
    }
}

#[test]
fn sizes_from_the_least_to_the_greatest_have_the_same_feet() {
    let mut random = Random(29);
    for class in CLASSES {
        for scale in [1e-60_f64, 1e60] {
            // powers of two change no digit
            let scale = 2.0_f64.powi(scale.log2() as i32);
            let definition = shape(&mut random, class, 1.0, 1.0);
            let map = perpend_kernel::glam::DAffine3::from_scale(DVec3::splat(scale));
            let scaled: Definition = match &definition {
                Definition::NurbsCurve(curve) => curve.transformed(&map).expect("within limits").into(),
                Definition::NurbsSurface(surface) => surface.transformed(&map).expect("within limits").into(),
            };
            let [plain, other] =
                [Prepared::new(Arc::new(definition.clone()), None), Prepared::new(Arc::new(scaled), None)];
            assert_eq!(other.plan().method, plain.plan().method, "{class} at {scale:e}");
            for _ in 0..20 {
                let p = query(&mut random, &definition);
                let [a, b] = [(&plain, p), (&other, scale * p)]
                    .map(|(prepared, p)| ask(prepared, p, Method::Analytic, &mut Scratch::default()));
                assert_eq!(a.method, b.method, "{class} at {scale:e}: {p}");
                let ulp = f64::EPSILON * (definition.reach() + p.abs().max_element());
                // a search of a profile may stop anywhere within its gap
                let allowed = if class.starts_with("free") { 1e-9 * definition.size() } else { 256.0 * ulp };
                assert!((a.distance - b.distance / scale).abs() <= allowed, "{class} at {scale:e}: {a:?} {b:?}");
            }
        }
    }
}

fn exact(x: f64) -> DoubleDouble {
    DoubleDouble::from(x)
}

/// One step of Newton's method from the root of the leading part.
fn root(x: DoubleDouble) -> DoubleDouble {
    let leading = x.to_f64().sqrt();
    if leading == 0.0 {
        return exact(0.0);
    }
    exact(leading) + (x - exact(leading) * exact(leading)) / (2.0 * leading)
}

fn norm(a: DoubleDouble, b: DoubleDouble) -> DoubleDouble {
    root(a * a + b * b)
}

#[test]
fn bounds_of_whole_shapes_hold_in_double_double_and_are_as_close_as_stated() {
    let mut random = Random(31);
    let (mut widest, mut worst) = (0.0_f64, 0.0_f64);
    for round in 0..4000 {
        let centre = 10.0_f64.powf(random.between(-2.0, 2.0)) * random.point();
        let frame = Frame::new(centre, DVec3::Z, DVec3::X).expect("a frame");
        let (radius, minor) = (random.between(0.5, 2.0), random.between(0.1, 0.4));
        let far = 10.0_f64.powf(random.between(-16.0, 6.0));
        let on = match round % 3 {
            0 => centre,
            1 => centre + radius * DVec3::new(0.6, -0.8, 0.0),
            _ => centre + DVec3::new(0.0, 0.0, random.between(-1.0, 1.0)),
        };
        let p = on + far * random.point();
        let [x, y, z] = [0, 1, 2].map(|k| exact(p[k]) - exact(centre[k]));
        let (axis, xdir, sweep, angular) = (DVec3::Z, DVec3::X, (0.0, TAU), Direction::V);
        let (definition, kind): (Definition, Kind) = match round % 4 {
            0 => (
                Circle::whole(frame, radius).expect("valid").to_nurbs().expect("valid").into(),
                Kind::Circle { centre, axis, xdir, radius, sweep },
            ),
            1 => (
                Sphere::whole(frame, radius).expect("valid").to_nurbs().expect("valid").into(),
                Kind::Sphere { centre, axis, xdir, radius, sweep, latitude: (-FRAC_PI_2, FRAC_PI_2), angular },
            ),
            2 => (
                Torus::whole(frame, radius, minor).expect("valid").to_nurbs().expect("valid").into(),
                Kind::Torus {
                    centre,
                    axis,
                    xdir,
                    major_radius: radius,
                    minor_radius: minor,
                    sweep,
                    section: sweep,
                    angular,
                },
            ),
            _ => (
                Cylinder::new(frame, radius, (-1.0, 1.0), sweep).expect("valid").to_nurbs().expect("valid").into(),
                Kind::Cylinder { centre, axis, xdir, radius, height: (-1.0, 1.0), sweep, angular },
            ),
        };
        let rho = norm(x, y);
        let true_distance = match round % 4 {
            0 => norm(rho - exact(radius), z),
            1 => norm(rho, z) - exact(radius),
            2 => norm(rho - exact(radius), z) - exact(minor),
            _ => {
                let beyond = if z.to_f64() > 1.0 { z - exact(1.0) } else { exact(0.0) - z - exact(1.0) };
                norm(rho - exact(radius), if beyond.to_f64() > 0.0 { beyond } else { exact(0.0) })
            }
        };
        let true_distance = true_distance.to_f64().abs();
        let analytic = Analytic::new(&definition, &kind, 0.0).expect("it has a closed form");
        let query = Query::new(p, QueryOptions::default()).expect("finite");
        let proposal =
            analytic.propose(&query, &mut Workspace::default(), &mut Work::default()).expect("in closed form");
        let ulp = f64::EPSILON * (centre.abs().max_element() + radius + p.distance(centre));
        assert!(proposal.lower_bound <= true_distance, "{kind:?} {p}: {proposal:?} {true_distance:e}");
        let foot = match &definition {
            Definition::NurbsCurve(curve) => curve.point(proposal.u),
            Definition::NurbsSurface(surface) => surface.point(proposal.u, proposal.v),
        };
        worst = worst.max((foot.distance(p) - true_distance).abs() / ulp);
        // 34 u of the query's distance, which has an error of its own, 4 ε of the origin's coordinates, and 64 u + 16 ε of the radii and twice the size
        let bound = 2.0 * (radius + minor) + 2.0 * definition.size();
        let stated = f64::EPSILON * (20.0 * p.distance(centre) + 4.0 * centre.abs().max_element() + 48.0 * bound);
        let share = (true_distance - proposal.lower_bound) / stated;
        assert!(share <= 1.0, "{kind:?} {p}: {proposal:?} {true_distance:e}");
        widest = widest.max(share);
    }
    // control points are rounded, and so is the evaluation of degree (2, 2)
    assert!(worst <= 6.0, "{worst} ulps");
    assert!(widest > 0.5, "the stated bound is what is taken off");
}

/// Queries on the normal of a planted point, on the near side of the larger axis: up to it, across the evolute, and on all sides of it.
#[test]
fn ellipses_from_needles_to_near_circles_give_the_planted_distance() {
    let mut random = Random(37);
    let mut worst = 0.0_f64;
    for round in 0..6000 {
        let flat = match round % 4 {
            0 => 10.0_f64.powf(random.between(-5.0, 0.0)),
            1 => 1.0 - 10.0_f64.powf(random.between(-15.0, -1.0)),
            _ => random.between(0.05, 1.0),
        };
        let angle = match round % 5 {
            0 => 10.0_f64.powf(random.between(-16.0, 0.0)),
            1 => FRAC_PI_2 - 10.0_f64.powf(random.between(-16.0, 0.0)),
            _ => random.between(-PI, PI),
        };
        let (sin, cos) = angle.sin_cos();
        // the point is nearest to its normal's points from the larger axis, s = 0, outwards; s = k² is the ellipse
        let s = match round % 3 {
            0 => 10.0_f64.powf(random.between(-18.0, 3.0)),
            1 => flat * flat * (1.0 + random.between(-1.0, 1.0) * 10.0_f64.powf(random.between(-15.0, 0.0))),
            _ => random.between(0.0, 3.0),
        };
        let t = exact(s) - exact(flat) * exact(flat);
        let (x, y) = ((t + exact(1.0)) * exact(cos), (exact(s) / exact(flat)) * exact(sin));
        let p = DVec3::new(x.to_f64(), y.to_f64(), 0.0);
        let (dx, dy) = (t * exact(cos), t * exact(sin) / exact(flat));
        let planted = norm(dx, dy).to_f64();
        let (centre, axis, xdir, sweep) = (DVec3::ZERO, DVec3::Z, DVec3::X, (0.0, TAU));
        let Ok(ellipse) = Ellipse::whole(Frame::WORLD, (1.0, flat)) else { continue };
        let definition = Definition::from(ellipse.to_nurbs().expect("valid"));
        let kind = Kind::Ellipse { centre, axis, xdir, radii: (1.0, flat), sweep };
        let analytic = Analytic::new(&definition, &kind, 0.0).expect("it has a closed form");
        let query = Query::new(p, QueryOptions::default()).expect("finite");
        let proposal =
            analytic.propose(&query, &mut Workspace::default(), &mut Work::default()).expect("in closed form");
        let Definition::NurbsCurve(curve) = &definition else { panic!("an ellipse is a curve") };
        let ulp = f64::EPSILON * (1.0 + p.length());
        let off = (curve.point(proposal.u).distance(p) - planted).abs() / ulp;
        worst = worst.max(off);
        assert!(off <= 8.0, "1 by {flat}, angle {angle}, s = {s:e}: {proposal:?}, not {planted:e}");
        assert!(proposal.lower_bound <= planted + 2.0 * ulp, "1 by {flat}, angle {angle}, s = {s:e}: {proposal:?}");
        assert!(planted - proposal.lower_bound <= 256.0 * ulp, "1 by {flat}, angle {angle}, s = {s:e}: {proposal:?}");
    }
    assert!(worst > 0.0);
}
