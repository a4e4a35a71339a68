//! Every kind of irregularity: an entity that was built to have it, and a neighbour that was built not to.

use perpend_kernel::glam::DVec3;
use perpend_kernel::{Cone, Definition, Direction, Frame, NurbsCurve, NurbsSurface};
use perpend_knowledge::{AcquireOptions, Basis, Irregularity, Item, ParameterPoint, Representation, acquire};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

fn known(definition: impl Into<Definition>) -> Representation {
    acquire(&definition.into(), &AcquireOptions::default())
}

fn irregular(definition: impl Into<Definition>) -> Vec<Item<Irregularity>> {
    known(definition).irregularities.expect("acquired")
}

/// Those of one kind.
fn of_kind(all: &[Item<Irregularity>], kind: &str) -> Vec<Irregularity> {
    all.iter().map(|item| item.value).filter(|value| format!("{value:?}").starts_with(kind)).collect()
}

fn points(points: &[[f64; 3]]) -> Vec<DVec3> {
    points.iter().map(|p| DVec3::from_array(*p)).collect()
}

fn bezier(control: &[[f64; 3]]) -> NurbsCurve {
    let p = control.len() - 1;
    let knots = [vec![0.0; p + 1], vec![1.0; p + 1]].concat();
    NurbsCurve::new(p, knots, points(control), None).expect("valid")
}

fn spline(degree: usize, inner: &[f64], control: &[[f64; 3]]) -> NurbsCurve {
    let knots = [&vec![0.0; degree + 1], inner, &vec![1.0; degree + 1]].concat();
    NurbsCurve::new(degree, knots, points(control), None).expect("valid")
}

/// A Bézier surface, rows along u.
fn patch(rows: &[&[[f64; 3]]]) -> NurbsSurface {
    let ends = |degree: usize| [vec![0.0; degree + 1], vec![1.0; degree + 1]].concat();
    let (p, q) = (rows.len() - 1, rows[0].len() - 1);
    let net = rows.iter().map(|row| points(row)).collect();
    NurbsSurface::new((p, q), (ends(p), ends(q)), net, None).expect("valid")
}

#[test]
fn cusps() {
    // (t², t³) about the middle, and the same opened by a straight motion
    let cusp = |open: f64| {
        let [x, y] = [[0.25, -1.0 / 12.0, -1.0 / 12.0, 0.25], [-0.125, 0.125, -0.125, 0.125]];
        bezier(&std::array::from_fn::<_, 4, _>(|k| [x[k], y[k] + open * k as f64 / 3.0, 0.0]))
    };
    let found = irregular(cusp(0.0));
    let cusps = of_kind(&found, "Cusp");
    let [Irregularity::Cusp { at: ParameterPoint::Curve(u), angle }] = cusps.as_slice() else { panic!("{found:?}") };
    assert!((u - 0.5).abs() < 1e-9 && (angle - PI).abs() < 1e-2, "{found:?}");
    assert!(matches!(
        of_kind(&found, "VanishingDerivative").as_slice(),
        [Irregularity::VanishingDerivative { at: ParameterPoint::Curve(_), speed, .. }] if *speed < 1e-9
    ));
    assert!(found.iter().any(|item| matches!(item.basis, Basis::Measured { error } if error > 0.0 && error < 0.1)));
    for open in [1e-3, -1e-3, 0.1] {
        let part = known(cusp(open));
        let found = part.irregularities.expect("acquired");
        assert_eq!(of_kind(&found, "Cusp"), [], "{open}: {found:?}");
        assert_eq!(of_kind(&found, "Vanishing"), [], "{open}: {found:?}");
        // and that is proven: the least speed is above 0
        assert!(part.speed.expect("acquired")[0].value.min > 0.0, "{open}");
    }
}

