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
//! those around the Bernstein coefficients of the form's tables; of a rational one they come from the boxes around its derivatives
//! ([`quotient`](super::quotient)).
//!
//! # Rounding
//!
//! Of a polynomial leaf a coefficient of the form errs by at most [`rounding_bound`], a first difference by twice and a second by four times that, made of
//! the same coefficients; the axes turn vectors and query with errors of less than `32 u` of their product, `|c1|` of a difference being at most
//! `4 r`. Twice the largest of these bounds pays for it all, and times the squared ratio of the weights for the products of a rational leaf's boxes,
//! whose own rounding is in the boxes.

use glam::{DMat3, DVec3, DVec4};
use perpend_kernel::Aabb;

use super::convex::{CORRELATED, Curvature};
use super::form::{Coefficients, Shape, rounding_bound};
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

    /// Around the `factor`-fold differences that `difference` takes at so many rows and columns of a net whose rows are `width` long.
    #[inline(always)]
    fn around(
        (rows, columns, width): (usize, usize, usize),
        factor: usize,
        difference: impl Fn(usize) -> DVec4,
    ) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 4], [f64::NEG_INFINITY; 4]);
        for row in 0..rows {
            for at in row * width..row * width + columns {
                let value = difference(at).to_array();
                for k in 0..4 {
                    low[k] = if value[k] < low[k] { value[k] } else { low[k] };
                    high[k] = if value[k] > high[k] { value[k] } else { high[k] };
                }
            }
        }
        let mut affine = Self::default();
        if rows > 0 && columns > 0 {
            for k in 0..4 {
                affine.middle[k] = factor as f64 * 0.5 * (low[k] + high[k]);
                affine.extent[k] = factor as f64 * 0.5 * (high[k] - low[k]);
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
    /// Of a leaf, along the axes that are the rows of `axes`; its control points lie within `radius` of its origin and its
    /// weights between two bounds.
    pub(super) fn new(leaf: Shape<'_>, axes: &DMat3, radius: f64, weights: (f64, f64)) -> Self {
        let Layout { m, n } = leaf.layout();
        let factors = [m, n, m * (m - 1), m * n, n * n.saturating_sub(1)];
        let [s, t, ss, st, tt] = if leaf.rational {
            rational(&Boxes::around(leaf, axes, radius, weights))
        } else {
            polynomial(leaf, axes, factors)
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

/// From the coefficients of a polynomial leaf's form.
fn polynomial(leaf: Shape<'_>, axes: &DMat3, factors: [usize; 5]) -> [Affine; 5] {
    let (Layout { m, n }, Coefficients { squares, vectors }) = (leaf.layout(), Coefficients::of(leaf));
    let turned: Vec<DVec4> = squares
        .iter()
        .zip(&vectors)
        .map(|(c0, c1)| {
            let c1 = *axes * c1.truncate();
            DVec4::new(*c0, c1.x, c1.y, c1.z)
        })
        .collect();
    let (g, width) = (&turned[..], n + 1);
    // all coefficients that have so many others after them in s and in t
    let inside = |s: usize, t: usize| ((m + 1).saturating_sub(s), (n + 1).saturating_sub(t), width);
    let first = |step: usize| move |at: usize| g[at + step] - g[at];
    let second = |step: usize| move |at: usize| g[at] - 2.0 * g[at + step] + g[at + 2 * step];
    let mixed = |at: usize| (g[at] - g[at + 1]) - (g[at + width] - g[at + width + 1]);
    [
        Affine::around(inside(1, 0), factors[0], first(width)),
        Affine::around(inside(0, 1), factors[1], first(1)),
        Affine::around(inside(2, 0), factors[2], second(width)),
        Affine::around(inside(1, 1), factors[3], mixed),
        Affine::around(inside(0, 2), factors[4], second(1)),
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
