//! What files do with closed surfaces, poles, seams and tolerances, each in a small face of its own.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_3, PI, TAU};

use glam::{DVec2, DVec3};
use perpend::kernel::{PlaneCurve, TrimLoopData, Trimming, TrimmingData};
use perpend::{Circle, Cylinder, Direction, Frame, Line, NurbsCurve, NurbsSurface, Shape, Sphere, Torus};

use super::area::area;
use crate::face::{BuiltFace, FaceError, build, edge_curve};
use crate::source::{SourceCurve, SourceEdge, SourceFace, SourceLoop, SourceSurface, SourceUse};

const TOLERANCE: f64 = 1e-7;

/// A face in the making.
struct Sketch {
    surface: SourceSurface,
    same_sense: bool,
    edges: Vec<SourceEdge>,
    loops: Vec<SourceLoop>,
}

impl Sketch {
    fn on(surface: SourceSurface) -> Self {
        Self { surface, same_sense: true, edges: Vec::new(), loops: Vec::new() }
    }

    fn edge(&mut self, curve: SourceCurve, start: DVec3, end: DVec3) -> usize {
        let entity = 100 + self.edges.len() as u64;
        let closed = start == end;
        self.edges.push(SourceEdge { entity, curve, start, end, closed, same_sense: true });
        self.edges.len() - 1
    }

    fn line(&mut self, start: DVec3, end: DVec3) -> usize {
        self.edge(SourceCurve::Line { point: start, direction: end - start }, start, end)
    }

    /// The arc of a circle about the axis of a frame between two angles.
    fn arc(&mut self, frame: Frame, radius: f64, sweep: (f64, f64)) -> usize {
        let at = |angle: f64| frame.centre + radius * (angle.cos() * frame.xdir + angle.sin() * frame.ydir());
        let (start, end) = (at(sweep.0), at(sweep.1));
        let end = if sweep.1 - sweep.0 == TAU { start } else { end };
        self.edge(SourceCurve::Circle { frame, radius }, start, end)
    }

    fn nurbs(&mut self, curve: NurbsCurve) -> usize {
        let (first, last) = curve.domain();
        let (start, end) = (curve.point(first), curve.point(last));
        self.edge(SourceCurve::Nurbs(curve), start, end)
    }

    fn bound(mut self, uses: &[(usize, bool)]) -> Self {
        let uses =
            uses.iter().map(|(edge, forward)| SourceUse { edge: *edge, forward: *forward, pcurve: None }).collect();
        self.loops.push(SourceLoop::Edges { outer: false, uses });
        self
    }

    fn build(&self) -> Result<BuiltFace, FaceError> {
        self.build_within(TOLERANCE)
    }

    fn build_within(&self, tolerance: f64) -> Result<BuiltFace, FaceError> {
        let curves: Vec<_> = self.edges.iter().map(|edge| edge_curve(edge, tolerance)).collect();
        let face = SourceFace {
            entity: 1,
            name: String::new(),
            surface: self.surface.clone(),
            same_sense: self.same_sense,
            loops: self.loops.clone(),
            colour: None,
        };
        build(&face, &self.edges, &curves, tolerance)
    }

    /// The face, with one loop for each outline, and its area.
    fn built(&self, outer: usize, inner: usize) -> (BuiltFace, Trimming, f64) {
        let built = self.build().expect("the face is built");
        let count = |wanted: bool| built.loops.iter().filter(|one| one.outer == wanted).count();
        assert_eq!((count(true), count(false)), (outer, inner), "{:#?}", built.loops);
        let loops = built
            .loops
            .iter()
            .map(|one| TrimLoopData {
                outer: one.outer,
                curves: one.curves.iter().map(|(curve, _)| curve.clone()).collect(),
            })
            .collect();
        let data = TrimmingData { reversed: built.reversed, tolerance: 1e-12, loops };
        let (trimming, _) = Trimming::enter(data, &built.surface).expect("loops closed in their bits");
        let curves: Vec<Vec<PlaneCurve>> =
            trimming.loops().iter().map(|one| one.curves.iter().map(|curve| curve.curve.clone()).collect()).collect();
        let area = area(&built.surface, &curves);
        (built, trimming, area)
    }
}

fn about(axis: DVec3, centre: DVec3, xdir: DVec3) -> Frame {
    Frame::new(centre, axis, xdir).expect("a frame")
}

fn raised(height: f64) -> Frame {
    Frame { centre: height * DVec3::Z, ..Frame::WORLD }
}

#[track_caller]
fn assert_near(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 2e-5 * expected, "{found}, {expected} expected");
}

/// The angles at which a cylinder, a sphere or a torus of a built face begins and ends.
fn sweep(built: &BuiltFace) -> (f64, f64) {
    match built.shape {
        Some(
            Shape::Cylinder(Cylinder { sweep, .. })
            | Shape::Sphere(Sphere { sweep, .. })
            | Shape::Torus(Torus { sweep, .. }),
        ) => sweep,
        _ => panic!("{:?}", built.shape),
    }
}

fn cylinder() -> SourceSurface {
    SourceSurface::Cylinder { frame: Frame::WORLD, radius: 2.0 }
}

#[test]
fn a_whole_cylinder_between_two_circles_is_cut_open() {
    let mut sketch = Sketch::on(cylinder());
    let bottom = sketch.arc(Frame::WORLD, 2.0, (0.4, 0.4 + TAU));
    let top = sketch.arc(raised(3.0), 2.0, (1.9, 1.9 + TAU));
    let (built, _, area) = sketch.bound(&[(bottom, true)]).bound(&[(top, false)]).built(1, 0);
    assert_near(area, TAU * 2.0 * 3.0);
    assert_eq!(sweep(&built).1 - sweep(&built).0, TAU);
    assert!(built.reversed, "the normal of a kernel's cylinder points inward");
    let edges: Vec<Option<usize>> = built.loops[0].curves.iter().map(|curve| curve.1).collect();
    assert!(edges.contains(&Some(bottom)) && edges.contains(&Some(top)) && edges.contains(&None));
}

