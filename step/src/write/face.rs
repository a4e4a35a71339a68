//! Faces: surfaces between loops of edges.

use std::io::{self, Write};
use std::sync::Arc;

use glam::DVec2;
use perpend::kernel::{PlaneCurve, Side, Trimming};
use perpend::{Definition, Direction, EntityId, NurbsSurface};

use super::edge::{SpaceCurve, is_point, space_curves, whole_edge};
use super::geometry::{Analytic, known_kind, spline_surface};
use super::part::FaceSource;
use super::text::{Id, Text, list, string};
use super::topology::{Topology, Used};
use super::{Fitted, Written};

/// A loop of p-curves.
struct Loop {
    outer: bool,
    /// Whether the face lies on its left in the parameters.
    left: bool,
    curves: Vec<(PlaneCurve, Option<EntityId>)>,
}

/// Writes a face, with its own tolerance; none where its loops are points within rounding. `edges` finds the definition of an edge entity.
pub(super) fn face<W: Write>(
    text: &mut Text<W>,
    topology: &mut Topology,
    source: &FaceSource<'_>,
    edges: &dyn Fn(EntityId) -> Option<Arc<Definition>>,
    tolerance: f64,
    written: &mut Written,
) -> io::Result<Option<Id>> {
    let FaceSource { entity, surface, trimming, .. } = *source;
    let reversed = trimming.is_some_and(Trimming::reversed);
    let mut paths = Vec::new();
    for one in loops(surface, trimming) {
        let path = path_curves(surface, &one.curves, edges, tolerance);
        // a loop that is a point bounds nothing; a loop of one vertex would stand for all of the carrier
        if !path.is_empty() {
            paths.push((one, path));
        }
    }
    if paths.is_empty() {
        written.empty.push(entity.id());
        return Ok(None);
    }
    let all: Vec<&SpaceCurve> = paths.iter().flat_map(|(_, path)| path).collect();
    topology.short_edges(text, &all, tolerance)?;
    let mut bounds = Vec::new();
    let mut has_outer = false;
    for (one, curves) in paths {
        let mut path: Vec<Used> = Vec::new();
        for curve in curves {
            if curve.deviation > 0.1 * tolerance && curve.entity.is_none() {
                written.fitted.push(Fitted { face: entity.id(), deviation: curve.deviation });
            }
            path.push(topology.edge(text, &curve, entity.id(), tolerance)?);
        }
        if one.left == reversed {
            path.reverse();
            path.iter_mut().for_each(|used| used.forward = !used.forward);
        }
        let mut oriented = Vec::with_capacity(path.len());
        for Used { edge, forward } in path {
            let sense = if forward { ".T." } else { ".F." };
            oriented.push(text.add(format_args!("ORIENTED_EDGE('',*,*,{edge},{sense})"))?);
        }
        let chain = text.add(format_args!("EDGE_LOOP('',{})", list(oriented, |id| id.to_string())))?;
        // a face has one of these at most
        let outer = one.outer && !has_outer;
        has_outer |= outer;
        let keyword = if outer { "FACE_OUTER_BOUND" } else { "FACE_BOUND" };
        bounds.push(text.add(format_args!("{keyword}('',{chain},.T.)"))?);
    }
    let kind = known_kind(entity.record(), entity.definition());
    let (carrier, outward) = match Analytic::of(&kind) {
        Some(analytic) => (analytic.write(text)?, same_normal(surface, &analytic)),
        None => (spline_surface(text, surface)?, true),
    };
    let sense = if outward != reversed { ".T." } else { ".F." };
    let name = string(entity.name());
    let bounds = list(bounds, |id| id.to_string());
    text.add(format_args!("ADVANCED_FACE({name},{bounds},{carrier},{sense})")).map(Some)
}

