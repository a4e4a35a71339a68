//! What the derivatives of a leaf's form can be at most and at least, told in a few operations, before the form is made.
//!
//! The form's coefficients are affine in the query: `g = c0 - 2 x · c1 + kappa c2` with `kappa = |x|² - tau²`. So are their differences, which are the
//! Bernstein coefficients of the form's derivatives. All coefficients of one derivative have their `(c0, c1, c2)` in a box of five dimensions, known
//! beforehand; over that box the affine function takes values in
//!
//! ```text
//! a + b · y + c kappa  ±  (ra + rb · |y| + rc |kappa|)
//! ```
//!
//! with the box's middle `(a, b, c)` and half its extents. The vectors are taken along the axes of the leaf's oriented box, `y` being the query
//! there: beside the leaf `y` points mostly along the normal, and what varies along the surface costs nothing.
//!
//! # Rounding
//!
//! A coefficient of the form errs by at most [`rounding_bound`], a first difference by twice and a second by four times that, made of the same tables;
//! the axes turn `c1` and `x` with errors of less than `32 u` of their product, `|c1|` of a difference being at most `4 r W²`. Twice the
//! largest of these bounds pays for it all.

use glam::{DMat3, DVec3};

use super::convex::{CORRELATED, Curvature};
use super::form::{Shape, rounding_bound};
use super::net::Layout;
use super::newton::Domain;

/// An affine function of the query for each coefficient of a net: the box around all of them.
#[derive(Debug, Clone, Copy)]
struct Affine {
    middle: [f64; 5],
    extent: [f64; 5],
}

impl Affine {
    /// The middle of the values at a query, and how far they may be from it.
    #[inline(always)]
    fn at(&self, view: &View) -> (f64, f64) {
        let (mut middle, mut extent) = (self.middle[0], self.extent[0]);
        for k in 0..4 {
            middle += self.middle[k + 1] * view.factors[k];
            extent += self.extent[k + 1] * view.factors[k].abs();
        }
        (middle, extent)
    }

    /// Around the `factor`-fold differences that `difference` takes of each table at every index.
    fn around(
        tables: &[&[f64]; 5],
        factor: usize,
        indices: impl Iterator<Item = usize> + Clone,
        difference: impl Fn(&[f64], usize) -> f64,
    ) -> Self {
        let mut affine = Self { middle: [0.0; 5], extent: [0.0; 5] };
        for (k, table) in tables.iter().enumerate().filter(|(_, table)| !table.is_empty()) {
            let (low, high) = indices.clone().map(|at| difference(table, at)).fold(
                (f64::INFINITY, f64::NEG_INFINITY),
                |(low, high), x| (low.min(x), high.max(x)),
            );
            if low <= high {
                affine.middle[k] = factor as f64 * 0.5 * (low + high);
                affine.extent[k] = factor as f64 * 0.5 * (high - low);
            }
        }
        affine
    }
}

/// A query as the ranges see it.
#[derive(Debug, Clone, Copy)]
pub(super) struct View {
    /// `-2 y` and `kappa`.
    factors: [f64; 4],
    /// What pays for the rounding of a difference.
    rounding: f64,
}

/// Ranges of the first and second derivatives of a leaf's form.
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
    heaviest: f64,
}

impl Ranges {
    /// Of a leaf whose tables are `tables`, along the axes that are the rows of `axes`.
    pub(super) fn new(leaf: Shape<'_>, tables: &[f64], axes: &DMat3, radius: f64, heaviest: f64) -> Self {
        let layout = leaf.layout();
        let (Layout { m, n }, len) = (layout, layout.len());
        let table = |k: usize| tables.get(k * len..(k + 1) * len).unwrap_or_default();
        let turned: Vec<DVec3> =
            (0..len).map(|at| *axes * DVec3::new(table(1)[at], table(2)[at], table(3)[at])).collect();
        let along = |axis: usize| turned.iter().map(|c1| c1[axis]).collect::<Vec<f64>>();
        let (cx, cy, cz) = (along(0), along(1), along(2));
        let tables = [table(0), &cx, &cy, &cz, table(4)];
        // all coefficients that have so many others after them in s and in t
        let inside = |s: usize, t: usize| {
            (0..(m + 1).saturating_sub(s)).flat_map(move |i| (0..(n + 1).saturating_sub(t)).map(move |j| layout.at(i, j)))
        };
        let (step_s, step_t) = (layout.at(1, 0), layout.at(0, 1));
        let first = |step: usize| move |g: &[f64], at: usize| g[at + step] - g[at];
        let second = |step: usize| move |g: &[f64], at: usize| g[at] - 2.0 * g[at + step] + g[at + 2 * step];
        let mixed = |g: &[f64], at: usize| (g[at] - g[at + step_t]) - (g[at + step_s] - g[at + step_s + step_t]);
        let factors = [m, n, m * (m - 1), m * n, n * n.saturating_sub(1)];
        Self {
            s: Affine::around(&tables, factors[0], inside(1, 0), first(step_s)),
            t: Affine::around(&tables, factors[1], inside(0, 1), first(step_t)),
            ss: Affine::around(&tables, factors[2], inside(2, 0), second(step_s)),
            st: Affine::around(&tables, factors[3], inside(1, 1), mixed),
            tt: Affine::around(&tables, factors[4], inside(0, 2), second(step_t)),
            factors: factors.map(|factor| factor as f64),
            degree: leaf.degree,
            radius,
            heaviest,
        }
    }

    /// The query at `x` from the leaf's origin and at `y` along its axes, with the distance `tau` that the form is made with.
    #[inline(always)]
    pub(super) fn view(&self, x: DVec3, y: DVec3, tau: f64) -> View {
        let square = x.length_squared();
        let rounding = 8.0 * rounding_bound(self.degree, square.sqrt(), self.radius, tau, self.heaviest);
        View { factors: [-2.0 * y.x, -2.0 * y.y, -2.0 * y.z, square - tau * tau], rounding }
    }

    /// The edge or corner of the leaf on which the form is least, as far as the signs of its slopes tell; else all of it.
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

    /// A lower bound of the Hessian in the directions in which the box has an extent, if the ranges show the form convex there: with
    /// `rho² = max Gst² / (min Gss min Gtt) < 1`, `H >= (1 - rho) diag(min Gss, min Gtt)`.
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
