//! Bodies: the nearest face, inside and outside, against closed forms.

#[path = "bodies/solids.rs"]
mod solids;

use perpend::glam::DVec2;
use perpend::{BodyError, BodySide, DVec3, EntityId, Model, QueryOptions, Shell};

use solids::{circle, closed, cuboid, cylinder, face, planar, plane, polygon, prism, rectangle, sphere};

/// A small generator: the points of a test are the same on every machine.
struct Numbers(u64);

impl Numbers {
    /// The next number in [0, 1).
    fn next(&mut self) -> f64 {
        // Knuth's MMIX constants; the high bits are the good ones
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, min: DVec3, max: DVec3) -> DVec3 {
        min + DVec3::new(self.next(), self.next(), self.next()) * (max - min)
    }
}

/// The signed distance to a box.
fn to_box(p: DVec3, min: DVec3, max: DVec3) -> f64 {
    let beyond = (min - p).max(p - max);
    beyond.max(DVec3::ZERO).length() + beyond.max_element().min(0.0)
}

/// Asks random points in a box, some of them moved onto the planes, axes and centre of the body, and compares with a closed form.
fn agrees(model: &Model, body: EntityId, count: usize, (min, max): (DVec3, DVec3), expected: impl Fn(DVec3) -> f64) {
    let mut numbers = Numbers(count as u64);
    let special = [0.0, 1.0, 0.5, 2.0, -0.25, 1e-5, 1.0 + 1e-5, 1.0 - 1e-5];
    let points: Vec<DVec3> = (0..count)
        .map(|k| {
            let mut p = numbers.between(min, max);
            if k % 3 > 0 {
                for axis in 0..3 {
                    if numbers.next() < 0.4 {
                        p[axis] = special[(numbers.next() * special.len() as f64) as usize];
                    }
                }
            }
            p
        })
        .collect();
    let answers = model.signed_distance_all(body, &points, &QueryOptions::default());
    let size = model.size();
    for (p, answer) in points.iter().zip(answers) {
        let answer = answer.unwrap_or_else(|error| panic!("{p:?}: {error}"));
        let expected = expected(*p);
        assert!((answer.signed_distance - expected).abs() <= 1e-8 * size, "{p:?}: {answer:?}, expected {expected}");
        assert!(answer.lower_bound <= expected.abs() + 1e-14 * size, "{p:?}: {answer:?}, expected {expected}");
        match answer.side {
            BodySide::Outside => assert!(expected > -1e-15 * size, "{p:?}: {answer:?}"),
            BodySide::Inside => assert!(expected < 1e-15 * size, "{p:?}: {answer:?}"),
            BodySide::Boundary => assert!(expected.abs() <= 1e-15 * size, "{p:?}: {answer:?}"),
        }
    }
}

#[test]
fn a_box_tells_inside_from_outside_also_at_edges_and_corners() {
    let mut model = Model::new();
    let (min, max) = (DVec3::ZERO, DVec3::new(1.0, 2.0, 1.0));
    let faces = cuboid(&mut model, min, max, false);
    let body = closed(&mut model, faces);
    agrees(&model, body, 100_000, (min - 1.5, max + 1.5), |p| to_box(p, min, max));
}

/// Every point about a cube whose foot is an edge or a corner, as the method's test T23 asks.
#[test]
fn signs_are_right_around_every_edge_and_corner_of_a_cube() {
    let mut model = Model::new();
    let faces = cuboid(&mut model, DVec3::splat(-1.0), DVec3::ONE, false);
    let body = closed(&mut model, faces);
    for corner in (0..8).map(|k| DVec3::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2)) * 2.0 - 1.0) {
        for scale in [1e-9, 1e-6, 1e-3, 1.0, 1e3, 1e6] {
            for weights in [(1.0, 1.0, 1.0), (1.0, 1e-3, 1e-3), (1.0, 1.0, 0.0), (1e-3, 1.0, 0.5), (0.3, 0.0, 1.0)] {
                let outside = corner + scale * corner * DVec3::from(weights);
                let answer = model.signed_distance(body, outside, &QueryOptions::default()).unwrap();
                assert_eq!(answer.side, BodySide::Outside, "{outside:?}: {answer:?}");
                assert!((answer.signed_distance - outside.distance(corner)).abs() <= 1e-8 * (1.0 + scale));
                if scale < 1.0 {
                    let inside = corner - scale * corner * DVec3::from(weights).max(DVec3::splat(0.1));
                    let answer = model.signed_distance(body, inside, &QueryOptions::default()).unwrap();
                    assert_eq!(answer.side, BodySide::Inside, "{inside:?}: {answer:?}");
                }
            }
        }
    }
}

