//! P-curves: pieces of edges as curves in the parameters of the carrier's NURBS.

use glam::DVec2;
use perpend::NurbsCurve;
use perpend::kernel::TrimCurveData;

use super::carrier::{Carrier, Form};
use super::open::root;
use super::trace::Piece;
use super::window::Window;

/// How often a part of a piece is halved at most.
const DEPTH: u32 = 14;

/// A p-curve has no more cubics than about this.
const MOST: usize = 2048;

/// A step for a difference quotient, as a share of the part that it is taken on.
const STEP: f64 = 1e-3;

/// Tangents that differ by less than this, as a share, are one.
const SMOOTH: f64 = 1e-5;

/// What p-curves are made with.
pub(super) struct Fit<'a> {
    pub(super) carrier: &'a Carrier,
    pub(super) window: &'a Window,
    pub(super) curves: &'a [NurbsCurve],
    /// The largest distance of a p-curve's image from the projection of its edge.
    pub(super) tolerance: f64,
}

/// How far a line of constant coordinate may lie from the projection of an edge, as a share of how far the edge lies off the surface.
const STRAIGHT: f64 = 1.0;

/// The same of a curve that is fitted to it.
const FITTED: f64 = 0.1;

/// A p-curve before its ends are fixed.
#[derive(Debug, Clone)]
pub(super) struct Flat {
    pub(super) degree: usize,
    pub(super) knots: Vec<f64>,
    pub(super) points: Vec<DVec2>,
    pub(super) weights: Option<Vec<f64>>,
    /// The parameters that are constant along it.
    pub(super) constant: [bool; 2],
    pub(super) edge: Option<usize>,
}

impl Flat {
    pub(super) fn line(from: DVec2, to: DVec2, constant: [bool; 2], edge: Option<usize>) -> Self {
        Self { degree: 1, knots: vec![0.0, 0.0, 1.0, 1.0], points: vec![from, to], weights: None, constant, edge }
    }

    pub(super) fn start(&self) -> DVec2 {
        self.points[0]
    }

    pub(super) fn end(&self) -> DVec2 {
        self.points[self.points.len() - 1]
    }

    /// With other ends; what is next to an end moves along with it.
    pub(super) fn with_ends(mut self, start: DVec2, end: DVec2) -> Self {
        let last = self.points.len() - 1;
        let (first_step, last_step) = (start - self.points[0], end - self.points[last]);
        if last >= 3 {
            self.points[1] += first_step;
            self.points[last - 1] += last_step;
        }
        (self.points[0], self.points[last]) = (start, end);
        self
    }

    /// As trims hold it, without its edge.
    pub(super) fn data(self) -> TrimCurveData {
        let Self { degree, knots, points, weights, .. } = self;
        TrimCurveData { degree, knots, points, weights, edge: None }
    }
}