#[test]
fn a_cylinder_with_a_seam_begins_at_it() {
    let mut sketch = Sketch::on(cylinder());
    let at = |height: f64| DVec3::new(2.0 * 0.7_f64.cos(), 2.0 * 0.7_f64.sin(), height);
    let bottom = sketch.arc(Frame::WORLD, 2.0, (0.7, 0.7 + TAU));
    let top = sketch.arc(raised(3.0), 2.0, (0.7, 0.7 + TAU));
    let seam = sketch.line(at(0.0), at(3.0));
    let sketch = sketch.bound(&[(bottom, true), (seam, true), (top, false), (seam, false)]);
    let (built, _, area) = sketch.built(1, 0);
    assert_near(area, TAU * 2.0 * 3.0);
    assert!((sweep(&built).0 - 0.7).abs() < 1e-12);
    let seams = built.loops[0].curves.iter().filter(|curve| curve.1 == Some(seam));
    let sides: Vec<f64> = seams.map(|(curve, _)| curve.points[0].y).collect();
    assert_eq!(sides, [0.0, 1.0]);
    assert!(built.loops[0].curves.iter().all(|(curve, _)| curve.degree == 1));
}

#[test]
fn a_face_across_the_seam_of_its_surface_is_one_piece() {
    for same_sense in [true, false] {
        let mut sketch = Sketch::on(cylinder());
        sketch.same_sense = same_sense;
        let (from, to) = (PI - 0.5, PI + 0.8);
        let at = |angle: f64, height: f64| DVec3::new(2.0 * angle.cos(), 2.0 * angle.sin(), height);
        let bottom = sketch.arc(Frame::WORLD, 2.0, (from, to));
        let right = sketch.line(at(to, 0.0), at(to, 1.0));
        let top = sketch.arc(raised(1.0), 2.0, (from, to));
        let left = sketch.line(at(from, 0.0), at(from, 1.0));
        let mut uses = [(bottom, true), (right, true), (top, false), (left, false)];
        if !same_sense {
            uses.reverse();
            uses.iter_mut().for_each(|one| one.1 = !one.1);
        }
        let (built, trimming, area) = sketch.bound(&uses).built(1, 0);
        assert_near(area, 2.0 * 1.3);
        assert!((sweep(&built).1 - sweep(&built).0 - 1.3).abs() < 1e-12);
        assert_eq!(trimming.region().bounds(), (DVec2::ZERO, DVec2::ONE));
        assert_eq!(built.reversed, same_sense);
    }
}

#[test]
fn a_cylinder_ends_in_a_slanted_plane() {
    let mut sketch = Sketch::on(cylinder());
    let bottom = sketch.arc(Frame::WORLD, 2.0, (0.0, TAU));
    // z = 3 + x / 2
    let frame = about(DVec3::new(-0.5, 0.0, 1.0), 3.0 * DVec3::Z, DVec3::new(1.0, 0.0, 0.5));
    let radii = (2.0 * 1.25_f64.sqrt(), 2.0);
    let start = frame.centre + radii.1 * frame.ydir();
    let slant = sketch.edge(SourceCurve::Ellipse { frame, radii }, start, start);
    let (_, _, area) = sketch.bound(&[(bottom, true)]).bound(&[(slant, false)]).built(1, 0);
    assert_near(area, TAU * 2.0 * 3.0);
}

#[test]
fn a_hole_in_a_whole_cylinder_is_not_cut() {
    let mut sketch = Sketch::on(cylinder());
    let bottom = sketch.arc(Frame::WORLD, 2.0, (0.0, TAU));
    let top = sketch.arc(raised(4.0), 2.0, (0.0, TAU));
    let at = |angle: f64, height: f64| DVec3::new(2.0 * angle.cos(), 2.0 * angle.sin(), height);
    // across angle 0, where both circles begin
    let low = sketch.arc(raised(1.0), 2.0, (-0.5, 0.5));
    let high = sketch.arc(raised(2.0), 2.0, (-0.5, 0.5));
    let left = sketch.line(at(-0.5, 1.0), at(-0.5, 2.0));
    let right = sketch.line(at(0.5, 1.0), at(0.5, 2.0));
    let sketch = sketch.bound(&[(bottom, true)]).bound(&[(top, false)]);
    let sketch = sketch.bound(&[(left, true), (high, true), (right, false), (low, false)]);
    let (_, _, area) = sketch.built(1, 1);
    assert_near(area, TAU * 2.0 * 4.0 - 2.0);
}

#[test]
fn holes_all_around_are_cut_where_they_must_be() {
    let mut sketch = Sketch::on(cylinder());
    let bottom = sketch.arc(Frame::WORLD, 2.0, (0.0, TAU));
    let top = sketch.arc(raised(6.0), 2.0, (0.0, TAU));
    let at = |angle: f64, height: f64| DVec3::new(2.0 * angle.cos(), 2.0 * angle.sin(), height);
    let mut holes = Vec::new();
    // three slots, each longer than a third of a turn, one above the other
    for k in 0..3 {
        let (from, to) = (TAU * f64::from(k) / 3.0, TAU * (f64::from(k) + 1.2) / 3.0);
        let height = 1.0 + 1.5 * f64::from(k);
        let low = sketch.arc(raised(height), 2.0, (from, to));
        let high = sketch.arc(raised(height + 1.0), 2.0, (from, to));
        let left = sketch.line(at(from, height), at(from, height + 1.0));
        let right = sketch.line(at(to, height), at(to, height + 1.0));
        holes.push([(left, true), (high, true), (right, false), (low, false)]);
    }
    let sketch = sketch.bound(&[(bottom, true)]).bound(&[(top, false)]);
    let sketch = holes.iter().fold(sketch, |sketch, hole| sketch.bound(hole));
    let built = sketch.build().expect("a face");
    let outer = built.loops.iter().filter(|one| one.outer).count();
    let (_, _, area) = sketch.built(outer, built.loops.len() - outer);
    assert_near(area, TAU * 2.0 * 6.0 - 3.0 * 1.2 * TAU / 3.0 * 2.0);
}

