//! Parts that nobody here wrote: no face is lost, and what is read lies where another kernel puts it.
//!
//! The parts lie outside the repository: in `real` of the folder that the environment variable `PERPEND_SHARED` names, by default
//! `../shared` beside the workspace. Without them the test says so and passes.

#![allow(clippy::print_stderr, reason = "a test that skips says so aloud; the times are wanted by readers")]

mod common;

use std::path::Path;
use std::time::Instant;

use perpend::{DVec3, Direction, Frame, Model, NurbsSurface};
use perpend_step::{ReadOptions, SourceCurve, SourceLoop, SourcePart, SourceSurface, read_file};

/// A part: its folder, its file, and how many faces, edges and bodies the file has.
struct Part {
    folder: &'static str,
    file: &'static str,
    faces: usize,
    edges: usize,
    bodies: usize,
    closed_shells: usize,
    /// Entities that hold geometry without faces.
    left_out: &'static [&'static str],
}

/// Edges are counted in the files: other kernels split some of them.
const MODELS: [Part; 6] = [
    Part {
        folder: "aero-assembly",
        file: "original.step",
        faces: 507,
        edges: 1423,
        bodies: 8,
        closed_shells: 8,
        left_out: &[],
    },
    Part {
        folder: "as1-assembly",
        file: "original.stp",
        faces: 160,
        edges: 354,
        bodies: 18,
        closed_shells: 18,
        left_out: &[],
    },
    Part {
        folder: "iea15mw-blade",
        file: "original.stp",
        faces: 3,
        edges: 12,
        bodies: 3,
        closed_shells: 0,
        left_out: &["GEOMETRIC_CURVE_SET"],
    },
    Part {
        folder: "nist-ftc-06",
        file: "original.step",
        faces: 187,
        edges: 476,
        bodies: 1,
        closed_shells: 1,
        left_out: &["GEOMETRIC_CURVE_SET", "TRIMMED_CURVE"],
    },
    Part {
        folder: "odri-lower-leg",
        file: "original.step",
        faces: 329,
        edges: 814,
        bodies: 1,
        closed_shells: 1,
        left_out: &[],
    },
    Part {
        folder: "tigl-nacelle",
        file: "original.stp",
        faces: 6,
        edges: 14,
        bodies: 1,
        closed_shells: 0,
        left_out: &[],
    },
];

#[test]
fn no_face_is_lost() {
    let Some(shared) = common::real() else { return };
    for model in MODELS {
        let folder = shared.join(model.folder);
        let start = Instant::now();
        let part = read_file(&folder.join(model.file), &ReadOptions::default()).expect("a STEP file");
        eprintln!("{}: {:?}, {}, tolerance {}", model.folder, start.elapsed(), part.units.symbol(), part.tolerance);
        for left_out in &part.not_understood {
            eprintln!("  {left_out}");
        }
        let listed: Vec<&str> = part.not_understood.iter().map(|left_out| left_out.keyword.as_str()).collect();
        assert_eq!(listed, model.left_out, "{}", model.folder);
        assert_eq!(part.faces.len(), model.faces, "faces of {}", model.folder);
        assert_eq!(part.edges.len(), model.edges, "edges of {}", model.folder);
        assert_eq!(part.bodies.len(), model.bodies, "bodies of {}", model.folder);
        let shells = || part.bodies.iter().flat_map(|body| &body.shells);
        assert_eq!(shells().filter(|shell| shell.closed).count(), model.closed_shells, "{}", model.folder);
        let mut in_shells: Vec<usize> = shells().flat_map(|shell| shell.faces.iter().copied()).collect();
        in_shells.sort_unstable();
        assert!(in_shells.into_iter().eq(0..model.faces), "every face of {} is in one shell", model.folder);
        check_loops(&part, model.folder);
        check_edges(&part, model.folder);
        check_against_corpus(&part, &folder);
    }
}

/// The edges of a loop follow one another, and closed shells use every edge twice, once in either direction.
fn check_loops(part: &SourcePart, name: &str) {
    let mut uses = vec![(0, 0); part.edges.len()];
    for face in &part.faces {
        for around in &face.loops {
            let SourceLoop::Edges { uses: around, .. } = around else { continue };
            let ends = |i: usize| {
                let used = &around[i % around.len()];
                let edge = &part.edges[used.edge];
                if used.forward { (edge.start, edge.end) } else { (edge.end, edge.start) }
            };
            for (i, used) in around.iter().enumerate() {
                let gap = ends(i).1.distance(ends(i + 1).0);
                assert!(gap <= part.tolerance, "{name}: a gap of {gap} after edge #{}", part.edges[used.edge].entity);
                let both = &mut uses[used.edge];
                *if used.forward { &mut both.0 } else { &mut both.1 } += 1;
            }
        }
    }
    if part.bodies.iter().flat_map(|body| &body.shells).all(|shell| shell.closed) {
        assert!(uses.iter().all(|both| *both == (1, 1)), "{name}: an edge is not used once in either direction");
    }
}

