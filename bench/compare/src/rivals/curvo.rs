//! curvo: `find_closest_parameter`, on surfaces with the best point of a coarse sample as its hint.

use curvo::prelude::{NurbsCurve3D, NurbsSurface3D};
use nalgebra::{Point3, Point4};
use perpend::{DVec3, Definition, Direction, Parameter};

use crate::Failure;
use crate::case::{Case, Set};
use crate::contender::{Answer, Ask, Contender, Entrant, Pace};

/// Points of the coarse sample per control point, in each direction.
const DENSITY: usize = 2;

struct Curvo;

pub(super) fn contenders() -> Vec<Box<dyn Contender>> {
    vec![Box::new(Curvo)]
}

impl Contender for Curvo {
    fn name(&self) -> String {
        "curvo 0.3".to_owned()
    }

    fn pace(&self, set: Set) -> Pace {
        if set.has_surfaces() { Pace::Thinned } else { Pace::All }
    }

    fn enter(&self, case: &Case, _: &[DVec3]) -> Result<Option<Box<dyn Entrant>>, Failure> {
        let homogeneous = |points: &[perpend::glam::DVec4]| {
            points.iter().map(|p| Point4::new(p.x, p.y, p.z, p.w)).collect::<Vec<_>>()
        };
        Ok(Some(match &*case.definition {
            Definition::NurbsCurve(curve) => {
                let knots = curve.knots().as_slice().to_vec();
                let points = homogeneous(&curve.homogeneous_points());
                let curve = NurbsCurve3D::try_new(curve.degree(), points, knots).map_err(|error| error.to_string())?;
                Box::new(OnCurve { curve })
            }
            Definition::NurbsSurface(surface) => {
                let [u, v] = [Direction::U, Direction::V].map(|d| surface.knots(d).as_slice().to_vec());
                let points = surface.homogeneous_points();
                let rows = points.chunks(surface.columns()).map(homogeneous).collect();
                let (p, q) = surface.degree();
                Box::new(OnSurface::new(NurbsSurface3D::new(p, q, u, v, rows), surface.rows(), surface.columns()))
            }
        }))
    }
}

struct OnCurve {
    curve: NurbsCurve3D<f64>,
}

impl Ask for OnCurve {
    fn ask(&mut self, p: DVec3) -> Option<Answer> {
        let p = Point3::new(p.x, p.y, p.z);
        let u = self.curve.find_closest_parameter(&p).ok()?;
        let distance = (self.curve.point_at(u) - p).norm();
        Some(Answer { distance, parameter: Some(Parameter::Curve(u)), lower_bound: None })
    }
}

struct OnSurface {
    surface: NurbsSurface3D<f64>,
    /// Points of the surface with their parameters.
    sample: Vec<(Point3<f64>, (f64, f64))>,
}

impl OnSurface {
    fn new(surface: NurbsSurface3D<f64>, rows: usize, columns: usize) -> Self {
        let spread = |(from, to): (f64, f64), steps: usize| {
            (0..=steps).map(move |i| from + (to - from) * i as f64 / steps as f64)
        };
        let mut sample = Vec::new();
        for u in spread(surface.u_knots_domain(), DENSITY * rows) {
            for v in spread(surface.v_knots_domain(), DENSITY * columns) {
                sample.push((surface.point_at(u, v), (u, v)));
            }
        }
        Self { surface, sample }
    }
}

impl Ask for OnSurface {
    fn ask(&mut self, p: DVec3) -> Option<Answer> {
        let p = Point3::new(p.x, p.y, p.z);
        let mut nearest = (f64::INFINITY, (0.0, 0.0));
        for (point, at) in &self.sample {
            let distance_sq = (point - p).norm_squared();
            if distance_sq < nearest.0 {
                nearest = (distance_sq, *at);
            }
        }
        let (u, v) = self.surface.find_closest_parameter(&p, Some(nearest.1)).ok()?;
        let distance = (self.surface.point_at(u, v) - p).norm();
        Some(Answer { distance, parameter: Some(Parameter::Surface(u, v)), lower_bound: None })
    }
}