#[test]
fn an_l_shaped_prism_tells_inside_from_outside_at_its_concave_edge() {
    let corners = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)].map(DVec2::from);
    let mut model = Model::new();
    let faces = prism(&mut model, &corners, &[], 1.0);
    let body = closed(&mut model, faces);
    let inside = |p: DVec3| {
        let slab =
            |min: (f64, f64), max: (f64, f64)| to_box(p, DVec2::from(min).extend(0.0), DVec2::from(max).extend(1.0));
        slab((0.0, 0.0), (2.0, 1.0)).min(slab((0.0, 0.0), (1.0, 2.0)))
    };
    // outside, the nearer of the two boxes; inside, how far it is to the nearest wall
    let expected = |p: DVec3| {
        let outside = inside(p);
        if outside > 0.0 {
            return outside;
        }
        let mut nearest = p.z.min(1.0 - p.z);
        for k in 0..6 {
            let (a, b) = (corners[k], corners[(k + 1) % 6]);
            let q = DVec2::new(p.x, p.y);
            let share = ((q - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
            nearest = nearest.min(q.distance(a.lerp(b, share)));
        }
        -nearest
    };
    agrees(&model, body, 100_000, (DVec3::splat(-1.0), DVec3::new(3.0, 3.0, 2.0)), expected);
}

#[test]
fn a_hollow_box_has_a_void_that_is_outside() {
    let mut model = Model::new();
    let (min, max) = (DVec3::ZERO, DVec3::splat(2.0));
    // a wall a ten-thousandth thick on one side
    let (inner_min, inner_max) = (DVec3::new(1e-4, 0.5, 0.5), DVec3::new(1.0, 1.0, 1.5));
    let outer = cuboid(&mut model, min, max, false);
    let void = cuboid(&mut model, inner_min, inner_max, true);
    let shells = vec![Shell { faces: outer, closed: true }, Shell { faces: void, closed: true }];
    let body = model.insert_body("hollow", shells).unwrap();
    let expected = |p: DVec3| to_box(p, min, max).max(-to_box(p, inner_min, inner_max));
    agrees(&model, body, 100_000, (min - 0.5, max + 0.5), expected);
    let mut numbers = Numbers(8);
    for _ in 0..2_000 {
        let p = numbers.between(DVec3::new(-1e-4, 0.4, 0.4), DVec3::new(2e-4, 1.1, 1.6));
        let answer = model.signed_distance(body, p, &QueryOptions::default()).unwrap();
        assert!((answer.signed_distance - expected(p)).abs() < 1e-8, "{p:?}: {answer:?}, {}", expected(p));
    }
}

#[test]
fn a_cylinder_tells_inside_from_outside_at_its_seam_and_rims() {
    let mut model = Model::new();
    let faces = cylinder(&mut model, 1.0, 1.0, true);
    let body = closed(&mut model, faces);
    let expected = |p: DVec3| {
        let beyond = DVec2::new(p.x.hypot(p.y) - 1.0, (p.z - 0.5).abs() - 0.5);
        beyond.max(DVec2::ZERO).length() + beyond.max_element().min(0.0)
    };
    agrees(&model, body, 30_000, (DVec3::splat(-2.0), DVec3::splat(2.0)), expected);
}

#[test]
fn spheres_tell_inside_from_outside_at_their_poles_and_seams() {
    let mut model = Model::new();
    let ball = sphere(&mut model, DVec3::ZERO, 1.0, true, true);
    let body = closed(&mut model, vec![ball]);
    agrees(&model, body, 20_000, (DVec3::splat(-2.0), DVec3::splat(2.0)), |p| p.length() - 1.0);
    for trimmed in [true, false] {
        let outer = cuboid(&mut model, DVec3::splat(-2.0), DVec3::splat(2.0), false);
        let bubble = sphere(&mut model, DVec3::ZERO, 1.0, trimmed, false);
        let shells = vec![Shell { faces: outer, closed: true }, Shell { faces: vec![bubble], closed: true }];
        let body = model.insert_body("bubble", shells).unwrap();
        let expected = |p: DVec3| to_box(p, DVec3::splat(-2.0), DVec3::splat(2.0)).max(1.0 - p.length());
        agrees(&model, body, 20_000, (DVec3::splat(-3.0), DVec3::splat(3.0)), expected);
    }
}

/// A sharp wedge: the faces at its edge are a hundredth of a radian apart, so that their normals nearly cancel.
#[test]
fn a_knife_edge_is_told_by_points_beside_it() {
    let corners = [(0.0, 0.0), (1.0, -0.005), (1.0, 0.005)].map(DVec2::from);
    let mut model = Model::new();
    let faces = prism(&mut model, &corners, &[], 1.0);
    let body = closed(&mut model, faces);
    let mut numbers = Numbers(5);
    for k in 0..5_000 {
        let spread = if k % 2 == 0 { 0.05 } else { 1.0 };
        let p =
            DVec3::new(spread * (numbers.next() - 0.5), spread * (numbers.next() - 0.5), 1.4 * numbers.next() - 0.2);
        let inside = p.x > 0.0 && p.y.abs() < 0.005 * p.x && p.z > 0.0 && p.z < 1.0;
        let answer = model.signed_distance(body, p, &QueryOptions::default()).unwrap();
        let expected = if inside { BodySide::Inside } else { BodySide::Outside };
        assert_eq!(answer.side, expected, "{p:?}: {answer:?}");
    }
}

/// A box whose lid stops a thousandth short of the walls on all sides, as files have it.
#[test]
fn gaps_within_the_tolerance_are_no_way_in() {
    let gap = 1e-3;
    let mut model = Model::new();
    let mut faces = cuboid(&mut model, DVec3::ZERO, DVec3::ONE, false);
    faces.pop();
    let mut lid = face(
        plane(DVec3::Z, DVec3::X, DVec3::Y, (DVec2::splat(-1.0), DVec2::splat(2.0))),
        false,
        vec![rectangle(DVec2::splat(gap), DVec2::splat(1.0 - gap))],
    );
    lid.trimming.tolerance = 1.5 * gap;
    faces.push(model.insert_trimmed("lid", lid).unwrap());
    let body = closed(&mut model, faces);
    let mut numbers = Numbers(11);
    for k in 0..50_000 {
        let mut p = numbers.between(DVec3::splat(-0.5), DVec3::splat(1.5));
        if k % 2 == 0 {
            p = numbers.between(DVec3::new(0.97, 0.97, 0.97), DVec3::new(1.03, 1.03, 1.03));
        }
        let expected = to_box(p, DVec3::ZERO, DVec3::ONE);
        let answer = model.signed_distance(body, p, &QueryOptions::default()).unwrap();
        if expected.abs() > 2.0 * gap {
            assert_eq!(answer.side == BodySide::Inside, expected < 0.0, "{p:?}: {answer:?}, {expected}");
            assert!((answer.signed_distance - expected).abs() <= 1.5 * gap, "{p:?}: {answer:?}, {expected}");
        }
    }
}

#[test]
fn a_plate_with_a_hole_is_open_where_the_hole_is() {
    let corners = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)].map(DVec2::from);
    let hole = [(0.5, 0.5), (0.5, 1.5), (1.5, 1.5), (1.5, 0.5)].map(DVec2::from).to_vec();
    let mut model = Model::new();
    let faces = prism(&mut model, &corners, &[hole], 1.0);
    let body = closed(&mut model, faces);
    let inside = |p: DVec3| {
        let outer = to_box(p, DVec3::ZERO, DVec3::new(2.0, 2.0, 1.0)) < 0.0;
        outer && !(p.x > 0.5 && p.x < 1.5 && p.y > 0.5 && p.y < 1.5)
    };
    let mut numbers = Numbers(3);
    for _ in 0..20_000 {
        let p = numbers.between(DVec3::splat(-0.5), DVec3::new(2.5, 2.5, 1.5));
        let answer = model.signed_distance(body, p, &QueryOptions::default()).unwrap();
        assert_eq!(answer.side == BodySide::Inside, inside(p), "{p:?}: {answer:?}");
    }
}

