//! Arcs of circles and ellipses.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3, DVec4};
use perpend_kernel::{NurbsCurve, binomial};

use super::along::{Extent, Hull, Piece, extent, pieces};
use super::curves::{local, samples};
use super::turned::perpendicular;
use super::{axis, proof};
use crate::classification::Kind;

/// An ellipse: its centre and its half-axes, orthogonal.
#[derive(Debug, Clone, Copy)]
pub(super) struct Conic {
    pub(super) centre: DVec3,
    pub(super) normal: DVec3,
    pub(super) xdir: DVec3,
    pub(super) radii: (f64, f64),
}

/// The circle through samples, from the curve's start, in the direction in which it runs.
pub(super) fn circle(curve: &NurbsCurve) -> Option<Kind> {
    let (curve_at, origin) = local(curve)?;
    let row = samples(&curve_at);
    let fitted = axis::fit(std::slice::from_ref(&row), false)?;
    let (height, radius) = fitted.mean(&row);
    let centre = fitted.centre + height * fitted.axis;
    let mut axis = fitted.axis;
    let xdir = perpendicular(row[0] - centre, axis)?;
    let turned = |axis| {
        let conic = Conic { centre, normal: axis, xdir, radii: (radius, radius) };
        Some(conic.angles(&curve_at)?.range())
    };
    let mut sweep = turned(axis)?;
    if sweep.1 < sweep.0 || (sweep.1 == 0.0 && sweep.0 < 0.0) {
        axis = -axis;
        sweep = turned(axis)?;
    }
    let sweep = full_if_closed(sweep, super::tolerance_in(curve.control_box()) * 1e-2 / radius);
    Some(Kind::Circle { centre: origin + centre, axis, xdir, radius, sweep })
}

/// The range with exactly a full turn, where it is one up to `slack` or more.
pub(super) fn full_if_closed(sweep: (f64, f64), slack: f64) -> (f64, f64) {
    let turn = sweep.1 - sweep.0;
    if turn.abs() >= TAU - slack { (sweep.0, sweep.0 + TAU.copysign(turn)) } else { sweep }
}

impl Conic {
    fn ydir(&self) -> DVec3 {
        self.normal.cross(self.xdir)
    }

    /// A vector in units of the half-axes, with the height above the plane.
    fn relative(&self, arm: DVec3) -> DVec3 {
        DVec3::new(arm.dot(self.xdir) / self.radii.0, arm.dot(self.ydir()) / self.radii.1, arm.dot(self.normal))
    }

    /// Bound of the distance between a curve and the arc over `sweep`.
    ///
    /// In units of the half-axes the ellipse is the unit circle, and a step there is a step of at most the larger half-axis
    /// here. The square of the distance from the centre, less 1, is a rational function whose Bernstein coefficients bound it;
    /// it is formed from a point of the curve, so that a short arc of a large circle cancels nothing.
    pub(super) fn gap(&self, curve: &NurbsCurve, sweep: (f64, f64)) -> Option<f64> {
        let (a, b) = curve.domain();
        let anchor = curve.point(0.5 * a + 0.5 * b);
        let k = self.relative(anchor - self.centre).truncate();
        let excess = (k.length() - 1.0) * (k.length() + 1.0);
        let pieces = pieces(curve, |p| self.relative(p - anchor));
        let squares = pieces.iter().map(|piece| off_circle(piece, k, excess)).fold(0.0, f64::max);
        let largest = self.radii.0.max(self.radii.1);
        let reach = curve.control_points().iter().map(|p| self.relative(*p - anchor).truncate().length());
        let reach = reach.fold(0.0, f64::max);
        let rounded = proof::rounding(curve.degree()) * (reach * reach + 2.0 * reach * k.length() + k.length() + 1.0);
        let squares = squares + rounded;
        let radial = squares / (1.0 + (1.0 - squares).max(0.0).sqrt());
        let plane = |p: &DVec3| (*p - self.centre).dot(self.normal).abs();
        let flat = curve.control_points().iter().map(plane).fold(0.0, f64::max);
        let arms = curve.control_points().iter().map(|p| p.distance(self.centre)).fold(0.0, f64::max);
        let extent = self.angles(curve)?;
        let turned = 8.0 * f64::EPSILON * (sweep.0.abs() + sweep.1.abs() + 1.0);
        let angle = extent.off_turn(sweep) + turned + extent.rounding(curve.degree());
        Some(largest * (radial + angle) + flat + proof::rounding(1) * arms)
    }

    /// How the (eccentric) angle runs along a curve, continuously from its start.
    pub(super) fn angles(&self, curve: &NurbsCurve) -> Option<Extent> {
        let pieces = pieces(curve, |p| self.relative(p - self.centre));
        let of = |p: &DVec4| p.y.atan2(p.x);
        extent(&pieces, |piece, before| {
            let first = piece[0];
            // relative to the start of the piece the angles have no jump as long as they fill less than half a turn
            let turned = |p: &DVec4| (first.x * p.y - first.y * p.x).atan2(first.x * p.x + first.y * p.y);
            let (least, greatest) =
                piece.iter().map(turned).fold((0.0_f64, 0.0_f64), |(low, high), t| (low.min(t), high.max(t)));
            if greatest - least > 0.9 * PI {
                return None;
            }
            let near = |angle: f64, to: f64| angle + TAU * ((to - angle) / TAU).round();
            let start = before.map_or_else(|| of(&first), |before| near(of(&first), before));
            // the same value for the same point, whichever piece it ends
            let value = |p: &DVec4| near(of(p), start + turned(p));
            let (least, greatest) = piece
                .iter()
                .map(value)
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), t| (low.min(t), high.max(t)));
            Some(Hull { least, greatest, start, end: value(&piece[piece.len() - 1]) })
        })
    }
}

impl Extent {
    /// As [`off`](Self::off), up to full turns; a stated full turn holds all angles.
    pub(super) fn off_turn(&self, stated: (f64, f64)) -> f64 {
        let turn = stated.1 - stated.0;
        if turn.abs() >= TAU * (1.0 - f64::EPSILON) {
            let missed = (TAU - (self.greatest - self.least)).max(0.0);
            let start = self.start - stated.0;
            let start = (start - TAU * (start / TAU).round()).abs();
            let opposed = if (self.end - self.start) * turn < 0.0 { TAU } else { 0.0 };
            return missed.max(start).max(opposed).max(turn.abs() - TAU);
        }
        let shift = 0.5 * (stated.0 + stated.1) - 0.5 * (self.least + self.greatest);
        let shift = TAU * (shift / TAU).round();
        self.off((stated.0 - shift, stated.1 - shift))
    }
}

/// Bound of `| |q + k|² - 1 |` over a piece, where `excess` is `|k|² - 1`: of a quotient of Bernstein forms with a positive
/// denominator, the largest quotient of coefficients.
fn off_circle(piece: &Piece, k: DVec2, excess: f64) -> f64 {
    let p = piece.len() - 1;
    let mut worst = 0.0_f64;
    for m in 0..=2 * p {
        let (mut numerator, mut denominator) = (0.0, 0.0);
        for i in m.saturating_sub(p)..=m.min(p) {
            let (a, b) = (piece[i], piece[m - i]);
            let share = binomial(p, i) * binomial(p, m - i);
            let (qa, qb) = (DVec2::new(a.x, a.y), DVec2::new(b.x, b.y));
            numerator += share * (qa.dot(qb) + (qa.dot(k) * b.w + qb.dot(k) * a.w) + excess * a.w * b.w);
            denominator += share * a.w * b.w;
        }
        worst = worst.max(numerator.abs() / denominator);
    }
    worst
}
