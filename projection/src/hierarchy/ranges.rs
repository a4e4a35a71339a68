//! What the squared distance to a leaf and its derivatives can be at most and at least, told in a few operations, before any form is made.
//!
//! The derivatives of `D = |S - x|²` are affine in the query:
//!
//! ```text
//! D_s = 2 S·S_s - 2 x·S_s,      D_ss = 2 S_s·S_s + 2 S·S_ss - 2 x·S_ss,      and so on.
//! ```
//!
//! The four numbers of such a function, its constant and its vector, lie in a box that is known beforehand, all over the leaf; over that box it takes
//! values in
//!
//! ```text
//! a + b · y  ±  (ra + rb · |y|)
//! ```
//!
//! with the box's middle `(a, b)` and half its extents. The vectors are taken along the axes of the leaf's oriented box, `y` being the query
//! there: beside the leaf `y` points mostly along the normal, and what varies along the surface costs nothing. Of a polynomial leaf the boxes are
//! those around the Bernstein coefficients, which the form's tables hold; of a rational one they come from the boxes around its derivatives
//! ([`quotient`](super::quotient)).
//!
//! # Rounding
//!
//! Of a polynomial leaf a coefficient of the form errs by at most [`rounding_bound`], a first difference by twice and a second by four times that, made of
//! the same tables; the axes turn vectors and query with errors of less than `32 u` of their product, `|c1|` of a difference being at most
//! `4 r`. Twice the largest of these bounds pays for it all, and times the squared ratio of the weights for the products of a rational leaf's boxes,
//! whose own rounding is in the boxes.

use glam::{DMat3, DVec3};
use perpend_kernel::Aabb;

use super::convex::{CORRELATED, Curvature};
use super::form::{Shape, rounding_bound};
use super::net::Layout;
use super::newton::Domain;
use super::quotient::Boxes;

/// An affine function of the query that varies over the leaf: the box around all of them.
#[derive(Debug, Clone, Copy, Default)]
struct Affine {
    middle: [f64; 4],
    extent: [f64; 4],
}

impl Affine {
    /// The middle of the values at a query, and how far they may be from it.
    #[inline(always)]
    fn at(&self, view: &View) -> (f64, f64) {
        let (mut middle, mut extent) = (self.middle[0], self.extent[0]);
        for k in 0..3 {
            middle += self.middle[k + 1] * view.factors[k];
            extent += self.extent[k + 1] * view.factors[k].abs();
        }
        (middle, extent)
    }

    /// Around the `factor`-fold differences that `difference` takes of each table at every index.
    fn around(
        tables: [&[f64]; 4],
        factor: usize,
        indices: impl Iterator<Item = usize> + Clone,
        difference: impl Fn(&[f64], usize) -> f64,
    ) -> Self {
        let mut affine = Self::default();
        for (k, table) in tables.into_iter().enumerate() {
            let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
            for at in indices.clone() {
                let value = difference(table, at);
                (low, high) = (if value < low { value } else { low }, if value > high { value } else { high });
            }
            if low <= high {
                affine.middle[k] = factor as f64 * 0.5 * (low + high);
                affine.extent[k] = factor as f64 * 0.5 * (high - low);
            }
        }
        affine
    }

    /// The function whose constant lies in an interval and whose vector lies in a box.
    fn of(constant: (f64, f64), vector: &Aabb) -> Self {
        let (middle, extent) = (0.5 * (vector.min + vector.max), 0.5 * (vector.max - vector.min));
        Self {
            middle: [0.5 * (constant.0 + constant.1), middle.x, middle.y, middle.z],
            extent: [0.5 * (constant.1 - constant.0), extent.x, extent.y, extent.z],
        }
    }
}

/// A query as the ranges see it.
#[derive(Debug, Clone, Copy)]
pub(super) struct View {
    /// `-2 y`.
    factors: [f64; 3],
    /// What pays for the rounding of a difference.
    rounding: f64,
}

/// Ranges of the first and second derivatives of the squared distance to a leaf.
#[derive(Debug)]
pub(super) struct Ranges {
    s: Affine,
    t: Affine,
    ss: Affine,
    st: Affine,
    tt: Affine,
    factors: [f64; 5],
    degree: (usize, usize),
    radius: f64,
    /// What the rounding of a rational leaf is multiplied with.
    weights: f64,
}