#[test]
fn a_sphere_with_a_vertex_loop_is_whole() {
    let frame = about(DVec3::new(1.0, 2.0, 0.5), DVec3::new(3.0, -1.0, 2.0), DVec3::X);
    let mut sketch = Sketch::on(SourceSurface::Sphere { frame, radius: 1.5 });
    sketch.loops.push(SourceLoop::Vertex(frame.centre + 1.5 * frame.axis));
    let (built, _, area) = sketch.built(1, 0);
    assert_near(area, 2.0 * TAU * 1.5 * 1.5);
    assert!(built.loops[0].curves.iter().all(|curve| curve.1.is_none()));
}

#[test]
fn an_open_spline_surface_without_edges_is_refused_and_a_closed_one_is_whole() {
    let flat = perpend::Plane::new(Frame::WORLD, (0.0, 1.0), (0.0, 1.0)).unwrap().to_nurbs().unwrap();
    let tube = perpend::Cylinder::new(Frame::WORLD, 1.0, (0.0, 2.0), (0.0, TAU)).unwrap().to_nurbs().unwrap();
    let ball = perpend::Sphere::whole(Frame::WORLD, 1.5).unwrap().to_nurbs().unwrap();
    for vertex in [None, Some(DVec3::X)] {
        let on = |surface: &perpend::NurbsSurface| {
            let mut sketch = Sketch::on(SourceSurface::Nurbs(surface.clone()));
            sketch.loops.extend(vertex.map(SourceLoop::Vertex));
            sketch
        };
        assert_eq!(on(&flat).build().err(), Some(FaceError::Unbounded));
        assert_eq!(on(&tube).build().err(), Some(FaceError::Unbounded));
        let (_, _, area) = on(&ball).built(1, 0);
        assert_near(area, 2.0 * TAU * 1.5 * 1.5);
    }
}

#[test]
fn a_cap_around_the_pole_reaches_the_pole() {
    for (forward, height) in [(true, 1.0 - 0.5_f64.sqrt()), (false, 1.0 + 0.5_f64.sqrt())] {
        let mut sketch = Sketch::on(SourceSurface::Sphere { frame: Frame::WORLD, radius: 1.0 });
        let parallel = sketch.arc(raised(0.5_f64.sqrt()), 0.5_f64.sqrt(), (1.0, 1.0 + TAU));
        let (_, _, area) = sketch.bound(&[(parallel, forward)]).built(1, 0);
        assert_near(area, TAU * height);
    }
}

#[test]
fn a_sphere_without_a_small_disc_keeps_the_rest() {
    for (forward, height) in [(true, 1.0 - 0.8), (false, 1.0 + 0.8)] {
        let mut sketch = Sketch::on(SourceSurface::Sphere { frame: Frame::WORLD, radius: 1.0 });
        let axis = DVec3::new(0.6, 0.7, 0.1).normalize();
        let rim = sketch.arc(about(axis, 0.8 * axis, DVec3::Z), 0.6, (0.3, 0.3 + TAU));
        let (_, _, area) = sketch.bound(&[(rim, forward)]).built(1, usize::from(!forward));
        assert_near(area, TAU * height);
    }
}

#[test]
fn a_sphere_with_a_seam_from_pole_to_pole_is_whole() {
    let mut sketch = Sketch::on(SourceSurface::Sphere { frame: Frame::WORLD, radius: 1.0 });
    let seam = sketch.arc(about(-DVec3::Y, DVec3::ZERO, DVec3::X), 1.0, (-FRAC_PI_2, FRAC_PI_2));
    let (built, _, area) = sketch.bound(&[(seam, true), (seam, false)]).built(1, 0);
    assert_near(area, 2.0 * TAU);
    assert_eq!(built.loops[0].curves.len(), 4);
}

#[test]
fn a_lune_lies_between_its_meridians() {
    for (same_sense, width) in [(true, FRAC_PI_3), (false, TAU - FRAC_PI_3)] {
        let mut sketch = Sketch::on(SourceSurface::Sphere { frame: Frame::WORLD, radius: 1.0 });
        sketch.same_sense = same_sense;
        let meridian = |angle: f64| {
            let out = DVec3::new(angle.cos(), angle.sin(), 0.0);
            about(out.cross(DVec3::Z), DVec3::ZERO, out)
        };
        let west = sketch.arc(meridian(0.2), 1.0, (-FRAC_PI_2, FRAC_PI_2));
        let east = sketch.arc(meridian(0.2 + FRAC_PI_3), 1.0, (-FRAC_PI_2, FRAC_PI_2));
        let (_, _, area) = sketch.bound(&[(east, true), (west, false)]).built(1, 0);
        assert_near(area, 2.0 * width);
    }
}

#[test]
fn an_edge_may_pass_the_pole_between_its_ends() {
    let mut sketch = Sketch::on(SourceSurface::Sphere { frame: Frame::WORLD, radius: 1.0 });
    // half of the northern hemisphere: over the pole, and back along the equator
    let over = sketch.arc(about(-DVec3::Y, DVec3::ZERO, DVec3::X), 1.0, (0.0, PI));
    let equator = sketch.arc(Frame::WORLD, 1.0, (0.0, PI));
    let (_, _, area) = sketch.bound(&[(equator, true), (over, false)]).built(1, 0);
    assert_near(area, PI);
}

