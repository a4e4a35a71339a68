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
//! there: beside the leaf `y` points mostly along the normal, and what varies along the surface costs nothing.
//!
//! Of a polynomial leaf the boxes are those around differences of the form's coefficients `g`. In place of slopes, secants are taken, which vary less:
//!
//! ```text
//! (D(s) - D(0)) / s       = Σ n (g_k - g_0) / k · B_{k-1}^{n-1}(s)
//! (D(s) - D(1)) / (1 - s) = Σ n (g_k - g_n) / (n - k) · B_k^{n-1}(s)
//! ```
//!
//! Where the first are not negative, the leaf is nearest where it begins, where the second are not, at its end. Of a rational leaf the boxes come from
//! those around its derivatives ([`quotient`](super::quotient)), by interval products, and slopes stand for secants. Each edge has ranges of its own,
//! from the coefficients of its line alone.
//!
//! # Rounding
//!
//! Of a polynomial leaf a coefficient of the form errs by at most [`rounding_bound`], a first difference by twice and a second by four times that, made of
//! the same coefficients; the axes turn vectors and query with errors of less than `32 u` of their product, `|c1|` of a difference being at most
//! `4 r`. Twice the largest of these bounds pays for it all. The boxes of a rational leaf hold their own rounding; with `n` the degree in their direction and `rho` the ratio
//! of the weights their vectors are at most `24 n² r rho³` and their constants `32 n² r² rho⁴` ([`quotient`](super::quotient)), and turning and
//! summing errs by less than `40 u` of the products with the query: less than the bound of a polynomial leaf times `rho⁴`, since `(|x| + r)² >= 4 |x| r`. Storing in single precision needs no share: the extent is taken from the rounded middle, and rounded outwards.

use glam::{DMat3, DVec3, DVec4};
use perpend_kernel::Aabb;

use super::convex::Curvature;
use super::form::{Coefficients, Shape, rounding_bound};
use super::net::Layout;
use super::newton::Domain;
use super::quotient::Boxes;

/// An affine function of the query that varies over the leaf: the box around all of them, in single precision and rounded outwards: large
/// entities wait for memory (measured: 128 × 128 spans cost 3.5 times as much as 8 × 8 with double precision, 3.0 times with single).
#[derive(Debug, Clone, Copy, Default)]
struct Affine {
    middle: [f32; 4],
    extent: [f32; 4],
}

impl Affine {
    /// The middle of the values at a query, and how far they may be from it.
    #[inline(always)]
    fn at(&self, view: &View) -> (f64, f64) {
        let (mut middle, mut extent) = (f64::from(self.middle[0]), f64::from(self.extent[0]));
        for k in 0..3 {
            middle += f64::from(self.middle[k + 1]) * view.factors[k];
            extent += f64::from(self.extent[k + 1]) * view.factors[k].abs();
        }
        (middle, extent)
    }

    fn negative(&self) -> Self {
        Self { middle: self.middle.map(|x| -x), extent: self.extent }
    }

    /// The function whose constant lies in an interval and whose vector lies in a box.
    fn of(constant: (f64, f64), vector: &Aabb) -> Self {
        let (low, high) = (vector.min, vector.max);
        Self::between([constant.0, low.x, low.y, low.z], [constant.1, high.x, high.y, high.z])
    }

