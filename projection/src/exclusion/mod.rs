//! Exclusion (Selimovic 2006): an entity is split until its parts are flat, and parts that provably hold no nearest point are dropped.
//!
//! It works on the definition as it is, without preparation: a query begins with the whole of it, splits at interior knots first, and so arrives
//! at Bézier pieces only where it must. The same subdivision with other [`Criteria`] is the comparator of the paper's tables.
//!
//! What it finds is a proposal: Newton's method ends the search in flat parts, and that proves nothing.

mod cone;
mod control_polygon;
mod criteria;
mod newton;
mod segment;
mod walk;

use std::sync::Arc;

use perpend_kernel::Definition;

use self::segment::Segment;
use self::walk::Walk;
use crate::answer::Method;
use crate::hierarchy::Frame;
use crate::query::{DEFAULT_FLATNESS, DEFAULT_GAP, Query};
use crate::scratch::Scratch;
use crate::solver::Proposer;

/// Which tests drop a segment, beside its box.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Criteria {
    /// Theorems 4.1, 4.2 and 4.4 of Selimovic 2006.
    Selimovic,
    /// The control polygons of Ma and Hewitt 2003, as far as they are known.
    ControlPolygon,
}

/// The solver, for one definition.
#[derive(Debug)]
pub(crate) struct Exclusion {
    definition: Arc<Definition>,
    frame: Frame,
    whole: Segment,
    criteria: Criteria,
}

impl Exclusion {
    pub(crate) fn new(definition: &Arc<Definition>, criteria: Criteria) -> Self {
        let frame = Frame::of(definition);
        let whole = Segment::whole(definition, &frame);
        Self { definition: Arc::clone(definition), frame, whole, criteria }
    }
}

impl Proposer for Exclusion {
    fn method(&self) -> Method {
        match self.criteria {
            Criteria::Selimovic => Method::Exclusion,
            Criteria::ControlPolygon => Method::ControlPolygon,
        }
    }

