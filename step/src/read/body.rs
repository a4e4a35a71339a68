//! Bodies in their own coordinates: shells, faces, loops, edges.

use std::collections::{BTreeMap, HashMap, HashSet};

use glam::{DAffine3, DVec3};
use perpend::InvalidDefinition;

use super::entities::{MAX_DEPTH, Understood};
use super::pcurve::Pcurve;
use super::placed::{mapped_curve, mapped_surface, scale_of};
use super::placement::Geometry;
use super::style::Colours;
use super::surface::FaceSurface;
use crate::source::{
    NotUnderstood, SourceBody, SourceCurve, SourceEdge, SourceFace, SourceLoop, SourcePart, SourceShell, SourceSurface,
    SourceUse,
};

/// Solids.
pub(super) const SOLIDS: [&str; 3] = ["MANIFOLD_SOLID_BREP", "BREP_WITH_VOIDS", "FACETED_BREP"];
/// Models of faces without a solid.
pub(super) const SHEETS: [&str; 2] = ["SHELL_BASED_SURFACE_MODEL", "FACE_BASED_SURFACE_MODEL"];
/// Shells by their own.
pub(super) const SHELLS: [&str; 5] =
    ["CLOSED_SHELL", "OPEN_SHELL", "ORIENTED_CLOSED_SHELL", "ORIENTED_OPEN_SHELL", "CONNECTED_FACE_SET"];
/// Faces.
pub(super) const FACES: [&str; 4] = ["ADVANCED_FACE", "FACE_SURFACE", "ORIENTED_FACE", "FACE"];

/// A body in its own coordinates; indices count from zero.
#[derive(Default)]
pub(super) struct LocalBody {
    edges: Vec<SourceEdge>,
    faces: Vec<SourceFace>,
    shells: Vec<SourceShell>,
    /// Faces that were read or listed, by their numbers.
    pub(super) met: Vec<u64>,
    /// What a copy of it takes: faces, loops, uses of edges, edges, control points, and their share of texts.
    pub(super) pieces: usize,
    pub(super) not_understood: Vec<NotUnderstood>,
}

/// An edge that was read, with what the file says of it in surfaces.
#[derive(Clone)]
struct Known {
    index: usize,
    pcurves: Vec<Pcurve>,
}

/// Reads one body.
pub(super) struct BodyReader<'a> {
    geometry: Geometry<'a>,
    colours: &'a Colours,
    body: LocalBody,
    edges: HashMap<u64, Understood<Known>>,
    /// Sides of polygons by the numbers of their points, the smaller first.
    sides: HashMap<(u64, u64), usize>,
}

impl<'a> BodyReader<'a> {
    pub(super) fn new(geometry: Geometry<'a>, colours: &'a Colours) -> Self {
        Self { geometry, colours, body: LocalBody::default(), edges: HashMap::new(), sides: HashMap::new() }
    }

    /// A body of any kind: a solid, a model of faces, a shell, or a face.
    pub(super) fn read(mut self, id: u64) -> LocalBody {
        if let Err(left_out) = self.shells_of(id) {
            self.body.not_understood.push(left_out);
        }
        self.body
    }

    fn shells_of(&mut self, id: u64) -> Understood<()> {
        let entities = self.geometry.entities;
        if entities.is(id, &SHELLS) {
            return self.shell(id, false, 0);
        }
        if entities.is(id, &FACES) {
            let faces = self.face(id, None).into_iter().collect();
            self.body.shells.push(SourceShell { entity: id, faces, closed: false, reversed: false });
            return Ok(());
        }
        // of several keywords, the one that names the shells has values
        let (values, first) = match entities.simple(id) {
            Some(values) => (values, 1),
            None => {
                let kinds = SOLIDS.iter().chain(&SHEETS);
                let part = kinds.filter_map(|kind| entities.part(id, kind)).find(|part| part.get(0).is_some());
                (part.ok_or_else(|| entities.unexpected(id, "a body"))?, 0)
            }
        };
        if SHEETS.contains(&values.keyword) {
            for shell in values.references(first)? {
                self.shell_or_say(shell);
            }
            return Ok(());
        }
        self.shell_or_say(values.reference(first)?);
        let voids = match entities.part(id, "BREP_WITH_VOIDS") {
            Some(part) => part.references(0).or_else(|_| part.references(1))?,
            None if values.keyword == "BREP_WITH_VOIDS" => values.references(first + 1)?,
            None => Vec::new(),
        };
        for shell in voids {
            self.shell_or_say(shell);
        }
        Ok(())
    }