#[test]
fn what_has_no_inside_says_so() {
    let mut model = Model::new();
    let faces = cuboid(&mut model, DVec3::ZERO, DVec3::ONE, false);
    let inward = cuboid(&mut model, DVec3::ZERO, DVec3::ONE, true);
    let open = model.insert_body("open", vec![Shell { faces: faces[1..].to_vec(), closed: false }]).unwrap();
    let turned = closed(&mut model, inward);
    let ask = |body| model.signed_distance(body, DVec3::splat(0.4), &QueryOptions::default());
    assert_eq!(ask(open).unwrap_err(), BodyError::Open { body: open, shell: 0 });
    assert_eq!(ask(turned).unwrap_err(), BodyError::InsideOut { body: turned });
    assert_eq!(
        ask(faces[0]).unwrap_err().to_string(),
        "the model has no body 1; its bodies are listed by `perpend show`"
    );
    // an open one has a distance
    let (_, foot) = model.nearest_of(open, DVec3::splat(0.4), &QueryOptions::default()).unwrap().unwrap();
    assert!((foot.distance - 0.4).abs() < 1e-9);
}

#[test]
fn points_on_the_faces_are_on_the_boundary() {
    let mut model = Model::new();
    let faces = cuboid(&mut model, DVec3::ZERO, DVec3::ONE, false);
    let body = closed(&mut model, faces);
    for p in [DVec3::ZERO, DVec3::X, DVec3::new(0.5, 0.0, 0.25), DVec3::new(1.0, 1.0, 0.3)] {
        let answer = model.signed_distance(body, p, &QueryOptions::default()).unwrap();
        assert_eq!(answer.side, BodySide::Boundary, "{p:?}: {answer:?}");
        assert!(answer.signed_distance.abs() <= 1e-15, "{p:?}: {answer:?}");
    }
}