impl Ranges {
    /// Of a leaf whose tables are `tables`, along the axes that are the rows of `axes`; its control points lie within `radius` of its origin and its
    /// weights between two bounds.
    pub(super) fn new(leaf: Shape<'_>, tables: &[f64], axes: &DMat3, radius: f64, weights: (f64, f64)) -> Self {
        let Layout { m, n } = leaf.layout();
        let factors = [m, n, m * (m - 1), m * n, n * n.saturating_sub(1)];
        let [s, t, ss, st, tt] = if leaf.rational {
            rational(&Boxes::around(leaf, axes, radius, weights))
        } else {
            polynomial(leaf, tables, axes, factors)
        };
        Self {
            s,
            t,
            ss,
            st,
            tt,
            factors: factors.map(|factor| factor as f64),
            degree: leaf.degree,
            radius,
            weights: (weights.1 / weights.0).powi(2),
        }
    }

    /// The query at `x` from the leaf's origin and at `y` along its axes.
    #[inline(always)]
    pub(super) fn view(&self, x: DVec3, y: DVec3) -> View {
        let rounding = 8.0 * rounding_bound(self.degree, x.length(), self.radius, 0.0, 1.0) * self.weights;
        View { factors: (-2.0 * y).to_array(), rounding }
    }

    /// The edge or corner of the leaf that is nearest, as far as the signs of the slopes tell; else all of it.
    #[inline(always)]
    pub(super) fn lowest(&self, view: &View) -> Domain {
        let toward = |slope: &Affine, factor: f64| {
            let (middle, extent) = slope.at(view);
            let extent = extent + factor * view.rounding;
            if middle >= extent {
                (0.0, 0.0)
            } else if middle <= -extent {
                (1.0, 1.0)
            } else {
                (0.0, 1.0)
            }
        };
        let t = if self.degree.1 == 0 { (0.0, 0.0) } else { toward(&self.t, self.factors[1]) };
        Domain { s: toward(&self.s, self.factors[0]), t }
    }

    /// A lower bound of the Hessian in the directions in which the box has an extent, if the ranges show `D` convex there: with
    /// `rho² = max D_st² / (min D_ss min D_tt) < 1`, `H >= (1 - rho) diag(min D_ss, min D_tt)`.
    #[inline(always)]
    pub(super) fn curvature(&self, view: &View, domain: &Domain) -> Option<Curvature> {
        let least = |curvature: &Affine, factor: f64| {
            let (middle, extent) = curvature.at(view);
            middle - extent - factor * view.rounding
        };
        let (along_s, along_t) = (domain.s.0 < domain.s.1, domain.t.0 < domain.t.1);
        let s = if along_s { least(&self.ss, self.factors[2]) } else { 0.0 };
        let t = if along_t { least(&self.tt, self.factors[4]) } else { 0.0 };
        // not `<=`: a NaN must fail too
        let positive = (!along_s || s > 0.0) && (!along_t || t > 0.0);
        if !positive {
            return None;
        }
        if !(along_s && along_t) {
            return Some(Curvature { s, t });
        }
        let (middle, extent) = self.st.at(view);
        let mixed = middle.abs() + extent + self.factors[3] * view.rounding;
        let rho = mixed / (s * t).sqrt();
        (rho <= CORRELATED).then_some(Curvature { s: (1.0 - rho) * s, t: (1.0 - rho) * t })
    }
}

/// From the tables of a polynomial leaf's form.
fn polynomial(leaf: Shape<'_>, tables: &[f64], axes: &DMat3, factors: [usize; 5]) -> [Affine; 5] {
    let layout = leaf.layout();
    let (Layout { m, n }, len) = (layout, layout.len());
    let table = |k: usize| &tables[k * len..(k + 1) * len];
    let mut turned = vec![0.0; 3 * len];
    for at in 0..len {
        let c1 = *axes * DVec3::new(table(1)[at], table(2)[at], table(3)[at]);
        (turned[at], turned[len + at], turned[2 * len + at]) = (c1.x, c1.y, c1.z);
    }
    let tables = [table(0), &turned[..len], &turned[len..2 * len], &turned[2 * len..]];
    // all coefficients that have so many others after them in s and in t
    let inside = |s: usize, t: usize| {
        (0..(m + 1).saturating_sub(s)).flat_map(move |i| (0..(n + 1).saturating_sub(t)).map(move |j| layout.at(i, j)))
    };
    let (step_s, step_t) = (layout.at(1, 0), layout.at(0, 1));
    let first = |step: usize| move |g: &[f64], at: usize| g[at + step] - g[at];
    let second = |step: usize| move |g: &[f64], at: usize| g[at] - 2.0 * g[at + step] + g[at + 2 * step];
    let mixed = |g: &[f64], at: usize| (g[at] - g[at + step_t]) - (g[at + step_s] - g[at + step_s + step_t]);
    [
        Affine::around(tables, factors[0], inside(1, 0), first(step_s)),
        Affine::around(tables, factors[1], inside(0, 1), first(step_t)),
        Affine::around(tables, factors[2], inside(2, 0), second(step_s)),
        Affine::around(tables, factors[3], inside(1, 1), mixed),
        Affine::around(tables, factors[4], inside(0, 2), second(step_t)),
    ]
}

