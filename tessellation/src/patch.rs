//! Polynomial pieces in homogeneous form over a rectangle of parameters, and their halves.

use glam::DVec4;
use perpend_kernel::Direction;
use perpend_kernel::bezier::BezierSurface;

/// A rectangle of parameters: from `low` to `high` in u and v.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Rectangle {
    pub(crate) u: (f64, f64),
    pub(crate) v: (f64, f64),
}

/// The middle of a range that is no point: strictly inside, or none where no number is.
pub(crate) fn middle((from, to): (f64, f64)) -> Option<f64> {
    let middle = 0.5 * from + 0.5 * to;
    (from < middle && middle < to).then_some(middle)
}

/// A part of a surface that is one polynomial or rational piece.
#[derive(Debug, Clone)]
pub(crate) struct Patch {
    pub(crate) degree: (usize, usize),
    /// `(p + 1)(q + 1)` homogeneous control points, `i * (q + 1) + j`.
    pub(crate) points: Vec<DVec4>,
    pub(crate) over: Rectangle,
}

impl Patch {
    pub(crate) fn new(piece: BezierSurface) -> Self {
        let (u, v) = piece.spans;
        let over = Rectangle { u: (u.start, u.end), v: (v.start, v.end) };
        Self { degree: piece.degree, points: piece.points, over }
    }

    /// Both halves; none where the range is too short to have a middle.
    pub(crate) fn halves(&self, along: Direction) -> Option<(f64, Self, Self)> {
        let (p, q) = self.degree;
        let at = middle(match along {
            Direction::U => self.over.u,
            Direction::V => self.over.v,
        })?;
        let (mut low, mut high) = (self.clone(), self.clone());
        match along {
            Direction::U => {
                (low.over.u.1, high.over.u.0) = (at, at);
                for j in 0..=q {
                    halve(&mut low.points, &mut high.points, j, q + 1, p);
                }
            }
            Direction::V => {
                (low.over.v.1, high.over.v.0) = (at, at);
                for i in 0..=p {
                    halve(&mut low.points, &mut high.points, i * (q + 1), 1, q);
                }
            }
        }
        Some((at, low, high))
    }
}

/// De Casteljau's algorithm at one half, on the points `first + k * step`, for `k` up to the degree; both slices hold them at the start.
fn halve(low: &mut [DVec4], high: &mut [DVec4], first: usize, step: usize, degree: usize) {
    // `high` becomes the last points of each level, in place; `low` keeps the first ones
    for level in 1..=degree {
        for k in 0..=degree - level {
            high[first + k * step] = 0.5 * (high[first + k * step] + high[first + (k + 1) * step]);
        }
        low[first + level * step] = high[first];
    }
}

/// Both halves of the control points of a curve.
pub(crate) fn halves(points: &[DVec4]) -> (Vec<DVec4>, Vec<DVec4>) {
    let (mut low, mut high) = (points.to_vec(), points.to_vec());
    halve(&mut low, &mut high, 0, 1, points.len() - 1);
    (low, high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec4;

    #[test]
    fn halves_of_a_curve_meet_in_its_middle() {
        let points = [DVec4::ZERO, DVec4::X, DVec4::new(1.0, 2.0, 0.0, 0.0), DVec4::Y];
        let (low, high) = halves(&points);
        let middle = (points[0] + 3.0 * points[1] + 3.0 * points[2] + points[3]) / 8.0;
        assert_eq!(low[3], middle);
        assert_eq!(high[0], middle);
        assert_eq!((low[0], high[3]), (points[0], points[3]));
        assert_eq!(low[1], 0.5 * (points[0] + points[1]));
        assert_eq!(high[2], 0.5 * (points[2] + points[3]));
    }
}
