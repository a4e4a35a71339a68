//! Faces and solids of known shape, made of trimmed faces.

use perpend::glam::{DVec2, Vec2Swizzles as _};
use perpend::{
    Carrier, Cylinder, DVec3, Direction, EntityId, Frame, Model, NurbsSurface, Shell, Sphere, SurfaceData,
    TrimCurveData, TrimLoopData, TrimmedSurface, TrimmingData,
};

/// A plane with its own coordinates: `origin + u x + v y`, over a rectangle of them.
pub(crate) fn plane(origin: DVec3, x: DVec3, y: DVec3, (min, max): (DVec2, DVec2)) -> NurbsSurface {
    let at = |u: f64, v: f64| origin + u * x + v * y;
    let data = SurfaceData {
        degree: (1, 1),
        knots: (vec![min.x, min.x, max.x, max.x], vec![min.y, min.y, max.y, max.y]),
        control_points: vec![vec![at(min.x, min.y), at(min.x, max.y)], vec![at(max.x, min.y), at(max.x, max.y)]],
        weights: None,
    };
    NurbsSurface::enter(data).expect("a plane").0
}

/// A straight p-curve.
pub(crate) fn side(from: DVec2, to: DVec2) -> TrimCurveData {
    TrimCurveData { degree: 1, knots: vec![0.0, 0.0, 1.0, 1.0], points: vec![from, to], weights: None, edge: None }
}

/// A closed polygon.
pub(crate) fn polygon(outer: bool, corners: &[DVec2]) -> TrimLoopData {
    let next = |k: usize| corners[(k + 1) % corners.len()];
    TrimLoopData { outer, curves: corners.iter().enumerate().map(|(k, from)| side(*from, next(k))).collect() }
}

/// The rectangle between two corners.
pub(crate) fn rectangle(min: DVec2, max: DVec2) -> TrimLoopData {
    polygon(true, &[min, DVec2::new(max.x, min.y), max, DVec2::new(min.x, max.y)])
}

/// A whole circle, as one p-curve.
pub(crate) fn circle(outer: bool, centre: DVec2, radius: f64) -> TrimLoopData {
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let corners = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0)];
    let points = corners.map(|(x, y)| centre + radius * DVec2::new(f64::from(x), f64::from(y))).to_vec();
    let weights = (0..9).map(|k| if k % 2 == 1 { half } else { 1.0 }).collect();
    let knots = vec![0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 4.0, 4.0, 4.0];
    let curve = TrimCurveData { degree: 2, knots, points, weights: Some(weights), edge: None };
    TrimLoopData { outer, curves: vec![curve] }
}

pub(crate) fn face(surface: NurbsSurface, reversed: bool, loops: Vec<TrimLoopData>) -> TrimmedSurface {
    TrimmedSurface { surface: Carrier::Own(surface), trimming: TrimmingData { reversed, tolerance: 1e-6, loops } }
}

/// A planar face with loops in the coordinates of `x` and `y`; its outward normal is `x × y`. Where `reversed`, its carrier is turned
/// over.
pub(crate) fn planar(
    model: &mut Model,
    origin: DVec3,
    [x, y]: [DVec3; 2],
    loops: Vec<TrimLoopData>,
    reversed: bool,
) -> EntityId {
    let points = || loops.iter().flat_map(|one| &one.curves).flat_map(|curve| &curve.points);
    let min = points().fold(DVec2::INFINITY, |min, point| min.min(*point)) - 0.75;
    let max = points().fold(DVec2::NEG_INFINITY, |max, point| max.max(*point)) + 1.25;
    let one = if reversed {
        // u and v change places, and with them the sense of every loop
        let turned = |mut one: TrimLoopData| {
            one.curves.iter_mut().flat_map(|curve| &mut curve.points).for_each(|point| *point = point.yx());
            one
        };
        face(plane(origin, y, x, (min.yx(), max.yx())), true, loops.into_iter().map(turned).collect())
    } else {
        face(plane(origin, x, y, (min, max)), false, loops)
    };
    model.insert_trimmed("planar", one).expect("a planar face")
}

/// The six faces of a box; with `inward`, their outward normals point into it, as around a void. Every other face is reversed.
pub(crate) fn cuboid(model: &mut Model, min: DVec3, max: DVec3, inward: bool) -> Vec<EntityId> {
    let mut faces = Vec::new();
    for axis in 0..3 {
        let (a, b) = (DVec3::AXES[(axis + 1) % 3], DVec3::AXES[(axis + 2) % 3]);
        let extent = max - min;
        for upper in [false, true] {
            let origin = if upper { min + extent[axis] * DVec3::AXES[axis] } else { min };
            // x × y points away from the box, or into it
            let turned = upper == inward;
            let (x, y) = if turned { (b, a) } else { (a, b) };
            let corner = DVec2::new(extent.dot(x), extent.dot(y));
            faces.push(planar(model, origin, [x, y], vec![rectangle(DVec2::ZERO, corner)], upper));
        }
    }
    faces
}