impl Fit<'_> {
    /// The p-curve of a piece.
    pub(super) fn curve(&self, piece: &Piece) -> Flat {
        let constant = [0, 1].map(|k| self.is_constant(piece, k));
        let to = |at: DVec2| self.window.parameters(at);
        let Some(edge) = piece.edge else {
            return Flat::line(to(piece.start()), to(piece.end()), constant, None);
        };
        for k in 0..2 {
            if constant[k] {
                let (mut from, mut end) = (piece.start(), piece.end());
                let value = 0.5 * (from[k] + end[k]);
                (from[k], end[k]) = (value, value);
                return Flat::line(to(from), to(end), constant, Some(edge));
            }
        }
        if matches!(self.carrier.form, Form::Plane(_)) {
            return self.on_plane(piece, edge);
        }
        self.fitted(piece, edge)
    }

    /// Whether a coordinate is the same all along, up to the tolerance, and the other one runs one way.
    fn is_constant(&self, piece: &Piece, k: usize) -> bool {
        let (from, end) = (piece.start(), piece.end());
        let value = 0.5 * (from[k] + end[k]);
        let forth = end[1 - k] > from[1 - k];
        let hair = self.carrier.hair(1 - k);
        let tolerance = self.tolerance.max(STRAIGHT * piece.off);
        let along = piece.at.windows(2).all(|pair| {
            let step = pair[1][1 - k] - pair[0][1 - k];
            if forth { step >= -hair } else { step <= hair }
        });
        along
            && piece.at.iter().all(|at| {
                let mut moved = *at;
                moved[k] = value;
                let most = 0.25 * self.carrier.periods[k].unwrap_or(f64::INFINITY);
                (at[k] - value).abs() < most && self.carrier.point(*at).distance(self.carrier.point(moved)) <= tolerance
            })
    }

    /// The image of the edge's control points: exact.
    fn on_plane(&self, piece: &Piece, edge: usize) -> Flat {
        let curve = &self.curves[edge];
        let curve = if piece.t[0] > piece.t[piece.t.len() - 1] { curve.reversed() } else { curve.clone() };
        let Form::Plane(frame) = &self.carrier.form else { unreachable!("the carrier is a plane") };
        let [(a, b), (c, d)] = self.window.linear_ranges();
        let to = |p: glam::DVec3| {
            let arm = p - frame.centre;
            DVec2::new((arm.dot(frame.xdir) - a) / (b - a), (arm.dot(frame.ydir()) - c) / (d - c))
        };
        Flat {
            degree: curve.degree(),
            knots: curve.knots().as_slice().to_vec(),
            points: curve.control_points().iter().map(|p| to(*p)).collect(),
            weights: curve.weights().map(<[f64]>::to_vec),
            constant: [false; 2],
            edge: Some(edge),
        }
    }

    /// Cubic pieces that share their ends and tangents with the edge's projection.
    fn fitted(&self, piece: &Piece, edge: usize) -> Flat {
        let (first, last) = (piece.t[0], piece.t[piece.t.len() - 1]);
        let mut breaks = vec![first];
        breaks.extend(self.breaks(piece, edge));
        breaks.push(last);
        let mut cubics: Vec<Cubic> = Vec::new();
        for pair in breaks.windows(2) {
            self.refine(piece, (pair[0], pair[1]), 0, &mut cubics);
        }
        let share = |t: f64| (t - first) / (last - first);
        let (mut knots, mut points) = (vec![0.0; 4], vec![cubics[0].points[0]]);
        let count = cubics.len();
        for i in 0..count {
            let [_, b, c, d] = cubics[i].points;
            points.extend([b, c]);
            if i + 1 == count {
                points.push(d);
                break;
            }
            let next = &cubics[i + 1];
            let (h, g) = (share(cubics[i].t.1) - share(cubics[i].t.0), share(next.t.1) - share(next.t.0));
            let at = share(cubics[i].t.1);
            let (before, after) = ((d - c) / h, (next.points[1] - next.points[0]) / g);
            let is_smooth = (before - after).length() <= SMOOTH * before.length().max(after.length());
            if is_smooth {
                // one tangent for both: then the point between is theirs, and need not be stored
                let tangent = 0.5 * (before + after);
                let last = points.len() - 1;
                points[last] = d - h * tangent;
                cubics[i + 1].points[1] = d + g * tangent;
                knots.extend([at; 2]);
            } else {
                points.push(d);
                knots.extend([at; 3]);
            }
        }
        knots.extend([1.0; 4]);
        Flat { degree: 3, knots, points, weights: None, constant: [false; 2], edge: Some(edge) }
    }

    /// The parameters inside where the edge or the surface is not smooth, in the piece's order.
    fn breaks(&self, piece: &Piece, edge: usize) -> Vec<f64> {
        let (first, last) = (piece.t[0], piece.t[piece.t.len() - 1]);
        let (low, high) = (first.min(last), first.max(last));
        let mut breaks: Vec<f64> = self.curves[edge].knots().breaks().map(|knot| knot.at).collect();
        for k in 0..2 {
            for value in self.window.joints(k) {
                for i in 1..piece.t.len() {
                    let (a, b) = (piece.at[i - 1][k], piece.at[i][k]);
                    if (a < value) != (b < value) {
                        breaks.push(root(self.carrier, self.curves, piece, i, k, value).0);
                    }
                }
            }
        }
        let hair = 1e-7 * (high - low);
        breaks.retain(|t| *t > low + hair && *t < high - hair);
        breaks.sort_by(f64::total_cmp);
        breaks.dedup_by(|a, b| *a - *b <= hair);
        if first > last {
            breaks.reverse();
        }
        breaks
    }

    fn refine(&self, piece: &Piece, t: (f64, f64), depth: u32, out: &mut Vec<Cubic>) {
        let cubic = self.cubic(piece, t);
        let tolerance = self.tolerance.max(FITTED * piece.off);
        let is_near = |share: f64| {
            let wanted = self.parameters(piece, t.0 + share * (t.1 - t.0));
            let found = cubic.point(share);
            let surface = &self.window.surface;
            surface.point(found.x, found.y).distance(surface.point(wanted.x, wanted.y)) <= tolerance
        };
        if depth == DEPTH || out.len() > MOST || [0.5, 0.25, 0.75, 0.1, 0.9].into_iter().all(is_near) {
            out.push(cubic);
            return;
        }
        let middle = 0.5 * (t.0 + t.1);
        self.refine(piece, (t.0, middle), depth + 1, out);
        self.refine(piece, (middle, t.1), depth + 1, out);
    }

    fn parameters(&self, piece: &Piece, t: f64) -> DVec2 {
        self.window.parameters(piece.place(self.carrier, self.curves, t))
    }

    /// The cubic with the places and tangents of the ends of a range.
    fn cubic(&self, piece: &Piece, t: (f64, f64)) -> Cubic {
        let at = |share: f64| self.parameters(piece, t.0 + share * (t.1 - t.0));
        let (start, end) = (at(0.0), at(1.0));
        // one-sided quotients of second order: the edge may bend sharply at its ends
        let forth = (4.0 * at(STEP) - at(2.0 * STEP) - 3.0 * start) / (2.0 * STEP);
        let back = (4.0 * at(1.0 - STEP) - at(1.0 - 2.0 * STEP) - 3.0 * end) / (2.0 * STEP);
        Cubic { t, points: [start, start + forth / 3.0, end + back / 3.0, end] }
    }
}

/// A cubic in Bézier form over a range of an edge's parameter.
struct Cubic {
    t: (f64, f64),
    points: [DVec2; 4],
}

impl Cubic {
    fn point(&self, share: f64) -> DVec2 {
        let [a, b, c, d] = self.points;
        let (ab, bc, cd) = (a.lerp(b, share), b.lerp(c, share), c.lerp(d, share));
        ab.lerp(bc, share).lerp(bc.lerp(cd, share), share)
    }
}
