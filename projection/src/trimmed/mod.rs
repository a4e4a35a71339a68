//! The nearest point of a trimmed surface, with its proof.
//!
//! A foot of the carrier that lies in the region is the foot of the trimmed surface. Where it does not, snapping it to the boundary would be wrong: the trimmed
//! surface is nearest on its [`boundary`] or at another local minimum of the distance inside the region. Planes, spheres, cylinders, cones and tori have one
//! local minimum at most (away from their centres and axes, where all points of a circle or sphere are equally near, those on the boundary too), so
//! that there the boundary decides alone. On other carriers the hierarchy of the trimmed part finds the others, or proves that there are none.

mod boundary;
mod compose;

use std::sync::{Arc, OnceLock};

use glam::{DVec2, DVec3};
use perpend_kernel::{Aabb, Definition, NurbsSurface, Side, Trimming};

use self::boundary::{Boundary, BoundaryFoot};
use crate::answer::{FootPoint, Method, Parameter, Place};
use crate::closed_form::ClosedForm;
use crate::foot::Reader;
use crate::hierarchy::{BoundaryPoint, Hierarchy, Patches, TrimmedFoot};
use crate::query::{DEFAULT_GAP, Query, QueryOptions};
use crate::scratch::Scratch;
use crate::solver::{Solution, Solved, Solver, Tie, unit_normal};

/// A trimmed surface made ready for queries.
#[derive(Debug)]
pub(crate) struct Trimmed {
    definition: Arc<Definition>,
    trimming: Arc<Trimming>,
    made: OnceLock<Made>,
    hierarchy: OnceLock<Hierarchy>,
}

/// What every query to the trimmed part needs, made by the first.
#[derive(Debug)]
struct Made {
    patches: Patches,
    boundary: Boundary,
    /// Where the boundary begins, in the entity's own coordinates.
    anchor: DVec3,
}

/// What a query has come to, before the answer is written.
struct Outcome {
    at: DVec2,
    lower_bound: f64,
    /// Where the boundary's foot is a vertex; none for a foot inside.
    on_boundary: Option<bool>,
    tie: Tie,
    method: Method,
}

impl Trimmed {
    /// The trim was validated against the definition, which is a surface.
    pub(crate) fn new(definition: &Arc<Definition>, trimming: Arc<Trimming>) -> Self {
        Self { definition: Arc::clone(definition), trimming, made: OnceLock::new(), hierarchy: OnceLock::new() }
    }

    pub(crate) fn trimming(&self) -> &Arc<Trimming> {
        &self.trimming
    }

    fn surface(&self) -> &NurbsSurface {
        match &*self.definition {
            Definition::NurbsSurface(surface) => surface,
            Definition::NurbsCurve(_) => unreachable!("a trim was validated against a surface"),
        }
    }

    fn made(&self) -> &Made {
        self.made.get_or_init(|| {
            let (surface, region) = (self.surface(), self.trimming.region());
            let patches = Patches::new(&self.definition, surface, region);
            let boundary = Boundary::new(region, surface, patches.frame(), &patches);
            let start = region.pieces()[0].start;
            let anchor = patches.frame().enter(surface.point(start.x, start.y));
            Made { patches, boundary, anchor }
        })
    }

    fn hierarchy(&self) -> &Hierarchy {
        self.hierarchy.get_or_init(|| self.made().patches.hierarchy(self.surface(), Arc::clone(&self.trimming)))
    }

    /// A box that holds the trimmed part.
    pub(crate) fn bounds(&self) -> Aabb {
        self.made().patches.bounds()
    }

    /// The nearest point of the trimmed surface; none where it is proven that none lies within the query's `max_distance`.
    pub(crate) fn project(
        &self,
        query: &Query,
        closed_form: Option<&ClosedForm>,
        reader: Reader<'_>,
        scratch: &mut Scratch,
    ) -> Option<FootPoint> {
        let frame = self.made().patches.frame();
        let gap = query.options.gap.unwrap_or(DEFAULT_GAP * frame.size);
        let coincidence = query.options.coincidence.unwrap_or(1e-6 * frame.size);
        let options = QueryOptions { gap: Some(gap), coincidence: Some(coincidence), ..query.options };
        if query.options.max_distance.is_some_and(|limit| self.is_beyond(query.point, limit)) {
            return None;
        }
        let foot = self.answer(&Query { options, ..*query }, closed_form, reader, scratch)?;
        let limit = query.options.max_distance.unwrap_or(f64::INFINITY);
        if foot.distance <= limit {
            return Some(foot);
        }
        if foot.lower_bound >= limit {
            return None;
        }
        // whether a foot just beyond the limit is all there is needs a finer proof
        let finer = QueryOptions { gap: Some((0.5 * (foot.distance - limit)).min(gap)), ..options };
        let foot = self.answer(&Query { options: finer, ..*query }, closed_form, reader, scratch)?;
        (foot.distance <= limit || foot.lower_bound < limit).then_some(foot)
    }

