//! The tight box.

use std::collections::BinaryHeap;

use glam::DVec3;
use perpend_kernel::{Aabb, cartesian};

use super::bernstein::Side;
use super::open::Open;
use super::source::{Piece, Source};

/// How far a side may stand off, as a share of the entity's size.
const TIGHT: f64 = 1e-9;

/// Halvings for each of the six sides.
const HALVINGS: usize = 4000;

/// A box that holds the entity, and the largest distance by which a side stands off from it, rounding included.
///
/// A piece lies in the box of its control points (weights are positive), and a corner is a point of it; the piece that
/// reaches farthest is halved until the two agree.
pub(super) fn bounds(source: &Source) -> (Aabb, f64) {
    let (p, q) = source.degree();
    let rounding = 16.0 * (p + q + 4) as f64 * f64::EPSILON * (source.reach + source.middle.abs().max_element());
    let mut open: [Vec<Piece>; 6] = Default::default();
    let mut attained = [f64::NEG_INFINITY; 6];
    for piece in source.pieces() {
        let corners = Aabb::around(corners(&piece));
        for (side, best) in attained.iter_mut().enumerate() {
            *best = best.max(reach(&corners, side));
        }
        let hull = Aabb::around(piece.points());
        for (side, open) in open.iter_mut().enumerate() {
            if reach(&hull, side) > attained[side] {
                open.push(piece.clone());
            }
        }
    }
    let size = 2.0 * source.reach;
    let mut bounds = attained;
    for (side, pieces) in open.into_iter().enumerate() {
        bounds[side] = farthest(pieces, side, &mut attained[side], TIGHT * size);
    }
    let gap = bounds.iter().zip(attained).map(|(bound, attained)| bound - attained).fold(0.0, f64::max);
    let [x0, y0, z0, x1, y1, z1] = bounds.map(|bound| bound + rounding);
    let middle = source.middle;
    let (min, max) = (middle - DVec3::new(x0, y0, z0), middle + DVec3::new(x1, y1, z1));
    (Aabb { min, max }, gap + 2.0 * rounding)
}

/// How far a box reaches to one of the six sides: down the axes, then up.
fn reach(of: &Aabb, side: usize) -> f64 {
    if side < 3 { -of.min[side] } else { of.max[side - 3] }
}

fn corners(piece: &Piece) -> impl Iterator<Item = DVec3> + '_ {
    piece.form.corners().map(|(k, _)| cartesian(piece.form.coefficients[k]))
}

fn farthest(pieces: Vec<Piece>, side: usize, attained: &mut f64, tolerance: f64) -> f64 {
    let hull = |piece: &Piece| reach(&Aabb::around(piece.points()), side);
    let mut open: BinaryHeap<Open<Piece>> =
        pieces.into_iter().map(|piece| Open { key: hull(&piece), item: piece }).collect();
    for _ in 0..HALVINGS {
        match open.pop() {
            Some(Open { key: bound, item: piece }) if bound > *attained + tolerance => {
                let across = wider(&piece, side);
                let (lower, upper) = piece.halves(across);
                for half in [lower, upper] {
                    *attained = attained.max(reach(&Aabb::around(corners(&half)), side));
                    open.push(Open { key: hull(&half), item: half });
                }
            }
            Some(Open { key: bound, .. }) => return bound.max(*attained),
            None => return *attained,
        }
    }
    open.peek().map_or(*attained, |Open { key: bound, .. }| bound.max(*attained))
}

/// The parameter along which the coordinate bends more.
fn wider(piece: &Piece, side: usize) -> Side {
    let (m, n) = piece.form.degree;
    let c: Vec<f64> = piece.points().map(|p| p[side % 3]).collect();
    let columns = n + 1;
    let down = (0..m * columns).map(|k| (c[k + columns] - c[k]).abs()).fold(0.0, f64::max) * m as f64;
    let along = c.chunks(columns).flat_map(|row| row.windows(2)).map(|w| (w[1] - w[0]).abs()).fold(0.0, f64::max);
    if along * n as f64 > down { Side::Second } else { Side::First }
}

#[cfg(test)]
mod tests {
    use super::*;
    use perpend_kernel::{Circle, Definition, Frame};

    #[test]
    fn the_box_of_a_circle_is_its_square() {
        let far = Frame { centre: DVec3::new(1e3, -2e3, 5.0), ..Frame::WORLD };
        let circle: Definition =
            Circle::new(far, 2.0, (0.0, std::f64::consts::TAU)).expect("valid").to_nurbs().expect("valid").into();
        let (bounds, gap) = super::bounds(&Source::of(&circle));
        let rim = Aabb { min: far.centre - DVec3::new(2.0, 2.0, 0.0), max: far.centre + DVec3::new(2.0, 2.0, 0.0) };
        assert!(gap < 1e-8, "{gap}");
        assert!(bounds.contains(rim.min) && bounds.contains(rim.max));
        assert!((bounds.min - rim.min).length() <= 2.0 * gap && (bounds.max - rim.max).length() <= 2.0 * gap);
    }
}