#[test]
fn stops_that_are_no_cusps() {
    let along = |x: [f64; 4]| irregular(bezier(&x.map(|x| [x, 0.0, 0.0])));
    // (2t - 1)³: it stops in the middle and goes on
    let found = along([-1.0, 1.0, -1.0, 1.0]);
    assert_eq!((of_kind(&found, "VanishingDerivative").len(), of_kind(&found, "Cusp").len()), (1, 0), "{found:?}");
    // it turns back, twice
    let found = along([0.0, 3.0, -2.0, 1.0]);
    assert_eq!((of_kind(&found, "VanishingDerivative").len(), of_kind(&found, "Cusp").len()), (2, 2), "{found:?}");
    let found = along([0.0, 1.0, 2.0, 4.0]);
    assert_eq!((of_kind(&found, "VanishingDerivative").len(), of_kind(&found, "Cusp").len()), (0, 0), "{found:?}");
    let found = irregular(bezier(&[[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]]));
    let stops = of_kind(&found, "VanishingDerivative");
    assert!(
        matches!(stops.as_slice(), [Irregularity::VanishingDerivative { at: ParameterPoint::Curve(u), .. }] if u.abs() < 1e-9),
        "{found:?}"
    );
    assert_eq!(of_kind(&found, "Cusp"), [], "an end does not turn back");
    let found = irregular(bezier(&[[0.0, 0.0, 0.0], [1e-3, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]]));
    assert_eq!(of_kind(&found, "VanishingDerivative"), [], "{found:?}");
}

#[test]
fn creases() {
    let roof = |y: f64| {
        spline(2, &[0.5, 0.5], &[[0.0, 0.0, 0.0], [1.0, y, 0.0], [2.0, 0.0, 0.0], [3.0, -1.0, 0.0], [4.0, 0.0, 0.0]])
    };
    let found = irregular(roof(1.25));
    let creases = of_kind(&found, "Crease");
    let [Irregularity::Crease { at: 0.5, angle, .. }] = creases.as_slice() else { panic!("{found:?}") };
    assert!((angle - (1.25_f64.atan() - 1.0_f64.atan())).abs() < 1e-12, "{angle}");
    let smooth = known(roof(1.0));
    assert_eq!(of_kind(&smooth.irregularities.expect("acquired"), "Crease"), []);
    let breaks = smooth.breaks.expect("acquired");
    assert_eq!(breaks.iter().map(|item| (item.value.c, item.value.g)).collect::<Vec<_>>(), [(1, 1)], "{breaks:?}");
    assert!(matches!(breaks[0].basis, Basis::Proved { gap } if gap < 1e-12));

    // a surface over both profiles: the crease is proven along the whole line
    let fold = |y: f64| {
        let rows = [[0.0, 0.0], [1.0, y], [2.0, 0.0], [3.0, -1.0], [4.0, 0.0]];
        let net = rows.iter().map(|[x, z]| points(&[[*x, 0.0, *z], [*x, 1.0, *z + 0.1 * x]])).collect();
        let u = vec![0.0, 0.0, 0.0, 0.5, 0.5, 1.0, 1.0, 1.0];
        NurbsSurface::new((2, 1), (u, vec![0.0, 0.0, 1.0, 1.0]), net, None).expect("valid")
    };
    let found = irregular(fold(1.25));
    let crease = found.iter().find(|item| matches!(item.value, Irregularity::Crease { .. })).expect("a crease");
    let Irregularity::Crease { direction: Direction::U, at: 0.5, angle } = crease.value else { panic!("{crease:?}") };
    assert!(angle > 0.05 && angle < 0.2 && matches!(crease.basis, Basis::Proved { gap } if gap < 0.01), "{crease:?}");
    let smooth = known(fold(1.0));
    assert_eq!(of_kind(&smooth.irregularities.expect("acquired"), "Crease"), []);
    let breaks = smooth.breaks.expect("acquired");
    assert_eq!((breaks[0].value.c, breaks[0].value.g), (1, 1), "{breaks:?}");
}

