//! A dust pan: one bicubic sheet from the lip to the end of the handle.
//!
//! In the spirit of Piegl et al. 2008, Fig. 7: a wide flat floor, tight concave corners, a back wall, a narrow neck, and a handle
//! that is an open channel.

use perpend::{DVec3, Model, SurfaceData};

use super::known::{self, Known};
use super::{Outcome, rounded};

/// Where the middle of the lip stands on the bench.
const LIP: DVec3 = DVec3::new(-570.0, -190.0, 2.0);

/// Cross sections from the lip to the end of the handle: distance from the lip, half the width, height of the middle, and
/// how far the rims rise above it. The floor is flat, the back wall climbs, and in the handle the rims hang below.
const SECTIONS: [(f64, f64, f64, f64); 20] = [
    (0.0, 112.0, -1.5, 7.0),
    (10.0, 112.0, -0.5, 10.0),
    (28.0, 111.5, 0.0, 16.0),
    (52.0, 110.5, 0.0, 24.0),
    (78.0, 109.5, 0.0, 31.0),
    (104.0, 108.5, 0.0, 38.0),
    (126.0, 107.5, 0.0, 44.0),
    (140.0, 106.5, 0.0, 49.0),
    (147.0, 105.5, 3.0, 50.0),
    (151.0, 104.0, 18.0, 38.0),
    (154.0, 101.0, 36.0, 23.0),
    (158.0, 93.0, 51.0, 10.0),
    (166.0, 76.0, 58.0, 3.0),
    (178.0, 50.0, 61.0, -1.0),
    (192.0, 26.0, 62.0, -6.0),
    (210.0, 14.5, 63.0, -9.5),
    (236.0, 14.0, 66.0, -11.0),
    (268.0, 18.0, 71.0, -12.0),
    (302.0, 19.0, 77.0, -12.0),
    (330.0, 12.0, 81.0, -8.0),
];

/// Half a cross section from the rim inwards: across as a share of half the width, up as a share of the rim's rise.
const HALF: [(f64, f64); 7] =
    [(1.08, 1.0), (1.06, 0.7), (1.035, 0.36), (1.01, 0.07), (0.95, 0.0), (0.7, 0.0), (0.25, 0.0)];

pub(crate) fn add(model: &mut Model) -> Outcome<()> {
    let mirrored = HALF.iter().map(|(across, up)| (-across, *up));
    let template: Vec<(f64, f64)> = mirrored.chain(HALF.iter().rev().copied()).collect();
    let control_points = SECTIONS
        .iter()
        .map(|(along, width, middle, rise)| {
            let point = |(across, up): &(f64, f64)| LIP + DVec3::new(*along, across * width, middle + up * rise);
            template.iter().map(|share| rounded(point(share))).collect()
        })
        .collect();
    let knots = (clamped(SECTIONS.len()), clamped(template.len()));
    let pan = SurfaceData { degree: (3, 3), knots, control_points, weights: None };
    let decision = "one sheet, so that it can be pressed in one stroke";
    known::add(model, "dust pan", pan, Known::designed("moulding").because(decision))?;
    Ok(())
}

/// Evenly spaced knots of degree 3 with clamped ends.
pub(crate) fn clamped(points: usize) -> Vec<f64> {
    let spans = points - 3;
    (0..points + 4).map(|k| k.saturating_sub(3).min(spans) as f64).collect()
}
