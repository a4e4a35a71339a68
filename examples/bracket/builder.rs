//! Faces from their edges: every edge is one curve of the model, which both of its faces name.

use perpend::glam::DVec2;
use perpend::{
    Carrier, Circle, DVec3, EntityId, Frame, Line, Model, NurbsCurve, NurbsSurface, Plane, Shell, TrimCurveData,
    TrimLoopData, TrimmedSurface, TrimmingData,
};

use super::Outcome;

/// How closely the loops are closed: they are exact but for rounding.
const TOLERANCE: f64 = 1e-9;

/// By how much the carrier of a flat face is larger than the face.
const MARGIN: f64 = 2.0;

/// An edge, which two faces share, or one that meets itself there.
#[derive(Clone)]
pub(super) struct Edge {
    id: EntityId,
    pub(super) curve: NurbsCurve,
}

/// An edge and whether it is gone along forwards.
pub(super) type Along<'a> = (&'a Edge, bool);

/// A part under way.
#[derive(Default)]
pub(super) struct Builder {
    model: Model,
    faces: Vec<EntityId>,
}

impl Builder {
    /// An edge along a curve.
    pub(super) fn edge(&mut self, name: &str, curve: NurbsCurve) -> Outcome<Edge> {
        let id = self.model.insert(name, curve.clone())?;
        Ok(Edge { id, curve })
    }

    pub(super) fn line(&mut self, name: &str, from: DVec3, to: DVec3) -> Outcome<Edge> {
        self.edge(name, Line::new(from, to)?.to_nurbs()?)
    }

    /// An arc about a vertical axis.
    pub(super) fn arc(&mut self, name: &str, centre: DVec3, radius: f64, sweep: (f64, f64)) -> Outcome<Edge> {
        self.edge(name, Circle::new(Frame { centre, ..Frame::WORLD }, radius, sweep)?.to_nurbs()?)
    }

    /// The flat face within these loops, the first of which is the outer one. The frame's axis points away from the material, and the
    /// loops leave the face at their left, seen against the axis.
    pub(super) fn flat(&mut self, name: &str, frame: Frame, loops: &[Vec<Along<'_>>]) -> Outcome<()> {
        let place = |p: DVec3| DVec2::new((p - frame.centre).dot(frame.xdir), (p - frame.centre).dot(frame.ydir()));
        let points = loops.iter().flatten().flat_map(|(edge, _)| edge.curve.control_points());
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for p in points {
            (low, high) = (low.min(place(*p)), high.max(place(*p)));
        }
        (low, high) = (low - MARGIN, high + MARGIN);
        let plane = Plane::new(frame, (low.x, high.x), (low.y, high.y))?.to_nurbs()?;
        // a curve in a plane has its own control points for those of its p-curve
        let along = |(edge, forwards): &Along<'_>| {
            let curve = if *forwards { edge.curve.clone() } else { edge.curve.reversed() };
            TrimCurveData {
                degree: curve.degree(),
                knots: curve.knots().as_slice().to_vec(),
                points: curve.control_points().iter().map(|p| (place(*p) - low) / (high - low)).collect(),
                weights: curve.weights().map(<[f64]>::to_vec),
                edge: Some(edge.id),
            }
        };
        let of_loop = |one: &Vec<Along<'_>>| one.iter().map(along).collect();
        let loops = loops.iter().enumerate().map(|(k, one)| TrimLoopData { outer: k == 0, curves: of_loop(one) });
        self.face(name, plane, false, loops.collect())
    }

    /// A whole surface as a face. The edges lie at the first v, the last u, the last v and the first u.
    pub(super) fn whole(
        &mut self,
        name: &str,
        surface: NurbsSurface,
        reversed: bool,
        edges: [&Edge; 4],
    ) -> Outcome<()> {
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(u, v)| DVec2::new(u, v));
        let side = |k: usize| TrimCurveData {
            degree: 1,
            knots: vec![0.0, 0.0, 1.0, 1.0],
            points: vec![corners[k], corners[(k + 1) % 4]],
            weights: None,
            edge: Some(edges[k].id),
        };
        let curves = (0..4).map(side).collect();
        self.face(name, surface, reversed, vec![TrimLoopData { outer: true, curves }])
    }

    fn face(&mut self, name: &str, surface: NurbsSurface, reversed: bool, loops: Vec<TrimLoopData>) -> Outcome<()> {
        let trimming = TrimmingData { reversed, tolerance: TOLERANCE, loops };
        let face = TrimmedSurface { surface: Carrier::Own(surface), trimming };
        self.faces.push(self.model.insert_trimmed(name, face)?);
        Ok(())
    }

    /// The model with the faces as a closed body.
    pub(super) fn finish(mut self, name: &str) -> Outcome<Model> {
        self.model.insert_body(name, vec![Shell { faces: self.faces, closed: true }])?;
        Ok(self.model)
    }
}

/// The curve of an entity that is one.
pub(super) fn boundary(surface: &NurbsSurface) -> Outcome<[NurbsCurve; 4]> {
    let curves = surface.boundary_curves();
    let [u0, u1, v0, v1] = curves.map(|curve| curve.ok_or("a side of the seat is no curve"));
    Ok([u0?, u1?, v0?, v1?])
}
