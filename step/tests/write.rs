//! Models written as STEP and read again.

#![allow(clippy::print_stderr, reason = "a test that skips says so aloud")]

mod common;

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};
use perpend::{
    Carrier, CurveData, Cylinder, Frame, Model, NurbsSurface, Plane, QueryOptions, Shell, Sphere, Torus, TrimCurveData,
    TrimLoopData, TrimmedSurface, TrimmingData, Units,
};
use perpend_step::{ReadOptions, SourceLoop, SourceSurface, WriteOptions, import, read, write};

fn text(model: &Model) -> Vec<u8> {
    let mut text = Vec::new();
    write(model, WriteOptions { name: "part", only: None }, &mut text).unwrap();
    text
}

/// Numbers that need every digit.
fn wavy(rational: bool) -> NurbsSurface {
    let wave =
        |i: usize, j: usize| DVec3::new(i as f64 / 3.0, j as f64 * 0.1 + 1e-17, ((i * 7 + j * 3) as f64).sin() * 1e-7);
    let points = (0..5).map(|i| (0..4).map(|j| wave(i, j)).collect()).collect();
    let weights =
        rational.then(|| (0..5).map(|i| (0..4).map(|j| 1.0 + ((i + j) as f64).cos() / 3.0).collect()).collect());
    let knots = (vec![0.0, 0.0, 0.0, 0.1, 1.0 / 3.0, 1.0, 1.0, 1.0], vec![-7.0, -7.0, -7.0, -7.0, 1e9, 1e9, 1e9, 1e9]);
    NurbsSurface::new((2, 3), knots, points, weights).unwrap()
}

fn circle(radius: f64, outer: bool) -> TrimLoopData {
    let around = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)];
    let half = std::f64::consts::FRAC_1_SQRT_2;
    TrimLoopData {
        outer,
        curves: vec![TrimCurveData {
            degree: 2,
            knots: vec![0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 4.0, 4.0, 4.0],
            points: around.map(|(x, y)| DVec2::new(0.5, 0.5) + radius * DVec2::new(x.into(), y.into())).to_vec(),
            weights: Some((0..9).map(|i| if i % 2 == 0 { 1.0 } else { half }).collect()),
            edge: None,
        }],
    }
}

/// A tube about the z-axis from 0 to 2, of radius 1, with lids: 3 faces, a body.
fn can() -> Model {
    let mut model = Model::new();
    model.set_units(Units::Inch);
    let tube = Cylinder::new(Frame::WORLD, 1.0, (0.0, 2.0), (0.0, TAU)).unwrap().to_nurbs().unwrap();
    // S_u × S_v points inward
    let border = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(u, v)| DVec2::new(u, v));
    let side = |i: usize| TrimCurveData {
        degree: 1,
        knots: vec![0.0, 0.0, 1.0, 1.0],
        points: vec![border[i], border[(i + 1) % 4]],
        weights: None,
        edge: None,
    };
    let whole = vec![TrimLoopData { outer: true, curves: (0..4).map(side).collect() }];
    let face = |surface: NurbsSurface, loops, reversed| TrimmedSurface {
        surface: Carrier::Own(surface),
        trimming: TrimmingData { reversed, tolerance: 1e-6, loops },
    };
    let mut faces = vec![model.insert_trimmed("tube", face(tube, whole, true)).unwrap()];
    for (name, height, reversed) in [("bottom", 0.0, true), ("top", 2.0, false)] {
        let frame = Frame { centre: height * DVec3::Z, ..Frame::WORLD };
        let lid = Plane::new(frame, (-2.0, 2.0), (-2.0, 2.0)).unwrap().to_nurbs().unwrap();
        faces.push(model.insert_trimmed(name, face(lid, vec![circle(0.25, true)], reversed)).unwrap());
    }
    model.learn_all();
    let body = model.insert_body("can", vec![Shell { faces, closed: true }]).unwrap();
    model.set_colour(body, Some([0.8, 0.1, 0.25])).unwrap();
    model
}

#[test]
fn spline_surfaces_come_back_bit_for_bit() {
    for rational in [false, true] {
        let surface = wavy(rational);
        let mut model = Model::new();
        model.insert("wavy ü", surface.clone()).unwrap();
        let part = read(text(&model), &ReadOptions::default()).unwrap();
        assert_eq!(part.not_understood, []);
        assert_eq!(part.faces.len(), 1);
        assert_eq!(part.faces[0].name, "wavy ü");
        assert!(part.faces[0].same_sense);
        assert_eq!(part.faces[0].surface, SourceSurface::Nurbs(surface));
        let SourceLoop::Edges { uses, .. } = &part.faces[0].loops[0] else { panic!("four edges") };
        assert_eq!(uses.len(), 4);
    }
}

