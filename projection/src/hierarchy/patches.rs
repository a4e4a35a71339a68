//! The Bézier patches of a trimmed surface's carrier, in coordinates of the trimmed part.

use fearless_simd::Level;
use glam::{DVec2, DVec3};
use perpend_kernel::{Aabb, Cover, Definition, Direction, NurbsSurface, Region, cartesian};

use super::crossed::{CROSSED_DEPTH, Trim};
use super::frame::power_of_two_below;
use super::piece::Piece;
use super::{Frame, Hierarchy, MOST_POINTS, ROUNDING, split_bent};

/// How often a patch that the boundary crosses is halved before queries beyond what its bending asks.
const PREPARED_CROSSED_DEPTH: u32 = 6;

/// How many leaves may come of that.
const MOST_LEAVES: usize = 4096;

/// The patches of a carrier in the coordinates of its trimmed part.
#[derive(Debug)]
pub(crate) struct Patches {
    frame: Frame,
    /// All of them, u-spans outermost.
    pieces: Vec<Piece>,
    /// The ends of the spans in u and in v.
    knots: [Vec<f64>; 2],
    /// How far rounding has moved them.
    reserve: f64,
    reach: f64,
    /// Holds the trimmed part, in the model's coordinates.
    bounds: Aabb,
}

impl Patches {
    /// Of a surface, about the part that a region leaves of it.
    pub(crate) fn new(definition: &Definition, surface: &NurbsSurface, region: &Region) -> Self {
        let rough = Frame::of(definition);
        let (min, max) = region.bounds();
        let (net, rational) = rough.net(definition);
        let mut points: Vec<DVec3> = Vec::new();
        let mut bounds = Aabb::EMPTY;
        for part in Piece::all(definition, &net, rational).into_iter().filter_map(|piece| piece.within(min, max)) {
            part.write_points(&mut points);
            bounds = bounds.join(Aabb::around(points.iter().copied()));
        }
        let size = rough.length(bounds.diagonal());
        let frame = if size > 0.0 {
            let origin = rough.origin + bounds.centre() / rough.scale;
            Frame { origin, scale: power_of_two_below(size).recip(), size }
        } else {
            rough
        };
        let (net, rational) = frame.net(definition);
        let reach = net.iter().fold(0.0_f64, |reach, h| reach.max(cartesian(*h).length()));
        // two cuts at parameters in either direction: three roundings a level; and the halvings of crossed leaves
        let (p, q) = surface.degree();
        let more = 12.0 * (p + q) as f64 + f64::from(CROSSED_DEPTH) * (p.max(q) as f64 + 5.0);
        let reserve = Frame::reserve((p, q), reach) + more * ROUNDING * reach;
        let room = DVec3::splat(rough.length(8.0 * reserve_of(surface, &rough, definition)));
        let world = |local: DVec3| rough.origin + local / rough.scale;
        let bounds = Aabb { min: world(bounds.min) - room, max: world(bounds.max) + room };
        let knots = [Direction::U, Direction::V].map(|along| {
            let knots = surface.knots(along);
            knots.spans().map(|span| span.end).collect()
        });
        Self { frame, pieces: Piece::all(definition, &net, rational), knots, reserve, reach, bounds }
    }

    pub(crate) fn frame(&self) -> Frame {
        self.frame
    }

    /// A box that holds the trimmed part, in the model's coordinates.
    pub(crate) fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// The patch that holds these parameters: degree, homogeneous net and ranges.
    pub(crate) fn holding(&self, at: DVec2) -> Patch<'_> {
        let span = |axis: usize| {
            let ends: &[f64] = &self.knots[axis];
            ends.partition_point(|end| *end <= at[axis]).min(ends.len() - 1)
        };
        let piece = &self.pieces[span(0) * self.knots[1].len() + span(1)];
        Patch { degree: piece.degree, net: &piece.net, u: piece.u, v: piece.v }
    }

    /// How far rounding may move a curve of this degree in the parameters that is composed with a patch: `p + q` levels of products of polynomials.
    pub(crate) fn rounding(&self, degree: usize) -> f64 {
        let (p, q) = self.pieces[0].degree;
        self.reserve + ((p + q) * (4 * degree + 8)) as f64 * ROUNDING * self.reach
    }

    /// The leaves of the trimmed part.
    pub(crate) fn hierarchy(
        &self,
        surface: &NurbsSurface,
        region: std::sync::Arc<perpend_kernel::Trimming>,
    ) -> Hierarchy {
        let bounds = region.region().bounds();
        let parts = self.pieces.iter().cloned().filter_map(|piece| piece.within(bounds.0, bounds.1)).collect();
        let (mut whole, mut crossed) = (Vec::new(), Vec::new());
        let mut waiting: Vec<(Piece, u32)> =
            split_bent(parts, &mut Vec::new()).into_iter().rev().map(|piece| (piece, 0)).collect();
        while let Some((piece, depth)) = waiting.pop() {
            let cover = region.region().cover(DVec2::new(piece.u.0, piece.v.0), DVec2::new(piece.u.1, piece.v.1));
            let room = whole.len() + waiting.len() < MOST_LEAVES && whole.len() * piece.net.len() < MOST_POINTS;
            match cover {
                Cover::Outside => {}
                Cover::Crossed if depth < PREPARED_CROSSED_DEPTH && room => {
                    let direction = piece.longer();
                    let [low, high] = piece.halves(direction);
                    waiting.extend([(high, depth + 1), (low, depth + 1)]);
                }
                Cover::Inside | Cover::Crossed => {
                    whole.push(piece);
                    crossed.push(cover == Cover::Crossed);
                }
            }
        }
        let trim = Trim::new(region, crossed, surface);
        let hierarchy = Hierarchy::of_pieces(self.frame, whole, self.reserve, Level::new(), &mut Vec::new());
        Hierarchy { trim: Some(trim), ..hierarchy }
    }
}

/// How far rounding moves a surface on its way into the patches, in a frame's coordinates.
fn reserve_of(surface: &NurbsSurface, frame: &Frame, definition: &Definition) -> f64 {
    Frame::reserve(surface.degree(), frame.enter(definition.control_box().max).length())
}

/// A patch: degree, homogeneous net in row order, and the ranges of parameters that it covers.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Patch<'a> {
    pub degree: (usize, usize),
    pub net: &'a [glam::DVec4],
    pub u: (f64, f64),
    pub v: (f64, f64),
}
