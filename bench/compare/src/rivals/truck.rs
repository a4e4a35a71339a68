//! truck-geometry: `search_nearest_parameter` without a hint, its answer clamped to the domain.

use perpend::{DVec3, Definition, Direction, Parameter};
use truck_geometry::prelude::{
    BSplineCurve, BSplineSurface, D1, D2, KnotVec, MetricSpace, NurbsCurve, NurbsSurface, ParametricCurve,
    ParametricSurface, Point3, SPHint1D, SPHint2D, SearchNearestParameter, Vector4,
};

use crate::Failure;
use crate::case::{Case, Set};
use crate::contender::{Answer, Ask, Contender, Entrant, Pace};

/// Newton's steps at most: what the crate's own examples ask for.
const TRIALS: usize = 100;

struct Truck;

pub(super) fn contenders() -> Vec<Box<dyn Contender>> {
    vec![Box::new(Truck)]
}

impl Contender for Truck {
    fn name(&self) -> String {
        "truck-geometry 0.5".to_owned()
    }

    fn pace(&self, set: Set) -> Pace {
        if set.has_surfaces() { Pace::Thinned } else { Pace::All }
    }

    fn enter(&self, case: &Case, _: &[DVec3]) -> Result<Option<Box<dyn Entrant>>, Failure> {
        Ok(Some(match &*case.definition {
            Definition::NurbsCurve(curve) => {
                let knots = KnotVec::from(curve.knots().as_slice().to_vec());
                let domain = curve.domain();
                match curve.weights() {
                    None => {
                        let points = curve.control_points().iter().map(point).collect();
                        Box::new(OnCurve { curve: BSplineCurve::try_new(knots, points)?, domain })
                    }
                    Some(_) => {
                        let points = curve.homogeneous_points().into_iter().map(|p| Vector4::new(p.x, p.y, p.z, p.w));
                        let curve = NurbsCurve::new(BSplineCurve::try_new(knots, points.collect())?);
                        Box::new(OnCurve { curve, domain })
                    }
                }
            }
            Definition::NurbsSurface(surface) => {
                let directions = [Direction::U, Direction::V];
                let [u, v] = directions.map(|d| KnotVec::from(surface.knots(d).as_slice().to_vec()));
                let domain = directions.map(|d| surface.domain(d));
                let columns = surface.columns();
                match surface.weights() {
                    None => {
                        let rows = surface.control_points().chunks(columns);
                        let points = rows.map(|row| row.iter().map(point).collect()).collect();
                        Box::new(OnSurface { surface: BSplineSurface::try_new((u, v), points)?, domain })
                    }
                    Some(_) => {
                        let points = surface.homogeneous_points();
                        let row = |row: &[perpend::glam::DVec4]| {
                            row.iter().map(|p| Vector4::new(p.x, p.y, p.z, p.w)).collect::<Vec<_>>()
                        };
                        let points = points.chunks(columns).map(row).collect();
                        let surface = NurbsSurface::new(BSplineSurface::try_new((u, v), points)?);
                        Box::new(OnSurface { surface, domain })
                    }
                }
            }
        }))
    }
}

fn point(p: &DVec3) -> Point3 {
    Point3::new(p.x, p.y, p.z)
}

struct OnCurve<C> {
    curve: C,
    domain: (f64, f64),
}

impl<C> Ask for OnCurve<C>
where
    C: ParametricCurve<Point = Point3> + SearchNearestParameter<D1, Point = Point3>,
{
    fn ask(&mut self, p: DVec3) -> Option<Answer> {
        let p = point(&p);
        let u = self.curve.search_nearest_parameter(p, SPHint1D::None, TRIALS)?;
        if u.is_nan() {
            return None;
        }
        let u = u.clamp(self.domain.0, self.domain.1);
        let distance = self.curve.subs(u).distance(p);
        Some(Answer { distance, parameter: Some(Parameter::Curve(u)), lower_bound: None })
    }
}

struct OnSurface<S> {
    surface: S,
    domain: [(f64, f64); 2],
}

impl<S> Ask for OnSurface<S>
where
    S: ParametricSurface<Point = Point3> + SearchNearestParameter<D2, Point = Point3>,
{
    fn ask(&mut self, p: DVec3) -> Option<Answer> {
        let p = point(&p);
        let (u, v) = self.surface.search_nearest_parameter(p, SPHint2D::None, TRIALS)?;
        if u.is_nan() || v.is_nan() {
            return None;
        }
        let [in_u, in_v] = self.domain;
        let (u, v) = (u.clamp(in_u.0, in_u.1), v.clamp(in_v.0, in_v.1));
        let distance = self.surface.subs(u, v).distance(p);
        Some(Answer { distance, parameter: Some(Parameter::Surface(u, v)), lower_bound: None })
    }
}