#[test]
fn a_can_is_a_solid_of_three_faces_and_three_edges() {
    let text = text(&can());
    let part = read(text, &ReadOptions::default()).unwrap();
    assert_eq!(part.not_understood, []);
    assert_eq!(part.units, Units::Inch);
    // two rims and a seam, each used twice
    assert_eq!((part.faces.len(), part.edges.len(), part.bodies.len()), (3, 3, 1));
    assert!(part.bodies[0].shells[0].closed);
    assert_eq!(part.bodies[0].colour, Some([0.8, 0.1, 0.25]));
    assert!(
        matches!(part.faces[0].surface, SourceSurface::Cylinder { radius, .. } if radius == 1.0),
        "{:?}",
        part.faces[0]
    );
    assert!(matches!(part.faces[1].surface, SourceSurface::Plane(_)));
    // outward is away from the axis
    assert!(part.faces[0].same_sense);
    assert_eq!(part.faces.iter().map(|face| face.name.as_str()).collect::<Vec<_>>(), ["tube", "bottom", "top"]);
}

#[test]
fn a_can_that_was_written_and_read_is_where_it_was() {
    let before = can();
    let after = import(text(&before), &ReadOptions::default()).unwrap().model;
    for p in
        [DVec3::new(3.0, 0.2, 1.0), DVec3::new(0.2, 0.1, 5.0), DVec3::new(0.3, 0.4, 0.4), DVec3::new(2.0, 2.0, -3.0)]
    {
        let [a, b] =
            [&before, &after].map(|model| model.nearest(p, &QueryOptions::default()).unwrap().unwrap().1.distance);
        assert!((a - b).abs() < 1e-12, "{p}: {a} {b}");
    }
}

#[test]
fn whole_surfaces_close_at_their_seams_and_poles() {
    let mut model = Model::new();
    model.insert("ball", Sphere::whole(Frame::WORLD, 2.0).unwrap().to_nurbs().unwrap()).unwrap();
    model.insert("ring", Torus::whole(Frame::WORLD, 3.0, 1.0).unwrap().to_nurbs().unwrap()).unwrap();
    model.learn_all();
    let part = read(text(&model), &ReadOptions::default()).unwrap();
    assert_eq!(part.not_understood, []);
    assert!(matches!(part.faces[0].surface, SourceSurface::Sphere { .. }));
    assert!(matches!(part.faces[1].surface, SourceSurface::Torus { .. }));
    // a meridian; two circles
    assert_eq!(part.edges.len(), 1 + 2);
    for (face, count) in part.faces.iter().zip([2, 4]) {
        let SourceLoop::Edges { uses, .. } = &face.loops[0] else { panic!("edges") };
        assert_eq!(uses.len(), count);
        assert_eq!(uses.iter().filter(|used| used.forward).count(), count / 2);
    }
}

#[test]
fn a_class_that_nobody_stated_is_recognised() {
    let tube = Cylinder::new(Frame::WORLD, 1.0, (0.0, 2.0), (0.0, TAU)).unwrap().to_nurbs().unwrap();
    let mut model = Model::new();
    model.insert("tube", tube).unwrap();
    let part = read(text(&model), &ReadOptions::default()).unwrap();
    assert!(
        matches!(part.faces[0].surface, SourceSurface::Cylinder { radius: 1.0, .. }),
        "{:?}",
        part.faces[0].surface
    );
}

#[test]
fn one_model_gives_one_text() {
    assert_eq!(text(&can()), text(&can()));
}

/// Parts as other systems wrote them, once they are models, are written and read with no face lost. They lie outside the repository, where
/// `real.rs` looks for them; without them the test says so and passes.
#[test]
fn real_parts_are_written_and_read_again() {
    let Some(folder) = common::real() else { return };
    let parts = [("as1-assembly", "stp"), ("nist-ftc-06", "step"), ("odri-lower-leg", "step"), ("tigl-nacelle", "stp")];
    for (name, ending) in parts {
        let file = std::fs::read(folder.join(name).join(format!("original.{ending}"))).unwrap();
        let first = import(file, &ReadOptions::default()).unwrap();
        let second = import(text(&first.model), &ReadOptions::default()).unwrap();
        assert_eq!(second.not_understood, [], "{name}");
        assert_eq!((second.faces, second.bodies), (first.faces, first.bodies), "{name}");
    }
}

#[test]
fn free_curves_are_a_curve_set_each() {
    let mut model = Model::new();
    let bow = CurveData {
        degree: 2,
        knots: vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0],
        control_points: vec![DVec3::ZERO, DVec3::new(1.0, 1.0 / 3.0, 0.0), DVec3::new(2.0, 0.0, 0.1)],
        weights: None,
    };
    model.insert("bow", bow).unwrap();
    let text = String::from_utf8(text(&model)).unwrap();
    assert!(text.contains("GEOMETRIC_CURVE_SET('bow',"), "{text}");
    assert!(text.contains("CARTESIAN_POINT('',(1.,0.3333333333333333,0.))"), "{text}");
}