    fn propose(&self, query: &Query, scratch: &mut Scratch) -> Option<(f64, f64)> {
        let Frame { size, scale, .. } = self.frame;
        let mut walk = Walk {
            definition: &self.definition,
            frame: &self.frame,
            criteria: self.criteria,
            point: self.frame.enter(query.point),
            flatness: query.options.flatness.unwrap_or(DEFAULT_FLATNESS * size) * scale,
            gap: query.options.gap.unwrap_or(DEFAULT_GAP * size) * scale,
            left: u64::from(query.options.work),
            best: (f64::INFINITY, [0.0; 2]),
        };
        walk.run(&self.whole, &mut scratch.statistics.proposal);
        let [u, v] = walk.best.1;
        walk.best.0.is_finite().then_some((u, v))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hierarchy::double_double::Random;
    use crate::{FootPoint, Prepared, QueryOptions, Statistics};
    use glam::DVec3;
    use perpend_kernel::{Circle, NurbsCurve, NurbsSurface};
    use std::f64::consts::TAU;

    const BOTH: [Method; 2] = [Method::Exclusion, Method::ControlPolygon];

    fn ask(prepared: &Prepared, p: DVec3, options: QueryOptions) -> (FootPoint, Statistics) {
        let mut scratch = Scratch::default();
        let query = Query::new(p, options).expect("finite");
        (prepared.project(&query, &mut scratch).expect("no limit"), scratch.statistics)
    }

    fn prepared(definition: &Definition) -> Prepared {
        Prepared::new(Arc::new(definition.clone()), None)
    }

    fn with(method: Method) -> QueryOptions {
        QueryOptions { method: Some(method), ..QueryOptions::default() }
    }

    fn bezier(points: Vec<DVec3>) -> Definition {
        let degree = points.len() - 1;
        let knots = [vec![0.0; degree + 1], vec![1.0; degree + 1]].concat();
        NurbsCurve::new(degree, knots, points, None).expect("valid").into()
    }

    /// The case of the paper's Fig. 1, which its text names without numbers: both ends of the polygon lead away from the query, so that a test
    /// which reads the ends alone drops the curve (Dyllong and Luther 1999), and the foot is inside.
    #[test]
    fn a_curve_whose_ends_lead_away_is_kept() {
        let points: Vec<DVec3> = [(-1.0, 1.2), (-2.5, 3.0), (0.0, -3.0), (2.5, 3.0), (1.0, 1.2)]
            .map(|(x, y)| DVec3::new(x, y, 0.0))
            .to_vec();
        for (end, next) in [(0, 1), (4, 3)] {
            assert!((points[next] - points[end]).dot(points[end]) > 0.0, "the test reads the ends");
        }
        for method in BOTH {
            let (foot, statistics) = ask(&prepared(&bezier(points.clone())), DVec3::ZERO, with(method));
            assert_eq!((foot.method, statistics.corrected), (method, 0));
            assert!((foot.distance - 0.525).abs() < 1e-9, "{foot:?}");
        }
    }

    #[test]
    fn proposals_on_curves_and_surfaces_need_no_correction() {
        let mut random = Random(23);
        for round in 0..60 {
            let (p, q) = (2 + round % 3, 1 + round % 4);
            let knots = |degree: usize| [vec![0.0; degree + 1], vec![0.4, 0.7], vec![1.0; degree + 1]].concat();
            let at =
                |i: usize, j: usize, random: &mut Random| DVec3::new(i as f64, j as f64, 0.0) + 0.4 * random.point();
            let weights = (round % 2 == 1)
                .then(|| (0..p + 3).map(|i| (0..q + 3).map(|j| 1.0 + ((i + j) % 3) as f64).collect()).collect());
            let points: Vec<Vec<DVec3>> =
                (0..p + 3).map(|i| (0..q + 3).map(|j| at(i, j, &mut random)).collect()).collect();
            let curve =
                NurbsCurve::new(q, knots(q), points[0].clone(), weights.as_ref().map(|w: &Vec<Vec<f64>>| w[1].clone()));
            let surface = NurbsSurface::new((p, q), (knots(p), knots(q)), points, weights);
            for definition in [Definition::from(curve.expect("valid")), Definition::from(surface.expect("valid"))] {
                let ready = prepared(&definition);
                for k in 0..8 {
                    let p = definition.control_points()[k % 4] + [0.1, 4.0][k % 2] * random.point();
                    let (foot, statistics) = ask(&ready, p, with(Method::Exclusion));
                    let (plain, _) = ask(&ready, p, with(Method::Hierarchy));
                    assert_eq!((foot.method, statistics.corrected), (Method::Exclusion, 0), "{definition:?} {p}");
                    assert!((foot.distance - plain.distance).abs() <= 1e-9 * definition.size());
                }
            }
        }
    }

    /// A polygon that is convex as seen along its axis, and rises along it.
    #[test]
    fn what_spatial_polygons_tell_wrongly_is_corrected() {
        let turn = |k: i32| DVec3::new((0.9 * f64::from(k)).cos(), (0.9 * f64::from(k)).sin(), 0.5 * f64::from(k));
        let curve = bezier((0..6).map(turn).collect());
        let ready = prepared(&curve);
        let mut random = Random(29);
        let mut corrected = 0;
        for _ in 0..600 {
            let p = 4.0 * random.point();
            let (foot, statistics) = ask(&ready, p, with(Method::ControlPolygon));
            let (plain, _) = ask(&ready, p, with(Method::Hierarchy));
            assert!((foot.distance - plain.distance).abs() <= 1e-9 * curve.size());
            assert_eq!(foot.method == Method::Hierarchy, statistics.corrected == 1);
            corrected += statistics.corrected;
            assert_eq!(ask(&ready, p, with(Method::Exclusion)).1.corrected, 0, "theorem 4.1 is not misled");
        }
        assert!(corrected > 5, "{corrected}: the comparator is misled now and then");
    }

    /// A wide flatness ends the subdivision at once: Newton's method finds a foot, not the nearest one.
    #[test]
    fn flatness_is_the_callers_and_what_it_misses_is_corrected() {
        let wave = bezier(
            [(0.0, 0.0), (1.0, 9.0), (2.0, -12.0), (3.0, 12.0), (4.0, -9.0), (5.0, 0.0)]
                .map(|(x, y)| DVec3::new(x, y, 0.0))
                .to_vec(),
        );
        let ready = prepared(&wave);
        let (mut corrected, mut fine) = (0, 0);
        for k in 0..40 {
            let p = DVec3::new(0.125 * f64::from(k), 1.0, 0.3);
            let wide = QueryOptions { flatness: Some(100.0), ..with(Method::Exclusion) };
            let (foot, statistics) = ask(&ready, p, wide);
            assert_eq!(statistics.proposal.subdivisions, 0);
            corrected += statistics.corrected;
            let (same, statistics) = ask(&ready, p, with(Method::Exclusion));
            fine += statistics.corrected;
            assert!((same.distance - foot.distance).abs() <= 1e-9 * wave.size());
        }
        assert!(corrected > 0 && fine == 0, "{corrected} with one start, {fine} with many");
    }

    /// The foot lies on the line in which the first splits cut, and the nearest corners are always its ends.
    #[test]
    fn strips_beside_a_plane_of_symmetry_do_not_multiply() {
        let knots = || vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0];
        let at = |i: i32, j: i32| {
            DVec3::new(f64::from(i), f64::from(j - 1), -f64::from((j - 1) * (j - 1)) - f64::from((i - 1) * (i - 1)))
        };
        let points = (0..3).map(|i| (0..3).map(|j| at(i, j)).collect()).collect();
        let saddle = prepared(&NurbsSurface::new((2, 2), (knots(), knots()), points, None).expect("valid").into());
        for k in 0..20 {
            let p = DVec3::new(0.3 + 0.07 * f64::from(k), 0.0, 0.2);
            let options = QueryOptions { flatness: Some(1e-4), ..with(Method::Exclusion) };
            let (_, statistics) = ask(&saddle, p, options);
            let splits = statistics.proposal.subdivisions;
            assert!(splits < 200 && statistics.corrected == 0, "{splits} at {p}");
        }
    }

