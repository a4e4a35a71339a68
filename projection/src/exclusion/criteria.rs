//! What a control net proves about the nearest point of its segment (Selimovic 2006, §4).
//!
//! All criteria need end interpolation and positive weights, which segments have. They are stated here as they are proved; the paper's
//! theorem 4.4 as printed leaves out `i = 0` and mixes the indices of the mirrored sides.

use glam::DVec3;

use super::cone::Hodograph;
use super::segment::Segment;

/// What is left of a segment for one query.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Verdict {
    /// Nothing: a corner is its nearest point, and corners are looked at anyway.
    Corner,
    /// Nothing: its nearest points are on an edge beyond which the surface goes on, and comes nearer.
    Nothing,
    /// The edge at an end of a direction.
    Edge {
        /// The direction that is gone.
        direction: usize,
        /// 0 its start, 1 its end.
        end: usize,
    },
    /// All of it.
    Open,
}

/// The verdict of theorems 4.1, 4.2 and 4.4.
pub(super) fn verdict(segment: &Segment, p: DVec3) -> Verdict {
    if nearest_is_corner(segment, p) {
        return Verdict::Corner;
    }
    if segment.along().is_some() {
        return Verdict::Open;
    }
    let mut verdict = Verdict::Open;
    for direction in [0, 1] {
        let Some(hodograph) = Hodograph::of(segment, direction) else { continue };
        let Some(end) = nearest_edge(segment, &hodograph, direction, p) else { continue };
        if segment.goes_on[direction][end] && hodograph.is_regular(direction, end) {
            return Verdict::Nothing;
        }
        verdict = Verdict::Edge { direction, end };
    }
    verdict
}

/// Theorems 4.1 and 4.2, applied to the corner that is nearest to `p`: whether all other control points lie behind the plane through it
/// across the line of sight. Then no point of the segment is nearer than it.
///
/// Control points that coincide with the corner add nothing to the sum of the proof.
fn nearest_is_corner(segment: &Segment, p: DVec3) -> bool {
    let corners = segment.corners().map(|(_, corner)| corner);
    let nearest = corners[1..].iter().fold(corners[0], |nearest, corner| {
        if corner.distance_squared(p) < nearest.distance_squared(p) { *corner } else { nearest }
    });
    let sight = nearest - p;
    segment.points.iter().all(|point| (*point - nearest).dot(sight) > 0.0 || *point == nearest)
}