/// A part of a square of side 10 at a height, between loops of corners; the first is the outer one.
fn plate(height: f64, tolerance: f64, loops: &[&[(f64, f64)]]) -> TrimmedSurface {
    let frame = Frame { centre: height * DVec3::Z, ..Frame::WORLD };
    let of = |(index, corners): (usize, &&[(f64, f64)])| TrimLoopData {
        outer: index == 0,
        curves: (0..corners.len())
            .map(|i| TrimCurveData {
                degree: 1,
                knots: vec![0.0, 0.0, 1.0, 1.0],
                points: [i, (i + 1) % corners.len()].map(|k| DVec2::from(corners[k]) / 10.0).to_vec(),
                weights: None,
                edge: None,
            })
            .collect(),
    };
    TrimmedSurface {
        surface: Carrier::Own(Plane::new(frame, (0.0, 10.0), (0.0, 10.0)).unwrap().to_nurbs().unwrap()),
        trimming: TrimmingData { reversed: false, tolerance, loops: loops.iter().enumerate().map(of).collect() },
    }
}

#[test]
fn faces_and_holes_below_the_coarsest_tolerance_keep_their_edges() {
    let square: &[_] = &[(1.0, 1.0), (9.0, 1.0), (9.0, 9.0), (1.0, 9.0)];
    let small: &[_] = &[(5.0, 5.0), (5.4, 5.0), (5.4, 5.4), (5.0, 5.4)];
    let hole: &[_] = &[(5.0, 5.0), (5.0, 5.3), (5.3, 5.3), (5.3, 5.0)];
    let sliver: &[_] = &[(1.0, 1.0), (9.0, 1.0), (9.0, 1.4), (1.0, 1.4)];
    let plates = [
        ("sloppy", plate(0.0, 0.5, &[square])),
        ("small", plate(7.0, 1e-6, &[small])),
        ("holed", plate(14.0, 1e-6, &[square, hole])),
        ("small and sloppy", plate(21.0, 0.5, &[small])),
        ("holed and sloppy", plate(28.0, 0.5, &[square, hole])),
        ("thin and sloppy", plate(35.0, 0.5, &[sliver])),
    ];
    for is_body in [false, true] {
        let mut before = Model::new();
        let faces = plates.iter().map(|(name, plate)| before.insert_trimmed(name, plate.clone()).unwrap()).collect();
        if is_body {
            before.insert_body("plates", vec![Shell { faces, closed: false }]).unwrap();
        }
        let mut text = Vec::new();
        let written = write(&before, WriteOptions::default(), &mut text).unwrap();
        assert_eq!((written.faces, written.empty, written.fitted), (6, vec![], vec![]));
        assert!(!String::from_utf8_lossy(&text).contains("VERTEX_LOOP"));
        let part = read(text.clone(), &ReadOptions::default()).unwrap();
        assert_eq!(part.not_understood, []);
        let counts: Vec<Vec<usize>> = part
            .faces
            .iter()
            .map(|face| {
                let uses = |one: &SourceLoop| match one {
                    SourceLoop::Edges { uses, .. } => uses.len(),
                    SourceLoop::Vertex(_) => 0,
                };
                face.loops.iter().map(uses).collect()
            })
            .collect();
        assert_eq!(counts, [vec![4], vec![4], vec![4, 4], vec![4], vec![4, 4], vec![4]]);
        assert_eq!(part.edges.len(), 32);
        let after = import(text, &ReadOptions::default()).unwrap().model;
        for height in 0..6 {
            for (x, y) in [(0.5, 0.5), (5.2, 5.2), (5.15, 5.15), (6.0, 6.0), (5.0, 1.2), (8.0, 8.0)] {
                let p = DVec3::new(x, y, 7.0 * f64::from(height) + 0.1);
                let [a, b] = [&before, &after]
                    .map(|model| model.nearest(p, &QueryOptions::default()).unwrap().unwrap().1.distance);
                assert!((a - b).abs() < 1e-9, "{p}: {a} {b}");
            }
        }
    }
}

#[test]
fn a_round_hole_of_two_arcs_below_the_tolerance_stays_open() {
    let mut face = plate(0.0, 0.5, &[&[(1.0, 1.0), (9.0, 1.0), (9.0, 9.0), (1.0, 9.0)]]);
    let whole = circle(0.015, false).curves.remove(0);
    let weights = whole.weights.unwrap();
    // clockwise, in halves
    let half = |from: usize| TrimCurveData {
        degree: 2,
        knots: vec![0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 2.0],
        points: (0..5).map(|k| whole.points[from - k]).collect(),
        weights: Some((0..5).map(|k| weights[from - k]).collect()),
        edge: None,
    };
    face.trimming.loops.push(TrimLoopData { outer: false, curves: vec![half(8), half(4)] });
    let mut model = Model::new();
    model.insert_trimmed("holed", face).unwrap();
    let part = read(text(&model), &ReadOptions::default()).unwrap();
    assert_eq!(part.edges.len(), 4 + 2);
    let after = import(text(&model), &ReadOptions::default()).unwrap().model;
    let (_, foot) = after.nearest(DVec3::new(5.0, 5.0, 0.0), &QueryOptions::default()).unwrap().unwrap();
    assert!((foot.distance - 0.15).abs() < 1e-6, "{}", foot.distance);
}