#[test]
fn a_face_with_a_round_hole_is_no_nearer_than_its_rim() {
    let mut model = Model::new();
    let loops = vec![rectangle(DVec2::splat(-2.0), DVec2::splat(2.0)), circle(false, DVec2::ZERO, 1.0)];
    let plate = planar(&mut model, DVec3::ZERO, [DVec3::X, DVec3::Y], loops, false);
    let foot = model.project(plate, DVec3::new(0.25, 0.0, 1.0)).unwrap();
    assert!((foot.distance - 1.25).abs() < 1e-9, "{foot:?}");
    // the last corner of one loop is not the first point of the next
    for corner in [DVec2::new(-2.0, -2.0), DVec2::new(2.0, -2.0), DVec2::new(2.0, 2.0), DVec2::new(-2.0, 2.0)] {
        let foot = model.project(plate, 2.0 * corner.extend(0.5)).unwrap();
        assert!((foot.point - corner.extend(0.0)).length() < 1e-12 && foot.gap() < 1e-8, "{foot:?}");
    }
    let triangle = vec![polygon(true, &[DVec2::ZERO, DVec2::X, DVec2::Y])];
    let gusset = planar(&mut model, DVec3::ZERO, [DVec3::X, DVec3::Y], triangle, true);
    let foot = model.project(gusset, DVec3::new(1.0, 1.0, 0.0)).unwrap();
    assert!((foot.distance - std::f64::consts::FRAC_1_SQRT_2).abs() < 1e-9, "{foot:?}");
}