#[test]
fn a_cone_reaches_its_apex_with_and_without_a_vertex_there() {
    let half_angle = 0.6_f64;
    let surface = || SourceSurface::Cone { frame: Frame::WORLD, radius: 1.0, half_angle };
    let slant = |radius: f64| radius / half_angle.sin();
    let mut sketch = Sketch::on(surface());
    let rim = sketch.arc(Frame::WORLD, 1.0, (0.0, TAU));
    let (_, _, area) = sketch.bound(&[(rim, false)]).built(1, 0);
    assert_near(area, PI * slant(1.0));
    let mut sketch = Sketch::on(surface());
    let rim = sketch.arc(Frame::WORLD, 1.0, (0.0, TAU));
    let ruling = sketch.line(DVec3::X, -DVec3::Z / half_angle.tan());
    let (built, _, area) = sketch.bound(&[(rim, false), (ruling, true), (ruling, false)]).built(1, 0);
    assert_near(area, PI * slant(1.0));
    assert!(matches!(built.shape, Some(Shape::Cone(cone)) if cone.radii.0 == 0.0));
    let mut sketch = Sketch::on(surface());
    let rim = sketch.arc(Frame::WORLD, 1.0, (0.5, 1.7));
    let apex = -DVec3::Z / half_angle.tan();
    let at = |angle: f64| DVec3::new(angle.cos(), angle.sin(), 0.0);
    let (left, right) = (sketch.line(apex, at(0.5)), sketch.line(apex, at(1.7)));
    let (_, _, area) = sketch.bound(&[(left, false), (right, true), (rim, false)]).built(1, 0);
    assert_near(area, 0.6 * slant(1.0));
}

#[test]
fn a_torus_is_whole_or_between_two_circles_either_way() {
    let (major, minor) = (3.0, 1.0);
    let surface = || SourceSurface::Torus { frame: Frame::WORLD, major, minor };
    let (_, _, area) = Sketch::on(surface()).built(1, 0);
    assert_near(area, TAU * TAU * major * minor);
    // about the axis, from the tube's angle 2 to 5
    let ring = |angle: f64| (raised(minor * angle.sin()), major + minor * angle.cos());
    for (start, (from, to)) in [(0.3, (2.0, 5.0)), (-1.0, (5.0, 2.0 + TAU))] {
        let mut sketch = Sketch::on(surface());
        let ((a, r), (b, s)) = (ring(from), ring(to));
        let first = sketch.arc(a, r, (start, start + TAU));
        let second = sketch.arc(b, s, (1.0, 1.0 + TAU));
        let (_, _, area) = sketch.bound(&[(first, true)]).bound(&[(second, false)]).built(1, 0);
        assert_near(area, TAU * minor * (major * (to - from) + minor * (to.sin() - from.sin())));
    }
    // about the tube, from the axis' angle 1 to 2.5, and the rest
    let section = |angle: f64| {
        let out = DVec3::new(angle.cos(), angle.sin(), 0.0);
        about(out.cross(DVec3::Z), major * out, out)
    };
    for (from, to) in [(1.0, 2.5), (2.5, 1.0 + TAU)] {
        let mut sketch = Sketch::on(surface());
        let first = sketch.arc(section(from), minor, (0.5, 0.5 + TAU));
        let second = sketch.arc(section(to), minor, (-2.0, -2.0 + TAU));
        let (built, _, area) = sketch.bound(&[(first, false)]).bound(&[(second, true)]).built(1, 0);
        assert_near(area, TAU * minor * major * (to - from));
        assert!((sweep(&built).1 - sweep(&built).0 - (to - from)).abs() < 1e-9);
    }
}

#[test]
fn loops_of_a_plane_may_be_named_wrong_and_run_wrong() {
    let mut sketch = Sketch::on(SourceSurface::Plane(raised(1.0)));
    let corners = [(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0)].map(|(x, y)| DVec3::new(x, y, 1.0));
    let sides: Vec<(usize, bool)> = (0..4).map(|k| (sketch.line(corners[k], corners[(k + 1) % 4]), true)).collect();
    let at = Frame { centre: DVec3::new(2.0, 1.5, 1.0), ..Frame::WORLD };
    let rim = sketch.arc(at, 1.0, (0.0, TAU));
    let backward: Vec<(usize, bool)> = sides.iter().rev().map(|(edge, _)| (*edge, false)).collect();
    for hole in [true, false] {
        for outline in [&sides, &backward] {
            let sketch = Sketch { edges: sketch.edges.clone(), ..Sketch::on(sketch.surface.clone()) };
            let (built, _, area) = sketch.bound(&[(rim, hole)]).bound(outline).built(1, 1);
            assert_near(area, 12.0 - PI);
            assert!(!built.reversed && built.loops[1].outer);
            assert_eq!(built.loops[0].curves[0].0.weights.as_ref().map(Vec::len), Some(9), "circles stay exact");
        }
    }
}