/// From the boxes around the derivatives of a rational leaf.
fn rational(boxes: &Boxes) -> [Affine; 5] {
    let Boxes { p, ps, pt, pss, pst, ptt } = boxes;
    let twice_sum = |terms: &[(f64, f64)]| terms.iter().fold((0.0, 0.0), |(a, b), (c, d)| (a + 2.0 * c, b + 2.0 * d));
    [
        Affine::of(twice_sum(&[dot(p, ps)]), ps),
        Affine::of(twice_sum(&[dot(p, pt)]), pt),
        Affine::of(twice_sum(&[square(ps), dot(p, pss)]), pss),
        Affine::of(twice_sum(&[dot(ps, pt), dot(p, pst)]), pst),
        Affine::of(twice_sum(&[square(pt), dot(p, ptt)]), ptt),
    ]
}

/// The interval of the scalar product of vectors in two boxes.
fn dot(a: &Aabb, b: &Aabb) -> (f64, f64) {
    (0..3).fold((0.0, 0.0), |(low, high), k| {
        let products = [a.min[k] * b.min[k], a.min[k] * b.max[k], a.max[k] * b.min[k], a.max[k] * b.max[k]];
        let least = products.into_iter().fold(f64::INFINITY, f64::min);
        let most = products.into_iter().fold(f64::NEG_INFINITY, f64::max);
        (low + least, high + most)
    })
}

/// The interval of the squared length of the vectors in a box.
fn square(a: &Aabb) -> (f64, f64) {
    (0..3).fold((0.0, 0.0), |(low, high), k| {
        let (x, y) = (a.min[k] * a.min[k], a.max[k] * a.max[k]);
        let least = if a.min[k] <= 0.0 && a.max[k] >= 0.0 { 0.0 } else { x.min(y) };
        (low + least, high + x.max(y))
    })
}

#[cfg(test)]
mod tests {
    use super::super::double_double::{DoubleDouble, Random, squared_distance};
    use super::super::leaf::Leaf;
    use super::super::piece::Piece;
    use super::*;
    use fearless_simd::Level;
    use glam::DVec4;

    const DEGREES: [(usize, usize); 12] =
        [(1, 0), (2, 0), (3, 0), (9, 0), (25, 0), (1, 1), (2, 1), (1, 5), (2, 2), (3, 3), (3, 2), (5, 5)];

    /// A piece near a parallelogram, or as far from it as `bend` says, whose weights are up to `ratio` apart.
    fn leaf(degree: (usize, usize), bend: f64, ratio: Option<f64>, random: &mut Random) -> Leaf {
        let (p, q) = degree;
        let (along, across) = (random.point(), random.point());
        let share = |k: usize, n: usize| if n > 0 { k as f64 / n as f64 } else { 0.0 };
        let net: Vec<DVec4> = (0..(p + 1) * (q + 1))
            .map(|e| {
                let flat = share(e / (q + 1), p) * along + share(e % (q + 1), q) * across;
                let weight = ratio.map_or(1.0, |ratio| ratio.powf(random.between(0.0, 1.0)));
                ((flat + bend * random.point()) * weight).extend(weight)
            })
            .collect();
        Leaf::new(Piece { degree, net, u: (0.0, 1.0), v: (0.0, 1.0) }, ratio.is_some(), Level::new())
    }

    /// A query about a leaf's origin: from on the leaf to a thousand radii away.
    fn query(leaf: &Leaf, random: &mut Random) -> DVec3 {
        let on = leaf.jet(random.between(0.0, 1.0), random.between(0.0, 1.0)).point();
        on + leaf.radius * 10.0_f64.powf(random.between(-9.0, 3.0)) * random.point()
    }

    /// Parameters with the corners and edges among them.
    fn parameters(leaf: &Leaf, random: &mut Random) -> (f64, f64) {
        let mut one = || random.between(-0.3, 1.3).clamp(0.0, 1.0);
        let (s, t) = (one(), one());
        (s, if leaf.degree.1 == 0 { 0.0 } else { t })
    }

    fn ratio(round: usize, random: &mut Random) -> Option<f64> {
        match round % 4 {
            0 => None,
            1 => Some(1.0 + random.between(0.0, 1e-3)),
            2 => Some(16.0),
            // what a leaf has whose splitting ran out of room
            _ => Some(10.0_f64.powf(random.between(1.0, 4.0))),
        }
    }

