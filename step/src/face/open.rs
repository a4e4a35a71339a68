//! Closed surfaces cut open, so that a face's loops are closed in the plane of its coordinates.
//!
//! Rings that run through whole periods (the two circles that bound a part of a cylinder) bound a region only together with a cut along a
//! line of constant coordinate. All rings are split at that line, and what is left of them is linked along its two sides, with the material
//! on the left: along the line, and around the ends of the other coordinate (poles, edges of the domain) where no more parts begin on it.

use glam::DVec2;
use perpend::NurbsCurve;

use super::FaceError;
use super::carrier::Carrier;
use super::chain::Ring;
use super::trace::Piece;

/// How far edges may go on beyond a seam of the file, as a share of the period: such ends are clamped.
const OVERSHOOT: f64 = 1e-3;

/// A ring of less area than this share of the largest beside it bounds nothing.
const SLIVER: f64 = 1e-9;

/// The rings of a face, closed in the plane, and the ranges of a whole period that its coordinates have where the surface was cut open.
pub(super) struct Opened {
    pub(super) rings: Vec<Ring>,
    pub(super) full: [Option<(f64, f64)>; 2],
}

/// Cuts the carrier open as the rings ask; they have their material on the left.
pub(super) fn open(carrier: &Carrier, curves: &[NurbsCurve], rings: Vec<Ring>) -> Result<Opened, FaceError> {
    let mut opened = Opened { rings, full: [None; 2] };
    let winds = |rings: &[Ring], k: usize| rings.iter().any(|ring| ring.winding(carrier, k) != 0);
    let order = if winds(&opened.rings, 0) { [1, 0] } else { [0, 1] };
    let is_bounded = (0..2)
        .all(|k| carrier.periods[k].is_some() || carrier.limits[k].0.is_finite() && carrier.limits[k].1.is_finite());
    let unbounded_by_rings =
        !winds(&opened.rings, 0) && !winds(&opened.rings, 1) && !opened.rings.iter().any(|ring| ring.area() > 0.0);
    if unbounded_by_rings {
        if opened.rings.is_empty() && !is_bounded {
            return Err(FaceError::Unbounded);
        }
        if carrier.periods == [None; 2] || !is_bounded {
            // a file with its loops the wrong way round: the largest bounds the material
            opened.rings = opened.rings.into_iter().map(Ring::reversed).collect();
        } else {
            return whole(carrier, curves, opened.rings);
        }
    }
    for k in order {
        let Some(period) = carrier.periods[k] else { continue };
        if winds(&opened.rings, k) {
            let at = cut_place(carrier, &opened.rings, k, period);
            opened.rings = cut(carrier, curves, opened.rings, k, at)?;
            opened.full[k] = Some((at, at + period));
            continue;
        }
        let (rings, range) = gathered(carrier, opened.rings, k, period);
        opened.rings = rings;
        let hair = carrier.hair(k);
        if let Some(seam) =
            seam(carrier, &opened.rings, k, period).filter(|_| range.1 - range.0 <= (1.0 + OVERSHOOT) * period)
        {
            opened.full[k] = Some((seam, seam + period));
        } else if range.1 - range.0 > period + 4.0 * hair {
            let at = cut_place(carrier, &opened.rings, k, period);
            opened.rings = cut(carrier, curves, opened.rings, k, at)?;
            opened.full[k] = Some((at, at + period));
        } else if range.1 - range.0 > period - 4.0 * hair {
            opened.full[k] = Some((range.0, range.0 + period));
        }
    }
    Ok(opened)
}

/// Where the file has cut the surface itself: the constant coordinate of edges that lie a period apart.
fn seam(carrier: &Carrier, rings: &[Ring], k: usize, period: f64) -> Option<f64> {
    let hair = carrier.hair(k);
    let pieces = rings.iter().flat_map(|ring| &ring.pieces).filter(|piece| piece.edge.is_some());
    let straight = pieces.filter_map(|piece| {
        let (low, high) = extent(piece.at.iter().map(|at| at[k]));
        (high - low <= hair).then_some(0.5 * (low + high))
    });
    let (low, high) = extent(straight);
    (((high - low) - period).abs() <= 4.0 * hair).then_some(low)
}

/// The least and the largest.
fn extent(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
}

