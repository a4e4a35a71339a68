//! The handle of a paint brush: a convex skin with a narrow neck, closed around, with a pole at its end.
//!
//! In the spirit of Piegl et al. 2008, Fig. 7. It is open where the ferrule is put on.

use std::f64::consts::TAU;

use perpend::{DVec3, Model, SurfaceData};

use super::dust_pan::clamped;
use super::known::{self, Known};
use super::{Outcome, rounded};

/// Where the middle of the ferrule's end stands.
const FERRULE: DVec3 = DVec3::new(-170.0, -230.0, 30.0);

/// Control points around a cross section.
const AROUND: usize = 12;

/// Cross sections from the ferrule to the end: distance from the ferrule, half the width, half the thickness, and the exponent
/// that makes the section boxy (below 1) or an ellipse (1). The last two make the end smooth.
const SECTIONS: [(f64, f64, f64, f64); 21] = [
    (0.0, 25.0, 8.0, 0.45),
    (6.0, 25.5, 8.3, 0.5),
    (14.0, 27.0, 8.8, 0.55),
    (22.0, 27.0, 9.2, 0.6),
    (30.0, 23.0, 9.6, 0.65),
    (37.0, 15.5, 9.2, 0.75),
    (44.0, 9.5, 7.8, 0.85),
    (52.0, 6.7, 6.2, 0.95),
    (62.0, 6.0, 5.4, 1.0),
    (74.0, 6.6, 5.8, 1.0),
    (90.0, 9.0, 7.2, 1.0),
    (108.0, 11.6, 8.8, 1.0),
    (128.0, 13.2, 10.0, 1.0),
    (148.0, 13.4, 10.2, 1.0),
    (166.0, 12.2, 9.4, 1.0),
    (182.0, 10.2, 8.0, 1.0),
    (194.0, 8.4, 6.8, 1.0),
    (202.0, 7.0, 5.8, 1.0),
    (207.0, 5.0, 4.2, 1.0),
    (209.0, 2.5, 2.1, 1.0),
    (209.0, 0.0, 0.0, 1.0),
];

pub(crate) fn add(model: &mut Model) -> Outcome<()> {
    let control_points = SECTIONS
        .iter()
        .map(|(along, width, thickness, exponent)| {
            // periodic around: the first three columns come again at the end
            (0..AROUND + 3)
                .map(|column| {
                    let (sine, cosine) = (TAU * (column % AROUND) as f64 / AROUND as f64).sin_cos();
                    let boxy = |x: f64| x.signum() * x.abs().powf(*exponent);
                    rounded(FERRULE + DVec3::new(*along, width * boxy(cosine), thickness * boxy(sine)))
                })
                .collect()
        })
        .collect();
    let around = (0..AROUND + 7).map(|k| k as f64 - 3.0).collect();
    let knots = (clamped(SECTIONS.len()), around);
    let handle = SurfaceData { degree: (3, 3), knots, control_points, weights: None };
    let decision = "periodic around: no edge under the fingers";
    known::add(model, "brush handle", handle, Known::designed("turning").because(decision))?;
    Ok(())
}