/// A prism over a polygon given counter-clockwise, with holes through it, from `z = 0` to `height`.
pub(crate) fn prism(model: &mut Model, outline: &[DVec2], holes: &[Vec<DVec2>], height: f64) -> Vec<EntityId> {
    let mut faces = Vec::new();
    let lift = DVec3::Z * height;
    let mut loops = vec![polygon(true, outline)];
    loops.extend(holes.iter().map(|hole| polygon(false, hole)));
    faces.push(planar(model, lift, [DVec3::X, DVec3::Y], loops.clone(), false));
    faces.push(planar(model, DVec3::ZERO, [DVec3::X, DVec3::Y], loops, false));
    // the lower face looks down: it is the same plane, reversed
    let lower = faces[1];
    let trimming = model.entity(lower).and_then(perpend::Entity::trimming).expect("a face").data();
    let surface = match model.entity(lower).expect("a face").definition().as_ref() {
        perpend::Definition::NurbsSurface(surface) => surface.clone(),
        perpend::Definition::NurbsCurve(_) => unreachable!("a face"),
    };
    let turned =
        TrimmedSurface { surface: Carrier::Own(surface), trimming: TrimmingData { reversed: true, ..trimming } };
    model.replace_trimmed(lower, turned).expect("the same trim");
    for corners in std::iter::once(outline).chain(holes.iter().map(Vec::as_slice)) {
        for (k, from) in corners.iter().enumerate() {
            let along = corners[(k + 1) % corners.len()] - *from;
            let wall = rectangle(DVec2::ZERO, DVec2::new(along.length(), height));
            let x = along.normalize().extend(0.0);
            faces.push(planar(model, from.extend(0.0), [x, DVec3::Z], vec![wall], k % 2 == 0));
        }
    }
    faces
}

/// A trim along the whole domain of a surface.
pub(crate) fn whole(surface: NurbsSurface, reversed: bool) -> TrimmedSurface {
    let [(u0, u1), (v0, v1)] = [Direction::U, Direction::V].map(|direction| surface.domain(direction));
    face(surface, reversed, vec![rectangle(DVec2::new(u0, v0), DVec2::new(u1, v1))])
}

/// A cylinder of revolution about z: its wall and its two caps; `outward` is whether the material is inside.
pub(crate) fn cylinder(model: &mut Model, radius: f64, height: f64, outward: bool) -> Vec<EntityId> {
    let wall = Cylinder::new(Frame::WORLD, radius, (0.0, height), (0.0, std::f64::consts::TAU)).expect("a cylinder");
    let wall = wall.to_nurbs().expect("a cylinder");
    let normal = wall.normal(0.3, 0.4);
    let is_out = normal.dot(wall.point(0.3, 0.4) * DVec3::new(1.0, 1.0, 0.0)) > 0.0;
    let mut faces = vec![model.insert_trimmed("wall", whole(wall, is_out != outward)).expect("a wall")];
    for (upper, z) in [(false, 0.0), (true, height)] {
        let axes = if upper == outward { [DVec3::X, DVec3::Y] } else { [DVec3::Y, DVec3::X] };
        faces.push(planar(model, z * DVec3::Z, axes, vec![circle(true, DVec2::ZERO, radius)], upper));
    }
    faces
}

/// A whole sphere as one face without a trim, or with one along its domain.
pub(crate) fn sphere(model: &mut Model, centre: DVec3, radius: f64, trimmed: bool, outward: bool) -> EntityId {
    let frame = Frame::new(centre, DVec3::Z, DVec3::X).expect("a frame");
    let half = std::f64::consts::FRAC_PI_2;
    let ball = Sphere::new(frame, radius, (-half, half), (0.0, std::f64::consts::TAU)).expect("a sphere");
    let ball = ball.to_nurbs().expect("a sphere");
    let at = [Direction::U, Direction::V].map(|direction| {
        let (from, to) = ball.domain(direction);
        from + 0.4 * (to - from)
    });
    let is_out = ball.normal(at[0], at[1]).dot(ball.point(at[0], at[1]) - centre) > 0.0;
    assert!(trimmed || is_out == outward, "an untrimmed sphere looks inward, to its centre");
    if trimmed {
        model.insert_trimmed("ball", whole(ball, is_out != outward)).expect("a ball")
    } else {
        model.insert("ball", ball).expect("a ball")
    }
}

/// A body of one closed shell.
pub(crate) fn closed(model: &mut Model, faces: Vec<EntityId>) -> EntityId {
    model.insert_body("body", vec![Shell { faces, closed: true }]).expect("faces")
}
