//! What the control points of a piece say of its derivatives.

use glam::{DVec3, DVec4};
use perpend_kernel::cartesian;

use crate::patch::Patch;

/// Bounds of the lengths of a piece's derivatives with respect to parameters that run over `[0, 1]` on it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Derivatives {
    pub(crate) u: f64,
    pub(crate) v: f64,
    pub(crate) uu: f64,
    pub(crate) uv: f64,
    pub(crate) vv: f64,
}

impl Derivatives {
    /// How far any triangle with corners on the piece is from the piece.
    pub(crate) fn chord_error(&self) -> f64 {
        0.125 * (self.uu + 2.0 * self.uv + self.vv)
    }

    /// Bounds over a piece.
    ///
    /// A derivative of a Bézier piece is a convex combination of differences of its points. With `N = S w`, and the origin in the
    /// middle of the piece so that `|S| <= r` there: `S_u = (N_u - w_u S) / w`,
    /// `S_uu = (N_uu - 2 w_u S_u - w_uu S) / w`, `S_uv = (N_uv - w_u S_v - w_v S_u - w_uv S) / w`.
    pub(crate) fn of(patch: &Patch) -> Self {
        let (p, q) = patch.degree;
        let columns = q + 1;
        let places: Vec<DVec3> = patch.points.iter().map(|point| cartesian(*point)).collect();
        let least = places.iter().fold(DVec3::INFINITY, |least, place| least.min(*place));
        let most = places.iter().fold(DVec3::NEG_INFINITY, |most, place| most.max(*place));
        let centre = 0.5 * least + 0.5 * most;
        let reach = places.iter().map(|place| (*place - centre).length()).fold(0.0, f64::max);
        let least_weight = patch.points.iter().map(|point| point.w).fold(f64::INFINITY, f64::min);
        let form: Vec<DVec4> =
            patch.points.iter().map(|point| (point.truncate() - point.w * centre).extend(point.w)).collect();
        let at = |i: usize, j: usize| form[i * columns + j];
        let (pf, qf) = (p as f64, q as f64);
        let u = largest(p, q + 1, |i, j| at(i + 1, j) - at(i, j)).scaled(pf);
        let v = largest(p + 1, q, |i, j| at(i, j + 1) - at(i, j)).scaled(qf);
        let uu = largest(p.saturating_sub(1), q + 1, |i, j| at(i + 2, j) - 2.0 * at(i + 1, j) + at(i, j));
        let vv = largest(p + 1, q.saturating_sub(1), |i, j| at(i, j + 2) - 2.0 * at(i, j + 1) + at(i, j));
        let uv = largest(p, q, |i, j| at(i + 1, j + 1) - at(i + 1, j) - at(i, j + 1) + at(i, j)).scaled(pf * qf);
        let (uu, vv) = (uu.scaled(pf * (pf - 1.0)), vv.scaled(qf * (qf - 1.0)));
        let first = |of: Largest| (of.vector + of.weight * reach) / least_weight;
        let (by_u, by_v) = (first(u), first(v));
        Self {
            u: by_u,
            v: by_v,
            uu: (uu.vector + 2.0 * u.weight * by_u + uu.weight * reach) / least_weight,
            uv: (uv.vector + u.weight * by_v + v.weight * by_u + uv.weight * reach) / least_weight,
            vv: (vv.vector + 2.0 * v.weight * by_v + vv.weight * reach) / least_weight,
        }
    }
}

/// The largest length and the largest weight of some differences.
#[derive(Debug, Clone, Copy)]
struct Largest {
    vector: f64,
    weight: f64,
}

impl Largest {
    fn scaled(self, by: f64) -> Self {
        Self { vector: self.vector * by, weight: self.weight * by }
    }
}

fn largest(rows: usize, columns: usize, difference: impl Fn(usize, usize) -> DVec4) -> Largest {
    let mut found = Largest { vector: 0.0, weight: 0.0 };
    for i in 0..rows {
        for j in 0..columns {
            let difference = difference(i, j);
            found.vector = found.vector.max(difference.truncate().length());
            found.weight = found.weight.max(difference.w.abs());
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use perpend_kernel::{Direction, Frame, NurbsSurface, Torus, bezier::surface_pieces};

    /// The bounds hold at samples of ever smaller parts of rational pieces, and stay in proportion to what is there.
    #[test]
    fn the_bounds_hold_at_samples() {
        let torus = Torus::whole(Frame::WORLD, 3.0, 1.0).unwrap().to_nurbs().unwrap();
        let point = |i: i32, j: i32| DVec3::new(f64::from(i), f64::from(j * j), f64::from(i * j % 3));
        let skewed = NurbsSurface::new(
            (3, 2),
            (vec![0.0, 0.0, 0.0, 0.0, 2.0, 2.0, 2.0, 2.0], vec![0.0, 0.0, 0.0, 5.0, 5.0, 5.0]),
            (0..4).map(|i| (0..3).map(|j| point(i, j)).collect()).collect(),
            Some((0..4).map(|i| (0..3).map(|j| 1.0 + f64::from((i * 2 + j) % 3)).collect()).collect()),
        )
        .unwrap();
        for surface in [torus, skewed] {
            let (u, v) = (surface.knots(Direction::U), surface.knots(Direction::V));
            for piece in surface_pieces(u, v, &surface.homogeneous_points()) {
                let mut patch = Patch::new(piece);
                let mut slack = f64::INFINITY;
                for _ in 0..5 {
                    slack = slack_of(&surface, &patch);
                    let (_, low, _) = patch.halves(Direction::U).unwrap();
                    (_, _, patch) = low.halves(Direction::V).unwrap();
                }
                // what the weights' derivatives take off again does not cancel in a bound
                assert!(slack < 4.0, "{slack}");
            }
        }
    }

    /// By what factor the bound of the chord error is above that of sampled derivatives.
    fn slack_of(surface: &NurbsSurface, patch: &Patch) -> f64 {
        let bounds = Derivatives::of(patch);
        let (hu, hv) = (patch.over.u.1 - patch.over.u.0, patch.over.v.1 - patch.over.v.0);
        let mut most = [0.0_f64; 5];
        for k in 0..=8 {
            for l in 0..=8 {
                let mut out = [DVec3::ZERO; 9];
                // inside: at a border the derivatives may be those of the piece beside
                let [s, t] = [k, l].map(|k| (f64::from(k) / 8.0).clamp(1e-9, 1.0 - 1e-9));
                surface.derivatives(patch.over.u.0 + s * hu, patch.over.v.0 + t * hv, 2, &mut out);
                let found = [out[3] * hu, out[1] * hv, out[6] * hu * hu, out[4] * hu * hv, out[2] * hv * hv];
                most.iter_mut().zip(found).for_each(|(most, found)| *most = most.max(found.length()));
            }
        }
        let stated = [bounds.u, bounds.v, bounds.uu, bounds.uv, bounds.vv];
        for (most, stated) in most.iter().zip(stated) {
            assert!(*most <= stated * (1.0 + 1e-12) + 1e-12, "{most} > {stated}");
        }
        let [u, v, uu, uv, vv] = most;
        bounds.chord_error() / Derivatives { u, v, uu, uv, vv }.chord_error()
    }
}
