//! Trimmed surfaces against dense samples of what their trims leave.

use std::f64::consts::TAU;
use std::sync::Arc;

use glam::{DVec2, DVec3};
use perpend_kernel::{
    Cylinder, Definition, Direction, Frame, NurbsSurface, PlaneCurve, Side, Sphere, Torus, TrimCurveData, TrimLoopData,
    Trimming, TrimmingData,
};
use perpend_projection::{Place, Prepared, Query, QueryOptions, Scratch};

struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    fn point(&mut self) -> DVec3 {
        DVec3::new(self.between(-1.0, 1.0), self.between(-1.0, 1.0), self.between(-1.0, 1.0))
    }
}

fn data(curve: &PlaneCurve) -> TrimCurveData {
    TrimCurveData {
        degree: curve.degree(),
        knots: curve.knots().as_slice().to_vec(),
        points: curve.points().collect(),
        weights: curve.weights().map(<[f64]>::to_vec),
        edge: None,
    }
}

/// A closed cubic about a point, in shares of the domain.
fn star(surface: &NurbsSurface, centre: DVec2, radius: f64, random: &mut Random) -> TrimLoopData {
    let [(u0, u1), (v0, v1)] = [Direction::U, Direction::V].map(|d| surface.domain(d));
    let n = 7;
    let radii: Vec<f64> = (0..n).map(|_| radius * random.between(0.4, 1.0)).collect();
    let corner = |k: usize| {
        let share = centre + radii[k % n] * DVec2::from_angle(TAU * k as f64 / n as f64);
        DVec2::new(u0 + share.x * (u1 - u0), v0 + share.y * (v1 - v0))
    };
    let knots = (0..n + 7).map(|k| k as f64).collect();
    let curve = PlaneCurve::new(3, knots, (0..n + 3).map(corner).collect(), None).expect("valid");
    TrimLoopData { outer: true, curves: vec![data(&curve)] }
}

fn wavy(random: &mut Random, rational: bool, height: f64) -> NurbsSurface {
    let n = 7;
    let knots = vec![0.0, 0.0, 0.0, 0.0, 0.25, 0.5, 0.75, 1.0, 1.0, 1.0, 1.0];
    let points = (0..n)
        .map(|i| (0..n).map(|j| DVec3::new(f64::from(i), f64::from(j), height * random.between(-1.0, 1.0))).collect())
        .collect();
    let weights = rational.then(|| (0..n).map(|_| (0..n).map(|_| random.between(0.5, 2.0)).collect()).collect());
    NurbsSurface::new((3, 3), (knots.clone(), knots), points, weights).expect("valid")
}

fn judge(surface: NurbsSurface, trimming: Trimming, queries: usize, random: &mut Random, name: &str) -> [usize; 4] {
    let trimming = Arc::new(trimming);
    let definition = Arc::new(Definition::from(surface.clone()));
    let prepared = Prepared::new(Arc::clone(&definition), None).with_trimming(Arc::clone(&trimming));
    let [(u0, u1), (v0, v1)] = [Direction::U, Direction::V].map(|d| surface.domain(d));
    let region = trimming.region();
    let mut samples: Vec<DVec3> = Vec::new();
    let n = 150;
    for i in 0..=n {
        for j in 0..=n {
            let at = DVec2::new(u0 + (u1 - u0) * i as f64 / n as f64, v0 + (v1 - v0) * j as f64 / n as f64);
            if region.side(at) != Side::Outside {
                samples.push(surface.point(at.x, at.y));
            }
        }
    }
    for one in trimming.loops() {
        for curve in &one.curves {
            let (a, b) = curve.curve.domain();
            for k in 0..=400 {
                let at = curve.curve.point(a + (b - a) * k as f64 / 400.0);
                samples.push(surface.point(at.x, at.y));
            }
        }
    }
    let size = definition.size();
    let bounds = prepared.bounds();
    let mut scratch = Scratch::default();
    let mut counts = [0; 4];
    for k in 0..queries {
        let near = samples[(random.next() * samples.len() as f64) as usize];
        let p = near + [0.01, 0.2, 1.0][k % 3] * size * random.point();
        let query = Query::new(p, QueryOptions::default()).expect("finite");
        let foot = prepared.project(&query, &mut scratch).expect("no limit");
        let nearest = samples.iter().map(|s| s.distance(p)).fold(f64::INFINITY, f64::min);
        assert!(
            foot.lower_bound <= nearest + 1e-12 * size,
            "{name} {k}: bound {} above a sample at {nearest}",
            foot.lower_bound
        );
        assert!(
            foot.distance <= nearest + 1e-9 * size,
            "{name} {k}: {foot:?} farther than a sample at {nearest} of {p}"
        );
        let (u, v) = (foot.parameter.u(), foot.parameter.v().expect("a surface"));
        assert!((surface.point(u, v) - foot.point).length() <= 1e-13 * size, "{name} {k}");
        assert!((foot.point.distance(p) - foot.distance).abs() <= 1e-13 * (size + foot.distance), "{name} {k}");
        let at = DVec2::new(u, v);
        let inside = (0..9).any(|m| {
            let by = 1e-9 * DVec2::new((u1 - u0) * f64::from(m % 3 - 1), (v1 - v0) * f64::from(m / 3 - 1));
            region.side(at + by) != Side::Outside
        });
        assert!(inside, "{name} {k}: {foot:?} is trimmed away");
        assert!(foot.point.cmpge(bounds.min - 1e-12 * size).all() && foot.point.cmple(bounds.max + 1e-12 * size).all());
        counts[3] += usize::from(foot.gap() > 1e-9 * size);
        counts[match foot.place {
            Place::TrimEdge => 1,
            Place::Vertex => 2,
            _ => 0,
        }] += 1;
    }
    counts
}

