//! Points and surfaces of which a benchmark may make as many and as large as it needs, the same in every run.

use glam::DVec3;
use perpend_kernel::{Direction, InvalidDefinition, NurbsSurface};

/// Point `k` of a sequence that fills the cube of side 1 about the origin evenly.
///
/// Multiples of the inverse powers of the root of `x⁴ = x + 1`, the analogue in space of the golden ratio.
#[must_use]
pub fn spread(k: u32) -> DVec3 {
    let steps = [0.819_172_513_396_164_4, 0.671_043_606_703_789_2, 0.549_700_477_901_970_2];
    DVec3::from(steps.map(|step: f64| (f64::from(k) * step).fract() - 0.5))
}

/// `side * side` points within 1 % of the size of a surface, off along its normal, as a scanner takes them: row after row in u, each in the
/// direction opposite to the one before.
#[must_use]
pub fn scan(surface: &NurbsSurface, side: u32) -> Vec<DVec3> {
    let size = surface.control_box().diagonal();
    let within = |direction: Direction, k: u32| {
        let (first, last) = surface.domain(direction);
        first + (last - first) * (f64::from(k) + 0.5) / f64::from(side)
    };
    let point = |i: u32, j: u32| {
        let j = if i.is_multiple_of(2) { j } else { side - 1 - j };
        let (u, v) = (within(Direction::U, i), within(Direction::V, j));
        let noise = 0.02 * size * spread(i * side + j).x;
        surface.point(u, v) + noise * surface.normal(u, v).normalize_or_zero()
    };
    (0..side).flat_map(|i| (0..side).map(move |j| (i, j))).map(|(i, j)| point(i, j)).collect()
}

/// A bicubic wave of 8 by 8 spans over the unit square, refined to `spans` by `spans`: the same surface, whatever `spans` is.
///
/// # Errors
///
/// None where `spans` is a multiple of 8.
pub fn wavy(spans: usize) -> Result<NurbsSurface, InvalidDefinition> {
    const COARSE: usize = 8;
    let points = COARSE + 3;
    let knots: Vec<f64> = (0..points + 4).map(|k| (k.clamp(3, points) - 3) as f64 / COARSE as f64).collect();
    let at = |k: usize| k as f64 / (points - 1) as f64;
    let height = |i: usize, j: usize| 0.1 * (9.0 * at(i)).sin() * (7.0 * at(j)).cos();
    let net = (0..points).map(|i| (0..points).map(|j| DVec3::new(at(i), at(j), height(i, j))).collect()).collect();
    let coarse = NurbsSurface::new((3, 3), (knots.clone(), knots), net, None)?;
    let new: Vec<f64> =
        (1..spans).filter(|k| !(k * COARSE).is_multiple_of(spans)).map(|k| k as f64 / spans as f64).collect();
    let refined = coarse.refine(Direction::U, &new).and_then(|surface| surface.refine(Direction::V, &new));
    Ok(refined.expect("knots inside the domain, none there before"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_refined_wave_is_the_same_surface_with_more_spans() {
        let (coarse, fine) = (wavy(8).expect("valid"), wavy(40).expect("valid"));
        assert_eq!(fine.knots(Direction::U).spans().count(), 40);
        for k in 0..50 {
            let at = spread(k) + 0.5;
            assert!(coarse.point(at.x, at.y).distance(fine.point(at.x, at.y)) < 1e-14);
        }
    }

    #[test]
    fn a_scan_keeps_within_one_per_cent_of_the_size() {
        let wave = wavy(8).expect("valid");
        let size = wave.control_box().diagonal();
        let points = scan(&wave, 20);
        assert_eq!(points.len(), 400);
        let steps: Vec<f64> = points.windows(2).map(|pair| pair[0].distance(pair[1])).collect();
        assert!(steps.iter().all(|step| *step < 0.1 * size), "each point is beside the one before it");
    }
}