#[test]
fn edges_may_be_conics_without_end() {
    let mut sketch = Sketch::on(SourceSurface::Plane(Frame::WORLD));
    // under y = 4 - x², above the branch y = √(1 + x²) of a hyperbola
    let x = ((9.0 - 21.0_f64.sqrt()) / 2.0).sqrt();
    let (left, right) = (DVec3::new(-x, 4.0 - x * x, 0.0), DVec3::new(x, 4.0 - x * x, 0.0));
    let parabola = about(DVec3::Z, 4.0 * DVec3::Y, -DVec3::Y);
    let bow = sketch.edge(SourceCurve::Parabola { frame: parabola, focal: 0.25 }, left, right);
    let hyperbola = about(DVec3::Z, DVec3::ZERO, DVec3::Y);
    let bend = sketch.edge(SourceCurve::Hyperbola { frame: hyperbola, radii: (1.0, 1.0) }, right, left);
    let (_, _, area) = sketch.bound(&[(bow, false), (bend, false)]).built(1, 0);
    let under = |x: f64| 4.0 * x - x.powi(3) / 3.0 - 0.5 * (x * (1.0 + x * x).sqrt() + x.asinh());
    assert_near(area, 2.0 * under(x));
}

/// A closed tube of degree (3, 1) around the axis, which begins at angle 0: u around, v along.
fn tube() -> NurbsSurface {
    let count = 16;
    let ring = |height: f64| -> Vec<DVec3> {
        (0..=count)
            .map(|k| {
                let angle = TAU * f64::from(k % count) / f64::from(count);
                DVec3::new(angle.cos() * (2.0 + 0.2 * (3.0 * angle).cos()), 2.0 * angle.sin(), height)
            })
            .collect()
    };
    let (low, high) = (ring(0.0), ring(5.0));
    let points = low.into_iter().zip(high).map(|(a, b)| vec![a, b]).collect();
    let mut knots = vec![0.0; 3];
    knots.extend((0..=14).map(f64::from));
    knots.extend([14.0; 3]);
    NurbsSurface::new((3, 1), (knots, vec![0.0, 0.0, 1.0, 1.0]), points, None).expect("a tube")
}

#[test]
fn a_closed_spline_is_cut_open_over_the_box_of_its_face() {
    let surface = tube();
    // from u = 12 over the seam to u = 2, v from 0.25 to 0.75
    let whole: f64 = {
        let part = |from, to| area_of(&surface, from, to);
        part(12.0, 14.0) + part(0.0, 2.0)
    };
    let at = |v: f64| {
        let iso = surface.iso_curve(Direction::V, v).expect("an iso-curve");
        let (tail, head) = (iso.split(12.0).expect("inside").1, iso.split(2.0).expect("inside").0);
        (tail, head)
    };
    let ((low_tail, low_head), (high_tail, high_head)) = (at(0.25), at(0.75));
    let mut sketch = Sketch::on(SourceSurface::Nurbs(surface.clone()));
    let (low_tail, low_head) = (sketch.nurbs(low_tail), sketch.nurbs(low_head));
    let (high_tail, high_head) = (sketch.nurbs(high_tail), sketch.nurbs(high_head));
    let left = sketch.line(surface.point(12.0, 0.25), surface.point(12.0, 0.75));
    let right = sketch.line(surface.point(2.0, 0.25), surface.point(2.0, 0.75));
    let uses =
        [(low_tail, true), (low_head, true), (right, true), (high_head, false), (high_tail, false), (left, false)];
    let (built, trimming, area) = sketch.bound(&uses).built(1, 0);
    assert_near(area, whole);
    let domain = built.surface.domain(Direction::U);
    assert!((domain.1 - domain.0 - 14.0).abs() < 1e-12 && domain.0 > 2.0 && domain.0 < 12.0, "{domain:?}");
    let (min, max) = trimming.region().bounds();
    assert!((min.x - 12.0).abs() < 1e-6 && (max.x - 16.0).abs() < 1e-6, "{min} {max}");
    for k in 0..=40 {
        let u = domain.0 + 14.0 * f64::from(k) / 40.0;
        let wrapped = if u > 14.0 { u - 14.0 } else { u };
        assert!(built.surface.point(u, 0.3).distance(surface.point(wrapped, 0.3)) < 1e-14);
    }
}

/// The area of the tube between two u and v = 0.25 to 0.75.
fn area_of(surface: &NurbsSurface, from: f64, to: f64) -> f64 {
    let corners = [(from, 0.25), (to, 0.25), (to, 0.75), (from, 0.75), (from, 0.25)].map(|(u, v)| DVec2::new(u, v));
    let sides = corners.windows(2).map(|pair| PlaneCurve::line(pair[0], pair[1]).expect("a line")).collect();
    area(surface, &[sides])
}

#[test]
fn a_carrier_far_larger_than_its_face_is_cut_down_or_kept() {
    // a plane whose frame is a kilometre away, and a spline sheet a thousand times as large as its face
    let far = about(DVec3::Z, DVec3::new(1e6, -2e6, 0.0), DVec3::new(3.0, 4.0, 0.0));
    let mut sketch = Sketch::on(SourceSurface::Plane(far));
    let rim = sketch.arc(Frame::WORLD, 1.0, (0.0, TAU));
    let (built, _, area) = sketch.bound(&[(rim, true)]).built(1, 0);
    assert_near(area, PI);
    assert!(built.surface.control_box().diagonal() < 4.5);
    let sheet = || {
        let grid = |k: i32| 500.0 * f64::from(k);
        let points =
            (-2..=2).map(|i| (-2..=2).map(|j| DVec3::new(grid(i), grid(j), f64::from(i * j))).collect()).collect();
        let knots = vec![0.0, 0.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0, 1.0];
        NurbsSurface::new((3, 3), (knots.clone(), knots), points, None).expect("a sheet")
    };
    let mut sketch = Sketch::on(SourceSurface::Nurbs(sheet()));
    let uv = [(0.5, 0.5), (0.501, 0.5), (0.501, 0.501), (0.5, 0.501)];
    let iso = |k: usize| {
        let (a, b) = (uv[k], uv[(k + 1) % 4]);
        let points: Vec<DVec3> = (0..=8)
            .map(|s| {
                let s = f64::from(s) / 8.0;
                sheet().point(a.0 + s * (b.0 - a.0), a.1 + s * (b.1 - a.1))
            })
            .collect();
        perpend::kernel::curve_through(&points, 3, perpend::kernel::Spacing::ChordLength).expect("a curve")
    };
    let uses: Vec<(usize, bool)> = (0..4).map(|k| (sketch.nurbs(iso(k)), true)).collect();
    let (built, trimming, _) = sketch.bound(&uses).built(1, 0);
    assert_eq!(built.surface, sheet());
    let (min, max) = trimming.region().bounds();
    assert!(
        (min - DVec2::splat(0.5)).abs().max_element() < 1e-8 && (max - DVec2::splat(0.501)).abs().max_element() < 1e-8
    );
}

