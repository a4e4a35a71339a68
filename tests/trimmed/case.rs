//! A trimmed face with its oracle and its solver; every answer is held to what every answer promises.

use glam::DVec3;
use perpend::{FootPoint, Prepared, Query, QueryOptions, Scratch};
use std::sync::Arc;

use super::faces::Face;
use super::hard_points::hard_points;
use crate::common::face_judgement::judge_on_face;
use crate::common::face_oracle::FaceOracle;
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
        let told = || {
            format!(
                "{name} at {p:?}: a point of the face is at {:e}, outline at {:e}",
                judged.real, judged.from_outline
            )
        };
        let wrong = if !is_same(&foot, &again) {
            Some(format!("{}: two answers: {foot:?}, {again:?}", told()))
        } else if let Some(fault) = judged.fault {
            Some(format!("{}: {fault:?} by {:e}: {foot:?}", told(), foot.distance - judged.real))
        } else if !judged.is_proven {
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
