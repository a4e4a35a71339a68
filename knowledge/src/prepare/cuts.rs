//! Where a curve is to be cut, so that its parts have neither cusps nor loops.

use std::f64::consts::FRAC_PI_2;

use perpend_kernel::{InvalidEdit, NurbsCurve};

use crate::acquire::{AcquireOptions, acquire};
use crate::item::Item;
use crate::representation::{Irregularity, ParameterPoint};

/// Cuts are one, and an end of the domain is none, where they are nearer than this share of the domain: a part so short has no
/// extent to speak of.
const SAME: f64 = 1e-9;

/// The parameters, ascending, at which a curve is to be cut so that its parts have neither cusps nor loops (Piegl et al. 2008, §2).
///
/// They are those at which the derivative vanishes or the curve turns back by more than a right angle, and both parameters of a place
/// where the curve meets itself: the part between those is closed, and meets itself at its ends alone.
///
/// # Accuracy
///
/// As [`acquire`] finds irregularities: found, not proven complete.
#[must_use]
pub fn cuts(curve: &NurbsCurve) -> Vec<f64> {
    let known = acquire(&curve.clone().into(), &AcquireOptions::default());
    cuts_at(curve, known.irregularities.as_deref().unwrap_or_default())
}

/// As [`cuts`], of a curve whose irregularities are known.
#[must_use]
pub fn cuts_at(curve: &NurbsCurve, irregularities: &[Item<Irregularity>]) -> Vec<f64> {
    let mut all = Vec::new();
    for item in irregularities {
        match item.value {
            Irregularity::Cusp { at: ParameterPoint::Curve(u), .. }
            | Irregularity::VanishingDerivative { at: ParameterPoint::Curve(u), .. } => all.push(u),
            Irregularity::Crease { at, angle, .. } if angle > FRAC_PI_2 => all.push(at),
            Irregularity::Loop { from, to, .. } => all.extend([from, to]),
            _ => {}
        }
    }
    let (first, last) = curve.domain();
    let same = SAME * (last - first);
    all.sort_by(f64::total_cmp);
    all.retain(|u| *u - first > same && last - *u > same);
    all.dedup_by(|later, earlier| *later - *earlier <= same);
    // a cut beside a knot would leave a span without extent
    let knot = |u: f64| curve.knots().breaks().map(|b| b.at).find(|at| (at - u).abs() <= same);
    all.iter_mut().for_each(|u| *u = knot(*u).unwrap_or(*u));
    all
}

/// The parts of a curve between the given parameters, ascending and inside its domain; the parts keep their parameters and meet
/// in the same bits.
///
/// # Errors
///
/// A parameter outside; a part that would be a single point.
pub fn parted(curve: &NurbsCurve, cuts: &[f64]) -> Result<Vec<NurbsCurve>, InvalidEdit> {
    let mut parts = Vec::with_capacity(cuts.len() + 1);
    let mut rest = curve.clone();
    // from the end, so that the longer part of many is not copied again and again
    for u in cuts.iter().rev() {
        let (before, after) = rest.split(*u)?;
        parts.push(after);
        rest = before;
    }
    parts.push(rest);
    parts.reverse();
    Ok(parts)
}