/// The vertices of an edge lie on its curve.
fn check_edges(part: &SourcePart, name: &str) {
    for edge in &part.edges {
        let slack = part.tolerance.max(2e-3);
        for point in [edge.start, edge.end] {
            let off = match &edge.curve {
                SourceCurve::Line { point: origin, direction } => {
                    let along = direction.normalize();
                    let arm = point - *origin;
                    (arm - arm.dot(along) * along).length()
                }
                SourceCurve::Circle { frame, radius } => {
                    let arm = point - frame.centre;
                    let height = arm.dot(frame.axis);
                    ((arm - height * frame.axis).length() - radius).hypot(height)
                }
                SourceCurve::Nurbs(curve) => {
                    let (from, to) = curve.domain();
                    curve.point(from).distance(point).min(curve.point(to).distance(point))
                }
                other => panic!("{name}: {other:?}"),
            };
            assert!(off <= slack, "{name}: a vertex of edge #{} lies {off} beside its curve", edge.entity);
        }
    }
}

/// A surface that another kernel made of a face of the same file: its kind, and points of it.
struct Other {
    kind: String,
    points: Vec<DVec3>,
    net: Vec<DVec3>,
}

/// Surfaces beside those that another kernel made of the same file: each is the surface of one face.
fn check_against_corpus(part: &SourcePart, folder: &Path) {
    let text = std::fs::read_to_string(folder.join("corpus.json")).expect("a corpus");
    let corpus: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let entities = corpus["entities"].as_array().expect("entities");
    let mut left: Vec<Other> = entities.iter().filter(|entity| entity["kind"] == "surface").map(other).collect();
    let name = folder.display();
    assert_eq!(left.len(), part.faces.len(), "{name}");
    let size = part.edges.iter().map(|edge| edge.start.abs().max_element()).fold(1.0, f64::max);
    for face in &part.faces {
        let near = 1e-9 * size;
        // the side of a pin lies on that of a longer one, so that the same net comes first
        let at = left.iter().position(|other| has_net(&face.surface, other, near));
        let at = at.or_else(|| left.iter().position(|other| is_same(&face.surface, other, near)));
        let at = at.unwrap_or_else(|| panic!("{name}: no surface of the corpus is that of face #{}", face.entity));
        left.swap_remove(at);
    }
}

fn other(entity: &serde_json::Value) -> Other {
    let degree = |along: &str| entity[along].as_u64().expect("a degree") as usize;
    let rows = |of: &str| entity[of].as_array().expect("rows").iter().map(numbers).collect::<Vec<_>>();
    let points = rows("points").iter().map(|row| row.chunks_exact(3).map(DVec3::from_slice).collect()).collect();
    let weights = entity["weights"].is_array().then(|| rows("weights"));
    let knots = (numbers(&entity["knots_u"]), numbers(&entity["knots_v"]));
    let surface = NurbsSurface::new((degree("degree_u"), degree("degree_v")), knots, points, weights);
    let surface = surface.expect("a valid surface");
    let (u, v) = (surface.domain(Direction::U), surface.domain(Direction::V));
    let at = |(first, last): (f64, f64), share: usize| first + (last - first) * share as f64 / 4.0;
    let points = (0..25).map(|i| surface.point(at(u, i / 5), at(v, i % 5))).collect();
    let kind = entity["origin_type"].as_str().unwrap_or_default().to_owned();
    Other { kind, points, net: surface.control_points().to_vec() }
}

fn numbers(value: &serde_json::Value) -> Vec<f64> {
    match value {
        serde_json::Value::Array(values) => values.iter().flat_map(numbers).collect(),
        value => value.as_f64().into_iter().collect(),
    }
}

/// Whether the surface has the control points of the other one.
fn has_net(surface: &SourceSurface, other: &Other, near: f64) -> bool {
    let SourceSurface::Nurbs(surface) = surface else { return false };
    let own = surface.control_points();
    own.len() == other.net.len() && own.iter().zip(&other.net).all(|(p, q)| p.distance(*q) <= near)
}

/// Whether the other surface is a part of this one.
fn is_same(surface: &SourceSurface, other: &Other, near: f64) -> bool {
    let all = |off: &dyn Fn(DVec3) -> f64| other.points.iter().all(|p| off(*p).abs() <= near);
    // distance from the axis, and height along it
    let about = |frame: &Frame, p: DVec3| {
        let height = (p - frame.centre).dot(frame.axis);
        ((p - frame.centre - height * frame.axis).length(), height)
    };
    match (surface, other.kind.as_str()) {
        (SourceSurface::Plane(frame), "plane") => all(&|p| about(frame, p).1),
        (SourceSurface::Cylinder { frame, radius }, "cylinder") => all(&|p| about(frame, p).0 - radius),
        (SourceSurface::Cone { frame, radius, half_angle }, "cone") => all(&|p| {
            let (across, height) = about(frame, p);
            across - (radius + height * half_angle.tan()).abs()
        }),
        (SourceSurface::Sphere { frame, radius }, "sphere") => all(&|p| p.distance(frame.centre) - radius),
        (SourceSurface::Torus { frame, major, minor }, "torus") => all(&|p| {
            let (across, height) = about(frame, p);
            (across - major).hypot(height) - minor
        }),
        (SourceSurface::Nurbs(surface), "bspline") => {
            let bounds = surface.control_box();
            if !all(&|p| bounds.distance_squared(p).sqrt()) {
                return false;
            }
            let mut model = Model::new();
            let id = model.insert("surface", surface.clone()).expect("a valid surface");
            all(&|p| model.project(id, p).expect("a finite point").distance)
        }
        _ => false,
    }
}