    /// Pays for a part of the body that is kept.
    fn keep(&mut self, id: u64, pieces: usize) -> Understood<()> {
        self.body.pieces += pieces;
        self.geometry.entities.keep(id, pieces)
    }

    fn shell_or_say(&mut self, id: u64) {
        if let Err(left_out) = self.shell(id, false, 0) {
            self.body.not_understood.push(left_out);
        }
    }

    fn shell(&mut self, id: u64, reversed: bool, depth: usize) -> Understood<()> {
        let entities = self.geometry.entities;
        entities.spend(id, 1)?;
        let values = entities.simple_of(id, &SHELLS).ok_or_else(|| entities.unexpected(id, "a shell"))?;
        if values.keyword.starts_with("ORIENTED") {
            if depth > MAX_DEPTH {
                return Err(values.refuse("shells of shells are nested too deeply".to_owned()));
            }
            return self.shell(values.reference(2)?, reversed == values.flag(3)?, depth + 1);
        }
        let colour = self.colours.get(id);
        let numbers = values.references(1)?;
        let faces: Vec<usize> = numbers.iter().filter_map(|face| self.face(*face, colour)).collect();
        let mut closed = values.keyword == "CLOSED_SHELL" && faces.len() == numbers.len();
        if closed && let Some(edge) = self.open_edge(&faces) {
            closed = false;
            let reason = format!(
                "it is called closed, but its faces do not use edge #{edge} once in either direction: it is imported as open"
            );
            self.body.not_understood.push(values.refuse(reason));
        }
        self.body.shells.push(SourceShell { entity: id, faces, closed, reversed });
        Ok(())
    }

    /// An edge that these faces do not use once in either direction, as those of a closed shell do.
    fn open_edge(&self, faces: &[usize]) -> Option<u64> {
        let mut uses: BTreeMap<usize, (usize, usize)> = BTreeMap::new();
        for around in faces.iter().flat_map(|face| &self.body.faces[*face].loops) {
            let SourceLoop::Edges { uses: around, .. } = around else { continue };
            for used in around {
                let (forth, back) = uses.entry(used.edge).or_default();
                *(if used.forward { forth } else { back }) += 1;
            }
        }
        let open = uses.into_iter().find(|(_, both)| *both != (1, 1));
        open.map(|(edge, _)| self.body.edges[edge].entity)
    }

    /// The index of a face; none where it was listed.
    fn face(&mut self, id: u64, colour: Option<[f64; 3]>) -> Option<usize> {
        match self.read_face(id, false, 0) {
            Ok(mut face) => {
                face.colour = self.colours.get(face.entity).or(colour);
                self.body.faces.push(face);
                Some(self.body.faces.len() - 1)
            }
            Err(reason) => {
                self.body.not_understood.push(about(self.geometry.entities.refuse(id, String::new()), reason));
                None
            }
        }
    }

    fn read_face(&mut self, id: u64, turned: bool, depth: usize) -> Understood<SourceFace> {
        let entities = self.geometry.entities;
        entities.spend(id, 1)?;
        self.body.met.push(id);
        let values = entities.simple_of(id, &FACES).ok_or_else(|| entities.unexpected(id, "a face"))?;
        if values.keyword == "ORIENTED_FACE" {
            if depth > MAX_DEPTH {
                return Err(values.refuse("faces of faces are nested too deeply".to_owned()));
            }
            return self.read_face(values.reference(2)?, turned == values.flag(3)?, depth + 1);
        }
        if values.keyword == "FACE" {
            return Err(values.refuse("it has no surface".to_owned()));
        }
        let surface_id = values.reference(2)?;
        let surface = self.geometry.surface(surface_id)?;
        let same_sense = (values.flag(3)? != surface.flipped) != turned;
        self.keep(id, of_surface(&surface.surface) + of_text(values.text(0)))?;
        let mut bounds = values.references(1)?;
        // the boundaries are a set: one that is named again is the same
        let mut seen = HashSet::new();
        bounds.retain(|bound| seen.insert(*bound));
        let mut loops = Vec::with_capacity(bounds.len());
        for bound in bounds {
            let read = self
                .bound(bound, surface_id, &surface, turned)
                .map_err(|reason| about(entities.refuse(bound, String::new()), reason))?;
            loops.push(read);
        }
        Ok(SourceFace {
            entity: id,
            name: values.text(0).to_owned(),
            surface: surface.surface,
            same_sense,
            loops,
            colour: None,
        })
    }