    /// The box between these corners.
    fn between(low: [f64; 4], high: [f64; 4]) -> Self {
        let mut affine = Self::default();
        for k in 0..4 {
            let middle = (0.5 * (low[k] + high[k])) as f32;
            let extent = (high[k] - f64::from(middle)).max(f64::from(middle) - low[k]).max(0.0);
            affine.middle[k] = middle;
            // above the extent, whichever way it was rounded; of what is no number nothing is known
            affine.extent[k] = if middle.is_nan() { f32::INFINITY } else { (extent as f32).next_up() };
        }
        affine
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

/// Where weights are farther apart than this the margins of a rational leaf's boxes would leave nothing, and single precision may overflow: then no
/// range is claimed. Leaves are split until their weights are 16 apart where there is room.
const MOST_UNEVEN: f64 = 1e6;

/// One direction of a leaf or of one of its edges.
#[derive(Debug, Clone, Copy, Default)]
struct Along {
    /// How the squared distance rises from the beginning, and how it falls to the end, over the parameter that it takes: secants, which vary less than slopes.
    rise: Affine,
    fall: Affine,
    /// The second derivative.
    bend: Affine,
}

impl Along {
    /// Of a rational piece whose points and derivatives lie in these boxes: slopes are secants, too.
    fn within(point: &Aabb, first: &Aabb, second: &Aabb) -> Self {
        let slope = Affine::of(twice(&[dot(point, first)]), first);
        let bend = Affine::of(twice(&[square(first), dot(point, second)]), second);
        Self { rise: slope, fall: slope.negative(), bend }
    }

    /// The end that is nearest, as far as the secants tell; else both.
    #[inline(always)]
    fn lowest(&self, view: &View, factor: f64) -> (f64, f64) {
        let error = factor * view.rounding;
        // a difference, not a sum: what is too large for single precision is infinite in both, and must fail
        let (middle, extent) = self.rise.at(view);
        if middle - extent >= error {
            return (0.0, 0.0);
        }
        let (middle, extent) = self.fall.at(view);
        if middle - extent >= error { (1.0, 1.0) } else { (0.0, 1.0) }
    }

    /// The least second derivative.
    #[inline(always)]
    fn least_bend(&self, view: &View, factor: f64) -> f64 {
        let (middle, extent) = self.bend.at(view);
        middle - extent - factor * (factor - 1.0) * view.rounding
    }
}

/// Ranges of the slopes of the squared distance to a leaf: where one of them has a sign, no stationary point lies in the leaf.
#[derive(Debug)]
pub(super) struct Slopes {
    s: Affine,
    t: Affine,
    /// What rounding is multiplied with in either direction.
    factors: [f64; 2],
}

impl Slopes {
    /// As [`Ranges::new`].
    pub(super) fn new(leaf: Shape<'_>, axes: &DMat3, radius: f64, weights: (f64, f64)) -> Self {
        let Layout { m, n } = leaf.layout();
        let factors = [m as f64, n as f64];
        if weights.1 > MOST_UNEVEN * weights.0 {
            let unknown = Affine { middle: [0.0; 4], extent: [f32::INFINITY; 4] };
            return Self { s: unknown, t: unknown, factors };
        }
        if leaf.rational {
            let Boxes { p, ps, pt, .. } = Boxes::around(leaf, axes, radius, weights);
            let slope = |first: &Aabb| Affine::of(twice(&[dot(&p, first)]), first);
            return Self { s: slope(&ps), t: slope(&pt), factors };
        }
        let (g, width) = (turned(leaf, axes), n + 1);
        let (mut s, mut t) = (Hull::EMPTY, Hull::EMPTY);
        for i in 0..=m {
            for j in 0..=n {
                let at = i * width + j;
                if i < m {
                    s.add(g[at + width] - g[at]);
                }
                if j < n {
                    t.add(g[at + 1] - g[at]);
                }
            }
        }
        Self { s: s.times(factors[0]), t: t.times(factors[1]), factors }
    }

    /// The signs that the slopes in s and in t have all over the leaf; 0 where one may vanish.
    pub(super) fn signs(&self, view: &View) -> [f64; 2] {
        [(&self.s, self.factors[0]), (&self.t, self.factors[1])].map(|(slope, factor)| {
            let (middle, extent) = slope.at(view);
            if middle.abs() - extent > factor * view.rounding { middle.signum() } else { 0.0 }
        })
    }
}

/// The coefficients of a polynomial leaf's form, with their vectors along the axes.
fn turned(leaf: Shape<'_>, axes: &DMat3) -> Vec<DVec4> {
    let Coefficients { squares, vectors } = Coefficients::of(leaf);
    let turned = squares.iter().zip(&vectors).map(|(c0, c1)| {
        let c1 = *axes * c1.truncate();
        DVec4::new(*c0, c1.x, c1.y, c1.z)
    });
    turned.collect()
}

/// Ranges of the derivatives of the squared distance to a leaf.
#[derive(Debug)]
pub(super) struct Ranges {
    /// Over the whole leaf.
    s: Along,
    t: Along,
    st: Affine,
    /// Over the edges at the two ends in t, along s; and at the two ends in s, along t.
    edges_s: [Along; 2],
    edges_t: [Along; 2],
    /// Degrees of the form.
    m: f64,
    n: f64,
    degree: (usize, usize),
    radius: f64,
    /// What the rounding of a rational leaf is multiplied with: `rho⁴`.
    weights: f64,
}

impl Ranges {
    /// Of a leaf along the axes that are the rows of `axes`; its control points lie within `radius` of its origin and its
    /// weights between two bounds.
    pub(super) fn new(leaf: Shape<'_>, axes: &DMat3, radius: f64, weights: (f64, f64)) -> Self {
        let Layout { m, n } = leaf.layout();
        let empty = Self {
            s: Along::default(),
            t: Along::default(),
            st: Affine::default(),
            edges_s: Default::default(),
            edges_t: Default::default(),
            m: m as f64,
            n: n as f64,
            degree: leaf.degree,
            radius,
            weights: (weights.1 / weights.0).powi(4),
        };
        if weights.1 > MOST_UNEVEN * weights.0 {
            empty.unknown()
        } else if leaf.rational {
            empty.rational(leaf, axes, radius, weights)
        } else {
            empty.polynomial(leaf, axes)
        }
    }

    /// Ranges that claim nothing.
    fn unknown(self) -> Self {
        let affine = Affine { middle: [0.0; 4], extent: [f32::INFINITY; 4] };
        let along = Along { rise: affine, fall: affine, bend: affine };
        Self { s: along, t: along, st: affine, edges_s: [along; 2], edges_t: [along; 2], ..self }
    }

    /// The query at `x` from the leaf's origin and at `y` along its axes.
    #[inline(always)]
    pub(super) fn view(&self, x: DVec3, y: DVec3) -> View {
        let rounding = 8.0 * rounding_bound(self.degree, x.length(), self.radius, 0.0, 1.0) * self.weights;
        View { factors: (-2.0 * y).to_array(), rounding }
    }

    /// The edge or corner of the leaf that is nearest, as far as the secants tell; else all of it.
    #[inline(always)]
    pub(super) fn lowest(&self, view: &View) -> Domain {
        let mut s = self.s.lowest(view, self.m);
        if self.degree.1 == 0 {
            return Domain { s, t: (0.0, 0.0) };
        }
        let mut t = self.t.lowest(view, self.n);
        // on an edge its own secants tell
        match (s.0 == s.1, t.0 == t.1) {
            (true, false) => t = self.edges_t[s.0 as usize].lowest(view, self.n),
            (false, true) => s = self.edges_s[t.0 as usize].lowest(view, self.m),
            _ => {}
        }
        Domain { s, t }
    }

    /// A lower bound of the Hessian in the directions in which the box has an extent, if the ranges show `D` convex there: with
    /// `rho² = max D_st² / (min D_ss min D_tt) < 1`, `H >= (1 - rho) diag(min D_ss, min D_tt)`.
    #[inline(always)]
    pub(super) fn curvature(&self, view: &View, domain: &Domain) -> Option<Curvature> {
        let (along_s, along_t) = (domain.s.0 < domain.s.1, domain.t.0 < domain.t.1);
        if !along_t {
            let edge = if self.degree.1 == 0 { &self.s } else { &self.edges_s[domain.t.0 as usize] };
            let s = edge.least_bend(view, self.m);
            return (s > 0.0).then_some(Curvature { s, t: 0.0 });
        }
        if !along_s {
            let t = self.edges_t[domain.s.0 as usize].least_bend(view, self.n);
            return (t > 0.0).then_some(Curvature { s: 0.0, t });
        }
        let (s, t) = (self.s.least_bend(view, self.m), self.t.least_bend(view, self.n));
        let (middle, extent) = self.st.at(view);
        Curvature::uncorrelated(s, t, middle.abs() + extent + self.m * self.n * view.rounding)
    }

    /// From the coefficients of a polynomial leaf's form.
    fn polynomial(mut self, leaf: Shape<'_>, axes: &DMat3) -> Self {
        let (Layout { m, n }, g) = (leaf.layout(), turned(leaf, axes));
        let width = n + 1;
        let lines = |degree: usize, step: usize, across: usize| Lines { g: &g, degree, step, across };
        self.s = lines(m, width, 1).along(0..width);
        if n > 0 {
            self.t = lines(n, 1, width).along(0..m + 1);
            self.edges_s = [lines(m, width, 1).along(0..1), lines(m, width, 1).along(n..width)];
            self.edges_t = [lines(n, 1, width).along(0..1), lines(n, 1, width).along(m..m + 1)];
            let mut mixed = Hull::EMPTY;
            for i in 0..m {
                for at in i * width..i * width + n {
                    mixed.add((g[at] - g[at + 1]) - (g[at + width] - g[at + width + 1]));
                }
            }
            self.st = mixed.times((m * n) as f64);
        }
        self
    }

    /// From the boxes around the derivatives of a rational leaf and of its edges.
    fn rational(mut self, leaf: Shape<'_>, axes: &DMat3, radius: f64, weights: (f64, f64)) -> Self {
        let Boxes { p, ps, pt, pss, pst, ptt } = Boxes::around(leaf, axes, radius, weights);
        self.s = Along::within(&p, &ps, &pss);
        if leaf.degree.1 > 0 {
            self.t = Along::within(&p, &pt, &ptt);
            self.st = Affine::of(twice(&[dot(&ps, &pt), dot(&p, &pst)]), &pst);
            let edge = |from: usize, step: usize, degree: usize| {
                let net: Vec<DVec4> = leaf.net[from..].iter().step_by(step).take(degree + 1).copied().collect();
                let edge = Shape { degree: (degree, 0), rational: true, net: &net };
                let Boxes { p, ps, pss, .. } = Boxes::around(edge, axes, radius, weights);
                Along::within(&p, &ps, &pss)
            };
            let (p, q) = leaf.degree;
            self.edges_s = [edge(0, q + 1, p), edge(q, q + 1, p)];
            self.edges_t = [edge(0, 1, q), edge(p * (q + 1), 1, q)];
        }
        self
    }
}

/// Parallel lines of coefficients: index `k` of line `l` lies at `k step + l across`.
struct Lines<'a> {
    g: &'a [DVec4],
    degree: usize,
    step: usize,
    across: usize,
}

impl Lines<'_> {
    /// Secants and second derivatives of some of the lines.
    fn along(&self, lines: std::ops::Range<usize>) -> Along {
        let degree = self.degree;
        let (mut rise, mut fall, mut bend) = (Hull::EMPTY, Hull::EMPTY, Hull::EMPTY);
        for l in lines {
            let at = |k: usize| self.g[k * self.step + l * self.across];
            for k in 0..degree {
                fall.add((at(k) - at(degree)) / (degree - k) as f64);
                rise.add((at(k + 1) - at(0)) / (k + 1) as f64);
                if k + 2 <= degree {
                    bend.add(at(k) - 2.0 * at(k + 1) + at(k + 2));
                }
            }
        }
        let first = degree as f64;
        Along { rise: rise.times(first), fall: fall.times(first), bend: bend.times(first * (first - 1.0)) }
    }
}

