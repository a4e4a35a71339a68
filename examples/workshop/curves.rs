//! Four curves in the spirit of Selimovic 2006, Fig. 7: three planar ones, with and without inflections, and one in space.

use std::f64::consts::TAU;

use perpend::kernel::Spacing;
use perpend::{CurveData, DVec3, Model, Operation};

use super::known::{self, Known};
use super::{Outcome, rounded};

pub(crate) fn add(model: &mut Model) -> Outcome<()> {
    let flat = |points: &[(f64, f64)]| points.iter().map(|(x, y)| DVec3::new(*x, *y, 1.0)).collect();

    // one inflection
    let s = CurveData {
        degree: 3,
        knots: vec![0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 3.0, 3.0, 3.0],
        control_points: flat(&[
            (-560.0, 160.0),
            (-500.0, 120.0),
            (-400.0, 190.0),
            (-560.0, 250.0),
            (-470.0, 320.0),
            (-400.0, 280.0),
        ]),
        weights: None,
    };
    known::add(model, "S curve", s, Known::designed("styling"))?;

    // eleven inflections
    let wave: Vec<DVec3> = (0..=48)
        .map(|k| {
            let t = f64::from(k) / 48.0;
            rounded(DVec3::new(-340.0 + 240.0 * t, 230.0 + 22.0 * (6.0 * TAU * t).sin(), 1.0))
        })
        .collect();
    through(model, "wave", &wave)?;

    // none
    let arch = CurveData {
        degree: 4,
        knots: vec![0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 1.0],
        control_points: flat(&[(-60.0, 160.0), (-50.0, 290.0), (20.0, 360.0), (90.0, 290.0), (100.0, 160.0)]),
        weights: Some(vec![1.0, 1.5, 0.5, 1.5, 1.0]),
    };
    known::add(model, "arch", arch, Known::designed("styling"))?;

    let coil: Vec<DVec3> = (0..=40)
        .map(|k| {
            let t = f64::from(k) / 40.0;
            let ((sine, cosine), radius) = ((3.5 * TAU * t).sin_cos(), 20.0 + 25.0 * t);
            rounded(DVec3::new(190.0 + radius * cosine, 240.0 + radius * sine, 5.0 + 110.0 * t))
        })
        .collect();
    through(model, "coil", &coil)
}

/// Adds the cubic through some points.
fn through(model: &mut Model, name: &str, points: &[DVec3]) -> Outcome<()> {
    let (points, spacing) = (points.to_vec(), Spacing::ChordLength);
    let operation = Operation::Interpolation { degree: (3, 0), points, columns: 0, spacing };
    known::make(model, name, operation, &[], Known::designed("bending"))?;
    Ok(())
}