/// The curves in space of a loop, in its order from any of them on.
fn path_curves(
    surface: &NurbsSurface,
    curves: &[(PlaneCurve, Option<EntityId>)],
    edges: &dyn Fn(EntityId) -> Option<Arc<Definition>>,
    tolerance: f64,
) -> Vec<SpaceCurve> {
    let extended = curves.iter().filter(|(plane, _)| !is_point(surface, plane));
    let mut curves: Vec<&(PlaneCurve, Option<EntityId>)> = extended.collect();
    // an edge over a pole has a p-curve on either side of it: they follow each other, maybe from the end of the loop to its beginning
    let is_same = |a: Option<EntityId>, b: Option<EntityId>| a.is_some() && a == b;
    let first = (1..curves.len()).find(|i| !is_same(curves[i - 1].1, curves[*i].1)).unwrap_or(0);
    curves.rotate_left(first);
    let mut path = Vec::new();
    for group in curves.chunk_by(|a, b| is_same(a.1, b.1)) {
        let related = group[0].1.and_then(|id| Some((id, edges(id)?)));
        let planes: Vec<&PlaneCurve> = group.iter().map(|(plane, _)| plane).collect();
        match related.as_ref().and_then(|related| whole_edge(surface, &planes, related, tolerance)) {
            Some(curve) => path.push(curve),
            None => {
                let each = |plane: &&PlaneCurve| space_curves(surface, plane, related.as_ref(), tolerance);
                path.extend(planes.iter().flat_map(each));
            }
        }
    }
    path
}

/// Whether `S_u × S_v` has the sense of the standard's normal.
fn same_normal(surface: &NurbsSurface, analytic: &Analytic) -> bool {
    let [u, v] = [Direction::U, Direction::V].map(|direction| {
        let (from, to) = surface.domain(direction);
        // away from poles, seams and knots
        from + 0.381_966 * (to - from)
    });
    let mut out = [glam::DVec3::ZERO; 4];
    surface.derivatives(u, v, 1, &mut out);
    out[2].cross(out[1]).dot(analytic.normal(out[0])) > 0.0
}

/// The loops of a trim; without one, the border of the domain.
fn loops(surface: &NurbsSurface, trimming: Option<&Trimming>) -> Vec<Loop> {
    let Some(trimming) = trimming else {
        let [(u0, u1), (v0, v1)] = [Direction::U, Direction::V].map(|direction| surface.domain(direction));
        let corners = [(u0, v0), (u1, v0), (u1, v1), (u0, v1)].map(|(u, v)| DVec2::new(u, v));
        let side = |i: usize| PlaneCurve::line(corners[i], corners[(i + 1) % 4]).expect("a domain has an extent");
        return vec![Loop { outer: true, left: true, curves: (0..4).map(|i| (side(i), None)).collect() }];
    };
    let of = |one: &perpend::kernel::TrimLoop| Loop {
        outer: one.outer,
        left: lies_left(trimming, &one.curves.iter().map(|trim| &trim.curve).collect::<Vec<_>>()),
        curves: one.curves.iter().map(|trim| (trim.curve.clone(), trim.edge)).collect(),
    };
    trimming.loops().iter().map(of).collect()
}

/// Whether the region lies on the left of a loop: the first place beside it tells where one side is in the region and the other is not. Loops
/// run so by convention, and are believed where no place tells.
fn lies_left(trimming: &Trimming, curves: &[&PlaneCurve]) -> bool {
    let region = trimming.region();
    let (low, high) = region.bounds();
    let size = (high - low).max_element();
    for share in [1e-6, 1e-4, 1e-2] {
        for curve in curves {
            let (from, to) = curve.domain();
            for at in [0.5, 0.3, 0.7] {
                let mut out = [DVec2::ZERO; 2];
                curve.derivatives(from + at * (to - from), &mut out);
                let Some(left) = out[1].try_normalize().map(DVec2::perp) else { continue };
                let sides = [1.0, -1.0].map(|sign| region.side(out[0] + sign * share * size * left));
                match sides {
                    [Side::Inside, Side::Outside] => return true,
                    [Side::Outside, Side::Inside] => return false,
                    _ => {}
                }
            }
        }
    }
    true
}