#[test]
fn trims_that_leave_the_domain_by_a_hair_end_at_its_edge() {
    let points = vec![vec![DVec3::ZERO, DVec3::Y], vec![DVec3::X, DVec3::new(1.0, 1.0, 0.3)]];
    let knots = vec![0.0, 0.0, 1.0, 1.0];
    let sheet = NurbsSurface::new((1, 1), (knots.clone(), knots), points, None).expect("a sheet");
    let mut sketch = Sketch::on(SourceSurface::Nurbs(sheet.clone()));
    let beyond = 6e-4;
    let corners = [
        DVec3::new(-beyond, 0.0, 0.0),
        DVec3::new(1.0 + beyond, 0.0, 0.0),
        DVec3::new(1.0 + beyond, 1.0, 0.3),
        DVec3::new(-beyond, 1.0, 0.0),
    ];
    let uses: Vec<(usize, bool)> = (0..4).map(|k| (sketch.line(corners[k], corners[(k + 1) % 4]), true)).collect();
    let (built, trimming, _) = sketch.bound(&uses).built(1, 0);
    assert_eq!(trimming.region().bounds(), (DVec2::ZERO, DVec2::ONE));
    assert!(built.tolerance >= beyond && built.tolerance < 3.0 * beyond, "{}", built.tolerance);
}

#[test]
fn revolutions_and_extrusions_are_as_large_as_their_face() {
    // a paraboloid-like cup from a spline profile, whole, between two parallels
    let profile = NurbsCurve::new(
        2,
        vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0],
        vec![DVec3::new(1.0, 0.0, 0.0), DVec3::new(3.0, 0.0, 1.0), DVec3::new(2.0, 0.0, 4.0)],
        None,
    )
    .expect("a profile");
    let (low, high) = (profile.point(0.25), profile.point(0.75));
    let turned = |sweep: Option<(f64, f64)>| {
        let mut sketch = Sketch::on(SourceSurface::Revolution {
            profile: SourceCurve::Nurbs(profile.clone()),
            point: DVec3::ZERO,
            axis: DVec3::Z,
        });
        match sweep {
            None => {
                let bottom = sketch.arc(raised(low.z), low.x, (2.0, 2.0 + TAU));
                let top = sketch.arc(raised(high.z), high.x, (0.0, TAU));
                sketch.bound(&[(bottom, true)]).bound(&[(top, false)])
            }
            Some((from, to)) => {
                let part = profile.split(0.25).expect("inside").1.split(0.75).expect("inside").0;
                let at = |angle: f64| part.transformed(&glam::DAffine3::from_rotation_z(angle)).expect("a turn");
                let bottom = sketch.arc(raised(low.z), low.x, (from, to));
                let top = sketch.arc(raised(high.z), high.x, (from, to));
                let (left, right) = (sketch.nurbs(at(from)), sketch.nurbs(at(to)));
                sketch.bound(&[(bottom, true), (right, true), (top, false), (left, false)])
            }
        }
    };
    let (whole, _, all) = turned(None).built(1, 0);
    assert!(whole.reversed && whole.shape.is_none());
    assert!((whole.surface.domain(Direction::U).0 - 0.25).abs() < 1e-9);
    for (from, to) in [(1.0, 2.5), (5.0, 8.0), (-3.0, 2.0)] {
        let (_, _, part) = turned(Some((from, to))).built(1, 0);
        assert_near(part, all * (to - from) / TAU);
    }
    // a tube of a circle's profile, and a wall of a line's
    let direction = DVec3::new(0.0, 0.3, 2.0);
    let mut sketch = Sketch::on(SourceSurface::Extrusion {
        profile: SourceCurve::Circle { frame: Frame::WORLD, radius: 1.0 },
        direction,
    });
    let bottom = sketch.arc(raised(0.0), 1.0, (0.0, TAU));
    let moved = Frame { centre: direction, ..Frame::WORLD };
    let top = sketch.arc(moved, 1.0, (1.0, 1.0 + TAU));
    let (built, _, area) = sketch.bound(&[(bottom, true)]).bound(&[(top, false)]).built(1, 0);
    // the length of an ellipse's arc: the circle seen along the direction
    let around: f64 = (0..4000)
        .map(|k| {
            let t = TAU * (f64::from(k) + 0.5) / 4000.0;
            DVec3::new(-t.sin(), t.cos(), 0.0).cross(direction).length() * TAU / 4000.0
        })
        .sum();
    assert_near(area, around);
    assert!(!built.reversed);
    let mut sketch = Sketch::on(SourceSurface::Extrusion {
        profile: SourceCurve::Line { point: DVec3::new(-50.0, 0.0, 0.0), direction: DVec3::X },
        direction: DVec3::Z,
    });
    let rim = sketch.arc(about(-DVec3::Y, DVec3::new(2.0, 0.0, 7.0), DVec3::X), 1.0, (0.0, TAU));
    let (_, _, area) = sketch.bound(&[(rim, true)]).built(1, 0);
    assert_near(area, PI);
}

