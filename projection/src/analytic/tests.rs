//! Closed forms beside the certified solver, which shares nothing with them.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::Arc;

use glam::DVec3;
use perpend_kernel::{
    Circle, Cone, Cylinder, Definition, Direction, Ellipse, Frame, Line, NurbsCurve, NurbsSurface, Plane, Sphere,
    Torus, extrusion, revolution,
};

use crate::hierarchy::double_double::Random;
use crate::{FootPoint, Method, Prepared, Query, QueryOptions, Scratch};

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
            let slant = if chance(random, 0.3) { 0.5 } else { 0.0 };
            extrusion(&profile, 3.0 * scale * (frame.axis + slant * frame.ydir())).map(Into::into)
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
        let least = if class.ends_with("extrusion") { asked * 3 / 4 } else { asked };
        assert!(answered >= least, "{class}: {answered} of {asked} queries");
    }
}