/// The box around points of four dimensions.
struct Hull {
    low: DVec4,
    high: DVec4,
}

impl Hull {
    const EMPTY: Self = Self { low: DVec4::INFINITY, high: DVec4::NEG_INFINITY };

    fn add(&mut self, x: DVec4) {
        let smaller = |a: f64, b: f64| if b < a { b } else { a };
        let larger = |a: f64, b: f64| if b > a { b } else { a };
        for k in 0..4 {
            (self.low[k], self.high[k]) = (smaller(self.low[k], x[k]), larger(self.high[k], x[k]));
        }
    }

    fn times(&self, factor: f64) -> Affine {
        Affine::between((self.low * factor).to_array(), (self.high * factor).to_array())
    }
}

/// Twice the sum of intervals.
fn twice(terms: &[(f64, f64)]) -> (f64, f64) {
    terms.iter().fold((0.0, 0.0), |(a, b), (c, d)| (a + 2.0 * c, b + 2.0 * d))
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
        let piece = Piece { degree, net, rational: ratio.is_some(), u: (0.0, 1.0), v: (0.0, 1.0) };
        Leaf::new(piece, Level::new(), &mut Vec::new())
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

    /// Where the ranges of one direction hold: over the lines at all `t`, or on an edge.
    fn held_along(ranges: &Ranges, in_s: bool, other: f64) -> Vec<&Along> {
        let (whole, edges) = if in_s { (&ranges.s, &ranges.edges_s) } else { (&ranges.t, &ranges.edges_t) };
        let is_edge = ranges.degree.1 > 0 && (other == 0.0 || other == 1.0);
        [Some(whole), is_edge.then(|| &edges[other as usize])].into_iter().flatten().collect()
    }

    /// Each secant and second derivative of the squared distance, to 30 digits, lies in its range; and the ranges are not idle: of polynomial pieces more
    /// than half of one is met. (What is reserved for rounding lies far below the single precision of the boxes.)
    #[test]
    fn derivatives_lie_in_their_ranges() {
        let mut random = Random(43);
        let mut fullest = 0.0_f64;
        for round in 0..1200 {
            let degree = DEGREES[round / 4 % DEGREES.len()];
            let ratio = ratio(round, &mut random);
            let bend = if round % 3 == 0 { 0.0 } else { 10.0_f64.powf(random.between(-4.0, 0.0)) };
            let leaf = leaf(degree, bend, ratio, &mut random);
            let ranges = leaf.ranges();
            for _ in 0..6 {
                let x = query(&leaf, &mut random);
                let view = ranges.view(x, leaf.along_axes(x));
                let mut check = |what: &str, range: &Affine, exact: DoubleDouble, factor: f64| {
                    let (middle, extent) = range.at(&view);
                    let (apart, held) =
                        ((exact - DoubleDouble::from(middle)).to_f64().abs(), extent + factor * view.rounding);
                    assert!(apart <= held, "{what} of {degree:?} with {ratio:?} at {x}: {apart} beyond {held}");
                    if ratio.is_none() {
                        fullest = fullest.max(apart / held);
                    }
                };
                for _ in 0..4 {
                    let (s, t) = parameters(&leaf, &mut random);
                    let at = |s: f64, t: f64| squared_distance(&leaf.net, degree, x, (s, t));
                    let (here, [first, last], [low, high]) =
                        (at(s, t), [at(0.0, t), at(1.0, t)], [at(s, 0.0), at(s, 1.0)]);
                    let secant = |from: DoubleDouble, step: f64, slope: DoubleDouble| {
                        if step > 0.0 { (here[0] - from) / step } else { slope }
                    };
                    let negative = |x: DoubleDouble| DoubleDouble::from(0.0) - x;
                    for along in held_along(ranges, true, t) {
                        check("rise in s", &along.rise, secant(first[0], s, here[1]), ranges.m);
                        check("fall in s", &along.fall, secant(last[0], 1.0 - s, negative(here[1])), ranges.m);
                        check("bend in s", &along.bend, here[3], ranges.m * (ranges.m - 1.0));
                    }
                    if degree.1 > 0 {
                        for along in held_along(ranges, false, s) {
                            check("rise in t", &along.rise, secant(low[0], t, here[2]), ranges.n);
                            check("fall in t", &along.fall, secant(high[0], 1.0 - t, negative(here[2])), ranges.n);
                            check("bend in t", &along.bend, here[5], ranges.n * (ranges.n - 1.0));
                        }
                        check("twist", &ranges.st, here[4], ranges.m * ranges.n);
                    }
                }
            }
        }
        assert!(fullest > 0.5, "the ranges are idle: {fullest}");
    }

    /// Weights may be so far apart that a box is too large for single precision: then nothing is claimed.
    #[test]
    fn what_single_precision_cannot_hold_claims_nothing() {
        let mut random = Random(59);
        let mut infinite = 0;
        for round in 0..200 {
            let degree = [(1, 0), (2, 0), (1, 1), (2, 2)][round % 4];
            let leaf = leaf(degree, 0.1, Some(10.0_f64.powf(random.between(18.0, 99.0))), &mut random);
            let ranges = leaf.ranges();
            let x = query(&leaf, &mut random);
            let view = ranges.view(x, leaf.along_axes(x));
            infinite += usize::from(ranges.s.rise.extent.iter().any(|x| x.is_infinite()));
            let domain = ranges.lowest(&view);
            for _ in 0..20 {
                let at = parameters(&leaf, &mut random);
                let [anywhere, there] =
                    [at, domain.clamp(at.0, at.1)].map(|at| squared_distance(&leaf.net, degree, x, at)[0]);
                assert!((anywhere - there).to_f64() >= 0.0, "{degree:?} at {at:?} is nearer than in {domain:?}");
            }
        }
        assert!(infinite > 20, "single precision held all but {infinite}");
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
            let ranges = leaf.ranges();
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
