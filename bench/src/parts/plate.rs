//! Wavy plates with round holes: trimmed faces where there is no part from outside.

use glam::{DAffine3, DVec2, DVec3};
use perpend::{NurbsSurface, TrimCurveData, TrimLoopData, TrimmingData};
use perpend_bench::{Failure, spread, wavy};

use crate::growth::Block;

/// `count` plates side by side, with points beside them.
pub(crate) fn plates(count: usize) -> Result<Block, Failure> {
    let plate = wavy(8)?;
    let mut faces = Vec::new();
    let mut points = Vec::new();
    for k in 0..count {
        let map = DAffine3::from_translation(DVec3::new((k % 10) as f64, (k / 10) as f64, 0.0));
        let surface = plate.transformed(&map)?;
        points.extend((0..20).map(|j| beside(&surface, (k * 20 + j) as u32)));
        faces.push((surface, trimming()));
    }
    Ok(Block { name: "wavy plates with a hole".to_owned(), faces, points })
}

/// A point near a plate.
fn beside(surface: &NurbsSurface, k: u32) -> DVec3 {
    let at = spread(k) + 0.5;
    surface.point(at.x, at.y) + 0.05 * spread(k).z * DVec3::Z
}

/// A square with a round hole.
fn trimming() -> TrimmingData {
    let corners = [(0.1, 0.1), (0.9, 0.1), (0.9, 0.9), (0.1, 0.9)].map(DVec2::from);
    let side = |from: DVec2, to: DVec2| TrimCurveData {
        degree: 1,
        knots: vec![0.0, 0.0, 1.0, 1.0],
        points: vec![from, to],
        weights: None,
        edge: None,
    };
    let sides = (0..4).map(|k| side(corners[k], corners[(k + 1) % 4])).collect();
    // clockwise about the square's middle, with the corners of its own square between quarters
    let around = [(1, 0), (1, -1), (0, -1), (-1, -1), (-1, 0), (-1, 1), (0, 1), (1, 1), (1, 0)];
    let hole = TrimCurveData {
        degree: 2,
        knots: vec![0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 4.0, 4.0, 4.0],
        points: around.map(|(x, y)| DVec2::splat(0.5) + 0.2 * DVec2::new(f64::from(x), f64::from(y))).to_vec(),
        weights: Some((0..9).map(|k| if k % 2 == 1 { std::f64::consts::FRAC_1_SQRT_2 } else { 1.0 }).collect()),
        edge: None,
    };
    let loops = vec![TrimLoopData { outer: true, curves: sides }, TrimLoopData { outer: false, curves: vec![hole] }];
    TrimmingData { reversed: false, tolerance: 1e-9, loops }
}