/// A whole closed surface, with holes.
fn whole(carrier: &Carrier, curves: &[NurbsCurve], rings: Vec<Ring>) -> Result<Opened, FaceError> {
    let mut ranges = carrier.limits;
    let mut opened = Opened { rings, full: [None; 2] };
    let mut crossed = false;
    for (k, range) in ranges.iter_mut().enumerate() {
        let Some(period) = carrier.periods[k] else { continue };
        let at = if opened.rings.is_empty() { 0.0 } else { cut_place(carrier, &opened.rings, k, period) };
        let at = match carrier.nurbs() {
            Some(_) if opened.rings.is_empty() => carrier.base(k),
            _ => at,
        };
        crossed |= opened.rings.iter().any(|ring| crossings(ring, k, at, period, carrier.hair(k)) > 0);
        opened.rings = cut(carrier, curves, opened.rings, k, at)?;
        opened.full[k] = Some((at, at + period));
        *range = (at, at + period);
    }
    if crossed {
        return Ok(opened);
    }
    opened.rings.insert(0, frame(ranges));
    Ok(opened)
}

/// The border of a box of coordinates, counter-clockwise.
pub(super) fn frame([(u0, u1), (v0, v1)]: [(f64, f64); 2]) -> Ring {
    let corners = [(u0, v0), (u1, v0), (u1, v1), (u0, v1), (u0, v0)].map(|(u, v)| DVec2::new(u, v));
    Ring { pieces: corners.windows(2).map(|pair| Piece::join(pair[0], pair[1])).collect() }
}

/// Rings moved by whole periods, each next to the one that bounds them, and the range of their coordinate.
fn gathered(carrier: &Carrier, rings: Vec<Ring>, k: usize, period: f64) -> (Vec<Ring>, (f64, f64)) {
    if rings.is_empty() {
        return (rings, (0.0, 0.0));
    }
    // of rings that wind about the other coordinate, the one whose material lies above it; otherwise the largest
    let side = if k == 1 { 1 } else { -1 };
    let first = rings.iter().find(|ring| ring.winding(carrier, 1 - k) == side).or_else(|| {
        let area = |ring: &&Ring| ring.area();
        rings.iter().max_by(|a, b| area(a).total_cmp(&area(b)))
    });
    let base = first.expect("a ring").extent(k);
    let hair = carrier.hair(k);
    let moved: Vec<Ring> = rings
        .into_iter()
        .map(|ring| {
            let extent = ring.extent(k);
            let mut by = DVec2::ZERO;
            by[k] = ((base.0 - 4.0 * hair - extent.0) / period).ceil() * period;
            ring.moved(by)
        })
        .collect();
    let range = extent(moved.iter().map(|ring| ring.extent(k)).flat_map(|(low, high)| [low, high]));
    (moved, range)
}

/// Where to cut: at an end of a piece where that splits the fewest, first of rings that do not wind.
fn cut_place(carrier: &Carrier, rings: &[Ring], k: usize, period: f64) -> f64 {
    let hair = carrier.hair(k);
    let ends = rings.iter().flat_map(|ring| &ring.pieces).map(|piece| piece.start()[k]);
    let base = rings[0].pieces[0].start()[k];
    let even = (0..64).map(|i| base + period * f64::from(i) / 64.0);
    let cost = |at: f64| {
        let all: usize = rings.iter().map(|ring| crossings(ring, k, at, period, hair)).sum();
        let holes = rings.iter().filter(|ring| ring.winding(carrier, k) == 0);
        // one that the cut touches would become a part of the outline
        let touches = |ring: &Ring| {
            let places = ring.pieces.iter().flat_map(|piece| &piece.at);
            places.filter(|place| matches!(strip(place[k], at, period, hair), Strip::Line(_))).count()
        };
        let holes: usize = holes.map(|ring| crossings(ring, k, at, period, hair) + touches(ring)).sum();
        let split: usize =
            rings.iter().flat_map(|ring| &ring.pieces).map(|piece| splits(piece, k, at, period, hair)).sum();
        (holes, all, split)
    };
    ends.chain(even).min_by_key(|at| cost(*at)).unwrap_or(base)
}

/// The line on which a coordinate lies, or the strip between two lines.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Strip {
    Line(i64),
    Above(i64),
}

fn strip(x: f64, at: f64, period: f64, hair: f64) -> Strip {
    let share = (x - at) / period;
    if (share - share.round()).abs() * period <= hair {
        Strip::Line(share.round() as i64)
    } else {
        Strip::Above(share.floor() as i64)
    }
}

/// How often a ring goes from one strip to another.
fn crossings(ring: &Ring, k: usize, at: f64, period: f64, hair: f64) -> usize {
    let strips =
        ring.pieces.iter().flat_map(|piece| &piece.at).filter_map(|place| match strip(place[k], at, period, hair) {
            Strip::Above(k) => Some(k),
            Strip::Line(_) => None,
        });
    let strips: Vec<i64> = strips.collect();
    strips.windows(2).filter(|pair| pair[0] != pair[1]).count()
}

/// How often a piece crosses a line inside.
fn splits(piece: &Piece, k: usize, at: f64, period: f64, hair: f64) -> usize {
    crossings(&Ring { pieces: vec![piece.clone()] }, k, at, period, hair)
}