    fn bound(&mut self, id: u64, surface_id: u64, surface: &FaceSurface, turned: bool) -> Understood<SourceLoop> {
        let entities = self.geometry.entities;
        let values = entities
            .simple_of(id, &["FACE_BOUND", "FACE_OUTER_BOUND"])
            .ok_or_else(|| entities.unexpected(id, "the boundary of a face"))?;
        let outer = values.keyword == "FACE_OUTER_BOUND";
        let backward = values.flag(2)? == turned;
        let around = values.reference(1)?;
        self.keep(around, 1)?;
        let values = entities
            .simple_of(around, &["EDGE_LOOP", "VERTEX_LOOP", "POLY_LOOP"])
            .ok_or_else(|| entities.unexpected(around, "a loop"))?;
        let mut uses = match values.keyword {
            "VERTEX_LOOP" => return Ok(SourceLoop::Vertex(self.vertex(values.reference(1)?)?)),
            "POLY_LOOP" => self.polygon(around, &values.references(1)?)?,
            _ => {
                let edges = values.references(1)?;
                edges
                    .into_iter()
                    .map(|edge| self.edge_use(edge, surface_id, surface))
                    .collect::<Understood<Vec<_>>>()?
            }
        };
        if uses.is_empty() {
            return Err(values.refuse("it has no edges".to_owned()));
        }
        if backward {
            uses.reverse();
            for edge in &mut uses {
                edge.forward = !edge.forward;
            }
        }
        Ok(SourceLoop::Edges { outer, uses })
    }

    fn edge_use(&mut self, id: u64, surface_id: u64, surface: &FaceSurface) -> Understood<SourceUse> {
        let entities = self.geometry.entities;
        let (mut edge, mut forward, mut depth) = (id, true, 0);
        while let Some(values) = entities.simple_of(edge, &["ORIENTED_EDGE"]) {
            entities.spend(edge, 1)?;
            (edge, forward, depth) = (values.reference(3)?, forward == values.flag(4)?, depth + 1);
            if depth > MAX_DEPTH {
                return Err(values.refuse("edges of edges are nested too deeply".to_owned()));
            }
        }
        let known = match self.edges.get(&edge) {
            Some(known) => known.clone()?,
            None => {
                let known = self.edge(edge);
                self.edges.insert(edge, known.clone());
                known?
            }
        };
        // a seam has two p-curves in one surface: the first of the edge as it runs, the second of its return
        let here: Vec<&Pcurve> = known.pcurves.iter().filter(|pcurve| pcurve.surface == surface_id).collect();
        let chosen = here.get(if forward { 0 } else { here.len().saturating_sub(1) });
        let pcurve = chosen.and_then(|pcurve| self.geometry.raw(**pcurve, surface, &self.body.edges[known.index]));
        self.keep(id, 1 + pcurve.as_ref().map_or(0, |pcurve| pcurve.points.len()))?;
        Ok(SourceUse { edge: known.index, forward, pcurve })
    }

    fn edge(&mut self, id: u64) -> Understood<Known> {
        let entities = self.geometry.entities;
        entities.spend(id, 1)?;
        let values =
            entities.simple_of(id, &["EDGE_CURVE"]).ok_or_else(|| entities.unexpected(id, "an edge with its curve"))?;
        let (start, end) = (values.reference(1)?, values.reference(2)?);
        let curve = values.reference(3)?;
        let read = self.geometry.curve(curve).map_err(|reason| about(values.refuse(String::new()), reason))?;
        let pcurves = if read.own_parameter { self.geometry.pcurves(curve) } else { Vec::new() };
        let (from, to) = (self.vertex(start)?, self.vertex(end)?);
        self.keep(id, of_curve(&read.curve))?;
        self.body.edges.push(SourceEdge {
            entity: id,
            curve: read.curve,
            start: from,
            end: to,
            closed: start == end || from == to,
            same_sense: values.flag(4)?,
        });
        Ok(Known { index: self.body.edges.len() - 1, pcurves })
    }

    fn vertex(&self, id: u64) -> Understood<DVec3> {
        let entities = self.geometry.entities;
        let values = entities.simple_of(id, &["VERTEX_POINT"]).ok_or_else(|| entities.unexpected(id, "a vertex"))?;
        self.geometry.point(values.reference(1)?)
    }