#[test]
fn closed_curves_give_edges_over_their_own_seam() {
    let whole = Circle::whole(Frame::WORLD, 1.0).and_then(|circle| circle.to_nurbs()).expect("a circle");
    let at = |angle: f64| DVec3::new(angle.cos(), angle.sin(), 0.0);
    for same_sense in [true, false] {
        let (start, end) = if same_sense { (at(5.0), at(1.0)) } else { (at(1.0), at(5.0)) };
        for curve in [SourceCurve::Nurbs(whole.clone()), SourceCurve::Circle { frame: Frame::WORLD, radius: 1.0 }] {
            let edge = SourceEdge { entity: 7, curve, start, end, closed: false, same_sense };
            let cut = edge_curve(&edge, TOLERANCE).expect("an edge");
            let (a, b) = cut.domain();
            assert!(cut.point(a).distance(start) < 1e-9 && cut.point(b).distance(end) < 1e-9);
            assert!(cut.point(0.5 * (a + b)).x > 0.7, "the short way, over angle 0");
        }
    }
    let line = SourceCurve::Line { point: DVec3::ZERO, direction: DVec3::X };
    let backward =
        SourceEdge { entity: 7, curve: line, start: DVec3::X, end: DVec3::ZERO, closed: false, same_sense: true };
    assert!(matches!(edge_curve(&backward, TOLERANCE), Err(FaceError::Edge { entity: 7, .. })));
    let ok = SourceEdge { same_sense: false, ..backward };
    let expected = Line::new(DVec3::X, DVec3::ZERO).and_then(|line| line.to_nurbs()).expect("a line");
    assert_eq!(edge_curve(&ok, TOLERANCE).expect("an edge").control_points(), expected.control_points());
}

#[test]
fn a_torus_that_passes_its_axis_is_one_of_its_shells() {
    let (major, minor) = (1.0, 2.0_f64);
    let meets = (-major / minor).acos();
    // the outer shell between two parallels, then the inner one
    let ring = |angle: f64| (raised(minor * angle.sin()), (major + minor * angle.cos()).abs());
    for (from, to, sign) in [(-1.0, 1.5, 1.0), (meets + 0.2, TAU - meets - 0.4, -1.0)] {
        let mut sketch = Sketch::on(SourceSurface::Torus { frame: Frame::WORLD, major, minor });
        let ((a, r), (b, s)) = (ring(from), ring(to));
        let first = sketch.arc(a, r, (0.0, TAU));
        let second = sketch.arc(b, s, (1.0, 1.0 + TAU));
        let (_, _, area) = sketch.bound(&[(first, true)]).bound(&[(second, false)]).built(1, 0);
        assert_near(area, sign * TAU * minor * (major * (to - from) + minor * (to.sin() - from.sin())));
    }
}

/// Numbers in `[0, 1)` from a seed.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

#[test]
fn whatever_a_file_says_is_built_or_refused() {
    let mut numbers = Numbers(7);
    let surfaces = [
        cylinder(),
        SourceSurface::Plane(Frame::WORLD),
        SourceSurface::Cone { frame: Frame::WORLD, radius: 1.0, half_angle: 0.6 },
        SourceSurface::Sphere { frame: Frame::WORLD, radius: 2.0 },
        SourceSurface::Torus { frame: Frame::WORLD, major: 2.0, minor: 1.0 },
        SourceSurface::Torus { frame: Frame::WORLD, major: 1.0, minor: 2.0 },
        SourceSurface::Nurbs(tube()),
        SourceSurface::Revolution {
            profile: SourceCurve::Line { point: DVec3::X, direction: DVec3::new(0.3, 0.1, 1.0) },
            point: DVec3::ZERO,
            axis: DVec3::Z,
        },
        SourceSurface::Extrusion {
            profile: SourceCurve::Circle { frame: Frame::WORLD, radius: 2.0 },
            direction: DVec3::Z,
        },
    ];
    let (mut built, mut refused) = (0, 0);
    for round in 0..3000 {
        let mut sketch = Sketch::on(surfaces[round % surfaces.len()].clone());
        sketch.same_sense = numbers.next() < 0.5;
        // edges between places of a coarse lattice, so that many lie on axes, poles and one another
        let mut place = || DVec3::from_array([0; 3].map(|_| (numbers.next() * 5.0).floor() - 2.0));
        let corners: Vec<DVec3> = (0..4).map(|_| place()).collect();
        for _ in 0..1 + (numbers.next() * 3.0) as usize {
            let count = 1 + (numbers.next() * 4.0) as usize;
            let uses: Vec<(usize, bool)> = (0..count)
                .map(|k| {
                    let (a, b) = (corners[k % 4], corners[(k + 1) % count % 4]);
                    let frame = raised((numbers.next() * 4.0).floor() - 2.0);
                    let edge = match (numbers.next() * 3.0) as usize {
                        0 => sketch.line(a, b),
                        1 => sketch.arc(frame, 0.5 + 2.0 * numbers.next(), (0.0, TAU)),
                        _ => sketch.edge(SourceCurve::Circle { frame, radius: 2.0 }, a, b),
                    };
                    (edge, numbers.next() < 0.5)
                })
                .collect();
            sketch = sketch.bound(&uses);
        }
        // a file that states a tolerance as large as its faces
        match sketch.build_within(1.0) {
            Ok(face) => {
                built += 1;
                let points = face.loops.iter().flat_map(|one| &one.curves).flat_map(|(curve, _)| &curve.points);
                assert!(points.into_iter().all(|point| point.is_finite()));
            }
            Err(_) => refused += 1,
        }
    }
    assert!(built > 100 && refused > 100, "{built} built, {refused} refused");
}

