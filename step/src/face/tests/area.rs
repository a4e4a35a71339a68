//! The area of a trimmed face, by quadrature over the region's polygon: shares no code with what it checks.

use glam::{DVec2, DVec3};
use perpend::kernel::PlaneCurve;
use perpend::{Direction, NurbsSurface};

/// Nodes and weights of Gauss and Legendre's quadrature over `[0, 1]`, five points.
const NODES: [(f64, f64); 5] = [
    (0.046_910_077_030_668, 0.118_463_442_528_094_5),
    (0.230_765_344_947_158_5, 0.239_314_335_249_683_2),
    (0.5, 0.284_444_444_444_444_4),
    (0.769_234_655_052_841_5, 0.239_314_335_249_683_2),
    (0.953_089_922_969_332, 0.118_463_442_528_094_5),
];

/// The area of what closed loops bound.
pub(crate) fn area(surface: &NurbsSurface, loops: &[Vec<PlaneCurve>]) -> f64 {
    let mut polygons: Vec<Vec<DVec2>> = loops.iter().map(|one| one.iter().flat_map(polyline).collect()).collect();
    polygons.iter_mut().for_each(Vec::dedup);
    let mut stops: Vec<f64> = loops.iter().flatten().flat_map(|curve| [curve.start().x, curve.end().x]).collect();
    // extremes of bent curves too
    stops.extend(polygons.iter().flat_map(|polygon| {
        polygon.windows(3).filter(|w| (w[1].x - w[0].x) * (w[2].x - w[1].x) < 0.0).map(|w| w[1].x)
    }));
    stops.extend(surface.knots(Direction::U).distinct().map(|(knot, _)| knot));
    stops.sort_by(f64::total_cmp);
    let mut sum = 0.0;
    for pair in stops.windows(2) {
        let width = pair[1] - pair[0];
        if width <= 0.0 {
            continue;
        }
        for part in 0..6 {
            for (node, weight) in NODES {
                let s = (f64::from(part) + node) / 6.0;
                // slow at the ends, where lengths may grow as square roots do
                let u = pair[0] + width * s * s * (3.0 - 2.0 * s);
                let pace = 6.0 * s * (1.0 - s);
                sum += weight / 6.0 * pace * width * length(surface, &polygons, u);
            }
        }
    }
    sum
}

fn polyline(curve: &PlaneCurve) -> Vec<DVec2> {
    let spans: Vec<_> = curve.knots().spans().collect();
    let steps = if curve.degree() == 1 { 1 } else { (800 / spans.len() as u32).max(24) };
    spans
        .into_iter()
        .flat_map(|span| {
            (0..=steps).map(move |k| span.start + (span.end - span.start) * f64::from(k) / f64::from(steps))
        })
        .map(|t| curve.point(t))
        .collect()
}

/// The integral of `|S_u × S_v|` over what of a line of constant `u` lies inside.
fn length(surface: &NurbsSurface, polygons: &[Vec<DVec2>], u: f64) -> f64 {
    let mut crossings = Vec::new();
    for polygon in polygons {
        for (a, b) in polygon.iter().zip(polygon.iter().cycle().skip(1)) {
            if (a.x > u) != (b.x > u) {
                crossings.push(a.y + (u - a.x) / (b.x - a.x) * (b.y - a.y));
            }
        }
    }
    crossings.sort_by(f64::total_cmp);
    let knots: Vec<f64> = surface.knots(Direction::V).distinct().map(|(knot, _)| knot).collect();
    let mut sum = 0.0;
    for pair in crossings.chunks_exact(2) {
        let mut stops = vec![pair[0], pair[1]];
        stops.extend(knots.iter().filter(|knot| **knot > pair[0] && **knot < pair[1]));
        stops.sort_by(f64::total_cmp);
        for pair in stops.windows(2) {
            for part in 0..3 {
                for (node, weight) in NODES {
                    let width = (pair[1] - pair[0]) / 3.0;
                    let v = pair[0] + width * (f64::from(part) + node);
                    let mut out = [DVec3::ZERO; 4];
                    surface.derivatives(u, v, 1, &mut out);
                    sum += weight * width * out[1].cross(out[2]).length();
                }
            }
        }
    }
    sum
}