#[test]
fn free_forms() {
    let mut random = Random(77);
    for case in 0..12 {
        let surface = wavy(&mut random, case % 2 == 1, [0.3, 1.5, 4.0][case % 3]);
        let mut loops = vec![star(&surface, DVec2::splat(0.5), 0.48, &mut random)];
        if case % 2 == 0 {
            loops.push(star(&surface, DVec2::splat(0.5), 0.15, &mut random));
        }
        let data = TrimmingData { reversed: false, tolerance: 1e-6, loops };
        let (trimming, _) = Trimming::enter(data, &surface).expect("valid");
        let counts = judge(surface, trimming, 400, &mut random, &format!("wavy {case}"));
        assert_eq!(counts[3], 0, "uncertified");
    }
}

#[test]
fn closed_forms() {
    let mut random = Random(7);
    let surfaces = [
        Cylinder::new(Frame::WORLD, 1.0, (0.0, 4.0), (0.0, TAU)).and_then(|s| s.to_nurbs()),
        Sphere::whole(Frame::WORLD, 1.0).and_then(|s| s.to_nurbs()),
        Torus::whole(Frame::WORLD, 3.0, 1.0).and_then(|s| s.to_nurbs()),
    ];
    for (case, surface) in surfaces.into_iter().enumerate() {
        let surface = surface.expect("valid");
        let loops = vec![star(&surface, DVec2::splat(0.5), 0.48, &mut random)];
        let data = TrimmingData { reversed: false, tolerance: 1e-6, loops };
        let (trimming, _) = Trimming::enter(data, &surface).expect("valid");
        let counts = judge(surface, trimming, 600, &mut random, &format!("quadric {case}"));
        assert_eq!(counts[3], 0, "uncertified");
    }
}

/// A maximum distance changes no answer within it, and what is beyond is told as such.
#[test]
fn maximum_distances() {
    let mut random = Random(19);
    let mut beyond = 0;
    for case in 0..6 {
        let surface = if case < 4 {
            wavy(&mut random, case % 2 == 1, 2.0)
        } else {
            Cylinder::new(Frame::WORLD, 1.0, (0.0, 4.0), (0.0, TAU)).and_then(|s| s.to_nurbs()).expect("valid")
        };
        let loops = vec![star(&surface, DVec2::splat(0.5), 0.45, &mut random)];
        let (trimming, _) =
            Trimming::enter(TrimmingData { reversed: false, tolerance: 1e-6, loops }, &surface).expect("valid");
        let size = surface.control_box().diagonal();
        let prepared = Prepared::new(Arc::new(surface.into()), None).with_trimming(Arc::new(trimming));
        let mut scratch = Scratch::default();
        for k in 0..300 {
            let p = prepared.bounds().centre() + [0.3, 1.0][k % 2] * size * random.point();
            let whole = Query::new(p, QueryOptions::default()).expect("finite");
            let foot = prepared.project(&whole, &mut scratch).expect("no limit");
            for share in [0.0, 0.5, 0.999, 1.0 - 1e-7, 1.0, 1.0 + 1e-7, 1.001, 2.0] {
                let limit = share * foot.distance;
                let options = QueryOptions { max_distance: Some(limit), ..QueryOptions::default() };
                let found = prepared.project(&Query::new(p, options).expect("finite"), &mut scratch);
                if share >= 1.0 {
                    let found = found.unwrap_or_else(|| panic!("{case} {k} {share}: {limit} {foot:?}"));
                    assert!((found.distance - foot.distance).abs() <= 1e-9 * size, "{case} {k} {share}");
                } else if foot.distance > 0.0 {
                    assert!(found.is_none() || share > 0.9999, "{case} {k} {share}: {found:?} {foot:?}");
                    beyond += usize::from(found.is_none());
                }
            }
        }
    }
    assert!(beyond > 4000, "{beyond}");
}
