//! Vertices and edges that faces share.

use std::collections::HashMap;
use std::io::{self, Write};
use std::sync::Arc;

use glam::DVec3;
use perpend::{Definition, EntityId, Kind, NurbsCurve};

use super::edge::{SpaceCurve, ends_apart, extent, follows};
use super::geometry::{edge_curve, point};
use super::text::{Id, Text};

/// Of the distance between an edge's ends: a vertex farther from either than this share of it is not theirs, so that they are two.
const END: f64 = 0.45;

/// Of an edge's extent: an edge of another face farther from it than this share is not the same.
const BESIDE: f64 = 0.25;

/// Of an edge's extent: an edge of the same face farther from it than this share bounds an area with it; nearer, it is a seam.
const SEAM: f64 = 1e-4;

/// The vertices and edges of faces that hang together.
#[derive(Debug)]
pub(super) struct Topology {
    /// No face has a larger tolerance.
    coarsest: f64,
    /// Whether edges of different faces are one where their curves are; otherwise only where they are one entity.
    sewn: bool,
    vertices: Vec<Vertex>,
    /// Vertices by the cube of space that they lie in.
    cubes: HashMap<[i64; 3], Vec<usize>>,
    edges: Vec<Edge>,
    by_entity: HashMap<EntityId, usize>,
    by_ends: HashMap<(usize, usize), Vec<usize>>,
}

#[derive(Debug)]
struct Vertex {
    id: Id,
    at: DVec3,
    reach: Reach,
}

/// How near an end of an edge is to a vertex that it is.
#[derive(Debug, Clone, Copy)]
struct Reach {
    /// The tolerance of the face.
    tolerance: f64,
    /// What would make the edge's two ends one.
    most: f64,
}

impl Reach {
    fn with(self, other: Self) -> f64 {
        self.tolerance.max(other.tolerance).min(self.most).min(other.most)
    }
}

#[derive(Debug)]
struct Edge {
    id: Id,
    curve: Arc<NurbsCurve>,
    /// The faces that have it, and the largest of their tolerances.
    faces: Vec<EntityId>,
    tolerance: f64,
}

/// An edge as a loop uses it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Used {
    pub(super) edge: Id,
    pub(super) forward: bool,
}

impl Topology {
    pub(super) fn new(coarsest: f64, sewn: bool) -> Self {
        Self {
            coarsest,
            sewn,
            vertices: Vec::new(),
            cubes: HashMap::new(),
            edges: Vec::new(),
            by_entity: HashMap::new(),
            by_ends: HashMap::new(),
        }
    }

    /// The vertex at a point: the nearest within reach, or a new one.
    fn vertex<W: Write>(&mut self, text: &mut Text<W>, at: DVec3, reach: Reach) -> io::Result<(usize, Id)> {
        let cube = (at / (2.0 * self.coarsest)).floor().to_array().map(|x| x as i64);
        let mut near: Option<(f64, usize)> = None;
        for k in 0..27 {
            let beside = [k % 3, k / 3 % 3, k / 9];
            let key = std::array::from_fn(|i| cube[i].saturating_add(beside[i] - 1));
            for index in self.cubes.get(&key).into_iter().flatten().copied() {
                let old = &self.vertices[index];
                let distance = old.at.distance(at);
                let is_nearer = near.is_none_or(|(least, first)| (distance, index) < (least, first));
                if distance <= reach.with(old.reach) && is_nearer {
                    near = Some((distance, index));
                }
            }
        }
        if let Some((_, index)) = near {
            return Ok((index, self.vertices[index].id));
        }
        let place = point(text, at)?;
        let id = text.add(format_args!("VERTEX_POINT('',{place})"))?;
        self.vertices.push(Vertex { id, at, reach });
        self.cubes.entry(cube).or_default().push(self.vertices.len() - 1);
        Ok((self.vertices.len() - 1, id))
    }

