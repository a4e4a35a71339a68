//! Which side of closed polylines a point lies on, by the even-odd rule.

use glam::DVec2;
use robust::{Coord, orient2d};

/// Segments of closed polylines, by the strips of `v` that they pass.
#[derive(Debug)]
pub(crate) struct Parity {
    strips: Vec<Vec<[DVec2; 2]>>,
    low: f64,
    height: f64,
}

impl Parity {
    /// Segments that together are closed polylines.
    pub(crate) fn new(segments: &[[DVec2; 2]]) -> Self {
        let low = segments.iter().flatten().map(|p| p.y).fold(f64::INFINITY, f64::min);
        let high = segments.iter().flatten().map(|p| p.y).fold(f64::NEG_INFINITY, f64::max);
        // few: a segment is kept once for each strip that it passes
        let count = (segments.len() / 4).clamp(1, 256);
        let mut parity = Self { strips: vec![Vec::new(); count], low, height: high - low };
        for segment in segments {
            let (a, b) = (parity.strip(segment[0].y), parity.strip(segment[1].y));
            for strip in &mut parity.strips[a.min(b)..=a.max(b)] {
                strip.push(*segment);
            }
        }
        parity
    }

    fn strip(&self, v: f64) -> usize {
        let last = self.strips.len() - 1;
        let share = (v - self.low) / self.height;
        // from 0 where the height is 0, and then there is one strip
        if share > 0.0 { ((share * (last + 1) as f64) as usize).min(last) } else { 0 }
    }

    /// Whether a ray from the point towards larger `u` crosses the polylines an odd number of times. Exact: signs of determinants
    /// are those without rounding.
    pub(crate) fn inside(&self, p: DVec2) -> bool {
        let coord = |p: DVec2| Coord { x: p.x, y: p.y };
        let crossed = self.strips[self.strip(p.y)].iter().filter(|[a, b]| {
            let (low, high) = if a.y <= b.y { (a, b) } else { (b, a) };
            // half open: a ray through a corner crosses one of its segments
            low.y <= p.y && p.y < high.y && orient2d(coord(*low), coord(*high), coord(p)) > 0.0
        });
        crossed.count() % 2 == 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_through_corners_and_along_sides_count_right() {
        let corners = [(0.0, 0.0), (2.0, 0.0), (3.0, 1.0), (2.0, 2.0), (0.0, 2.0), (1.0, 1.0)];
        let corners = corners.map(|(x, y)| DVec2::new(x, y));
        let segments: Vec<_> = (0..6).map(|i| [corners[i], corners[(i + 1) % 6]]).collect();
        let parity = Parity::new(&segments);
        assert!(parity.inside(DVec2::new(2.0, 1.0)));
        assert!(parity.inside(DVec2::new(0.5, 0.1)));
        assert!(!parity.inside(DVec2::new(0.5, 1.0)));
        assert!(!parity.inside(DVec2::new(-1.0, 1.0)));
        assert!(!parity.inside(DVec2::new(-1.0, 0.0)));
        assert!(!parity.inside(DVec2::new(-1.0, 2.0)));
        assert!(!parity.inside(DVec2::new(9.0, 1.5)));
    }

    #[test]
    fn a_segment_that_is_passed_twice_bounds_nothing() {
        let [a, b] = [DVec2::new(1.0, 0.0), DVec2::new(1.0, 1.0)];
        let parity = Parity::new(&[[a, b], [b, a]]);
        assert!(!parity.inside(DVec2::new(0.5, 0.5)));
    }
}