    /// Each derivative of the squared distance, to 30 digits, lies in its range; and the share that pays for rounding is not idle: of pieces that are
    /// nothing but a line or a parallelogram a hundredth of it is exceeded.
    #[test]
    fn derivatives_lie_in_their_ranges_and_rounding_is_paid_for() {
        let mut random = Random(43);
        let (mut worst, mut worst_flat) = (f64::NEG_INFINITY, f64::NEG_INFINITY);
        for round in 0..1200 {
            let degree = DEGREES[round / 4 % DEGREES.len()];
            let ratio = ratio(round, &mut random);
            let flat = round % 3 == 0;
            let bend = if flat { 0.0 } else { 10.0_f64.powf(random.between(-4.0, 0.0)) };
            let leaf = leaf(degree, bend, ratio, &mut random);
            let ranges = &leaf.opened().ranges;
            for _ in 0..6 {
                let x = query(&leaf, &mut random);
                let view = ranges.view(x, leaf.along_axes(x));
                for _ in 0..4 {
                    let exact = squared_distance(&leaf.net, degree, x, parameters(&leaf, &mut random));
                    let held = [&ranges.s, &ranges.t, &ranges.ss, &ranges.st, &ranges.tt];
                    for (k, (range, factor)) in held.into_iter().zip(ranges.factors).enumerate() {
                        if degree.1 == 0 && [1, 3, 4].contains(&k) {
                            continue;
                        }
                        let (middle, extent) = range.at(&view);
                        let apart = (exact[k + 1] - DoubleDouble::from(middle)).to_f64().abs();
                        let beyond = (apart - extent) / (factor * view.rounding);
                        worst = worst.max(beyond);
                        if flat && ratio.is_none() {
                            worst_flat = worst_flat.max(beyond);
                        }
                    }
                }
            }
        }
        assert!(worst < 1.0, "a derivative lies outside its range by {worst} of what rounding may take");
        assert!(worst_flat > 1e-2, "the bound of rounding is idle: {worst_flat}");
    }

    /// No dense sample of a leaf contradicts the edge or corner that is claimed to be nearest, nor the claimed curvature; and both are claimed often.
    #[test]
    fn no_sample_contradicts_what_the_ranges_claim() {
        let mut random = Random(47);
        let (mut edges, mut curved, mut count) = (0, 0, 0);
        for round in 0..600 {
            let degree = DEGREES[round / 4 % DEGREES.len()];
            let ratio = ratio(round, &mut random);
            let bend = 10.0_f64.powf(random.between(-4.0, 0.0));
            let leaf = leaf(degree, bend, ratio, &mut random);
            let ranges = &leaf.opened().ranges;
            for _ in 0..4 {
                let x = query(&leaf, &mut random);
                let view = ranges.view(x, leaf.along_axes(x));
                let domain = ranges.lowest(&view);
                let curvature = ranges.curvature(&view, &domain);
                let (along_s, along_t) = (domain.s.0 < domain.s.1, domain.t.0 < domain.t.1);
                count += 1;
                edges += usize::from(!along_s || (degree.1 > 0 && !along_t));
                curved += usize::from(curvature.is_some() && (along_s || along_t));
                for _ in 0..12 {
                    let at = parameters(&leaf, &mut random);
                    let anywhere = squared_distance(&leaf.net, degree, x, at);
                    let inside = domain.clamp(at.0, at.1);
                    let [there, _, _, ss, st, tt] = squared_distance(&leaf.net, degree, x, inside);
                    let farther = (anywhere[0] - there).to_f64();
                    assert!(farther >= 0.0, "{degree:?} at {at:?}: nearer than {inside:?} by {farther}");
                    let Some(Curvature { s, t }) = curvature else { continue };
                    let left = |second: DoubleDouble, claimed: f64| (second - DoubleDouble::from(claimed)).to_f64();
                    let (left_s, left_t, st) = (left(ss, s), left(tt, t), st.to_f64());
                    assert!(!along_s || (s > 0.0 && left_s >= 0.0), "{degree:?} at {inside:?}: {left_s}");
                    assert!(!along_t || (t > 0.0 && left_t >= 0.0), "{degree:?} at {inside:?}: {left_t}");
                    assert!(!(along_s && along_t) || left_s * left_t >= st * st, "{left_s} {left_t} {st}");
                }
            }
        }
        assert!(edges * 20 > count && curved * 10 > count, "nothing is claimed: {edges} and {curved} of {count}");
    }
}
