//! A range of lengths along a straight line.

use glam::DVec2;
use perpend_kernel::KnotVector;

use super::inverse::Inverse;

/// Lengths from `-half` to `half` about the middle, ascending with the parameter.
#[derive(Debug)]
pub(super) struct Range {
    half: f64,
    inverse: Inverse,
}

/// The nearest length of a range.
#[derive(Debug, Clone, Copy)]
pub(super) struct Clamped {
    /// The length.
    pub at: f64,
    /// How far the asked one is outside.
    pub outside: f64,
    /// The definition's parameter.
    pub parameter: f64,
}

/// How far the definition may begin or end from where its shape does, as a share of its size: parameters are not proven, but those of a
/// curve that runs back beyond its ends are of no use.
const ENDS: f64 = 1e-6;

impl Range {
    /// The range of `half` to both sides, along which the control points of a definition lie at these lengths with these weights.
    pub(super) fn new(half: f64, knots: &KnotVector, lengths: impl Iterator<Item = (f64, f64)>) -> Option<Self> {
        let inverse = Inverse::new(knots, lengths.map(|(g, w)| (w * DVec2::new(1.0, g), w)), false)?;
        let [first, last] = inverse.ends().map(|pair| pair.y);
        let fits = (first + half).abs() <= ENDS && (last - half).abs() <= ENDS;
        fits.then_some(Self { half, inverse })
    }

    /// The nearest length to `h`; borders of the definition's pieces within `tolerance` count as met.
    #[inline(always)]
    pub(super) fn clamp(&self, h: f64, tolerance: f64) -> Clamped {
        let (first, last) = self.inverse.domain();
        let outside = h.abs() - self.half;
        if outside >= 0.0 {
            let (at, parameter) = if h < 0.0 { (-self.half, first) } else { (self.half, last) };
            return Clamped { at, outside, parameter };
        }
        Clamped { at: h, outside: 0.0, parameter: self.inverse.parameter(1.0, h, tolerance) }
    }

    /// Half of its length.
    pub(super) fn half(&self) -> f64 {
        self.half
    }
}