    #[test]
    fn work_is_bounded_where_every_point_ties() {
        let circle =
            Circle::new(perpend_kernel::Frame::WORLD, 2.0, (0.0, TAU)).expect("valid").to_nurbs().expect("valid");
        for method in BOTH {
            let options = QueryOptions { flatness: Some(0.0), work: 500, ..with(method) };
            let (foot, statistics) = ask(&prepared(&circle.clone().into()), DVec3::new(0.0, 0.0, 1.0), options);
            let proposal = statistics.proposal;
            assert!(proposal.subdivisions <= 500 && proposal.unresolved > 0, "{proposal:?}");
            assert!((foot.distance - 5.0_f64.sqrt()).abs() < 1e-12);
        }
    }

    #[test]
    fn extreme_definitions_get_parameters_of_their_domain() {
        let mut random = Random(31);
        for (scale, spread, degree) in [(1e70, 0.0, 3), (1e-69, 0.0, 2), (1.0, 49.0, 4), (1e-3, 2.0, 25)] {
            for closed in [false, true] {
                let n = degree + 1;
                let mut points: Vec<Vec<DVec3>> =
                    (0..n).map(|_| (0..3).map(|_| scale * random.point()).collect()).collect();
                if closed {
                    // one Bézier piece whose borders coincide, and a pole
                    points[degree] = points[0].clone();
                    points.iter_mut().for_each(|row| row[2] = DVec3::ZERO);
                }
                let weights =
                    (0..n).map(|_| (0..3).map(|_| 10.0_f64.powf(random.between(-spread, spread))).collect()).collect();
                let knots = ([vec![-1e-3; n], vec![1e-3; n]].concat(), vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0]);
                let surface = NurbsSurface::new((degree, 2), knots, points, Some(weights)).expect("valid");
                let definition = Arc::new(Definition::from(surface));
                for criteria in [Criteria::Selimovic, Criteria::ControlPolygon] {
                    let solver = Exclusion::new(&definition, criteria);
                    for k in 0..4 {
                        let p = [0.0, 1.0, 3.0, 1e4][k] * scale * random.point();
                        let query =
                            Query::new(p, QueryOptions { work: 2000, ..QueryOptions::default() }).expect("finite");
                        let mut scratch = Scratch::default();
                        let (u, v) = solver.propose(&query, &mut scratch).expect("there are corners");
                        assert!((-1e-3..=1e-3).contains(&u) && (0.0..=1.0).contains(&v), "{u}, {v}");
                        assert!(scratch.statistics.proposal.subdivisions <= 2000);
                    }
                }
            }
        }
    }
}
