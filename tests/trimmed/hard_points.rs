//! Query points about a trimmed face.

use glam::{DVec2, DVec3};
use perpend::NurbsSurface;

use crate::common::face_oracle::FaceOracle;
use crate::common::outline::Verdict;
use crate::common::random::Random;

/// About `count` points: on the face, its outline and what was cut away; beside them at all distances; about centres of curvature; around and far away.
pub(crate) fn hard_points(
    oracle: &FaceOracle,
    surface: &NurbsSurface,
    special: &[DVec3],
    count: usize,
    random: &mut Random,
) -> Vec<DVec3> {
    let inner: Vec<DVec2> = oracle.inner_points().map(|(uv, _)| uv).collect();
    let rim: Vec<DVec3> = oracle.rim_points().collect();
    let middle = rim.iter().sum::<DVec3>() / rim.len() as f64;
    let size = 2.0 * rim.iter().map(|point| point.distance(middle)).fold(0.0, f64::max);
    let (low, high) = oracle.outline.bounds();
    let mut points = special.to_vec();
    while points.len() < count {
        let along = |random: &mut Random, a: f64, b: f64| random.between(a, b);
        let cut = DVec2::new(along(random, low.x, high.x), along(random, low.y, high.y));
        let is_cut = oracle.outline.side(cut) == Verdict::Outside;
        let place = if is_cut || inner.is_empty() { cut } else { random.pick(&inner) };
        let point = surface.point(place.x, place.y);
        let normal = surface.normal(place.x, place.y).normalize_or(DVec3::Z);
        let near = size * random.power(-9.0, -3.0);
        points.extend([point, point + near * normal, point - near * normal]);
        points.push(point + random.sign() * size * random.power(-3.0, 0.5) * normal);
        if let Some(centre) = centre_of_curvature(surface, place, point, normal, size) {
            points.extend([centre, centre + size * random.power(-12.0, -4.0) * random.direction()]);
        }
        let edge = random.pick(&rim);
        points.push(edge);
        points.push(edge + size * random.power(-9.0, -3.0) * random.direction());
        points.push(edge + size * random.power(-3.0, 0.3) * random.direction());
        points.push(edge + random.sign() * size * random.power(-9.0, 0.0) * normal);
        if !special.is_empty() {
            points.push(random.pick(special) + size * random.power(-12.0, -1.0) * random.direction());
        }
        points.push(0.5 * (edge + random.pick(&rim)));
        points.push(middle + 1.5 * size * random.in_cube());
        points.push(middle + size * random.power(1.0, 3.0) * random.direction());
        points.push(middle + size * 10.0_f64.powi(random.count(3, 6) as i32) * random.direction());
    }
    points.truncate(count.max(special.len()));
    points
}

/// The centre of curvature along u.
fn centre_of_curvature(surface: &NurbsSurface, at: DVec2, point: DVec3, normal: DVec3, size: f64) -> Option<DVec3> {
    let mut d = [DVec3::ZERO; 9];
    surface.derivatives(at.x, at.y, 2, &mut d);
    let curvature = d[6].dot(normal) / d[3].length_squared();
    (curvature.is_finite() && curvature.abs() * size > 1e-3).then(|| point + normal / curvature)
}