/// A part of a ring in one strip, moved into the first; its ends lie on the cut.
struct Arc {
    pieces: Vec<Piece>,
    /// Of the start and the end: whether on the upper side of the cut, and the other coordinate there.
    ends: [(bool, f64); 2],
}

/// The rings split at the line `at` of coordinate `k` and linked along it.
fn cut(carrier: &Carrier, curves: &[NurbsCurve], rings: Vec<Ring>, k: usize, at: f64) -> Result<Vec<Ring>, FaceError> {
    let period = carrier.periods[k].expect("a coordinate with a period is cut");
    let (mut done, mut arcs) = (Vec::new(), Vec::new());
    for ring in rings {
        let winding = ring.winding(carrier, k);
        let parts: Vec<(Piece, i64)> =
            ring.pieces.iter().flat_map(|piece| split(carrier, curves, piece, k, at, period)).collect();
        let count = parts.len();
        // where the next part lies in another strip; the first one's is counted on from the last's
        let breaks = |i: usize| {
            let next = if i + 1 == count { parts[0].1 + winding } else { parts[i + 1].1 };
            parts[i].1 != next
        };
        let into_window = |(piece, strip): &(Piece, i64)| {
            let mut by = DVec2::ZERO;
            by[k] = -(*strip as f64) * period;
            let mut piece = piece.clone().moved(by);
            for place in &mut piece.at {
                place[k] = place[k].clamp(at, at + period);
            }
            piece
        };
        let Some(last) = (0..count).find(|i| breaks(*i)) else {
            done.push(Ring { pieces: parts.iter().map(into_window).collect() });
            continue;
        };
        let mut pieces: Vec<Piece> = Vec::new();
        for i in (last + 1..=last + count).map(|i| i % count) {
            pieces.push(into_window(&parts[i]));
            if breaks(i) {
                let whole = std::mem::take(&mut pieces);
                arcs.push(arc(whole, k, at, period));
            }
        }
    }
    let linked = link(carrier, arcs, k, at, period)?;
    // slivers that the rounding of the cut left
    let largest = linked.iter().map(|ring| ring.area().abs()).fold(0.0, f64::max);
    done.extend(
        linked.into_iter().filter(|ring| ring.winding(carrier, 1 - k) != 0 || ring.area().abs() > SLIVER * largest),
    );
    Ok(done)
}

fn arc(mut pieces: Vec<Piece>, k: usize, at: f64, period: f64) -> Arc {
    let last = pieces.len() - 1;
    let side = |x: f64| x - at > 0.5 * period;
    let snapped = |place: &mut DVec2| {
        let upper = side(place[k]);
        place[k] = if upper { at + period } else { at };
        (upper, place[1 - k])
    };
    let start = snapped(&mut pieces[0].at[0]);
    let end = snapped(pieces[last].at.last_mut().expect("a piece has places"));
    Arc { pieces, ends: [start, end] }
}

/// The parts of a piece with the strips they lie in; split only where the strip changes.
fn split(carrier: &Carrier, curves: &[NurbsCurve], piece: &Piece, k: usize, at: f64, period: f64) -> Vec<(Piece, i64)> {
    let hair = carrier.hair(k);
    let piece = with_crossings(carrier, curves, piece, k, at, period);
    let strips: Vec<Strip> = piece.at.iter().map(|place| strip(place[k], at, period, hair)).collect();
    let mut parts: Vec<(Piece, i64)> = Vec::new();
    let (mut first, mut current) = (0, None);
    for (i, this) in strips.iter().enumerate() {
        if let Strip::Above(strip) = this {
            match current {
                Some(before) if before != *strip => {
                    // the last place on a line before this one
                    let on = (first..i).rev().find(|j| matches!(strips[*j], Strip::Line(_))).expect("a crossing");
                    parts.push((piece.between(first, on), before));
                    first = on;
                }
                _ => {}
            }
            current = Some(*strip);
        }
    }
    let last = strips.len() - 1;
    let strip = current.unwrap_or_else(|| {
        // on the line: above it where the material on its left is
        let Strip::Line(line) = strips[0] else { unreachable!("no place is off the line") };
        let ascends = piece.end()[1 - k] > piece.start()[1 - k];
        if ascends == (k == 1) { line } else { line - 1 }
    });
    parts.push((piece.between(first, last), strip));
    parts
}

