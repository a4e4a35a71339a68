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
    /// A derivative of a Bézier piece is a convex combination of differences of its points. With `N = S w`, the origin in the middle of the
    /// piece so that `|S| <= r` there, and vectors `a` and `b` near `S_u` and `S_v`:
    ///
    /// ```text
    /// w (S_u - a) = (N_u - a w) - w_u S
    /// w S_uu = (N_uu - 2 a w_u) - 2 w_u (S_u - a) - w_uu S
    /// w S_uv = (N_uv - b w_u - a w_v) - w_u (S_v - b) - w_v (S_u - a) - w_uv S
    /// ```
    ///
    /// Each bracket is one Bézier form, so what cancels in it is not counted; without `a` and `b` a long thin strip of a cylinder would seem
    /// to be twisted.
    pub(crate) fn of(patch: &Patch) -> Self {
        let (p, q) = patch.degree;
        let places: Vec<DVec3> = patch.points.iter().map(|point| cartesian(*point)).collect();
        let least = places.iter().fold(DVec3::INFINITY, |least, place| least.min(*place));
        let most = places.iter().fold(DVec3::NEG_INFINITY, |most, place| most.max(*place));
        let centre = 0.5 * least + 0.5 * most;
        let reach = places.iter().map(|place| (*place - centre).length()).fold(0.0, f64::max);
        let least_weight = patch.points.iter().map(|point| point.w).fold(f64::INFINITY, f64::min);
        let points = patch.points.iter().map(|point| (point.truncate() - point.w * centre).extend(point.w)).collect();
        let mut form = Form { degree: (p, q), points };
        // so that every second derivative is a form
        if p == 1 {
            form = form.raised_in_u();
        }
        if q == 1 {
            form = form.raised_in_v();
        }
        let corner = |i: usize, j: usize| places[i * (q + 1) + j];
        let across = 0.5 * (corner(p, 0) - corner(0, 0) + corner(p, q) - corner(0, q));
        let along = 0.5 * (corner(0, q) - corner(0, 0) + corner(p, q) - corner(p, 0));
        let (by_u, by_v) = (form.by_u(), form.by_v());
        let (weight_u, weight_v) = (by_u.weight(), by_v.weight());
        let off = |first: Form, vector: DVec3, weight: f64| {
            (first.less(&form, vector).vector() + weight * reach) / least_weight
        };
        let off_u = off(by_u.raised_in_u(), across, weight_u);
        let off_v = off(by_v.raised_in_v(), along, weight_v);
        let (by_uu, by_uv, by_vv) = (by_u.by_u(), by_u.by_v(), by_v.by_v());
        let uu = by_uu.raised_in_u().less(&by_u, 2.0 * across).vector();
        let vv = by_vv.raised_in_v().less(&by_v, 2.0 * along).vector();
        let mixed = by_uv.raised_in_u().raised_in_v();
        let uv = mixed.less(&by_u.raised_in_u(), along).less(&by_v.raised_in_v(), across).vector();
        Self {
            u: across.length() + off_u,
            v: along.length() + off_v,
            uu: (uu + 2.0 * weight_u * off_u + by_uu.weight() * reach) / least_weight,
            uv: (uv + weight_u * off_v + weight_v * off_u + by_uv.weight() * reach) / least_weight,
            vv: (vv + 2.0 * weight_v * off_v + by_vv.weight() * reach) / least_weight,
        }
    }
}

/// A homogeneous Bézier form over the unit square.
#[derive(Debug, Clone)]
struct Form {
    degree: (usize, usize),
    points: Vec<DVec4>,
}

impl Form {
    fn make(degree: (usize, usize), point: impl Fn(usize, usize) -> DVec4) -> Self {
        let columns = degree.1 + 1;
        Self { degree, points: (0..(degree.0 + 1) * columns).map(|k| point(k / columns, k % columns)).collect() }
    }

    fn at(&self, i: usize, j: usize) -> DVec4 {
        self.points[i * (self.degree.1 + 1) + j]
    }

    fn by_u(&self) -> Self {
        let (p, q) = self.degree;
        Self::make((p - 1, q), |i, j| p as f64 * (self.at(i + 1, j) - self.at(i, j)))
    }

    fn by_v(&self) -> Self {
        let (p, q) = self.degree;
        Self::make((p, q - 1), |i, j| q as f64 * (self.at(i, j + 1) - self.at(i, j)))
    }

    /// The same form, its degree in u one higher. The NURBS Book, equation 5.36.
    fn raised_in_u(&self) -> Self {
        let (p, q) = self.degree;
        Self::make((p + 1, q), |i, j| raised(i, p, |i| self.at(i, j)))
    }

    fn raised_in_v(&self) -> Self {
        let (p, q) = self.degree;
        Self::make((p, q + 1), |i, j| raised(j, q, |j| self.at(i, j)))
    }

    /// This form less a vector times the weight of another of the same degree.
    fn less(&self, of: &Self, vector: DVec3) -> Self {
        debug_assert_eq!(self.degree, of.degree, "forms of different degrees");
        Self::make(self.degree, |i, j| self.at(i, j) - (of.at(i, j).w * vector).extend(0.0))
    }

    /// A bound of the length of its vector.
    fn vector(&self) -> f64 {
        self.points.iter().map(|point| point.truncate().length()).fold(0.0, f64::max)
    }

    /// A bound of its weight, without sign.
    fn weight(&self) -> f64 {
        self.points.iter().map(|point| point.w.abs()).fold(0.0, f64::max)
    }
}

/// Point `i` of a form of degree `degree + 1` that is one of `degree`.
fn raised(i: usize, degree: usize, point: impl Fn(usize) -> DVec4) -> DVec4 {
    let share = i as f64 / (degree + 1) as f64;
    match i {
        0 => point(0),
        _ if i == degree + 1 => point(degree),
        _ => share * point(i - 1) + (1.0 - share) * point(i),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use perpend_kernel::{Direction, Frame, NurbsSurface, Torus, bezier::surface_pieces};

    /// The bounds hold at samples of ever smaller parts of rational pieces, and approach what is there.
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
                assert!(slack < 1.5, "{slack}");
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