#[test]
fn an_open_loop_and_an_unbounded_face_are_refused() {
    let mut sketch = Sketch::on(SourceSurface::Plane(Frame::WORLD));
    let uses = [(DVec3::ZERO, DVec3::X), (DVec3::X, DVec3::Y), (0.5 * DVec3::Y, DVec3::ZERO)];
    let uses: Vec<(usize, bool)> = uses.iter().map(|(a, b)| (sketch.line(*a, *b), true)).collect();
    assert!(matches!(sketch.bound(&uses).build(), Err(FaceError::Open { .. })));
    let mut sketch = Sketch::on(cylinder());
    let bottom = sketch.arc(Frame::WORLD, 2.0, (0.0, TAU));
    assert_eq!(sketch.bound(&[(bottom, true)]).build().err(), Some(FaceError::Unbounded));
    assert_eq!(Sketch::on(SourceSurface::Plane(Frame::WORLD)).build().err(), Some(FaceError::Unbounded));
}

/// A square of this side in a plane across the z axis.
fn square(surface: SourceSurface, side: f64, height: f64) -> Sketch {
    let mut sketch = Sketch::on(surface);
    let at = |k: usize| DVec3::new([0.0, side, side, 0.0][k % 4], [0.0, 0.0, side, side][k % 4], height);
    let uses: Vec<(usize, bool)> = (0..4).map(|k| (sketch.line(at(k), at(k + 1)), true)).collect();
    sketch.bound(&uses)
}

#[test]
fn edges_far_off_their_surface_are_refused() {
    let plane = || SourceSurface::Plane(Frame::WORLD);
    let Err(FaceError::Off { edge: 100, off, .. }) = square(plane(), 10.0, 3.0).build() else {
        panic!("edges 3 off a plane")
    };
    assert_near(off, 3.0);
    let near = square(plane(), 10.0, 0.1).build().expect("edges a hundredth of the face off are told of");
    assert!(near.tolerance >= 0.1, "{}", near.tolerance);
    // one corner alone
    let mut sketch = Sketch::on(plane());
    let corners = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.3), DVec3::Y];
    let uses: Vec<(usize, bool)> = (0..4).map(|k| (sketch.line(corners[k], corners[(k + 1) % 4]), true)).collect();
    let Err(FaceError::Off { edge: 101, .. }) = sketch.bound(&uses).build() else { panic!("a spike") };
    // a vertex off its edge's line
    let mut sketch = Sketch::on(plane());
    let line = SourceCurve::Line { point: DVec3::ZERO, direction: DVec3::X };
    sketch.edge(line, DVec3::ZERO, DVec3::new(1.0, 0.0, 0.3));
    let error = edge_curve(&sketch.edges[0], TOLERANCE).expect_err("a vertex in the air").to_string();
    assert!(error.contains("#100") && error.contains("off its vertices"), "{error}");
}

/// A bicubic with these control points and weights in its middle, about over the unit square.
fn patch(height: f64, weight: f64) -> SourceSurface {
    let knots = vec![0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0];
    let is_middle = |i: usize, j: usize| (i, j) == (1, 2);
    let point =
        |i: usize, j: usize| DVec3::new(i as f64 / 3.0, j as f64 / 3.0, if is_middle(i, j) { height } else { 0.0 });
    let net = (0..4).map(|i| (0..4).map(|j| point(i, j)).collect()).collect();
    let weights = (0..4).map(|i| (0..4).map(|j| if is_middle(i, j) { weight } else { 1.0 }).collect()).collect();
    SourceSurface::Nurbs(NurbsSurface::new((3, 3), (knots.clone(), knots), net, Some(weights)).expect("valid"))
}

#[test]
fn numbers_beyond_all_digits_are_refused() {
    square(patch(0.2, 2.0), 1.0, 0.0).build().expect("a face between the borders of its surface");
    assert_eq!(square(patch(0.2, 1e70), 1.0, 0.0).build().err(), Some(FaceError::Weights(1e70)));
    assert_eq!(square(patch(0.2, 1e-70), 1.0, 0.0).build().err(), Some(FaceError::Weights(1e70)));
    assert_eq!(square(patch(1e70, 2.0), 1.0, 0.0).build().err(), Some(FaceError::TooFar(1e70)));
    // of an edge, it is the edge that is named
    let mut sketch = Sketch::on(SourceSurface::Plane(Frame::WORLD));
    let points = vec![DVec3::ZERO, DVec3::new(1.0, 1.0, 0.0), 2.0 * DVec3::X];
    let knots = vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0];
    let arc = sketch.nurbs(NurbsCurve::new(2, knots, points, Some(vec![1.0, 1e70, 1.0])).expect("valid"));
    let back = sketch.line(2.0 * DVec3::X, DVec3::ZERO);
    assert!(matches!(sketch.bound(&[(arc, true), (back, true)]).build(), Err(FaceError::Edge { entity: 100, .. })));
}

#[test]
fn a_face_whose_edges_cost_too_much_is_given_up() {
    // thousands of spans in the air above a bump: each of their places asks for a projection of its own
    let mut sketch = Sketch::on(patch(0.9, 2.0));
    let count = 20_000;
    let at = |i: i32| DVec3::new(f64::from(i % 7) / 7.0, f64::from(i % 5) / 5.0, 1.0 + f64::from(i % 3));
    let points: Vec<DVec3> = (0..count).map(at).collect();
    let inner = (0..count).map(f64::from);
    let knots = [0.0].into_iter().chain(inner).chain([f64::from(count - 1)]).collect();
    let edge = sketch.nurbs(NurbsCurve::new(1, knots, points, None).expect("valid"));
    assert_eq!(sketch.bound(&[(edge, true)]).build().err(), Some(FaceError::TooHard));
}