    fn answer(
        &self,
        query: &Query,
        closed_form: Option<&ClosedForm>,
        reader: Reader<'_>,
        scratch: &mut Scratch,
    ) -> Option<FootPoint> {
        scratch.statistics.queries += 1;
        if let Some(closed_form) = closed_form.filter(|form| form.has_one_minimum()) {
            match closed_form.solve(query, None, scratch) {
                Solved::Foot(solution) => {
                    if let Some(at) = self.inside(reader, solution.u, solution.v) {
                        return Some(self.written_foot(reader, at, solution, closed_form.method()));
                    }
                    let off = 2.0 * closed_form.deviation() + self.length(self.made().boundary.error());
                    let limit = query.options.max_distance.map(|limit| limit + off);
                    let foot = self.on_boundary(query, limit, scratch)?;
                    let lower = self.length(foot.solution.lower_bound) - 2.0 * closed_form.deviation();
                    return Some(self.written(
                        query,
                        reader,
                        Outcome {
                            at: foot.at,
                            lower_bound: lower.max(0.0),
                            on_boundary: Some(foot.is_vertex),
                            tie: foot.solution.tie,
                            method: Method::Trimmed,
                        },
                    ));
                }
                Solved::Beyond => return None,
                Solved::Declined => scratch.statistics.declined += 1,
            }
        }
        self.by_hierarchy(query, scratch).map(|outcome| self.written(query, reader, outcome))
    }

    fn by_hierarchy(&self, query: &Query, scratch: &mut Scratch) -> Option<Outcome> {
        let made = self.made();
        let mut workspace = std::mem::take(&mut scratch.hierarchy);
        let mut on_boundary = None;
        let mut boundary = |limit: Option<f64>| {
            let foot =
                self.on_boundary(query, limit.map(|limit| self.length(limit + made.boundary.error())), scratch)?;
            let point = BoundaryPoint {
                point: made.patches.frame().enter(query.point) + foot.solution.offset,
                distance: foot.solution.distance,
                lower_bound: foot.solution.lower_bound,
            };
            on_boundary = Some(foot);
            Some(point)
        };
        let found = self.hierarchy().project_trimmed(query, made.anchor, &mut boundary, &mut workspace);
        scratch.hierarchy = workspace;
        Some(match found {
            TrimmedFoot::Beyond(done) => {
                scratch.statistics.proof += done;
                return None;
            }
            TrimmedFoot::Inside(solution, instead) => {
                scratch.statistics.proof += solution.done;
                let at = instead.unwrap_or(DVec2::new(solution.u, solution.v));
                let lower_bound = self.length(solution.lower_bound);
                Outcome { at, lower_bound, on_boundary: None, tie: solution.tie, method: Method::Trimmed }
            }
            TrimmedFoot::OnBoundary { lower_bound, done } => {
                scratch.statistics.proof += done;
                let foot = on_boundary.expect("the boundary was asked");
                Outcome {
                    at: foot.at,
                    lower_bound: self.length(lower_bound),
                    on_boundary: Some(foot.is_vertex),
                    tie: foot.solution.tie,
                    method: Method::Trimmed,
                }
            }
        })
    }

    /// Whether the box of the trimmed part tells that it is beyond a distance.
    fn is_beyond(&self, p: DVec3, limit: f64) -> bool {
        let bounds = self.bounds();
        let rounding = 8.0 * f64::EPSILON * bounds.reach().max(p.abs().max_element());
        bounds.distance_squared(p).sqrt() - rounding > limit
    }

    /// The boundary's foot, within `limit` (in the model's unit) if there is one.
    fn on_boundary(&self, query: &Query, limit: Option<f64>, scratch: &mut Scratch) -> Option<BoundaryFoot> {
        let made = self.made();
        let gap = query.options.gap.unwrap_or_default();
        // what the curves' error takes away is sought closer, where that leaves anything
        let left = gap - 2.0 * self.length(made.boundary.error());
        let gap = if left > 0.5 * gap { left } else { gap };
        let options = QueryOptions { gap: Some(gap), max_distance: limit, ..query.options };
        let foot =
            made.boundary.project(&Query { options, ..*query }, self.trimming.region(), &mut scratch.boundary)?;
        scratch.statistics.proof += foot.solution.done;
        Some(foot)
    }

