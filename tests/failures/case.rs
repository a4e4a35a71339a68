//! An entity of a model, asked through the facade.

use std::cell::OnceCell;

use glam::DVec3;
use perpend::{Definition, EntityId, FootPoint, Model, Parameter, QueryOptions, Ties};

use crate::common::judgement::{judge, rounding};
use crate::common::oracle::Oracle;
use crate::common::shape::Shape;

/// The gap of a query that asks for none, as a share of the size.
pub(crate) const GAP: f64 = 1e-9;

/// An entity alone in its model. Its answers are held to what every answer promises before a test sees them: the parameter
/// inside the domain, the point the definition there, the distance that of the point, the bound below every known distance, the
/// gap reached.
pub(crate) struct Case {
    pub(crate) model: Model,
    pub(crate) id: EntityId,
    pub(crate) definition: Definition,
    pub(crate) shape: Shape,
    oracle: OnceCell<Oracle>,
}

impl Case {
    pub(crate) fn new(definition: impl Into<Definition>) -> Self {
        let definition = definition.into();
        let mut model = Model::new();
        let id = model.insert("case", definition.clone()).expect("valid");
        let shape = Shape::of(&definition);
        Self { model, id, definition, shape, oracle: OnceCell::new() }
    }

    pub(crate) fn size(&self) -> f64 {
        self.definition.size()
    }

    /// The definition at parameters.
    pub(crate) fn at(&self, u: f64, v: f64) -> DVec3 {
        match &self.definition {
            Definition::NurbsCurve(curve) => curve.point(u),
            Definition::NurbsSurface(surface) => surface.point(u, v),
        }
    }

    /// The unit normal `S_u × S_v` of a surface.
    pub(crate) fn normal(&self, u: f64, v: f64) -> DVec3 {
        let Definition::NurbsSurface(surface) = &self.definition else { panic!("a curve has no normal") };
        surface.normal(u, v).normalize()
    }

    /// A parameter of a direction, as a share of its domain.
    pub(crate) fn share(&self, along: usize, share: f64) -> f64 {
        let [first, last] = self.shape.domain(along);
        if share == 1.0 { last } else { first + share * (last - first) }
    }

    /// The foot of `p`, whatever its distance.
    pub(crate) fn foot(&self, p: DVec3) -> FootPoint {
        self.foot_no_farther(p, f64::INFINITY, &QueryOptions::default())
    }

    /// The foot of `p`, whose distance is known: it is met to 1e-12 of the size. A foot is polished far below the gap; what remains is
    /// the rounding of control points, weights and evaluation.
    pub(crate) fn foot_at(&self, p: DVec3, distance: f64) -> FootPoint {
        let foot = self.foot_no_farther(p, distance, &QueryOptions::default());
        let allowed = 1e-12 * self.size() + rounding(self.shape.reach(), p, distance);
        assert!((foot.distance - distance).abs() <= allowed, "{p}: true distance {distance:e}, {foot:?}");
        foot
    }

    /// The foot of `p`, held to the oracle's.
    pub(crate) fn foot_by_oracle(&self, p: DVec3) -> FootPoint {
        self.foot_no_farther(p, self.oracle_distance(p), &QueryOptions::default())
    }

    /// The distance of a real point of the entity, the nearest that the oracle knows.
    pub(crate) fn oracle_distance(&self, p: DVec3) -> f64 {
        self.oracle.get_or_init(|| Oracle::new(self.shape.clone())).nearest(p).distance
    }

    /// The foot of `p`, where a point of the entity is known to be at distance `real`.
    pub(crate) fn foot_no_farther(&self, p: DVec3, real: f64, options: &QueryOptions) -> FootPoint {
        let foot = self.model.project_with(self.id, p, options).expect("a good query").expect("no limit");
        let gap = options.gap.unwrap_or(GAP * self.size());
        let judged = judge(&self.shape, &self.definition, p, &foot, gap, real);
        assert!(judged.fault.is_none(), "{p}: {:?}, a point is at {:e}, {foot:?}", judged.fault, judged.real);
        assert!(judged.certified, "{p}: not certified, {foot:?}");
        foot
    }

    /// All feet of `p`.
    pub(crate) fn ties(&self, p: DVec3) -> Ties {
        let ties = self.model.project_ties(self.id, p, &QueryOptions::default()).expect("a good query");
        ties.expect("no limit")
    }

    /// Points of the entity at a grid of parameters, ends included: `(u, v, point)`.
    pub(crate) fn grid(&self, count: usize) -> Vec<(f64, f64, DVec3)> {
        let shares = |along: usize| {
            let last = if along == 1 && self.shape.curve { 0 } else { count };
            (0..=last).map(move |k| self.share(along, k as f64 / count as f64))
        };
        shares(0).flat_map(|u| shares(1).map(move |v| (u, v, self.at(u, v)))).collect()
    }
}

/// Both parameters of a surface.
pub(crate) fn uv(foot: &FootPoint) -> (f64, f64) {
    match foot.parameter {
        Parameter::Surface(u, v) => (u, v),
        Parameter::Curve(_) => panic!("{foot:?} lies on a curve"),
    }
}

/// The parameter of a curve.
pub(crate) fn u(foot: &FootPoint) -> f64 {
    match foot.parameter {
        Parameter::Curve(u) => u,
        Parameter::Surface(..) => panic!("{foot:?} lies on a surface"),
    }
}

/// Fails where two numbers differ by more than `allowed`.
#[track_caller]
pub(crate) fn close(a: f64, b: f64, allowed: f64) {
    assert!((a - b).abs() <= allowed, "{a:?} is not {b:?} to {allowed:e}");
}
