//! A trimmed face with its oracle and its solver; every answer is held to what every answer promises.

use glam::{DVec2, DVec3};
use perpend::{FootPoint, NurbsSurface, Prepared, Query, QueryOptions, Scratch};
use std::sync::Arc;

use super::faces::Face;
use crate::common::face_judgement::judge_on_face;
use crate::common::face_oracle::FaceOracle;
use crate::common::outline::Verdict;
use crate::common::random::Random;

/// The gap that the tests ask for, as a share of the carrier's size.
const GAP: f64 = 1e-9;

pub(crate) struct Case {
    pub(crate) face: Face,
    pub(crate) oracle: FaceOracle,
    prepared: Prepared,
}

impl Case {
    pub(crate) fn new(face: Face) -> Self {
        let oracle = FaceOracle::new(&face.surface, &face.trimming);
        let definition = Arc::new(face.surface.clone().into());
        let prepared = Prepared::new(definition, None).with_trimming(Arc::clone(&face.trimming));
        Self { face, oracle, prepared }
    }

    pub(crate) fn size(&self) -> f64 {
        self.oracle.shape.size()
    }

    /// The answer, and what is wrong with it where something is. A scratch that has been used must not matter.
    pub(crate) fn ask(&self, p: DVec3, real: f64, scratch: &mut Scratch) -> (FootPoint, Option<String>) {
        let gap = GAP * self.size();
        let query = Query::new(p, QueryOptions { gap: Some(gap), ..QueryOptions::default() }).expect("a good query");
        let foot = self.prepared.project(&query, scratch).expect("no limit");
        let again = self.prepared.project(&query, &mut Scratch::default()).expect("no limit");
        let judged = judge_on_face(&self.oracle, &self.face.surface, p, &foot, gap, real);
        let name = &self.face.name;
        let told = || format!("{name} at {p:?}: a point of the face is at {:e}, outline at {:e}", judged.real, judged.from_outline);
        let wrong = if !is_same(&foot, &again) {
            Some(format!("{}: two answers: {foot:?}, {again:?}", told()))
        } else if let Some(fault) = judged.fault {
            Some(format!("{}: {fault:?} by {:e}: {foot:?}", told(), foot.distance - judged.real))
        } else if !judged.certified {
            Some(format!("{}: not certified, gap {:e}: {foot:?}", told(), foot.gap()))
        } else {
            None
        };
        (foot, wrong)
    }

    /// The foot of `p`, held to the oracle's.
    #[track_caller]
    pub(crate) fn foot(&self, p: DVec3) -> FootPoint {
        self.foot_no_farther(p, self.oracle.nearest(p).distance)
    }

    /// The foot of `p`, whose distance is known.
    #[track_caller]
    pub(crate) fn foot_at(&self, p: DVec3, distance: f64) -> FootPoint {
        let foot = self.foot_no_farther(p, distance);
        let allowed = GAP * self.size() + 1e-12 * (self.size() + p.length());
        assert!((foot.distance - distance).abs() <= allowed, "{p}: true distance {distance:e}, {foot:?}");
        assert!(foot.lower_bound <= distance + 1e-12 * self.size(), "{p}: true distance {distance:e}, {foot:?}");
        foot
    }

    #[track_caller]
    fn foot_no_farther(&self, p: DVec3, real: f64) -> FootPoint {
        let (foot, wrong) = self.ask(p, real, &mut Scratch::default());
        assert!(wrong.is_none(), "{}", wrong.unwrap_or_default());
        foot
    }

    /// Everything that is wrong with the answers to these points.
    pub(crate) fn faults(&self, points: &[DVec3]) -> Vec<String> {
        let mut scratch = Scratch::default();
        points.iter().filter_map(|p| self.ask(*p, self.oracle.nearest(*p).distance, &mut scratch).1).collect()
    }

    /// About `count` query points of all kinds.
    pub(crate) fn hard_points(&self, count: usize, random: &mut Random) -> Vec<DVec3> {
        hard_points(&self.oracle, &self.face.surface, &self.face.special, count, random)
    }
}

fn is_same(a: &FootPoint, b: &FootPoint) -> bool {
    let bits = |foot: &FootPoint| {
        let (u, v) = (foot.parameter.u(), foot.parameter.v().unwrap_or(0.0));
        let numbers = [u, v, foot.point.x, foot.point.y, foot.point.z, foot.distance, foot.lower_bound];
        numbers.map(f64::to_bits)
    };
    bits(a) == bits(b) && a == b
}

/// About `count` points: on the face, its outline and what was cut away; beside them at all distances; about centres of curvature; around and far away.
pub(crate) fn hard_points(
    oracle: &FaceOracle,
    surface: &NurbsSurface,
    special: &[DVec3],
    count: usize,
    random: &mut Random,
) -> Vec<DVec3> {
    let inner: Vec<DVec2> = oracle.inner_points().map(|(uv, _)| uv).collect();
    let rim: Vec<DVec3> = oracle.rim_points().collect();
    let middle = rim.iter().sum::<DVec3>() / rim.len() as f64;
    let size = 2.0 * rim.iter().map(|point| point.distance(middle)).fold(0.0, f64::max);
    let (low, high) = oracle.outline.bounds();
    let mut points = special.to_vec();
    while points.len() < count {
        let along = |random: &mut Random, a: f64, b: f64| random.between(a, b);
        let cut = DVec2::new(along(random, low.x, high.x), along(random, low.y, high.y));
        let is_cut = oracle.outline.side(cut) == Verdict::Outside;
        let place = if is_cut || inner.is_empty() { cut } else { random.pick(&inner) };
        let point = surface.point(place.x, place.y);
        let normal = surface.normal(place.x, place.y).normalize_or(DVec3::Z);
        let near = size * random.power(-9.0, -3.0);
        points.extend([point, point + near * normal, point - near * normal]);
        points.push(point + random.sign() * size * random.power(-3.0, 0.5) * normal);
        if let Some(centre) = centre_of_curvature(surface, place, point, normal, size) {
            points.extend([centre, centre + size * random.power(-12.0, -4.0) * random.direction()]);
        }
        let edge = random.pick(&rim);
        points.push(edge);
        points.push(edge + size * random.power(-9.0, -3.0) * random.direction());
        points.push(edge + size * random.power(-3.0, 0.3) * random.direction());
        points.push(edge + random.sign() * size * random.power(-9.0, 0.0) * normal);
        if !special.is_empty() {
            points.push(random.pick(special) + size * random.power(-12.0, -1.0) * random.direction());
        }
        points.push(0.5 * (edge + random.pick(&rim)));
        points.push(middle + 1.5 * size * random.in_cube());
        points.push(middle + size * random.power(1.0, 3.0) * random.direction());
        points.push(middle + size * 10.0_f64.powi(random.count(3, 6) as i32) * random.direction());
    }
    points.truncate(count.max(special.len()));
    points
}

/// The centre of curvature along u.
fn centre_of_curvature(surface: &NurbsSurface, at: DVec2, point: DVec3, normal: DVec3, size: f64) -> Option<DVec3> {
    let mut d = [DVec3::ZERO; 9];
    surface.derivatives(at.x, at.y, 2, &mut d);
    let curvature = d[6].dot(normal) / d[3].length_squared();
    (curvature.is_finite() && curvature.abs() * size > 1e-3).then(|| point + normal / curvature)
}