    /// A length of the entity's own coordinates in the model's unit.
    fn length(&self, local: f64) -> f64 {
        self.made().patches.frame().length(local)
    }

    /// Parameters of a foot, if they lie in the region; on a seam, on either side of it.
    fn inside(&self, reader: Reader<'_>, u: f64, v: f64) -> Option<DVec2> {
        let landmarks = reader.landmarks;
        let twin = |d: usize, at: f64| {
            let (first, last) = landmarks.ends[d];
            match landmarks.closed[d] {
                true if at == first => last,
                true if at == last => first,
                _ => at,
            }
        };
        let (other_u, other_v) = (twin(0, u), twin(1, v));
        [(u, v), (other_u, v), (u, other_v), (other_u, other_v)]
            .map(DVec2::from)
            .into_iter()
            .find(|at| self.trimming.region().side(*at) != Side::Outside)
    }

    /// The answer at parameters of the region.
    fn written(&self, query: &Query, reader: Reader<'_>, outcome: Outcome) -> FootPoint {
        let Outcome { at, lower_bound, on_boundary, tie, method } = outcome;
        let mut d = [DVec3::ZERO; 4];
        self.surface().derivatives(at.x, at.y, 1, &mut d);
        let offset = d[0] - query.point;
        let distance = offset.length();
        let solution = Solution {
            u: at.x,
            v: at.y,
            point: Some(d[0]),
            distance,
            lower_bound: lower_bound.min(distance),
            normal: unit_normal(d[2], d[1]),
            offset,
            tie,
        };
        let mut foot = self.written_foot(reader, at, solution, method);
        if let Some(is_vertex) = on_boundary {
            foot.place = match foot.place {
                Place::Pole | Place::Cusp => foot.place,
                _ if is_vertex => Place::Vertex,
                Place::Seam if self.goes_on_over_seam(reader, at) => Place::Seam,
                _ => Place::TrimEdge,
            };
        }
        foot
    }

    /// Whether the region goes on at the other side of the seam on which these parameters lie.
    fn goes_on_over_seam(&self, reader: Reader<'_>, at: DVec2) -> bool {
        let landmarks = reader.landmarks;
        (0..2).any(|d| {
            let (first, last) = landmarks.ends[d];
            let mut other = at;
            other[d] = if at[d] == first { last } else { first };
            landmarks.closed[d]
                && (at[d] == first || at[d] == last)
                && self.trimming.region().side(other) != Side::Outside
        })
    }

    /// Whether p-curves meet at these parameters, but for rounding.
    fn is_vertex(&self, at: DVec2) -> bool {
        let near = |end: DVec2| (end - at).abs().cmple(4.0 * f64::EPSILON * at.abs()).all();
        let pieces = self.trimming.region().pieces();
        pieces.iter().any(|piece| (piece.begins_curve && near(piece.start)) || (piece.ends_curve && near(piece.end)))
    }

    /// The answer that a solution at parameters of the region is, as far as the carrier tells; with the outward normal.
    fn written_foot(&self, reader: Reader<'_>, at: DVec2, solution: Solution, method: Method) -> FootPoint {
        let (u, v) = (at.x, at.y);
        let mut foot = reader.answer(&Solution { u, v, ..solution }, method);
        let kept = |parameter: Parameter| {
            let there = DVec2::new(parameter.u(), parameter.v().unwrap_or_default());
            self.trimming.region().side(there) != Side::Outside
        };
        if !kept(foot.parameter) {
            // the lower side of a seam was trimmed away
            foot.parameter = Parameter::Surface(u, v);
            foot.point = self.surface().point(u, v);
        }
        foot.place = match foot.place {
            Place::Edge => Place::TrimEdge,
            Place::Corner => Place::Vertex,
            Place::Interior | Place::Crease if self.trimming.region().side(at) == Side::Boundary => {
                if self.is_vertex(at) { Place::Vertex } else { Place::TrimEdge }
            }
            place => place,
        };
        if self.trimming.reversed() {
            foot.normal = foot.normal.map(|normal| -normal);
            foot.signed_distance = foot.signed_distance.map(|distance| -distance);
        }
        foot
    }
}