#[test]
fn a_corner_of_equal_tangents_is_geometrically_smooth() {
    // the second half runs half as fast
    let curve =
        spline(2, &[0.5, 0.5], &[[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [2.0, 1.0, 0.0], [2.5, 1.0, 0.0], [3.0, 0.0, 0.0]]);
    let breaks = known(curve).breaks.expect("acquired");
    assert_eq!(breaks.iter().map(|b| (b.value.c, b.value.g)).collect::<Vec<_>>(), [(0, 1)], "{breaks:?}");
    // a parabola in two halves of different speed: of one curvature at the knot
    let halves = spline(
        2,
        &[0.25, 0.25],
        &[[-1.0, 1.0, 0.0], [-0.5, 0.0, 0.0], [0.0, 0.0, 0.0], [0.5, 0.0, 0.0], [1.0, 1.0, 0.0]],
    );
    let breaks = known(halves).breaks.expect("acquired");
    assert_eq!(breaks.iter().map(|b| (b.value.c, b.value.g)).collect::<Vec<_>>(), [(0, 2)], "{breaks:?}");
    assert!(matches!(breaks[0].basis, Basis::Proved { gap } if gap < 1e-9 && gap == breaks[0].value.g_within));
}

#[test]
fn a_knot_that_can_be_removed_is_no_break() {
    let curve = bezier(&[[0.0, 0.0, 0.0], [1.0, 2.0, 0.0], [3.0, 2.0, 1.0], [4.0, 0.0, 0.0]]);
    let finer = curve.insert_knot(0.3, 3).expect("an interior knot");
    assert_eq!(known(finer).breaks.map(|breaks| breaks.len()), Some(0));
}

#[test]
fn seams_of_curves() {
    let closed = |x: f64, y: f64| {
        spline(
            2,
            &[0.25, 0.5, 0.75],
            &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 3.0, 0.0], [x, y, 0.0], [0.0, 0.0, 0.0]],
        )
    };
    let part = known(closed(-1.0, 0.0));
    let seams = of_kind(part.irregularities.as_ref().expect("acquired"), "Seam");
    assert_eq!(seams, [Irregularity::Seam { direction: Direction::U, gap: 0.0, order: Some((1, 1)) }]);
    assert_eq!(part.periodic.map(|item| item.value), Some((true, false)));
    // the same speed no longer, the same tangent still
    let part = known(closed(-2.0, 0.0));
    let seams = of_kind(part.irregularities.as_ref().expect("acquired"), "Seam");
    assert_eq!(seams, [Irregularity::Seam { direction: Direction::U, gap: 0.0, order: Some((0, 1)) }]);
    assert_eq!(
        (part.closed.map(|item| item.value.0), part.periodic.map(|item| item.value.0)),
        (Some(true), Some(false))
    );
    // a corner at the seam
    let seams = of_kind(&irregular(closed(-1.0, 1.0)), "Seam");
    assert_eq!(seams, [Irregularity::Seam { direction: Direction::U, gap: 0.0, order: Some((0, 0)) }]);
    // open by a millionth
    let open = spline(2, &[0.5], &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 1e-6, 0.0]]);
    let part = known(open);
    assert_eq!(of_kind(part.irregularities.as_ref().expect("acquired"), "Seam"), []);
    assert_eq!(part.closed.map(|item| item.value), Some((false, false)));
}

#[test]
fn seams_of_surfaces() {
    let cone = |sweep: f64| {
        Cone::new(Frame::WORLD, (0.5, 1.0), (0.0, 2.0), (0.0, sweep)).expect("valid").to_nurbs().expect("valid")
    };
    let part = known(cone(TAU));
    let irregularities = part.irregularities.expect("acquired");
    let seam = irregularities.iter().find(|item| matches!(item.value, Irregularity::Seam { .. })).expect("a seam");
    assert_eq!(seam.value, Irregularity::Seam { direction: Direction::V, gap: 0.0, order: Some((1, 2)) });
    assert!(matches!(seam.basis, Basis::Proved { gap } if gap < 1e-8), "{seam:?}");
    assert_eq!(part.closed.map(|item| item.value), Some((false, true)));
    assert_eq!(part.periodic.map(|item| item.value), Some((false, true)));
    let part = known(cone(1.75 * PI));
    assert_eq!(of_kind(&part.irregularities.expect("acquired"), "Seam"), []);
    assert_eq!(part.closed.map(|item| item.value), Some((false, false)));
}