/// Theorem 4.4: the end of a direction on whose edge all nearest points lie, none of them critical.
///
/// Every way into the segment from the start leads along a vector of the tangent cone. Where `<P_i - p, w> > 0` for all control
/// points of that edge, its first included, and all `w` of the cone, it leads away from `p`. At the other end the sign turns: the
/// way into the segment is `-w`, so `<P_i - p, w> < 0`.
fn nearest_edge(segment: &Segment, hodograph: &Hodograph, direction: usize, p: DVec3) -> Option<usize> {
    let cone = hodograph.cone()?;
    let last = segment.count[direction] - 1;
    let on_edge = |line: usize| {
        let other = 1 - direction;
        (0..segment.count[other]).map(move |k| if direction == 0 { segment.at(line, k) } else { segment.at(k, line) })
    };
    if on_edge(0).all(|point| cone.is_ahead(point - p)) {
        Some(0)
    } else if on_edge(last).all(|point| cone.is_ahead(p - point)) {
        Some(1)
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hierarchy::double_double::Random;
    use crate::hierarchy::{Frame, Hierarchy, Workspace};
    use crate::query::{Query, QueryOptions};
    use perpend_kernel::{Definition, NurbsCurve, NurbsSurface};

    fn segment(definition: &Definition) -> (Frame, Segment) {
        let frame = Frame::of(definition);
        (frame, Segment::whole(definition, &frame))
    }

    fn clamped(degree: usize, inner: &[f64]) -> Vec<f64> {
        [vec![0.0; degree + 1], inner.to_vec(), vec![1.0; degree + 1]].concat()
    }

    fn random_knots(degree: usize, random: &mut Random) -> Vec<f64> {
        let count = random.next() as usize % 3;
        let mut inner: Vec<f64> = (0..count).map(|_| random.between(0.1, 0.9)).collect();
        inner.sort_by(f64::total_cmp);
        clamped(degree, &inner)
    }

    fn weights(count: usize, random: &mut Random) -> Vec<f64> {
        (0..count).map(|_| 10.0_f64.powf(random.between(-0.7, 0.7))).collect()
    }

    /// Curves and surfaces, polynomial and rational, with and without interior knots, bent enough to be wrong about.
    fn random_definition(round: usize, random: &mut Random) -> Definition {
        let rational = round % 2 == 1;
        let bend = random.between(0.05, 1.0);
        if round.is_multiple_of(3) {
            let degree = 1 + round / 6 % 5;
            let knots = random_knots(degree, random);
            let n = knots.len() - degree - 1;
            let points = (0..n).map(|i| DVec3::X * i as f64 + bend * random.point()).collect();
            let weights = rational.then(|| weights(n, random));
            return NurbsCurve::new(degree, knots, points, weights).expect("valid").into();
        }
        let (p, q) = (1 + round / 6 % 4, 1 + round / 24 % 3);
        let (u, v) = if rational {
            (clamped(p, &[]), clamped(q, &[]))
        } else {
            (random_knots(p, random), random_knots(q, random))
        };
        let (n, m) = (u.len() - p - 1, v.len() - q - 1);
        let at = |i: usize, j: usize, random: &mut Random| DVec3::new(i as f64, j as f64, 0.0) + bend * random.point();
        let points = (0..n).map(|i| (0..m).map(|j| at(i, j, random)).collect()).collect();
        let weights = rational.then(|| (0..n).map(|_| weights(m, random)).collect());
        NurbsSurface::new((p, q), (u, v), points, weights).expect("valid").into()
    }

    /// The points of a definition over a grid of parameters, in its own coordinates.
    fn samples(definition: &Definition, frame: &Frame, side: usize) -> Vec<Vec<DVec3>> {
        let share = |k: usize| k as f64 / (side - 1) as f64;
        match definition {
            Definition::NurbsCurve(curve) => (0..side).map(|k| vec![frame.enter(curve.point(share(k)))]).collect(),
            Definition::NurbsSurface(surface) => {
                (0..side).map(|i| (0..side).map(|j| frame.enter(surface.point(share(i), share(j)))).collect()).collect()
            }
        }
    }

    const ROUNDING: f64 = 1e-13;

    /// Each claim is stronger than the foot's being elsewhere: it speaks of every point.
    #[test]
    fn what_the_criteria_claim_holds_at_every_point() {
        let mut random = Random(3);
        let (mut corners, mut edges) = ([0; 2], [[[0; 2]; 2]; 2]);
        for round in 0..600 {
            let definition = random_definition(round, &mut random);
            let (frame, whole) = segment(&definition);
            let kind = usize::from(whole.rational);
            let grid = samples(&definition, &frame, 15);
            let last = grid.len() - 1;
            let hodographs = [0, 1].map(|d| whole.along().is_none().then(|| Hodograph::of(&whole, d)).flatten());
            for k in 0..40 {
                let p = [0.3, 1.0, 3.0][k % 3] * random.point();
                let nearest = whole.corners().map(|(_, c)| c.distance(p)).into_iter().fold(f64::MAX, f64::min);
                if nearest_is_corner(&whole, p) {
                    corners[kind] += 1;
                    assert!(grid.iter().flatten().all(|s| s.distance(p) >= nearest - ROUNDING), "round {round}, {p}");
                }
                for (direction, hodograph) in hodographs.iter().enumerate() {
                    let Some(hodograph) = hodograph else { continue };
                    let Some(end) = nearest_edge(&whole, hodograph, direction, p) else { continue };
                    edges[kind][direction][end] += 1;
                    for (i, row) in grid.iter().enumerate() {
                        for (j, sample) in row.iter().enumerate() {
                            let place = if end == 0 { 0 } else { last };
                            let foot = if direction == 0 { grid[place][j] } else { grid[i][place] };
                            assert!(sample.distance(p) >= foot.distance(p) - ROUNDING, "round {round}, {p}");
                            let inside = sample.distance(foot) > 1e-3;
                            assert!(!inside || sample.distance(p) > foot.distance(p), "round {round}, {p}: critical");
                        }
                    }
                }
            }
        }
        let fewest = edges.as_flattened().as_flattened().iter().chain(&corners).min();
        assert!(fewest > Some(&200), "corners {corners:?}, edges {edges:?}: a claim is hardly tested");
    }

    /// A segment that holds the foot in its inside is never dropped, and an edge that is kept holds it.
    #[test]
    fn the_part_that_holds_the_foot_is_kept() {
        let mut random = Random(17);
        let (mut corners, mut edges, mut kept) = (0, 0, 0);
        for round in 0..240 {
            let definition = random_definition(round, &mut random);
            let (frame, whole) = segment(&definition);
            let hierarchy = Hierarchy::new(&definition, &[]);
            for k in 0..6 {
                let p = [0.2, 0.7, 2.0][k % 3] * random.point();
                let world = p / frame.scale + frame.origin;
                let query = Query::new(world, QueryOptions::default()).expect("finite");
                let foot = hierarchy.project(&query, None, &mut Workspace::default()).expect("no limit");
                let (nearest, at) = (foot.distance, [foot.u, foot.v]);
                // parts that hold the foot: one at each level, until it is on a border
                let mut part = whole.clone();
                for level in 0..8 {
                    let near = |part: &Segment| {
                        let foot = &part.corners().map(|(_, c)| c.distance(p));
                        foot.iter().copied().fold(f64::MAX, f64::min) <= nearest + 1e-9
                    };
                    match verdict(&part, p) {
                        Verdict::Corner => {
                            corners += 1;
                            assert!(near(&part), "round {round}: the foot of {p} was dropped");
                            break;
                        }
                        Verdict::Nothing => panic!("round {round}: the foot of {p} was dropped at level {level}"),
                        Verdict::Edge { direction, end } => {
                            edges += 1;
                            assert!(
                                (at[direction] - part.end(direction, end)).abs() < 1e-6,
                                "round {round}: {p} has its foot elsewhere"
                            );
                            break;
                        }
                        Verdict::Open => kept += 1,
                    }
                    let direction = part.along().unwrap_or(level % 2);
                    let Some(parts) = part.split(direction) else { break };
                    let middle = parts[0].end(direction, 1);
                    if (at[direction] - middle).abs() < 1e-6 {
                        break;
                    }
                    part = parts.into_iter().nth(usize::from(at[direction] > middle)).expect("two parts");
                }
            }
        }
        assert!(corners > 100 && edges > 50 && kept > 1000, "corners {corners}, edges {edges}, kept {kept}");
    }

    /// A patch over the unit square whose net along a direction starts (or ends) at the edge under test.
    fn patch(direction: usize, end: usize, heights: [f64; 4]) -> Segment {
        let (flat, bezier) = ([0.0, 1.0, 2.0, 3.0], clamped(3, &[]));
        // across: along the edge, into: away from it; the edge's own control points rise by `heights`
        let point = |across: usize, into: usize| {
            let depth = into as f64 + if into == 0 { heights[across] } else { 0.0 };
            let depth = if end == 0 { depth } else { 3.0 - depth };
            if direction == 0 { DVec3::new(depth, flat[across], 0.0) } else { DVec3::new(flat[across], depth, 0.0) }
        };
        let into = |k: usize| if end == 0 { k } else { 3 - k };
        let points = (0..4)
            .map(|i| (0..4).map(|j| if direction == 0 { point(j, into(i)) } else { point(i, into(j)) }).collect())
            .collect();
        segment(&NurbsSurface::new((3, 3), (bezier.clone(), bezier), points, None).expect("valid").into()).1
    }

    /// Theorem 4.4 needs every control point of the edge, the first included, on each of its four sides with its own sign.
    #[test]
    fn every_control_point_of_an_edge_has_its_say() {
        for direction in [0, 1] {
            for end in [0, 1] {
                let level = patch(direction, end, [0.0; 4]);
                let mut at = [0; 2];
                at[direction] = end;
                let (_, corner) = level.corners().into_iter().find(|(place, _)| *place == at).expect("one of four");
                let out = if direction == 0 { DVec3::X } else { DVec3::Y } * if end == 0 { -1.0 } else { 1.0 };
                // some way out, and off to the side of the far corner: behind the edge, not behind the corner
                let other = if direction == 0 { DVec3::Y } else { DVec3::X };
                let p = corner + 0.05 * out + 0.3 * other + DVec3::Z;
                assert_eq!(verdict(&level, p), Verdict::Edge { direction, end });
                let inside = corner - 0.05 * out + 0.3 * other + DVec3::Z;
                assert_eq!(verdict(&level, inside), Verdict::Open, "the foot is inside");
                for k in 0..4 {
                    let mut heights = [0.0; 4];
                    heights[k] = -0.5;
                    let bent = patch(direction, end, heights);
                    let hodograph = Hodograph::of(&bent, direction).expect("polynomial");
                    let tip = (0..4).map(|k| {
                        let line = if end == 0 { 0 } else { 3 };
                        if direction == 0 { bent.at(line, k) } else { bent.at(k, line) }
                    });
                    let tip = tip.max_by(|a, b| a.dot(out).total_cmp(&b.dot(out))).expect("four");
                    // between the tip and the other three
                    let p = tip - 0.02 * out + DVec3::Z;
                    assert_eq!(nearest_edge(&bent, &hodograph, direction, p), None, "{direction} {end} {k}");
                    let p = tip + 3.0 * out;
                    assert_eq!(nearest_edge(&bent, &hodograph, direction, p), Some(end), "{direction} {end} {k}");
                }
            }
        }
    }

    /// Theorems 4.1 and 4.2 need every control point behind the plane, and the plane on the far side of the query.
    #[test]
    fn every_control_point_has_its_say_about_a_corner() {
        let polygon = |points: Vec<DVec3>| {
            let knots = clamped(points.len() - 1, &[]);
            segment(&NurbsCurve::new(points.len() - 1, knots, points, None).expect("valid").into()).1
        };
        let straight = |k: usize| DVec3::new(k as f64, 0.2 * k as f64, 0.0);
        for turned in [false, true] {
            let order = |mut points: Vec<DVec3>| {
                if turned {
                    points.reverse();
                }
                polygon(points)
            };
            let whole = order((0..5).map(straight).collect());
            let end = if turned { 4 } else { 0 };
            let query = |segment: &Segment| segment.at(end, 0) - DVec3::new(0.2, 0.0, 0.0);
            assert_eq!(verdict(&whole, query(&whole)), Verdict::Corner);
            assert_eq!(verdict(&whole, whole.at(end, 0) + DVec3::new(0.2, 0.0, 0.0)), Verdict::Open);
            for k in 1..5 {
                let bent = order(
                    (0..5)
                        .map(|i| straight(i) - if i == k { DVec3::X * (k as f64 + 0.1) } else { DVec3::ZERO })
                        .collect(),
                );
                let p = bent.at(end, 0) - DVec3::new(0.2, 0.0, 0.0);
                assert_eq!(verdict(&bent, p), Verdict::Open, "control point {k}");
            }
        }
        let square = patch(0, 0, [0.0; 4]);
        for (at, corner) in square.corners() {
            let out = DVec3::new(at[0] as f64 - 0.5, at[1] as f64 - 0.5, 0.0);
            assert_eq!(verdict(&square, corner + out), Verdict::Corner);
            assert_ne!(verdict(&square, corner - out), Verdict::Corner);
        }
    }

    /// An edge is dropped only where the surface goes on beyond it and comes nearer.
    #[test]
    fn an_edge_is_dropped_only_inside_the_surface() {
        let beside = |surface: &NurbsSurface, k: usize, p: DVec3| {
            let definition = Definition::from(surface.clone());
            let (frame, whole) = segment(&definition);
            let parts = whole.split(0).expect("it has an inside");
            verdict(&parts[k], frame.enter(p))
        };
        let v = || vec![0.0, 0.0, 1.0, 1.0];
        let row = |x: f64, z: f64| vec![DVec3::new(x, 0.0, z), DVec3::new(x, 3.0, z)];
        let rows = |xs: &[(f64, f64)]| xs.iter().map(|(x, z)| row(*x, *z)).collect::<Vec<_>>();
        let below = DVec3::new(-1.0, 1.0, -9.0);
        // smooth: split at a knot of multiplicity 1, and in the middle of a span
        let net = rows(&[(0.0, 0.0), (1.0, 1.0), (2.0, 2.0), (3.0, 3.0)]);
        let knots = vec![0.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0];
        let smooth = NurbsSurface::new((2, 1), (knots, v()), net, None).expect("valid");
        assert_eq!(beside(&smooth, 1, below), Verdict::Nothing);
        assert_eq!(beside(&smooth, 0, below), Verdict::Edge { direction: 0, end: 0 }, "the border of the surface");
        let net = rows(&[(0.0, 0.0), (1.0, 1.0), (3.0, 3.0)]);
        let single = NurbsSurface::new((2, 1), (clamped(2, &[]), v()), net, None).expect("valid");
        assert_eq!(beside(&single, 1, below), Verdict::Nothing);
        // a crease: a knot as often as the degree; both sides rise from it
        let net = rows(&[(0.0, 4.0), (1.0, 2.0), (2.0, 0.0), (3.0, 2.0), (4.0, 4.0)]);
        let knots = vec![0.0, 0.0, 0.0, 0.5, 0.5, 1.0, 1.0, 1.0];
        let creased = NurbsSurface::new((2, 1), (knots, v()), net, None).expect("valid");
        let under = DVec3::new(2.0, 1.0, -9.0);
        assert_eq!(beside(&creased, 0, under), Verdict::Edge { direction: 0, end: 1 });
        assert_eq!(beside(&creased, 1, under), Verdict::Edge { direction: 0, end: 0 });
        // a cusp: smooth parameters, but the derivative vanishes where both sides turn back; (t², t³) about the middle
        let net = rows(&[(1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, 1.0)]);
        let cusp = NurbsSurface::new((3, 1), (clamped(3, &[]), v()), net, None).expect("valid");
        let ahead = DVec3::new(-9.0, 1.0, 0.0);
        for k in [0, 1] {
            assert_eq!(beside(&cusp, k, ahead), Verdict::Edge { direction: 0, end: 1 - k });
        }
    }
}