/// The piece with a place more on every line that it crosses.
fn with_crossings(carrier: &Carrier, curves: &[NurbsCurve], piece: &Piece, k: usize, at: f64, period: f64) -> Piece {
    let hair = carrier.hair(k);
    let mut all = Piece { t: vec![piece.t[0]], at: vec![piece.at[0]], ..piece.clone() };
    for i in 1..piece.t.len() {
        let (a, b) = (piece.at[i - 1][k], piece.at[i][k]);
        if let (Strip::Above(from), Strip::Above(to)) = (strip(a, at, period, hair), strip(b, at, period, hair))
            && from != to
        {
            let line = at + period * from.max(to) as f64;
            let (t, mut place) = root(carrier, curves, piece, i, k, line);
            place[k] = line;
            all.t.push(t);
            all.at.push(place);
        }
        all.t.push(piece.t[i]);
        all.at.push(piece.at[i]);
    }
    all
}

/// Where a piece takes a value of a coordinate between its places `i - 1` and `i`, by bisection.
pub(super) fn root(
    carrier: &Carrier,
    curves: &[NurbsCurve],
    piece: &Piece,
    i: usize,
    k: usize,
    value: f64,
) -> (f64, DVec2) {
    let (mut low, mut high) = (piece.t[i - 1], piece.t[i]);
    let below = piece.at[i - 1][k] < value;
    let mut place = piece.at[i - 1];
    if piece.edge.is_none() {
        let share = (value - piece.at[i - 1][k]) / (piece.at[i][k] - piece.at[i - 1][k]);
        return (low + share * (high - low), piece.at[i - 1].lerp(piece.at[i], share));
    }
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        place = piece.place(carrier, curves, middle);
        if (place[k] < value) == below {
            low = middle;
        } else {
            high = middle;
        }
    }
    (0.5 * (low + high), place)
}

/// Arcs linked along the cut, with the material on the left.
fn link(carrier: &Carrier, arcs: Vec<Arc>, k: usize, at: f64, period: f64) -> Result<Vec<Ring>, FaceError> {
    let other = 1 - k;
    let (hair, turn, limits) = (carrier.hair(other), carrier.periods[other], carrier.limits[other]);
    // the boundary of the strip runs this way along its upper side, and the other way along its lower one
    let upper_sign = if k == 1 { -1.0 } else { 1.0 };
    let sign = |upper: bool| if upper { upper_sign } else { -upper_sign };
    let place = |upper: bool, along: f64| {
        let mut place = DVec2::ZERO;
        place[k] = if upper { at + period } else { at };
        place[other] = along;
        place
    };
    let mut arcs: Vec<Option<Arc>> = arcs.into_iter().map(Some).collect();
    let starts: Vec<(bool, f64)> = arcs.iter().flatten().map(|arc| arc.ends[0]).collect();
    // the arc that begins next on a side, going on from a place: its index and how far that is
    let next = |upper: bool, from: f64, open: &dyn Fn(usize) -> bool| -> Option<(usize, f64)> {
        let ways = starts.iter().enumerate().filter(|(i, start)| start.0 == upper && open(*i)).map(|(i, start)| {
            let way = (start.1 - from) * sign(upper);
            (i, turn.map_or(way, |turn| (way + hair).rem_euclid(turn) - hair))
        });
        ways.filter(|(_, way)| *way >= -hair).min_by(|a, b| a.1.total_cmp(&b.1))
    };
    let mut rings = Vec::new();
    while let Some(first) = arcs.iter().position(Option::is_some) {
        let mut current = arcs[first].take().expect("an arc that is left");
        let mut pieces: Vec<Piece> = Vec::new();
        let mut by = 0.0;
        loop {
            let (mut upper, mut along) = (current.ends[1].0, current.ends[1].1 + by);
            let mut moved = DVec2::ZERO;
            moved[other] = by;
            pieces.extend(current.pieces.into_iter().map(|piece| piece.moved(moved)));
            let mut corners = 0;
            let (index, to) = loop {
                let open = |i: usize| i == first || arcs[i].is_some();
                if let Some((index, way)) = next(upper, along, &open) {
                    break (index, along + way * sign(upper));
                }
                // on around the end of the strip
                let limit = if sign(upper) > 0.0 { limits.1 } else { limits.0 };
                if !limit.is_finite() || corners == 2 {
                    return Err(FaceError::Unbounded);
                }
                for to in [place(upper, limit), place(!upper, limit)] {
                    let from = place(upper, along);
                    if from != to {
                        pieces.push(Piece::join(pieces.last().map_or(from, Piece::end), to));
                    }
                }
                (upper, along) = (!upper, limit);
                corners += 1;
            };
            let from = pieces.last().expect("an arc has pieces").end();
            if from.distance(place(upper, to)) > 0.0 {
                pieces.push(Piece::join(from, place(upper, to)));
            }
            by = to - starts[index].1;
            if index == first {
                break;
            }
            current = arcs[index].take().expect("an arc that is open");
        }
        rings.push(Ring { pieces });
    }
    Ok(rings)
}