    /// The vertices of a curve's start and end, which are two unless the curve is closed.
    fn ends<W: Write>(
        &mut self,
        text: &mut Text<W>,
        curve: &NurbsCurve,
        tolerance: f64,
    ) -> io::Result<[(usize, Id); 2]> {
        let reach = Reach { tolerance, most: ends_apart(curve, tolerance).map_or(f64::INFINITY, |apart| END * apart) };
        let (from, to) = curve.domain();
        Ok([self.vertex(text, curve.point(from), reach)?, self.vertex(text, curve.point(to), reach)?])
    }

    /// Makes the vertices of a face's shortest edges, before its longer edges take one vertex for both ends of a short one.
    pub(super) fn short_edges<W: Write>(
        &mut self,
        text: &mut Text<W>,
        curves: &[&SpaceCurve],
        tolerance: f64,
    ) -> io::Result<()> {
        let mut short: Vec<(f64, &SpaceCurve)> = curves
            .iter()
            .filter_map(|of| Some((ends_apart(&of.curve, tolerance)?, *of)))
            .filter(|(apart, _)| END * apart < self.coarsest)
            .collect();
        short.sort_by(|a, b| a.0.total_cmp(&b.0));
        short.into_iter().try_for_each(|(_, of)| self.ends(text, &of.curve, tolerance).map(|_| ()))
    }

    /// The edge of a curve that a face's loop follows; `tolerance` is that of the face.
    pub(super) fn edge<W: Write>(
        &mut self,
        text: &mut Text<W>,
        of: &SpaceCurve,
        face: EntityId,
        tolerance: f64,
    ) -> io::Result<Used> {
        if let Some(index) = of.entity.and_then(|entity| self.by_entity.get(&entity)) {
            return Ok(Used { edge: self.edges[*index].id, forward: of.forward });
        }
        let curve = &of.curve;
        let [(first, from), (last, to)] = self.ends(text, curve, tolerance)?;
        let extent = extent(curve);
        let key = (first.min(last), first.max(last));
        for index in self.by_ends.get(&key).into_iter().flatten() {
            let old = &mut self.edges[*index];
            let is_own = old.faces.contains(&face);
            if !self.sewn && !is_own {
                continue;
            }
            let beside = tolerance.max(old.tolerance).min(extent * if is_own { SEAM } else { BESIDE });
            if let Some((ascends, _)) = follows(&samples(curve), &old.curve, beside) {
                if let Some(entity) = of.entity {
                    // it runs as its own curve does, which may be the other way
                    if !ascends {
                        continue;
                    }
                    self.by_entity.insert(entity, *index);
                }
                old.faces.push(face);
                old.tolerance = old.tolerance.max(tolerance);
                return Ok(Used { edge: old.id, forward: of.forward == ascends });
            }
        }
        let kind = curve_kind(curve);
        let geometry = edge_curve(text, curve, &kind)?;
        let id = text.add(format_args!("EDGE_CURVE('',{from},{to},{geometry},.T.)"))?;
        self.edges.push(Edge { id, curve: Arc::clone(curve), faces: vec![face], tolerance });
        let index = self.edges.len() - 1;
        self.by_ends.entry(key).or_default().push(index);
        if let Some(entity) = of.entity {
            self.by_entity.insert(entity, index);
        }
        Ok(Used { edge: id, forward: of.forward })
    }
}

fn samples(curve: &NurbsCurve) -> Vec<DVec3> {
    let (from, to) = curve.domain();
    (0..=8).map(|k| curve.point(from + f64::from(k) / 8.0 * (to - from))).collect()
}

/// The class of a curve, proved within rounding: edges seldom have a record of their own.
pub(super) fn curve_kind(curve: &NurbsCurve) -> Kind {
    let definition = Definition::NurbsCurve(curve.clone());
    let tolerance = perpend::knowledge::default_tolerance(&definition);
    perpend::knowledge::class_and_gap(&definition, tolerance).0
}