#[test]
fn poles() {
    let cone = |low: f64| {
        Cone::new(Frame::WORLD, (low, 1.0), (0.0, 2.0), (0.0, FRAC_PI_2)).expect("valid").to_nurbs().expect("valid")
    };
    let found = irregular(cone(0.0));
    assert!(
        matches!(of_kind(&found, "Pole").as_slice(), [Irregularity::Pole { direction: Direction::U, at: 0.0, extent }] if *extent < 1e-15),
        "{found:?}"
    );
    assert!(found.iter().any(|item| matches!(
        item.value,
        Irregularity::VanishingDerivative { direction: Direction::V, at: ParameterPoint::Iso(Direction::U, 0.0), .. }
    )));
    assert_eq!(of_kind(&found, "VanishingNormal"), [], "a pole says so itself");
    let found = irregular(cone(1e-3));
    assert_eq!((of_kind(&found, "Pole"), of_kind(&found, "Vanishing")), (vec![], vec![]), "{found:?}");
}

#[test]
fn vanishing_normals_at_the_boundary() {
    // (u + v, u² + open u, v²): at the corner (0, 0) both derivatives point along x
    let corner = |open: f64| {
        let row = |i: usize| {
            let y = [0.0, 0.5 * open, 1.0 + open][i];
            [0.0, 0.0, 1.0].iter().enumerate().map(|(j, z)| [0.5 * (i + j) as f64, y, *z]).collect::<Vec<_>>()
        };
        let (a, b, c) = (row(0), row(1), row(2));
        patch(&[&a, &b, &c])
    };
    let found = irregular(corner(0.0));
    let [Irregularity::VanishingNormal { at: ParameterPoint::Surface(u, v), area }] =
        of_kind(&found, "VanishingNormal")[..]
    else {
        panic!("{found:?}")
    };
    assert!(u < 1e-9 && v < 1e-9 && area < 1e-9, "{found:?}");
    assert_eq!(of_kind(&irregular(corner(0.1)), "Vanishing"), []);
    // a whole edge on which S_u vanishes, and the same edge opened
    let edge = |x: f64| {
        patch(&[
            &[[0.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            &[[x, 0.0, 0.0], [x, 1.0, 0.0]],
            &[[1.0, 0.0, 1.0], [1.0, 1.0, 1.0]],
        ])
    };
    let found = irregular(edge(0.0));
    let iso = ParameterPoint::Iso(Direction::U, 0.0);
    assert!(
        matches!(of_kind(&found, "VanishingNormal")[..], [Irregularity::VanishingNormal { at, .. }] if at == iso),
        "{found:?}"
    );
    assert!(
        matches!(of_kind(&found, "VanishingDerivative")[..], [Irregularity::VanishingDerivative { direction: Direction::U, at, .. }] if at == iso),
        "{found:?}"
    );
    assert_eq!(of_kind(&found, "Cusp"), [], "the normal is the same beside it");
    assert_eq!(of_kind(&irregular(edge(0.01)), "Vanishing"), []);
}

#[test]
fn vanishing_normals_inside() {
    // (t², t³) drawn along y: a cuspidal edge in the middle; and the same opened
    let edge = |open: f64| {
        let [x, z] = [[0.25, -1.0 / 12.0, -1.0 / 12.0, 0.25], [-0.125, 0.125, -0.125, 0.125]];
        let row = |k: usize| [[x[k], 0.0, z[k] + open * k as f64 / 3.0], [x[k], 1.0, z[k] + open * k as f64 / 3.0]];
        let (a, b, c, d) = (row(0), row(1), row(2), row(3));
        patch(&[&a, &b, &c, &d])
    };
    let found = irregular(edge(0.0));
    assert!(!of_kind(&found, "VanishingNormal").is_empty(), "{found:?}");
    for value in of_kind(&found, "VanishingNormal") {
        let Irregularity::VanishingNormal { at: ParameterPoint::Surface(u, _), area } = value else {
            panic!("{value:?}")
        };
        assert!((u - 0.5).abs() < 1e-6 && area < 1e-8, "{value:?}");
    }
    let cusps = of_kind(&found, "Cusp");
    assert!(
        !cusps.is_empty() && cusps.iter().all(|cusp| matches!(cusp, Irregularity::Cusp { angle, .. } if *angle > 3.0)),
        "{found:?}"
    );
    let found = irregular(edge(0.2));
    assert_eq!((of_kind(&found, "Vanishing"), of_kind(&found, "Cusp")), (vec![], vec![]), "{found:?}");
    // the umbrella (a b, a, b²), pinched where both are 0
    let umbrella = |from: f64| {
        let row = |a: f64| [[-a, a, 1.0], [0.0, a, -1.0], [a, a, 1.0]];
        let (start, end) = (row(from), row(1.0));
        patch(&[&start, &end])
    };
    let found = irregular(umbrella(-1.0));
    let pinch = of_kind(&found, "VanishingNormal");
    assert!(
        matches!(pinch[..], [Irregularity::VanishingNormal { at: ParameterPoint::Surface(u, v), area }]
            if (u - 0.5).abs() < 1e-9 && (v - 0.5).abs() < 1e-9 && area < 1e-9),
        "{found:?}"
    );
    assert!(matches!(of_kind(&found, "Cusp")[..], [Irregularity::Cusp { angle, .. }] if angle > 2.5), "{found:?}");
    let found = irregular(umbrella(0.25));
    assert_eq!((of_kind(&found, "Vanishing"), of_kind(&found, "Cusp")), (vec![], vec![]), "{found:?}");
}

#[test]
fn loops() {
    let looped = |x: f64| bezier(&[[0.0, 0.0, 0.0], [x, 2.0, 0.0], [1.0 - x, 2.0, 0.0], [1.0, 0.0, 0.0]]);
    let found = irregular(looped(3.0));
    let loops = of_kind(&found, "Loop");
    let [Irregularity::Loop { from, to, gap }] = loops.as_slice() else { panic!("{found:?}") };
    assert!((from + to - 1.0).abs() < 1e-9 && *gap < 1e-12, "{loops:?}");
    let curve = looped(3.0);
    assert!(curve.point(*from).distance(curve.point(*to)) < 1e-12);
    assert_eq!(of_kind(&irregular(looped(0.9)), "Loop"), []);
    // in space the branches pass each other
    let apart = bezier(&[[0.0, 0.0, 0.0], [3.0, 2.0, 0.0], [-2.0, 2.0, 1e-3], [1.0, 0.0, 1e-3]]);
    assert_eq!(of_kind(&irregular(apart), "Loop"), []);
}

#[test]
fn inflections() {
    let s = |y: f64| bezier(&[[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [2.0, y, 0.0], [3.0, 0.0, 0.0]]);
    let found = irregular(s(-1.0));
    let item = found.iter().find(|item| matches!(item.value, Irregularity::Inflection { .. })).expect("an inflection");
    assert!(
        matches!(item.value, Irregularity::Inflection { at: ParameterPoint::Curve(u), curvature } if (u - 0.5).abs() < 1e-9 && curvature == 0.0)
    );
    assert!(matches!(item.basis, Basis::Proved { gap } if gap < 1e-9), "{item:?}");
    assert_eq!(of_kind(&irregular(s(1.0)), "Inflection"), []);
    // over a knot: one parabola up, one down, with one tangent
    let wave = |y: f64| {
        spline(
            2,
            &[0.5, 0.5],
            &[[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [2.0, 0.0, 0.0], [3.0, y, 0.0], [4.0, 0.0 + (y + 1.0), 0.0]],
        )
    };
    let found = irregular(wave(-1.0));
    let item = found.iter().find(|item| matches!(item.value, Irregularity::Inflection { .. })).expect("an inflection");
    let Irregularity::Inflection { at: ParameterPoint::Curve(0.5), curvature } = item.value else { panic!("{item:?}") };
    // y = x - x²/2 has curvature 1 / 2^1.5 where its slope is 1
    assert!((curvature - 1.0 / 8.0_f64.sqrt()).abs() < 1e-12 && item.basis == Basis::Proved { gap: 0.0 }, "{item:?}");
    // turned upwards again, there is a crease instead
    assert_eq!(of_kind(&irregular(wave(-1.5)), "Inflection"), []);
    // in space: the same S with a twist has no inflection
    let twisted = bezier(&[[0.0, 0.0, 0.0], [1.0, 1.0, 1.0], [2.0, -1.0, 1.0], [3.0, 0.0, 0.0]]);
    assert_eq!(of_kind(&irregular(twisted), "Inflection"), []);
}

#[test]
fn zero_curvature() {
    // y = x⁴: flat at 0, without a change of sign
    let flat = bezier(&[[-1.0, 1.0, 0.0], [-0.5, -1.0, 0.0], [0.0, 1.0, 0.0], [0.5, -1.0, 0.0], [1.0, 1.0, 0.0]]);
    let found = irregular(flat);
    let zeros = of_kind(&found, "ZeroCurvature");
    let [Irregularity::ZeroCurvature { from, to, curvature }] = zeros.as_slice() else { panic!("{found:?}") };
    assert!((from - 0.5).abs() < 1e-5 && from == to && *curvature < 1e-6, "{found:?}");
    // a straight stretch between two bends
    let bent = spline(2, &[0.5], &[[0.0, 1.0, 0.0], [0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [4.0, 1.0, 0.0]]);
    assert_eq!(of_kind(&irregular(bent), "ZeroCurvature"), [], "a quadratic spline bends in every span");
    let straight = spline(
        2,
        &[0.25, 0.25, 0.75, 0.75],
        &[
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [2.0, 0.0, 0.0],
            [3.0, 0.0, 0.0],
            [4.0, 0.0, 0.0],
            [4.0, 1.0, 0.0],
        ],
    );
    let item = irregular(straight)
        .into_iter()
        .find(|item| matches!(item.value, Irregularity::ZeroCurvature { .. }))
        .expect("a stretch");
    assert!(matches!(item.value, Irregularity::ZeroCurvature { from: 0.25, to: 0.75, .. }), "{item:?}");
    assert!(matches!(item.basis, Basis::Proved { gap } if gap < 1e-12), "{item:?}");
}

#[test]
fn near_knots_and_tiny_spans() {
    let curve = |apart: f64| {
        spline(
            3,
            &[0.5, 0.5 + apart],
            &[[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [2.0, 0.0, 0.0], [3.0, 1.0, 0.0], [4.0, 0.0, 0.0], [5.0, 1.0, 0.0]],
        )
    };
    let found = irregular(curve(1e-9));
    assert!(
        matches!(of_kind(&found, "NearKnots")[..], [Irregularity::NearKnots { at: 0.5, apart, .. }] if (apart - 1e-9).abs() < 1e-15),
        "{found:?}"
    );
    assert!(
        matches!(of_kind(&found, "TinySpan")[..], [Irregularity::TinySpan { at: 0.5, extent, .. }] if extent < 1e-7),
        "{found:?}"
    );
    let found = irregular(curve(1e-2));
    assert_eq!((of_kind(&found, "NearKnots"), of_kind(&found, "TinySpan")), (vec![], vec![]));
}
