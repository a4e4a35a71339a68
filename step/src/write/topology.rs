//! Vertices and edges that faces share.

use std::collections::HashMap;
use std::io::{self, Write};
use std::sync::Arc;

use glam::DVec3;
use perpend::{Definition, EntityId, Kind, NurbsCurve};

use super::edge::{SpaceCurve, follows};
use super::geometry::{edge_curve, point};
use super::text::{Id, Text};

/// The vertices and edges of faces that hang together.
#[derive(Debug)]
pub(super) struct Topology {
    /// What is nearer is one.
    tolerance: f64,
    /// Whether edges of different faces are one where their curves are; otherwise only where they are one entity.
    sewn: bool,
    vertices: Vec<(DVec3, Id)>,
    /// Vertices by the cube of space that they lie in.
    cubes: HashMap<[i64; 3], Vec<usize>>,
    edges: Vec<Edge>,
    by_entity: HashMap<EntityId, usize>,
    by_ends: HashMap<(usize, usize), Vec<usize>>,
}

#[derive(Debug)]
struct Edge {
    id: Id,
    curve: Arc<NurbsCurve>,
    /// The face that first had it.
    face: EntityId,
}

/// An edge as a loop uses it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Used {
    pub(super) edge: Id,
    pub(super) forward: bool,
}

impl Topology {
    pub(super) fn new(tolerance: f64, sewn: bool) -> Self {
        Self {
            tolerance,
            sewn,
            vertices: Vec::new(),
            cubes: HashMap::new(),
            edges: Vec::new(),
            by_entity: HashMap::new(),
            by_ends: HashMap::new(),
        }
    }

    /// The vertex at a point: an old one within the tolerance, the first of them, or a new one.
    pub(super) fn vertex<W: Write>(&mut self, text: &mut Text<W>, at: DVec3) -> io::Result<(usize, Id)> {
        let cube = (at / (2.0 * self.tolerance)).floor().to_array().map(|x| x as i64);
        let mut near: Option<usize> = None;
        for k in 0..27 {
            let beside = [k % 3, k / 3 % 3, k / 9];
            let key = std::array::from_fn(|i| cube[i].saturating_add(beside[i] - 1));
            let found = self.cubes.get(&key).into_iter().flatten();
            let found = found.copied().filter(|i| self.vertices[*i].0.distance(at) <= self.tolerance).min();
            near = match (near, found) {
                (Some(a), Some(b)) => Some(a.min(b)),
                (a, b) => a.or(b),
            };
        }
        if let Some(index) = near {
            return Ok((index, self.vertices[index].1));
        }
        let place = point(text, at)?;
        let id = text.add(format_args!("VERTEX_POINT('',{place})"))?;
        self.vertices.push((at, id));
        self.cubes.entry(cube).or_default().push(self.vertices.len() - 1);
        Ok((self.vertices.len() - 1, id))
    }

    /// The edge of a curve that a face's loop follows; none where the curve begins, ends and stays at one vertex, as beside a pole.
    pub(super) fn edge<W: Write>(
        &mut self,
        text: &mut Text<W>,
        of: &SpaceCurve,
        face: EntityId,
    ) -> io::Result<Option<Used>> {
        if let Some(index) = of.entity.and_then(|entity| self.by_entity.get(&entity)) {
            return Ok(Some(Used { edge: self.edges[*index].id, forward: of.forward }));
        }
        let curve = &of.curve;
        let (start, end) = (curve.point(curve.domain().0), curve.point(curve.domain().1));
        let ((first, from), (last, to)) = (self.vertex(text, start)?, self.vertex(text, end)?);
        // the vertex may lie beside both ends by the tolerance, and they beside the rest by another
        let stays = |at: &DVec3| at.distance(self.vertices[first].0) <= 4.0 * self.tolerance;
        if first == last && samples(curve).iter().all(stays) {
            return Ok(None);
        }
        let key = (first.min(last), first.max(last));
        for index in self.by_ends.get(&key).into_iter().flatten() {
            let old = &self.edges[*index];
            if !self.sewn && old.face != face {
                continue;
            }
            if let Some((ascends, _)) = follows(&samples(curve), &old.curve, self.tolerance) {
                if let Some(entity) = of.entity {
                    // it runs as its own curve does, which may be the other way
                    if !ascends {
                        continue;
                    }
                    self.by_entity.insert(entity, *index);
                }
                return Ok(Some(Used { edge: old.id, forward: of.forward == ascends }));
            }
        }
        let kind = curve_kind(curve);
        let geometry = edge_curve(text, curve, &kind)?;
        let id = text.add(format_args!("EDGE_CURVE('',{from},{to},{geometry},.T.)"))?;
        self.edges.push(Edge { id, curve: Arc::clone(curve), face });
        let index = self.edges.len() - 1;
        self.by_ends.entry(key).or_default().push(index);
        if let Some(entity) = of.entity {
            self.by_entity.insert(entity, index);
        }
        Ok(Some(Used { edge: id, forward: of.forward }))
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