    /// The sides of a polygon; neighbours share theirs.
    fn polygon(&mut self, id: u64, corners: &[u64]) -> Understood<Vec<SourceUse>> {
        // each a use, and an edge unless a neighbour has it
        self.keep(id, 2 * corners.len())?;
        let mut uses = Vec::with_capacity(corners.len());
        for (i, from) in corners.iter().enumerate() {
            let to = &corners[(i + 1) % corners.len()];
            let (start, end) = (self.geometry.point(*from)?, self.geometry.point(*to)?);
            if start == end {
                // some writers repeat the first corner at the end
                continue;
            }
            let edges = &mut self.body.edges;
            let edge = *self.sides.entry((*from.min(to), *from.max(to))).or_insert_with(|| {
                let (start, end) = if from < to { (start, end) } else { (end, start) };
                let curve = SourceCurve::Line { point: start, direction: end - start };
                edges.push(SourceEdge { entity: id, curve, start, end, closed: false, same_sense: true });
                edges.len() - 1
            });
            uses.push(SourceUse { edge, forward: from < to, pcurve: None });
        }
        Ok(uses)
    }
}

impl LocalBody {
    /// Whether nothing of it was read.
    pub(super) fn is_empty(&self) -> bool {
        self.faces.is_empty()
    }

    /// Puts a copy of it into a part.
    pub(super) fn place(
        &self,
        map: &DAffine3,
        (entity, name, colour): (u64, String, Option<[f64; 3]>),
        part: &mut SourcePart,
    ) -> Result<(), InvalidDefinition> {
        let (first_edge, first_face) = (part.edges.len(), part.faces.len());
        let still = *map == DAffine3::IDENTITY;
        let scaled = scale_of(map) != 1.0;
        let at = |point: DVec3| if still { point } else { map.transform_point3(point) };
        let mut edges = Vec::with_capacity(self.edges.len());
        for edge in &self.edges {
            let curve = if still { edge.curve.clone() } else { mapped_curve(&edge.curve, map)? };
            edges.push(SourceEdge { curve, start: at(edge.start), end: at(edge.end), ..*edge });
        }
        let mut faces = Vec::with_capacity(self.faces.len());
        for face in &self.faces {
            let surface = if still { face.surface.clone() } else { mapped_surface(&face.surface, map)? };
            let loops = face.loops.iter().map(|around| match around {
                SourceLoop::Vertex(point) => SourceLoop::Vertex(at(*point)),
                SourceLoop::Edges { outer, uses } => SourceLoop::Edges {
                    outer: *outer,
                    uses: uses.iter().map(|used| used_there(used, first_edge, scaled)).collect(),
                },
            });
            faces.push(SourceFace { surface, loops: loops.collect(), name: face.name.clone(), ..*face });
        }
        part.edges.append(&mut edges);
        part.faces.append(&mut faces);
        let shells = self
            .shells
            .iter()
            .map(|shell| SourceShell { faces: shell.faces.iter().map(|face| face + first_face).collect(), ..*shell });
        part.bodies.push(SourceBody { entity, name, shells: shells.collect(), colour });
        Ok(())
    }
}

/// Pieces of a curve.
fn of_curve(curve: &SourceCurve) -> usize {
    match curve {
        SourceCurve::Nurbs(curve) => curve.control_points().len(),
        _ => 1,
    }
}

/// Pieces of a surface.
fn of_surface(surface: &SourceSurface) -> usize {
    match surface {
        SourceSurface::Nurbs(surface) => surface.control_points().len(),
        SourceSurface::Revolution { profile, .. } | SourceSurface::Extrusion { profile, .. } => of_curve(profile),
        _ => 1,
    }
}

/// Pieces of a text: one takes more memory than these characters.
pub(super) fn of_text(text: &str) -> usize {
    text.len() / 64
}

/// A use of an edge in a copy. Where the copy is larger or smaller, the parameters of the file's p-curve are not those of the surface any more.
fn used_there(used: &SourceUse, first_edge: usize, scaled: bool) -> SourceUse {
    let pcurve = if scaled { None } else { used.pcurve.clone() };
    SourceUse { edge: used.edge + first_edge, forward: used.forward, pcurve }
}

/// An entity that was left out because of another one within it.
fn about(mut whole: NotUnderstood, reason: NotUnderstood) -> NotUnderstood {
    whole.reason = if whole.entity == reason.entity { reason.reason } else { format!("its {reason}") };
    whole
}
